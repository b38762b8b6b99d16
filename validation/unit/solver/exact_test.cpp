// The result of the exact method: status, bounds, decimals, cutters, fractions, bad receivers, drawings.
#include "kernel/ball.h"
#include "support/solve.h"
#include "support/test.h"

namespace exactff {
namespace {

using validation::solve;

generate::PlainScene square_source(double half = 1.0, double z = 1.0) {
  generate::PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-half, half, z}, {half, half, z}, {half, -half, z}, {-half, -half, z}});
  return scene;
}

void add_square(generate::PlainScene& scene, const std::string& name, double half, double z, double x = 0.0,
                double y = 0.0) {
  scene.add_ring(scene.patch(name),
                 {{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}});
}

TEST(ExactFormFactor, BoundsAreTheNeighboursOfACertifiedValue) {
  const FormFactor f = solve(square_source());
  EXPECT_EQ(f.status, Status::kCertified);
  EXPECT_EQ(f.lower, std::nextafter(f.value, 0.0));
  EXPECT_EQ(f.upper, std::nextafter(f.value, 1.0));
  EXPECT_TRUE(f.enclosure.contains(f.enclosure));
  EXPECT_EQ(f.enclosure.nearest(), f.value);
}

TEST(ExactFormFactor, BoundsAreNumbersHoweverFewBitsAreAllowed) {
  PlainScene plain = square_source();
  add_square(plain, "o", 0.3, 0.4, 0.1, 0.2);
  const double value = solve(plain).value;
  for (const Engine engine : validation::kEngines) {
    for (int cap = 1; cap <= 16; ++cap) {
      const FormFactor f = validation::solve_by(engine, plain, {.precision_cap = cap});
      EXPECT_LE(0.0, f.lower) << cap;
      EXPECT_LE(f.lower, value) << cap;
      EXPECT_LE(value, f.upper) << cap;
      EXPECT_LE(f.upper, 1.0) << cap;
      EXPECT_EQ(f.value, f.value) << cap;
    }
  }
}

TEST(ExactFormFactor, AValueThatRoundsToOneIsBoundedByOne) {
  const FormFactor f = solve(square_source(1.0, 1e-12));
  EXPECT_EQ(f.value, 1.0);
  EXPECT_EQ(f.upper, 1.0);
  EXPECT_EQ(f.lower, std::nextafter(1.0, 0.0));
  EXPECT_EQ(f.status, Status::kCertified);
}

TEST(ExactFormFactor, PositiveButRoundingToZeroIsAnUnderflow) {
  const FormFactor f = solve(square_source(1e-170));
  EXPECT_EQ(f.status, Status::kUnderflow);
  EXPECT_EQ(f.value, 0.0);
  EXPECT_EQ(f.lower, 0.0);
  EXPECT_EQ(f.upper, std::numeric_limits<double>::denorm_min());
}

TEST(ExactFormFactor, ADecimalTieLeavesTheDoubleCertified) {
  // An eighth of the sphere of directions: F = 1/8, a tie that no ball can round to two decimals.
  PlainScene plain;
  plain.add_ring(plain.patch("source"), {{1, 0, 0}, {1, 0, 2}, {1, 1, 2}, {1, 1, 0}});
  plain.add_ring(plain.patch("source"), {{0, 0, 2}, {1, 1, 2}, {1, 0, 2}});
  const FormFactor f = solve(plain, {.digits = 2, .precision_cap = 1024});
  EXPECT_EQ(f.value, 0.125);
  EXPECT_EQ(f.status, Status::kCertified);
  EXPECT_FALSE(f.enclosure.decimals(2).has_value());
  EXPECT_TRUE(f.enclosure.decimals(3).has_value());
}

TEST(ExactFormFactor, AllAndNothingAreDecidedExactlyHoweverTheFractionRounds) {
  const auto seen = [](double occluder_half) {
    PlainScene plain = square_source();
    add_square(plain, "o", occluder_half, 0.5);
    return solve(plain, {.visible_fraction = true});
  };
  EXPECT_EQ(seen(0x1p-40).visible_fraction, 1.0);
  EXPECT_EQ(seen(0x1p-40).visible_part, VisiblePart::kSome);
  EXPECT_EQ(seen(0.5).visible_part, VisiblePart::kNothing);
  EXPECT_EQ(solve(square_source(), {.visible_fraction = true}).visible_part, VisiblePart::kAll);
}

