// Scenes of rays, shafts that leave out occluders, and closed forms of the adaptive algorithm.
#include <gtest/gtest.h>

#include "adaptive/sampled_scene.h"
#include "adaptive/shaft.h"
#include "adaptive/sub_patch.h"
#include "exactff/adaptive.h"
#include "kernel/numbers.h"
#include "support/random_scenes.h"
#include "support/shapes.h"
#include "support/test.h"
#include "unit/rivals/sampled_scenes.h"

namespace exactff::adaptive {
namespace {

RayEnds place(const SubPatch& s, SamplePattern pattern, int rays, std::uint64_t key = 7) {
  SamplePlan plan;
  plan.prepare(pattern, rays);
  RayEnds ends;
  ends.resize(plan.ray_count());
  plan.place(s, key, ends);
  return ends;
}

std::vector<Vec3> points(const RayEnds& ends) {
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < static_cast<std::size_t>(ends.count); ++i) {
    result.push_back({ends.x[i], ends.y[i], ends.z[i]});
  }
  return result;
}

std::string refusal(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  return complaint([&] { const AdaptiveSolver solver(scene); });
}

TEST(SinglePrecision, MergedVerticesAreRefusedByName) {
  PlainScene plain = validation::open_scene();
  add(plain, "sliver", {{0, 0.9, 0.5}, {0.25, 0.9, 0.5}, {0.25, 0.9 + 1e-9, 0.5}});
  const std::string message = refusal(plain);
  EXPECT_HOLDS(message, "face 'sliver'");
  EXPECT_HOLDS(message, "merges");
  EXPECT_HOLDS(message, "the sampled methods refuse");
}

TEST(SinglePrecision, CollapsedFacesAreRefusedByName) {
  PlainScene plain = validation::open_scene();
  add(plain, "needle", {{-0.75, 0.9, 0.5}, {0.5, 0.9, 0.5}, {0.25, 0.9 + 1e-12, 0.5}});
  const std::string message = refusal(plain);
  EXPECT_HOLDS(message, "face 'needle'");
  EXPECT_HOLDS(message, "collapses");
}

// Twenty triangles in front of the source, in a box of size `thickness` along z and 1 along the other axes.
PlainScene thin_scene(double thickness) {
  PlainScene plain;
  add(plain, "source", {{-0.5, -0.5, thickness}, {-0.5, 0.5, thickness}, {0.5, 0.5, thickness}});
  for (int i = 0; i < 20; ++i) {
    const double x = -0.5 + i / 20.0, z = thickness * (i % 5) / 5.0;
    add(plain, "slats", {{x, -0.5, z}, {x + 0.04, -0.5, z + thickness / 9.0}, {x, 0.5, z}});
  }
  return plain;
}

TEST(SinglePrecision, ScenesTooThinForEmbreeAreRefusedByName) {
  EXPECT_EQ(refusal(thin_scene(0x1p-70)), "");
  for (const double thickness : {0x1p-100, 0x1p-110, 0x1p-125, 0x1p-140}) {
    const std::string message = refusal(thin_scene(thickness));
    EXPECT_HOLDS(message, "face 's");
    EXPECT_HOLDS(message, "along z is below 2^-100 (7.9e-31) of the scene's size");
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one message is enough: " << message;
    EXPECT_HOLDS(message, "the sampled methods refuse");
  }
}

TEST(SinglePrecision, FewFacesMayBeAsThinAsFloatsAre) {
  PlainScene plain = thin_scene(0x1p-110);
  plain.patches[1].faces.resize(kMostPiecesWithoutEmbree - 1);
  EXPECT_EQ(refusal(plain), "");
}

// Such coordinates arise as products of cos(pi / 2) in double, for example at the pole of a sphere.
TEST(SinglePrecision, NoiseBesideTheMiddleIsTakenForTheMiddle) {
  PlainScene plain = thin_scene(0.5);
  for (Vec3& v : plain.vertices) {
    if (std::abs(v.x) < 1e-9) v.x = 1e-35;
  }
  EXPECT_EQ(refusal(plain), "");
}

// Shaft culling never loses an occluder and never reports a cut that does not exist: it is compared with exact segments
// and with the unculled list.

SubPatch random_sub_patch(Random& random) {
  const double size = random.one_in(2) ? 1.0 : random.between(1e-6, 1.0);
  const Vec3 at{random.between(-1, 1), random.between(-1, 1), 1.0};
  std::vector<Vec3> corners = {{0, 0, 0}, {0, size, 0}, {size, size, 0}, {size, 0, 0}};
  if (random.one_in(2)) corners.pop_back();
  for (Vec3& c : corners) c = c + at;
  return make_sub_patch(corners);
}

// A triangle or parallelogram that sometimes meets the pyramid; half of the time on a lattice, so that it touches.
std::vector<Vec3> random_occluder(Random& random, const SubPatch& s) {
  const double t = random.between(0.2, 0.9);
  const Vec3 centre = (s.corner(0) + s.corner(2)) * (0.5 * t);
  const double size = random.between(0.1, 3.0) * length(s.corner(2) - s.corner(0));
  const auto offset = [&] { return random.between(-size, size); };
  if (random.one_in(2)) {  // a scaled copy of the patch, moved along its own edges: shares side planes with the shaft
    const Vec3 shift = (s.corner(1) - s.corner(0)) * (0.5 * random.integer(-2, 2) * t);
    std::vector<Vec3> copy;
    for (int i = 0; i < s.corner_count(); ++i) copy.push_back(s.corner(i) * t + shift);
    return copy;
  }
  std::vector<Vec3> corners(3);
  for (Vec3& c : corners) c = centre + Vec3{offset(), offset(), 0.3 * offset()};
  if (random.one_in(2)) corners.push_back(corners[0] + (corners[2] - corners[1]));
  return corners;
}

// The face as seen from the origin; nothing if the origin lies in its plane.
std::optional<SeenPolygon> seen_from_origin(const std::vector<Vec3>& corners) {
  SeenPolygon seen;
  seen.corners = corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    seen.edges.push_back(corners[(i + 1) % corners.size()] - corners[i]);
  }
  const Normal front = plane_normal(corners[0], corners[1], corners[2]);
  seen.normal = {-front.value, front.magnitude};
  const int side = kernel::orientation(corners[0], corners[1], corners[2], Vec3{});
  if (side == 0) return std::nullopt;
  if (side < 0) seen.reverse();
  return seen;
}

