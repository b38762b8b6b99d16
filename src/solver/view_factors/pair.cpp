#include "view_factors/pair.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "kernel/poll.h"
#include "text/phrases.h"
#include "view_factors/certified_integral.h"

namespace exactff::view_factors {
namespace {

using kernel::difference;
using kernel::distance;
using kernel::dot;

constexpr double kSlack = 1.0 + 0x1p-40;           // more than the roundings of an estimated bound
constexpr double kLargestMismatch = 0x1p-16;       // of the self-check, whose point is rounded
constexpr double kStepAside = 0x1p-30;             // in units of Point::at
constexpr double kLeastMargin = 0x1p-24;           // the same
constexpr std::uint64_t kSignsForACell = 1 << 15;  // more than where few occluders lie between
constexpr std::size_t kManyOccluders = 256;        // an event cell of more is not worth a visit to its centre
constexpr double kShareOfParent = 0.125;           // of a cell's error that its halves may have
constexpr double kShareOfUnresolved = 0x1p-8;      // of all that F can be on a cell: what may be left out to resolve it
constexpr double kTrifle = 0x1p-10;                // of the receiver's area: what may be left out at first
constexpr double kMostLeftOut = 0.5;               // of a cell's error; if more is due to it, less is left out
// Whether the difference of two rules tells their error. Where an edge is nearer than this, F may have a peak that both
// rules miss. At 1.5 radii, two points more divide the error by 2.6^4 = 46.
constexpr double kLeastRadii = 1.5;
constexpr double kRadiiForFour = 3.0;  // nearer to an edge, four points hardly ever suffice
// Certified slopes. Coordinates are at most 1 and rounded once. A distance errs by less than 2^-45: that of a point of
// the segment which is not quite the nearest one. A sum of 2^20 edges has a relative error below 2^-32.
constexpr double kDistanceMargin = 0x1p-44;
constexpr double kSumMargin = 1.0 + 0x1p-30;
constexpr double kOfBall = 0x1p-50;  // relative: of a value that was made precise
constexpr double kOfSum = 0x1p-46;   // relative: of the weights of a rule and of their sum with values

Point middle(const Point& p, const Point& q, const Units& units) {
  Homogeneous sum;
  for (std::size_t i = 0; i < 3; ++i) sum[i] = p.exact[i] * q.exact[3] + q.exact[i] * p.exact[3];
  sum[3] = 2 * p.exact[3] * q.exact[3];
  return make_point(std::move(sum), units);
}

// An exact point inside the cell.
Point point_inside(const Cell& cell, const Units& units) {
  return middle(cell.corners[0], middle(cell.corners[1], cell.corners[2], units), units);
}

// The same, rounded.
Vec3 near_point_inside(const Cell& cell) {
  const Vec3 &a = cell.corners[0].at, &b = cell.corners[1].at, &c = cell.corners[2].at;
  const auto middle_of = [](double p, double q, double r) { return 0.5 * (p + 0.5 * (q + r)); };
  return {middle_of(a.x, b.x, c.x), middle_of(a.y, b.y, c.y), middle_of(a.z, b.z, c.z)};
}

double radius_about(const Cell& cell, const Vec3& centre) {
  double radius = 0.0;
  for (const Point& corner : cell.corners) radius = std::max(radius, distance(corner.at, centre));
  return radius * kSlack;
}

// The distance of the nearest edge from the cell's middle, in radii of the cell.
double resolution(const Cell& cell, const Formula& formula) {
  Vec3 centre;
  for (const Point& corner : cell.corners) {
    const double share = 1.0 / static_cast<double>(cell.corners.size());
    centre = {centre.x + share * corner.at.x, centre.y + share * corner.at.y, centre.z + share * corner.at.z};
  }
  return formula.distance_to_edges(centre) / radius_about(cell, centre);
}

// The value of a ball, with as many bits as it takes to make it small.
template <class Function>
Evaluated precise(const Function& f) {
  constexpr long kFirstBits = 192, kMostBits = 12288, kEnough = 60, kBitsForZero = 768;
  constexpr double kTiny = 0x1p-100;
  for (long bits = kFirstBits;; bits *= 2) {
    const Ball ball = f(bits);
    const double value = kernel::nearest_to_midpoint(ball);
    const bool tiny = std::abs(value) < kTiny && bits >= kBitsForZero;  // perhaps exactly 0
    if (kernel::certain_bits(ball) >= kEnough || tiny) return {value, kOfBall * std::abs(value) + kTiny};
    if (bits >= kMostBits) return {0.5, 0.5};
  }
}

// At the exact point of the receiver's plane that the place stands for.
Evaluated precise_value(const Formula& formula, const Cell& cell, const CellPlace& place) {
  return precise([&](long bits) {
    const auto corner = [&](std::size_t i) { return ball_point(cell.corners[i % cell.corners.size()], bits); };
    const auto between = [](const Ball& a, const Ball& b, const Ball& t) { return a + (b - a) * t; };
    const Ball s = kernel::to_ball(place.s, bits), t = kernel::to_ball(place.t, bits);
    const BallPoint a = corner(0), b = corner(place.i), c = corner(place.i + 1), d = corner(place.i + 2);
    const auto coordinate = [&](Ball BallPoint::*axis) {
      return between(between(a.*axis, b.*axis, s), between(d.*axis, c.*axis, s), t);
    };
    return formula.at(BallPoint{coordinate(&BallPoint::x), coordinate(&BallPoint::y), coordinate(&BallPoint::z)});
  });
}

// A value in [0, most] that is near if any is known to be.
Evaluated within(const Evaluated& value, double most) {
  return {value.rounding < most ? std::clamp(value.value, 0.0, most) : 0.5 * most, 0.0};
}

}  // namespace

Pair::Pair(const Scene& scene, Sight sight, FaceId receiver_face, std::shared_ptr<const ExactSource> whole,
           PairMemory& memory, std::size_t id)
    : scene_(scene),
      sight_(std::move(sight)),
      receiver_face_(receiver_face),
      whole_(std::move(whole)),
      bound_(sight_),
      view_(sight_, memory, id),
      omissions_(sight_, view_) {
  if (!sight_.is_of_open()) {
    if (sight_.near_horizon) {
      strip_.emplace(sight_, sight_.source, *sight_.near_horizon, sight_.source_plane, StripBound::Sides::kFront);
    }
    return;
  }
  for (const int side : {1, -1}) {
    for (const Occluder& occluder : sight_.occluders) {
      const std::vector<Vec3> corners = sight_.points.positions(occluder.ring);
      Plane plane = *occluder.plane;
      for (double& coefficient : plane.rounded) coefficient *= side;
      of_occluders_.emplace_back(corners, plane, sight_.receiver);
    }
  }
}

CellView::Outcome Pair::view(const Cell& cell, std::size_t depth, Candidates& candidates) {
  const std::uint64_t before = view_.work();
  const CellView::Outcome outcome = view_.look(cell, depth, candidates);
  extra_cost_ += static_cast<std::size_t>((view_.work() - before) / kSignsForACell);
  return outcome;
}

std::size_t Pair::events() {
  view_.start();
  Candidates candidates = view_.all_candidates();
  (void)view(sight_.root, 0, candidates);
  return view_.count_events(sight_.root, candidates);
}

std::vector<Share> Pair::cells(double enough, const Budget& budget) {
  budget_ = {cost() + budget.cost, effort() + budget.effort};
  std::vector<Share> shares;
  view_.start();
  look(sight_.root, 0, view_.all_candidates(), enough, kTrifle * area(sight_.root), shares);
  return shares;
}

std::vector<Share> Pair::without_cells() const {
  std::vector<Share> shares;
  add_dark(sight_.root, view_.all_candidates(), {}, nullptr, shares);
  return shares;
}

template <unsigned kCount>
Pair::Rule Pair::gauss_integral(const Formula& formula, const Cell& cell, const std::vector<Vec3>& ring,
                                std::optional<double> most) const {
  const std::vector<WeightedPlace> places = gauss_places<kCount>(ring);
  std::vector<Vec3> points;
  for (const WeightedPlace& p : places) points.push_back(p.at);
  std::vector<Evaluated> values(points.size());
  formula.at(points, values);
  Rule rule;
  double largest = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool is_enough = values[i].rounding <= limits_.rounding;
    const auto [value, rounding] = is_enough ? values[i]
                                   : most    ? within(values[i], *most)
                                             : precise_value(formula, cell, places[i].place);
    rule.integral += places[i].weight * value;
    rule.rounding += places[i].weight * rounding;
    largest = std::max(largest, std::abs(value));
  }
  rule.rounding += largest * (error_of_area(ring) + kOfSum * area(ring));
  return rule;
}

