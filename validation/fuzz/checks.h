// What must hold for a fuzzed scene: the solver agrees with the oracle, and with itself after a change that may not
// matter. Every function returns what is wrong in a few words, and nothing where all is well.
#pragma once

#include <optional>
#include <string>

#include "fuzz/scene_bytes.h"
#include "generate/plain_scene.h"

namespace exactff::validation {

// support/oracle_check.h: equal doubles, zero flags and exact visible fractions.
[[nodiscard]] std::string oracle_problem(const generate::PlainScene& scene);

// The scene that the case's identity turns its scene into; nothing where the identity compares no two scenes, or
// cannot be applied to this one.
[[nodiscard]] std::optional<generate::PlainScene> changed(const FuzzCase& fuzz_case);

[[nodiscard]] std::string identity_problem(const FuzzCase& fuzz_case);

// Both, and no exception either.
[[nodiscard]] std::string problem(const FuzzCase& fuzz_case);

[[nodiscard]] std::string name_of(Identity identity);

}  // namespace exactff::validation
