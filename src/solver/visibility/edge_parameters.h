// Points of an edge as the edge engine knows them: by a double with an error bound, and exactly where that is not
// enough.
#pragma once

#include <cmath>
#include <deque>
#include <vector>

#include "visibility/boundary_piece.h"
#include "visibility/outlines.h"

namespace exactff::visibility {

// A parameter (l : m) of an edge (outlines.h), with a and b scaled like their doubles: one of the edge's ends, or the
// crossing with the line of another edge. m / (l + m) lies within `error` of `value`.
struct Parameter {
  static constexpr EdgeId kAtBegin = 0xFFFFFFFEU, kAtEnd = 0xFFFFFFFFU;
  double value = 0.0;
  float error = 0.0F;
  EdgeId line = kAtBegin;  // the line that crosses
};

// The error of a crossing's parameter as a float. It exceeds the double by enough that the sum of two, rounded as
// floats, is no less than the sum of the doubles. It is at least 2^-50 and so a normal float; an infinite error decides
// nothing in either case.
inline float rounded_up(double error) { return static_cast<float>(error * (1.0 + 0x1p-20)); }

// Exact parameters, each computed at first use. Equal lines must have equal ids.
class ExactParameters {
 public:
  // Forgets all parameters, in the existing memory.
  void clear(std::size_t edges) {
    count_ = 0;
    grow(edges);
  }
  // Makes room for edges that were added since.
  void grow(std::size_t edges) { stored_at_.resize(4 * edges); }

  [[nodiscard]] const EdgeParameter& of(Outlines& outlines, EdgeId edge, const Parameter& p);
  // Where the line crosses the edge.
  [[nodiscard]] const EdgeParameter& crossing(Outlines& outlines, EdgeId edge, EdgeId line);
  // -1, 0, +1: p before, at, after q.
  [[nodiscard]] int compare(Outlines& outlines, EdgeId edge, const Parameter& p, const Parameter& q);

 private:
  struct Stored {
    EdgeId edge = 0, line = 0;
    EdgeParameter parameter;
  };

  std::deque<Stored> stored_;  // the first count_; the rest is spare memory
  std::size_t count_ = 0;
  std::vector<std::uint32_t> stored_at_;  // into stored_, for every line and four edges; may be stale or another edge's
  kernel::Integer product_p_, product_q_;  // scratch
};

}  // namespace exactff::visibility