TEST(ExactFormFactor, AShadowInTheGapOfASourceDoesNotCutIt) {
  PlainScene plain;
  plain.add_rings(plain.patch("source"), {{{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}},
                                          {{-0.5, 0.5, 1}, {0.5, 0.5, 1}, {0.5, -0.5, 1}, {-0.5, -0.5, 1}}});
  add_square(plain, "in_the_gap", 0.2, 0.5);
  add_square(plain, "over_the_rim", 0.2, 0.5, 0.2);
  const Scene scene = generate::build(plain);
  const FormFactor f = solve(scene, plain, {.list_cutters = true});
  ASSERT_EQ(f.cutters.size(), 1U);
  EXPECT_EQ(scene.name_of(f.cutters[0]), "over_the_rim");
}

TEST(ExactFormFactor, ASourceWithoutAreaGivesZero) {
  PlainScene plain;
  plain.add_ring(plain.patch("source"), {{-1, 0, 1}, {1, 0, 1}, {0, 0, 1}});
  const FormFactor f = solve(plain, {.visible_fraction = true});
  EXPECT_EQ(f.status, Status::kZero);
  EXPECT_EQ(f.lower, 0.0);
  EXPECT_EQ(f.upper, 0.0);
  EXPECT_EQ(f.visible_fraction, 0.0);
}

// All shadows lie within 2^-40 of one direction, but doubles know directions only to 2^-49.
TEST(ExactFormFactor, OccludersThatNothingTellsApartAreLeftToTheBooleans) {
  constexpr double kSize = 0x1p-40;
  PlainScene plain = square_source(kSize);
  Random random(7);
  constexpr int kTriangles = 4000;
  for (int i = 0; i < kTriangles; ++i) {
    const double x = random.between(-2, 2), y = random.between(-2, 2);
    const auto number = [&](double middle) { return kSize * (middle + random.between(-0.05, 0.05)); };
    const auto corner = [&] { return Vec3{number(x), number(y), 0.5}; };
    plain.add_ring(plain.patch("occ"), {corner(), corner(), corner()});
  }
  const FormFactor f = validation::solve_by(Engine::kEdges, plain);
  EXPECT_EQ(f.planes.at(0).engine, Engine::kBoolean);
  EXPECT_EQ(f.planes.at(0).outcome, Outcome::kPartlyHidden);
  EXPECT_EQ(f.status, Status::kCertified);
  plain.patch("occ").faces.resize(300);
  EXPECT_EQ(solve(plain).planes.at(0).engine, Engine::kEdges);
}

TEST(ExactFormFactor, RefusesAReceiverWithoutDirectionOrPlace) {
  PlainScene plain = square_source();
  plain.normal = {0.0, -0.0, 0.0};
  EXPECT_THROW((void)solve(plain), InputError);
  plain.normal = {0.0, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_THROW((void)solve(plain), InputError);
  plain.normal = {0.0, 0.0, 1.0};
  plain.point.x = std::nan("");
  EXPECT_THROW((void)solve(plain), InputError);
}

// Their sums round in different places, so that their estimates differ.
TEST(ExactFormFactor, EnginesThatMeetTheCapNeedNotAgreeOnAnEstimate) {
  int uncertified = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    Random random(validation::seed_of(i));
    const PlainScene plain = validation::degenerate_scene(random);
    const FormFactor f = solve(plain, {.engine = Engine::kBoth, .precision_cap = 33});
    uncertified += f.status == Status::kNotCertified ? 1 : 0;
  }
  EXPECT_GT(uncertified, 0);
}

// --- Results, workspaces and enclosures that are used again: nothing of the last value remains in them ---

