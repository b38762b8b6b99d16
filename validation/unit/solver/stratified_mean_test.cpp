// Intervals of means over strata, judged by numbers whose means are known.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace exactff::view_factors
