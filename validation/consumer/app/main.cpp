// Reads a scene and holds a form factor against the closed form for a point below the corner of a parallel rectangle.
#include <exactff/error.h>
#include <exactff/exact.h>
#include <exactff/scene_files.h>
#include <exactff/version.h>

#include <cmath>
#include <cstdio>
#include <numbers>

namespace {

// Sides a and b in units of the distance.
double corner_form_factor(double a, double b) {
  const double p = std::sqrt(1.0 + a * a);
  const double q = std::sqrt(1.0 + b * b);
  return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2.0 * std::numbers::pi);
}

// Input errors are exceptions that cross from the library into this program.
bool refuses_what_is_not_there() {
  try {
    (void)exactff::read_obj("there/is/no/such.obj");
  } catch (const exactff::InputError& error) {
    return !error.problems().empty();
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const exactff::Scene scene = exactff::read_obj(argv[1]);
  const exactff::ExactSource lamp(scene, scene.select("lamp"));
  const exactff::FormFactor f = exactff::exact_form_factor(scene, {.point = {0, 0, 0}, .normal = {0, 0, 1}}, lamp);
  const double expected = corner_form_factor(0.5, 1.0);
  std::printf("exactff %s: %.17g, closed form %.17g\n", exactff::kVersion, f.value, expected);
  const bool agrees = f.status == exactff::Status::kCertified && std::abs(f.value - expected) < 1e-15;
  return agrees && refuses_what_is_not_there() ? 0 : 1;
}
