// Shaft culling (E. Haines and J. Wallace 1991) from a point to a convex patch, and the occluders in the shaft.
//
// Notation: x is the origin; s_i the corners of a sub-patch, t_j those of an occluder, both relative to x; u = 2^-53.
// The shaft is the pyramid over s_i, cut off by the plane of the source. An occluder is kept as linear forms
// L(d) = a . d - b, one per edge of its pyramid (b = 0) and one for its plane: the segment from x to d meets it exactly
// if every L(d) >= 0. So the same forms decide
//   outside   some L is negative at every s_i, or every t_j is beyond one side plane of the shaft;
//   cuts      every L is positive at every s_i: the patch is convex, so x sees no part of it;
// and test shadow rays. Only certain signs count: a culled occluder certainly meets no ray to the patch, and a cut is
// certain.
//
// Error of L: a = e x t with an edge e and a corner t, each within u a component, errs by at most 8u E T (E, T max
// norms) a component, and is at most 2 E T; with d exact and at most D, three products and their sum add less than
// 24u E T D each: 64u E T D = 2^-47 E T D covers both. The side planes of the shaft are the same with the roles of
// s and t exchanged.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "adaptive/sub_patch.h"

namespace exactff::adaptive {

// The side planes (x, s_i, s_i+1) of a sub-patch's shaft, pointing inward. By coordinate, as in SubPatch.
struct ShaftSides {
  alignas(32) double x[4];
  double y[4];
  double z[4];
  double error = 0.0;  // of inward . t over the max norm of t

  explicit ShaftSides(const SubPatch& s);
};

// A convex planar polygon as x sees it: counter-clockwise, its normal pointing away from x.
struct SeenPolygon {
  std::vector<Vec3> corners;  // relative to x
  std::vector<Vec3> edges;    // from each corner to the next
  Normal normal;

  // Corners in the opposite order.
  void reverse();
};

// The box around an occluder's corners.
struct SeenBox {
  Vec3 centre;
  Vec3 half;
  double size = 0.0;  // bounds the max norm of its points
};

enum class ShaftRelation { kOutside, kInDoubt, kCuts };

// A range of the stack of candidate lists.
struct CandidateRange {
  std::size_t first = 0;
  std::size_t last = 0;

  [[nodiscard]] std::size_t size() const { return last - first; }
  [[nodiscard]] bool empty() const { return first == last; }
};

// Occluders as x sees them, and the candidate lists of the recursion as one stack. Reused from receiver to receiver:
// clear() keeps the memory.
class OccluderSet {
 public:
  void clear();

  // `reach` must bound the max norm of every sub-patch in later calls.
  void add(const SeenPolygon& polygon, double reach);
  [[nodiscard]] std::size_t size() const { return occluders_.size(); }

  // A list of all occluders, or of those given.
  CandidateRange push_all();
  CandidateRange push(std::span<const std::uint32_t> indices);

  // Pushes the part of the parent's list that may lie in the shaft. Returns nullopt and pushes nothing if one candidate
  // cuts it.
  std::optional<CandidateRange> inherit(CandidateRange parent, const SubPatch& s, const ShaftSides& sides);
  void drop(CandidateRange list) { stack_.resize(list.first); }

  // The number of rays from x to `ends` that meet none of the listed occluders.
  [[nodiscard]] int count_visible(CandidateRange list, const RayEnds& ends) const;
  // Bit k: the ray to end first + k meets one, for k < RayEnds::kLanes. Requires a `first` that is a multiple of
  // kLanes.
  [[nodiscard]] unsigned hidden_lanes(CandidateRange list, const RayEnds& ends, int first) const;

 private:
  struct Form {
    double x, y, z, offset;
    double error;
  };
  struct Occluder {
    std::uint32_t first_form;
    std::uint32_t first_corner;
    std::uint32_t corner_count;  // one form more
  };

  [[nodiscard]] ShaftRelation relation(std::uint32_t index, const SubPatch& s, const ShaftSides& sides) const;
  [[nodiscard]] std::span<const Form> forms(const Occluder& o) const {
    return {forms_.data() + o.first_form, o.corner_count + 1};
  }
  [[nodiscard]] std::span<const Vec3> corners(const Occluder& o) const {
    return {corners_.data() + o.first_corner, o.corner_count};
  }

  std::vector<Occluder> occluders_;
  std::vector<Form> forms_;
  std::vector<Vec3> corners_;
  std::vector<std::uint32_t> stack_;
  std::vector<SeenBox> boxes_;
};

}  // namespace exactff::adaptive
