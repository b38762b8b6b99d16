// Other measures than the form factor, compared with an algorithm that shares nothing with the solver: the same double
// and zero flag by both engines.
#include "support/decimal.h"
#include "support/oracle.h"
#include "support/oracle_check.h"
#include "support/test.h"
#include "support/view_scenes.h"

namespace exactff::validation {
namespace {

// Upwards along the normal, against it, across it, along an axis, or anywhere on a lattice.
Vec3 random_up(Random& random, const Vec3& n) {
  switch (random.below(6)) {
    case 0:
      return {2.0 * n.x, 2.0 * n.y, 2.0 * n.z};
    case 1:
      return {-n.x, -n.y, -n.z};
    case 2:
      return n.x == 0.0 && n.y == 0.0 ? Vec3{1.0, 0.0, 0.0} : Vec3{-n.y, n.x, 0.0};
    case 3:
      return {0.0, 0.0, 1.0};
    case 4:
      return {0.0, -1.0, 0.0};
    default: {
      const auto number = [&] { return static_cast<double>(random.below(9)) - 4.0; };
      return {number(), number(), 0.5 + number()};
    }
  }
}

// Any normal, too: the families' are mostly upright.
void turn_normal(Random& random, Receiver& receiver) {
  if (!receiver.on.empty() || random.one_in(2)) return;
  const auto number = [&] { return static_cast<double>(random.below(7)) - 3.0; };
  receiver.normal = {number(), number(), 0.5 + number()};
}

void expect_oracle(const Scene& scene, const Receiver& receiver, const Selection& selection, const Measure& measure) {
  SCOPED_TRACE(testing::Message() << to_string(measure.kind) << (measure.sphere ? " of a sphere" : "") << ", up "
                                  << measure.up.x << ' ' << measure.up.y << ' ' << measure.up.z << ", n "
                                  << receiver.normal.x << ' ' << receiver.normal.y << ' ' << receiver.normal.z);
  const ExactSource source(scene, selection);
  const FormFactor found = exact_form_factor(scene, receiver, source, {.engine = Engine::kBoth, .measure = measure});
  if (some_is_buried(scene)) return;  // the oracle knows no solids
  const OracleResult truth = oracle(scene, receiver, selection, measure);
  ASSERT_EQ(found.value, truth.value) << found.enclosure.midpoint() << " and " << truth.decimals;
  ASSERT_EQ(found.status == Status::kZero, truth.zero);
  const mpq_class middle = read_decimal(found.enclosure.midpoint()).value;
  const mpq_class radius = read_decimal(found.enclosure.radius()).value;
  ASSERT_TRUE(middle - radius <= truth.high && truth.low <= middle + radius);
}

class MeasuresOfRandomScenes : public testing::TestWithParam<RandomFamily> {};

TEST_P(MeasuresOfRandomScenes, AreWhatTheOracleFinds) {
  for_each_scene_of(GetParam(), 4, [](const generate::PlainScene& plain, const Scene& scene, Receiver receiver) {
    Random random(seed_of(plain.vertices.size()));
    turn_normal(random, receiver);
    const Selection source = scene.select(plain.source);
    expect_oracle(scene, receiver, source, {.kind = MeasureKind::kSolidAngle});
    expect_oracle(scene, receiver, source, {.sphere = true});
    expect_oracle(scene, receiver, source, {.kind = MeasureKind::kSolidAngle, .sphere = true});
    for (int i = 0; i < 2; ++i) {
      expect_oracle(scene, receiver, source,
                    {.kind = MeasureKind::kOvercast, .up = random_up(random, receiver.normal)});
    }
  });
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, MeasuresOfRandomScenes, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });

}  // namespace
}  // namespace exactff::validation
