#include "view_factors/sampled_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "kernel/poll.h"
#include "view_factors/factor_bound.h"
#include "view_factors/near_planes.h"
#include "view_factors/split_strata.h"
#include "view_factors/strata.h"
#include "view_factors/stratified_mean.h"

namespace exactff::view_factors {
namespace {

constexpr std::size_t kPointsOfStratum = kDraws;
constexpr std::size_t kFirstStrata = kPointsOfFirstLook / kPointsOfStratum;
static_assert(kFirstStrata >= kFewestStrata);
constexpr double kOfExpected = 0.95;     // of a width: what is expected is a little less
constexpr double kNarrower = 0.1;        // than the look before
constexpr double kLeastOfWidths = 0.75;  // of the width that is expected if F is the same in every stratum
constexpr double kDecay = 1.5;           // of the square of a mean: the exponent of the number of strata
constexpr double kCaution = 1.4;         // so much more is expected than predicted
constexpr double kFirstSquare = 2.0;     // what the first look expects, in squares of the range

constexpr std::size_t kPointsOfSplit = 2 * kPointsOfStratum;  // more after a split than before, at most

// About what they take (Pair::effort), measured in crowds.
constexpr std::uint64_t kEffortOfPoint = 100, kEffortOfPlane = 125, kEffortOfCandidate = 15, kEffortOfEdges = 2;

double risk_of(std::size_t look) { return kRisk / static_cast<double>(look * (look + 1)); }

// F at exact points of a patch. Nothing where rounding matters.
class PointFactors {
 public:
  PointFactors(const ExactScene& scene, const std::vector<Part>& from, const Selection& to)
      : scene_(scene), from_(from), source_(scene.scene, to), near_(from.size()) {}

  std::optional<double> at(const Point& point, std::size_t part) {
    std::optional<NearPlanes>& near = near_[part];
    if (!near) near.emplace(scene_, from_[part]);
    const std::optional<Vec3> rounded = near->round(point);
    if (!rounded) return std::nullopt;
    exact_form_factor(scene_.scene, {.point = *rounded, .normal = near->normal(), .on = near->own(), .id = {}}, source_,
                      {}, factor_, workspace_);
    effort_ += kEffortOfPoint;
    for (const PlaneRecord& plane : factor_.planes) {
      effort_ += kEffortOfPlane + kEffortOfCandidate * plane.tree_candidates + kEffortOfEdges * plane.pairs;
    }
    return factor_.value;
  }
  // So far, as of Pair::effort.
  [[nodiscard]] std::uint64_t effort() const { return effort_; }

 private:
  const ExactScene& scene_;
  const std::vector<Part>& from_;
  ExactSource source_;
  std::vector<std::optional<NearPlanes>> near_;  // made when asked for
  FormFactor factor_;
  Workspace workspace_;
  std::uint64_t effort_ = 0;
};

// The largest F if nothing hides any of the source.
class LargestFactors {
 public:
  LargestFactors(const ExactScene& scene, const std::vector<Part>& from, const std::vector<Part>& to)
      : units_(scene.units), from_(from), to_(to), bounds_(from.size()) {}

  // From every point of the tile.
  double on(const Tile& tile) { return on(tile.part, corners_of(from_[tile.part], tile, units_)); }
  // From every point of the convex hull of these points of a part.
  double on(std::size_t part, std::span<const Vec3> corners) {
    if (to_.size() > kMostParts) return 1.0;
    if (bounds_[part].empty()) prepare(part);
    double sum = 0.0;
    for (const OfPart& of : bounds_[part]) {
      sum += std::min(of.by_distance.on(corners), of.open.on(corners));
      if (sum >= 1.0) return 1.0;
    }
    return std::min(1.0, sum * kSum);
  }

 private:
  struct OfPart {
    FactorBound by_distance;
    OpenFactorBound open;
  };
  static constexpr std::size_t kMostParts = 256;  // of more, F is only known to be at most 1
  static constexpr double kSum = 1.0 + 0x1p-40;   // more than the roundings of the sum

