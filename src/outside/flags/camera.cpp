#include "flags/camera.h"

#include "flags/lists.h"
#include "kernel/vec.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::flags {

namespace {

bool is_along(const Vec3& direction, const Vec3& axis) {
  constexpr double kParallel = 1e-6;
  return !(kernel::max_norm(kernel::cross(kernel::unit(direction), axis)) > kParallel);
}

}  // namespace

void CameraArguments::add_to(CLI::App& app, const std::string& eye_meaning, const std::string& look_meaning) {
  add_vector_option(app, "--eye", eye, eye_meaning);
  add_vector_option(app, "--look", look, look_meaning);
  add_vector_option(app, "--up", up,
                    "The direction that points upwards in the picture (default: 0 0 1 if more area of fronts looks "
                    "along +z than along +y; else 0 1 0)");
  app.add_option("--fov", fov,
                 "Vertical angle of view in degrees (default: " + text::shortest(render::Camera{}.fov) + "; " +
                     text::shortest(render::kWideFov) + " where the program places a camera inside a closed room)")
      ->type_name("DEGREES")
      ->check(is_positive);
}

bool CameraArguments::is_placed() const {
  if (is_given(eye) == is_given(look)) return is_given(eye);
  text::refuse(
      std::string(is_given(eye) ? "--eye" : "--look") + " is given without " + (is_given(eye) ? "--look" : "--eye"),
      "a camera stands at one point and looks at another", "give both, or neither for a view of the whole");
}

render::CameraWishes CameraArguments::wishes() const {
  render::CameraWishes wishes{.fov = fov};
  if (!is_given(up)) return wishes;
  wishes.up = vector_of(up, "--up");
  if (wishes.up == Vec3{}) {
    text::refuse("--up is (0, 0, 0)", "nothing then says which side of the picture is up", "give a direction");
  }
  return wishes;
}

render::Camera CameraArguments::camera(const Scene& scene) const {
  render::Camera camera{.eye = vector_of(eye, "--eye"), .look = vector_of(look, "--look")};
  camera.up = is_given(up) ? wishes().up : render::upwards(scene);
  if (!is_given(up) && is_along(kernel::difference(camera.look, camera.eye), camera.up)) {
    camera.up = {0.0, camera.up.z, camera.up.y};
  }
  if (fov) camera.fov = *fov;
  return camera;
}

std::string command_words(const CameraArguments& args) {
  std::string line;
  const auto add = [&](const char* flag, const ThreeNumbers& numbers) {
    if (!is_given(numbers)) return;
    line += std::string(" ") + flag;
    for (const std::string& number : numbers) line += ' ' + number;
  };
  add("--eye", args.eye);
  add("--look", args.look);
  add("--up", args.up);
  if (args.fov) line += " --fov " + text::shortest(*args.fov);
  return line;
}

}  // namespace exactff::flags
