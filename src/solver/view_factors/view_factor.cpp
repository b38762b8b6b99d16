// The view factor from patch i to patch j.
//
//   A_i F_ij = integral over patch i of F(x -> j) dA,   upper - lower <= accuracy for F_ij and for
//                                                       F_ji = A_i F_ij / A_j
//
// 1. Cut both patches into convex parts that do not overlap (patch_parts.h), once for all of their factors.
// 2. Of the parts that may see each other (seen_parts.h), cut one of each pair into cells (pair_choice.h, pair.h), so
//    that all points of a cell see the same corners and edges of the other (cell_view.h). No cells: F_ij is 0, proved.
// 3. Integrate F(x -> j) over each cell by Gauss' rules, with an error: an estimate (quadrature.h), or a bound where
//    the factor is to be certified (certified_integral.h).
// 4. Refine: halve the cell of the largest error until the sum of the errors is small enough (refinement.h).
// 5. In a crowd of occluders, cells may cost more than random points. So whenever the cells have cost twice as much as
//    before, points are taken as well, as far as they cost about the same: of the cells that are not known
//    (sampled_cells.h), and of the whole patch (sampled_factor.h).
// 6. Divide by A_i. A_i F_ij = A_j F_ji gives the factor of the other direction.
//
// Source: see exactff/view_factors.h.
#include "view_factors/view_factor.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "exactff/view_factors.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "view_factors/disc_space.h"
#include "view_factors/near_planes.h"
#include "view_factors/pair_memory.h"
#include "view_factors/pairs.h"
#include "view_factors/patch_parts.h"
#include "view_factors/refinement.h"
#include "view_factors/sampled_cells.h"
#include "view_factors/sampled_factor.h"

namespace exactff {
namespace view_factors {
namespace {

constexpr double kMostTimes = 4.0;          // the cells' effort, for looks at the patch
constexpr std::size_t kPointsOfBudget = 4;  // for a cell of the limit, which costs more than these
constexpr std::uint64_t kAnyEffort = std::uint64_t{1} << 62;

// Of a factor that is at most `most`, within it.
struct Interval {
  double lower, upper;
};

Interval interval_of(const Disc& f, double most) {
  if (!is_finite(f)) return {0.0, most};
  return {std::clamp(lower_end(f), 0.0, most), std::clamp(upper_end(f), 0.0, most)};
}

double width_of(const ViewFactor& f) { return f.upper - f.lower; }

// The larger one of both directions, if both count.
double counted_width(const ViewFactor& f, const PreparedPatch& from, const PreparedPatch& to) {
  return width_of(f) * from.unit_area / counted_area(from, to);
}

bool is_within(double accuracy, const ViewFactor& f, const PreparedPatch& from, const PreparedPatch& to) {
  return counted_width(f, from, to) <= accuracy;
}

ViewFactor unknown_factor(const PreparedPatch& from, const PreparedPatch& to) {
  const double most = largest_factor(from, to);
  return {.value = 0.5 * most, .upper = most, .area_from = from.area, .area_to = to.area, .claim = Claim::kEstimated};
}

// Of two patches, whether points on the first one tell more of their factor for the same effort. The error of a mean
// over the larger one counts as many times as it is larger, but F is as many times smaller there on average. A point
// that sees many parts costs more.
bool has_better_points(const PreparedPatch& one, const PreparedPatch& other) {
  if (one.parts.size() != other.parts.size()) return one.parts.size() > other.parts.size();
  return one.unit_area < other.unit_area;
}

class PointSearch {
 public:
  PointSearch(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to,
              const ViewFactorOptions& options)
      : from_(from),
        to_(to),
        turned_(is_symmetric(to, options) && has_better_points(to, from)),
        mean_(scene, seen, turned_ ? to : from, turned_ ? from : to, kPointsOfBudget * options.budget,
              (turned_ ? to : from).unit_area / counted_area(from, to)) {}

  [[nodiscard]] const SampledMean& mean() const { return mean_; }
  // Until the factor is accurate, or the next look would take more than this effort of all looks.
  void look(std::uint64_t effort, double accuracy) {
    while (!is_within(accuracy, factor(), from_, to_) && mean_.look(effort)) {
    }
  }
  void look_with_the_rest(double width, double accuracy) {
    if (is_within(accuracy, factor(), from_, to_)) return;
    mean_.look_with_the_rest(std::min(width, counted_width(factor(), from_, to_)));
  }

