// Receivers: where and with which normal a form factor is asked for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// A point with a normal of any non-zero length. A receiver made on a face remembers it: that face, every
// piece of it, neither occludes nor illuminates the point, since the rounded point lies a hair above or
// below it. A receiver without `on` excludes nothing.
struct Receiver {
  Vec3 point;
  Vec3 normal;
  std::optional<FaceId> on;
  std::string id;  // of a CSV row, or "i,j" of a grid cell; may be empty
};

// The grid cell that a receiver is the centre of; column and row count from 1.
struct GridCell {
  FaceId face{};
  int column = 1;  // along u
  int row = 1;     // along v
};

struct GridSize {
  int u = 1;
  int v = 1;
};

// Cell centres of a u x v grid on each face of the selection: of the bilinear map of a convex
// quadrilateral; else of its bounding rectangle in its plane (u along the first edge, v = Newell x u),
// keeping the centres inside the face. Computed rationally and rounded once; the normal is the face's
// Newell vector. u runs fastest. The id is "column,row", counted from 1.
// A face that is not planar: the quadrilateral's map is then a curved patch through all four corners; the
// rectangle lies in the plane through the mean of the vertices with the Newell vector as its normal. Either
// way the point may lie off the face's triangles, which it remembers nevertheless. Throws InputError where a
// count is below 1.
[[nodiscard]] std::vector<Receiver> grid_receivers(const Scene& scene, const Selection& on, GridSize size);

// The cell of a receiver that lies on a face and has an id as grid_receivers gives it; else nothing.
[[nodiscard]] std::optional<GridCell> grid_cell(const Receiver& receiver);

// A CSV with the header id,x,y,z,nx,ny,nz,on (`on` empty or NAME:K; the columns id and on may be absent, and
// any order will do). Fields may be quoted; lines that are empty or begin with # are passed over. Numbers are
// read with correct rounding. Throws one InputError with file:line for everything wrong.
[[nodiscard]] std::vector<Receiver> read_receivers(const std::filesystem::path& path, const Scene& scene);

}  // namespace exactff