// Exact test: the open segment from the origin to y meets the interior of the triangle a, b, c.
bool meets_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& y) {
  const Vec3 x{};
  const int before = kernel::orientation(a, b, c, x);
  const int after = kernel::orientation(a, b, c, y);
  if (before == 0 || after != -before) return false;
  const int first = kernel::orientation(x, y, a, b);
  return first != 0 && kernel::orientation(x, y, b, c) == first && kernel::orientation(x, y, c, a) == first;
}

bool meets(const std::vector<Vec3>& polygon, const Vec3& y) {
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    if (meets_triangle(polygon[0], polygon[i], polygon[i + 1], y)) return true;
  }
  return false;
}

constexpr double kReach = 8.0;

struct Seen {
  int culled = 0;
  int cut = 0;
  int kept = 0;
};

TEST(ShaftCull, AgreesWithExactSegments) {
  Random random(11);
  Seen seen;
  const std::uint64_t rounds = validation::scaled_count(240);
  for (std::uint64_t round = 0; round < rounds; ++round) {
    const SubPatch s = random_sub_patch(random);
    const std::vector<Vec3> corners = random_occluder(random, s);
    const auto polygon = seen_from_origin(corners);
    if (!polygon) continue;
    OccluderSet set;
    set.add(*polygon, kReach);
    const auto list = set.inherit(set.push_all(), s, ShaftSides(s));
    const std::vector<Vec3> ends = points(place(s, SamplePattern::kJittered, 16, random.bits()));
    const auto hidden = std::count_if(ends.begin(), ends.end(), [&](const Vec3& y) { return meets(corners, y); });
    if (!list) {
      EXPECT_EQ(hidden, 16) << "cut in round " << round;
      ++seen.cut;
    } else if (list->empty()) {
      EXPECT_EQ(hidden, 0) << "culled in round " << round;
      ++seen.culled;
    } else {
      ++seen.kept;
    }
  }
  EXPECT_GT(seen.cut, 10);
  EXPECT_GT(seen.culled, 10);
  EXPECT_GT(seen.kept, 10);
}

SubPatch square(double h, double z) {
  const std::vector<Vec3> corners = {{-h, -h, z}, {-h, h, z}, {h, h, z}, {h, -h, z}};
  return make_sub_patch(corners);
}

// Four edges, each with a handful of roundings and an atan2 within 1 ulp: 32 ulp is generous for well-placed patches.
constexpr double kBound = 32 * 0x1p-53;

// Below h/r = 1/8 the series replaces atan2; on both sides F must be the same function.
TEST(ClosedForm, SeriesAndArcTangentAgree) {
  for (double h = 1.0; h > 1e-3; h *= 0.93) {
    const SubPatch whole = square(h, 4.0);
    double parts = 0.0;
    for (const SubPatch& part : split_patch(whole)) parts += unoccluded_form_factor(part, {0, 0, 1});
    const double f = unoccluded_form_factor(whole, {0, 0, 1});
    // Splitting adds edges through the middle, which cancel: relative loss about r/h.
    EXPECT_NEAR(parts, f, kBound * f * (4.0 / h)) << h;
  }
}

}  // namespace
}  // namespace exactff::adaptive
