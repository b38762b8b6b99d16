// Embree's builder must survive scenes as thin as checked_unit_box accepts. The failure is a crash of this program, and
// the last line that it prints shows the seed. EXACTFF_TEST_SCALE multiplies the number of scenes and EXACTFF_TEST_SEED
// selects others. For a million scenes:
//
//   EXACTFF_TEST_SCALE=500 build/sampled_tests --gtest_filter='ThinScenes.*'
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "adaptive/sampled_scene.h"
#include "support/test.h"

namespace exactff::adaptive {
namespace {

volatile std::sig_atomic_t seed_high = 0, seed_low = 0;

extern "C" void tell_seed(int signal) {
  char text[64];
  const int length = std::snprintf(text, sizeof text, "died of the scene with the seed 0x%08x%08x\n",
                                   static_cast<unsigned>(seed_high), static_cast<unsigned>(seed_low));
  if (write(STDERR_FILENO, text, static_cast<std::size_t>(length)) < 0) _exit(1);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void remember(std::uint64_t seed) {
  seed_high = static_cast<std::sig_atomic_t>(static_cast<std::uint32_t>(seed >> 32));
  seed_low = static_cast<std::sig_atomic_t>(static_cast<std::uint32_t>(seed));
}

enum class Spread { kEven, kTowardsTheMiddle, kLattice, kAllMagnitudes, kLatticeAndMagnitudes };

// Triangles in a box whose half extents are powers of two, centred exactly at the origin.
class ThinScene {
 public:
  explicit ThinScene(Random& random) : random_(random) {
    spread_ = static_cast<Spread>(random_.below(5));
    for (double& extent : half_extent_) extent = std::ldexp(0.5, -exponent());
    half_extent_[random_.below(3)] = 0.5;
    if (random_.one_in(6)) half_extent_[random_.below(3)] = 0.0;
    // Mostly up to the bound (the scene has size 1, in the box half of it); checked_unit_box must detect the others.
    least_ = random_.one_in(16) ? 0.0 : 2.0 * kLeastInEmbree;
    needles_ = random_.one_in(3);
  }

  Scene build() {
    SceneBuilder builder("thin");
    const MaterialId grey = builder.add_material({});
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
      const std::uint32_t first = builder.add_vertex(a);
      builder.add_vertex(b);
      builder.add_vertex(c);
      builder.add_face(builder.patch("faces"), grey, {{first, first + 1, first + 2}});
    };
    add(corner(-1, -1, -1), corner(1, 1, 1), corner(1, -1, 1));
    const int faces = random_.one_in(16) ? random_.integer(100, 400) : random_.integer(20, 60);
    for (int i = 0; i < faces; ++i) {
      const Vec3 a = point(), b = point(), c = point();
      needles_&& random_.one_in(3) ? add(a, towards(a, b), towards(a, c)) : add(a, b, c);
    }
    return builder.build();
  }

  Vec3 point() {
    if (!points_.empty() && random_.one_in(4)) return points_[random_.below(points_.size())];
    const double x = coordinate(0), y = coordinate(1);
    points_.push_back({x, y, coordinate(2)});
    return points_.back();
  }

 private:
  // The kind of a half extent: ordinary, near the bound, or beyond it.
  int exponent() {
    const std::size_t kind = random_.below(20);
    if (kind < 5) return random_.integer(0, 30);
    if (kind < 9) return random_.integer(30, 76);
    return kind < 19 ? random_.integer(76, 98) : random_.integer(95, 145);
  }

  [[nodiscard]] Vec3 corner(int x, int y, int z) const {
    return {x * half_extent_[0], y * half_extent_[1], z * half_extent_[2]};
  }

  // 0 or at least `least_`.
  [[nodiscard]] double kept(double t) const { return std::abs(t) < least_ ? 0.0 : t; }

  double coordinate(std::size_t axis) {
    const double even = random_.between(-1.0, 1.0);
    const double tiny = std::ldexp(even, -random_.integer(0, 110));
    const double lattice = random_.integer(-8, 8) / 8.0;
    switch (spread_) {
      case Spread::kEven:
        return kept(half_extent_[axis] * even);
      case Spread::kTowardsTheMiddle:
        return kept(half_extent_[axis] * even * random_.unit() * random_.unit());
      case Spread::kLattice:
        return kept(half_extent_[axis] * lattice);
      case Spread::kAllMagnitudes:
        return kept(half_extent_[axis] * tiny);
      case Spread::kLatticeAndMagnitudes:
        break;
    }
    return kept(half_extent_[axis] * (random_.one_in(3) ? tiny : lattice));
  }

  // Long thin and tiny triangles.
  Vec3 towards(const Vec3& a, const Vec3& b) {
    const double step = std::ldexp(1.0, -random_.integer(1, 12));
    return {kept(a.x + (b.x - a.x) * step), kept(a.y + (b.y - a.y) * step), kept(a.z + (b.z - a.z) * step)};
  }

  Random& random_;
  Spread spread_{};
  double half_extent_[3] = {0.5, 0.5, 0.5};
  double least_ = 0.0;
  bool needles_ = false;
  std::vector<Vec3> points_;
};

// A packet of rays between points of the scene, some from far away.
void cast_rays(const ScaledScene& scaled, const RayScene& rays, ThinScene& thin, Random& random) {
  const Vec3 far = thin.point() * std::ldexp(1.0, random.integer(0, 300));
  const Vec3 from = (random.one_in(4) ? far : thin.point()) * scaled.scale;
  RayEnds ends;
  ends.resize(RayScene::kPacket);
  for (std::size_t i = 0; i < ends.x.size(); ++i) {
    const Vec3 to = thin.point() * scaled.scale - from;
    ends.x[i] = to.x;
    ends.y[i] = to.y;
    ends.z[i] = to.z;
  }
  Blockers blockers;
  blockers.assign_all_but(scaled.scene->pieces().size(), {});
  (void)rays.hidden_lanes(from, ends, 0, blockers, 0);
}

enum class Outcome { kBuilt, kRefused, kNoScene };

Outcome try_one(std::uint64_t seed) {
  remember(seed);
  Random random(seed);
  ThinScene thin(random);
  std::optional<Scene> scene;
  try {
    scene.emplace(thin.build());
  } catch (const InputError&) {
    return Outcome::kNoScene;
  }
  try {
    const ScaledScene scaled(*scene);
    const UnitBox box = checked_unit_box(*scene, scaled.points);
    const RayScene rays(*scene, scaled.points, box);
    cast_rays(scaled, rays, thin, random);
  } catch (const InputError& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("the sampled methods refuse this scene"), std::string::npos);
    return Outcome::kRefused;
  }
  return Outcome::kBuilt;
}

// Both were found by running 10^6 scenes. Here the receiver is so far away that rounding moves the ends of rays far
// outside the scene.
TEST(ThinScenes, EmbreeLivesWithRaysFromFarAway) {
  const auto before = std::signal(SIGABRT, tell_seed);
  EXPECT_EQ(try_one(0xd28adefc780b540c), Outcome::kBuilt);
  std::signal(SIGABRT, before);
}

// RTC_BUILD_QUALITY_HIGH crashes on this one.
TEST(ThinScenes, EmbreeLivesWhereItsSpatialSplitsDie) {
  const auto before = std::signal(SIGABRT, tell_seed);
  EXPECT_EQ(try_one(0xded13ba90e0467c5), Outcome::kBuilt);
  std::signal(SIGABRT, before);
}

TEST(ThinScenes, EmbreeLivesUpToTheBound) {
  const auto before = std::signal(SIGABRT, tell_seed);
  const std::uint64_t wanted = validation::scaled_count(2000);
  std::uint64_t built = 0, refused = 0;
  for (std::uint64_t i = 0; built < wanted; ++i) {
    ASSERT_LT(i, 20 * wanted + 100) << "too few scenes pass the check";
    const Outcome outcome = try_one(validation::seed_of(i));
    built += outcome == Outcome::kBuilt ? 1 : 0;
    refused += outcome == Outcome::kRefused ? 1 : 0;
  }
  std::signal(SIGABRT, before);
  std::printf("%llu scenes built, %llu refused\n", static_cast<unsigned long long>(built),
              static_cast<unsigned long long>(refused));
  EXPECT_GT(refused, 0U) << "no scene was beyond the bound";
}

}  // namespace
}  // namespace exactff::adaptive
