// Faces that a point given by coordinates lies on or near. All distances are estimates, in coordinates multiplied by a
// power of two that brings the largest of the scene near 1; the side of a face is exact.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <tuple>

#include "exactff/receiver.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "scene/selections.h"
#include "scene/shaft_tree.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff {
namespace {

using kernel::cross;
using kernel::difference;
using kernel::dot;
using kernel::unit_by_inverse;

constexpr double kCosOfOneDegree = 0.99984769515639124;

// A piece as it lies about the point, in scaled coordinates.
struct Nearby {
  std::uint32_t piece = 0;
  FaceId face{};
  Vec3 normal;            // unit
  double height = 0.0;    // of the point above the plane of the piece
  double beside = 0.0;    // distance of its foot from the piece
  double distance = 0.0;  // of the point from the piece
};

// Of a planar face the Newell vector, which is correctly rounded however thin the piece is.
Vec3 normal_of(const Scene& scene, double scale, const Piece& piece) {
  const Face& face = scene.face(piece.face);
  if (face.shape == FaceShape::kPlanar) return unit_by_inverse(face.newell);
  const auto frame = [&](std::size_t i) { return kernel::scaled(scene.vertices()[piece.frame[i]], scale); };
  return unit_by_inverse(cross(unit_by_inverse(difference(frame(1), frame(0))),  //
                               unit_by_inverse(difference(frame(2), frame(1)))));
}

class Search {
 public:
  Search(const Scene& scene, const Vec3& point, double tolerance)
      : scene_(scene),
        scale_(extent(scene).scale),
        point_(kernel::scaled(point, scale_)),
        tolerance_(tolerance * scale_) {
    const HalfSpace box[] = {{{1, 0, 0}, -tolerance},  {{-1, 0, 0}, -tolerance}, {{0, 1, 0}, -tolerance},
                             {{0, -1, 0}, -tolerance}, {{0, 0, 1}, -tolerance},  {{0, 0, -1}, -tolerance}};
    shaft_tree(scene).query(point, box, [&](std::uint32_t piece) {
      if (const auto found = look_at(piece)) found_.push_back(*found);
      return true;
    });
  }

  // Pieces whose plane and whose outline come within the tolerance of the point.
  [[nodiscard]] const std::vector<Nearby>& found() const { return found_; }
  [[nodiscard]] double in_the_scenes_unit(double length) const { return length / scale_; }

 private:
  [[nodiscard]] std::optional<Nearby> look_at(std::uint32_t index) const {
    const Piece& piece = scene_.pieces()[index];
    const auto corners = scene_.corners(piece);
    const auto corner = [&](std::size_t i) { return kernel::scaled(scene_.vertices()[corners[i]], scale_); };
    const auto frame = [&](std::size_t i) { return kernel::scaled(scene_.vertices()[piece.frame[i]], scale_); };
    const Vec3 normal = normal_of(scene_, scale_, piece);
    const double height = dot(normal, difference(point_, frame(0)));
    if (!(std::abs(height) <= tolerance_)) return std::nullopt;
    double beside = 0.0;
    bool inside = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3 p = corner(i), q = corner(i + 1 < corners.size() ? i + 1 : 0);
      const Vec3 side = difference(q, p), to_point = difference(point_, p);
      inside = inside && dot(normal, cross(side, to_point)) >= 0.0;
      nearest = std::min(nearest, distance_from_side(side, to_point));
    }
    if (!inside) beside = std::sqrt(std::max(nearest * nearest - height * height, 0.0));
    if (!(beside <= tolerance_)) return std::nullopt;
    return Nearby{index, piece.face, normal, height, beside, std::hypot(height, beside)};
  }

  static double distance_from_side(const Vec3& side, const Vec3& to_point) {
    const double along = dot(side, to_point), square = dot(side, side);
    const double share = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
    const Vec3 off = difference(to_point, kernel::scaled(side, share));
    return std::hypot(off.x, off.y, off.z);
  }

  const Scene& scene_;
  double scale_;
  Vec3 point_;
  double tolerance_;
  std::vector<Nearby> found_;
};

// Exact: +1 if the point is in front of the piece, 0 if it lies in its plane.
int side_of(const Scene& scene, std::uint32_t piece, const Vec3& point) {
  const auto vertices = scene.vertices();
  const auto& frame = scene.pieces()[piece].frame;
  return kernel::orientation(vertices[frame[0]], vertices[frame[1]], vertices[frame[2]], point);
}

