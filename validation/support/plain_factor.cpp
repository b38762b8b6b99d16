#include "support/plain_factor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/numbers.h"
#include "kernel/vec.h"

namespace exactff::validation {
namespace {

using kernel::cross;
using kernel::difference;
using kernel::dot;
using Polygon = std::vector<Vec3>;

Polygon polygon_of(const Scene& scene, const Piece& piece) {
  Polygon corners;
  for (const std::uint32_t corner : scene.corners(piece)) corners.push_back(scene.vertices()[corner]);
  return corners;
}

// The part where the height is positive, and the part where it is negative.
struct Parts {
  Polygon above, below;
};

template <class Height>
Parts cut(const Polygon& polygon, const Height& height) {
  Parts parts;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double here = height(p), next = height(q);
    if (here >= 0.0) parts.above.push_back(p);
    if (here <= 0.0) parts.below.push_back(p);
    if (here * next >= 0.0) continue;
    const double t = here / (here - next);
    const Vec3 crossing{p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
    parts.above.push_back(crossing);
    parts.below.push_back(crossing);
  }
  return parts;
}

// The height of a corner above a piece's plane, with the exact sign.
auto height_above(const Scene& scene, const Piece& piece) {
  const auto vertex = [&scene, &piece](int i) { return scene.vertices()[piece.frame[i]]; };
  const Vec3 a = vertex(0), b = vertex(1), c = vertex(2), normal = cross(difference(b, a), difference(c, a));
  return [=](const Vec3& p) {
    const int side = kernel::orientation(a, b, c, p);
    return side == 0 ? 0.0 : static_cast<double>(side) * std::abs(dot(normal, difference(p, a)));
  };
}

// Empty if no corner lies in front.
template <class Height>
Polygon in_front(const Polygon& polygon, const Height& height) {
  const bool some = std::ranges::any_of(polygon, [&](const Vec3& p) { return height(p) > 0.0; });
  return some ? cut(polygon, height).above : Polygon();
}

// Adds to `left` what of the fragment is not seen within the occluder's outline.
void subtract(Polygon fragment, const Polygon& occluder, const Vec3& x, std::vector<Polygon>& left) {
  Vec3 middle;
  for (const Vec3& p : occluder) middle = {middle.x + p.x, middle.y + p.y, middle.z + p.z};
  middle = kernel::scaled(middle, 1.0 / static_cast<double>(occluder.size()));
  std::vector<Polygon> outside;
  for (std::size_t i = 0; i < occluder.size(); ++i) {
    const Vec3 a = difference(occluder[i], x), b = difference(occluder[(i + 1) % occluder.size()], x);
    Vec3 inward = cross(a, b);
    if (dot(inward, difference(middle, x)) < 0.0) inward = kernel::scaled(inward, -1.0);
    Parts parts = cut(fragment, [&](const Vec3& p) { return dot(inward, difference(p, x)); });
    if (parts.below.size() >= 3) outside.push_back(std::move(parts.below));
    fragment = std::move(parts.above);
    if (fragment.size() < 3) break;
  }
  left.insert(left.end(), outside.begin(), outside.end());
}

double contour(const Polygon& polygon, const Vec3& x, const Vec3& normal) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 a = difference(polygon[i], x), b = difference(polygon[(i + 1) % polygon.size()], x), c = cross(a, b);
    const double area = std::sqrt(dot(c, c)), lengths = std::sqrt(dot(a, a) * dot(b, b));
    if (area > 0.0) sum += std::acos(std::clamp(dot(a, b) / lengths, -1.0, 1.0)) / area * dot(c, normal);
  }
  return std::abs(sum) / (2.0 * std::numbers::pi);
}

}  // namespace

PlainFactor::PlainFactor(const Scene& scene, FaceId from, const Selection& to, Occluders occluders) {
  const Piece& receiver = scene.pieces_of(from).front();
  const auto above = height_above(scene, receiver);
  const Vec3& newell = scene.face(from).newell;
  normal_ = kernel::scaled(newell, 1.0 / std::sqrt(dot(newell, newell)));
  for (const FaceId face : scene.faces_of(to)) {
    for (const Piece& piece : scene.pieces_of(face)) {
      const auto before = height_above(scene, piece);
      Source source{in_front(polygon_of(scene, piece), above), {}};
      if (source.corners.empty() || face == from) continue;
      for (const Piece& other : scene.pieces()) {
        if (other.transparent || other.face == from || occluders == Occluders::kNone) continue;
        // By the piece's own corners first: those made by a cut are rounded.
        const Polygon corners = polygon_of(scene, other);
        if (in_front(corners, before).empty()) continue;
        Polygon between = in_front(in_front(corners, above), before);
        if (!between.empty()) source.occluders.push_back(std::move(between));
      }
      sources_.push_back(std::move(source));
    }
  }
}

double PlainFactor::at(const Vec3& x) const {
  double sum = 0.0;
  for (const Source& source : sources_) {
    const Vec3 &a = source.corners[0], &b = source.corners[1], &c = source.corners[2];
    if (dot(cross(difference(b, a), difference(c, a)), difference(x, a)) <= 0.0) continue;
    std::vector<Polygon> left{source.corners};
    for (const Polygon& occluder : source.occluders) {
      std::vector<Polygon> next;
      for (Polygon& fragment : left) subtract(std::move(fragment), occluder, x, next);
      left = std::move(next);
    }
    for (const Polygon& fragment : left) sum += contour(fragment, x, normal_);
  }
  return sum;
}

}  // namespace exactff::validation
