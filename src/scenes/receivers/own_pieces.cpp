#include "receivers/own_pieces.h"

#include <cmath>
#include <limits>
#include <utility>

#include "exactff/error.h"
#include "kernel/filter.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "scene/contacts.h"
#include "scene/face_points.h"
#include "scene/scene.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {
namespace {

using kernel::Approx3;
using kernel::Rational;
using kernel::ScaledVec3;

// A computed sum, and that of the magnitudes of its terms.
struct Sum {
  double value, magnitude;
};

Sum product(const Approx3& a, const Approx3& b) {
  const double x = a.x * b.x, y = a.y * b.y, z = a.z * b.z;
  return {x + y + z, std::abs(x) + std::abs(y) + std::abs(z)};
}

// The projection of x onto the plane of a triangle p, q, r lies on r's side of the edge from p to q, or on its line, if
// s = (w.f)(e.e) - (w.e)(e.f) is not negative, for e = q - p, f = r - p and w = x - p.
//
// Filter: a component of e, f and w carries u = 2^-53, each of the four sums of products 5u of the sum of its
// magnitudes, their products 11u, and s 12u of the magnitude m. m is computed to within 12u, so |s| > 2^-48 m = 32u m
// decides. Underflow is excluded as in kernel/filter.h.
int side_of_edge(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& x) {
  const Approx3 e = kernel::approx_difference(q, p), f = kernel::approx_difference(r, p),
                w = kernel::approx_difference(x, p);
  const Sum wf = product(w, f), ee = product(e, e), we = product(w, e), ef = product(e, f);
  const double s = wf.value * ee.value - we.value * ef.value;
  const double m = wf.magnitude * ee.magnitude + we.magnitude * ef.magnitude;
  const bool moderate = kernel::max_norm(e) <= 0x1p200 && kernel::max_norm(f) <= 0x1p200 &&
                        kernel::max_norm(w) <= 0x1p200 && m >= 0x1p-400;
  if (moderate && std::abs(s) > 0x1p-48 * m) return s > 0.0 ? 1 : -1;
  const kernel::ExactVec3 e_exact = kernel::exact_difference(q, p).v, f_exact = kernel::exact_difference(r, p).v,
                          w_exact = kernel::exact_difference(x, p).v;
  return kernel::sign(
      kernel::Integer(dot(w_exact, f_exact) * dot(e_exact, e_exact) - dot(w_exact, e_exact) * dot(e_exact, f_exact)));
}

class OwnTriangle {
 public:
  OwnTriangle(const Scene& scene, std::uint32_t piece)
      : p_(scene.vertices()[scene.pieces()[piece].frame[0]]),
        q_(scene.vertices()[scene.pieces()[piece].frame[1]]),
        r_(scene.vertices()[scene.pieces()[piece].frame[2]]) {}

  // The perpendicular projection of x; on an edge, too.
  [[nodiscard]] bool holds_projection(const Vec3& x) const {
    return side_of_edge(p_, q_, r_, x) >= 0 && side_of_edge(q_, r_, p_, x) >= 0 && side_of_edge(r_, p_, q_, x) >= 0;
  }

  [[nodiscard]] Rational squared_distance_from_plane(const Vec3& x) const {
    const ScaledVec3 away = kernel::exact_difference(x, p_);
    const kernel::ExactVec3 n = cross(kernel::exact_difference(q_, p_).v, kernel::exact_difference(r_, p_).v);
    const kernel::Integer height = dot(n, away.v);
    Rational square(height * height, dot(n, n));
    square.canonicalize();
    return kernel::times_power_of_two(std::move(square), 2 * away.exponent);
  }

 private:
  const Vec3 &p_, &q_, &r_;
};

using Pieces = boost::container::small_vector<std::uint32_t, 8>;

std::uint32_t nearest_of(const Scene& scene, const Pieces& pieces, const Vec3& x) {
  if (pieces.size() == 1) return pieces.front();
  return *std::ranges::min_element(
      pieces, {}, [&](std::uint32_t piece) { return OwnTriangle(scene, piece).squared_distance_from_plane(x); });
}

}  // namespace

std::uint32_t own_piece(const Scene& scene, FaceId id, const Vec3& x) {
  const Face& face = scene.face(id);
  if (face.shape == FaceShape::kPlanar) return face.first_piece;
  Pieces all, holding;
  for (std::uint32_t piece = face.first_piece; piece < face.first_piece + face.piece_count; ++piece) {
    all.push_back(piece);
    if (OwnTriangle(scene, piece).holds_projection(x)) holding.push_back(piece);
  }
  return nearest_of(scene, holding.empty() ? all : holding, x);
}

Vec3 front_of_piece(const Scene& scene, std::uint32_t id) {
  const Piece& piece = scene.pieces()[id];
  if (scene.face(piece.face).shape == FaceShape::kPlanar) return scene.face(piece.face).newell;
  const auto corners = scene.corners(piece);
  const FacePoints points = face_points(scene.vertices(), {{corners.begin(), corners.end()}});
  return nearest_vector(newell(points, 0, points.size()), 2 * points.exponent - 1);
}

namespace {

// Steps of roundings towards a side of a face that is not planar.
class StepsAside {
 public:
  StepsAside(const Scene& scene, FaceId face, const Vec3& from, Looks looks)
      : pieces_(scene.pieces_of(face)),
        vertices_(scene.vertices()),
        from_(from),
        side_(looks == Looks::kToFront ? 1 : -1) {
    const Vec3 front = scene.face(face).newell;
    const double largest = kernel::max_norm(from);
    const double rounding = std::nextafter(largest, std::numeric_limits<double>::max()) - largest;
    step_ = kernel::scaled(front, side_ * (largest > 0.0 ? rounding : 0.0) / kernel::max_norm(front));
  }

