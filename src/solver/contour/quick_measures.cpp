// Once per piece:
//   1. p, q and w, as for Eq. (4);
//   2. of a tilted receiver: what lies above z's horizon;
//   3. the term of the arc, and of the arc that closes it along the horizon.
#include "contour/quick_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contour/quick_lanes.h"
#include "kernel/vec.h"

namespace exactff::contour {

namespace {

// --- Frame ---

template <class Real>
EXACTFF_INLINE BasicVector<Real> uniform_vector(const Vector& v) {
  const auto component = [&](int i) -> BasicDoubleDouble<Real> {
    return {uniform<Real>(v.c[i].hi), uniform<Real>(v.c[i].lo)};
  };
  return {{component(0), component(1), component(2)}, uniform<Real>(v.norm), uniform<Real>(v.error)};
}

struct FourFrame {
  EXACTFF_INLINE explicit FourFrame(const QuickMeasureFrame& frame)
      : n(uniform_vector<Four>(frame.n)),
        z(uniform_vector<Four>(frame.z)),
        middle(uniform_vector<Four>(frame.middle)),
        closing(uniform_vector<Four>(frame.closing)),
        length_n(uniform<Four>(frame.length_n)),
        three_z(uniform<Four>(3.0 * frame.length_z)),
        eight_up(uniform<Four>(8.0 * frame.normal_up)),
        closing_k(uniform<Four>(frame.closing_k)),
        inverse_z(uniform<Four>(frame.inverse_z)) {}

  FourVector n, z, middle, closing;
  FourBounded length_n, three_z, eight_up, closing_k, inverse_z;
};

// --- Terms ---

struct FourArcs {
  FourVector p, q;
  FourBounded sine;    // |C|, with the sign of w
  FourBounded weight;  // n . C / sine
};

// The length of p, and n . p.
struct FourEnds {
  FourBounded length, height;
};

EXACTFF_INLINE FourEnds ends_of(const FourFrame& frame, const FourVector& p) {
  return {square_root(dot(p, p)), dot(frame.n, p)};
}

// Step 3: fan; or the bracket in the sum of the overcast sky, where `up_cross` returns z . C.
template <bool kOvercast, class UpCross>
EXACTFF_INLINE FourBounded term(const FourFrame& frame, const FourArcs& arc, const AngleConstants& known,
                                const UpCross& up_cross) {
  const FourEnds p = ends_of(frame, arc.p), q = ends_of(frame, arc.q);
  const FourBounded cosine = dot(arc.p, arc.q), lengths = p.length * q.length, e = lengths + cosine;
  const FourBounded s = sum_of_products(p.height, q.length, q.height, p.length);
  const FourBounded fan = atan2(arc.sine * arc.weight, frame.length_n * e + s, known);
  if constexpr (!kOvercast) {
    return fan;
  } else {
    const FourBounded lambert = frame.three_z * (atan2(arc.sine, cosine, known) * arc.weight);
    const FourBounded second = (uniform<Four>(4.0) * s * up_cross()) / (lengths * e);
    return (lambert + frame.eight_up * fan) + second;
  }
}

// --- Pieces ---

struct FourPieces {
  FourOf<QuickLine> line;
  FourPoints p, q;
  FourBounded w;