Evaluated Pair::value_at(const Formula& formula, const Point& x) const {
  const Evaluated quick = formula.at(x.at);
  if (quick.rounding <= limits_.rounding) return quick;
  return precise([&](long bits) { return formula.at(ball_point(x, bits)); });
}

Extent Pair::extent_of(const Cell& cell) const {
  std::vector<Vec3> corners = positions_of(cell.corners);
  const double most = bound_.on(corners);
  return {std::move(corners), most, size_of(cell)};
}

// Only where all of these sides are seen, and those before and after lead to them: then the contour goes round the
// strip as well.
std::shared_ptr<const Formula> Pair::formula_to_horizon(const std::vector<BoundaryPart>& seen) const {
  if (!strip_) return nullptr;
  std::vector<BoundaryPart> parts = seen;
  const auto& [first, count, in_plane] = *sight_.near_horizon;
  const auto part_of = [&](std::size_t place) -> BoundaryPart* {
    const LineId line = sight_.source[place % sight_.source.size()].line;
    const auto is_part = [&](const BoundaryPart& p) { return p.sign > 0 && p.edge.line == line; };
    const auto found = std::ranges::find_if(parts, is_part);
    return found == parts.end() || std::ranges::count_if(parts, is_part) > 1 ? nullptr : &*found;
  };
  const auto is_whole_from = [](const BoundaryPart* p) { return !p->from.line && p->from.vertex == p->edge.from; };
  const auto is_whole_to = [](const BoundaryPart* p) { return !p->to.line && p->to.vertex == p->edge.to; };
  BoundaryPart *const before = part_of(first + sight_.source.size() - 1), *const after = part_of(first + count);
  if (before == nullptr || after == nullptr || !is_whole_to(before) || !is_whole_from(after)) return nullptr;
  for (std::size_t k = 0; k < count; ++k) {
    const BoundaryPart* const side = part_of(first + k);
    if (side == nullptr || !is_whole_from(side) || !is_whole_to(side)) return nullptr;
  }
  before->edge.to = before->to.vertex = in_plane.from;
  after->edge.from = after->from.vertex = in_plane.to;
  for (std::size_t k = 1; k < count; ++k) parts.erase(parts.begin() + (part_of(first + k) - parts.data()));
  *part_of(first) = {in_plane, {in_plane.from, {}}, {in_plane.to, {}}, 1};
  return std::make_shared<const Formula>(sight_, parts);
}

