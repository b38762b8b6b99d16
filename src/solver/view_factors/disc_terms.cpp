#include "view_factors/disc_terms.h"

namespace exactff::view_factors {
namespace {

using kernel::BasicDisc;
using kernel::uniform;
using kernel::disc::kFailed;
using kernel::double_double::both;
using kernel::double_double::in_every_lane;
using kernel::lanes::Four;

template <class Real>
struct At {
  BasicDisc<Real> s, t;

  [[nodiscard]] EXACTFF_INLINE BasicDisc<Real> of(const Bilinear& f) const {
    const auto k = [&](std::size_t i) { return uniform<Real>({f.centres[i], f.radii[i]}); };
    return k(0) + k(2) * t + s * (k(1) + k(3) * t);
  }
  [[nodiscard]] EXACTFF_INLINE BasicDisc<Real> of(const DiscFunction& f) const { return of(f.on_square); }
};

template <class Real>
EXACTFF_INLINE BasicDisc<Real> fraction_of(const DiscTerm::End& end, const At<Real>& at) {
  if (!end.is_crossing) return uniform<Real>({end.fraction, 0.0});
  return at.of(end.above) / at.of(end.below);
}

// T of the header.
template <class Real>
EXACTFF_INLINE BasicDisc<Real> value_of(const DiscTerm& term, const At<Real>& at) {
  const BasicDisc<Real> along = at.of(term.along), nu = at.of(term.height);
  const BasicDisc<Real> squared = square(at.of(term.across)) + square(at.of(term.beyond));  // d^2
  const BasicDisc<Real> from = fraction_of(term.from, at), to = fraction_of(term.to, at);
  const BasicDisc<Real> size = uniform<Real>(term.size);
  const BasicDisc<Real> p = along + size * from, q = along + size * to;  // their components along l
  const BasicDisc<Real> between = size * (to - from);                    // D
  const BasicDisc<Real> product = p * q + squared;                       // p.q
  const BasicDisc<Real> roots = square_root(square(p) + squared) * square_root(square(q) + squared);
  if (!in_every_lane(is_finite(roots))) return roots;  // the usual failure: P or Q may be met
  const auto is_near = product.centre > 0.0;
  const auto turns = both(!is_near, is_negative(between));  // P and Q have changed places: T is odd
  const BasicDisc<Real> distance = where(turns, -between, between);
  const BasicDisc<Real> w = distance / (roots + where(is_near, product, -product));
  const BasicDisc<Real> near = nu * w * atan_of_root(square(w) * squared) * uniform<Real>(kernel::kInversePi);
  if (in_every_lane(is_near)) return near;
  BasicDisc<Real> half;
  if (!term.in_receiver_plane) {
    half = 0.5 * (nu / square_root(squared));
  } else {
    half = uniform<Real>(term.side != 0.0 ? Disc{0.5 * term.side, 0.0} : kFailed);
  }
  // The factor only widens the disc: published values keep their last bits.
  const BasicDisc<Real> wide = 1.0 * only_where(is_positive(distance), half - near);
  return where(is_near, near, where(turns, -wide, wide));
}

// Fails in every lane if it fails in one.
template <class Real>
EXACTFF_INLINE BasicDisc<Real> value_of(const DiscSum& sum, const At<Real>& at) {
  BasicDisc<Real> result = uniform<Real>({sum.constant, 0.0});
  for (const DiscTerm& term : sum.terms) {
    const BasicDisc<Real> one = value_of(term, at);
    if (!in_every_lane(is_finite(one))) return uniform<Real>(kFailed);
    result = term.sign > 0.0 ? result - one : result + one;
  }
  return result;
}

EXACTFF_INLINE BasicDisc<Four> gathered(const Disc& a, const Disc& b, const Disc& c, const Disc& d) {
  return {Four{a.centre, b.centre, c.centre, d.centre}, Four{a.radius, b.radius, c.radius, d.radius}};
}
EXACTFF_INLINE BasicDisc<Four> gathered(const FourDiscs& a) { return gathered(a[0], a[1], a[2], a[3]); }

EXACTFF_CLONES void evaluate_four(const DiscSum& sum, const FourDiscs& s, const FourDiscs& t, FourDiscs& found) {
  const At<Four> at{gathered(s), gathered(t)};
  const BasicDisc<Four> product = value_of(sum, at) * at.of(sum.jacobian);
  for (std::size_t i = 0; i < 4; ++i) found[i] = {product.centre[i], product.radius[i]};
}

EXACTFF_INLINE Bilinear bilinear(const BasicDisc<Four>& k) {
  Bilinear result;
  kernel::lanes::store(k.centre, result.centres.data());
  kernel::lanes::store(k.radius, result.radii.data());
  return result;
}

// The dot products of `from`, a, b and c with the gradient, a lane for each.
EXACTFF_INLINE void put_on_square(DiscFunction& f, const SquareMap& map) {
  const auto with = [&](Disc DiscVec::*part) {
    return gathered(f.from.*part, map.a.*part, map.b.*part, map.c.*part) * uniform<Four>(f.gradient.*part);
  };
  const BasicDisc<Four> product = with(&DiscVec::x) + with(&DiscVec::y) + with(&DiscVec::z);
  f.on_square = bilinear({product.centre * Four{1.0, -1.0, -1.0, -1.0}, product.radius});
}

EXACTFF_INLINE void put_on_square(DiscTerm::End& end, const SquareMap& map) {
  if (!end.is_crossing) return;
  put_on_square(end.above, map);
  put_on_square(end.below, map);
}

EXACTFF_CLONES void put_on_square(std::vector<DiscTerm>& terms, const SquareMap& map) {
  for (DiscTerm& term : terms) {
    for (DiscFunction* f : {&term.along, &term.across, &term.beyond, &term.height}) put_on_square(*f, map);
    put_on_square(term.from, map);
    put_on_square(term.to, map);
  }
}

}  // namespace

void take(DiscSum& sum, const SquareMap& map, const DiscVec& normal) {
  put_on_square(sum.terms, map);
  const auto& [a, b, c] = map;
  sum.jacobian = bilinear(gathered(dot(normal, cross(a, b)), dot(normal, cross(a, c)), dot(normal, cross(c, b)), {}));
}

Disc value_of(const DiscSum& sum, const Disc& s, const Disc& t) { return value_of(sum, At<double>{s, t}); }

Disc jacobian_of(const DiscSum& sum, const Disc& s, const Disc& t) { return At<double>{s, t}.of(sum.jacobian); }

FourDiscs integrands_of(const DiscSum& sum, const FourDiscs& s, const FourDiscs& t) {
  FourDiscs found;
  evaluate_four(sum, s, t, found);
  return found;
}

}  // namespace exactff::view_factors
