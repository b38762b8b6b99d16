// Compares the solver with an algorithm that shares nothing with it: equal doubles, zero flags and exact rational
// fractions.
//
// EXACTFF_TEST_SCALE multiplies the number of scenes, EXACTFF_TEST_SEED selects other scenes, and EXACTFF_TEST_KEEP
// names a directory for the minimised cases of failures.
#include <cstdlib>

#include "generate/families.h"
#include "support/case_file.h"
#include "support/minimise.h"
#include "support/oracle_check.h"
#include "support/solve.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

// The oracle itself, on scenes with known values.
TEST(Oracle, AgreesWithTheReferenceCases) {
  for (const auto& path : case_paths(EXACTFF_DATA_DIR "/reference")) {
    const CaseFile file = read_case(path);
    const OracleResult truth = ask_oracle(file.scene);
    EXPECT_EQ(truth.value, file.expected.nearest) << file.name;
    EXPECT_EQ(truth.zero, file.expected.exact_zero) << file.name;
    if (file.expected.visible_fractions.size() == 1) {
      EXPECT_DOUBLE_EQ(truth.planes.at(0).visible_fraction.get_d(), file.expected.visible_fractions[0]) << file.name;
    }
  }
}

void keep(const std::string& name, const PlainScene& scene) {
  const char* directory = std::getenv("EXACTFF_TEST_KEEP");
  if (directory == nullptr) return;
  std::ofstream(std::filesystem::path(directory) / (name + ".obj")) << generate::to_obj(scene);
  if (std::ranges::find(scene.patches, "on", &generate::PlainPatch::name) != scene.patches.end()) return;
  try {
    std::ofstream(std::filesystem::path(directory) / (name + ".json"))
        << to_json(as_case(name, scene), "found by a random search");
  } catch (const std::exception&) {  // outside the case format, like receivers on a face: only the OBJ is kept
  }
}

using Make = PlainScene (*)(Random&);

void expect_agreement(const std::string& family, std::uint64_t count, Make make) {
  constexpr int kEnough = 5;  // number of failures to minimise
  int failures = 0;
  for (std::uint64_t i = 0; i < scaled_count(count) && failures < kEnough; ++i) {
    Random random(seed_of(i));
    const PlainScene scene = make(random);
    const std::string problem = disagreement(scene);
    if (problem.empty()) continue;
    ++failures;
    const bool threw = problem.starts_with("threw");
    const PlainScene small = minimised(scene, [threw](const PlainScene& s) {
      const std::string found = disagreement(s);
      return !found.empty() && found.starts_with("threw") == threw;
    });
    keep(family + '_' + std::to_string(seed_of(i)), small);
    ADD_FAILURE() << problem << " in scene " << i << ", seed " << seed_of(i) << "; minimised (" << disagreement(small)
                  << "):\n"
                  << generate::to_obj(small);
  }
}

TEST(Oracle, AgreesOnDegenerateScenes) { expect_agreement("degenerate", 250, &degenerate_scene); }
TEST(Oracle, AgreesOnGenericScenes) { expect_agreement("generic", 60, &generic_scene); }
TEST(Oracle, AgreesOnScenesNudgedByAnUlp) { expect_agreement("nudged", 150, &nudged_scene); }
TEST(Oracle, AgreesOnShearedScenes) { expect_agreement("sheared", 100, &sheared_scene); }
TEST(Oracle, AgreesOnCrowdedScenes) { expect_agreement("crowded", 20, &crowded_scene); }
TEST(Oracle, AgreesOnScenesOfAllMagnitudes) { expect_agreement("magnitudes", 60, &scene_of_all_magnitudes); }

class OracleOnRays : public testing::TestWithParam<RandomFamily> {};

TEST_P(OracleOnRays, Agrees) { expect_agreement(GetParam().name, GetParam().count, GetParam().make); }

INSTANTIATE_TEST_SUITE_P(RandomScenes, OracleOnRays, testing::ValuesIn(families_on_rays()),
                         [](const auto& family) { return family.param.name; });

// One scene of each family of the generator, with rounded coordinates.
TEST(Oracle, AgreesOnTheGeneratedFamilies) {
  for (const generate::Family& family : generate::families()) {
    if (family.name == "room") continue;  // its form factors are checked by closure
    const int n = family.name == "tiles" ? 5 : 24;
    PlainScene scene = family.make({.n = n, .seed = seed_of(0), .drop = 7});
    generate::scale(scene, 0.1);
    EXPECT_EQ(disagreement(scene), "") << family.name;
  }
}

