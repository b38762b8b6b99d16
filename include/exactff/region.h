// What a receiver sees of a source, as a value: found once, and read as often as needed. Everything that is computed
// from it, values of all measures, gradients and derivatives by vertices, is a sum over the same exact arcs, and is
// the same in every bit as what exact_form_factor finds for the same request (exact.h).
#pragma once

#include <memory>
#include <vector>

#include "exactff/exact.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff {

// A part of the boundary of what is visible, on its line in space: an edge of a face, or where one cuts the source; of
// what the Booleans found, in the source's plane. Seen from x, what is visible is on the left as one goes from `from`
// to `to`. Each coordinate is rounded once: for drawings, no value depends on it.
struct RegionArc {
  Vec3 from, to;
};

// Keeps references to the scene and to the source. Can be moved, not copied. Reading reuses memory of the region, so
// concurrent calls need one each.
class VisibleRegion {
 public:
  VisibleRegion();  // of nothing: call find() first
  // As find().
  VisibleRegion(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                const ExactOptions& options = {});
  VisibleRegion(VisibleRegion&&) noexcept;
  VisibleRegion& operator=(VisibleRegion&&) noexcept;
  ~VisibleRegion();

  // Finds another one, in the existing memory. Of the options, the engine, the occluders, the requests for fractions
  // and cutters, and whether the measure is that of a sphere count. Requires what exact_form_factor requires, and one
  // engine (else std::invalid_argument).
  void find(const Scene& scene, const Receiver& receiver, const ExactSource& source, const ExactOptions& options = {});

  // Exact: nothing is visible.
  [[nodiscard]] bool empty() const;
  // In any order; they form closed loops.
  [[nodiscard]] std::vector<RegionArc> arcs() const;

  // With the records of the search. Requires that the measure is of a sphere if and only if the region is (else
  // std::invalid_argument).
  [[nodiscard]] FormFactor form_factor(const Measure& measure = {}, int digits = 0, int precision_cap = 65536);
  // Only the requests for a gradient of the options and their precision cap count. Requires a region that is not a
  // sphere's (else std::invalid_argument).
  [[nodiscard]] Gradient gradient(const ExactOptions& options = {});

 private:
  struct Data;
  [[nodiscard]] Data& data() const;
  std::unique_ptr<Data> data_;
};

}  // namespace exactff