std::shared_ptr<const Formula> Pair::formula_of_view(CellView::Outcome outcome) const {
  if (outcome != CellView::Outcome::kKnown || (view_.parts().empty() && !view_.has_horizon())) return nullptr;
  return std::make_shared<const Formula>(sight_, view_.parts(), view_.has_horizon());
}

// Where edges are almost seen along one another, or lie almost in the cell.
bool Pair::is_hard(const Formula& formula, const Cell& cell) {
  return !formula.boundary().empty() && omissions_.are_possible() &&
         (!(formula.at(near_point_inside(cell)).rounding <= limits_.rounding) ||
          resolution(cell, formula) < kLeastRadii);
}

// Depth first: the cells that wait are the siblings of those on the way.
void Pair::look(Cell cell, std::size_t depth, Candidates candidates, double enough, double trifle,
                std::vector<Share>& shares) {
  kernel::poll();
  ++cells_made_;
  CellView::Outcome outcome = view(cell, depth, candidates);
  std::shared_ptr<const Formula> formula = formula_of_view(outcome);
  LeftOut left_out;
  const auto is_unresolved = [&] {
    return outcome == CellView::Outcome::kKnown && formula != nullptr && is_hard(*formula, cell);
  };
  const auto leave_out = [&](const Extent& extent, double most) {
    candidates = omissions_.united(candidates, left_out);
    left_out = omissions_.leave_out(extent, candidates, most);
    if (left_out.candidates.empty()) return;
    outcome = view(cell, depth, candidates);
    formula = formula_of_view(outcome);
  };
  if (!candidates.empty() && (outcome != CellView::Outcome::kKnown || is_unresolved())) {
    const Extent extent = extent_of(cell);
    leave_out(extent, trifle);
    const double of_unresolved = kShareOfUnresolved * extent.most * extent.size;
    if (trifle < of_unresolved && is_unresolved()) leave_out(extent, of_unresolved);
  }
  if (outcome == CellView::Outcome::kKnown && formula == nullptr) return;
  const auto all = [&] { return omissions_.united(candidates, left_out); };
  if (size_of(cell) <= limits_.negligible_area) {
    add_dark(std::move(cell), all(), view_.way(depth), nullptr, shares);
    shares.back().next = Share::Next::kNextStage;
    return;
  }
  switch (outcome) {
    case CellView::Outcome::kKnown:
      return add_smooth({.cell = std::move(cell),
                         .candidates = left_out.candidates.empty() ? Candidates{} : std::move(candidates),
                         .formula = std::move(formula),
                         .to_horizon = formula_to_horizon(view_.parts()),
                         .way = {},
                         .cut = nullptr,
                         .left_out = std::move(left_out),
                         .near = nullptr},
                        HUGE_VAL, shares);
    case CellView::Outcome::kCrossings:
      add_event(std::move(cell), depth, std::move(candidates), std::vector(view_.triples()), shares);
      shares.back().left_out = std::move(left_out);
      return count_left_out(shares.back());
    case CellView::Outcome::kCut:
      break;
  }
  if (range_on(cell, candidates).half() * size_of(cell) <= enough) {
    return add_dark(std::move(cell), all(), view_.way(depth), view_.best_cut(), shares);
  }
  if (effort() >= budget_.effort) {
    return add_dark(std::move(cell), all(), view_.way(depth), view_.best_cut(), shares);
  }
  if (cost() >= budget_.cost) {
    add_event(std::move(cell), depth, std::move(candidates), {}, shares);
    shares.back().left_out = std::move(left_out);
    return count_left_out(shares.back());
  }
  Halves halves = cut(cell, sight_.receiver, view_.best_cut(), sight_.points.units());
  candidates = all();
  look(std::move(halves.negative), depth + 1, candidates, enough, trifle, shares);
  look(std::move(halves.positive), depth + 1, std::move(candidates), enough, trifle, shares);
}

