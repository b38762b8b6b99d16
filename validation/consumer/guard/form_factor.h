// What is to be guarded: somebody's form factor from a point on the floor of room.obj to its lamp, by shadow rays. It
// knows nothing of exactff.
#pragma once

#include <cmath>

struct Point {
  double x, y, z;
};

// Of a segment up from x, y, 0 to the lamp, where it crosses the height of the plate.
inline bool is_hidden(double x, double y, double lamp_x, double lamp_y) {
  const double at_x = 0.5 * (x + lamp_x), at_y = 0.5 * (y + lamp_y);
  return at_x > 1.53 && at_x < 2.97 && at_y > 1.07 && at_y < 2.91;
}

inline double sampled_form_factor(const Point& p) {
  constexpr int kRays = 64;  // by side of the lamp
  constexpr double kPi = 3.14159265358979323846, kHeight = 3.0;
  double sum = 0.0;
  for (int i = 0; i < kRays; ++i) {
    for (int j = 0; j < kRays; ++j) {
      const double x = 1.0 + (i + 0.5) / kRays, y = 1.0 + (j + 0.5) / kRays;
      if (is_hidden(p.x, p.y, x, y)) continue;
      const double squared = (x - p.x) * (x - p.x) + (y - p.y) * (y - p.y) + kHeight * kHeight;
      sum += kHeight * kHeight / (kPi * squared * squared);
    }
  }
  return sum / (kRays * kRays);
}
