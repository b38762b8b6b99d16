// Makes a failing scene small before anyone has to look at it.
#pragma once

#include <functional>

#include "support/case_file.h"

namespace exactff::validation {

// Drops patches, then faces, as long as `fails` stays true. Requires fails(scene). Corners no face uses are gone from
// the result.
[[nodiscard]] generate::PlainScene minimised(generate::PlainScene scene,
                                             const std::function<bool(const generate::PlainScene&)>& fails);

// The scene as a case file, with what the oracle says as the expected value. Patches of several polygons are cut
// into one patch a face; a source of several polygons is beyond the format and throws std::invalid_argument.
[[nodiscard]] CaseFile as_case(const std::string& name, const generate::PlainScene& scene);

}  // namespace exactff::validation
