// A camera for a scene of which nothing is known. Test pictures of few pixels decide where it stands: nothing else
// tells on which side a room is open.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "exactff/enclosure.h"
#include "exactff/render.h"
#include "kernel/ball.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/shaft_tree.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::render {
namespace {

using kernel::cross;
using kernel::difference;
using kernel::dot;
using kernel::is_finite;
using kernel::scaled;
using kernel::unit;
using kernel::unit_unscaled;

constexpr int kTestSide = 24;

struct Extents : Box {
  // Without overflow.
  [[nodiscard]] Vec3 at(double x, double y, double z) const {
    return {low.x * (1.0 - x) + high.x * x, low.y * (1.0 - y) + high.y * y, low.z * (1.0 - z) + high.z * z};
  }
};

Extents extents_of(const Scene& scene) {
  constexpr double kMost = std::numeric_limits<double>::max();
  Extents box{Box{{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}}};
  for (const Piece& piece : scene.pieces()) {
    for (const std::uint32_t v : scene.corners(piece)) box.include(scene.vertices()[v]);
  }
  return box;
}

// Far enough away in this direction to show every corner of the box; with parallel rays, outside the box.
Camera camera_from(const Extents& box, const Vec3& direction, const Camera& like, const Size& size) {
  Camera camera = like;
  camera.look = box.at(0.5, 0.5, 0.5);
  Vec3 up = unit_unscaled(like.up);
  const Vec3 away = unit_unscaled(direction);
  if (kernel::max_norm(cross(away, up)) < 1e-3) up = std::abs(up.y) > 0.5 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
  camera.up = up;
  const Vec3 right = unit_unscaled(cross(scaled(away, -1.0), up)), upward = cross(right, scaled(away, -1.0));
  constexpr double kMargin = 1.05;
  const double tangent = std::tan(like.fov * std::numbers::pi / 360.0) / kMargin;
  const double aspect = static_cast<double>(size.width) / size.height;
  double distance = 0.0, half_height = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = difference(box.at(corner & 1, corner >> 1 & 1, corner >> 2 & 1), camera.look);
    const double across = std::max(std::abs(dot(p, right)) / aspect, std::abs(dot(p, upward)));
    distance = std::max(distance, dot(p, away) + across / tangent);
    half_height = std::max(half_height, kMargin * across);
  }
  camera.eye = kernel::along(camera.look, away, distance);
  if (camera.ortho) camera.ortho = 2.0 * half_height;
  return camera;
}

// Calls take(hit) for each pixel of a test picture that shows a front.
template <class Take>
void for_each_front(const Scene& scene, const Camera& camera, const Size& size, const Take& take) {
  const View view(camera, size);
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const auto hit = first_hit(scene, view.ray(column + 0.5, row + 0.5));
      if (hit && !hit->back) take(*hit);
    }
  }
}

// The share of a test picture that shows fronts. Between views that show as much, the number of patches decides.
double fronts_seen(const Scene& scene, const Camera& camera) {
  int fronts = 0;
  std::set<PatchId> patches;
  for_each_front(scene, camera, {kTestSide, kTestSide}, [&](const Hit& hit) {
    ++fronts;
    patches.insert(scene.face(hit.face).patch);
  });
  constexpr double kOfPatches = 1e-3;
  const double share = static_cast<double>(fronts) / (kTestSide * kTestSide);
  return share * (1.0 + kOfPatches * static_cast<double>(patches.size()));
}

bool is_usable(const Camera& camera) {
  try {
    View(camera, Size{1, 1});
    return true;
  } catch (const InputError&) {
    return false;
  }
}

struct Best {
  Camera camera;
  double score = -1.0;

  void offer(const Scene& scene, const Camera& candidate, double weight) {
    if (!is_usable(candidate)) return;
    const double seen = weight * fronts_seen(scene, candidate);
    if (seen > score) *this = {candidate, seen};
  }
};

// The six axes count more than the directions between them, of which those from above come first.
void look_from_outside(const Scene& scene, const Extents& box, const Camera& like, const Size& size, Best& best) {
  constexpr double kBetween = 0.95, kFromBelow = 0.8, kAlongUp = 0.3;
  const Vec3 up = unit_unscaled(like.up);
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Vec3 direction{1.0 * x, 1.0 * y, 1.0 * z};
        if (direction == Vec3{}) continue;
        const double height = dot(unit_unscaled(direction), up);
        const double weight = height < -0.1                                 ? kFromBelow
                              : height > 0.9                                ? kAlongUp
                              : std::abs(x) + std::abs(y) + std::abs(z) > 1 ? kBetween
                                                                            : 1.0;
        best.offer(scene, camera_from(box, direction, like, size), weight);
      }
    }
  }
}

// --- Inside a closed room ---

// Near a corner of the box, below its top. The camera looks across the middle, at a point low on the other side.
struct Corner {
  int number = 0;       // bit 0: at the upper end of the first axis that is level, bit 1: of the second one
  double inset = 0.04;  // shares of the box
  double height = 0.72;
};

Camera camera_within(const Extents& box, const Corner& corner, const Camera& like) {
  constexpr double kBelow = 0.36;
  Camera camera = like;
  const double a = (corner.number & 1) != 0 ? 1.0 - corner.inset : corner.inset,
               b = (corner.number & 2) != 0 ? 1.0 - corner.inset : corner.inset;
  const Vec3 up = unit_unscaled(like.up);
  const auto place = [&](double first, double second, double height) {
    if (std::abs(up.z) > 0.7) return box.at(first, second, up.z > 0.0 ? height : 1.0 - height);
    if (std::abs(up.x) > 0.7) return box.at(up.x > 0.0 ? height : 1.0 - height, first, second);
    return box.at(first, up.y >= 0.0 ? height : 1.0 - height, second);
  };
  camera.eye = place(a, b, corner.height);
  camera.look = place(1.0 - a, 1.0 - b, kBelow);
  return camera;
}

