#include "exactff/version.h"
#include "python/bindings.h"

PYBIND11_MODULE(_exactff, module) {
  using namespace exactff::python;
  module.doc() = "The compiled part of the package exactff.";
  module.attr("version") = std::string(exactff::kVersion);
  bind_errors(module);
  bind_scene(module);
  bind_receivers(module);
  bind_form_factors(module);
  bind_methods(module);
  bind_truth(module);
  bind_check(module);
  bind_view_factors(module);
  bind_radiosity(module);
}
