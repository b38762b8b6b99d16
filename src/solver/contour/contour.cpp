#include "contour/contour.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "kernel/expect.h"
#include "kernel/poll.h"

namespace exactff::contour {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::ratio;
using kernel::Rational;
using kernel::RationalVec3;
using kernel::sign;
using kernel::to_ball;
using kernel::to_rational;
using visibility::BoundaryPiece;

ContourIntegral::ContourIntegral(ExactVec3 normal) : normal_(std::move(normal)) {}

void ContourIntegral::add(const BoundaryPiece& piece) {
  const ExactVec3 a_cross_b = cross(piece.a, piece.b);
  EXACTFF_EXPECT(!kernel::is_zero(a_cross_b));
  const Integer w = piece.begin.l * piece.end.m - piece.begin.m * piece.end.l;
  if (sign(w) == 0) return;  // the piece begins where it ends
  const Integer normal_dot = dot(normal_, a_cross_b);
  if (sign(normal_dot) == 0) return;  // the normal lies in the plane of the edge and x: the term is 0
  terms_.push_back({dot(a_cross_b, a_cross_b), sign(w) > 0 ? normal_dot : Integer(-normal_dot), abs(w),
                    dot(piece.from(), piece.to())});
}

// Eq. (4), in the notation of contour.h.
Ball ContourIntegral::evaluate(long bits) const {
  Ball sum(bits);
  for (const Term& term : terms_) {
    kernel::poll();
    const Ball norm = sqrt(to_ball(term.squared_cross, bits));
    const Ball angle = atan2(norm * to_ball(term.parameter_span, bits), to_ball(term.ends_dot, bits));
    sum = sum - angle * to_ball(term.normal_dot, bits) / norm;
  }
  return sum / (twice(kernel::pi(bits)) * sqrt(to_ball(dot(normal_, normal_), bits)));
}

// --- Arc sum ---

// --- Terms ---

namespace {

// (w . n) k . (w x g) times |C| for the direction p of w.
Rational end_term(const ExactVec3& p, const ExactVec3& n, const ExactVec3& c, const RationalVec3& g) {
  return ratio(dot(p, n), dot(p, p)) * dot(to_rational(c), cross(to_rational(p), g));
}

}  // namespace

ArcIntegral::ArcIntegral(const MovingArc& arc, const ExactVec3& n)
    : cross(kernel::cross(arc.begin, arc.end)), squared_cross(dot(cross, cross)), ends_dot(dot(arc.begin, arc.end)) {
  const RationalVec3& g = arc.nearness;
  factor = dot(to_rational(n), g) - ratio(dot(n, cross), squared_cross) * dot(to_rational(cross), g);
  rest = end_term(arc.begin, n, cross, g) - end_term(arc.end, n, cross, g);
}

void ArcSum::add(Integer squared_cross, Integer ends_dot, Rational factor, Rational rest) {
  if (sign(factor) == 0 && sign(rest) == 0) return;
  EXACTFF_EXPECT(sign(squared_cross) > 0);
  terms_.push_back({std::move(squared_cross), std::move(ends_dot), std::move(factor), std::move(rest)});
}

// weight / |C| 2 I.
void ArcSum::add(const ArcIntegral& twice, const Rational& weight) {
  add(twice.squared_cross, twice.ends_dot, twice.factor * weight, twice.rest * weight / Rational(twice.squared_cross));
}

void ArcSum::add_position(const ArcIntegral& twice, int axis) { add(twice, Rational(-twice.cross[axis])); }

void ArcSum::add_normal(const MovingArc& arc, int axis) {
  const ExactVec3 c = cross(arc.begin, arc.end);
  add(dot(c, c), dot(arc.begin, arc.end), Rational(-c[axis]), Rational());
}

void ArcSum::add_weighted(const MovingArc& arc, const ExactVec3& n, const Rational& weight) {
  add(ArcIntegral(arc, n), weight);
}

void ArcSum::add_along(const MovingArc& arc, const ExactVec3& n, const ExactVec3& d) {
  const ArcIntegral twice(arc, n);
  add(twice, Rational(-dot(d, twice.cross)));
}

void ArcSum::add_gain(const MovingArc& arc, const ExactVec3& n, const ExactVec3& d) {
  const ArcIntegral twice(arc, n);
  add(twice, Rational(abs(dot(d, twice.cross))));
}

Ball ArcSum::evaluate(long bits) const {
  Ball sum(bits);
  for (const Term& term : terms_) {
    kernel::poll();
    const Ball norm = sqrt(to_ball(term.squared_cross, bits));
    const Ball theta = atan2(norm, to_ball(term.ends_dot, bits));
    sum = sum + (theta * to_ball(term.factor, bits) / norm + to_ball(term.rest, bits));
  }
  return sum;
}

// --- Cancellation ---

// Two angles are equal if their squared tangents and the signs of their cosines are. Terms with equal angles and equal
// squares of c / |C| cancel if their signs differ. What then remains is the rational part.
bool ArcSum::cancels() const {
  constexpr std::size_t kMostToAdd = 256;  // rational numbers, whose length grows with every one
  using Key = std::tuple<int, Rational, Rational>;
  std::map<Key, long> angles;
  std::map<Rational, long> rests;
  for (const Term& term : terms_) {
    kernel::poll();
    const Integer squared_cosine = term.ends_dot * term.ends_dot;
    const Key key{sign(term.ends_dot),
                  sign(squared_cosine) == 0 ? Rational() : ratio(term.squared_cross, squared_cosine),
                  term.factor * term.factor / Rational(term.squared_cross)};
    if (sign(term.factor) != 0) angles[key] += sign(term.factor);
    if (sign(term.rest) != 0) rests[abs(term.rest)] += sign(term.rest);
  }
  const auto is_even = [](const auto& entry) { return entry.second == 0; };
  if (!std::all_of(angles.begin(), angles.end(), is_even)) return false;
  if (std::all_of(rests.begin(), rests.end(), is_even)) return true;
  if (rests.size() > kMostToAdd) return false;
  Rational sum;
  for (const auto& [rest, count] : rests) sum += rest * count;
  return sign(sum) == 0;
}

// --- Joining ---

namespace {

std::string text_of(const ExactVec3& a) { return a.x.get_str(32) + ' ' + a.y.get_str(32) + ' ' + a.z.get_str(32); }

std::string text_of(const RationalVec3& a) { return a.x.get_str(32) + ' ' + a.y.get_str(32) + ' ' + a.z.get_str(32); }

// One text for one line in space and one side of it: the arc's plane, and the part of g in it.
std::string line_of(const MovingArc& arc) {
  ExactVec3 pole = cross(arc.begin, arc.end);
  make_primitive(pole);
  const RationalVec3 c = to_rational(pole);
  const RationalVec3 within = arc.nearness - c * Rational(dot(c, arc.nearness) / dot(c, c));
  return text_of(pole) + '/' + text_of(within);
}

}  // namespace

std::vector<MovingArc> joined(std::vector<MovingArc> arcs) {
  std::map<std::pair<std::string, std::string>, std::size_t> arc_from;  // by line and beginning
  std::vector<std::string> lines, ends;
  for (MovingArc& arc : arcs) {
    kernel::poll();
    make_primitive(arc.begin);
    make_primitive(arc.end);
    lines.push_back(line_of(arc));
    ends.push_back(text_of(arc.end));
    arc_from[{lines.back(), text_of(arc.begin)}] = ends.size() - 1;
  }
  std::vector<char> follows(arcs.size(), 0);
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    if (const auto next = arc_from.find({lines[i], ends[i]}); next != arc_from.end()) follows[next->second] = 1;
  }
  std::vector<MovingArc> result;
  for (std::size_t first = 0; first < arcs.size(); ++first) {
    if (follows[first] != 0) continue;
    std::size_t last = first;
    for (auto next = arc_from.find({lines[last], ends[last]}); next != arc_from.end();
         next = arc_from.find({lines[last], ends[last]})) {
      last = next->second;
    }
    result.push_back({arcs[first].begin, arcs[last].end, arcs[first].nearness});
  }
  return result;
}

}  // namespace exactff::contour
