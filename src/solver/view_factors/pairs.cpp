// The view factor from patch i to patch j.
//
//   A_i F_ij = integral over patch i of F(x -> j) dA,   upper - lower <= accuracy for F_ij and for
//                                                       F_ji = A_i F_ij / A_j
//
// 1. Cut both patches into convex parts that do not overlap (prepared_patch.h), once for all of their factors.
// 2. Of the parts that may see each other (seen_parts.h), cut one of each pair into cells (refinement.cpp, pair.h), so
//    that all points of a cell see the same corners and edges of the other (cell_view.h). No cells: F_ij is 0, proved.
// 3. Integrate F(x -> j) over each cell by Gauss' rules, with an error: an estimate (pair.h), or a bound where
//    the factor is to be certified (certified_integral.h).
// 4. Refine: halve the cell of the largest error until the sum of the errors is small enough (refinement.h).
// 5. With very many occluders, cells may cost more than random points. So whenever the cells have cost twice as much as
//    before, points are taken as well, as far as they cost about the same: of the cells that are not known, and of
//    the whole patch (sampled_factor.h).
// 6. Divide by A_i. A_i F_ij = A_j F_ji gives the factor of the other direction.
//
// Source: see exactff/view_factors.h.
#include "view_factors/pairs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "scene/scene_copy.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "view_factors/cell.h"
#include "view_factors/disc_terms.h"
#include "view_factors/exact_scene.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/point_factors.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/refinement.h"
#include "view_factors/sampled_factor.h"
#include "view_factors/seen_parts.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {

// --- One view factor ---

namespace {

constexpr double kMostTimes = 4.0;          // the cells' effort, for analyses at the patch
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
  PointSearch(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to,
              const ViewFactorOptions& options)
      : from_(from),
        to_(to),
        turned_(is_symmetric(to, options) && has_better_points(to, from)),
        mean_(scene, turned_ ? to : from, turned_ ? from : to, kPointsOfBudget * options.budget,
              (turned_ ? to : from).unit_area / counted_area(from, to)) {}

