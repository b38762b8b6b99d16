// From a failing case to a small scene that can be kept as a regression case.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fuzz/scene_bytes.h"

namespace exactff::validation {

struct Shrunk {
  generate::PlainScene scene;
  std::string problem;  // of the shrunk scene: a disagreement, "crashes" or "hangs"
  bool alone = true;    // the scene fails by itself; false: only together with the identity
  Identity identity{};  // what it fails with if not alone
};

// Nothing if the case does not fail. Every attempt runs in a process of its own, for `seconds` at most.
[[nodiscard]] std::optional<Shrunk> shrink(const FuzzCase& fuzz_case, unsigned seconds = 20);

// Writes NAME.json, a case for data/regression whose expected value is the oracle's, and NAME.obj, to look at.
// Returns the path of the case.
std::filesystem::path keep(const Shrunk& shrunk, const std::string& name, const std::filesystem::path& folder);

}  // namespace exactff::validation
