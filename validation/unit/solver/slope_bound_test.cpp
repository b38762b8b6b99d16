// How fast point factors change, judged by the exact solver.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "exactff/models.h"
#include "exactff/view.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/vec.h"
#include "support/random_scenes.h"
#include "unit/solver/factor_at.h"
#include "view_factors/exact_scene.h"
#include "view_factors/factor_bounds.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"

namespace exactff::view_factors {
namespace {

using generate::PlainScene;
using generate::Random;
using validation::scaled_count;
using validation::seed_of;

// Of a source seen from points of a floor.
class Seen {
 public:
  explicit Seen(const Scene& scene)
      : exact_(scene),
        receiver_(parts_of(exact_, scene.select("floor")).front()),
        source_(scene, scene.select("source")),
        sight_(sight_of(exact_, SeenParts(exact_).seen_from(receiver_).occluders, receiver_,
                        parts_of(exact_, scene.select("source")).front())) {}

  [[nodiscard]] bool sees() const { return sight_.has_value(); }
  [[nodiscard]] const Part& receiver() const { return receiver_; }
  [[nodiscard]] SlopeBound bound() const { return SlopeBound(*sight_); }
  // All in the scene's unit.
  [[nodiscard]] double slope(const Vec3& at, double radius) const {
    const double unit = std::ldexp(1.0, static_cast<int>(exact_.units.exponent + exact_.units.shift));
    return bound().about(kernel::scaled(at, 1.0 / unit), radius / unit) / unit;
  }
  [[nodiscard]] double factor(const Vec3& at) const {
    return factor_at(exact_, at, sight_->receiver, receiver_.face, source_);
  }

