#include "view_factors/sampled_cells.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/poll.h"
#include "view_factors/certified_integral.h"
#include "view_factors/factor_bound.h"
#include "view_factors/formula.h"
#include "view_factors/looks.h"
#include "view_factors/near_planes.h"
#include "view_factors/point_factors.h"
#include "view_factors/slope_bound.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {
namespace {

using kernel::Disc;

constexpr double kLeastLeft = 0.25;    // of a width, that points may have beside the cells that are known
constexpr double kShareOfFirst = 0.1;  // of the points that are needed, in the first look of a round
constexpr std::size_t kLeastRest = 10 * kPointsOfFirstLook;

Part part_of(const Pair& pair, const std::vector<Point>& corners, double weight) {
  return {.face = pair.receiver_face(), .corners = corners, .is_cut = true, .weight = weight};
}

std::vector<Part> parts_of(const std::vector<Refinement::Unknown>& cells) {
  std::vector<Part> parts;
  for (const Refinement::Unknown& cell : cells) {
    parts.push_back(part_of(*cell.pair, cell.share->cell.corners, 2.0 * cell.share->bound));
  }
  return parts;
}

Disc weighted_area_of(const std::vector<Part>& parts, const Units& units) {
  Disc sum;
  for (const Part& part : parts) sum = sum + part.weight * enclosed_area_of({part}, units);
  return sum;
}

}  // namespace

// By how much the point factor to the pair's source exceeds what it is at least, as far as the cell knows, as a share
// of what that may be. Weighted by that, strata of the same size hold equal amounts of what is unknown.
class SampledCells::FactorOfCells : public SampledFunction {
 public:
  FactorOfCells(const ExactScene& scene, const std::vector<Refinement::Unknown>& cells)
      : SampledFunction(parts_of(cells)), scene_(scene), factors_(scene.scene) {
    for (const Refinement::Unknown& cell : cells) add(*cell.pair, *cell.share);
  }

  // The integral of what it is at least.
  [[nodiscard]] const Disc& least() const { return least_; }

  [[nodiscard]] Span span(const Tile& tile, bool is_alone) override {
    const OfCell& cell = cells_[tile.part];
    if (cell.near != nullptr) return {};
    OfPair& of = *cell.pair;
    if (!of.unhidden) of.unhidden.emplace(of.pair.sight());
    const double most = of.unhidden->on(corners_of(parts()[tile.part], tile));
    Span span{.range = cell.share_of(most - cell.mean)};
    if (is_alone) span.change = cell.change_of(largest_change(of, tile, span.range * cell.bound));
    return span;
  }
  [[nodiscard]] std::optional<double> at(const Point& point, std::size_t part) override {
    const OfCell& cell = cells_[part];
    OfPair& of = *cell.pair;
    if (!of.near_planes) of.near_planes.emplace(scene_, part_of(of.pair, of.pair.sight().root.corners, 1.0));
    const std::optional<double> factor = factors_.at(point, *of.near_planes, *of.pair.whole());
    if (!factor) return std::nullopt;
    const Evaluated near = cell.near != nullptr ? cell.near->at(point.at) : Evaluated{cell.mean, 0.0};
    if (near.rounding > kRoundedPoints) return std::nullopt;
    return cell.share_of(*factor - near.value);
  }
  [[nodiscard]] std::uint64_t effort() const override { return factors_.effort(); }

 private:
  struct OfPair {
    explicit OfPair(const Pair& of) : pair(of) {}
    const Pair& pair;
    std::optional<NearPlanes> near_planes;  // all made when asked for
    std::optional<UnhiddenBound> unhidden;
    std::optional<SlopeBound> slope;
  };
  struct OfCell {
    OfPair* pair;
    const Formula* near;
    double mean, bound;

    [[nodiscard]] double share_of(double excess) const { return std::clamp(0.5 * (excess + bound) / bound, 0.0, 1.0); }
    [[nodiscard]] double change_of(double change) const { return 0.5 * change / bound; }
  };

  // Of the point factor. Infinite if it would be more than `most`.
  [[nodiscard]] double largest_change(OfPair& of, const Tile& tile, double most) {
    if (!of.slope && pieces_ > SlopeBound::kMostPieces) return HUGE_VAL;
    if (!of.slope) {
      of.slope.emplace(of.pair.sight());
      pieces_ += of.slope->pieces();
    }
    return of.slope->change_on(reach_of(parts()[tile.part], tile), most) + 2.0 * kRoundedPoints;
  }