// What points see tells nothing of what is left out.
void Pair::count_left_out(Share& share) {
  if (share.is_dark || share.left_out.candidates.empty()) return;
  share.integral += 0.5 * (share.left_out.under - share.left_out.over);
  share.error = (share.error + 0.5 * share.left_out.width() + 0x1p-52 * std::abs(share.integral)) * kSlack;
  share.bound = 0.0;
  share.near = nullptr;
  if (share.next != Share::Next::kMorePoints) share.next = Share::Next::kCut;
}

// For a certified integral, rounded up.
double Pair::size_of(const Cell& cell) const {
  return certifies() ? magnitude(enclosed_area(cell, sight_.receiver)) : area(cell);
}

// What is open is all that the occluders do not cover, even if no two of their shadows overlap. Where the cell's area
// must be rounded up, the least is not used.
Pair::Range Pair::range_on(const Cell& cell, const Candidates& candidates) const {
  Range range{.high = bound_.on(cell)};
  if (!sight_.is_of_open() || certifies()) return range;
  double covered = 0.0;
  for (const auto& [occluder, facing] : candidates) {
    if (facing != -1) covered += of_occluders_[occluder].on(cell);
    if (facing != 1) covered += of_occluders_[sight_.occluders.size() + occluder].on(cell);
    if (covered >= 1.0) return range;
  }
  range.low = std::max(0.0, 1.0 - covered * kSlack);
  return range;
}

