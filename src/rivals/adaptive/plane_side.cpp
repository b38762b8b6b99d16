#include "adaptive/plane_side.h"

namespace exactff::adaptive {

namespace {

double magnitude(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : std::max(std::abs(a * b), 0x1p-400); }

Vec3 absolute(const Vec3& a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }

}  // namespace

Normal plane_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 p = b - a;
  const Vec3 q = c - a;
  return {cross(p, q),
          {magnitude(p.y, q.z) + magnitude(p.z, q.y), magnitude(p.z, q.x) + magnitude(p.x, q.z),
           magnitude(p.x, q.y) + magnitude(p.y, q.x)}};
}

Normal exact_normal(const Vec3& n) { return {n, absolute(n)}; }

Bounded bounded_dot(const Normal& n, const Vec3& d) {
  const double m = magnitude(n.magnitude.x, d.x) + magnitude(n.magnitude.y, d.y) + magnitude(n.magnitude.z, d.z);
  return {dot(n.value, d), 0x1p-48 * m};
}

}  // namespace exactff::adaptive
