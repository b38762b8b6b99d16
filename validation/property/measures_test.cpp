// Other measures than the form factor: known values, and identities that hold for any scene.
#include "property/closed_rooms.h"
#include "support/decimal.h"
#include "support/solve.h"
#include "support/test.h"
#include "support/view_judge.h"
#include "support/view_scenes.h"

namespace exactff::validation {
namespace {

constexpr Measure kSolidAngle{.kind = MeasureKind::kSolidAngle};
constexpr Measure kOvercast{.kind = MeasureKind::kOvercast};
constexpr Measure kSphere{.sphere = true};

PlainScene one_patch(std::vector<Vec3> corners, const Vec3& normal = {0.0, 0.0, 1.0}) {
  PlainScene plain;
  plain.normal = normal;
  plain.add_ring(plain.patch("source"), corners);
  return plain;
}

std::string digits_of(const PlainScene& plain, const Measure& measure, int digits) {
  const auto found = solve(plain, {.measure = measure, .digits = digits}).enclosure.decimals(digits);
  return found.value_or("undecided");
}

// Computed by another program in 40 digits, the window's also by quadrature.
TEST(Measures, HaveKnownValues) {
  const PlainScene skylight = one_patch({{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}});
  EXPECT_EQ(digits_of(skylight, {}, 25), "0.2394564704607735388250522");
  EXPECT_EQ(digits_of(skylight, kSolidAngle, 25), "0.8054316831613231658205022");
  EXPECT_EQ(digits_of(skylight, kOvercast, 25), "0.2946856763081011311147252");
  const PlainScene window = one_patch({{-1.5, 2, 0.5}, {1.5, 2, 0.5}, {1.5, 2, 2.5}, {-1.5, 2, 2.5}});
  EXPECT_EQ(digits_of(window, {}, 25), "0.1071190636931872161056762");
  EXPECT_EQ(digits_of(window, kSolidAngle, 24), "0.683152611782873293647823");
  EXPECT_EQ(digits_of(window, kOvercast, 25), "0.09557417856322859436514359");
}

// The triangle whose second moment is .1997200560921144767857249, with normal and up not parallel:
// 3 / (7 pi) (pi F + 2 M).
TEST(Measures, HaveTheMomentOfATiltedReceiver) {
  const PlainScene triangle = one_patch({{-0.5, 1, 1.5}, {1, 1.5, 2.5}, {1, -0.5, 2}}, {0.25, 0.125, 1.0});
  EXPECT_EQ(digits_of(triangle, {}, 25), "0.06975134541248252499449268");
  EXPECT_EQ(digits_of(triangle, kSolidAngle, 25), "0.2297602627758134276486218");
  const double f = solve(triangle).value, share = solve(triangle, {.measure = kOvercast}).value;
  EXPECT_NEAR(share, 3.0 / 7.0 * (f + 2.0 * 0.1997200560921144767857249 / std::numbers::pi), 1e-16);
}

// The second moment of two directions does not depend on which of them is the receiver's: with unit vectors,
// 7 E / 3 - F is the same for both, as balls.
TEST(Measures, AreSymmetricInNormalAndUp) {
  const Vec3 a{0.0, 0.0, 1.0}, b{0.48, 0.6, 0.64};  // b is a unit vector up to rounding, which both sides share
  for (std::uint64_t i = 0; i < scaled_count(50); ++i) {
    Random random(seed_of(i));
    PlainScene plain = generic_scene(random);
    plain.normal = a;
    const auto moment = [&](const Vec3& n, const Vec3& up) {
      plain.normal = n;
      const FormFactor e = solve(plain, {.measure = {MeasureKind::kOvercast, up}, .digits = 30});
      const FormFactor f = solve(plain, {.digits = 30});
      const auto number = [](const FormFactor& x) { return read_decimal(x.enclosure.midpoint()).value; };
      return mpq_class(7 * number(e) - 3 * number(f));
    };
    // Only where nothing is cut by the second horizon: otherwise F is of another region than the moment.
    plain.normal = b;
    const FormFactor cut = solve(plain, {.visible_fraction = true});
    plain.normal = a;
    const FormFactor whole = solve(plain, {.visible_fraction = true});
    if (cut.visible_fraction != whole.visible_fraction || whole.status == Status::kZero) continue;
    const mpq_class difference = moment(a, b) - moment(b, a);
    EXPECT_LT(abs(difference), mpq_class(1e-20)) << "seed " << seed_of(i);
  }
}

TEST(Measures, OfOpenGroundAreThoseOfTheWholeSky) {
  PlainScene plain = one_patch({{-1, -1, -2}, {-1, 1, -2}, {1, 1, -2}, {1, -1, -2}});
  const Scene scene = generate::build(plain);
  const Receiver up{{}, {0.0, 0.0, 3.0}, {}, {}};
  EXPECT_EQ(view(scene, up, {.measure = kOvercast}).open.value, 1.0);
  EXPECT_EQ(view(scene, up, {.measure = kSolidAngle}).open.value, 2.0 * std::numbers::pi);
  const ViewShare around = view(scene, up, {.measure = {MeasureKind::kSolidAngle, {}, true}}).open;
  EXPECT_LT(around.value, 4.0 * std::numbers::pi);
  // A vertical surface: 3 / (7 pi) (pi / 2 + 2 * 2/3).
  const Receiver sideways{{}, {1.0, 0.0, 0.0}, {}, {}};
  EXPECT_NEAR(view(scene, sideways, {.measure = kOvercast}).open.value,
              3.0 / (7.0 * std::numbers::pi) * (std::numbers::pi / 2.0 + 4.0 / 3.0), 1e-15);
  const Receiver down{{}, {0.0, 0.0, -1.0}, {}, {}};
  EXPECT_EQ(view(scene, down, {.measure = kOvercast}).open.status, Status::kZero);
}

// A wall that hides all of the sky that a vertical receiver sees, and more than that: it begins below the horizon.
TEST(Measures, OfAClosedSkyAreZero) {
  PlainScene plain;
  plain.add_ring(plain.patch("lid"), {{0, -9, 5}, {9, -9, 5}, {9, 9, 5}, {0, 9, 5}});
  plain.patch("lid").faces.clear();
  add_room(plain, box({-1, -2, -3}, {4, 5, 6}));
  const Scene scene = generate::build(plain);
  for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{1, 2, -1}, Vec3{0, 1, 1}}) {
    for (const Measure& measure : {kSolidAngle, kOvercast, kSphere}) {
      EXPECT_EQ(view(scene, Receiver{{}, n, {}, {}}, {.measure = measure}).open.status, Status::kZero);
    }
  }
}

