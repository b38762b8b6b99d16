// Checks that both engines of the solver agree with the oracle.
#pragma once

#include <string>

#include "generate/plain_scene.h"
#include "support/oracle.h"

namespace exactff::validation {

// The receiver of a plain scene. If the scene has a patch `on`, the receiver lies on its only face.
[[nodiscard]] Receiver receiver_in(const Scene& scene, const generate::PlainScene& plain);

[[nodiscard]] OracleResult ask_oracle(const generate::PlainScene& plain);

// Empty if both engines and the oracle agree: in the double, in the zero flag, in the exact visible fraction of every
// plane, in the results for all planes together, and if their enclosures share a number. Throws what any of them
// throws.
[[nodiscard]] std::string disagreement(const Scene& scene, const Receiver& receiver, const Selection& source);

// The same for a plain scene. An exception counts as a disagreement.
[[nodiscard]] std::string disagreement(const generate::PlainScene& plain);

}  // namespace exactff::validation
