// Method: all signs from exact rationals. The rule for a face out of plane, seen along its Newell vector:
// 1. a quadrilateral takes the diagonal through the corner of lowest index if both triangles run counter-clockwise,
//    else the other one;
// 2. a larger face loses ear by ear, each time the one of lowest index that holds no other corner, its rim included.
// The rule does not cover a ring that touches itself as seen along that vector, where any cut of the face would be
// valid; such a face is used as the scene cut it.
#include "support/oracle_faces.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace exactff::validation {

Vector exact(const Vec3& v) { return {Rational(v.x), Rational(v.y), Rational(v.z)}; }

namespace {

Vector newell(const Corners& ring) {
  Vector sum;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vector term = cross(ring[i], ring[(i + 1) % ring.size()]);
    for (int k = 0; k < 3; ++k) sum[k] += term[k];
  }
  return sum;
}

Polygon polygon(FaceId face, std::vector<Corners> rings) {
  const Vector normal = newell(rings.front());
  const Rational offset = dot(normal, rings.front().front());
  return {face, std::move(rings), normal, offset, false};
}

bool on_one_line(const Corners& ring) {
  const auto other = std::ranges::find_if(ring, [&](const Vector& c) { return c != ring.front(); });
  if (other == ring.end()) return true;
  const Vector along = minus(*other, ring.front());
  return std::ranges::all_of(ring, [&](const Vector& c) { return is_zero(cross(along, minus(c, ring.front()))); });
}

bool in_plane(const Corners& corners, const Polygon& plane) {
  return std::ranges::all_of(corners, [&](const Vector& c) { return dot(plane.normal, c) == plane.offset; });
}

// A ring, projected along its Newell vector, and the part that is left of it.
class Ears {
 public:
  Ears(const Corners& corners, std::span<const std::uint32_t> index) : corners_(corners), along_(newell(corners)) {
    for (std::size_t i = 0; i < index.size(); ++i) left_.push_back({i, index[i]});
  }

  bool touches_itself() const {
    const std::size_t n = corners_.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const std::size_t k = (j + 1) % n;
        if (i != j && i != k && on_edge(corners_[i], corners_[j], corners_[k])) return true;
      }
    }
    return false;
  }

  std::vector<Corners> triangles() {
    if (left_.size() == 4) return halves();
    std::vector<Corners> out;
    while (left_.size() > 3) {
      const std::size_t ear = lowest_ear();
      out.push_back(triangle(before(ear), ear, after(ear)));
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    out.push_back(triangle(0, 1, 2));
    return out;
  }

 private:
  struct Corner {
    std::size_t position;
    std::uint32_t index;
  };

  const Vector& at(std::size_t i) const { return corners_[left_[i % left_.size()].position]; }
  std::size_t before(std::size_t i) const { return (i + left_.size() - 1) % left_.size(); }
  std::size_t after(std::size_t i) const { return (i + 1) % left_.size(); }
  Corners triangle(std::size_t a, std::size_t b, std::size_t c) const { return {at(a), at(b), at(c)}; }

  int turn(const Vector& a, const Vector& b, const Vector& c) const {
    return sgn(dot(along_, cross(minus(b, a), minus(c, a))));
  }
  int turn(std::size_t a, std::size_t b, std::size_t c) const { return turn(at(a), at(b), at(c)); }

  bool on_edge(const Vector& p, const Vector& a, const Vector& b) const {
    if (turn(a, b, p) != 0) return false;
    const Vector to_a = minus(a, p);
    const Vector to_b = minus(b, p);
    return dot(to_a, to_b) * dot(along_, along_) <= dot(along_, to_a) * dot(along_, to_b);
  }

  std::vector<Corners> halves() const {
    const auto low = static_cast<std::size_t>(std::ranges::min_element(left_, {}, &Corner::index) - left_.begin());
    for (const std::size_t a : {low, low + 1}) {
      if (turn(a, a + 1, a + 2) > 0 && turn(a, a + 2, a + 3) > 0) {
        return {triangle(a, a + 1, a + 2), triangle(a, a + 2, a + 3)};
      }
    }
    throw std::invalid_argument("no diagonal");
  }

  bool is_ear(std::size_t tip) const {
    const std::size_t a = before(tip);
    const std::size_t c = after(tip);
    if (turn(a, tip, c) <= 0) return false;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if (i == a || i == tip || i == c) continue;
      if (turn(a, tip, i) >= 0 && turn(tip, c, i) >= 0 && turn(c, a, i) >= 0) return false;
    }
    return true;
  }

  std::size_t lowest_ear() const {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < left_.size(); ++i) {
      if ((!best || left_[i].index < left_[*best].index) && is_ear(i)) best = i;
    }
    if (!best) throw std::invalid_argument("no ear");
    return *best;
  }

  const Corners& corners_;
  Vector along_;
  std::vector<Corner> left_;
};

// Where the vertex is, relative to the origin.
Vector corner_at(const Scene& scene, std::uint32_t vertex, const Vector& origin, const MovedPlace* moved) {
  const Vec3& v = scene.vertices()[vertex];
  const Vector corner = minus(exact(v), origin);
  return moved != nullptr && v == moved->place ? minus(corner, negative(moved->by)) : corner;
}

std::vector<Corners> as_the_scene_cut_it(const Scene& scene, FaceId face, const Vector& origin,
                                         const MovedPlace* moved) {
  std::vector<Corners> out;
  for (const Piece& piece : scene.pieces_of(face)) {
    Corners& corners = out.emplace_back();
    for (const std::uint32_t v : scene.corners(piece)) corners.push_back(corner_at(scene, v, origin, moved));
  }
  return out;
}

std::vector<Polygon> polygons_of(const Scene& scene, FaceId id, const Vector& origin, const MovedPlace* moved) {
  const Face& face = scene.face(id);
  if (face.shape == FaceShape::kSkipped) return {};
  if (face.shape == FaceShape::kZeroArea && face.rings.size() > 1) return {};  // the holes cover everything
  std::vector<Corners> rings;
  for (const auto& ring : face.rings) {
    Corners& corners = rings.emplace_back();
    for (const std::uint32_t v : ring) corners.push_back(corner_at(scene, v, origin, moved));
  }
  if (on_one_line(rings.front())) return {};
  const Polygon whole = polygon(id, rings);
  if (is_zero(whole.normal)) return {};  // goes forth and back the same way
  if (std::ranges::all_of(rings, [&](const Corners& ring) { return in_plane(ring, whole); })) return {whole};
  Ears ears(rings.front(), face.rings.front());
  std::vector<Polygon> out;
  for (Corners& part : ears.touches_itself() ? as_the_scene_cut_it(scene, id, origin, moved) : ears.triangles()) {
    out.push_back(polygon(id, {std::move(part)}));
  }
  return out;
}

}  // namespace

std::vector<Polygon> polygons_of(const Scene& scene, FaceId id, const Vector& origin) {
  return polygons_of(scene, id, origin, nullptr);
}
std::vector<Polygon> polygons_of(const Scene& scene, FaceId id, const Vector& origin, const MovedPlace& moved) {
  return polygons_of(scene, id, origin, &moved);
}

Polygon shifted(const Polygon& original, const Vector& by) {
  Polygon out = original;
  for (Corners& ring : out.rings) {
    for (Vector& corner : ring) corner = minus(corner, negative(by));
  }
  out.offset = dot(out.normal, out.rings.front().front());
  return out;
}

}  // namespace exactff::validation