void Pair::add_dark(Cell cell, Candidates candidates, PairMemory::Way way, std::shared_ptr<const Plane> cut,
                    std::vector<Share>& shares) const {
  const Range range = range_on(cell, candidates);
  const double size = size_of(cell);
  shares.push_back({.cell = std::move(cell),
                    .candidates = std::move(candidates),
                    .formula = nullptr,
                    .way = std::move(way),
                    .cut = std::move(cut),
                    .integral = range.middle() * size,
                    .error = range.half() * size * kSlack,
                    .stage = limits_.stage,
                    .is_event = true,
                    .is_dark = true,
                    .bound = range.half() * kSlack,
                    .near = nullptr});
}

// By a rule of Gauss' and those with one and two points less in each direction, from which the error is estimated; or
// all that F can be.
//
// With each point, the errors of the rules fall by about rho^2, rho = radii + sqrt(radii^2 - 1), as the nearest edge is
// `radii` radii away. The difference of the last two rules is about the error of the one before, which is on the safe
// side, but it can be small by chance. So the difference of the two before counts, too, over rho^4.
template <unsigned kCount>
Pair::Integral Pair::integrate_by(const Formula& formula, const Cell& cell, double radii) const {
  const std::vector<Vec3> ring = positions_of(cell.corners);
  const bool is_resolved = radii >= kLeastRadii;
  const double most = is_resolved ? 1.0 : bound_.on(ring);
  const Rule rule = gauss_integral<kCount>(formula, cell, ring, is_resolved ? std::nullopt : std::optional(most));
  Integral found{.integral = rule.integral, .rounding = rule.rounding};
  if (is_resolved) {
    const double lower = gauss_integral<kCount - 1>(formula, cell, ring).integral,
                 lowest = gauss_integral<kCount - 2>(formula, cell, ring).integral;
    const double rho = radii + std::sqrt(radii * radii - 1.0), rho_squared = rho * rho;
    const double by_last = std::abs(rule.integral - lower),
                 by_before = std::abs(lower - lowest) / (rho_squared * rho_squared);
    found.error = 4.0 * std::max(by_last, by_before) + rule.rounding;
  } else {
    const double size = area(ring);
    const double mean = size > 0.0 ? std::clamp(rule.integral / size, 0.0, most) : 0.0;
    found.bound = std::max(mean, most - mean) * kSlack;
    found.integral = mean * size;
    found.error = found.bound * size + rule.rounding;
  }
  return found;
}

// Four points where they suffice for a cell of this size, else six.
Pair::Integral Pair::integrate(const Formula& formula, const Cell& cell) const {
  const double radii = resolution(cell, formula);
  if (radii >= kRadiiForFour) {
    Integral four = integrate_by<4>(formula, cell, radii);
    four.more_points = true;
    if (four.error <= limits_.quadrature * area(cell)) return four;
  }
  return integrate_by<6>(formula, cell, radii);
}

Share::Next Pair::next_of(const Integral& found) const {
  if (found.rounding > 0.5 * found.error) return certifies() ? Share::Next::kNothing : Share::Next::kNextStage;
  return found.more_points ? Share::Next::kMorePoints : Share::Next::kCut;
}