 private:
  ExactScene exact_;
  Part receiver_;
  ExactSource source_;
  std::optional<Sight> sight_;
};

// Points of a small tile of the part, and its middle first.
std::vector<Vec3> points_of_tile(const Part& part, Random& random, double size) {
  const std::vector<Point>& corners = part.corners;
  const double s = random.unit() * (1.0 - size), t = random.unit() * (1.0 - size);
  const auto at = [&](double along, double up) {
    const Vec3& from = corners[0].at;
    return kernel::along(kernel::along(from, kernel::difference(corners[1].at, from), s + size * along),
                         kernel::difference(corners.back().at, from), t + size * up);
  };
  std::vector<Vec3> points{at(0.5, 0.5)};
  for (int i = 0; i < 6; ++i) points.push_back(at(random.unit(), random.unit()));
  return points;
}

// Faces of all kinds stand in between.
Scene scene_of(Random& random, std::uint64_t seed) {
  const std::string model = random.one_in(2) ? "soup" : random.one_in(2) ? "lattice" : "karkanis";
  return models::make_scene(model + ":n=" + std::to_string(random.integer(1, 6)) +
                            ",cover=1,seed=" + std::to_string(seed % 1000000));
}

struct Judged {
  int finite = 0, tight = 0;
};

// On tiles from large to tiny.
template <class Factor>
void judge(const SlopeBound& bound, const Part& receiver, const Factor& factor, Random& random, Judged& judged) {
  for (const double size : {0.25, 0.03, 0.004}) {
    const std::vector<Vec3> points = points_of_tile(receiver, random, size);
    double radius = 0.0;
    for (const Vec3& point : points) radius = std::max(radius, kernel::distance(points[0], point));
    const double slope = bound.about(points[0], radius);
    if (!(slope < HUGE_VAL)) continue;
    ++judged.finite;
    double steepest = 0.0;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const double distance = kernel::distance(points[i], points[i + 1]);
      const double change = std::abs(factor(points[i]) - factor(points[i + 1]));
      EXPECT_LE(change, slope * distance + 0x1p-40) << size;
      steepest = std::max(steepest, change / distance);
    }
    judged.tight += steepest > 0.1 * slope ? 1 : 0;
  }
}

TEST(SlopeBound, IsAtLeastEveryChangeOfThePointFactor) {
  Judged judged;
  for (std::uint64_t s = 0; s < scaled_count(120); ++s) {
    SCOPED_TRACE(s);
    Random random(seed_of(s));
    const Scene scene = scene_of(random, seed_of(s));
    const Seen seen(scene);
    if (!seen.sees()) continue;
    const auto factor = [&](const Vec3& at) { return seen.factor(at); };
    judge(seen.bound(), seen.receiver(), factor, random, judged);
  }
  EXPECT_GT(judged.finite, 100);
  EXPECT_GT(judged.tight, judged.finite / 20);
}

// From all faces, since those of the model's occluders see one another.
TEST(SlopeBound, OfWhatIsOpenIsAtLeastEveryChangeInTheView) {
  Judged judged;
  for (std::uint64_t s = 0; s < scaled_count(40); ++s) {
    SCOPED_TRACE(s);
    Random random(seed_of(s));
    const Scene scene = scene_of(random, seed_of(s));
    const ExactScene exact(scene);
    const Selection patch{static_cast<PatchId>(random.below(scene.patches().size())), {}, scene.id()};
    const std::vector<Part> parts = parts_of(exact, patch);
    const Part& receiver = parts[random.below(parts.size())];
    const Sight sight = sight_of_open(exact, SeenParts(exact).seen_from(receiver).occluders, receiver);
    const auto open = [&](const Vec3& at) {
      return view(scene, receiver_at(exact, at, sight.receiver, receiver.face)).open.value;
    };
    judge(SlopeBound(sight), receiver, open, random, judged);
  }
  EXPECT_GT(judged.finite, 50);
  EXPECT_GT(judged.tight, judged.finite / 20);
}

class SlopeOfSquares : public testing::Test {
 protected:
  SlopeOfSquares() {
    plain_.add_ring(plain_.patch("floor"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
    plain_.add_ring(plain_.patch("source"), {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}});
  }
  // With the faces so far, which share their corners.
  [[nodiscard]] double slope(const Vec3& at, double radius) const {
    PlainScene joined = plain_;
    for (generate::PlainPatch& patch : joined.patches) {
      for (generate::PlainFace& face : patch.faces) {
        for (std::uint32_t& corner : face.rings[0]) {
          const auto first = std::ranges::find(joined.vertices, joined.vertices[corner]);
          corner = static_cast<std::uint32_t>(first - joined.vertices.begin());
        }
      }
    }
    const Scene scene = generate::build(joined);
    return Seen(scene).slope(at, radius);
  }
  void cover(const std::vector<Vec3>& ring) { plain_.add_ring(plain_.patch("cover"), ring); }

  PlainScene plain_;
};

// A long roof of which nothing but the ridge can be seen before the source: from beside, it is an outline.
TEST_F(SlopeOfSquares, CountsRidgesThatAreOutlines) {
  plain_ = {};
  plain_.add_ring(plain_.patch("floor"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain_.add_ring(plain_.patch("source"), {{0.375, 0.625, 1}, {0.625, 0.625, 1}, {0.625, 0.375, 1}, {0.375, 0.375, 1}});
  const Vec3 beside{0.3125, 0.5, 0};
  const double open = slope(beside, 0.001);
  cover({{0.375, -2, 0.125}, {0.375, 3, 0.125}, {0.40625, 3, 0.5}, {0.40625, -2, 0.5}});
  cover({{0.40625, -2, 0.5}, {0.40625, 3, 0.5}, {0.4375, 3, 0.125}, {0.4375, -2, 0.125}});
  EXPECT_GT(slope(beside, 0.001), open + 0.05);
}

TEST_F(SlopeOfSquares, LeavesOutWhatIsBesideTheSource) {
  plain_ = {};
  plain_.add_ring(plain_.patch("floor"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain_.add_ring(plain_.patch("source"), {{0, 0.25, 1}, {0.25, 0.25, 1}, {0.25, 0, 1}, {0, 0, 1}});
  const Vec3 near{0.125, 0.125, 0}, far{0.875, 0.875, 0};
  const double open_near = slope(near, 0.01), open_far = slope(far, 0.01);
  cover({{0.0625, 0.0625, 0.5}, {0.1875, 0.0625, 0.5}, {0.1875, 0.1875, 0.5}, {0.0625, 0.1875, 0.5}});
  EXPECT_GT(slope(near, 0.01), open_near + 0.1);
  EXPECT_EQ(slope(far, 0.01), open_far);
  EXPECT_GT(slope(far, 0.5), open_far) << "from some points of a large tile, it may be before the source";
}

}  // namespace
}  // namespace exactff::view_factors
