#include "receivers/region_shape.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "kernel/expect.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "scene/scene.h"
#include "scene/shaft_tree.h"

namespace exactff {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::sign;

// --- Face plane ---

Rational quotient(const Integer& numerator, const Integer& denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return value;
}

FacePlane::FacePlane(const Scene& scene, FaceId id)
    : FacePlane(face_points(scene.vertices(), scene.face(id).rings),
                scene.vertices()[scene.face(id).rings.front().front()]) {}

FacePlane::FacePlane(FacePoints points, const Vec3& first_corner)
    : points_(std::move(points)), first_corner_(first_corner), normal_(newell(points_, 0, points_.ring_start[1])) {
  EXACTFF_EXPECT(!kernel::is_zero(normal_));
  kernel::make_primitive(normal_);
}

bool FacePlane::is_convex() const {
  const std::size_t n = points_.size();
  if (points_.ring_count() != 1) return false;
  for (std::size_t i = 0; i < n; ++i) {
    const ExactVec3 &p = points_.at[i], &q = points_.at[(i + 1) % n], &r = points_.at[(i + 2) % n];
    if (sign(dot(normal_, cross(q - p, r - q))) <= 0) return false;
  }
  return true;
}

Vec3 FacePlane::rounded(const std::array<Rational, 3>& offset) const {
  const auto at = [&](double origin, const Rational& along) {
    return kernel::nearest_double(kernel::to_rational(origin) + kernel::times_power_of_two(along, points_.exponent));
  };
  return {at(first_corner_.x, offset[0]), at(first_corner_.y, offset[1]), at(first_corner_.z, offset[2])};
}

namespace {

ExactVec3 first_edge(const FacePlane& plane) {
  const FacePoints& points = plane.points();
  for (std::size_t i = 1; i < points.size(); ++i) {
    ExactVec3 edge = points.at[i] - points.at[i - 1];
    if (!kernel::is_zero(cross(edge, plane.normal()))) return edge;
  }
  return points.at[1] - points.at[0];
}

}  // namespace

FaceFrame::FaceFrame(const FacePlane& plane) : plane_(plane) {
  const ExactVec3& n = plane.normal();
  const ExactVec3 edge = first_edge(plane);
  e_ = edge * dot(n, n) - n * dot(n, edge);
  kernel::make_primitive(e_);
  f_ = cross(n, e_);
  kernel::make_primitive(f_);
  for (const ExactVec3& p : plane.points().at) {
    a_.push_back(dot(e_, p));
    b_.push_back(dot(f_, p));
  }
}

bool FaceFrame::strictly_inside(const Coordinate& a, const Coordinate& b) const {
  bool inside = false;
  for (std::size_t i = 0; i < plane_.points().size(); ++i) {
    const int crossing = crosses(i, a, b);
    if (crossing < 0) return false;
    if (crossing > 0) inside = !inside;
  }
  return inside;
}

// 1 if the ray from (a, b) towards larger a crosses the edge from corner i, 0 if not, -1 if (a, b) lies on the edge. An
// edge includes its lower end and excludes its upper end, so that a ray through a corner gets the correct parity.
int FaceFrame::crosses(std::size_t i, const Coordinate& a, const Coordinate& b) const {
  const std::size_t j = next_in_ring(plane_.points(), i);
  const Integer ai = a_[i] * a.denominator - a.numerator, bi = b_[i] * b.denominator - b.numerator;
  const Integer aj = a_[j] * a.denominator - a.numerator, bj = b_[j] * b.denominator - b.numerator;
  const int side = sign(Integer(ai * bj - aj * bi));  // positive: the point is left of the edge
  const int bi_sign = sign(bi), bj_sign = sign(bj);
  if (side == 0 && bi_sign * bj_sign <= 0 && sign(ai) * sign(aj) <= 0) return -1;
  if ((bi_sign > 0) == (bj_sign > 0)) return 0;
  return (bj_sign > 0) == (side > 0) ? 1 : 0;
}

// --- Region shape ---

namespace {

using VertexRing = std::vector<std::uint32_t>;

constexpr double kStraight = 1e-6;   // of the size of the outline,
constexpr double kMostSlender = 64;  // if that is at most so many times its width

// The edges that are not shared, as rings of places. What is a straight side is an estimate: it has no effect on where
// a receiver lies, only on where cells are.
class Outline {
 public:
  Outline(const Scene& scene, const Region& region) : scene_(scene), places_(places(scene)) {
    if (region.faces.size() == 1) {
      rings_ = scene.face(region.faces.front()).rings;
      return;
    }
    for (const FaceId face : region.faces) {
      for (const VertexRing& ring : scene.face(face).rings) toggle(ring);
    }
    while (!edges_.empty()) rings_.push_back(take_ring(edges_.begin()->first));
    begin_with_the_outer_ring();
    rotate(rings_.front(), first_corner(region));
    straighten();
  }

