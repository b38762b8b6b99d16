// Runs the exact solver on a plain scene, and compares two results.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "generate/plain_scene.h"

namespace exactff::validation {

// Everything that specification and header promise to be independent of order, thread, machine and symmetry.
struct Answer {
  std::uint64_t value_bits = 0;
  Status status = Status::kZero;
  std::uint64_t fraction_bits = 0;

  friend bool operator==(const Answer&, const Answer&) = default;
};

inline void PrintTo(const Answer& answer, std::ostream* out) {
  *out << generate::to_text(std::bit_cast<double>(answer.value_bits)) << ' ' << to_string(answer.status) << " fraction "
       << generate::to_text(std::bit_cast<double>(answer.fraction_bits));
}

inline constexpr std::array kEngines{Engine::kEdges, Engine::kBoolean};

inline FormFactor solve_by(Engine engine, const Scene& scene, const generate::PlainScene& plain,
                           ExactOptions options = {}) {
  options.engine = engine;
  const ExactSource source(scene, scene.select(plain.source));
  return exact_form_factor(scene, generate::receiver_of(plain), source, options);
}

inline FormFactor solve_by(Engine engine, const generate::PlainScene& plain, const ExactOptions& options = {}) {
  return solve_by(engine, generate::build(plain), plain, options);
}

// Solves with both engines and checks one against the other, unless the options name an engine that is not the default.
// A test that used the default engine alone would not detect faults of the reference. If a cap ends the search for a
// double, each engine has its own ball, and the two need only overlap: use solve_by in that case.
inline FormFactor solve(const Scene& scene, const generate::PlainScene& plain, const ExactOptions& options = {}) {
  const bool engine_named = options.engine != ExactOptions{}.engine;
  return solve_by(engine_named ? options.engine : Engine::kBoth, scene, plain, options);
}

inline FormFactor solve(const generate::PlainScene& plain, const ExactOptions& options = {}) {
  return solve(generate::build(plain), plain, options);
}

inline Answer answer_of(const FormFactor& result) {
  return {std::bit_cast<std::uint64_t>(result.value), result.status,
          std::bit_cast<std::uint64_t>(result.visible_fraction.value())};
}

inline Answer answer(const generate::PlainScene& plain) {
  ExactOptions options;
  options.visible_fraction = true;
  return answer_of(solve(plain, options));
}

}  // namespace exactff::validation
