// A search that stops as soon as a few occluders hide all, and that begins with those that hid the source from another
// receiver, finds what the whole search finds. EXACTFF_TEST_SCALE multiplies the number of random scenes.
#include <ostream>

#include "exact/source_planes.h"
#include "generate/families.h"
#include "support/oracle_check.h"
#include "support/solve.h"
#include "support/test.h"
#include "visibility/visible_boundary.h"

namespace exactff::validation {
namespace {

using visibility::BoundaryRequest;
using visibility::EdgeWorkspace;
using visibility::PlaneVisibility;

struct Counts {
  std::uint64_t hidden = 0, few = 0, remembered = 0;
};

BoundaryRequest whole_search() {
  return {.fraction = true, .fewest_to_cover = std::numeric_limits<std::size_t>::max()};
}

PlaneVisibility find(const Scene& scene, const Receiver& receiver, const visibility::SourcePlane& plane,
                     const BoundaryRequest& request, EdgeWorkspace& workspace) {
  return find_visible_boundary(visibility::View(scene, receiver), plane, request, workspace);
}

void expect_same(const PlaneVisibility& shortened, const PlaneVisibility& whole, Counts& counts) {
  EXPECT_EQ(to_string(shortened.record.outcome), to_string(whole.record.outcome));
  EXPECT_EQ(shortened.record.edges, whole.record.edges);
  EXPECT_EQ(shortened.record.horizon_clipped, whole.record.horizon_clipped);
  EXPECT_EQ(*shortened.fraction, *whole.fraction);
  EXPECT_EQ(shortened.record.cover > 0, shortened.boundary.empty() && whole.record.candidates > 0);
  EXPECT_TRUE(shortened.record.cover_remembered || shortened.record.cover <= whole.record.candidates);
  if (whole.record.outcome != Outcome::kHiddenByUnion) return;
  ++counts.hidden;
  if (shortened.record.cover_remembered) ++counts.remembered;
  if (shortened.record.cover < whole.record.candidates) ++counts.few;
}

// The receiver of the scene, and others nearby, far away, and turned.
std::vector<Receiver> receivers_around(const Scene& scene, const PlainScene& plain, Random& random) {
  std::vector<Receiver> receivers{receiver_in(scene, plain)};
  for (const double step : {0x1p-40, 0x1p-10, 0x1p-3}) {
    Receiver moved = receivers.front();
    moved.on.clear();
    moved.point.x += step * random.between(-1, 1);
    moved.point.y += step * random.between(-1, 1);
    receivers.push_back(moved);
  }
  receivers.push_back(receivers.front());
  receivers.back().normal.x += 1.0;
  if (receivers.back().normal == Vec3{}) receivers.back().normal.y = 1.0;
  return receivers;
}

void shuffle(std::vector<std::size_t>& order, Random& random) {
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
}

class Covers : public testing::TestWithParam<RandomFamily> {};

// One workspace serves all scenes, so that what is remembered is often of another scene.
TEST_P(Covers, ChangeNothingInAnyOrderOfReceivers) {
  EdgeWorkspace shortened, whole;
  Counts counts;
  for (std::uint64_t i = 0; i < scaled_count(1 + GetParam().count / 4); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const PlainScene plain = GetParam().make(random);
    const Scene scene = generate::build(plain);
    const ExactSource source(scene, scene.select(plain.source));
    const std::vector<Receiver> receivers = receivers_around(scene, plain, random);
    std::vector<std::size_t> order(2 * receivers.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k % receivers.size();
    shuffle(order, random);
    for (const std::size_t k : order) {
      for (const visibility::SourcePlane& plane : ExactSourceInside::planes(source).planes) {
        expect_same(find(scene, receivers[k], plane, {.fraction = true, .remembers_covers = true, .fewest_to_cover = 1},
                         shortened),
                    find(scene, receivers[k], plane, whole_search(), whole), counts);
      }
    }
    if (HasFailure()) return;
  }
  RecordProperty("hidden", std::to_string(counts.hidden));
  RecordProperty("few", std::to_string(counts.few));
  RecordProperty("remembered", std::to_string(counts.remembered));
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, Covers, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });

// On both sides of the outline of what a generated scene hides.
struct ModelCase {
  std::string name;
  PlainScene plain;
  double spread;  // of the receivers
};

void PrintTo(const ModelCase& tested, std::ostream* out) { *out << tested.name; }

const std::vector<ModelCase>& model_cases() {
  static const std::vector<ModelCase> cases{
      {"Deep", generate::soup({.n = 300, .seed = 1, .cover = 50.0}), 0.02},
      {"Dense", generate::soup({.n = 300, .seed = 2, .cover = 6.0}), 0.02},
      {"Sparse", generate::soup({.n = 100, .seed = 3, .cover = 0.75}), 0.02},
      {"Karkanis", generate::karkanis({.n = 300, .seed = 1, .cover = 12.0}), 0.05},
      {"Tiles", generate::tiles({.n = 9}), 0.1},
      {"SomeTiles", generate::tiles({.n = 16, .drop = 3}), 0.1},
      {"Lattice", generate::lattice({.n = 300, .seed = 1}), 0.0625},
      {"Blinds", generate::blinds({.n = 100}), 0.5},
      {"Mesh", generate::mesh({.n = 300}), 0.5},
      {"Room", generate::room({.n = 20}), 0.5},
  };
  return cases;
}

std::vector<Receiver> receivers_beside(const PlainScene& plain, double spread) {
  constexpr int kSide = 3;
  std::vector<Receiver> receivers;
  for (int i = 0; i < kSide * kSide; ++i) {
    Receiver receiver = receiver_of(plain);
    receiver.point.x += spread * (i % kSide - kSide / 2);
    receiver.point.y += spread * (i / kSide - kSide / 2);
    receivers.push_back(receiver);
  }
  return receivers;
}

std::vector<std::vector<std::size_t>> orders_of(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::vector<std::size_t>> orders{order};
  std::reverse(order.begin(), order.end());
  orders.push_back(order);
  Random random(seed_of(0));
  shuffle(order, random);
  orders.push_back(order);
  return orders;
}

void expect_same(const FormFactor& a, const FormFactor& b) {
  EXPECT_EQ(answer_of(a), answer_of(b));
  EXPECT_EQ(a.visible_part, b.visible_part);
  ASSERT_EQ(a.planes.size(), b.planes.size());
  for (std::size_t p = 0; p < a.planes.size(); ++p) {
    EXPECT_EQ(to_string(a.planes[p].outcome), to_string(b.planes[p].outcome));
    EXPECT_EQ(a.planes[p].edges, b.planes[p].edges);
  }
}

class CoversOfModels : public testing::TestWithParam<ModelCase> {};

TEST_P(CoversOfModels, ChangeNothingInAnyOrderOfReceivers) {
  const PlainScene& plain = GetParam().plain;
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  const std::vector<Receiver> receivers = receivers_beside(plain, GetParam().spread);
  std::vector<FaceId> only;  // every second face
  for (std::uint32_t face = 0; face < scene.faces().size(); face += 2) only.push_back(FaceId{face});
  std::vector<ExactOptions> variants{{.visible_fraction = true}, {.visible_fraction = true, .only_occluders = &only}};
  for (const ExactOptions& options : variants) {
    ExactOptions alone = options, unculled = options;
    alone.from_scratch = true;
    unculled.culling = ShaftCulling::kNone;
    std::vector<FormFactor> expected;
    for (const Receiver& receiver : receivers) {
      expected.push_back(exact_form_factor(scene, receiver, source, alone));
      EXPECT_EQ(answer_of(exact_form_factor(scene, receiver, source, unculled)), answer_of(expected.back()));
    }
    for (const std::vector<std::size_t>& order : orders_of(receivers.size())) {
      Workspace workspace;
      FormFactor found;
      for (const std::size_t k : order) {
        exact_form_factor(scene, receivers[k], source, options, found, workspace);
        expect_same(found, expected[k]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, CoversOfModels, testing::ValuesIn(model_cases()),
                         [](const auto& tested) { return tested.param.name; });

Outcome outcome_of(const PlainScene& plain, const BoundaryRequest& request, EdgeWorkspace& workspace) {
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  return find(scene, receiver_of(plain), ExactSourceInside::planes(source).planes.at(0), request, workspace)
      .record.outcome;
}

// The largest one hides the source's left half and its middle. Four others around a hole hide the rest.
TEST(Cover, IsNoneWhereAHoleIsLeft) {
  EdgeWorkspace workspace;
  for (const double width : {0.25, 0x1p-30, 0x1p-52, 0.0}) {
    PlainScene plain = generate::soup({.n = 0});
    const auto add = [&](double x0, double x1, double y0, double y1, double z) {
      plain.add_ring(plain.patch("occ"),
                     {{x0 * z, y0 * z, z}, {x1 * z, y0 * z, z}, {x1 * z, y1 * z, z}, {x0 * z, y1 * z, z}});
    };
    add(-1.5, 0.125, -1.5, 1.5, 0.5);
    add(0.0, 0.5, -1.5, 1.5, 0.25);
    add(0.5 + width, 1.5, -1.5, 1.5, 0.25);
    add(0.25, 1.25, -1.5, 0.5, 0.125);
    add(0.25, 1.25, 0.5 + width, 1.5, 0.125);
    EXPECT_EQ(to_string(outcome_of(plain, {.fewest_to_cover = 1}, workspace)),
              to_string(width > 0.0 ? Outcome::kPartlyHidden : Outcome::kHiddenByUnion));
  }
}

// In about half of these scenes something is visible through holes.
TEST(Cover, IsNoneWhereRandomTrianglesLeaveHoles) {
  EdgeWorkspace workspace;
  std::size_t hidden = 0, visible = 0;
  for (std::uint64_t i = 0; i < scaled_count(300); ++i) {
    const PlainScene plain = generate::soup({.n = 40, .seed = seed_of(i), .cover = 14.0});
    const Outcome whole = outcome_of(plain, {.fewest_to_cover = std::numeric_limits<std::size_t>::max()}, workspace);
    EXPECT_EQ(to_string(outcome_of(plain, {.fewest_to_cover = 1}, workspace)), to_string(whole))
        << "seed " << seed_of(i);
    hidden += whole == Outcome::kHiddenByUnion ? 1 : 0;
    visible += whole == Outcome::kPartlyHidden ? 1 : 0;
  }
  EXPECT_GT(hidden, 20U);
  EXPECT_GT(visible, 20U);
}

// Two large squares hide the source from both receivers. From the second, a small one hides it alone.
TEST(Cover, LeavesASingleOccluderItsOutcome) {
  PlainScene plain = generate::soup({.n = 0});
  const auto add = [&](double low, double high, double z) {
    plain.add_ring(plain.patch("occ"), {{low, -2 * z, z}, {high, -2 * z, z}, {high, 2 * z, z}, {low, 2 * z, z}});
  };
  add(-2.0, 0.1, 0.5);
  add(-0.1, 2.0, 0.5);
  add(0.03, 0.07, 0.01);
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  EdgeWorkspace workspace;
  const auto outcome_at = [&](double x) {
    Receiver receiver{.point = {x, 0, 0}, .normal = {0, 0, 1}, .on = {}, .id = {}};
    const auto found = find(scene, receiver, ExactSourceInside::planes(source).planes.at(0),
                            {.remembers_covers = true, .fewest_to_cover = 1}, workspace);
    return std::pair(to_string(found.record.outcome), found.record.cover_remembered);
  };
  EXPECT_EQ(outcome_at(0.0), std::pair(to_string(Outcome::kHiddenByUnion), false));
  EXPECT_EQ(outcome_at(0.001), std::pair(to_string(Outcome::kHiddenByUnion), true));
  EXPECT_EQ(outcome_at(0.05), std::pair(to_string(Outcome::kHiddenByOne), false));
}

TEST(Cover, OfADeepSceneIsSmallAndServesItsNeighbours) {
  const PlainScene plain = generate::soup({.n = 300, .seed = 1, .cover = 50.0});
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  Receiver receiver = receiver_of(plain);
  Workspace workspace;
  FormFactor found;
  exact_form_factor(scene, receiver, source, {}, found, workspace);
  const PlaneRecord first = found.planes.at(0);
  ASSERT_EQ(first.outcome, Outcome::kHiddenByUnion);
  EXPECT_FALSE(first.cover_remembered);
  EXPECT_LE(first.cover, 16U);
  EXPECT_GT(first.candidates, 200U);

  receiver.point.x += 1e-4;
  exact_form_factor(scene, receiver, source, {}, found, workspace);
  const PlaneRecord second = found.planes.at(0);
  EXPECT_TRUE(second.cover_remembered);
  EXPECT_EQ(second.cover, first.cover);
  EXPECT_EQ(second.candidates, first.cover);

  for (const ExactOptions& whole : {ExactOptions{.from_scratch = true}, ExactOptions{.list_cutters = true}}) {
    exact_form_factor(scene, receiver, source, whole, found, workspace);
    EXPECT_EQ(found.planes.at(0).candidates, exact_form_factor(scene, receiver, source).planes.at(0).candidates);
  }
  EXPECT_GT(found.cutters.size(), 200U);
}

}  // namespace
}  // namespace exactff::validation