  [[nodiscard]] const std::vector<VertexRing>& rings() const { return rings_; }

 private:
  void toggle(const VertexRing& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::uint32_t from = places_[ring[i]], to = places_[ring[(i + 1) % ring.size()]];
      if (from == to) continue;
      const auto back = edges_.find({to, from});
      if (back == edges_.end()) {
        edges_.emplace(from, to);
      } else {
        edges_.erase(back);
      }
    }
  }

  // Follows the edges until they return to the first place.
  VertexRing take_ring(std::uint32_t first) {
    VertexRing ring;
    std::uint32_t at = first;
    do {
      const auto edge = edges_.lower_bound({at, 0});
      if (edge == edges_.end() || edge->first != at) break;
      ring.push_back(at);
      at = edge->second;
      edges_.erase(edge);
    } while (at != first);
    return ring;
  }

  void begin_with_the_outer_ring() {
    const FacePoints points = face_points(scene_.vertices(), rings_);
    std::vector<ExactVec3> areas;
    ExactVec3 sum;
    for (std::size_t r = 0; r < rings_.size(); ++r) {
      areas.push_back(newell(points, points.ring_start[r], points.ring_start[r + 1]));
      sum = sum + areas.back();
    }
    std::size_t outer = 0;
    for (std::size_t r = 1; r < rings_.size(); ++r) {
      if (dot(areas[r], sum) > dot(areas[outer], sum)) outer = r;
    }
    std::rotate(rings_.begin(), rings_.begin() + static_cast<std::ptrdiff_t>(outer), rings_.end());
  }

  [[nodiscard]] std::uint32_t first_corner(const Region& region) const {
    const VertexRing& outer = rings_.front();
    for (const FaceId face : region.faces) {
      for (const std::uint32_t v : scene_.face(face).rings.front()) {
        if (std::ranges::find(outer, places_[v]) != outer.end()) return places_[v];
      }
    }
    return outer.front();
  }

  static void rotate(VertexRing& ring, std::uint32_t first) {
    std::rotate(ring.begin(), std::ranges::find(ring, first), ring.end());
  }

  // --- Straight sides -------------------------------------------------------------------------------------------

  [[nodiscard]] Vec3 at(std::uint32_t vertex) const {
    return kernel::scaled(scene_.vertices()[vertex], extent(scene_).scale);
  }

  [[nodiscard]] double size_of(const VertexRing& ring) const {
    double size = 0.0;
    for (const std::uint32_t v : ring) size = std::max(size, kernel::distance(at(ring.front()), at(v)));
    return size;
  }

  [[nodiscard]] double distance_from_line(std::uint32_t vertex, std::uint32_t from, std::uint32_t to) const {
    const Vec3 line = kernel::difference(at(to), at(from)), off = kernel::difference(at(vertex), at(from));
    const double square = kernel::dot(line, line);
    const double share = square > 0.0 ? std::clamp(kernel::dot(line, off) / square, 0.0, 1.0) : 0.0;
    return kernel::distance(off, kernel::scaled(line, share));
  }

  // Of ring[first + 1], ..., ring[last - 1], keeps those without which the outline would move by more than the
  // tolerance (Douglas and Peucker). The end `last` may be the ring's size, which stands for its first corner.
  void keep_corners(const VertexRing& ring, std::size_t first, std::size_t last, double tolerance,
                    std::vector<char>& kept) const {
    std::size_t furthest = first;
    double most = tolerance;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distance_from_line(ring[i], ring[first], ring[last % ring.size()]);
      if (distance <= most) continue;
      most = distance;
      furthest = i;
    }
    if (furthest == first) return;
    kept[furthest] = 1;
    keep_corners(ring, first, furthest, tolerance, kept);
    keep_corners(ring, furthest, last, tolerance, kept);
  }

  // Drops slits. A region that is hardly more than a slit itself keeps its corners.
  void straighten() {
    const VertexRing outer = rings_.front();
    const double size = size_of(outer), width = area_of(outer) / size;
    const double tolerance = kStraight * std::min(size, kMostSlender * width);
    for (VertexRing& ring : rings_) ring = without_straight_corners(ring, tolerance);
    if (rings_.front().size() < 3) rings_.front() = outer;
    std::erase_if(rings_, [](const VertexRing& ring) { return ring.size() < 3; });
  }