  // The narrowest so far.
  [[nodiscard]] ViewFactor factor() const {
    ViewFactor f = turned_ ? unknown_factor(to_, from_) : unknown_factor(from_, to_);
    f.way = Way::kPoints;
    f.value = mean_.value();
    f.lower = mean_.lower();
    f.upper = mean_.upper();
    return turned_ ? transpose(f, to_, from_) : f;
  }

 private:
  const PreparedPatch& from_;
  const PreparedPatch& to_;
  bool turned_;
  SampledMean mean_;
};

// By cells and, where these cost more, by points. Each goes on in its own way whatever the accuracy is, and the
// narrowest interval is the result, as it is within what the factor can be. A smaller accuracy never yields a wider
// one: with it, cells and looks go on where a larger one stops, but for looks that cannot reach it; and if an entry
// that is made accurate by cells has left them out, none of them is narrower (SampledMean::may_reach).
class Search {
 public:
  Search(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to,
         const ViewFactorOptions& options, PairMemory& memory)
      : scene_(scene),
        seen_(seen),
        from_(from),
        to_(to),
        options_(options),
        cells_(scene, seen, from, to, options, memory),
        points_at_cells_(scene, from, to, kPointsOfBudget * options.budget),
        most_(largest_factor(from, to)),
        by_cells_(unknown_factor(from, to)),
        at_cells_(by_cells_) {}

  ViewFactor find() {
    do {
      refine();
    } while (!is_done() && go_on());
    return result();
  }

 private:
  void refine() {
    if (cells_.is_zero()) return;
    cells_.refine([&](const Disc& integral) {
      const Interval found = interval_of(integral);
      if (found.upper - found.lower < width_of(by_cells_)) {
        by_cells_.lower = found.lower;
        by_cells_.upper = found.upper;
      }
      return is_accurate(by_cells_);
    });
  }
  [[nodiscard]] Interval interval_of(const Disc& integral) const {
    return view_factors::interval_of(integral / from_.enclosed_area, most_);
  }
  [[nodiscard]] double counted(const ViewFactor& f) const { return counted_width(f, from_, to_); }
  [[nodiscard]] bool is_accurate(const ViewFactor& f) const { return is_within(options_.accuracy, f, from_, to_); }
  [[nodiscard]] bool is_done() const { return cells_.is_zero() || is_accurate(by_cells_); }

  // False if nothing more can or need be done.
  bool go_on() {
    const bool cells_left = cells_.go_on();
    if (options_.certify || !options_.sample_crowds) return cells_left;
    narrowing_ = std::exchange(last_width_, counted(by_cells_)) / counted(by_cells_);
    look_at_cells(cells_left);
    if (!is_accurate(at_cells_)) look_at_patch(cells_left);
    return cells_left && !is_accurate(at_cells_) && !(points_ && is_accurate(points_->factor()));
  }

  // What all looks have in common.
  void look_at_cells(bool cells_left) {
    const auto is_enough = [&](const Disc& integral) {
      const Interval found = interval_of(integral);
      const double lower = std::max(found.lower, at_cells_.lower), upper = std::min(found.upper, at_cells_.upper);
      if (lower <= upper) {
        at_cells_.lower = lower;
        at_cells_.upper = upper;
      }
      return is_accurate(at_cells_);
    };
    points_at_cells_.look(cells_, cells_left ? cells_.effort() : kAnyEffort, is_enough);
    if (!cells_left && !is_enough(points_at_cells_.enclosure())) points_at_cells_.look_with_the_rest(cells_);
    (void)is_enough(points_at_cells_.enclosure());
  }

  void look_at_patch(bool cells_left) {
    if (!points_) points_.emplace(scene_, seen_, from_, to_, options_);
    const SampledMean& mean = points_->mean();
    const std::uint64_t effort = cells_left ? effort_for_patch() : kAnyEffort;
    // At the end, looks that were left out because they could not be accurate.
    if (cells_left && !mean.may_reach(options_.accuracy, effort)) return;
    points_->look(effort, options_.accuracy);
    if (!cells_left) points_->look_with_the_rest(counted(at_cells_), options_.accuracy);
  }