// One unit of the last decimal with which a program would print the number; 0 for a number without decimals.
double last_decimal(double value) {
  const std::string text = text::shortest(value);
  const std::size_t exponent_at = std::min(text.find('e'), text.size()), dot_at = text.find('.');
  int places = dot_at < exponent_at ? static_cast<int>(exponent_at - dot_at) - 1 : 0;
  if (exponent_at < text.size()) places -= std::stoi(text.substr(exponent_at + 1));
  return places > 0 ? text::parse_number("1e-" + std::to_string(places)).value : 0.0;
}

double finest_decimal(const Vec3& point) {
  double finest = 0.0;
  for (const double c : {point.x, point.y, point.z}) {
    const double unit = last_decimal(c);
    if (unit > 0.0) finest = finest == 0.0 ? unit : std::min(finest, unit);
  }
  return finest;
}

}  // namespace

double tolerance_of_computed_points(const Scene& scene) {
  constexpr double kOfDiameter = 1e-6, kTwoFloatUlps = 0x1p-22;
  const Extent& size = extent(scene);
  return std::max(kOfDiameter * size.diameter, kTwoFloatUlps * size.largest);
}

double face_tolerance(const Scene& scene, const Vec3& point) {
  const kernel::StandardArithmetic arithmetic;
  constexpr double kMostOfDiameter = 1e-3;
  return std::max(tolerance_of_computed_points(scene),
                  std::min(finest_decimal(point), kMostOfDiameter * extent(scene).diameter));
}

namespace {

// `best` first, then the other faces of its patch whose fronts agree with its front.
std::vector<FaceId> own_faces(const Scene& scene, const Search& search, const Nearby& best) {
  std::vector<FaceId> faces = {best.face};
  for (const Nearby& near : search.found()) {
    if (scene.face(near.face).patch != scene.face(best.face).patch) continue;
    if (dot(near.normal, best.normal) < kCosOfOneDegree) continue;
    if (std::ranges::find(faces, near.face) == faces.end()) faces.push_back(near.face);
  }
  std::sort(faces.begin() + 1, faces.end());
  return faces;
}

}  // namespace

std::vector<FaceId> own_faces(const Scene& scene, FaceId face, const Vec3& point, double tolerance) {
  const Search search(scene, point, tolerance);
  const auto best = std::ranges::find(search.found(), face, &Nearby::face);
  return best != search.found().end() ? own_faces(scene, search, *best) : std::vector<FaceId>{face};
}

NearFaces find_faces(const Scene& scene, const Receiver& receiver, double tolerance, Normals normals) {
  const kernel::StandardArithmetic arithmetic;
  const Search search(scene, receiver.point, tolerance);
  const Vec3 normal = unit_by_inverse(receiver.normal);
  const Nearby* best = nullptr;
  using Rank = std::tuple<bool, double, double, std::size_t>;
  Rank least;
  for (const Nearby& near : search.found()) {
    const double cosine = dot(normal, near.normal);
    if (normals == Normals::kAgree && std::abs(cosine) < kCosOfOneDegree) continue;
    const double off = normals == Normals::kAgree ? 0.0 : -std::abs(cosine);
    const Rank rank(cosine < 0.0, off, near.distance, index_of(near.face));
    if (best != nullptr && least <= rank) continue;
    best = &near;
    least = rank;
  }
  if (best == nullptr) return {};
  return {own_faces(scene, search, *best), search.in_the_scenes_unit(std::abs(best->height)),
          side_of(scene, best->piece, receiver.point), std::get<0>(least)};
}

// --- Faces before a receiver ---------------------------------------------------------------------------------------

std::vector<FaceId> HidingFaces::of(const Receiver& receiver) {
  constexpr double kBlur = 0x1p-48;  // of the scene's largest coordinate
  std::vector<FaceId> hiding;
  if (std::ranges::none_of(receiver.on, [&](FaceId face) { return are_possible_on(face); })) return hiding;
  const OwnPieces own(scene_, receiver);
  const Search search(scene_, receiver.point, tolerance_of_computed_points(scene_));
  const Vec3 normal = unit_by_inverse(receiver.normal);
  for (const Nearby& near : search.found()) {
    if (scene_.pieces()[near.piece].transparent || own.contains(near.piece)) continue;
    const double cosine = dot(normal, near.normal);
    if (std::abs(cosine) < kCosOfOneDegree || near.beside > std::abs(near.height) + kBlur) continue;
    const int side = side_of(scene_, near.piece, receiver.point);
    if (side != 0 && (side < 0) == (cosine > 0.0)) hiding.push_back(near.face);
  }
  return hiding;
}

