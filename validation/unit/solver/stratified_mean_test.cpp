// Intervals of means over strata, judged by numbers whose means are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "unit/solver/add_numbers.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {
namespace {

// Strata of equal area. On each, a function is `high` on a share of it and 0 elsewhere.
struct Spots {
  std::vector<double> shares, high;

  [[nodiscard]] double weight() const { return 1.0 / static_cast<double>(shares.size()); }
  [[nodiscard]] double mean() const {
    double sum = 0.0;
    for (std::size_t s = 0; s < shares.size(); ++s) sum += weight() * shares[s] * high[s];
    return sum;
  }
  // Each range is 1. `control`: of every stratum.
  StratifiedMean analyse(std::mt19937_64& random, double control, double expected) const {
    StratifiedMean result{.expected = expected};
    std::uniform_real_distribution<double> uniform;
    for (std::size_t s = 0; s < shares.size(); ++s) {
      const auto draw = [&] { return uniform(random) < shares[s] ? high[s] : 0.0; };
      const double a = draw();
      add_numbers(result, a, draw(), control, weight());
    }
    return result;
  }
};

Spots spots(std::size_t count, double share, double high = 1.0) {
  return {std::vector(count, share), std::vector(count, high)};
}

// The probability with which an interval of risk 0.2 misses the mean.
double missed(const Spots& of, double control, double expected) {
  constexpr int kAnalyses = 1000;
  constexpr double kRisk = 0.2;
  std::mt19937_64 random(7);
  int missed = 0;
  for (int i = 0; i < kAnalyses; ++i) {
    const StratifiedMean mean = of.analyse(random, control, expected);
    missed += std::abs(mean.value - of.mean()) > mean.error(0.5 * of.weight(), kRisk) ? 1 : 0;
  }
  return static_cast<double>(missed) / kAnalyses;
}

// None of 72 numbers meets anything.
TEST(StratifiedMean, WhatNoNumberHasMetCounts) {
  StratifiedMean mean;
  for (int s = 0; s < 36; ++s) add_numbers(mean, 0.0, 0.0, 0.0, 1.0 / 36.0);
  const double error = mean.error(0.5 / 36.0, 1e-6), least = std::log(2e6) / 72.0;
  EXPECT_GT(error, least);
  EXPECT_LT(error, 1.02 * least);
  EXPECT_LT(std::pow(1.0 - error, 72.0), 1e-6)
      << "the probability that 72 draws miss a set of this share, evenly spread";
  EXPECT_NEAR(mean.error(0.0625 / 36.0, 1e-6), 0.125 * error, 1e-12) << "of a function that is an eighth as large";
}

TEST(StratifiedMean, IsKnownWhereNothingCanBeSeen) {
  StratifiedMean mean;
  add_numbers(mean, 0.0, 0.0, 0.0, 1.0);
  EXPECT_EQ(mean.error(0.0, 1e-6), 0.0);
}

// Rare, and common; all alike, and different; whatever the control variates, and what was expected.
TEST(StratifiedMean, IntervalsMissNoMoreThanTheirRisk) {
  std::mt19937_64 random(1);
  std::vector<Spots> all;
  for (const double share : {0.002, 0.01, 0.03, 0.1, 0.5, 0.9, 0.999}) all.push_back(spots(60, share));
  for (const double high : {0.1, 0.5}) all.push_back(spots(60, 0.5, high));
  Spots mixed;
  for (int s = 0; s < 60; ++s) {
    mixed.shares.push_back(std::uniform_real_distribution<double>()(random));
    mixed.high.push_back(std::uniform_real_distribution<double>()(random));
  }
  all.push_back(mixed);
  const double r = 0.5 / 60.0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const double control : {0.0, 0.5, 1.0}) {
      for (const double expected : {0.0, 2.0 * r * r, 30.0 * r * r})
        EXPECT_LT(missed(all[i], control, expected), 0.2) << i;
    }
  }
}

// The worst case: so few spots that they are often not met at all. The interval is not much wider than it must be.
TEST(StratifiedMean, IntervalsAreNotMuchWiderThanTheyMustBe) {
  const double share = 0.5 * std::log(10.0) / 60.0;  // unmet with a probability of about 0.1
  double largest = 0.0;
  for (double more = 1.0; more < 2.0; more += 0.02)
    largest = std::max(largest, missed(spots(60, more * share), 0.0, 0.0));
  EXPECT_GT(largest, 0.02);
}

// With good control variates, how large the function is does not matter.
TEST(StratifiedMean, ControlVariatesNarrowTheInterval) {
  const auto error = [](double control) {
    StratifiedMean mean;
    for (int s = 0; s < 100; ++s) add_numbers(mean, 0.75, 0.75, control, 0.01);
    return mean.error(0.005, 1e-6);
  };
  EXPECT_DOUBLE_EQ(error(0.75), StratifiedMean().error(0.005, 1e-6));
  EXPECT_GT(error(0.0), 2.0 * error(0.75));
  EXPECT_GT(error(0.5), error(0.75));
}

// Of a linear function, linear control variates leave nothing to chance; those that are off leave the interval true.
TEST(StratifiedMean, ControlVariatesMayDependOnThePlace) {
  constexpr int kStrata = 50, kAnalyses = 400;
  constexpr double kSlope = 0.4, kRisk = 0.2;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform;
  for (const double guessed : {kSlope, 0.0, -kSlope}) {
    int missed = 0;
    for (int analysis = 0; analysis < kAnalyses; ++analysis) {
      StratifiedMean mean{.expected = 1.0 / kStrata};
      for (int s = 0; s < kStrata; ++s) {
        const double place = uniform(random) - 0.5;
        mean.add(0.5 + kSlope * place, 0.5 + guessed * place, 0.5, 1.0 / kStrata);
      }
      missed += std::abs(mean.value - 0.5) > mean.error(0.5 / kStrata, kRisk) ? 1 : 0;
      const bool is_right = guessed == kSlope;
      EXPECT_TRUE(!is_right || std::abs(mean.value - 0.5) < 1e-14);
      EXPECT_EQ(mean.square < 1e-28, is_right);
    }
    EXPECT_LT(missed, kRisk * kAnalyses) << guessed;
  }
}

// What is expected decides how wide the interval is, but only the right number makes it about the narrowest.
TEST(StratifiedMean, IsNarrowestWhereTheSquareIsAsExpected) {
  constexpr double kTerm = 0.005, kUnit = kTerm * kTerm;
  for (const double square : {1.0, 10.0, 100.0, 1000.0}) {
    const auto error = [&](double expected) {
      return StratifiedMean{.expected = expected * kUnit, .square = square * kUnit}.error(kTerm, 1e-6);
    };
    for (const double off : {0.01, 0.1, 10.0, 100.0})
      EXPECT_LT(error(square), error(off * square)) << square << ' ' << off;
    EXPECT_LT(error(square), kTerm * (std::log(2e6) * 1.5 + std::sqrt(2.5 * std::log(2e6) * square)));
  }
}

}  // namespace
}  // namespace exactff::view_factors