// Within the tolerance of a cell of its size, if it can be.
Pair::Integral Pair::enclose(const Formula& formula, const Cell& cell, double most) const {
  const double share = std::sqrt(area(cell) / limits_.area);
  const double tolerance = std::min(most, limits_.certified * share * std::sqrt(share));
  const CertifiedIntegral found = certified_integral(formula, cell, bound_.on(cell), tolerance);
  return {.integral = found.value,
          .error = found.error,
          .rounding = found.is_final ? found.error : 0.0,
          .more_points = found.error <= tolerance};
}

template <class Integrate>
Pair::Integral Pair::better_integral(const Share& share, const Integrate& integrate) const {
  const Integral exact = integrate(*share.formula);
  if (share.to_horizon == nullptr) return exact;
  const double half = 0.5 * strip_->on(positions_of(share.cell.corners), size_of(share.cell));
  if (!(half < exact.error)) return exact;
  Integral to_horizon = integrate(*share.to_horizon);
  to_horizon.integral -= half;
  to_horizon.error = (to_horizon.error + half + 0x1p-52 * std::abs(to_horizon.integral)) * kSlack;
  to_horizon.bound = 0.0;
  return to_horizon.error < exact.error ? to_horizon : exact;
}

void Pair::add_smooth(Share share, double most, std::vector<Share>& shares) {
  const Integral found = better_integral(share, [&](const Formula& formula) {
    return certifies() ? enclose(formula, share.cell, most) : integrate(formula, share.cell);
  });
  if (whole_ != nullptr && share.left_out.candidates.empty()) check(share.cell, *share.formula);
  share.integral = found.integral;
  share.error = found.error;
  share.next = next_of(found);
  share.stage = limits_.stage;
  share.bound = found.bound;
  count_left_out(share);
  shares.push_back(std::move(share));
}

// From every point, F differs from its value at the centre by at most the slope times the distance: visibility in a
// direction changes only where an edge sweeps over it. An edge at distance d or more that is seen under the angle w
// contributes at most w / (pi d) to the slope.
double Pair::slope_bound(const Candidates& candidates, const Vec3& centre, double radius) const {
  double sum = 0.0;
  const auto add = [&](const Ring& ring) {
    for (const Edge& edge : ring) {
      const Vec3& a = sight_.points[edge.from].at;
      const Vec3& b = sight_.points[edge.to].at;
      const double nearest = distance_to_segment(centre, a, b) - radius;
      const double angle = std::min(std::numbers::pi, distance(a, b) / nearest);
      sum += nearest > 0.0 ? angle / nearest : HUGE_VAL;
    }
  };
  add(sight_.source);
  for (const Candidate& candidate : candidates) add(sight_.shadow(candidate.occluder).ring);
  return sum / std::numbers::pi * kSlack;
}

// By the formula of a point inside, and a bound on how far F can be from it elsewhere.
void Pair::add_event(Cell cell, std::size_t depth, Candidates candidates, const std::vector<CrossingTriple>& triples,
                     std::vector<Share>& shares) {
  if (triples.empty() && candidates.size() > kManyOccluders) {
    return add_dark(std::move(cell), std::move(candidates), view_.way(depth), nullptr, shares);
  }
  const Point centre = point_inside(cell, sight_.points.units());
  const Cell at_centre{{centre}, {}};
  Candidates of_centre = candidates;
  (void)view(at_centre, depth + 1, of_centre);  // at a single point every sign is known
  auto formula = std::make_shared<const Formula>(sight_, view_.parts(), view_.has_horizon());
  const Integral found = certifies() ? enclose_event(*formula, cell, centre, candidates, triples)
                                     : integrate_event(*formula, cell, centre, candidates, triples);
  shares.push_back({.cell = std::move(cell),
                    .candidates = std::move(candidates),
                    .formula = nullptr,
                    .way = view_.way(depth),
                    .cut = nullptr,
                    .integral = found.integral,
                    .error = found.error,
                    .next = certifies() ? Share::Next::kCut : next_of(found),
                    .stage = limits_.stage,
                    .is_event = true,
                    .bound = found.bound,
                    .near = found.is_near ? std::move(formula) : nullptr});
}