// What a test picture shows of a room: 0 unless most of it shows fronts, as it does wherever the room is closed. Views
// with a lamp come first. Then many patches count, far away: furniture right before the camera hides the rest.
double room_seen(const Scene& scene, const Camera& camera, const Size& size) {
  int fronts = 0;
  double distances = 0.0;
  bool lamp = false;
  std::set<PatchId> patches;
  for_each_front(scene, camera, size, [&](const Hit& hit) {
    ++fronts;
    const Face& face = scene.face(hit.face);
    patches.insert(face.patch);
    lamp = lamp || scene.material(face.material).emits();
    distances += kernel::distance(hit.point, camera.eye);
  });
  if (2 * fronts < size.width * size.height) return 0.0;
  constexpr double kOfLamp = 1e3;
  return (lamp ? kOfLamp : 1.0) * static_cast<double>(patches.size()) * distances;
}

// A test picture of the same shape.
Size small_size(const Size& size) {
  const double aspect = static_cast<double>(size.width) / size.height;
  return {static_cast<int>(std::clamp(kTestSide * aspect, 1.0, 3.0 * kTestSide)), kTestSide};
}

void look_from_inside(const Scene& scene, const Extents& box, const Camera& like, const Size& size, Best& best) {
  double most = 0.0;
  for (const double height : {Corner{}.height, 0.88}) {
    for (const double inset : {Corner{}.inset, 0.12}) {
      for (int number = 0; number < 4; ++number) {
        const Camera candidate = camera_within(box, {number, inset, height}, like);
        if (!is_usable(candidate)) continue;
        const double seen = room_seen(scene, candidate, small_size(size));
        if (seen <= most) continue;
        most = seen;
        best = {candidate, seen};
      }
    }
  }
}

}  // namespace

Vec3 upwards(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  constexpr double kCosOfTwoDegrees = 0.9994;
  double along_y = 0.0, along_z = 0.0;
  for (const Face& face : scene.faces()) {
    if (face.piece_count == 0) continue;
    const Vec3 front = kernel::unit(face.newell);
    if (front.y > kCosOfTwoDegrees) along_y += face.area;
    if (front.z > kCosOfTwoDegrees) along_z += face.area;
  }
  return along_z > along_y ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
}

Camera default_camera(const Scene& scene, const CameraWishes& wishes, const Size& size) {
  const kernel::StandardArithmetic arithmetic;
  Camera like;  // the given numbers are refused with words, not left out of the search
  like.up = wishes.up == Vec3{} ? upwards(scene) : wishes.up;
  like.fov = wishes.fov.value_or(like.fov);
  like.ortho = wishes.ortho;
  const Vec3 across = cross(like.up, Vec3{1, 0, 0});
  like.look = kernel::max_norm(across) > 0.0 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  View(like, size);
  Best best;
  if (scene.pieces().empty()) return like;
  const Extents box = extents_of(scene);
  look_from_outside(scene, box, like, size, best);
  // From outside, a closed room shows no front, or few.
  constexpr double kFew = 0.25;
  if (best.score < kFew && !like.ortho) {
    like.fov = wishes.fov.value_or(kWideFov);
    look_from_inside(scene, box, like, size, best);
  }
  if (best.score < 0.0) {
    text::refuse("no camera was found that shows the scene",
                 "its coordinates are too large or too close together for a view of the whole",
                 "give a camera with --eye and --look");
  }
  best.camera.ortho = like.ortho;  // a height that is given counts, whatever it shows
  return best.camera;
}

// --- View ---

// The rays of a camera. The header documents every operation, since users rebuild these rays.

namespace {

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

// Of a camera whose numbers are finite.
void require_directions(const Camera& camera) {
  const Vec3 along = difference(camera.look, camera.eye);
  if (along == Vec3{}) {
    text::refuse("the camera's eye and the point that it looks at are the same", "the line of sight has no direction",
                 "move one of them");
  }
  if (!is_finite(along)) {
    text::refuse("the camera's eye and the point that it looks at are too far apart",
                 "their difference is not a double", "look at a point nearer to the eye, in the same direction");
  }
  constexpr double kParallel = 1e-9;
  if (camera.up == Vec3{} || !(kernel::max_norm(cross(unit(along), unit(camera.up))) > kParallel)) {
    text::refuse("the camera's up vector is zero or parallel to the line of sight",
                 "nothing then says which side of the picture is up",
                 "give another direction, for example along another axis");
  }
}

}  // namespace

View::View(const Camera& camera, const Size& size) : camera_(camera), size_(size) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Problem> problems = problems_of_numbers(camera, size);
  if (!problems.empty()) throw InputError(std::move(problems));
  require_directions(camera);
  forward_ = unit(difference(camera.look, camera.eye));
  right_ = unit(cross(forward_, unit(camera.up)));
  up_ = cross(right_, forward_);
  tangent_ = camera.ortho ? 0.5 * *camera.ortho : tangent_of_half(camera.fov);
}

Ray View::ray(double column, double row) const {
  const kernel::StandardArithmetic arithmetic;
  const double s = (2.0 * column - size_.width) / size_.height * tangent_;
  const double r = (size_.height - 2.0 * row) / size_.height * tangent_;
  if (camera_.ortho) return {moved(camera_.eye, s, right_, r, up_), forward_};
  return {camera_.eye, moved(forward_, s, right_, r, up_)};
}

}  // namespace exactff::render