Enclosure sum_of(const WholeView& seen) {
  Enclosure sum = seen.back.enclosure;
  sum += seen.open.enclosure;
  sum += seen.buried.enclosure;
  for (const SeenPatch& patch : seen.patches) sum += patch.share.enclosure;
  return sum;
}

class MeasuresOfViews : public testing::TestWithParam<RandomFamily> {};

// What the sweep finds is what the solver finds for one source, to the last bit; and all shares add up to the whole.
TEST_P(MeasuresOfViews, AreThoseOfSingleSourcesAndAddUp) {
  for_each_scene_of(GetParam(), 12, [](const PlainScene&, const Scene& scene, const Receiver& receiver) {
    for (const Measure& measure : {kSolidAngle, kSphere, kOvercast, Measure{MeasureKind::kOvercast, {1.0, 0.0, 2.0}}}) {
      SCOPED_TRACE(testing::Message() << to_string(measure.kind) << (measure.sphere ? ", sphere" : ""));
      const WholeView seen = view(scene, receiver, {.measure = measure});
      for (std::size_t p = 0; p < scene.patches().size(); ++p) {
        const Selection whole{.patch = static_cast<PatchId>(p), .face = {}, .scene = scene.id()};
        const FormFactor f = exact_form_factor(scene, receiver, ExactSource(scene, whole), {.measure = measure});
        const SeenPatch* patch = find_patch(seen, p);
        expect_same_bits(patch ? patch->form_factor : ViewShare{}, f, scene.patches()[p].name);
      }
      const Enclosure sum = sum_of(seen);
      if (measure == kSphere) {
        EXPECT_TRUE(sum.contains(1.0)) << sum.midpoint();
      } else if (measure == kSolidAngle) {
        // The double is below 2 pi by less than 2^-51.
        EXPECT_LE(sum.lower(), std::nextafter(2.0 * std::numbers::pi, 7.0));
        EXPECT_GE(sum.upper(), 2.0 * std::numbers::pi);
      } else {
        const WholeView open = view(generate::build(one_patch({{0, 0, 1e-9}, {1, 0, 1e-9}, {0, 1, 1e-9}})),
                                    {{receiver.point.x, receiver.point.y, receiver.point.z}, receiver.normal, {}, {}},
                                    {.measure = measure});
        EXPECT_TRUE(sum.overlaps(sum_of(open))) << sum.midpoint() << " and " << sum_of(open).midpoint();
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, MeasuresOfViews, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });

// Splitting a source changes no sum.
TEST(Measures, AreAdditive) {
  for (std::uint64_t i = 0; i < scaled_count(40); ++i) {
    Random random(seed_of(i));
    const auto number = [&] { return static_cast<double>(random.below(1000)) / 64.0 - 7.0; };
    const double z = 1.0 + number() * number();
    const Vec3 a{number(), number(), z}, b{number(), number(), z}, c{number(), number(), z},
        middle{0.5 * (a.x + b.x), 0.5 * (a.y + b.y), z};
    for (const Measure& measure : {kSolidAngle, kOvercast, kSphere, Measure{MeasureKind::kOvercast, {1, 2, 1}}}) {
      const auto ball = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
        Enclosure sum;
        for (const bool turned : {false, true}) {
          const PlainScene plain = turned ? one_patch({p, r, q}) : one_patch({p, q, r});
          try {
            sum += solve(plain, {.measure = measure, .digits = 25}).enclosure;
          } catch (const InputError&) {  // no area
          }
        }
        return sum;
      };
      Enclosure parts = ball(a, middle, c);
      parts += ball(middle, b, c);
      EXPECT_TRUE(parts.overlaps(ball(a, b, c))) << "seed " << seed_of(i);
    }
  }
}

TEST(Measures, RefuseWhatHasNoMeaning) {
  const PlainScene plain = one_patch({{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}});
  EXPECT_THROW((void)solve(plain, {.measure = {MeasureKind::kOvercast, {}}}), InputError);
  EXPECT_THROW((void)solve(plain, {.measure = {MeasureKind::kOvercast, {0, 0, 1}, true}}), InputError);
  EXPECT_THROW((void)solve(plain, {.measure = kSolidAngle, .gradient = true}), InputError);
  PlainScene without_normal = plain;
  without_normal.normal = {};
  EXPECT_THROW((void)solve(without_normal, {.measure = kSolidAngle}), InputError);
  EXPECT_EQ(solve(without_normal, {.measure = kSphere}).value, solve(plain, {.measure = kSphere}).value);
}

}  // namespace
}  // namespace exactff::validation
