// Reduces a failing case to a small scene that can be kept as a regression case.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fuzz/scene_bytes.h"

namespace exactff::validation {

struct Shrunk {
  generate::PlainScene scene;
  std::string problem;  // of the shrunk scene: a disagreement, "crashes" or "hangs"
  bool alone = true;    // true: the scene fails by itself; false: only together with the identity
  Identity identity{};  // the identity with which it fails, if not alone
};

// Nothing if the case does not fail. Every attempt runs in a separate process, for at most `seconds`.
[[nodiscard]] std::optional<Shrunk> shrink(const FuzzCase& fuzz_case, unsigned seconds = 20);

// Writes NAME.json, a case for data/regression with the oracle's result as expected value, and NAME.obj for viewing.
// Returns the path of the case.
std::filesystem::path keep(const Shrunk& shrunk, const std::string& name, const std::filesystem::path& folder);

}  // namespace exactff::validation
