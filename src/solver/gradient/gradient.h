// The gradient of one form factor, plane by plane of the source: whether it exists (kinks.h), and its values, first in
// double-double (quick_arcs.h), then in balls of rising precision (contour/arc_sum.h).
#pragma once

#include <optional>
#include <vector>

#include "contour/arc_sum.h"
#include "exactff/exact.h"
#include "gradient/kinks.h"
#include "gradient/quick_arcs.h"

namespace exactff::gradient {

// A workspace.
class PointGradient {
 public:
  struct Request {
    std::optional<Vec3> along;  // not zero
    bool list_arcs = false;
  };
  // Starts a new one.
  void start(const visibility::View& view, const Request& request);
  // Takes one plane with its visible boundary.
  void add(const visibility::PlaneQuery& query, const visibility::VisibleBoundary& boundary);

  // Encloses F, by the sums for V. Requires that something is visible.
  [[nodiscard]] Ball form_factor() const;
  // Takes the values that double-double determines. False if others are left: then call add_exactly for all planes in
  // the same order, and certify.
  [[nodiscard]] bool finish(int cap, Gradient& result);
  void add_exactly(const visibility::PlaneQuery& query, const visibility::VisibleBoundary& boundary);
  void certify(int cap, Gradient& result);

 private:
  [[nodiscard]] bool exists_along() const;
  void list_arcs(const kernel::ExactVec3& n, Gradient& result) const;

  KinkSearch search_;
  QuickArcs quick_;
  std::optional<kernel::ExactVec3> along_;
  Vec3 x_, normal_;
  bool list_arcs_ = false;
  bool something_visible_ = false;
  std::optional<Kink> kink_;
  std::vector<std::vector<SightResult>> kinks_;  // by plane of the source, if `along` is asked for
  std::size_t exact_planes_ = 0;
  std::vector<contour::MovingArc> arcs_, contour_arcs_;
};

}  // namespace exactff::gradient
