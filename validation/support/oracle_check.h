// Do both engines of the solver agree with the oracle?
#pragma once

#include <string>

#include "generate/plain_scene.h"
#include "support/oracle.h"

namespace exactff::validation {

// The receiver of a plain scene; on the only face of the patch `on`, if the scene has one.
[[nodiscard]] Receiver receiver_in(const Scene& scene, const generate::PlainScene& plain);

[[nodiscard]] OracleResult ask_oracle(const generate::PlainScene& plain);

// Empty if both engines and the oracle agree: in the double, in the zero flag, in the exact visible fraction of every
// plane, in what is said of all planes together, and their enclosures share a number. Throws what any of them throws.
[[nodiscard]] std::string disagreement(const Scene& scene, const Receiver& receiver, const Selection& source);

// The same for a plain scene; an exception is a disagreement.
[[nodiscard]] std::string disagreement(const generate::PlainScene& plain);

}  // namespace exactff::validation