FaceId any_face(const Scene& scene, Random& random) {
  return FaceId{static_cast<std::uint32_t>(random.below(scene.faces().size()))};
}

// The receiver lies on a face, or on several: neither these faces nor the parts into which they were cut may hide or
// emit.
TEST(Oracle, AgreesForReceiversOnFaces) {
  for (std::uint64_t i = 0; i < scaled_count(100); ++i) {
    Random random(seed_of(i));
    const PlainScene plain = random.one_in(2) ? nudged_scene(random) : degenerate_scene(random);
    const Scene scene = generate::build(plain);
    Receiver receiver = generate::receiver_of(plain);
    for (std::uint64_t own = random.below(4); receiver.on.size() <= own;)
      receiver.on.push_back(any_face(scene, random));
    ASSERT_EQ(disagreement(scene, receiver, scene.select(plain.source)), "")
        << "on " << scene.name_of(receiver.on) << ", seed " << seed_of(i) << '\n'
        << generate::to_obj(plain);
  }
}

// Transparent faces hide nothing, on closed surfaces as elsewhere, and may be a part of the source.
TEST(Oracle, AgreesForTransparentFaces) {
  for (std::uint64_t i = 0; i < scaled_count(100); ++i) {
    Random random(seed_of(i));
    const PlainScene plain = random.one_in(2) ? nudged_scene(random) : degenerate_scene(random);
    const Scene opaque = generate::build(plain);
    std::vector<Selection> panes;
    for (std::uint64_t k = random.below(3); panes.size() <= k;) {
      const FaceId face = any_face(opaque, random);
      panes.push_back({opaque.face(face).patch, face, opaque.id()});
    }
    const Scene scene = opaque.with_transparent(panes);
    ASSERT_EQ(disagreement(scene, receiver_in(scene, plain), scene.select(plain.source)), "")
        << "seed " << seed_of(i) << '\n'
        << generate::to_obj(plain);
  }
}

// Sources so far away that F is subnormal, or positive but rounds to zero.
TEST(Oracle, AgreesWhereTheFormFactorUnderflows) {
  int statuses[3] = {0, 0, 0};
  for (int exponent = 480; exponent <= 560; ++exponent) {
    Random random(seed_of(static_cast<std::uint64_t>(exponent)));
    PlainScene plain = generic_scene(random);
    const double far = std::ldexp(1.0, exponent);
    plain.patches.resize(1);
    plain.vertices.resize(3);
    for (Vec3& vertex : plain.vertices) vertex = {vertex.x, vertex.y, far};
    plain.point = {};
    plain.normal = {0, 0, 1};
    const FormFactor result = solve(plain);
    const OracleResult truth = ask_oracle(plain);
    ASSERT_EQ(result.value, truth.value) << "2^" << exponent;
    ASSERT_FALSE(std::signbit(result.value)) << "2^" << exponent;
    ASSERT_EQ(result.status == Status::kZero, truth.zero);
    ++statuses[static_cast<int>(result.status)];
  }
  EXPECT_GT(statuses[static_cast<int>(Status::kCertified)], 0);
  EXPECT_GT(statuses[static_cast<int>(Status::kUnderflow)], 0);
}

// A search that finds only empty or full sources would prove little.
double partly_visible_share(Make make) {
  constexpr int kCount = 50;
  int partial = 0;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    Random random(seed_of(i));
    ExactOptions options;
    options.visible_fraction = true;
    partial += solve(make(random), options).visible_part == VisiblePart::kSome ? 1 : 0;
  }
  return static_cast<double>(partial) / kCount;
}

TEST(RandomScenes, ManyShowPartOfTheirSource) {
  EXPECT_GT(partly_visible_share(&degenerate_scene), 0.25);
  EXPECT_GT(partly_visible_share(&generic_scene), 0.25);
  EXPECT_GT(partly_visible_share(&nudged_scene), 0.25);
  EXPECT_GT(partly_visible_share(&sheared_scene), 0.25);
  EXPECT_GT(partly_visible_share(&crowded_scene), 0.25);
  EXPECT_GT(partly_visible_share(&scene_of_all_magnitudes), 0.25);
  for (const RandomFamily& family : families_on_rays())
    EXPECT_GT(partly_visible_share(family.make), 0.1) << family.name;
}

}  // namespace
}  // namespace exactff::validation
