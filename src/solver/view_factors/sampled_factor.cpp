#include "view_factors/sampled_factor.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <utility>

#include "exactff/exact.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "view_factors/certified_integral.h"
#include "view_factors/formula.h"
#include "view_factors/interim_analyses.h"
#include "view_factors/point_factors.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {
namespace {

struct Fragments {
  std::vector<Part> parts;
  std::vector<std::size_t> of;  // by fragment: the part
};

Fragments fragments_of(const ExactScene& scene, const std::vector<Part>& parts) {
  Fragments result;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    kernel::poll();
    std::ranges::move(cut_at_contacts(scene, parts[p]), std::back_inserter(result.parts));
    result.of.resize(result.parts.size(), p);
  }
  return result;
}

// F at points of a patch.
class FactorOfPatch : public SampledFunction {
 public:
  // Keeps a reference to the bounds.
  FactorOfPatch(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, PatchBounds& bounds)
      : FactorOfPatch(scene, to, bounds, fragments_of(scene, from.parts)) {}

  [[nodiscard]] double range(const Tile& tile) override {
    return bounds_.on(part_of_[tile.part], corners_of(parts()[tile.part], tile));
  }
  [[nodiscard]] std::optional<double> at(const Point& point, std::size_t part) override {
    std::optional<NearPlanes>& near = near_[part];
    if (!near) near.emplace(scene_, parts()[part]);
    return factors_.at(point, *near, source_);
  }
  [[nodiscard]] std::uint64_t effort() const override { return factors_.effort(); }

 private:
  FactorOfPatch(const ExactScene& scene, const PreparedPatch& to, PatchBounds& bounds, Fragments fragments)
      : SampledFunction(std::move(fragments.parts)),
        scene_(scene),
        part_of_(std::move(fragments.of)),
        source_(scene.scene, to.selection),
        near_(parts().size()),
        factors_(scene.scene),
        bounds_(bounds) {}

  const ExactScene& scene_;
  std::vector<std::size_t> part_of_;  // by fragment
  ExactSource source_;
  std::vector<std::optional<NearPlanes>> near_;  // made when asked for
  PointFactors factors_;
  PatchBounds& bounds_;
};

}  // namespace

class SampledMean::Analysing {
 public:
  Analysing(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, PatchBounds& bounds)
      : function_(scene, from, to, bounds), analyses(function_, scene.units, kRiskOfPatch, 0) {}

 private:
  FactorOfPatch function_;

 public:
  InterimAnalyses analyses;
};

SampledMean::SampledMean(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, std::size_t most,
                         double ratio)
    : scene_(scene),
      from_(from),
      to_(to),
      most_(std::max(most, kPointsOfFirstAnalysis)),
      ratio_(ratio),
      largest_(largest_factor(from, to)),
      bounds_(scene, from, to),
      range_(bounds_.mean()),
      known_{0.0, largest_},
      value_(0.5 * largest_),
      lower_(0.0),
      upper_(largest_) {}
SampledMean::~SampledMean() = default;

double SampledMean::least_width(double strata) const {
  return view_factors::least_width(range_, static_cast<std::size_t>(strata), kRiskOfPatch);
}

bool SampledMean::may_reach(double width, std::uint64_t effort) const {
  const std::uint64_t of_point = analysing_ ? analysing_->analyses.effort_of_point() : kLeastEffort;
  const double points = std::min(static_cast<double>(most_), static_cast<double>(effort / of_point));
  return points >= 2.0 && least_width(points / kDraws) * ratio_ <= width;
}

// The first one tells what the others are predicted from.
bool SampledMean::analyse(std::uint64_t effort) {
  if (analysing_ == nullptr) {
    analysing_ = std::make_unique<Analysing>(scene_, from_, to_, bounds_);
  } else if (!analysing_->analyses.prepare(next_width(width()) / ratio_, effort, most_)) {
    return false;
  }
  take_analysis();
  return true;
}

void SampledMean::analyse_with_the_rest(double width) {
  InterimAnalyses& analyses = analysing_->analyses;
  if (analyses.prepare_for_all(most_) && analyses.expected_width() * ratio_ < width) take_analysis();
}

// All analyses hold together, so what they have in common does, too. It is widened within what the factor can be.
void SampledMean::take_analysis() {
  const auto [value, error] = analysing_->analyses.analyse();
  const double lower = std::max(known_.lower, value - error), upper = std::min(known_.upper, value + error);
  if (lower <= upper) known_ = {lower, upper};
  const double strata = static_cast<double>(std::min(analysing_->analyses.strata(), most_ / kDraws));
  const double width = std::min(std::max(known_.upper - known_.lower, least_width(strata)), largest_);
  lower_ = std::clamp(0.5 * (known_.lower + known_.upper - width), 0.0, largest_ - width);
  upper_ = std::clamp(lower_ + width, known_.upper, largest_);
  lower_ = std::min(lower_, known_.lower);
  value_ = std::clamp(value, lower_, upper_);
}

// --- Sampled cells ---

namespace {

using kernel::Disc;

constexpr double kLeastLeft = 0.25;    // of a width, that points may have beside the cells that are known
constexpr double kShareOfFirst = 0.1;  // of the points that are needed, in the first analysis of a round
constexpr std::size_t kLeastRest = 10 * kPointsOfFirstAnalysis;

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

