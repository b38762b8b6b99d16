#include "exactff/view.h"

namespace exactff {

std::string_view to_string(Quantity quantity) {
  switch (quantity) {
    case Quantity::kRadiance:
      return "radiance";
    case Quantity::kRadiosity:
      return "radiosity";
    case Quantity::kIrradiance:
      return "irradiance";
    case Quantity::kFormFactor:
      return "form-factor";
  }
  return {};
}

std::optional<Quantity> quantity_named(std::string_view name) {
  for (const Quantity quantity :
       {Quantity::kRadiance, Quantity::kRadiosity, Quantity::kIrradiance, Quantity::kFormFactor}) {
    if (to_string(quantity) == name) return quantity;
  }
  return std::nullopt;
}

std::string unit_of(Quantity quantity, KeMeans ke) {
  if (quantity == Quantity::kFormFactor) return "a pure number";
  const bool radiance = quantity == Quantity::kRadiance, ke_is_radiance = ke == KeMeans::kRadiance;
  return radiance == ke_is_radiance ? "the unit of Ke" : radiance ? "the unit of Ke / pi" : "the unit of Ke * pi";
}

}  // namespace exactff