  void add(const Pair& pair, const Share& share) {
    std::unique_ptr<OfPair>& of = pairs_[&pair];
    if (of == nullptr) of = std::make_unique<OfPair>(pair);
    kernel::poll();
    const double size = area(share.cell), mean = share.integral / size, bound = share.bound;
    cells_.push_back({of.get(), share.near.get(), mean, bound});
    const Disc exact_size = enclosed_area(share.cell, pair.sight().receiver);
    const Disc near =
        share.near != nullptr ? Disc{share.integral, std::max(0.0, share.error - bound * size)} : mean * exact_size;
    const double rounded = std::min(bound, kRoundedPoints) * 2.0;  // of a value, and of what it is compared with
    least_ = least_ + widened(near - bound * exact_size, rounded * magnitude(exact_size));
  }

  const ExactScene& scene_;
  std::map<const Pair*, std::unique_ptr<OfPair>> pairs_;
  std::vector<OfCell> cells_;  // by part
  std::size_t pieces_ = 0;     // of all slopes
  PointFactors factors_;
  Disc least_;
};

// Looks at the cells as they are at one pause.
class SampledCells::Round {
 public:
  Round(const ExactScene& scene, const Refinement::Apart& apart, std::size_t before, std::size_t first)
      : function_(scene, apart.unknown),
        unknown_(weighted_area_of(function_.parts(), scene.units)),
        rest_(apart.known + function_.least()),
        looks_(function_, scene.units, kRiskOfCells, before, std::max(first, kPointsOfFirstLook)) {}

  [[nodiscard]] Looks& looks() { return looks_; }
  // For this radius of the integral.
  [[nodiscard]] bool prepare(double radius, std::uint64_t effort, std::size_t points) {
    return looks_.prepare(2.0 * (radius - rest_.radius) / unknown_.centre, effort, points);
  }
  [[nodiscard]] bool prepare_for_all(std::size_t points) { return looks_.prepare_for_all(points); }
  [[nodiscard]] double expected_radius() const {
    return rest_.radius + 0.5 * looks_.expected_width() * unknown_.centre;
  }
  // The integral.
  [[nodiscard]] Disc look() {
    const Looks::Mean mean = looks_.look();
    const double lower = std::max(0.0, mean.value - mean.error), upper = std::min(1.0, mean.value + mean.error);
    return Disc{0.5 * (lower + upper), 0.5 * (upper - lower) + kRoundedPoints} * unknown_ + rest_;
  }

 private:
  FactorOfCells function_;
  Disc unknown_, rest_;  // of the integral: what it may be more than the rest
  Looks looks_;
};

SampledCells::SampledCells(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to,
                           std::size_t most)
    : scene_(scene),
      smaller_area_(counted_area(from, to)),
      most_(most),
      effort_of_point_(kLeastEffort),
      narrowest_(kernel::widened(0.5 * from.enclosed_area, 0.5 * magnitude(from.enclosed_area))) {}

double SampledCells::next_radius() const {
  return 0.5 * smaller_area_ * next_width(2.0 * narrowest_.radius / smaller_area_);
}

double SampledCells::fewest_points(const Refinement::Apart& apart) const {
  double range = 0.0;
  for (const Refinement::Unknown& cell : apart.unknown) range += 2.0 * cell.share->error;
  const double wanted = next_radius(), left = wanted - apart.known.radius;
  return range > 0.0 && left > kLeastLeft * wanted ? points_for(range, 2.0 * left, kRiskOfCells) : HUGE_VAL;
}

void SampledCells::look(const Refinement& cells, std::uint64_t effort,
                        const std::function<bool(const Disc&)>& is_enough) {
  if (cells.enclosure().radius < narrowest_.radius) narrowest_ = cells.enclosure();
  const Refinement::Apart apart = cells.apart();
  const double most =
      std::min(static_cast<double>(points_left()), static_cast<double>(effort) / static_cast<double>(effort_of_point_));
  const double fewest = fewest_points(apart);
  const std::size_t points = points_left();
  if (!(fewest <= most) || points < kPointsOfFirstLook) return;
  const double first = looks_ == 0 ? 0.0 : kShareOfFirst * fewest;  // at first, what a point takes is a guess
  Round round(scene_, apart, looks_, static_cast<std::size_t>(first));
  take_look(round);
  while (!is_enough(narrowest_) && round.prepare(next_radius(), effort, points)) take_look(round);
}

void SampledCells::look_with_the_rest(const Refinement& cells) {
  const Refinement::Apart apart = cells.apart();
  const std::size_t points = points_left();
  if (apart.unknown.empty() || points < kLeastRest) return;
  Round round(scene_, apart, looks_, static_cast<std::size_t>(kShareOfFirst * static_cast<double>(points)));
  take_look(round);
  if (round.prepare_for_all(points) && round.expected_radius() < narrowest_.radius) take_look(round);
}

void SampledCells::take_look(Round& round) {
  const std::size_t before = round.looks().points();
  const Disc integral = round.look();
  if (integral.radius < narrowest_.radius) narrowest_ = integral;
  looks_ = round.looks().count();
  points_ += round.looks().points() - before;
  effort_of_point_ = std::max(kLeastEffort, round.looks().effort_of_point());
}

}  // namespace exactff::view_factors
