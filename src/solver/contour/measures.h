// The other measures (exact.h) of a visible region, in ball arithmetic over the same boundary as Eq. (4) (contour.h).
//
// Notation: an arc of the boundary runs from direction p to q, less than a half turn; the region is on its left as x
// sees it. C = p x q, k = C / |C|, theta = atan2(|C|, p . q). n is the receiver's normal, z is `up`. Unit vectors have
// a hat. The region lies above the horizon, so that n . p, n . q >= 0. With
//   E = |p||q| + p . q,   S = (n . p) |q| + (n . q) |p|,   fan = atan2(n . C, |n| E + S)
// the integrals over the region are sums over its arcs:
//   Phi   = integral of n^ . w            = - sum  1/2 theta n^ . k                                      (pi F)
//   sigma = integral of 1                 = - sum  2 fan
//   M     = integral of (n^ . w)(z^ . w)  = 1/3 [ (n^ . z^) sigma - sum S (z . C) / (|n||z| |p||q| E) ]
// and the share of an overcast sky is 3 / (7 pi) (Phi + 2 M), since open ground has Phi = pi and M = 2 pi / 3:
//   - 1 / (14 pi |n||z|) sum [ 3 |z| theta n . k + 8 (n . z) fan + 4 S (z . C) / (|p||q| E) ].
//
// sigma: with polar coordinates (t, f) around n^, the element of area sin t dt df is d((1 - cos t) df), and this form
// is smooth except at -n^, which is outside the region. So sigma is the sum of its integrals along the arcs. That of
// one arc is the signed area of the triangle (n^, p^, q^), whose other sides are meridians: 2 fan up to the sign (A.
// van Oosterom, J. Strackee, "The solid angle of a plane triangle", 1983). Its magnitude is at most pi: an arc of less
// than a half turn spans at most pi of longitude, and 0 <= 1 - cos t <= 1 above the horizon. So the fan is in [-pi/2,
// pi/2], and atan2 is its right branch: |n| E + S >= 0, and even > 0 since p and q are not opposite. In general, for
// any n whose opposite is outside the region, fan and arc differ by no whole turn: cos and sin of the half area are
// proportional, by a positive factor, to the two arguments (for p = q, and by continuity for all p, q, n of which no
// two are opposite and as long as -n^ is not on the arc). This is used for spheres, where n is only near a normal that
// has all of the region above its horizon.
//
// M: J. Arvo, "Applications of irradiance tensors to the simulation of non-Lambertian phenomena", SIGGRAPH '95, order
// 2, with tan(theta / 2) / |C| = 1 / E. It is symmetric in n and z as a whole sum.
//
// The horizon of z. If n and z are not parallel, only what is above z's horizon counts. A boundary that is cut there
// is closed along it, from every place where it crosses downwards to one where it crosses upwards. All these places,
// and all that has to be closed, lie on the half circle { z . w = 0, n . w >= 0 } with the middle m = (z . z) n - (n .
// z) z, so it does not matter which place follows which: each downward crossing c contributes the arc from c to m, each
// upward one the arc from m to c, and what is counted too much cancels. These arcs are quarter turns at most. A corner
// on z's horizon counts as below it. The region has a part above z's horizon if and only if an arc has: otherwise it
// would hold all that is above both horizons, whose boundary on n's horizon would then be among its arcs.
#pragma once

#include <vector>

#include "exactff/exact.h"
#include "kernel/ball.h"
#include "kernel/numbers.h"
#include "visibility/outlines.h"

namespace exactff::contour {

// Which of the sums above a receiver with the normal n needs.
enum class MeasureTerms {
  kSolidAngle,
  kUpright,  // overcast, n and z are parallel
  kTilted,   // overcast
  kNone,     // overcast, n and z are opposite: nothing is above both horizons
};
[[nodiscard]] MeasureTerms terms_of(const Measure& measure, const Vec3& n);

// The largest double that a bound needs: the first that is not below any value of the measure.
[[nodiscard]] double most_of(const Measure& measure);

class MeasureIntegral {
 public:
  // Requires a measure other than the form factor.
  explicit MeasureIntegral(const Measure& measure) : measure_(measure), up_(kernel::exact_vector(measure.up).v) {}

  // The normal for the pieces that are added from now on: the receiver's; of a sphere, any one above whose horizon the
  // pieces' region lies.
  void start(const Vec3& n);
  // Requires that a x b is not zero.
  void add(const visibility::BoundaryPiece& piece);
  // All directions above the horizon.
  void add_hemisphere();

  // True if nothing of the regions counts: then the measure is exactly 0.
  [[nodiscard]] bool empty() const { return terms_.empty(); }
  // Encloses the measure of the closed regions added so far, computed with `bits` bits.
  [[nodiscard]] Ball evaluate(long bits) const;

 private:
  struct Term {
    kernel::Integer squared_p, squared_q, squared_cross, ends_dot;
    kernel::Integer normal_p, normal_q, normal_cross, up_cross;  // dot products
    kernel::Integer squared_normal, normal_up;
  };
  void add(const kernel::ExactVec3& p, const kernel::ExactVec3& q);
  void add_above(const kernel::ExactVec3& p, const kernel::ExactVec3& q);

  Measure measure_;
  kernel::ExactVec3 up_, normal_, middle_;
  MeasureTerms kind_ = MeasureTerms::kSolidAngle;
  std::vector<Term> terms_;
};

// What the measure is for all directions that count. A ball of exactly 1 where it is 1.
[[nodiscard]] Ball whole_measure(const Measure& measure, const Vec3& n, long bits);

}  // namespace exactff::contour
