// Pixels of exact pictures, compared with an estimate that knows nothing of form factors: 10^5 stratified points of the
// lamps for each pixel, and for each a ray against every face, in doubles. The estimate brings its own error bars.
#include "support/test.h"

namespace exactff::validation {
namespace {

using render::Picture;

using Vector = std::array<double, 3>;

Vector vector_of(const Vec3& v) { return {v.x, v.y, v.z}; }
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Triangle {
  FaceId face{};
  Vector a, ab, ac;
};

// The convex pieces of a face as fans.
std::vector<Triangle> triangles_of(const Scene& scene, FaceId face) {
  std::vector<Triangle> triangles;
  for (const Piece& piece : scene.pieces_of(face)) {
    const auto corners = scene.corners(piece);
    const auto at = [&](std::size_t i) { return vector_of(scene.vertices()[corners[i]]); };
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      triangles.push_back({face, at(0), minus(at(i), at(0)), minus(at(i + 1), at(0))});
    }
  }
  return triangles;
}

// Whether the open segment from x to x + d meets the triangle away from its ends.
bool hides(const Triangle& triangle, const Vector& x, const Vector& d) {
  constexpr double kEnds = 1e-7;
  const Vector p = cross(d, triangle.ac);
  const double det = dot(triangle.ab, p);
  if (det == 0.0) return false;
  const Vector s = minus(x, triangle.a);
  const double u = dot(s, p) / det;
  if (u < 0.0 || u > 1.0) return false;
  const Vector q = cross(s, triangle.ab);
  const double v = dot(d, q) / det;
  if (v < 0.0 || u + v > 1.0) return false;
  const double t = dot(triangle.ac, q) / det;
  return t > kEnds && t < 1.0 - kEnds;
}

struct Mean {
  double value = 0.0;
  double error = 0.0;  // standard error, from neighbouring strata
};

class Lamps {
 public:
  explicit Lamps(const Scene& scene) : scene_(scene) {
    for (std::size_t f = 0; f < scene.faces().size(); ++f) {
      const auto id = static_cast<FaceId>(f);
      const bool emits = scene.material(scene.face(id).material).emits();
      for (const Triangle& triangle : triangles_of(scene, id)) {
        (emits ? lamps_ : faces_).push_back(triangle);
        if (emits) faces_.push_back(triangle);
      }
    }
  }

  // Of the irradiance in the channel `channel`: in each of a x a cells of a triangle's unit square two random points.
  [[nodiscard]] Mean irradiance(const Receiver& receiver, int channel, Random& random) const {
    const Vector x = vector_of(receiver.point), normal = vector_of(receiver.normal);
    const double length = std::sqrt(dot(normal, normal));
    std::vector<const Triangle*> others;
    for (const Triangle& triangle : faces_) {
      if (std::ranges::find(receiver.on, triangle.face) == receiver.on.end()) others.push_back(&triangle);
    }
    const int side = std::max(2, static_cast<int>(std::sqrt(5e4 / static_cast<double>(lamps_.size()))));
    double sum = 0.0, variance = 0.0;
    for (const Triangle& lamp : lamps_) {
      const Rgb& ke = scene_.material(scene_.face(lamp.face).material).radiosity;
      const double radiosity = channel == 0 ? ke.r : channel == 1 ? ke.g : ke.b;
      const double weight = radiosity / (std::numbers::pi * length * side * side);
      for (int i = 0; i < side * side; ++i) {
        const double one = weight * sample(lamp, i % side, i / side, side, x, normal, others, random);
        const double two = weight * sample(lamp, i % side, i / side, side, x, normal, others, random);
        sum += 0.5 * (one + two);
        variance += 0.25 * (one - two) * (one - two);
      }
    }
    return {sum, std::sqrt(variance)};
  }

 private:
  static double sample(const Triangle& lamp, int column, int row, int side, const Vector& x, const Vector& normal,
                       const std::vector<const Triangle*>& others, Random& random) {
    const double root = std::sqrt((column + random.between(0.0, 1.0)) / side);
    const double b = root * (row + random.between(0.0, 1.0)) / side, c = root - b;
    Vector d{};
    for (std::size_t k = 0; k < 3; ++k) d[k] = lamp.a[k] + b * lamp.ab[k] + c * lamp.ac[k] - x[k];
    const Vector front = cross(lamp.ab, lamp.ac);  // twice the area long
    const double at_x = dot(normal, d), at_lamp = -dot(front, d);
    if (at_x <= 0.0 || at_lamp <= 0.0) return 0.0;
    for (const Triangle* other : others) {
      if (hides(*other, x, d)) return 0.0;
    }
    const double squared = dot(d, d);
    return 0.5 * at_x * at_lamp / (squared * squared);
  }

  const Scene& scene_;
  std::vector<Triangle> lamps_, faces_;
};

// Compares a dozen pixels. Of so many, none may be off by five standard errors.
void compare(const Scene& scene, const render::Camera& camera) {
  const render::View view(camera, {24, 24});
  const Picture picture = render::render({.scene = &scene, .view = view, .quantity = Quantity::kIrradiance});
  const Lamps lamps(scene);
  Random random(seed_of(3));
  int compared = 0, lit = 0;
  while (compared < 12) {
    const std::size_t pixel = random.below(picture.pixels());
    if (picture.shows[pixel] != render::Shows::kFace) continue;
    const auto hit = render::first_hit(
        scene, view.ray(static_cast<double>(pixel % 24) + 0.5, static_cast<double>(pixel / 24) + 0.5));
    ASSERT_TRUE(hit);
    const int channel = compared % 3;
    const double exact = picture.values[3 * pixel + static_cast<std::size_t>(channel)];
    const Mean mean = lamps.irradiance(render::receiver_at(scene, *hit), channel, random);
    EXPECT_LE(std::abs(exact - mean.value), 5.0 * mean.error + 1e-9 * mean.value)
        << "pixel " << pixel << ": exact " << exact << ", rays " << mean.value << " +- " << mean.error;
    if (exact > 0.0) {
      ++lit;
      EXPECT_LT(mean.error, 0.05 * exact) << "the rays say too little";
    }
    ++compared;
  }
  EXPECT_GE(lit, 6);
}

TEST(Pictures, AgreeWithRaysInTheCornellBox) {
  compare(read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj"),
          {.eye = {278, 273, -800}, .look = {278, 273, 0}, .fov = 39.3});
}

TEST(Pictures, AgreeWithRaysBehindABlind) {
  compare(read_obj(EXACTFF_DATA_DIR "/scenes/blinds_room.obj"),
          {.eye = {3.8, 2.2, 4.8}, .look = {1.5, 0.8, 1}, .fov = 60});
}

TEST(Pictures, AgreeWithRaysInSunlight) {
  compare(models::make_scene("forest:n=150,trees=2,light=sun"),
          {.eye = {5, 5, 1.5}, .look = {20, 20, 0}, .up = {0, 0, 1}, .fov = 60});
}

}  // namespace
}  // namespace exactff::validation
