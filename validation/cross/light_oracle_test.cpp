// The light of several sources, compared with the oracle's form factors: sums of rational bounds.
#include <gmpxx.h>

#include "support/oracle.h"
#include "support/test.h"
#include "whole_view/light.h"

namespace exactff::validation {
namespace {

using whole_view::CertifiedNumber;
using whole_view::LightFormula;

// pi between two rationals 10^-40 apart.
const mpq_class& pi_low() {
  static const mpq_class kLow = mpq_class(mpz_class("31415926535897932384626433832795028841971")) /
                                mpq_class(mpz_class("1" + std::string(40, '0')));
  return kLow;
}
mpq_class pi_high() { return pi_low() + mpq_class(1) / mpq_class(mpz_class("1" + std::string(40, '0'))); }

struct Interval {
  mpq_class low, high;
};

Interval channel(const std::vector<OracleResult>& factors, const std::vector<double>& radiosities, double emitted,
                 double reflectance, int pi_power) {
  Interval sum{0, 0};
  for (std::size_t s = 0; s < factors.size(); ++s) {
    sum.low += mpq_class(radiosities[s]) * factors[s].low;
    sum.high += mpq_class(radiosities[s]) * factors[s].high;
  }
  Interval leaving{mpq_class(emitted) + mpq_class(reflectance) * sum.low,
                   mpq_class(emitted) + mpq_class(reflectance) * sum.high};
  if (pi_power > 0) return {leaving.low * pi_low(), leaving.high * pi_high()};
  if (pi_power < 0) return {leaving.low / pi_high(), leaving.high / pi_low()};
  return leaving;
}

// That the number is within half a unit in the last place of everything in the interval, and its bounds contain it.
void expect_rounded(const CertifiedNumber& number, const Interval& truth) {
  EXPECT_TRUE(number.certified);
  const mpq_class value(number.value), below(std::nextafter(number.value, -1.0)),
      above(std::nextafter(number.value, 2.0 * number.value + 1.0));
  EXPECT_LE((below + value) / 2, truth.low) << number.value;
  EXPECT_GE((above + value) / 2, truth.high) << number.value;
  EXPECT_LE(mpq_class(number.lower), truth.low);
  EXPECT_GE(mpq_class(number.upper), truth.high);
}

TEST(Light, IsTheRoundedSumOfTheOraclesFormFactors) {
  const Scene scene = models::make_scene("emitters:n=3,boxes=2,size=0.1");
  const std::vector<Selection> sources = scene.emitters();
  std::vector<Rgb> radiosities;
  for (std::size_t s = 0; s < sources.size(); ++s) radiosities.push_back({1.5 + double(s), 0.1, 1e-3 * double(s)});
  const whole_view::SourceFactors factors_of_all(scene, sources, whole_view::Sky::kLeftOut);
  const whole_view::Light all(factors_of_all, radiosities);
  whole_view::Light::Results results;
  int lit = 0;
  for (int i = 0; i < 8; ++i) {
    const Receiver receiver{
        .point = {1.1 * i + 0.7, 0.9 * i + 1.3, 0.0}, .normal = {0, 0, 1}, .on = {FaceId{0}}, .id = {}};
    std::vector<OracleResult> factors;
    for (const Selection& source : sources) factors.push_back(oracle(scene, receiver, source));
    for (const int power : {-1, 0, 1}) {
      const LightFormula formula{{0.0, 0.25, 1e-9}, {0.3, 0.7, 1.0 / 3.0}, power};
      const whole_view::Channels channels = all.at(receiver, formula, {}, results);
      if (channels[0].value > 0.0) ++lit;
      std::vector<double> r, g, b;
      for (const Rgb& one : radiosities) r.push_back(one.r), g.push_back(one.g), b.push_back(one.b);
      const Rgb &e = formula.emitted, &rho = formula.reflectance;
      if (channels[0].value == 0.0) {
        EXPECT_EQ(channels[0].upper, 0.0);
      } else {
        expect_rounded(channels[0], channel(factors, r, e.r, rho.r, power));
      }
      expect_rounded(channels[1], channel(factors, g, e.g, rho.g, power));
      expect_rounded(channels[2], channel(factors, b, e.b, rho.b, power));
    }
  }
  EXPECT_GE(lit, 6);
}

// Half a unit in the last place is added to a double: the sum is so near a midpoint that the first ball cannot tell.
TEST(Light, RaisesThePrecisionNearAMidpoint) {
  const Scene scene = read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  const Receiver receiver{.point = {200, 0, 400}, .normal = {0, 1, 0}, .on = {FaceId{0}}, .id = {}};
  const std::vector<Selection> sources = {scene.select("light")};
  const double tiny = 0x1p-120;
  const whole_view::SourceFactors factor(scene, sources, whole_view::Sky::kLeftOut);
  const whole_view::Light lamp(factor, {{tiny, tiny, 1.0}});
  whole_view::Light::Results results;
  // 1 + 2^-120 F is just above 1; (1 - 2^-53) + tiny F is just above a double and far from any midpoint.
  const whole_view::Channels channels = lamp.at(receiver, {{1.0, 1.0 - 0x1p-53, 0.0}, {1.0, 1.0, 1.0}, 0}, {}, results);
  EXPECT_EQ(channels[0].value, 1.0);
  EXPECT_EQ(channels[1].value, 1.0 - 0x1p-53);
  const OracleResult f = oracle(scene, receiver, sources[0]);
  EXPECT_EQ(channels[2].value, f.value);
  // rho F where rho is chosen so that the product is within 2^-53 of its unit in the last place of a midpoint.
  int refined = 0;
  for (int k = 1; k < 4000; ++k) {
    const LightFormula formula{{0, 0, 0}, {0, 0, 1.0 / k}, 0};
    const whole_view::Channels one = lamp.at(receiver, formula, {}, results);
    expect_rounded(one[2], channel({f}, {1.0}, 0.0, 1.0 / k, 0));
    if (!results.finer.empty()) ++refined;
  }
  EXPECT_LT(refined, 10);
}

}  // namespace
}  // namespace exactff::validation
