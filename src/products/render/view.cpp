// The rays of a camera. The header documents every operation, since users rebuild these rays.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "exactff/enclosure.h"
#include "exactff/render.h"
#include "kernel/ball.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "text/phrases.h"

namespace exactff::render {
namespace {

using kernel::cross;
using kernel::difference;
using kernel::is_finite;
using kernel::unit;

// (from + s a) + r b
Vec3 moved(const Vec3& from, double s, const Vec3& a, double r, const Vec3& b) {
  return {(from.x + s * a.x) + r * b.x, (from.y + s * a.y) + r * b.y, (from.z + s * a.z) + r * b.z};
}

// tan(degrees / 2), correctly rounded. Ends, since the tangent of a rational number of degrees is irrational or one of
// 0 and +-1.
double tangent_of_half(double degrees) {
  for (long bits = 96;; bits *= 2) {
    const Ball half_angle = kernel::to_ball(degrees, bits) * kernel::pi(bits) / kernel::to_ball(360.0, bits);
    if (const auto nearest = EnclosureInside::of(kernel::tan(half_angle)).nearest()) return *nearest;
  }
}

std::vector<Problem> problems_of_numbers(const Camera& camera, const Size& size) {
  std::vector<Problem> problems;
  const auto refuse = [&](std::string what, std::string why, std::string suggestion) {
    problems.push_back({.what = std::move(what), .why = std::move(why), .suggestion = std::move(suggestion)});
  };
  for (const int side : {size.width, size.height}) {
    if (side >= 1 && side <= kLongestSide) continue;
    refuse("the picture is " + std::to_string(size.width) + "x" + std::to_string(size.height) + " pixels",
           "each side is between 1 and " + std::to_string(kLongestSide) + " pixels", "give a size such as 512x512");
    break;
  }
  if (!(camera.fov > 0.0 && camera.fov < 180.0)) {
    refuse("the camera's angle of view is " + text::shortest(camera.fov) + " degrees",
           "it is above 0 and below 180 degrees", "give the vertical angle, for example 40");
  }
  if (camera.ortho && !(*camera.ortho > 0.0 && std::isfinite(*camera.ortho))) {
    refuse("the height of the parallel view is " + text::shortest(*camera.ortho),
           "it is a positive length in the scene's unit", "give the height of what the picture should show");
  }
  if (!is_finite(camera.eye) || !is_finite(camera.look) || !is_finite(camera.up)) {
    refuse("the camera's eye, look or up is not finite", "rays need finite coordinates",
           "give three finite numbers each");
  }
  return problems;
}

// Empty, or the problem with the directions of a camera whose numbers are finite.
std::optional<Problem> problem_of_directions(const Camera& camera) {
  const Vec3 along = difference(camera.look, camera.eye);
  if (along == Vec3{}) {
    return Problem{.what = "the camera's eye and the point that it looks at are the same",
                   .why = "the line of sight has no direction",
                   .suggestion = "move one of them"};
  }
  if (!is_finite(along)) {
    return Problem{.what = "the camera's eye and the point that it looks at are too far apart",
                   .why = "their difference is not a double",
                   .suggestion = "look at a point nearer to the eye, in the same direction"};
  }
  constexpr double kParallel = 1e-9;
  if (camera.up == Vec3{} || !(kernel::max_norm(cross(unit(along), unit(camera.up))) > kParallel)) {
    return Problem{.what = "the camera's up vector is zero or parallel to the line of sight",
                   .why = "nothing then says which side of the picture is up",
                   .suggestion = "give another direction, for example along another axis"};
  }
  return std::nullopt;
}

}  // namespace

View::View(const Camera& camera, const Size& size) : camera_(camera), size_(size) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Problem> problems = problems_of_numbers(camera, size);
  if (problems.empty()) {
    if (auto problem = problem_of_directions(camera)) problems.push_back(std::move(*problem));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  forward_ = unit(difference(camera.look, camera.eye));
  right_ = unit(cross(forward_, unit(camera.up)));
  up_ = cross(right_, forward_);
  tangent_ = camera.ortho ? 0.5 * *camera.ortho : tangent_of_half(camera.fov);
}

Ray View::ray(double column, double row) const {
  const double s = (2.0 * column - size_.width) / size_.height * tangent_;
  const double r = (size_.height - 2.0 * row) / size_.height * tangent_;
  if (camera_.ortho) return {moved(camera_.eye, s, right_, r, up_), forward_};
  return {camera_.eye, moved(forward_, s, right_, r, up_)};
}

}  // namespace exactff::render
