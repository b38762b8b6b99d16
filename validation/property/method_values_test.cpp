// include/exactff/methods.h promises that every value is finite, and in [0, 1] unless the method says that its formula
// can leave this range. If a method refuses a scene, it throws an InputError with a message, and nothing else.
//
// The scenes are those of the exact solver's tests (support/random_scenes.h), degenerate ones first, unchanged and with
// every axis scaled by a different power of two, up to 2^1000. EXACTFF_TEST_SCALE multiplies the number of scenes,
// EXACTFF_TEST_SEED selects other scenes.
#include "support/oracle_check.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

// The settings end the recursion early, because each leaf costs the control an exact visible fraction. The exact method
// is tested by oracle_test.cpp, and needs seconds if scenes of size 2^1000 go to the Boolean engine.
const std::vector<std::string> kChoices = {"adaptive:eps_B=0.02,rays=4,depth_cap=6",
                                           "adaptive:eps_B=0.05,rays=9,pattern=low-discrepancy,depth_cap=6",
                                           "adaptive:eps_B=0.05,rays=1,pattern=centre,eps_A=0.01,depth_cap=6",
                                           "adaptive:eps_B=0.02,rays=4,variant=literal,depth_cap=6",
                                           "adaptive:eps_B=0.1,rays=16,variant=literal,pattern=regular,depth_cap=4",
                                           "adaptive-exact-visibility:eps_B=0.1,depth_cap=1",
                                           "hemicube:resolution=2",
                                           "hemicube:resolution=16,rotation=15",
                                           "hemicube:resolution=50",
                                           "nettle",
                                           "nettle:splits=3,rays=4,pattern=centre",
                                           "nettle:variant=literal",
                                           "nettle:variant=literal,splits=2,area_ratio=sender-over-receiver",
                                           "nettle:variant=literal,receiver_area=1e-300,rays=3,pattern=regular",
                                           "nettle:variant=literal,receiver_area=1e300",
                                           "wallace",
                                           "wallace:splits=2,pattern=jittered,seed=3",
                                           "area-sampling:samples=32,pattern=random",
                                           "area-sampling:samples=16,pattern=stratified",
                                           "area-sampling:samples=16,pattern=sobol",
                                           "area-sampling:samples=9,pattern=sobol",
                                           "area-sampling:samples=5,pattern=sobol,seed=7",
                                           "area-sampling:samples=16,measure=solid-angle",
                                           "area-sampling:samples=9,pattern=sobol,measure=solid-angle"};

struct Judge {
  std::uint64_t values = 0, refusals = 0, beyond_one = 0;
};

bool is_literal(const methods::Choice& choice) {
  return choice.settings.has("variant") && choice.settings.word("variant") == "literal";
}

bool recurses(const methods::Choice& choice) { return choice.method->name.starts_with("adaptive"); }

// Empty if the value is as promised.
std::string fault(const methods::Choice& choice, double value, std::size_t source_pieces) {
  const auto told = [&](const char* what) { return choice.text() + " gives " + std::to_string(value) + ", " + what; };
  if (!std::isfinite(value)) return told("which is not finite");
  if (is_literal(choice)) return {};
  if (value < 0.0 || std::signbit(value)) return told("which is negative");
  const bool promised = !choice.method->can_leave_unit || !choice.method->can_leave_unit(choice.settings);
  if (value > 1.0 && (promised || (recurses(choice) && source_pieces == 1))) return told("which exceeds 1");
  return {};
}