  void prepare(std::size_t part) {
    const Plane receiver = plane_of(from_[part], units_);
    for (const Part& source : to_) {
      const std::vector<Vec3> corners = positions_of(source.corners);
      bounds_[part].push_back({{corners, plane_of(source, units_), receiver}, {corners, receiver}});
    }
  }

  const Units& units_;
  const std::vector<Part>&from_, &to_;
  std::vector<std::vector<OfPart>> bounds_;  // by part; made when asked for
};

// Of means over the patch.
struct Look {
  StratifiedMean least, most;  // what F is, or may be where it is not known
  std::size_t strata = 0;
};

std::vector<Part> fragments_of(const ExactScene& scene, const std::vector<Part>& parts) {
  std::vector<Part> fragments;
  for (const Part& part : parts) {
    kernel::poll();
    std::ranges::move(cut_at_contacts(scene, part), std::back_inserter(fragments));
  }
  return fragments;
}

Vec3 middle_of(std::span<const Vec3> corners) {
  Vec3 sum;
  for (const Vec3& corner : corners) sum = {sum.x + corner.x, sum.y + corner.y, sum.z + corner.z};
  return kernel::scaled(sum, 1.0 / static_cast<double>(corners.size()));
}

// Over a few strata, of the bounds at their middles: smaller strata have hardly smaller ones.
double mean_of_bounds(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to) {
  LargestFactors largest(scene, from.parts, to.parts);
  const Strata strata = strata_of(from.parts, kFewestStrata);
  double sum = 0.0;
  for (const Stratum& stratum : strata.strata) {
    const Tile& tile = strata.tiles[stratum.begin];
    const Vec3 middle = middle_of(corners_of(from.parts[tile.part], tile, scene.units));
    sum += stratum.area / strata.area * largest.on(tile.part, {&middle, 1});
  }
  return sum;
}

}  // namespace

class SampledMean::Looks {
 public:
  Looks(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to)
      : scene_(scene),
        from_(fragments_of(scene, from.parts)),
        factors_(scene, from_, to.selection),
        largest_(scene, from_, to.parts),
        of_shares_(error_of_shares(from_, scene.units)),
        strata_(from_, kFirstStrata, [this](const Tile& tile) { return largest_.on(tile); }) {}

  [[nodiscard]] std::size_t points() const { return points_; }
  [[nodiscard]] std::size_t points_after_next() const { return points_ + points_of_next(); }
  [[nodiscard]] std::size_t points_of_next() const { return kPointsOfStratum * strata_.strata().strata.size(); }
  // Of the first look, on average.
  [[nodiscard]] std::uint64_t effort_of_point() const { return effort_of_point_; }
  [[nodiscard]] std::uint64_t effort_after_next() const { return effort_of_point_ * points_after_next(); }
  [[nodiscard]] std::size_t strata() const { return last_.strata; }  // of the last look
  // False if all points might then be more than `most`, or the strata are too small.
  bool split_within(std::size_t most) { return points_after_next() + kPointsOfSplit <= most && strata_.split(); }

  // Of the next look, from the bounds and the last look.
  [[nodiscard]] double expected_width() const {
    const auto error = [&](const StratifiedMean& last) {
      const double square = expected_square(last);
      return StratifiedMean{.expected = square, .square = square}.error(strata_.largest(), risk_of(number_ + 1));
    };
    return std::min(1.0, last_.most.value + error(last_.most)) - std::max(0.0, last_.least.value - error(last_.least));
  }

  std::pair<double, double> look() {
    Look next;
    next.strata = strata_.strata().strata.size();
    next.least.expected = expected_square(last_.least);
    next.most.expected = expected_square(last_.most);
    for (std::size_t s = 0; s < next.strata; ++s) {
      kernel::poll();
      add(s, next);
    }
    last_ = next;
    ++number_;
    points_ += points_of_next();
    if (number_ == 1) effort_of_point_ = factors_.effort() / points_;
    const auto error = [&](const StratifiedMean& mean) { return mean.error(strata_.largest(), risk_of(number_)); };
    const double below = error(last_.least), above = last_.most.value - last_.least.value + error(last_.most);
    return {last_.least.value, std::max(below, above) + of_shares_ + kRoundedPoints};
  }

