// Coincident faces: whatever the order of the faces in the file, the same is seen of fronts together, of backs and of
// what is open, and every form factor keeps its bits. Rows of matrices meet each other.
#include "support/test.h"
#include "support/view_judge.h"
#include "support/view_scenes.h"

namespace exactff::validation {
namespace {

using generate::PlainPatch;

constexpr RandomFamily kSheets{"Sheets", 60, &sheets_scene};

PlainScene in_another_order(PlainScene scene, Random& random) {
  generate::shuffle(random, scene.patches);
  for (PlainPatch& patch : scene.patches) generate::shuffle(random, patch.faces);
  return scene;
}

struct ByName {
  const Scene& scene;
  const WholeView seen;

  // What is not listed has 0.
  [[nodiscard]] SeenPatch patch(const std::string& name) const {
    const SeenPatch* const found = find_patch(seen, index_of(scene.select(name).patch));
    return found == nullptr ? SeenPatch{} : *found;
  }
  [[nodiscard]] Enclosure fronts() const {
    Enclosure sum;
    for (const SeenPatch& one : seen.patches) sum += one.share.enclosure;
    return sum;
  }
};

void expect_same_views(const ByName& one, const ByName& other) {
  expect_same_bits(one.seen.back, other.seen.back, "back");
  expect_same_bits(one.seen.open, other.seen.open, "open");
  EXPECT_TRUE(one.fronts().overlaps(other.fronts()));
  for (const Patch& patch : one.scene.patches()) {
    const SeenPatch here = one.patch(patch.name), there = other.patch(patch.name);
    expect_same_bits(here.form_factor, there.form_factor, patch.name);
    if (!here.stacked && !there.stacked) expect_same_bits(here.share, there.share, patch.name);
  }
}

TEST(CoincidentFaces, GiveTheSameViewInAnyOrder) {
  std::size_t backs = 0, stacks = 0;
  for_each_scene_of(kSheets, 1, [&](const PlainScene& plain, const Scene& scene, const Receiver& receiver) {
    const ByName one{scene, view(scene, receiver)};
    for (std::uint64_t k = 0; k < 3; ++k) {
      Random random(seed_of(k));
      const Scene other = generate::build(in_another_order(plain, random));
      expect_same_views(one, {other, view(other, receiver)});
    }
    backs += one.seen.back.value > 0.0 ? 1U : 0U;
    stacks += std::ranges::any_of(one.seen.patches, &SeenPatch::stacked) ? 1U : 0U;
  });
  EXPECT_GT(backs, 10U);
  EXPECT_GT(stacks, 5U);
}

// --- Rows ---

// A floor, and above it sheets in one plane with either front, some of which overlap in part.
PlainScene sheets_over_a_floor() {
  PlainScene plain;
  const auto add = [&](const char* name, double low_x, double low_y, double high_x, double high_y, double z, bool up) {
    std::vector<Vec3> ring = {{low_x, low_y, z}, {high_x, low_y, z}, {high_x, high_y, z}, {low_x, high_y, z}};
    if (!up) std::ranges::reverse(ring);
    plain.add_ring(plain.patch(name), ring);
  };
  add("floor", 0, 0, 2, 2, 0, true);
  add("lamp up", 0.5, 0.5, 1, 1.5, 1, true);
  add("lamp down", 0.5, 0.5, 1.5, 1.5, 1, false);
  add("shelf", 1, 0, 2, 1.5, 1, true);
  add("ceiling", 0, 0, 1, 0.5, 1, false);
  add("plate", 0.25, 0.25, 0.75, 0.75, 0.5, false);
  return plain;
}

matrix::Matrix factors_of_sheets(const Scene& scene) {
  const std::vector<Selection> all = all_patches(scene);
  return matrix::compute(scene, all, all, {.factors = {.accuracy = 1e-2}, .backs = true, .open = true});
}

void expect_meet(const ViewFactor& a, const ViewFactor& b, const std::string& what) {
  EXPECT_LE(a.lower, b.upper) << what;
  EXPECT_GE(a.upper, b.lower) << what;
}

TEST(CoincidentFaces, GiveTheSameRowsByCellsInAnyOrder) {
  PlainScene plain = sheets_over_a_floor();
  const Scene first = generate::build(plain);
  const matrix::Matrix one = factors_of_sheets(first);
  EXPECT_EQ(reasons_against_one(first, one), std::vector<std::string>{});
  EXPECT_GT(one.back[0].lower, 0.01) << "the floor sees the shelf from below";
  std::ranges::reverse(plain.patches);
  const Scene reversed = generate::build(plain);
  const matrix::Matrix other = factors_of_sheets(reversed);
  for (std::size_t i = 0; i < one.back.size(); ++i) {
    const std::size_t row = one.back.size() - 1 - i;
    expect_meet(one.back[i], other.back[row], first.patches()[i].name);
    expect_meet(one.open[i], other.open[row], first.patches()[i].name);
    for (const matrix::Sum& sum : {row_sums(one)[i], row_sums(other)[row]}) {
      EXPECT_LE(sum.lower, 1.0);
      EXPECT_GE(sum.upper, 1.0);
      EXPECT_LE(sum.upper - sum.lower, 0.1);
    }
  }
}

}  // namespace
}  // namespace exactff::validation
