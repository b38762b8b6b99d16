// Formats words and numbers for the tables of stiff scenes.
#pragma once

#include <string>

#include "exactff/stress.h"

namespace exactff::stress {

// Powers from 10000 on as "10³⁰⁰" and "2⁵²", smaller numbers as "4096", 0 as "–".
[[nodiscard]] std::string stiffness_text(double stiffness);

// "3.4·10⁻¹⁷", "refused", "no number".
[[nodiscard]] std::string error_text(const Answer& answer);

// Up to which stiffness a method keeps its error below a threshold: "all" if to the family's end, otherwise the last
// such stiffness, or "–".
[[nodiscard]] std::string reach_text(const FamilyResult& result, Method method, double threshold);

// The same for every threshold: "10⁸ · 10⁵ · 100", or "all". Adds "(refused)" if the method then refuses the scene.
[[nodiscard]] std::string reaches_text(const FamilyResult& result, Method method);

}  // namespace exactff::stress