// Whether another piece near the face lies nearly in the plane of one of its pieces.
bool HidingFaces::are_possible_on(FaceId id) {
  const auto known = possible_.find(id);
  if (known != possible_.end()) return known->second;
  bool found = false;
  const double scale = extent(scene_).scale, tolerance = tolerance_of_computed_points(scene_);
  const auto at = [&](std::uint32_t vertex) { return kernel::scaled(scene_.vertices()[vertex], scale); };
  for (std::uint32_t own = scene_.face(id).first_piece; own < scene_.face(id).first_piece + scene_.face(id).piece_count;
       ++own) {
    const Piece& piece = scene_.pieces()[own];
    const Vec3 normal = normal_of(scene_, scale, piece), &origin = scene_.vertices()[piece.frame[0]];
    Box box{origin, origin};
    for (const std::uint32_t corner : scene_.corners(piece)) box.include(scene_.vertices()[corner]);
    visit_pieces_near(scene_, box, tolerance, [&](std::uint32_t other) {
      const Piece& near = scene_.pieces()[other];
      if (near.transparent || planes(scene_).of_piece(other) == planes(scene_).of_piece(own)) return true;
      if (std::abs(dot(normal, normal_of(scene_, scale, near))) < kCosOfOneDegree) return true;
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const std::uint32_t corner : scene_.corners(near)) {
        const double height = dot(normal, difference(at(corner), kernel::scaled(origin, scale)));
        low = std::min(low, height);
        high = std::max(high, height);
      }
      found = low <= tolerance * scale && high >= -tolerance * scale;
      return !found;
    });
    if (found) break;
  }
  return possible_[id] = found;
}

// --- Near misses ---

// Receivers that were probably meant to lie on a face.

namespace {

constexpr std::size_t kMostTold = 3;

std::string name_of_receiver(std::span<const Receiver> receivers, std::size_t i) {
  return "'" + (receivers[i].id.empty() ? std::to_string(i + 1) : receivers[i].id) + "'";
}

bool looks_away_from(const Face& face, const Vec3& normal) {
  const double largest = kernel::max_norm(normal), size = kernel::max_norm(face.newell);
  if (!(largest > 0.0) || !(size > 0.0)) return false;
  const auto share = [](const Vec3& v, double by) { return Vec3{v.x / by, v.y / by, v.z / by}; };
  return kernel::dot(share(normal, largest), share(face.newell, size)) < 0.0;
}

}  // namespace

std::vector<std::size_t> place_on_faces(const Scene& scene, std::span<Receiver> receivers,
                                        std::optional<double> tolerance) {
  std::vector<std::size_t> without;
  kernel::Steps steps("faces of receivers", receivers.size());
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    steps.take();
    Receiver& receiver = receivers[i];
    if (!receiver.on.empty()) continue;
    receiver.on = find_faces(scene, receiver, tolerance.value_or(face_tolerance(scene, receiver.point))).faces;
    if (receiver.on.empty()) without.push_back(i);
  }
  return without;
}