  // C is the line's a x b times `factor`.
  [[nodiscard]] EXACTFF_INLINE FourArcs arcs(const FourVector& begin, const FourVector& end,
                                             const FourBounded& factor) const {
    return {begin, end, factor * gather(line, &QuickLine::size), gather(line, &QuickLine::weight)};
  }
  [[nodiscard]] EXACTFF_INLINE FourBounded up_cross(const FourFrame& frame, const FourBounded& factor) const {
    return factor * dot(frame.z, gather(line, &QuickLine::cross));
  }
};

// Step 1.
EXACTFF_INLINE FourPieces located(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines) {
  const FourOf<QuickPiece> piece = four_of(pieces);
  const FourEdges edges = edges_of(piece, lines);
  const FourPoints p = locate(edges, piece, &QuickPiece::begin, lines);
  const FourPoints q = locate(edges, piece, &QuickPiece::end, lines);
  return {edges.line, p, q, sum_of_products(p.s, q.m, -p.m, q.s)};
}

// Step 2, for one end: whether it is certainly above z's horizon, or certainly not.
struct FourHeights {
  FourBounded height;
  FourMask above{}, not_above{};
};

EXACTFF_INLINE FourHeights heights_of(const FourFrame& frame, const std::array<bool, 3>& up_is_zero,
                                      const FourVector& p) {
  FourMask is_zero = p.error == 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!up_is_zero[axis]) is_zero = both(is_zero, p.c[axis].hi == 0.0);
  }
  const FourBounded height = where(is_zero, FourBounded{}, dot(frame.z, p));
  const FourMask certain = sign_is_certain(height);
  return {height, both(certain, height.hi > 0.0), either(is_zero, both(certain, height.hi < 0.0))};
}

EXACTFF_INLINE FourBounded tilted_terms(const FourFrame& frame, const std::array<bool, 3>& up_is_zero,
                                        const FourPieces& pieces, const AngleConstants& known) {
  const FourVector &p = pieces.p.direction, &q = pieces.q.direction;
  const FourHeights at_p = heights_of(frame, up_is_zero, p), at_q = heights_of(frame, up_is_zero, q);
  const FourMask certain = both(either(at_p.above, at_p.not_above), either(at_q.above, at_q.not_above));
  const FourMask below = both(at_p.not_above, at_q.not_above), cut = differ(at_p.above, at_q.above);
  FourArcs arc = pieces.arcs(p, q, pieces.w);
  FourBounded factor = pieces.w, closing{};
  if (in_some_lane(cut)) {
    const FourBounded high = absolute(at_p.height), low = absolute(at_q.height);
    const Four scale = inverse_power_of_two(high.hi + low.hi);
    const FourBounded of_p = scaled(low, scale), of_q = scaled(high, scale);
    const FourVector c = combination(of_p, p, of_q, q);
    factor = where(cut, pieces.w * where(at_p.above, of_q, of_p), pieces.w);
    arc = pieces.arcs(where(both(cut, at_q.above), c, p), where(both(cut, at_p.above), c, q), factor);
    const FourBounded up_cross = dot(frame.closing, c);  // z . (c x m)
    const FourArcs along{c, frame.middle, up_cross * frame.inverse_z, frame.closing_k};
    const FourBounded found = term<true>(
        frame, along, known, [&]() __attribute__((always_inline)) { return up_cross; });
    closing = where(cut, negated_where(at_q.above, found), FourBounded{});
  }
  const FourBounded kept = term<true>(
      frame, arc, known, [&]() __attribute__((always_inline)) { return pieces.up_cross(frame, factor); });
  return only_where(certain, where(below, FourBounded{}, kept + closing));
}

template <MeasureTerms kTerms>
EXACTFF_INLINE FourBounded terms(const FourFrame& frame, const std::array<bool, 3>& up_is_zero,
                                 std::span<const QuickPiece> some, std::span<const QuickLine> lines,
                                 const AngleConstants& known) {
  const FourPieces pieces = located(some, lines);
  if constexpr (kTerms == MeasureTerms::kTilted) {
    return tilted_terms(frame, up_is_zero, pieces, known);
  } else {
    const FourArcs arc = pieces.arcs(pieces.p.direction, pieces.q.direction, pieces.w);
    return term<kTerms == MeasureTerms::kUpright>(
        frame, arc, known, [&]() __attribute__((always_inline)) { return pieces.up_cross(frame, pieces.w); });
  }
}

