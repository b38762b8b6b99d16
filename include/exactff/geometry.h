// Plain value types that all public headers share. Coordinates are IEEE doubles; on the exact path each means exactly
// the value of its double.
#pragma once

#include <algorithm>

namespace exactff {

struct Vec3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  friend bool operator==(const Vec3&, const Vec3&) = default;
};

// A point of a texture: u to the right, v upwards.
struct TexturePoint {
  double u = 0.0;
  double v = 0.0;

  friend bool operator==(const TexturePoint&, const TexturePoint&) = default;
};

// One value per colour channel: a reflectance (a pure number) or a radiosity (not a radiance: no factor pi).
struct Rgb {
  double r = 0.0;
  double g = 0.0;
  double b = 0.0;

  [[nodiscard]] double largest() const { return std::max({r, g, b}); }
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

}  // namespace exactff
