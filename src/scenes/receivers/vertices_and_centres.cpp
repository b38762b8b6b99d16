// Receivers at the corners of faces and the centres of regions.
//
// The centroid of a region, in exact arithmetic and rounded once at the end. The convex pieces of its faces are fans of
// triangles p, q, r with the vectors N_t = (q - p) x (r - p); N is the Newell vector of the outline.
//   1. Each triangle weighs w_t = N.N_t: twice its area as seen along N, up to a factor that is common to all.
//   2. The centroid is the sum of w_t (p + q + r) over 3 times the sum of w_t.
//   3. Is it strictly inside the outline, as seen along N? If not, the receiver is at the mean of the
//      corners of the piece that weighs most.
#include <array>
#include <optional>
#include <unordered_set>

#include "exactff/error.h"
#include "exactff/receiver.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "receivers/region_shape.h"
#include "scene/scene.h"
#include "text/refuse.h"

namespace exactff {
namespace {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;

// --- Corners -------------------------------------------------------------------------------------------

void check_corner_count(const Scene& scene, std::span<const FaceId> on) {
  std::uint64_t corners = 0;
  for (const FaceId face : on) {
    if (scene.face(face).piece_count == 0) continue;
    for (const auto& ring : scene.face(face).rings) corners += ring.size();
  }
  if (corners <= kMostReceivers) return;
  text::refuse(std::to_string(corners) + " corners of faces",
               "the limit is " + std::to_string(kMostReceivers) + " receivers in total", "use a smaller patch");
}

void append_corners(const Scene& scene, FaceId id, std::vector<Receiver>& receivers) {
  const Face& face = scene.face(id);
  const std::string prefix = numbered_name_of(scene, id) + '/';
  std::unordered_set<std::uint32_t> visited;
  std::size_t number = 0;
  for (const auto& ring : face.rings) {
    for (const std::uint32_t v : ring) {
      ++number;
      if (!visited.insert(places(scene)[v]).second) continue;
      const Vec3& point = scene.vertices()[v];
      receivers.push_back(
          {point, front_of_piece(scene, own_piece(scene, id, point)), {id}, prefix + std::to_string(number)});
    }
  }
}

// --- Centres -------------------------------------------------------------------------------------------

// A point relative to the first corner of the face, in units of 2^exponent.
struct Fraction {
  ExactVec3 numerator;
  Integer denominator = 0;
};

// Where the receiver of one region is.
class RegionCentre {
 public:
  RegionCentre(const Scene& scene, const Region& region)
      : scene_(scene), region_(region), shape_(scene, region), plane_(shape_.outline()) {}

  [[nodiscard]] Receiver find() const {
    const Fraction at = centre();
    const FaceId first = region_.faces.front();
    const Offset offset = {quotient(at.numerator.x, at.denominator), quotient(at.numerator.y, at.denominator),
                           quotient(at.numerator.z, at.denominator)};
    std::optional<Receiver> receiver;
    if (!is_one_planar_face(scene_, region_)) {
      receiver = shape_.receiver_under(offset, along(shape_.frame().e(), at), along(shape_.frame().f(), at));
    }
    if (!receiver) receiver = receiver_on(scene_, first, {first}, plane_.rounded(offset));
    receiver->id = numbered_name_of(scene_, first);
    return *receiver;
  }

 private:
  using Offset = std::array<Rational, 3>;

  [[nodiscard]] Fraction centre() const {
    if (is_convex()) return mean(plane_.points().at);
    Fraction largest;
    const Fraction centroid = weigh_pieces(largest);
    return is_inside(centroid) ? centroid : largest;
  }

  // As seen along the Newell vector.
  [[nodiscard]] bool is_convex() const {
    if (region_.faces.size() > 1) return plane_.is_convex();
    if (plane_.is_convex_quadrilateral()) return true;
    // The single piece of a convex planar face is the face itself; it may have corners on a straight side.
    const auto pieces = scene_.pieces_of(region_.faces.front());
    return pieces.size() == 1 && plane_.points().ring_count() == 1 &&
           pieces.front().corner_count == plane_.points().size();
  }

  // The centroid. Sets `largest` to the mean of the corners of the heaviest piece, the first of equals.
  Fraction weigh_pieces(Fraction& largest) const {
    Fraction centroid;
    Integer largest_weight = 0;
    for (const FaceId face : region_.faces) {
      for (const Piece& piece : scene_.pieces_of(face)) {
        const std::vector<ExactVec3> corners = corners_of(piece);
        const Integer weight = add_piece(corners, centroid);
        if (weight <= largest_weight) continue;
        largest_weight = weight;
        largest = mean(corners);
      }
    }
    return centroid;
  }