template <MeasureTerms kTerms>
EXACTFF_INLINE void fill_terms(const QuickMeasureFrame& frame, std::span<const QuickPiece> pieces,
                               std::span<const QuickLine> lines, const AngleConstants& known,
                               std::span<Bounded> result) {
  const FourFrame four(frame);
  for (std::size_t i = 0; i < pieces.size(); i += kLanes) {
    const std::size_t count = std::min(kLanes, pieces.size() - i);
    const FourBounded found = terms<kTerms>(four, frame.up_is_zero, pieces.subspan(i, count), lines, known);
    for (std::size_t k = 0; k < count; ++k) result[i + k] = lane(found, k);
  }
}

EXACTFF_CLONES
void solid_angle_terms(const QuickMeasureFrame& frame, std::span<const QuickPiece> pieces,
                       std::span<const QuickLine> lines, const AngleConstants& known, std::span<Bounded> result) {
  fill_terms<MeasureTerms::kSolidAngle>(frame, pieces, lines, known, result);
}
EXACTFF_CLONES
void upright_terms(const QuickMeasureFrame& frame, std::span<const QuickPiece> pieces, std::span<const QuickLine> lines,
                   const AngleConstants& known, std::span<Bounded> result) {
  fill_terms<MeasureTerms::kUpright>(frame, pieces, lines, known, result);
}
EXACTFF_CLONES
void tilted_terms(const QuickMeasureFrame& frame, std::span<const QuickPiece> pieces, std::span<const QuickLine> lines,
                  const AngleConstants& known, std::span<Bounded> result) {
  fill_terms<MeasureTerms::kTilted>(frame, pieces, lines, known, result);
}

}  // namespace

QuickMeasure::QuickMeasure(const Measure& measure, const Vec3& n) : measure_(measure), n_(n) {
  frame_.terms = terms_of(measure, n);
  frame_.n = vector_of<double>(scaled_normal(n));
  frame_.length_n = square_root(dot(frame_.n, frame_.n));
  if (frame_.terms == MeasureTerms::kSolidAngle) return;
  const auto up = scaled_normal(measure.up);
  frame_.z = vector_of<double>(up);
  // 0 as doubles that are not scaled, which loses nothing.
  frame_.up_is_zero = {measure.up.x == 0.0, measure.up.y == 0.0, measure.up.z == 0.0};
  frame_.length_z = square_root(dot(frame_.z, frame_.z));
  frame_.normal_up = dot(frame_.n, frame_.z);
  frame_.middle = combination(dot(frame_.z, frame_.z), frame_.n, -frame_.normal_up, frame_.z);
  frame_.closing = cross(frame_.middle, frame_.z);
  frame_.closing_k = frame_.normal_up / frame_.length_z;
  frame_.inverse_z = Bounded{1.0, 0.0, 0.0} / frame_.length_z;
}

void QuickMeasure::find_terms(std::span<const QuickPiece> pieces, std::span<const QuickLine> lines,
                              std::span<Bounded> terms) const {
  switch (frame_.terms) {
    case MeasureTerms::kSolidAngle:
      return solid_angle_terms(frame_, pieces, lines, angle_constants(), terms);
    case MeasureTerms::kUpright:
      return upright_terms(frame_, pieces, lines, angle_constants(), terms);
    case MeasureTerms::kTilted:
      return tilted_terms(frame_, pieces, lines, angle_constants(), terms);
    case MeasureTerms::kNone:
      std::ranges::fill(terms, Bounded{});
  }
}

QuickContour::Value QuickMeasure::value(const Bounded& sum) const {
  const Bounded pi = constant(angle_constants().pi);
  const Bounded result = measure_.kind == MeasureKind::kOvercast
                             ? -sum / (14.0 * pi * frame_.length_n * frame_.length_z)
                         : measure_.kind == MeasureKind::kSolidAngle ? -2.0 * sum
                                                                     : -sum / (2.0 * pi);
  return value_of(result);
}

}  // namespace exactff::contour
