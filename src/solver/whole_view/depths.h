// Which of two faces is nearer to x in a direction.
//
// The plane N . (y - x) = c, c > 0, lies at y = x + d / w in direction d, where w = (N / c) . d is its inverse depth.
// Of two faces that are both seen in direction d, the one with the larger w is nearer. w is linear in d, so two signs
// decide for all directions between two given ones, and the directions in which two planes are equally deep form one
// plane through x.
//
// Filter, with u = 2^-53. Let e, f be the two edge vectors of a face that span its plane and s its first corner, as
// rounded differences (relative error u), and A = |e| |f|, |.| being the largest magnitude. A component of N = e x f
// errs by less than 8u A, c = N . s by less than 64u A |s| = C. A component of N / c then errs by at most
// (8u A + |N / c| C) / (|c| - C) + u |N / c|, which is called E. For a corner t (relative error 2u), w errs by less
// than (3 E + 18u |N / c|) |t|; the difference of two such numbers adds u of each, at most 3u |N / c| |t|. So error = 3
// E + 32u |N / c| serves for differences as well, with a margin for its own rounding.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "visibility/outlines.h"

namespace exactff::whole_view {

using visibility::CornerId;
using visibility::EdgeId;
using visibility::OutlineId;
using visibility::Outlines;

struct InverseDepth {
  Vec3 slope;          // N / c
  double error = 0.0;  // w = slope . t within error |t|; infinite where the filter must decline
};

class Depths {
 public:
  // Forgets all outlines.
  void start(const Scene& scene, const Vec3& x, int scale_exponent);
  // The next outline lies in the plane of this piece. Requires that the plane does not hold x; this
  // is checked where the exact plane is needed.
  void add(const Piece& piece);
  [[nodiscard]] std::span<const InverseDepth> all() const { return depths_; }
  [[nodiscard]] const InverseDepth& of(OutlineId outline) const { return depths_[outline]; }
  [[nodiscard]] const Piece& piece(OutlineId outline) const { return *pieces_[outline]; }

  // +1, 0, -1: the plane of p is nearer than, as far as, further than the plane of q in the direction of the corner.
  // Both planes must be ahead in some direction near the corner, or be compared by their linear w alone.
  [[nodiscard]] int compare(Outlines& outlines, OutlineId p, OutlineId q, CornerId corner);
  // The exact normal of an outline's plane, turned away from x.
  [[nodiscard]] const kernel::ExactVec3& exact_normal(OutlineId outline) { return exact(outline).normal; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Exact {
    kernel::ExactVec3 normal;
    kernel::Integer offset;  // c = offset 2^exponent
    long exponent = 0;
  };
  [[nodiscard]] const Exact& exact(OutlineId outline);

  std::span<const Vec3> vertices_;
  Vec3 x_;
  double scale_ = 1.0;
  std::vector<InverseDepth> depths_;
  std::vector<const Piece*> pieces_;
  std::vector<std::uint32_t> exact_at_;  // by outline, into exact_
  std::deque<Exact> exact_;              // the first exact_count_; the rest is spare memory
  std::size_t exact_count_ = 0;
  kernel::Integer left_, right_, dot_;  // scratch
  kernel::ScaledVec3 first_, second_;
};

}  // namespace exactff::whole_view
