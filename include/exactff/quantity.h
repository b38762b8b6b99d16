// Quantities of light at a point, for images and for sums over sources.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace exactff {

// B = Ke + rho * sum over sources of B_s F_s is what leaves the point, in each colour channel: rho is Kd of its face,
// Ke the emission of its face, B_s the radiosity of a source, F_s the exact form factor.
enum class Quantity {
  kRadiance,    // B / pi
  kRadiosity,   // B
  kIrradiance,  // sum of B_s F_s: what arrives, whatever the face reflects or emits
  kFormFactor,  // sum of F_s, in every channel
};
[[nodiscard]] std::string_view name_of(Quantity quantity);  // "radiance", "form-factor"
[[nodiscard]] std::optional<Quantity> quantity_named(std::string_view name);

enum class KeMeans { kRadiosity, kRadiance };  // kRadiance: B_s is pi Ke, and a face emits pi Ke

[[nodiscard]] std::string unit_of(Quantity quantity, KeMeans ke);  // "the unit of Ke / pi"

}  // namespace exactff
