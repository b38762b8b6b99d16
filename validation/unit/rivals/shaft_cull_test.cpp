// Shaft culling never loses an occluder and never reports a cut that does not exist. The test compares it with exact
// segments and with the unculled list. EXACTFF_TEST_SCALE multiplies the number of scenes.
#include <gtest/gtest.h>

#include <algorithm>

#include "adaptive/sampled_scene.h"
#include "adaptive/shaft.h"
#include "kernel/numbers.h"
#include "support/random_scenes.h"
#include "unit/rivals/sampled_rays.h"

namespace exactff::adaptive {
namespace {

using generate::Random;

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

}  // namespace
}  // namespace exactff::adaptive
