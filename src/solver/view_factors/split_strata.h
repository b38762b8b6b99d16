// Strata that are split where a function may be large, or differs from what is guessed of it, so that its mean is known
// best for a number of points.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

#include "view_factors/strata.h"

namespace exactff::view_factors {

// Of a change, that a number and its guess may differ by, since guesses change, too.
inline constexpr double kOverChange = 1.25;

// Proved of a function on a tile.
struct Span {
  double range = 1.0;        // it lies in [0, range]
  double change = HUGE_VAL;  // it is within this of what it is at the middle
};

class SplitStrata {
 public:
  // The change is needed only of a tile that is alone in its stratum.
  using SpanOf = std::function<Span(const Tile& tile, bool is_alone)>;

  // Begins with about `count` strata of the same area. Keeps a reference to the parts.
  SplitStrata(const std::vector<Part>& parts, std::size_t count, SpanOf span);

  [[nodiscard]] const Strata& strata() const { return strata_; }
  // Two numbers are taken for each: at two random places or, where that leaves less to chance, at the middle and at one
  // random place.
  [[nodiscard]] bool is_by_middle(std::size_t stratum) const { return known_[stratum].is_by_middle(); }
  [[nodiscard]] const Span& span(std::size_t stratum) const { return known_[stratum].span; }
  // r of stratified_mean.h.
  [[nodiscard]] double largest_term() const { return by_term_.front().size; }
  // What its terms are expected to add to Q: what was set for the stratum that it was split from, and less with each
  // split.
  void set_square(std::size_t stratum, double square);
  [[nodiscard]] double largest_square() const { return by_square_.empty() ? 0.0 : by_square_.front().size; }
  [[nodiscard]] double sum_of_squares() const { return sum_of_squares_; }

  // Cuts the stratum of the largest term or square: in two, but a triangle in three. False if it is too small.
  bool split_largest_term() { return split(by_term_); }
  bool split_largest_square() { return split(by_square_); }

 private:
  struct Known {
    Span span;
    double square = 0.0;
    std::size_t version = 0;

    [[nodiscard]] bool is_by_middle() const;
    [[nodiscard]] double term() const;
  };
  struct Waiting {
    double size;
    std::size_t stratum, version;
  };
  using Heap = std::vector<Waiting>;

  [[nodiscard]] static bool is_less_urgent(const Waiting& a, const Waiting& b);
  [[nodiscard]] double share(std::size_t stratum) const { return strata_.strata[stratum].area / strata_.area; }
  [[nodiscard]] Span span_of(const Stratum& stratum) const;
  void push(Heap& heap, double size, std::size_t stratum);
  void drop_old(Heap& heap) const;
  [[nodiscard]] bool split(Heap& heap);
  [[nodiscard]] static Known part_of(const Known& known, double share);
  void put(std::size_t place, const Stratum& stratum, const Known& of_whole);
  void share_out(const Stratum& whole, const Known& known, std::size_t place);
  void cut(const Tile& tile, const Known& known, std::size_t place);

  const std::vector<Part>& parts_;
  SpanOf span_;
  Strata strata_;
  std::vector<Known> known_;  // by stratum
  double sum_of_squares_ = 0.0;
  Heap by_term_, by_square_;  // the largest first; with old versions of strata, but never in front
};

}  // namespace exactff::view_factors