  // If cells become as many times narrower with each doubling of their effort, looks at them need as many times fewer
  // points. That is the better choice if points of the patch take more than this.
  [[nodiscard]] std::uint64_t effort_for_patch() const {
    const double times = narrowing_ > 1.0 ? narrowing_ / (narrowing_ - 1.0) : kMostTimes;
    return static_cast<std::uint64_t>(std::min(times, kMostTimes) * static_cast<double>(cells_.effort()));
  }

  [[nodiscard]] ViewFactor result() const {
    ViewFactor result = by_cells_;
    if (cells_.is_zero()) {
      result = {.area_from = from_.area, .area_to = to_.area};
    } else if (points_ && width_of(points_->factor()) < std::min(width_of(by_cells_), width_of(at_cells_))) {
      result = points_->factor();
    } else if (width_of(at_cells_) < width_of(by_cells_)) {
      result = at_cells_;
      result.way = Way::kPoints;
      result.value = std::clamp(points_at_cells_.enclosure().centre / from_.unit_area, result.lower, result.upper);
    } else {
      result.claim = options_.certify ? Claim::kCertified : Claim::kEstimated;
      result.value = std::clamp(cells_.estimate() / from_.unit_area, result.lower, result.upper);
    }
    result.accurate = cells_.is_zero() || is_accurate(result);
    if (!result.accurate) result.limit = result.way == Way::kPoints ? Limit::kBudget : cells_.limit();
    result.cells = cells_.cells();
    result.event_cells = cells_.event_cells();
    return result;
  }

  const ExactScene& scene_;
  const SeenParts& seen_;
  const PreparedPatch& from_;
  const PreparedPatch& to_;
  const ViewFactorOptions& options_;
  Refinement cells_;
  SampledCells points_at_cells_;
  double most_;                        // that the factor can be
  std::optional<PointSearch> points_;  // from the first pause on
  ViewFactor by_cells_, at_cells_;     // their intervals
  double last_width_ = 1.0;            // of the cells at the pause before
  double narrowing_ = 1.0;             // of the cells since then
};

}  // namespace

bool is_symmetric(const PreparedPatch& column, const ViewFactorOptions& options) {
  return are_reciprocal(column) && !options.both_directions;
}

ViewFactor factor_between(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                          const PreparedPatch& to, const ViewFactorOptions& options, PairMemory& memory) {
  return Search(scene, seen, from, to, options, memory).find();
}

ViewFactor transpose(const ViewFactor& f, const PreparedPatch& from, const PreparedPatch& to) {
  ViewFactor result = f;
  std::swap(result.area_from, result.area_to);
  if (f.claim == Claim::kZero) return result;
  const Disc ratio = from.enclosed_area / to.enclosed_area;
  const double most = largest_factor(to, from);
  result.lower = interval_of(f.lower * ratio, most).lower;
  result.upper = interval_of(f.upper * ratio, most).upper;
  result.value = std::clamp(f.value * (from.unit_area / to.unit_area), result.lower, result.upper);
  return result;
}

}  // namespace view_factors

std::string_view to_string(Claim claim) {
  switch (claim) {
    case Claim::kEstimated:
      return "estimated";
    case Claim::kCertified:
      return "certified";
    case Claim::kZero:
      return "zero";
  }
  return {};
}

std::string_view to_string(Way way) {
  switch (way) {
    case Way::kCells:
      return "cells";
    case Way::kPoints:
      return "points";
  }
  return {};
}

std::string_view to_string(Limit limit) {
  switch (limit) {
    case Limit::kNone:
      return "none";
    case Limit::kBudget:
      return "budget";
    case Limit::kCrowd:
      return "crowd";
    case Limit::kRounding:
      return "rounding";
  }
  return {};
}

ViewFactor view_factor(const Scene& scene, const Selection& from, const Selection& to,
                       const ViewFactorOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  const view_factors::Pairs pair(scene, {&from, 1}, {&to, 1}, options);
  kernel::poll();
  ViewFactor result;
  pair.compute(0, [&](std::size_t, const ViewFactor& f) { result = f; });
  return result;
}

}  // namespace exactff
