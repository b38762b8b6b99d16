// No occluder hides anything here: the source is near, far, small, thin, or barely above the horizon.
#include "stress/family.h"

namespace exactff::stress {

namespace {

Interval relative(const Span& span, double origin) {
  return {kernel::to_rational(span.low) - kernel::to_rational(origin),
          kernel::to_rational(span.high) - kernel::to_rational(origin)};
}

// An unoccluded level source.
Case level_source(double stiffness, const Vec3& point, const Vec3& normal, const Span& x, const Span& y, double z) {
  Stage stage(point, normal);
  stage.add_level_source(x, y, z);
  ClosedForm truth(normal);
  truth.add(LevelView(point, z).shadow(x, y, z));
  return stage.finish(stiffness, std::move(truth));
}

Case approach_interior(double s) { return level_source(s, {0.3, 0.2, 0}, kUp, {-1, 1}, {-1, 1}, 1 / s); }
Case approach_edge(double s) { return level_source(s, {0, 0.2, 0}, kUp, {0, 1}, {-1, 1}, 1 / s); }
Case approach_vertex(double s) { return level_source(s, {0, 0, 0}, kUp, {0, 1}, {0, 1}, 1 / s); }

Case shrink(double s) { return level_source(s, {100, 37, -50}, kUp, {-0.5 / s, 0.5 / s}, {-0.5 / s, 0.5 / s}, 0); }

Case recede(double s) { return level_source(s, {100 * s, 37 * s, -50 * s}, kUp, {-0.5, 0.5}, {-0.5, 0.5}, 0); }
Case sliver(double s) { return level_source(s, {0.7, 0.2, 0}, kUp, {0, 1 / s}, {-0.4, 1}, 0.5); }

Case foot_of_wall(double s) {
  const Vec3 point{0, 0.2, 0};
  const double d = 1 / s;
  Stage stage(point, kUp);
  stage.add_source({{d, -1, 0}, {d, -1, 1}, {d, 1, 1}, {d, 1, 0}});
  ClosedForm truth(kUp);
  truth.add({0, kernel::to_rational(d), relative({-1, 1}, point.y), relative({0, 1}, point.z)});
  return stage.finish(s, std::move(truth));
}

// A wall in the plane y = 1. Only its part from the receiver's height `z` up to `top` is above the horizon.
Case wall_over_horizon(double s, double z, double top) {
  const Vec3 point{0, 0, z};
  const Span x{-0.5, 0.75};
  Stage stage(point, kUp);
  stage.add_source({{x.low, 1, z - 1}, {x.high, 1, z - 1}, {x.high, 1, top}, {x.low, 1, top}});
  ClosedForm truth(kUp);
  truth.add({1, 1, relative({z, top}, z), relative(x, 0)});
  return stage.finish(s, std::move(truth));
}

Case horizon_grazed(double s) { return wall_over_horizon(s, 0, 1 / s); }
Case horizon_ulp(double s) { return wall_over_horizon(s, 1, 1 + 1 / s); }

// The horizon cuts the level square [-1,1]^2 along x = 1 - 1/s.
Case horizon_tilted(double s) {
  const double cut = 1 - 1 / s;
  const Vec3 normal{1, 0, -cut};
  Stage stage({0, 0, 0}, normal);
  stage.add_level_source({-1, 1}, {-1, 1}, 1);
  ClosedForm truth(normal);
  truth.add({2, 1, relative({cut, 1}, 0), relative({-1, 1}, 0)});
  return stage.finish(s, std::move(truth));
}

}  // namespace

std::vector<Family> distance_families() {
  return {
      {{"approach-interior", "Receiver approaching the inside of the source", "1 / distance",
        "The receiver approaches a square of side 2 from below, away from its centre. F tends to 1: every edge "
        "subtends almost 180°."},
       decades(300),
       approach_interior},
      {{"approach-edge", "Receiver approaching an edge of the source", "1 / distance",
        "The receiver approaches a point of an edge from right below. F tends to 1/2. The edge subtends almost 180°, "
        "where a × b vanishes compared with a · b."},
       decades(300),
       approach_edge},
      {{"approach-vertex", "Receiver approaching a vertex of the source", "1 / distance",
        "The receiver approaches a corner from right below. F tends to 1/4. In the limit, two edges end at the "
        "receiver."},
       decades(300),
       approach_vertex},
      {{"foot-of-wall", "Receiver at the foot of a wall", "1 / distance",
        "The receiver approaches a wall that stands on its surface at a right angle. F tends to 1/2. A program that "
        "drops perpendicular pairs returns 0."},
       decades(300),
       foot_of_wall},
      {{"shrink", "Source shrinking", "1 / side",
        "A square off the receiver's axis, at (100, 37, 50), shrinks. The terms of its edges fall with its side, but F "
        "falls with the square of the side, to 10⁻²⁸⁵. The terms cancel almost completely."},
       decades(140),
       shrink},
      {{"recede", "Source receding", "distance / side, over 118",
        "A unit square off the receiver's axis recedes. Differences of its coordinates are lost in rounding: a program "
        "computes zero or noise."},
       decades(140),
       recede},
      {{"sliver", "Sliver as source", "aspect ratio, over 1.4",
        "A rectangle of length 1.4 becomes thinner. Its two long edges almost coincide and their terms cancel."},
       decades(300),
       sliver},
      {{"horizon-grazed", "Source hardly above the horizon", "1 / height above the horizon",
        "A wall crosses the receiver's horizon (the plane of its surface), and less and less of the wall rises above "
        "it. F falls with the square of that height. Without clipping at the horizon, Eq. (4) returns the part above "
        "minus the part below; the printed listing drops the pair and returns 0."},
       decades(150),
       horizon_grazed},
      {{"horizon-ulp", "Source above the horizon by an ulp", "1 / height above the horizon",
        "The same with the receiver at height 1. The last wall rises above the horizon by one unit in the last place "
        "of its coordinates."},
       octaves(52),
       horizon_ulp},
      {{"horizon-tilted", "Horizon leaving a strip of the source", "1 / width left",
        "The receiver turns away until only a strip of the square is above its horizon, down to a width of 2⁻⁵². Both "
        "the strip and the cosine at the receiver vanish."},
       octaves(52),
       horizon_tilted},
  };
}

}  // namespace exactff::stress