  [[nodiscard]] double range(const Tile& tile) override {
    const OfCell& cell = cells_[tile.part];
    if (cell.near != nullptr) return 1.0;
    OfPair& of = *cell.pair;
    if (!of.unhidden) of.unhidden.emplace(of.pair.sight());
    return cell.share_of(of.unhidden->on(corners_of(parts()[tile.part], tile)) - cell.mean);
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
  };
  struct OfCell {
    OfPair* pair;
    const Formula* near;
    double mean, bound;

    [[nodiscard]] double share_of(double excess) const { return std::clamp(0.5 * (excess + bound) / bound, 0.0, 1.0); }
  };

  void add(const Pair& pair, const Share& share) {
    std::unique_ptr<OfPair>& of = pairs_[&pair];
    if (of == nullptr) of = std::make_unique<OfPair>(pair);
    kernel::poll();
    const std::vector<Vec3> ring = positions_of(share.cell.corners);
    const double size = area(ring), mean = share.integral / size, bound = share.bound;
    cells_.push_back({of.get(), share.near.get(), mean, bound});
    const Disc exact_size{size, 2.0 * error_of_area(ring)};
    const Disc near =
        share.near != nullptr ? Disc{share.integral, std::max(0.0, share.error - bound * size)} : mean * exact_size;
    const double rounded = std::min(bound, kRoundedPoints) * 2.0;  // of a value, and of what it is compared with
    least_ = least_ + widened(near - bound * exact_size, rounded * magnitude(exact_size));
  }

  const ExactScene& scene_;
  std::map<const Pair*, std::unique_ptr<OfPair>> pairs_;
  std::vector<OfCell> cells_;  // by part
  PointFactors factors_;
  Disc least_;
};

// Analyses of the cells as they are at one pause.
class SampledCells::Round {
 public:
  Round(const ExactScene& scene, const Refinement::Apart& apart, std::size_t before, std::size_t first)
      : function_(scene, apart.unknown),
        unknown_(apart.times * weighted_area_of(function_.parts(), scene.units)),
        rest_(apart.known + apart.times * function_.least()),
        analyses_(function_, scene.units, kRiskOfCells, before, std::max(first, kPointsOfFirstAnalysis)) {}

  [[nodiscard]] InterimAnalyses& analyses() { return analyses_; }
  // For this radius of the integral.
  [[nodiscard]] bool prepare(double radius, std::uint64_t effort, std::size_t points) {
    return analyses_.prepare(2.0 * (radius - rest_.radius) / unknown_.centre, effort, points);
  }
  [[nodiscard]] bool prepare_for_all(std::size_t points) { return analyses_.prepare_for_all(points); }
  [[nodiscard]] double expected_radius() const {
    return rest_.radius + 0.5 * analyses_.expected_width() * unknown_.centre;
  }
  // The integral.
  [[nodiscard]] Disc analyse() {
    const InterimAnalyses::Mean mean = analyses_.analyse();
    const double lower = std::max(0.0, mean.value - mean.error), upper = std::min(1.0, mean.value + mean.error);
    return Disc{0.5 * (lower + upper), 0.5 * (upper - lower) + kRoundedPoints} * unknown_ + rest_;
  }

 private:
  FactorOfCells function_;
  Disc unknown_, rest_;  // of the integral: what it may be more than the rest
  InterimAnalyses analyses_;
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
  for (const Refinement::Unknown& cell : apart.unknown) range += 2.0 * apart.times * cell.share->error;
  const double wanted = next_radius(), left = wanted - apart.known.radius;
  return range > 0.0 && left > kLeastLeft * wanted ? points_for(range, 2.0 * left, kRiskOfCells) : HUGE_VAL;
}

void SampledCells::analyse(const Refinement& cells, std::uint64_t effort,
                           const std::function<bool(const Disc&)>& is_enough) {
  if (cells.enclosure().radius < narrowest_.radius) narrowest_ = cells.enclosure();
  const Refinement::Apart apart = cells.apart();
  const double most =
      std::min(static_cast<double>(points_left()), static_cast<double>(effort) / static_cast<double>(effort_of_point_));
  const double fewest = fewest_points(apart);
  const std::size_t points = points_left();
  if (!(fewest <= most) || points < kPointsOfFirstAnalysis) return;
  const double first = analyses_ == 0 ? 0.0 : kShareOfFirst * fewest;  // at first, what a point takes is an estimate
  Round round(scene_, apart, analyses_, static_cast<std::size_t>(first));
  take_analysis(round);
  while (!is_enough(narrowest_) && round.prepare(next_radius(), effort, points)) take_analysis(round);
}

void SampledCells::analyse_with_the_rest(const Refinement& cells) {
  const Refinement::Apart apart = cells.apart();
  const std::size_t points = points_left();
  if (apart.unknown.empty() || points < kLeastRest) return;
  Round round(scene_, apart, analyses_, static_cast<std::size_t>(kShareOfFirst * static_cast<double>(points)));
  take_analysis(round);
  if (round.prepare_for_all(points) && round.expected_radius() < narrowest_.radius) take_analysis(round);
}

void SampledCells::take_analysis(Round& round) {
  const std::size_t before = round.analyses().points();
  const Disc integral = round.analyse();
  if (integral.radius < narrowest_.radius) narrowest_ = integral;
  analyses_ = round.analyses().count();
  points_ += round.analyses().points() - before;
  effort_of_point_ = std::max(kLeastEffort, round.analyses().effort_of_point());
}

}  // namespace exactff::view_factors