  [[nodiscard]] const SampledMean& mean() const { return mean_; }
  // Until the factor is accurate, or the next analysis would take more than this effort of all analyses.
  void analyse(std::uint64_t effort, double accuracy) {
    while (!is_within(accuracy, factor(), from_, to_) && mean_.analyse(effort)) {
    }
  }
  void analyse_with_the_rest(double width, double accuracy) {
    if (is_within(accuracy, factor(), from_, to_)) return;
    mean_.analyse_with_the_rest(std::min(width, counted_width(factor(), from_, to_)));
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
// one: with it, cells and analyses go on where a larger one stops, but for analyses that cannot reach it; and if an
// entry that is made accurate by cells has left them out, none of them is narrower (SampledMean::may_reach).
class Search {
 public:
  Search(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to,
         const ViewFactorOptions& options, PairMemory& memory)
      : scene_(scene),
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
    sample_cells(cells_left);
    if (!is_accurate(at_cells_)) sample_patch(cells_left);
    return cells_left && !is_accurate(at_cells_) && !(points_ && is_accurate(points_->factor()));
  }

  // What all analyses have in common.
  void sample_cells(bool cells_left) {
    const auto is_enough = [&](const Disc& integral) {
      const Interval found = interval_of(integral);
      const double lower = std::max(found.lower, at_cells_.lower), upper = std::min(found.upper, at_cells_.upper);
      if (lower <= upper) {
        at_cells_.lower = lower;
        at_cells_.upper = upper;
      }
      return is_accurate(at_cells_);
    };
    points_at_cells_.analyse(cells_, cells_left ? cells_.effort() : kAnyEffort, is_enough);
    if (!cells_left && !is_enough(points_at_cells_.enclosure())) points_at_cells_.analyse_with_the_rest(cells_);
    (void)is_enough(points_at_cells_.enclosure());
  }

  void sample_patch(bool cells_left) {
    if (!points_) points_.emplace(scene_, from_, to_, options_);
    const SampledMean& mean = points_->mean();
    const std::uint64_t effort = cells_left ? effort_for_patch() : kAnyEffort;
    // At the end, analyses that were left out because they could not be accurate.
    if (cells_left && !mean.may_reach(options_.accuracy, effort)) return;
    points_->analyse(effort, options_.accuracy);
    if (!cells_left) points_->analyse_with_the_rest(counted(at_cells_), options_.accuracy);
  }

  // If cells become as many times narrower with each doubling of their effort, analyses at them need as many times
  // fewer points. That is the better choice if points of the patch take more than this.
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

namespace {

// F_ij, `from` being patch i and `to` patch j.
ViewFactor factor_between(const ExactScene& scene, const SeenParts& seen, const PreparedPatch& from,
                          const PreparedPatch& to, const ViewFactorOptions& options, PairMemory& memory) {
  return Search(scene, seen, from, to, options, memory).find();
}

}  // namespace

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

// --- Pairs ---

namespace {

void check_accuracy(double accuracy) {
  if (accuracy > 0.0 && std::isfinite(accuracy)) return;
  text::refuse("the accuracy of a view factor is " + text::shortest(accuracy), "it bounds an error",
               "give a positive number; the default is 1e-6");
}

using Key = std::pair<PatchId, std::optional<FaceId>>;
Key key_of(const Selection& selection) { return {selection.patch, selection.face}; }

// Whether a part of the one may see a part of the other.
bool sees_some_of(const SeenParts& seen, const PreparedPatch& from, const PreparedPatch& to) {
  for (std::size_t i = 0; i < from.parts.size(); ++i) {
    for (std::size_t j = 0; j < to.parts.size(); ++j) {
      if (!are_separated(seen, from, i, to, j) && from.seen.sees(seen, from.parts, i, to.parts[j])) return true;
    }
  }
  return false;
}

// The mean over the whole patch: nothing is seen from what is buried.
ViewFactor of_whole(ViewFactor f, const PreparedPatch& from, const PreparedPatch& to) {
  f.area_from = from.whole_area;
  f.area_to = to.whole_area;
  const kernel::Disc& share = from.exposed_share;
  if (f.claim == Claim::kZero || (share.centre == 1.0 && share.radius == 0.0)) return f;
  f.lower = std::clamp(lower_end(f.lower * share), 0.0, 1.0);
  f.upper = std::clamp(upper_end(f.upper * share), 0.0, 1.0);
  f.value = std::clamp(f.value * share.centre, f.lower, f.upper);
  return f;
}

}  // namespace

struct Pairs::Patches {
  // Selections of the given scene, in a copy of it.
  Patches(const Scene& given, std::span<const Selection> from, std::span<const Selection> to,
          std::span<const Columns> kinds)
      : moved(near_origin(given)), scene(moved ? *moved : given), seen(scene) {
    for (const Selection& patch : from) rows.push_back(prepare(given, patch, Columns::kPatches));
    for (std::size_t j = 0; j < to.size(); ++j) {
      columns.push_back(prepare(given, to[j], kinds.empty() ? Columns::kPatches : kinds[j]));
    }
  }

  const PreparedPatch* prepare(const Scene& given, const Selection& patch, Columns what) {
    (void)given.faces_of(patch);  // throws if it is of another scene
    std::unique_ptr<const PreparedPatch>& known = prepared[key_of(patch)];
    if (known == nullptr) {
      known = std::make_unique<const PreparedPatch>(scene, Selection{patch.patch, patch.face, scene.scene.id()}, what);
    }
    return known.get();
  }

  std::optional<Scene> moved;
  ExactScene scene;
  SeenParts seen;
  std::map<Key, std::unique_ptr<const PreparedPatch>> prepared;
  std::vector<const PreparedPatch*> rows, columns;
  mutable PairMemories memories;
};

Pairs::Pairs(const Scene& scene, std::span<const Selection> from, std::span<const Selection> to,
             const ViewFactorOptions& options, std::span<const Columns> kinds)
    : options_(options) {
  check_accuracy(options.accuracy);
  patches_ = std::make_unique<const Patches>(scene, from, to, kinds);
  std::map<std::pair<Key, Key>, std::size_t> known;
  for (std::size_t e = 0; e < from.size() * to.size(); ++e) {
    const Ends ends = ends_of(e);
    const auto [place, is_new] =
        known.try_emplace({key_of(ends.from->selection), key_of(ends.to->selection)}, entries_.size());
    if (is_new) entries_.emplace_back();
    entries_[place->second].push_back(e);
    pair_of_.push_back(place->second);
  }
}
Pairs::~Pairs() = default;

double Pairs::area_from(std::size_t row) const { return patches_->rows[row]->whole_area; }
double Pairs::area_to(std::size_t column) const { return patches_->columns[column]->whole_area; }
kernel::Disc Pairs::exposed_share(std::size_t row) const { return patches_->rows[row]->exposed_share; }

bool Pairs::is_enclosed(std::size_t row) const {
  const PreparedPatch& patch = *patches_->rows[row];
  return std::ranges::all_of(patch.seen.windings(patches_->seen, patch.parts), [&](const Windings& windings) {
    return patches_->seen.enclosures().are_around(windings);
  });
}

double Pairs::open_at_most(std::size_t row) const {
  const PreparedPatch& patch = *patches_->rows[row];
  const double open = view_factors::open_at_most(patches_->scene, patches_->seen.almost_closed(), patch.parts);
  return std::min(1.0, upper_end(kernel::Disc{open, 0.0} / patch.enclosed_area));
}

bool Pairs::is_within(std::size_t row, std::size_t surface) const {
  const PreparedPatch& patch = *patches_->rows[row];
  return std::ranges::all_of(patch.seen.windings(patches_->seen, patch.parts),
                             [&](const Windings& windings) { return windings[surface] && *windings[surface] != 0; });
}

bool Pairs::may_see(std::size_t row, std::size_t column) const {
  return sees_some_of(patches_->seen, *patches_->rows[row], *patches_->columns[column]);
}

double Pairs::unhidden(std::size_t row, std::size_t column) const {
  const PreparedPatch &from = *patches_->rows[row], &to = *patches_->columns[column];
  if (from.parts.empty()) return 0.0;
  return PatchBounds(patches_->scene, from, to).mean();
}

// Of two patches that may be exchanged, the one that comes first in the scene is seen from, whichever is asked for.
Pairs::Ends Pairs::ends_of(std::size_t entry) const {
  const std::size_t columns = patches_->columns.size();
  const PreparedPatch *const row = patches_->rows[entry / columns], *const column = patches_->columns[entry % columns];
  const bool turned = is_symmetric(*column, options_) && key_of(column->selection) < key_of(row->selection);
  return turned ? Ends{column, row, true} : Ends{row, column, false};
}

void Pairs::compute(std::size_t pair, const std::function<void(std::size_t, const ViewFactor&)>& take,
                    double finer) const {
  ViewFactorOptions options = options_;
  options.accuracy /= finer;
  const auto [from, to, turned] = ends_of(entries_[pair].front());
  // First what the row may see, which all of its entries ask for.
  const PreparedPatch &row = turned ? *to : *from, &column = turned ? *from : *to;
  std::unique_ptr<PairMemory> memory = patches_->memories.take();
  ViewFactor computed{.area_from = from->area, .area_to = to->area};
  if (sees_some_of(patches_->seen, row, column)) {
    computed = factor_between(patches_->scene, patches_->seen, *from, *to, options, *memory);
  }
  patches_->memories.give_back(std::move(memory));
  for (const std::size_t entry : entries_[pair]) {
    const bool is_turned = ends_of(entry).turned;
    take(entry, of_whole(is_turned ? transpose(computed, *from, *to) : computed, is_turned ? *to : *from,
                         is_turned ? *from : *to));
  }
}

}  // namespace exactff::view_factors

namespace exactff {

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
