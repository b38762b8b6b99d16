// Several sources at one point on scenes of every random family: by one sweep as one by one, in every bit.
#include "support/oracle_check.h"
#include "support/test.h"
#include "support/view_scenes.h"
#include "whole_view/light.h"

namespace exactff::validation {
namespace {

using whole_view::Sky;
using whole_view::SourceFactors;

std::vector<Selection> every_patch(const Scene& scene) {
  std::vector<Selection> all;
  for (std::uint32_t p = 0; p < scene.patches().size(); ++p) all.push_back({PatchId{p}, {}, scene.id()});
  return all;
}

std::vector<Selection> every_face(const Scene& scene) {
  std::vector<Selection> all;
  for (std::uint32_t f = 0; f < scene.faces().size(); ++f)
    all.push_back({scene.faces()[f].patch, FaceId{f}, scene.id()});
  return all;
}

void expect_same(const FormFactor& found, const FormFactor& expected, const std::string& what) {
  EXPECT_EQ(found.value, expected.value) << what;
  EXPECT_EQ(found.lower, expected.lower) << what;
  EXPECT_EQ(found.upper, expected.upper) << what;
  EXPECT_EQ(found.status, expected.status) << what;
  EXPECT_TRUE(found.enclosure.overlaps(expected.enclosure)) << what;
}

// With the sky as a source, all factors come from the sweep that finds the sky.
void expect_as_one_by_one(const Scene& scene, const Receiver& receiver, const std::vector<Selection>& sources) {
  const SourceFactors together(scene, sources, Sky::kLastSource);
  ASSERT_TRUE(together.sweeps({}));
  SourceFactors::Results results;
  together.find_all(receiver, {}, results);
  ASSERT_EQ(results.factors.size(), sources.size() + 1);
  for (std::size_t s = 0; s < sources.size(); ++s) {
    expect_same(results.factors[s], exact_form_factor(scene, receiver, {scene, sources[s]}), scene.name_of(sources[s]));
  }
  EXPECT_EQ(results.factors.back().value, view(scene, receiver).open.value);
}

class SourceFactorsOf : public testing::TestWithParam<RandomFamily> {};

TEST_P(SourceFactorsOf, PatchesAreThoseOneByOne) {
  for_each_scene_of(GetParam(), 4, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    std::vector<Selection> sources = every_patch(scene);
    expect_as_one_by_one(scene, receiver, sources);
    std::ranges::reverse(sources);
    expect_as_one_by_one(scene, receiver, sources);
  });
}

TEST_P(SourceFactorsOf, FacesAreThoseOneByOne) {
  for_each_scene_of(GetParam(), 4, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    expect_as_one_by_one(scene, receiver, every_face(scene));
  });
}

// The whole view leaves transparent sources out.
TEST_P(SourceFactorsOf, TransparentPatchesAreFoundOneByOne) {
  for_each_scene_of(GetParam(), 8, [](const PlainScene&, const Scene& whole, const Receiver& receiver) {
    const Scene scene = whole.with_transparent(std::array{every_patch(whole).front()});
    if (scene.transparent().empty()) return;
    const std::vector<Selection> sources = every_patch(scene);
    const SourceFactors together(scene, sources, Sky::kLastSource);
    SourceFactors::Results results;
    together.find_all(receiver, {}, results);
    for (std::size_t s = 0; s < sources.size(); ++s) {
      expect_same(results.factors[s], exact_form_factor(scene, receiver, {scene, sources[s]}),
                  scene.name_of(sources[s]));
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Families, SourceFactorsOf, testing::ValuesIn(random_families()),
                         [](const auto& test) { return std::string(test.param.name); });

std::string truth_file(const Scene& scene, truth::Request request, Engine engine) {
  request.scene = &scene;
  request.engine = engine;
  std::ostringstream out;
  (void)truth::write(std::move(request), out);
  return std::move(out).str();
}

// A hall with so many lamps that its truth file is made by sweeps. The other engine finds sources one by one.
TEST(SourceFactors, GiveATruthFileTheSameBytes) {
  const Scene scene = models::make_scene("emitters:n=400,boxes=4");
  truth::Request request;
  request.threads = 1;
  request.receivers = grid_receivers(scene, scene.select("floor"), {2, 2});
  request.sources = every_patch(scene);
  std::erase_if(request.sources, [&](const Selection& patch) { return scene.faces_of(patch).empty(); });
  ASSERT_TRUE(SourceFactors(scene, request.sources, Sky::kLeftOut).sweeps({}));
  EXPECT_EQ(truth_file(scene, request, Engine::kEdges), truth_file(scene, request, Engine::kBoth));
  request.total = Quantity::kRadiance;
  request.unoccluded = true;
  EXPECT_EQ(truth_file(scene, request, Engine::kEdges), truth_file(scene, request, Engine::kBoth));
}

// Few sources of many are found one by one.
TEST(SourceFactors, OfFewSourcesMakeNoSweep) {
  const Scene scene = models::make_scene("emitters:n=400,boxes=4");
  EXPECT_FALSE(SourceFactors(scene, std::array{scene.select("floor")}, Sky::kLeftOut).sweeps({}));
  EXPECT_FALSE(SourceFactors(scene, every_patch(scene), Sky::kLeftOut).sweeps({.visible_fraction = true}));
}

}  // namespace
}  // namespace exactff::validation