// Of all that an option may ask for, by its bits.
std::string text_of(const FormFactor& result) {
  std::ostringstream text;
  const auto number = [&](double x) { text << generate::to_text(x) << ' '; };
  const auto derivative = [&](const Derivative& d) {
    text << to_string(d.status) << ' ' << (d.status == DerivativeStatus::kNone ? "" : generate::to_text(d.value));
  };
  for (const double x : {result.value, result.lower, result.upper, result.visible_fraction.value_or(-1.0)}) number(x);
  text << to_string(result.status) << ' ' << result.precision_bits << ' '
       << (result.visible_part ? to_string(*result.visible_part) : "no part") << " cut by";
  for (const FaceId face : result.cutters) text << ' ' << index_of(face);
  for (const PlaneRecord& plane : result.planes) {
    text << "\n"
         << to_string(plane.engine) << ' ' << to_string(plane.outcome) << ' ' << plane.horizon_clipped << ' '
         << plane.candidates << ' ' << plane.pairs << ' ' << plane.undecided_pairs << ' ' << plane.loops << ' '
         << plane.edges << ' ' << plane.exact_fraction.value_or("none") << " cut by " << plane.cutters.value_or(0)
         << ' ';
    number(plane.visible_fraction.value_or(-1.0));
  }
  if (!result.gradient) return text.str();
  text << '\n' << (result.gradient->kink ? to_string(result.gradient->kink->reason) : "no kink") << ' ';
  for (const auto* three : {&result.gradient->position, &result.gradient->normal}) {
    for (const Derivative& d : *three) derivative(d);
  }
  if (result.gradient->along) derivative(*result.gradient->along);
  text << result.gradient->arcs.size() << ' ' << result.gradient->vertices.size();
  return text.str();
}

// One result and one workspace are reused for all pairs; nothing of a pair may remain in them for the next.
class KeptResult : public ::testing::Test {
 protected:
  void expect_as_anew(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                      const ExactOptions& options) {
    exact_form_factor(scene, receiver, source, options, kept_, workspace_);
    FormFactor anew;
    Workspace fresh;
    exact_form_factor(scene, receiver, source, options, anew, fresh);
    EXPECT_EQ(text_of(kept_), text_of(anew));
    EXPECT_TRUE(kept_.enclosure.contains(anew.enclosure) && anew.enclosure.contains(kept_.enclosure));
  }
  void expect_as_anew(const PlainScene& plain, const ExactOptions& options) {
    const Scene scene = generate::build(plain);
    const ExactSource source(scene, scene.select(plain.source));
    expect_as_anew(scene, generate::receiver_of(plain), source, options);
  }

  FormFactor kept_;
  Workspace workspace_;
};

const std::vector<FaceId> kNobody;
const std::vector<ExactOptions> kOptions = {
    {},
    {.visible_fraction = true, .exact_fraction = true, .list_cutters = true},
    {.digits = 60},
    {.vertices = true},
    {.engine = Engine::kBoolean},
    {.precision_cap = 20},
    {.engine = Engine::kBoth, .visible_fraction = true},
    {.list_cutters = true, .culling = ShaftCulling::kNone},
    {.engine = Engine::kBoolean, .exact_fraction = true, .list_cutters = true},
    {.only_occluders = &kNobody},
    {.gradient = true},
    {.list_arcs = true, .along = Vec3{1.0, 2.0, 0.0}},
    {.engine = Engine::kBoth, .gradient = true},
    {.gradient = true, .precision_cap = 20},
};

TEST_F(KeptResult, IsAsOneMadeAnew) {
  std::vector<PlainScene> scenes(8, square_source());
  add_square(scenes[1], "hides_all", 0.9, 0.5);
  add_square(scenes[2], "hides_some", 0.2, 0.5, 0.1);
  scenes[3].normal = {0.0, 0.0, -1.0};  // below the horizon
  scenes[4].normal = {1.0, 0.0, 0.1};   // crosses the horizon
  scenes[5].point = {0.0, 0.0, 2.0};    // behind
  add_square(scenes[6], "source", 0.3, 0.8, 0.2, 0.1);
  scenes[6].add_ring(scenes[6].patch("source"), {{1, -1, 1}, {2, -1, 0.7}, {2, 1, 0.7}, {1, 1, 1}});
  add_square(scenes[7], "half", 0.5, 0.5, 0.5);
  add_square(scenes[7], "other_half", 0.5, 0.5, -0.5);
  for (std::size_t step : {1U, 5U, 7U}) {  // in several orders
    const std::size_t count = scenes.size() * kOptions.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = i * step % count;
      SCOPED_TRACE(at);
      expect_as_anew(scenes[at / kOptions.size()], kOptions[at % kOptions.size()]);
    }
  }
}

}  // namespace
}  // namespace exactff