  [[nodiscard]] double area_of(const VertexRing& ring) const {
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const Vec3 a = kernel::difference(at(ring[i]), at(ring[0])), b = kernel::difference(at(ring[i + 1]), at(ring[0]));
      sum = kernel::sum(sum, kernel::cross(a, b));
    }
    return 0.5 * kernel::length(sum);
  }

  // A ring that begins on a straight side begins where that side begins afterwards.
  [[nodiscard]] VertexRing without_straight_corners(const VertexRing& ring, double tolerance) const {
    const auto opposite =
        std::ranges::max_element(ring, {}, [&](std::uint32_t v) { return kernel::distance(at(ring.front()), at(v)); });
    const auto middle = static_cast<std::size_t>(opposite - ring.begin());
    std::vector<char> kept(ring.size(), 0);
    kept[0] = kept[middle] = 1;
    keep_corners(ring, 0, middle, tolerance, kept);
    keep_corners(ring, middle, ring.size(), tolerance, kept);
    VertexRing corners;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (kept[i] != 0) corners.push_back(ring[i]);
    }
    if (corners.size() < 3 || distance_from_line(corners[0], corners.back(), corners[1]) > tolerance) return corners;
    corners.erase(corners.begin());
    std::rotate(corners.begin(), corners.end() - 1, corners.end());
    return corners;
  }

  const Scene& scene_;
  std::span<const std::uint32_t> places_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges_;
  std::vector<VertexRing> rings_;
};

std::vector<VertexRing> with_tiles(const Scene& scene, const Region& region, std::vector<VertexRing> rings) {
  for (const FaceId face : region.faces) {
    for (const Piece& piece : scene.pieces_of(face)) {
      const auto corners = scene.corners(piece);
      rings.emplace_back(corners.begin(), corners.end());
    }
  }
  return rings;
}

// The first rings of the points.
FacePoints first_rings(const FacePoints& points, std::size_t count) {
  FacePoints first = points;
  first.ring_start.resize(count + 1);
  first.vertex.resize(first.ring_start.back());
  first.at.resize(first.ring_start.back());
  return first;
}

// numerator / denominator / 2^bits, with a relative error below 2^-51.
double as_double(const Integer& numerator, const Integer& denominator, long bits) {
  long n = 0, d = 0;
  const double above = mpz_get_d_2exp(&n, numerator.get_mpz_t()), below = mpz_get_d_2exp(&d, denominator.get_mpz_t());
  return std::ldexp(above / below, static_cast<int>(std::clamp(n - d - bits, -2000L, 2000L)));
}

long longest(const std::vector<Integer>& values) {
  std::size_t bits = 0;
  for (const Integer& value : values) bits = std::max(bits, mpz_sizeinbase(value.get_mpz_t(), 2));
  return static_cast<long>(bits);
}

}  // namespace

RegionShape::RegionShape(const Scene& scene, const Region& region)
    : RegionShape(scene, region, Outline(scene, region).rings()) {}

RegionShape::RegionShape(const Scene& scene, const Region& region, const std::vector<VertexRing>& outline)
    : points_(face_points(scene.vertices(), with_tiles(scene, region, outline))),
      outline_(first_rings(points_, outline.size()), scene.vertices()[points_.vertex.front()]),
      frame_(outline_),
      scene_(scene),
      is_lone_(region.faces.size() == 1) {
  a_bits_ = longest(frame_.a());
  b_bits_ = longest(frame_.b());
  std::size_t ring = outline.size();
  for (const FaceId face : region.faces) {
    for (std::uint32_t k = 0; k < scene.face(face).piece_count; ++k) add_tile(scene.face(face).first_piece + k, ring++);
  }
  fill_bins();
}

void RegionShape::add_tile(std::uint32_t piece, std::size_t ring) {
  const std::size_t first = points_.ring_start[ring], last = points_.ring_start[ring + 1];
  Tile tile{piece, points_.at[first], newell(points_, first, last), {}, {}, {}, {}};
  if (sign(dot(tile.normal, outline_.normal())) <= 0) return;
  for (std::size_t i = first; i < last; ++i) {
    const ExactVec3& p = points_.at[i];
    planar_ = planar_ && sign(dot(outline_.normal(), p)) == 0;
    tile.a.push_back(dot(frame_.e(), p));
    tile.b.push_back(dot(frame_.f(), p));
  }
  a_bits_ = std::max(a_bits_, longest(tile.a));
  b_bits_ = std::max(b_bits_, longest(tile.b));
  tiles_.push_back(std::move(tile));
}