  // The first place that is not behind the triangles that the steps can pass.
  [[nodiscard]] Vec3 place() const {
    constexpr double kMost = 16.0;
    if (!kernel::is_finite(at(kMost))) return from_;
    const auto passes = [&](const Piece& piece) { return is_behind(piece, from_) && !is_behind(piece, at(kMost)); };
    for (double steps = 1.0; std::ranges::any_of(pieces_, passes) && steps <= kMost; steps *= 2.0) {
      const Vec3 there = at(steps);
      if (std::ranges::none_of(pieces_, [&](const Piece& p) { return passes(p) && is_behind(p, there); })) return there;
    }
    return from_;
  }

 private:
  [[nodiscard]] Vec3 at(double steps) const { return kernel::along(from_, step_, steps); }
  [[nodiscard]] bool is_behind(const Piece& piece, const Vec3& x) const {
    const auto vertex = [&](int i) -> const Vec3& { return vertices_[piece.frame[i]]; };
    return side_ * kernel::orientation(vertex(0), vertex(1), vertex(2), x) < 0;
  }

  std::span<const Piece> pieces_;
  std::span<const Vec3> vertices_;
  Vec3 from_;
  int side_;
  Vec3 step_;
};

}  // namespace

bool is_one_planar_face(const Scene& scene, const Region& region) {
  return region.faces.size() == 1 && scene.face(region.faces.front()).shape == FaceShape::kPlanar;
}

Receiver receiver_on(const Scene& scene, FaceId face, std::vector<FaceId> on, const Vec3& rounded, Looks looks) {
  Receiver receiver{.point = rounded, .normal = {}, .on = std::move(on), .id = {}};
  for (const FaceId own : receiver.on) {
    if (scene.face(own).shape == FaceShape::kPlanar) continue;
    receiver.point = StepsAside(scene, own, receiver.point, looks).place();
  }
  const Vec3 front = front_of_piece(scene, own_piece(scene, face, receiver.point));
  receiver.normal = looks == Looks::kToFront ? front : Vec3{-front.x, -front.y, -front.z};
  return receiver;
}

OwnPieces::OwnPieces(const Scene& scene, const Receiver& receiver) {
  if (receiver.on.empty()) return;
  all_ = &exactff::planes(scene);
  for (const FaceId face : receiver.on) {
    if (scene.face(face).piece_count == 0) continue;
    const PlaneId plane = all_->of_piece(own_piece(scene, face, receiver.point));
    if (std::ranges::find(planes_, plane) == planes_.end()) planes_.push_back(plane);
  }
}

// --- Own faces ---

// The names of a receiver's own faces.

namespace {

FaceId one_face(const Scene& scene, const std::string& name) {
  const Selection selection = scene.select(name);
  if (selection.face) return *selection.face;
  const std::size_t faces = scene.patch(selection.patch).faces.size();
  if (faces == 1) return scene.patch(selection.patch).faces.front();
  text::refuse(text::in_quotes(name, text::kShownName) + " has " + std::to_string(faces) + " faces",
               "a patch may be bent, so the name does not say where the receiver lies",
               "write " + text::in_quotes(name + ":k", text::kShownName) + " for its k-th face");
}

}  // namespace

std::optional<FaceId> buried_under(const Scene& scene, const Receiver& receiver) {
  const kernel::StandardArithmetic arithmetic;
  if (receiver.on.empty() || contacts(scene).empty()) return std::nullopt;
  std::optional<FaceId> under;
  for (const FaceId id : receiver.on) {
    const Face& face = scene.face(id);
    if (face.piece_count == 0) continue;
    boost::container::small_vector<std::uint32_t, 16> pieces;  // in the plane that the receiver lies in
    for (std::uint32_t p = face.first_piece; p < face.first_piece + face.piece_count; ++p) pieces.push_back(p);
    if (face.shape != FaceShape::kPlanar) pieces = {own_piece(scene, id, receiver.point)};
    const Burial burial = burial_of(scene, {pieces.data(), pieces.size()}, receiver.point, receiver.normal);
    if (burial.is_exposed) return std::nullopt;
    if (!under) under = burial.under;
  }
  return under;
}

bool some_is_buried(const Scene& scene) { return !contacts(scene).empty(); }

std::vector<FaceId> own_faces_named(const Scene& scene, std::string_view name) {
  const std::size_t plus = name.find('+', std::min(name.rfind(':'), name.size()));
  const auto first = text::numbered_name(name.substr(0, plus));
  if (plus == std::string_view::npos || !first || SceneInside::data(scene).patch_by_name.contains(std::string(name))) {
    return {one_face(scene, std::string(name))};
  }
  std::vector<FaceId> faces = {one_face(scene, first->patch + ':' + std::to_string(first->number))};
  for (std::size_t at = plus; at < name.size();) {
    const std::size_t next = std::min(name.find('+', at + 1), name.size());
    const FaceId face = one_face(scene, first->patch + ':' + std::string(name.substr(at + 1, next - at - 1)));
    if (std::ranges::find(faces, face) == faces.end()) faces.push_back(face);
    at = next;
  }
  return faces;
}

}  // namespace exactff