  // Returns the weight.
  Integer add_piece(const std::vector<ExactVec3>& p, Fraction& centroid) const {
    Integer sum = 0;
    for (std::size_t i = 2; i < p.size(); ++i) {
      const Integer weight = dot(plane_.normal(), cross(p[i - 1] - p[0], p[i] - p[0]));
      centroid.numerator = centroid.numerator + (p[0] + p[i - 1] + p[i]) * weight;
      sum += weight;
    }
    centroid.denominator += 3 * sum;
    return sum;
  }

  [[nodiscard]] std::vector<ExactVec3> corners_of(const Piece& piece) const {
    const std::span<const Vec3> vertices = scene_.vertices();
    std::vector<ExactVec3> corners;
    for (const std::uint32_t v : scene_.corners(piece)) {
      kernel::ScaledVec3 corner = kernel::exact_difference(vertices[v], vertices[plane_.points().vertex.front()]);
      if (!kernel::is_zero(corner.v)) kernel::lower_exponent(corner, plane_.points().exponent);
      corners.push_back(std::move(corner.v));
    }
    return corners;
  }

  static Fraction mean(const std::vector<ExactVec3>& points) {
    Fraction sum;
    for (const ExactVec3& p : points) sum.numerator = sum.numerator + p;
    sum.denominator = static_cast<unsigned long>(points.size());
    return sum;
  }

  [[nodiscard]] bool is_inside(const Fraction& p) const {
    return shape_.frame().strictly_inside(along(shape_.frame().e(), p), along(shape_.frame().f(), p));
  }

  static FaceFrame::Coordinate along(const ExactVec3& axis, const Fraction& p) {
    return {dot(axis, p.numerator), p.denominator};
  }

  const Scene& scene_;
  const Region& region_;
  RegionShape shape_;
  const FacePlane& plane_;
};

void check_region_count(std::size_t regions) {
  if (regions <= kMostReceivers) return;
  text::refuse(std::to_string(regions) + " faces",
               "the limit is " + std::to_string(kMostReceivers) + " receivers in total", "use a smaller patch");
}

}  // namespace

std::vector<Receiver> vertex_receivers(const Scene& scene, std::span<const FaceId> on) {
  const kernel::StandardArithmetic arithmetic;
  check_corner_count(scene, on);
  std::vector<Receiver> receivers;
  kernel::Steps faces("receivers", on.size());
  for (const FaceId face : on) {
    faces.take();
    if (scene.face(face).piece_count > 0) append_corners(scene, face, receivers);
  }
  return receivers;
}

std::vector<Receiver> centre_receivers(const Scene& scene, std::span<const Region> on) {
  const kernel::StandardArithmetic arithmetic;
  check_region_count(on.size());
  std::vector<Receiver> receivers;
  kernel::Steps centres("receivers", on.size());
  for (const Region& region : on) {
    centres.take();
    receivers.push_back(RegionCentre(scene, region).find());
  }
  return receivers;
}

std::vector<Receiver> centre_receivers(const Scene& scene, std::span<const FaceId> on) {
  return centre_receivers(scene, lone_regions(scene, on));
}

// At a corner itself, walls that meet there would be seen edge-on, which is not what is seen a hair beside it.
std::vector<Receiver> probe_receivers(const Scene& scene, std::span<const FaceId> on) {
  constexpr double kToCentre = 0.125;
  const kernel::StandardArithmetic arithmetic;
  std::vector<Receiver> receivers;
  for (const FaceId face : on) {
    for (std::uint32_t k = 0; k < scene.face(face).piece_count; ++k) {
      const std::uint32_t index = scene.face(face).first_piece + k;
      const std::span<const std::uint32_t> corners = scene.corners(scene.pieces()[index]);
      const Vec3 front = front_of_piece(scene, index);
      Vec3 centre;
      for (const std::uint32_t v : corners) {
        centre = kernel::along(centre, scene.vertices()[v], 1.0 / static_cast<double>(corners.size()));
      }
      const auto add = [&](const Vec3& point) {
        if (kernel::is_finite(point)) receivers.push_back({point, front, {face}, {}});
      };
      add(centre);
      for (const std::uint32_t v : corners) {
        const Vec3& corner = scene.vertices()[v];
        add(kernel::along(corner, kernel::difference(centre, corner), kToCentre));
      }
    }
  }
  return receivers;
}

}  // namespace exactff