// Values of one method from one receiver; empty if all are as promised.
std::string judged(const Scene& scene, const Receiver& receiver, const std::string& source, const std::string& text,
                   Judge& judge) {
  const methods::Choice choice = methods::parse(text);
  const Selection selection = scene.select(source);
  std::size_t pieces = 0;
  for (const FaceId face : scene.faces_of(selection)) pieces += scene.face(face).piece_count;
  try {
    const auto on_scene = choice.method->prepare(scene);
    const auto prepared = on_scene->prepare_source(selection);
    const double value = on_scene->configure(choice.settings)->form_factor(receiver, *prepared).form_factor;
    ++judge.values;
    judge.beyond_one += value > 1.0 && !is_literal(choice) ? 1 : 0;
    return fault(choice, value, pieces);
  } catch (const InputError& refusal) {
    ++judge.refusals;
    const std::string words = refusal.what();
    return words.size() > 20 ? std::string() : text + " refuses without words: " + words;
  } catch (const std::exception& other) {
    return text + " throws " + other.what();
  }
}

double power(Random& random, int range) { return std::ldexp(1.0, random.integer(-range, range)); }

// A different random power of two for every axis, the same for all, or none.
void stretch(PlainScene& scene, Random& random) {
  constexpr int kRanges[] = {0, 10, 60, 130, 500, 1000};
  const int range = kRanges[random.below(std::size(kRanges))];
  Vec3 by{power(random, range), power(random, range), power(random, range)};
  if (random.one_in(3)) by.y = by.z = by.x;
  if (random.one_in(3)) by.y = by.x;
  const auto stretched = [&](const Vec3& p) { return Vec3{p.x * by.x, p.y * by.y, p.z * by.z}; };
  for (Vec3& vertex : scene.vertices) vertex = stretched(vertex);
  scene.point = stretched(scene.point);
}

Vec3 moved(const Vec3& p, const Vec3& towards, double share) {
  return {p.x + (towards.x - p.x) * share, p.y + (towards.y - p.y) * share, p.z + (towards.z - p.z) * share};
}

// The scene's own receiver, one very near a corner, and one far away.
Receiver receiver_in(const PlainScene& plain, const Scene& scene, Random& random) {
  Receiver receiver = generate::receiver_of(plain);
  const Vec3 corner = plain.vertices[random.below(plain.vertices.size())];
  if (random.one_in(4)) receiver.point = moved(receiver.point, corner, 1.0 - std::ldexp(1.0, -random.integer(1, 60)));
  if (random.one_in(6)) receiver.point = moved(corner, receiver.point, std::ldexp(1.0, -random.integer(40, 900)));
  if (random.one_in(8)) receiver.point = moved(corner, receiver.point, std::ldexp(1.0, random.integer(1, 900)));
  if (random.one_in(4)) {
    const double by = std::ldexp(1.0, random.integer(-900, 900));
    receiver.normal = {receiver.normal.x * by, receiver.normal.y * by, receiver.normal.z * by};
  }
  if (random.one_in(8)) receiver.on = {FaceId{static_cast<std::uint32_t>(random.below(scene.faces().size()))}};
  return receiver;
}

// Enlarged until Embree is used: copies of the scene's occluders, each slightly displaced.
void crowd(PlainScene& plain, Random& random) {
  const std::size_t patches = plain.patches.size();
  for (int copy = 0; copy < 6; ++copy) {
    for (std::size_t k = 0; k < patches; ++k) {
      if (plain.patches[k].name == plain.source || plain.patches[k].name == "on") continue;
      const std::vector<generate::PlainFace> faces = plain.patches[k].faces;
      for (const generate::PlainFace& face : faces) {
        std::vector<Vec3> corners;
        const double share = random.integer(1, 15) / 64.0;
        for (const std::uint32_t v : face.rings.front())
          corners.push_back(moved(plain.vertices[v], plain.point, share));
        plain.add_ring(plain.patches[k], corners);
      }
    }
  }
}