NearMisses near_misses(const Scene& scene, std::span<const Receiver> receivers) {
  const kernel::StandardArithmetic arithmetic;
  NearMisses misses;
  std::vector<std::string> worst, others;  // the former see nothing
  const auto tell = [&](std::size_t i, const std::string& what, std::vector<std::string>& list) {
    if (list.size() < kMostTold) list.push_back(name_of_receiver(receivers, i) + ", " + what);
  };
  HidingFaces hiding(scene);
  std::vector<FaceId> hiding_faces;
  kernel::Steps steps("faces of receivers", receivers.size());
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    steps.take();
    const Receiver& receiver = receivers[i];
    if (!receiver.on.empty()) {
      if (const std::vector<FaceId> before = hiding.of(receiver); !before.empty()) {
        ++misses.hidden;
        hiding_faces.insert(hiding_faces.end(), before.begin(), before.end());
        const bool own = std::ranges::find(receiver.on, before.front()) != receiver.on.end();
        tell(i,
             "on '" + scene.name_of(receiver.on) + "', behind " +
                 (own ? "another triangle of it" : "'" + scene.name_of(before.front()) + "'"),
             worst);
      }
      if (!looks_away_from(scene.face(receiver.on.front()), receiver.normal)) continue;
      ++misses.turned;
      tell(i, "turned against '" + scene.name_of(receiver.on) + "'", others);
      continue;
    }
    const NearFaces near = find_faces(scene, receiver, face_tolerance(scene, receiver.point));
    if (near.faces.empty() || near.side == 0) continue;
    // What counts is the side that the receiver looks away from.
    const bool behind = (near.side < 0) != near.turned;
    ++(behind ? misses.behind : misses.in_front);
    misses.furthest = std::max(misses.furthest, near.distance);
    tell(i,
         text::short_number(near.distance, 2) + (near.side < 0 ? " behind '" : " in front of '") +
             scene.name_of(near.faces.front()) + "'",
         behind ? worst : others);
  }
  misses.mends_hidden = flag_words(scene, "--transparent", selections_of(scene, std::move(hiding_faces)));
  misses.first = std::move(worst);
  std::ranges::move(others, std::back_inserter(misses.first));
  if (misses.first.size() > kMostTold) misses.first.resize(kMostTold);
  return misses;
}

std::vector<std::string> sentences(const NearMisses& misses, std::size_t receivers, std::string_view noun) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<std::string> told;
  const std::string of_all = " of " + text::counted(receivers, noun);
  if (misses.behind + misses.in_front > 0) {
    std::string sentence = std::to_string(misses.behind + misses.in_front) + of_all +
                           " are given without a face, within " + text::short_number(misses.furthest, 2) + " of one";
    if (misses.behind > 0) {
      sentence += "; " + std::to_string(misses.behind) + " of them look through it from behind, so it hides everything";
    }
    told.push_back(sentence + "; --on auto places them on their faces");
  }
  if (misses.hidden > 0) {
    told.push_back(std::to_string(misses.hidden) + of_all +
                   " lie on a face, but behind another one that is nearly in its plane and hides everything; " +
                   (misses.mends_hidden.empty() ? "--transparent NAME,NAME,..." : misses.mends_hidden) +
                   " lets light pass through it");
  }
  if (misses.turned > 0) {
    told.push_back(std::to_string(misses.turned) + of_all +
                   " look away from the front of the face that they lie on; --flip turns a patch round");
  }
  if (told.empty()) return told;
  std::string examples = "the first: ";
  for (std::size_t i = 0; i < misses.first.size(); ++i) examples += (i > 0 ? "; " : "") + misses.first[i];
  told.push_back(std::move(examples));
  return told;
}

// --- Distance ---

namespace {

// All coordinates are multiplied by this power of two first, so that no difference of large coordinates overflows.
constexpr double kScale = 0x1p-3;

Vec3 scaled_difference(const Vec3& p, const Vec3& q) {
  return {kScale * p.x - kScale * q.x, kScale * p.y - kScale * q.y, kScale * p.z - kScale * q.z};
}

double outside(double value, double low, double high) {
  return std::max({kScale * low - kScale * value, kScale * value - kScale * high, 0.0});
}

double distance_from_plane(const Face& face, const Vec3& from_corner) {
  return std::abs(kernel::dot(kernel::unit(face.newell), from_corner));
}

}  // namespace

double relative_distance_from_face(const Scene& scene, FaceId id, const Vec3& point) {
  const kernel::StandardArithmetic arithmetic;
  const Face& face = scene.face(id);
  if (face.rings.empty() || face.rings.front().empty()) return 0.0;
  const Vec3& first = scene.vertices()[face.rings.front().front()];
  Box box{first, first};
  for (const std::uint32_t v : face.rings.front()) box.include(scene.vertices()[v]);
  const auto& [low, high] = box;
  const Vec3 extent = scaled_difference(high, low);
  const double diagonal = std::hypot(extent.x, extent.y, extent.z);
  const double from_box =
      std::hypot(outside(point.x, low.x, high.x), outside(point.y, low.y, high.y), outside(point.z, low.z, high.z));
  const double distance = std::max(from_box, distance_from_plane(face, scaled_difference(point, first)));
  if (distance == 0.0) return 0.0;
  if (diagonal == 0.0) return std::numeric_limits<double>::infinity();
  return std::max(distance / diagonal - face.out_of_plane, 0.0);
}

}  // namespace exactff