Pair::Integral Pair::integrate_event(const Formula& formula, const Cell& cell, const Point& centre,
                                     const Candidates& candidates, const std::vector<CrossingTriple>& triples) const {
  const double size = size_of(cell);
  const double bound_near =
      triples.empty() ? HUGE_VAL : kEventMargin * event_bound(sight_.points, cell, centre.at, triples);
  if (bound_near < 1.0) {
    Integral found = integrate(formula, cell);
    found.more_points = false;
    if (found.bound == 0.0) {
      found.error += bound_near * size;
      found.bound = bound_near;
      found.is_near = true;
    }
    return found;
  }
  const auto [found, rounding] = value_at(formula, centre);
  const Range range = range_on(cell, candidates);
  const double value = std::clamp(found, range.low, range.high);
  const double radius = radius_about(cell, centre.at);
  const double bound = std::min(slope_bound(candidates, centre.at, radius) * radius + rounding,
                                std::max(value - range.low, range.high - value));
  return {.integral = value * size, .error = bound * size, .bound = bound};
}

// The narrowest of what is known: the largest F; the centre's formula with event_bound; its value with the slope.
Pair::Integral Pair::enclose_event(const Formula& formula, const Cell& cell, const Point& centre,
                                   const Candidates& candidates, const std::vector<CrossingTriple>& triples) const {
  const double size = size_of(cell);
  const double half = 0.5 * bound_.on(cell) * size;
  const Integral unknown{.integral = half, .error = half * kSlack};
  const double bound = triples.empty() ? HUGE_VAL : kEventMargin * event_bound(sight_.points, cell, centre.at, triples);
  if (bound < 1.0) {
    const Integral found = enclose(formula, cell, HUGE_VAL);
    const double error = (found.error + bound * size) * kSumMargin;
    if (error < unknown.error) return {.integral = found.integral, .error = error};
  }
  const double radius = radius_about(cell, centre.at) + kDistanceMargin;
  const Disc value = DiscFormula(formula, Cell{{centre}, {}}).value({}, {});
  const double change = slope_bound(candidates, centre.at, radius) * radius * kSumMargin;
  const Disc integral = widened(value, change) * enclosed_area(cell, sight_.receiver);
  if (!(integral.radius < unknown.error)) return unknown;
  return {.integral = integral.centre, .error = integral.radius};
}

bool Pair::improve_whole(Share& share) {
  const bool is_new_stage = share.stage < limits_.stage;
  share.stage = limits_.stage;
  if (share.formula == nullptr || share.left_out.width() > kMostLeftOut * share.error) return false;
  const bool more_points = share.next == Share::Next::kMorePoints;
  const bool is_due = (more_points && !certifies()) || (is_new_stage && share.next != Share::Next::kCut);
  if (!is_due) return false;
  ++extra_cost_;
  // Four points suggest that one formula is resolved. The other one may have an edge that is almost in the cell.
  const Integral found = better_integral(share, [&](const Formula& formula) {
    return certifies() ? enclose(formula, share.cell, HUGE_VAL)
           : more_points
               ? integrate_by<6>(formula, share.cell, std::min(kRadiiForFour, resolution(share.cell, formula)))
               : integrate(formula, share.cell);
  });
  if (!(found.error + 0.5 * share.left_out.width() < share.error)) return false;
  share.integral = found.integral;
  share.error = found.error;
  share.next = next_of(found);
  share.bound = found.bound;
  count_left_out(share);
  return true;
}