void judge_scenes(std::uint64_t count, PlainScene (*make)(Random&)) {
  Judge judge;
  int failures = 0;
  for (std::uint64_t i = 0; i < scaled_count(count) && failures < 5; ++i) {
    Random random(seed_of(i));
    PlainScene plain = make(random);
    if (random.one_in(4)) crowd(plain, random);
    stretch(plain, random);
    std::optional<Scene> scene;
    try {
      scene.emplace(generate::build(plain));
    } catch (const InputError&) {
      continue;  // overflow, or a face that scaling makes invalid
    }
    const Receiver receiver = receiver_in(plain, *scene, random);
    for (const std::string& text : kChoices) {
      const std::string problem = judged(*scene, receiver, plain.source, text, judge);
      if (problem.empty()) continue;
      ++failures;
      ADD_FAILURE() << problem << "\nscene " << i << ", seed " << seed_of(i) << ", receiver (" << receiver.point.x
                    << ", " << receiver.point.y << ", " << receiver.point.z << "), normal (" << receiver.normal.x
                    << ", " << receiver.normal.y << ", " << receiver.normal.z << ")\n"
                    << generate::to_obj(plain);
      break;
    }
  }
  testing::Test::RecordProperty("values", static_cast<int>(judge.values));
  testing::Test::RecordProperty("refusals", static_cast<int>(judge.refusals));
  testing::Test::RecordProperty("beyond_one", static_cast<int>(judge.beyond_one));
  EXPECT_GT(judge.values, 0U);
}

TEST(MethodValues, AreAsPromisedOnDegenerateScenes) { judge_scenes(60, &degenerate_scene); }
TEST(MethodValues, AreAsPromisedOnScenesOfAllMagnitudes) { judge_scenes(40, &scene_of_all_magnitudes); }
TEST(MethodValues, AreAsPromisedOnScenesNudgedByAnUlp) { judge_scenes(30, &nudged_scene); }
TEST(MethodValues, AreAsPromisedOnGenericScenes) { judge_scenes(30, &generic_scene); }
TEST(MethodValues, AreAsPromisedOnShearedScenes) { judge_scenes(20, &sheared_scene); }
TEST(MethodValues, AreAsPromisedOnCrowdedScenes) { judge_scenes(5, &crowded_scene); }

TEST(MethodValues, AreAsPromisedOnScenesOnRays) {
  for (const RandomFamily& family : families_on_rays()) {
    SCOPED_TRACE(family.name);
    judge_scenes(4, family.make);
  }
}

// Only the control, to a greater depth. V is exact and in [0, 1], so the error of a leaf that eps_F stops is at most
// eps_F, and other leaves have only rounding errors.
class ControlValues : public testing::TestWithParam<RandomFamily> {};

TEST_P(ControlValues, AreWithinTheirBound) {
  const methods::Choice choice = methods::parse("adaptive-exact-visibility:eps_B=0.01,depth_cap=10");
  for (std::uint64_t i = 0; i < scaled_count(1 + GetParam().count / 20); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const PlainScene plain = GetParam().make(random);
    const Scene scene = generate::build(plain);
    const Receiver receiver = validation::receiver_in(scene, plain);
    const Selection selection = scene.select(plain.source);
    std::unique_ptr<methods::PreparedScene> on_scene;
    try {
      on_scene = choice.method->prepare(scene);
    } catch (const InputError&) {
      continue;
    }
    const auto source = on_scene->prepare_source(selection);
    const methods::Estimate found = on_scene->configure(choice.settings)->form_factor(receiver, *source);
    ASSERT_TRUE(std::isfinite(found.form_factor));
    ASSERT_GE(found.form_factor, 0.0);
    const std::string family = GetParam().name;
    const bool moderate = family == "Degenerate" || family == "Generic" || family == "Triangles";
    if (!moderate || scene.faces_of(selection).size() > 1 || found.counters["leaves: depth cap"] > 0) continue;
    const double truth = exact_form_factor(scene, receiver, ExactSource(scene, selection)).value;
    ASSERT_NEAR(found.form_factor, truth, 0.01 * static_cast<double>(found.counters["leaves: eps_F"]) + 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, ControlValues, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });

}  // namespace
}  // namespace exactff::validation
