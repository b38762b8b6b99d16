#include "fuzz/scene_promises.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "support/oracle_sum.h"

namespace exactff::validation {

namespace {

using Indices = std::span<const std::uint32_t>;

Vector exact(const Vec3& v) { return {v.x, v.y, v.z}; }

Vector plus(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Corners corners_at(const Scene& scene, Indices indices) {
  Corners out;
  for (const std::uint32_t index : indices) out.push_back(exact(scene.vertices()[index]));
  return out;
}

// Twice the area, along the normal.
Vector newell(const Corners& corners) {
  Vector sum{0, 0, 0};
  for (std::size_t i = 2; i < corners.size(); ++i) {
    sum = plus(sum, cross(minus(corners[i - 1], corners[0]), minus(corners[i], corners[0])));
  }
  return sum;
}

// True if all corners are in one plane, and each lies to the left of each side or on its line.
bool convex_and_planar(const Corners& corners, const Vector& normal) {
  constexpr std::size_t kAllPairs = 60;  // above this number, only neighbours are compared: the time would be quadratic
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (sgn(dot(normal, minus(corners[i], corners[0]))) != 0) return false;
    const Vector side = minus(corners[(i + 1) % n], corners[i]);
    for (std::size_t k = 2; k < (n <= kAllPairs ? n : 3); ++k) {
      if (sgn(dot(normal, cross(side, minus(corners[(i + k) % n], corners[i])))) < 0) return false;
    }
  }
  return true;
}

bool in_range(Indices indices, std::size_t count) {
  return std::ranges::all_of(indices, [=](std::uint32_t index) { return index < count; });
}

std::string broken_by(const Scene& scene, const Piece& piece) {
  if (index_of(piece.face) >= scene.faces().size()) return "a piece of no face";
  const Indices indices = scene.corners(piece);
  if (indices.size() < 3 || !in_range(indices, scene.vertices().size())) return "a piece without three corners";
  if (!in_range(piece.frame, scene.vertices().size())) return "a frame out of range";
  const Corners corners = corners_at(scene, indices);
  const Vector normal = newell(corners);
  if (is_zero(normal)) return "a piece without area";
  if (!convex_and_planar(corners, normal)) return "a piece that is not convex or not planar";
  if (sgn(dot(normal, newell(corners_at(scene, piece.frame)))) <= 0) return "a frame that is no triangle of its piece";
  return {};
}

// True if the pieces' vector area must equal the ring's: one ring, no vertex twice, and no side of a non-planar face
// seen end-on along its Newell vector (such triangles would leave a gap, so there are fewer of them).
bool area_is_kept(const Face& face) {
  const auto& ring = face.rings.front();
  if (face.rings.size() != 1 || std::set<std::uint32_t>(ring.begin(), ring.end()).size() != ring.size()) return false;
  return face.shape == FaceShape::kPlanar || face.piece_count == ring.size() - 2;
}

std::string broken_by_pieces(const Scene& scene, FaceId id) {
  const Face& face = scene.face(id);
  const Vector whole = newell(corners_at(scene, face.rings.front()));
  if (sgn(dot(whole, exact(face.newell))) <= 0) return "a face whose normal points backwards";
  Vector sum{0, 0, 0};
  for (const Piece& piece : scene.pieces_of(id)) {
    if (piece.face != id) return "a face with a piece of another";
    const Vector normal = newell(corners_at(scene, scene.corners(piece)));
    if (sgn(dot(normal, whole)) <= 0) return "a piece that faces backwards";
    sum = plus(sum, normal);
  }
  return area_is_kept(face) && sum != whole ? "pieces that are not their face" : "";
}

bool is_usable(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && v != Vec3{}; }

std::string broken_by(const Scene& scene, FaceId id) {
  const Face& face = scene.face(id);
  if (index_of(face.patch) >= scene.patches().size()) return "a face of no patch";
  if (index_of(face.material) >= scene.materials().size()) return "a face of no material";
  const auto& siblings = scene.patch(face.patch).faces;
  if (face.number < 1 || face.number > siblings.size() || siblings[face.number - 1] != id) return "a wrong number";
  for (const auto& ring : face.rings) {
    if (!in_range(ring, scene.vertices().size())) return "a ring out of range";
  }
  const bool has_area = face.shape == FaceShape::kPlanar || face.shape == FaceShape::kTriangulated;
  if (has_area == scene.pieces_of(id).empty()) return "a face with area and no pieces, or the other way round";
  if (!has_area) return {};
  if (!is_usable(face.newell)) return "a face without a normal";
  if (!(face.area > 0.0 && std::isfinite(face.area))) return "a face without an area";
  return broken_by_pieces(scene, id);
}

std::string broken_by_names(const Scene& scene) {
  for (std::size_t i = 0; i < scene.patches().size(); ++i) {
    const Selection whole{PatchId(static_cast<std::uint32_t>(i)), {}, scene.id()};
    if (scene.select(scene.name_of(whole)) != whole) return "a name that selects another patch";
  }
  return {};
}

}  // namespace

std::string broken_promise(const Scene& scene) {
  for (const Piece& piece : scene.pieces()) {
    if (std::string wrong = broken_by(scene, piece); !wrong.empty()) return wrong;
  }
  for (std::size_t i = 0; i < scene.faces().size(); ++i) {
    if (std::string wrong = broken_by(scene, FaceId(static_cast<std::uint32_t>(i))); !wrong.empty()) return wrong;
  }
  return broken_by_names(scene);
}

}  // namespace exactff::validation
