// Receivers and scenes as cells.
#pragma once

#include <span>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "vtk/data_set.h"

namespace exactff::vtk {

// The receivers in the order of their cells: those without a cell on a lattice first.
[[nodiscard]] std::vector<std::size_t> cell_order(std::span<const Receiver> receivers);

// The cells, and arrays that say which receiver each one is.
[[nodiscard]] DataSet cells_of(const Scene& scene, std::span<const Receiver> receivers,
                               const std::vector<std::size_t>& order);

// The pieces of the faces, with patch, face and material.
[[nodiscard]] DataSet cells_of(const Scene& scene);

}  // namespace exactff::vtk
