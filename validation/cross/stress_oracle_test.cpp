// The oracle checks every stiff scene that has few enough faces for it, also where no closed form exists.
#include <gtest/gtest.h>

#include "stress/stress.h"
#include "support/decimal.h"
#include "support/oracle.h"

namespace exactff::stress {
namespace {

using validation::oracle;
using validation::OracleResult;
using validation::read_decimal;

constexpr std::size_t kMostFaces = 40;

class StiffScene : public testing::TestWithParam<std::size_t> {};

TEST_P(StiffScene, HasTheSameValueAndFractionForBoth) {
  const Family& family = all_families()[GetParam()];
  for (double stiffness : family.stiffnesses) {
    const Case stiff = family.make(stiffness);
    if (stiff.scene.faces().size() > kMostFaces) break;
    const Selection selection = stiff.scene.select("source");
    const FormFactor result = exact_form_factor(stiff.scene, stiff.receiver, ExactSource(stiff.scene, selection),
                                                {.engine = Engine::kBoth, .visible_fraction = true, .digits = 30});
    const OracleResult other = oracle(stiff.scene, stiff.receiver, selection);
    ASSERT_EQ(result.value, other.value) << stiffness;
    ASSERT_EQ(result.status == Status::kZero, other.zero) << stiffness;
    ASSERT_EQ(read_decimal(result.enclosure.decimals(30).value()).value, read_decimal(other.decimals).value)
        << stiffness;
    ASSERT_EQ(result.visible_fraction, other.visible_fraction) << stiffness;
  }
}

INSTANTIATE_TEST_SUITE_P(All, StiffScene, testing::Range<std::size_t>(0, all_families().size()),
                         [](const testing::TestParamInfo<std::size_t>& tested) {
                           std::string name(all_families()[tested.param].name);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace exactff::stress
