// Values of a method over many seeds.
#pragma once

#include "support/test.h"
#include "unit/rivals/methods_support.h"

namespace exactff::validation {

// The values that seeds 1 to `count` give.
inline std::vector<double> values_by_seed(const generate::PlainScene& plain, const std::string& choice, int count) {
  const Scene scene = generate::build(plain);
  const Receiver receiver = generate::receiver_of(plain);
  methods::Choice chosen = methods::parse(choice);
  const auto on_scene = chosen.method->prepare(scene);
  const auto source = on_scene->prepare_source(scene.select(plain.source));
  std::vector<double> values;
  for (int seed = 1; seed <= count; ++seed) {
    chosen.settings.set("seed", std::int64_t{seed});
    values.push_back(on_scene->configure(chosen.settings)->form_factor(receiver, *source).form_factor);
  }
  return values;
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

inline Moments moments(const std::vector<double>& values) {
  Moments result;
  const auto count = static_cast<double>(values.size());
  for (const double v : values) result.mean += v / count;
  for (const double v : values) result.variance += (v - result.mean) * (v - result.mean) / (count - 1.0);
  return result;
}

}  // namespace exactff::validation