 private:
  // Of the next look, from a mean of the last one.
  [[nodiscard]] double expected_square(const StratifiedMean& last) const {
    if (number_ == 0) return kFirstSquare * strata_.largest() * strata_.largest();
    const double ratio = static_cast<double>(last_.strata) / static_cast<double>(strata_.strata().strata.size());
    return kCaution * last.square * std::pow(ratio, kDecay);
  }

  void add(std::size_t stratum, Look& look) {
    const Strata& strata = strata_.strata();
    const double range = strata_.range(stratum), guess = strata_.guess(stratum);
    std::array<double, kDraws> least{}, most{};
    for (std::size_t d = 0; d < kDraws; ++d) {
      Draws draws(number_, stratum, d);
      const Tile& tile = draw_tile(strata, strata.strata[stratum], d, draws);
      const Point point = point_in(from_[tile.part], tile, draws, scene_.units);
      const std::optional<double> value = factors_.at(point, tile.part);
      least[d] = value.value_or(0.0);
      most[d] = value.value_or(range);
    }
    const double share = strata.strata[stratum].area / strata.area;
    look.least.add(least[0], least[1], guess, share);
    look.most.add(most[0], most[1], guess, share);
    strata_.set_guess(stratum, 0.5 * (least[0] + least[1]));
  }

  const ExactScene& scene_;
  const std::vector<Part> from_;
  PointFactors factors_;
  LargestFactors largest_;
  const double of_shares_;
  SplitStrata strata_;
  std::size_t number_ = 0, points_ = 0;  // so far
  Look last_;
  std::uint64_t effort_of_point_ = 0;
};

SampledMean::SampledMean(const ExactScene& scene, const PreparedPatch& from, const PreparedPatch& to, std::size_t most,
                         double ratio)
    : scene_(scene), from_(from), to_(to), most_(std::max(most, kPointsOfFirstLook)), ratio_(ratio) {
  const double range = mean_of_bounds(scene, from, to);
  width_of_one_ = kLeastOfWidths * 2.0 * StratifiedMean().error(range, risk_of(1));
}
SampledMean::~SampledMean() = default;

double SampledMean::lower() const { return std::max(0.0, value_ - error_); }
double SampledMean::upper() const { return std::min(1.0, value_ + error_); }

bool SampledMean::may_reach(double width, std::uint64_t effort) const {
  const double points = static_cast<double>(kPointsOfStratum) * width_of_one_ * ratio_ / width;
  const std::uint64_t of_point = looks_ ? looks_->effort_of_point() : kEffortOfPoint + kEffortOfPlane;
  return points <= static_cast<double>(most_) && points * static_cast<double>(of_point) <= static_cast<double>(effort);
}

double SampledMean::next_width() const {
  double next = 1.0;
  while (next >= width()) next *= kNarrower;
  return next;
}

// The first one tells what the others are predicted from.
bool SampledMean::look(std::uint64_t effort) {
  if (looks_ == nullptr) {
    looks_ = std::make_unique<Looks>(scene_, from_, to_);
    take_look();
    return true;
  }
  const double wanted = kOfExpected * next_width() / ratio_;
  while (looks_->expected_width() > wanted) {
    if (looks_->effort_after_next() > effort || !looks_->split_within(most_)) return false;
  }
  if (looks_->effort_after_next() > effort || looks_->points_after_next() > most_) return false;
  take_look();
  return true;
}

void SampledMean::look_with_the_rest(double width) {
  while (looks_->split_within(most_)) {
  }
  if (looks_->points_after_next() <= most_ && looks_->expected_width() * ratio_ < width) take_look();
}

void SampledMean::take_look() {
  const auto [value, found] = looks_->look();
  const double least = std::min(1.0, width_of_one_ / static_cast<double>(looks_->strata()));
  const double error = std::max({found, 0.5 * least, least - value});
  if (!(error < error_)) return;
  value_ = value;
  error_ = error;
}

}  // namespace exactff::view_factors
