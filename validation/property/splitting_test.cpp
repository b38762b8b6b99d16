// Compares parts of a source with the whole source, and more occluders with fewer.
#include <gmpxx.h>

#include "support/solve.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

using generate::PlainPatch;

using Corners = std::vector<Vec3>;

// A random scene whose source is the square [-1,1]^2 at z = 2, facing down.
PlainScene square_source_scene(Random& random) {
  PlainScene scene = random_scene(random);
  std::erase_if(scene.patches, [](const PlainPatch& patch) { return patch.name == "source"; });
  scene.add_ring(scene.patch("source"), {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
  return scene;
}

PlainScene with_source(const PlainScene& scene, const Corners& corners) {
  PlainScene out = scene;
  out.patch("source").faces.clear();
  out.add_ring(out.patch("source"), corners);
  return out;
}

// Twice the area of a polygon in a plane of constant z.
mpq_class twice_area(const Corners& corners) {
  mpq_class sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& a = corners[i];
    const Vec3& b = corners[(i + 1) % corners.size()];
    sum += mpq_class(a.x) * mpq_class(b.y) - mpq_class(a.y) * mpq_class(b.x);
  }
  return abs(sum);
}

struct Sum {
  Enclosure form_factor;
  mpq_class visible_area = 0;
};

Sum add_up(const PlainScene& scene, const std::vector<Corners>& parts) {
  ExactOptions options;
  options.exact_fraction = true;
  Sum sum;
  for (const Corners& part : parts) {
    const FormFactor result = solve(with_source(scene, part), options);
    sum.form_factor += result.enclosure;
    sum.visible_area += mpq_class(result.planes.at(0).exact_fraction.value()) * twice_area(part);
  }
  return sum;
}

void expect_additive(const std::vector<Corners>& parts, std::uint64_t count) {
  const Corners whole{{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}};
  for (std::uint64_t i = 0; i < scaled_count(count); ++i) {
    Random random(seed_of(i));
    const PlainScene scene = square_source_scene(random);
    const Sum one = add_up(scene, {whole});
    const Sum many = add_up(scene, parts);
    ASSERT_EQ(one.visible_area, many.visible_area) << "seed " << seed_of(i) << '\n' << generate::to_obj(scene);
    ASSERT_TRUE(one.form_factor.overlaps(many.form_factor))
        << one.form_factor.midpoint() << " against " << many.form_factor.midpoint() << ", seed " << seed_of(i) << '\n'
        << generate::to_obj(scene);
  }
}

TEST(Splitting, TwoTrianglesAddUpToTheSquare) {
  expect_additive({{{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}}, {{-1, 1, 2}, {1, -1, 2}, {-1, -1, 2}}}, 60);
}

TEST(Splitting, DyadicLatticeAddsUpToTheSquare) {
  std::vector<Corners> cells;
  for (int k = 0; k < 16; ++k) {
    const double x = -1 + 0.5 * (k % 4);
    const double y = -1 + 0.5 * (k / 4);
    cells.push_back({{x, y + 0.5, 2}, {x + 0.5, y + 0.5, 2}, {x + 0.5, y, 2}, {x, y, 2}});
  }
  expect_additive(cells, 25);
}

// With the parts as faces of one source, their union is the square itself, so no bit may change.
TEST(Splitting, PartsOfOneSourceAreTheWholeBitForBit) {
  for (std::uint64_t i = 0; i < scaled_count(60); ++i) {
    Random random(seed_of(i));
    const PlainScene scene = square_source_scene(random);
    PlainScene cut = with_source(scene, {{-1, 1, 2}, {1, 1, 2}, {0.25, 0.5, 2}});
    cut.add_ring(cut.patch("source"), {{1, 1, 2}, {1, -1, 2}, {0.25, 0.5, 2}});
    cut.add_ring(cut.patch("source"), {{1, -1, 2}, {-1, -1, 2}, {0.25, 0.5, 2}});
    cut.add_ring(cut.patch("source"), {{-1, -1, 2}, {-1, 1, 2}, {0.25, 0.5, 2}});
    ASSERT_EQ(answer(scene), answer(cut)) << "seed " << seed_of(i) << '\n' << generate::to_obj(scene);
  }
}

// Correct rounding is monotone, so this holds for values as well as for balls.
TEST(Splitting, AnAddedOccluderNeverRaisesTheFormFactor) {
  ExactOptions options;
  options.exact_fraction = true;
  for (std::uint64_t i = 0; i < scaled_count(100); ++i) {
    Random random(seed_of(i));
    PlainScene scene = square_source_scene(random);
    scene.source = "source";
    std::swap(scene.patches.front(), scene.patches.back());
    FormFactor before = solve(with_source(scene, {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}}), options);
    while (scene.patches.size() > 1) {
      scene.patches.pop_back();
      FormFactor fewer = solve(scene, options);
      ASSERT_LE(before.value, fewer.value) << "seed " << seed_of(i) << '\n' << generate::to_obj(scene);
      ASSERT_LE(mpq_class(before.planes.at(0).exact_fraction.value()),
                mpq_class(fewer.planes.at(0).exact_fraction.value()));
      before = std::move(fewer);
    }
    EXPECT_TRUE(before.planes.at(0).outcome != Outcome::kPartlyHidden) << "nothing is left that could hide the source";
  }
}

}  // namespace
}  // namespace exactff::validation
