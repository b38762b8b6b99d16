// Intervals for readers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "generate/random.h"
#include "support/random_scenes.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::text {
namespace {

TEST(Interval, IsRoundedOutwardToAFractionOfItsWidth) {
  EXPECT_EQ(interval(0.8123, 1.0), "[0.812, 1]");
  EXPECT_EQ(interval(0.0, 13.99), "[0, 14]");
  EXPECT_EQ(interval(1.01773, 1.017736), "[1.01773, 1.017736]");
  EXPECT_EQ(interval(-0.5, 216.7), "[-0.5, 217]");
  EXPECT_EQ(interval(-7.33e-9, 3.218e-9), "[-7.4·10⁻⁹, 3.3·10⁻⁹]");
  EXPECT_EQ(interval(0.0, std::numeric_limits<double>::max()), "[0, 1.7976931348623157·10³⁰⁸]");
  EXPECT_EQ(interval(0.0, std::numeric_limits<double>::denorm_min()), "[0, 5·10⁻³²⁴]");
}

TEST(Interval, IsNotRoundedBeyondALimit) {
  EXPECT_EQ(interval(0.0, 13.7123456), "[0, 13.8]");
  EXPECT_EQ(interval(0.0, 13.7123456, 13.7123456), "[0, 13.7123]");
  EXPECT_EQ(interval(0.0, 6.0000000000003, 6.0000000000003), "[0, 6]");
}

TEST(Interval, IsOneNumberIfSixDigitsAgree) {
  EXPECT_EQ(interval(0.0, 0.0), "0");
  EXPECT_EQ(interval(13.9999999, 14.0000001), "14");
  EXPECT_EQ(interval(216.347, 216.347), "216.347");
}

double parsed(std::string text) {
  const std::size_t power = text.find("·10");
  if (power == std::string::npos) return parse_number(text).value;
  std::string exponent;
  for (std::size_t i = power + std::string("·10").size(); i < text.size();) {
    for (int digit = -1; digit < 10; ++digit) {
      const std::string shown = digit < 0 ? "⁻" : superscript(digit);
      if (text.compare(i, shown.size(), shown) != 0) continue;
      exponent += digit < 0 ? "-" : std::to_string(digit);
      i += shown.size();
      break;
    }
  }
  return parse_number(text.substr(0, power) + 'e' + exponent).value;
}

TEST(Interval, HoldsTheBoundsThatItShows) {
  for (std::uint64_t s = 0; s < validation::scaled_count(3000); ++s) {
    generate::Random random(validation::seed_of(s));
    const double scale = std::pow(10.0, random.integer(-300, 300)), width = std::pow(0.1, random.integer(0, 16));
    const double lower = scale * random.between(-1, 1), upper = lower + scale * width * random.unit();
    const std::string shown = interval(lower, upper);
    if (shown.front() != '[') continue;
    const std::size_t comma = shown.find(", ");
    const double low = parsed(shown.substr(1, comma - 1)),
                 high = parsed(shown.substr(comma + 2, shown.size() - comma - 3));
    EXPECT_LE(low, lower) << shown << ' ' << s;
    EXPECT_GE(high, upper) << shown << ' ' << s;
    EXPECT_LE((lower - low) + (high - upper), 0.021 * (upper - lower)) << shown << ' ' << s;
  }
}

}  // namespace
}  // namespace exactff::text
