// Words and numbers for the tables of stiff scenes.
#pragma once

#include <string>

#include "exactff/stress.h"

namespace exactff::stress {

// "10³⁰⁰" and "2⁵²" for powers from 10000 on, "4096" below; "–" for 0.
[[nodiscard]] std::string stiffness_text(double stiffness);

// "3.4·10⁻¹⁷", "refused", "no number".
[[nodiscard]] std::string error_text(const Answer& answer);

// How far a method keeps its error below a threshold: "all" to the family's end, else the last stiffness, or "–".
[[nodiscard]] std::string reach_text(const FamilyResult& result, Method method, double threshold);

// The same for every threshold: "10⁸ · 10⁵ · 100", or "all"; "(refused)" where the method then refuses the scene.
[[nodiscard]] std::string reaches_text(const FamilyResult& result, Method method);

}  // namespace exactff::stress
