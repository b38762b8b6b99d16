// Occluders that almost touch each other, the receiver, the source, or the plane of the receiver or source.
//
// The source is a level square, [-1,1]^2 or similar, that faces down. Where only the profile of the plates in the xz
// plane matters, the plates are wider than the source.
#include <cmath>

#include "stress/family.h"

namespace exactff::stress {

namespace {

constexpr Span kWide{-4, 4};

// Two level plates at half the height of the source: one extends to the left from `left`, the other to the right from
// `right`.
Case two_plates(double s, double left, double right) {
  const Vec3 point{0.3, 0.2, 0};
  Stage stage(point, kUp);
  stage.add_level_source(kSide, kSide, 1);
  stage.add_level_occluder({-4, left}, kWide, 0.5);
  stage.add_level_occluder({right, 4}, kWide, 0.5);
  const LevelView view(point, 1);
  return stage.finish(s, left_by_strips(kUp, view.shadow(kSide, kSide, 1),
                                        {view.shadow({-4, 0.5}, {left, 0.5}), view.shadow({right, 0.5}, {4, 0.5})}));
}

Case crack(double s) { return two_plates(s, 0, 1 / s); }
Case crack_ulp(double s) { return two_plates(s, 0.25, 0.25 + 1 / s); }
Case overlap(double s) { return two_plates(s, 0.25 + 1 / s, 0.25); }

// One level plate between the given receiver and the given source.
Case one_plate(double s, const Vec3& point, double source_z, const Span& x, const Span& y, double z) {
  return plate_before_source(s, {point, kUp, kSide, kSide, source_z, x, y, z});
}

Case near_receiver(double s) { return one_plate(s, {0, 0, 0}, 1, {-0.25 / s, 0.3 / s}, {-0.2 / s, 0.35 / s}, 0.5 / s); }

Case near_source(double s) { return one_plate(s, {0.1, 0.2, -1}, 0, {-0.3, 0.4}, {-0.2, 0.5}, -0.5 / s); }

// Plates with the given profiles before a source at `source_z`.
struct Slat {
  ProfilePoint from, to;
};

Case slats(double s, const Vec3& point, double source_z, const std::vector<Slat>& profiles) {
  Stage stage(point, kUp);
  stage.add_level_source(kSide, kSide, source_z);
  const LevelView view(point, source_z);
  std::vector<Interval> shadows;
  for (const auto& [from, to] : profiles) {
    stage.add_slat(from, to, kWide);
    shadows.push_back(view.shadow(from, to));
  }
  return stage.finish(s, left_by_strips(kUp, view.shadow(kSide, kSide, source_z), std::move(shadows)));
}

Case contact_with_source(double s) { return slats(s, {0.1, 0.2, -1}, 0, {{{-0.45, 0}, {0.55, -0.5 / s}}}); }

Case crossing(double s) {
  const double t = 0.5 / s;
  return slats(s, {0, 0, -1}, 1, {{{-0.25, -0.25 * t}, {0.5, 0.5 * t}}, {{-0.375, 0.375 * t}, {0.5, -0.5 * t}}});
}

// A wall from the receiver's own plane up to half the height of the source: its shadow extends from the wall to
// infinity.
Case wall_beside(double s) {
  const double d = 0.25 / s;
  const Span x{-1, 1.3};
  const Vec3 point{0, 0.2, 0};
  Stage stage(point, kUp);
  stage.add_level_source(x, kSide, 1);
  stage.add_slat({d, 0}, {d, 0.5}, kWide);
  const LevelView view(point, 1);
  return stage.finish(s, left_by_strips(kUp, view.shadow(x, kSide, 1), {{view.along_x(d, 0.5), Rational(8)}}));
}

// Two plates leave a crack of width 2 d. A third plate stands in it, seen edge-on: the receiver is at the distance d
// from its plane.
Case edge_on(double s) {
  const double d = 0.25 / s;
  return slats(s, {0, 0.2, 0}, 1, {{{d, 0.25}, {d, 0.5}}, {{-1, 0.5}, {0, 0.5}}, {{2 * d, 0.5}, {1, 0.5}}});
}

// A bar along x, low at one end and high at the other, and its rotations by quarter turns: each bar lies over the next.
Case pinwheel(double s) {
  const double t = 0.25 / s;
  Stage stage({0.0625, 0.03125, -1}, kUp);
  stage.add_level_source(kSide, kSide, 1);
  std::vector<Vec3> bar = {{-0.5, 0.2, -t}, {0.5, 0.2, t}, {0.5, 0.3, t}, {-0.5, 0.3, -t}};
  for (int k = 0; k < 4; ++k) {
    stage.add_occluder(bar);
    for (Vec3& corner : bar) corner = {corner.y, -corner.x, corner.z};
  }
  return stage.finish(s, std::nullopt);
}

}  // namespace

std::vector<Family> occluder_families() {
  return {
      {{"crack", "Crack between two occluders", "1 / width",
        "Two plates hide everything except a crack. F is proportional to its width, down to 10⁻³⁰⁰. Soon no shadow ray "
        "hits it, and after rounding its two sides coincide."},
       decades(300),
       crack},
      {{"crack-ulp", "Crack of an ulp", "1 / width",
        "The same crack at x = 1/4, where the narrowest crack that doubles can represent is 2⁻⁵⁴ wide."},
       octaves(54, 2),
       crack_ulp},
      {{"overlap", "Overlap of two occluders", "1 / width",
        "The two plates overlap, down to one unit in the last place. F is exactly 0; errors are relative to the "
        "unoccluded form factor."},
       octaves(54, 2),
       overlap},
      {{"near-receiver", "Occluder approaching the receiver", "1 / distance, over 2",
        "A plate approaches the receiver and shrinks, so that its shadow stays the same. Coordinates of 10⁻³⁰⁰ are as "
        "important as those of order 1."},
       decades(300),
       near_receiver},
      {{"near-source", "Occluder approaching the source", "1 / distance, over 2",
        "A plate lies almost on the source. A plate exactly on the source hides nothing."},
       decades(300),
       near_source},
      {{"edge-on", "Occluder seen edge on", "1 / distance of its plane from the receiver, over 4",
        "A third plate stands in the crack between two plates. Its plane almost contains the receiver. The crack and "
        "the shadow of the third plate are as thin as the distance of the receiver from that plane."},
       decades(300),
       edge_on},
      {{"wall-beside", "Wall beside the receiver", "1 / distance of its plane from the receiver, over 4",
        "A wall rises from the receiver's own plane. In the limit it hides half of the source; if its plane contains "
        "the receiver, it hides nothing."},
       decades(300),
       wall_beside},
      {{"contact-with-source", "Occluder nearly in the plane of the source", "1 / slope, over 2",
        "A plate touches the source along a line and rises from it at a vanishing slope. In the source's plane, it "
        "would hide nothing."},
       decades(300),
       contact_with_source},
      {{"crossing", "Occluders that cross", "1 / slope, over 2",
        "Two plates cross each other at a vanishing angle. Their shadows overlap."},
       decades(300),
       crossing},
      {{"pinwheel", "Occluders that overlap in a cycle", "1 / slope, over 2",
        "Four bars, each in front of the next, so that no order from front to back exists.", Evidence::kCertified},
       decades(300),
       pinwheel},
  };
}

}  // namespace exactff::stress
