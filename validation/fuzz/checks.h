// What must hold for a fuzzed scene: the solver agrees with the oracle, and with itself after a change that must not
// matter. The check functions return a short description of the problem, or an empty string if there is none.
#pragma once

#include <optional>
#include <string>

#include "fuzz/scene_bytes.h"
#include "generate/plain_scene.h"

namespace exactff::validation {

// Checks what support/oracle_check.h checks: equal doubles, zero flags and exact visible fractions.
[[nodiscard]] std::string oracle_problem(const generate::PlainScene& scene);

// The scene after the change of the case's identity. Nothing if the identity does not compare two scenes, or if it
// cannot be applied to this one.
[[nodiscard]] std::optional<generate::PlainScene> changed(const FuzzCase& fuzz_case);

[[nodiscard]] std::string identity_problem(const FuzzCase& fuzz_case);

// Runs both checks. An exception is a problem, too.
[[nodiscard]] std::string problem(const FuzzCase& fuzz_case);

[[nodiscard]] std::string name_of(Identity identity);

}  // namespace exactff::validation
