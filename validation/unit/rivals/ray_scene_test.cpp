// Scenes of rays, the ends of rays, and closed forms of the adaptive algorithm.
#include "adaptive/sampled_scene.h"
#include "adaptive/sub_patch.h"
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

TEST(SamplePlan, FillsTrianglesAndQuadrilateralsEvenly) {
  const std::pair<std::vector<Vec3>, Vec3> centroids[] = {
      {{{0, 0, 1}, {0, 2, 1}, {3, 0, 1}}, {1, 2.0 / 3, 1}},
      {{{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, {0.5, 0.5, 1}},
      {{{0, 0, 1}, {0, 3, 1}, {1, 1, 1}, {1, 0, 1}}, {5.0 / 12, 13.0 / 12, 1}}};
  for (const SamplePattern pattern :
       {SamplePattern::kRegular, SamplePattern::kJittered, SamplePattern::kLowDiscrepancy}) {
    for (const auto& [corners, centroid] : centroids) {
      Vec3 mean;
      const std::vector<Vec3> placed = points(place(make_sub_patch(corners), pattern, 256));
      for (const Vec3& p : placed) mean = mean + p * (1.0 / static_cast<double>(placed.size()));
      EXPECT_LT(length(mean - centroid), 0.02) << to_string(pattern) << ' ' << corners.size();
    }
  }
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