std::vector<Share> Pair::improve(Share share, const Budget& budget) {
  budget_ = {cost() + budget.cost, effort() + budget.effort};
  std::vector<Share> result;
  if (improve_whole(share)) {
    result.push_back(std::move(share));
    return result;
  }
  const double enough = kShareOfParent * share.error;
  const bool too_much_is_left_out = share.left_out.width() > kMostLeftOut * share.error;
  if (share.formula == nullptr && (too_much_is_left_out || share.way.empty())) {
    view_.start();
    look(std::move(share.cell), 0, omissions_.united(share.candidates, share.left_out), enough, enough, result);
    return result;
  }
  const Units& units = sight_.points.units();
  const std::shared_ptr<const Plane> by = share.cut != nullptr ? share.cut : bisector(share.cell, units);
  if (by == nullptr) {
    share.next = Share::Next::kNothing;
    result.push_back(std::move(share));
    return result;
  }
  Halves parts = cut(share.cell, sight_.receiver, by, units);
  if (share.formula != nullptr && !too_much_is_left_out) {
    cells_made_ += 2;
    share.cell = {};
    for (Cell* part : {&parts.negative, &parts.positive}) {
      Share half = share;
      half.cell = std::move(*part);
      omissions_.bound(half.left_out, extent_of(half.cell));
      add_smooth(std::move(half), enough, result);
    }
  } else {
    const std::size_t depth = share.way.size();
    if (depth == 0) {
      view_.start();
    } else {
      view_.resume(std::move(share.way));
    }
    Candidates candidates = omissions_.united(share.candidates, share.left_out);
    look(std::move(parts.negative), depth, candidates, enough, enough, result);
    look(std::move(parts.positive), depth, std::move(candidates), enough, enough, result);
  }
  return result;
}

// Where only bounds are known, the value is that of one point.
double Pair::estimate(const Share& share) const {
  if (!share.is_dark || whole_ == nullptr || share.cell.corners.empty()) return share.integral;
  const double value = factor_near(near_point_inside(share.cell)) * area(share.cell);
  return std::clamp(value, share.integral - share.error, share.integral + share.error);
}

// The form factor of the exact solver, at a rounded point.
double Pair::factor_near(const Vec3& at) const {
  const int exponent = static_cast<int>(sight_.points.units().exponent + sight_.points.units().shift);
  const auto coordinate = [&](double x) { return std::ldexp(x, exponent); };
  const auto& normal = sight_.receiver.rounded;  // its largest component is about 1
  const Receiver receiver{.point = {coordinate(at.x), coordinate(at.y), coordinate(at.z)},
                          .normal = {normal[0], normal[1], normal[2]},
                          .on = {receiver_face_},
                          .id = {}};
  return exact_form_factor(scene_, receiver, *whole_).value;
}

// The point of the exact solver is rounded, and may lie on the other side of a face that is a rounding away from the
// receiver's plane. So points a little above and below are also tried, from which an edge at distance d is seen turned
// by at most the step over d.
void Pair::check(const Cell& cell, const Formula& formula) const {
  const Units& units = sight_.points.units();
  const int exponent = static_cast<int>(units.exponent + units.shift);
  const Vec3 inside = near_point_inside(cell);
  for (const double x : {inside.x, inside.y, inside.z}) {
    if (std::ldexp(std::ldexp(x, exponent), -exponent) != x) return;  // the point is no double in the scene's unit
  }
  const auto& plane = sight_.receiver.rounded;
  const auto [found, rounding] = formula.at(inside);
  // Where rounding may have moved the point to another cell, or matters, it means nothing.
  if (rounding > kLargestMismatch || distance_from_sides(cell, inside) < kLeastMargin) return;
  double exact = 0.0, turned = 0.0;
  for (const BoundaryPart& part : formula.boundary()) {
    turned +=
        kStepAside / distance_to_segment(inside, sight_.points[part.edge.from].at, sight_.points[part.edge.to].at);
  }
  for (const double above : {0.0, kStepAside, -kStepAside}) {
    exact = factor_near({inside.x + above * plane[0], inside.y + above * plane[1], inside.z + above * plane[2]});
    if (std::abs(found - exact) <= kLargestMismatch + (above == 0.0 ? 0.0 : turned)) return;
  }
  throw std::logic_error("a view factor's cell on " + scene_.name_of(receiver_face_) + " sees " +
                         text::shortest(found) + " of " + scene_.name_of(whole_->selection()) + ", its point sees " +
                         text::shortest(exact));
}

}  // namespace exactff::view_factors
