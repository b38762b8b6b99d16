#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>

#include "adaptive/sampled_scene.h"
#include "exactff/adaptive.h"
#include "unit/rivals/sampled_scenes.h"

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace exactff::adaptive {
namespace {

using generate::PlainScene;

std::string refusal(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  try {
    const AdaptiveSolver solver(scene);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

RayEnds rays_to(const std::vector<Vec3>& points) {
  RayEnds ends;
  ends.resize(static_cast<int>(points.size()));
  for (std::size_t i = 0; i < ends.x.size(); ++i) {
    const Vec3& p = points[std::min(i, points.size() - 1)];
    ends.x[i] = p.x;
    ends.y[i] = p.y;
    ends.z[i] = p.z;
  }
  return ends;
}

struct Built {
  explicit Built(const PlainScene& plain)
      : scene(generate::build(plain)),
        scaled(scene),
        rays(scene, scaled.points, checked_unit_box(scene, scaled.points)) {}

  // Rays from the origin to unscaled points; the bits of the first packet.
  unsigned hidden(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& pieces, unsigned known = 0) const {
    std::vector<Vec3> ends;
    for (const Vec3& p : points) ends.push_back(p * scaled.scale);
    return hidden_from({}, ends, pieces, known);
  }

  unsigned hidden_from(const Vec3& origin, const std::vector<Vec3>& ends, const std::vector<std::uint32_t>& pieces,
                       unsigned known = 0) const {
    Blockers blockers;
    blockers.assign(scene.pieces().size(), pieces);
    return rays.hidden_lanes(origin, rays_to(ends), 0, blockers, known);
  }

  Scene scene;
  ScaledScene scaled;
  RayScene rays;
};

const std::vector<std::uint32_t> kOccluder = {1};

TEST(RayScene, RaysStopAtPiecesBeforeTheirEnds) {
  const Built built(validation::occluded_scene(0.25));
  EXPECT_EQ(built.hidden({{0, 0, 1}, {0.4, 0.4, 1}, {0.6, 0, 1}, {0, 0, 0.25}}, kOccluder), 0b0011U);
}

TEST(RayScene, RaysPassThroughAllButBlockers) {
  const Built built(validation::occluded_scene(0.25));
  EXPECT_EQ(built.hidden({{0, 0, 2}}, {}), 0U);
  EXPECT_EQ(built.hidden({{0, 0, 2}, {1.5, 1.5, 2}}, kOccluder), 0b01U);
  EXPECT_EQ(built.hidden({{0, 0, 2}, {1.5, 1.5, 2}}, {0}), 0b11U);
}

TEST(Blockers, AreForgottenWhenAssignedAnew) {
  Blockers blockers;
  blockers.assign(4, kOccluder);
  EXPECT_TRUE(blockers.contains(1));
  blockers.assign(4, std::vector<std::uint32_t>{2});
  EXPECT_FALSE(blockers.contains(1));
  EXPECT_TRUE(blockers.contains(2));
}

TEST(RayScene, AReceiverFarAwayKeepsItsDigits) {
  const Built built(validation::occluded_scene(0.25));
  // Nearly parallel rays to the source's plane: the shadow there is as large as the occluder.
  const Vec3 from{0, 0, -1e6};
  const Vec3 inside = Vec3{0.249, 0, 1} * built.scaled.scale - from;
  const Vec3 outside = Vec3{0.251, 0, 1} * built.scaled.scale - from;
  EXPECT_EQ(built.hidden_from(from, {inside, outside}, kOccluder), 0b01U);
}

TEST(RayScene, LeavesTheFloatingPointModeAlone) {
  const int rounding = std::fegetround();
#ifdef __SSE__
  const unsigned mode = _mm_getcsr() & ~0x3fU;  // all but the exception flags
#endif
  const Built built(validation::occluded_scene(0.25));
  (void)built.hidden({{0, 0, 1}}, kOccluder);
  EXPECT_EQ(std::fegetround(), rounding);
#ifdef __SSE__
  EXPECT_EQ(_mm_getcsr() & ~0x3fU, mode);
#endif
}

TEST(SinglePrecision, MergedVerticesAreRefusedByName) {
  PlainScene plain = validation::open_scene();
  validation::add(plain, "sliver", {{0, 0.9, 0.5}, {0.25, 0.9, 0.5}, {0.25, 0.9 + 1e-9, 0.5}});
  const std::string message = refusal(plain);
  EXPECT_NE(message.find("face 'sliver'"), std::string::npos) << message;
  EXPECT_NE(message.find("merges"), std::string::npos) << message;
  EXPECT_NE(message.find("the sampled methods refuse"), std::string::npos) << message;
}

TEST(SinglePrecision, CollapsedFacesAreRefusedByName) {
  PlainScene plain = validation::open_scene();
  validation::add(plain, "needle", {{-0.75, 0.9, 0.5}, {0.5, 0.9, 0.5}, {0.25, 0.9 + 1e-12, 0.5}});
  const std::string message = refusal(plain);
  EXPECT_NE(message.find("face 'needle'"), std::string::npos) << message;
  EXPECT_NE(message.find("collapses"), std::string::npos) << message;
}

// Twenty triangles in front of the source, in a box of size `thickness` along z and 1 along the other axes.
PlainScene thin_scene(double thickness) {
  PlainScene plain;
  validation::add(plain, "source", {{-0.5, -0.5, thickness}, {-0.5, 0.5, thickness}, {0.5, 0.5, thickness}});
  for (int i = 0; i < 20; ++i) {
    const double x = -0.5 + i / 20.0, z = thickness * (i % 5) / 5.0;
    validation::add(plain, "slats", {{x, -0.5, z}, {x + 0.04, -0.5, z + thickness / 9.0}, {x, 0.5, z}});
  }
  return plain;
}

TEST(SinglePrecision, ScenesTooThinForEmbreeAreRefusedByName) {
  EXPECT_EQ(refusal(thin_scene(0x1p-70)), "");
  for (const double thickness : {0x1p-100, 0x1p-110, 0x1p-125, 0x1p-140}) {
    const std::string message = refusal(thin_scene(thickness));
    EXPECT_NE(message.find("face 's"), std::string::npos) << message;
    EXPECT_NE(message.find("along z is below 2^-100 (7.9e-31) of the scene's size"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one message is enough: " << message;
    EXPECT_NE(message.find("the sampled methods refuse"), std::string::npos) << message;
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
  const Built built(plain);
  EXPECT_EQ(built.hidden({{0, 0, 0.1}}, {}), 0U);
}

}  // namespace
}  // namespace exactff::adaptive