void RegionShape::fill_bins() {
  const Integer one = 1;
  bins_ = std::clamp<std::size_t>(static_cast<std::size_t>(std::sqrt(static_cast<double>(tiles_.size()))), 1, 256);
  tiles_in_bin_.resize(bins_ * bins_);
  for (std::uint32_t t = 0; t < tiles_.size(); ++t) {
    Tile& tile = tiles_[t];
    for (const Integer& a : tile.a) tile.x.push_back(as_double(a, one, a_bits_));
    for (const Integer& b : tile.b) tile.y.push_back(as_double(b, one, b_bits_));
    constexpr double kMargin = 0x1p-48;
    const auto [left, right] = std::ranges::minmax(tile.x);
    const auto [low, high] = std::ranges::minmax(tile.y);
    for (std::size_t v = bin_of(low - kMargin); v <= bin_of(high + kMargin); ++v) {
      for (std::size_t u = bin_of(left - kMargin); u <= bin_of(right + kMargin); ++u) {
        tiles_in_bin_[v * bins_ + u].push_back(t);
      }
    }
  }
}

// Coordinates lie in [-1, 1].
std::size_t RegionShape::bin_of(double t) const {
  const double share = std::clamp(0.5 * (t + 1.0), 0.0, 1.0);
  return std::min(static_cast<std::size_t>(share * static_cast<double>(bins_)), bins_ - 1);
}

// Positive: the place lies left of the tile's side that begins at the corner.
int RegionShape::side(const Tile& tile, std::size_t corner, const PlanePlace& place) {
  const std::size_t next = corner + 1 < tile.a.size() ? corner + 1 : 0;
  const double rough = (tile.x[next] - tile.x[corner]) * (place.y - tile.y[corner]) -
                       (tile.y[next] - tile.y[corner]) * (place.x - tile.x[corner]);
  if (rough > kUncertain) return 1;
  if (rough < -kUncertain) return -1;
  const Integer along_a = tile.a[next] - tile.a[corner], along_b = tile.b[next] - tile.b[corner];
  const Integer to_a = place.a.numerator - tile.a[corner] * place.a.denominator;
  const Integer to_b = place.b.numerator - tile.b[corner] * place.b.denominator;
  return sign(Integer(along_a * to_b * place.a.denominator - along_b * to_a * place.b.denominator));
}

std::optional<Receiver> RegionShape::receiver_under(const std::array<Rational, 3>& offset,
                                                    const FaceFrame::Coordinate& a,
                                                    const FaceFrame::Coordinate& b) const {
  const PlanePlace place{a, b, as_double(a.numerator, a.denominator, a_bits_),
                         as_double(b.numerator, b.denominator, b_bits_)};
  for (const std::uint32_t t : tiles_in_bin_[bin_of(place.y) * bins_ + bin_of(place.x)]) {
    const Tile& tile = tiles_[t];
    int least = 1;
    for (std::size_t i = 0; i < tile.a.size() && least >= 0; ++i) least = std::min(least, side(tile, i, place));
    if (least < 0) continue;
    if (least == 0 && !frame_.strictly_inside(a, b)) return std::nullopt;
    const Vec3 point = outline_.rounded(planar_ ? offset : on_plane(tile, offset));
    const FaceId face = scene_.pieces()[tile.piece].face;
    return receiver_on(
        scene_, face,
        is_lone_ ? std::vector{face} : own_faces(scene_, face, point, tolerance_of_computed_points(scene_)), point);
  }
  return std::nullopt;
}

// Where the line through the point along the outline's normal meets the plane of the tile.
std::array<Rational, 3> RegionShape::on_plane(const Tile& tile, const std::array<Rational, 3>& offset) const {
  const ExactVec3& n = outline_.normal();
  Rational height = 0;
  for (int axis = 0; axis < 3; ++axis) {
    height += (tile.corner[axis] - offset[static_cast<std::size_t>(axis)]) * tile.normal[axis];
  }
  height /= Rational(dot(tile.normal, n));
  std::array<Rational, 3> at = offset;
  for (int axis = 0; axis < 3; ++axis) at[static_cast<std::size_t>(axis)] += height * n[axis];
  return at;
}

}  // namespace exactff
