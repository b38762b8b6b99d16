#include "visibility/source_plane.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "kernel/vec.h"
#include "scene/contacts.h"
#include "visibility/polygon_sets.h"

namespace exactff::visibility {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using kernel::ScaledVec3;
using kernel::sign;

// --- Plane crossings ---

using namespace kernel::double_double;

namespace {

using Vector = std::array<Bounded, 3>;

std::array<double, 3> components(const Vec3& v) { return {v.x, v.y, v.z}; }

// (p - q) * scale, exact except for underflow.
EXACTFF_INLINE Vector difference(const Vec3& p, const Vec3& q, double scale) {
  const std::array<double, 3> from = components(q), to = components(p);
  Vector d;
  for (int i = 0; i < 3; ++i) {
    const DoubleDouble exact = two_sum(to[i], -from[i]);
    d[i] = {exact.hi * scale, exact.lo * scale, kUnderflow};
  }
  return d;
}

EXACTFF_INLINE Bounded magnitude(const Bounded& x) { return x.hi < 0.0 ? -x : x; }

EXACTFF_INLINE Bounded dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

bool is_zero(const Bounded& c) { return c.hi == 0.0 && c.lo == 0.0 && c.error == 0.0; }

// The axis normal to the plane, if there is one and the plane contains x: the component of crossings along it is
// exactly 0.
int zero_axis(const Vec3& x, const Vec3& s, const Vector& normal) {
  const std::array<double, 3> xc = components(x), sc = components(s);
  for (int i = 0; i < 3; ++i) {
    if (xc[i] == sc[i] && is_zero(normal[(i + 1) % 3]) && is_zero(normal[(i + 2) % 3])) return i;
  }
  return -1;
}

// False where the sign of a height is not certain: the crossing is then unknown. Its component along `axis` is 0.
EXACTFF_CLONES
bool cross(const Vec3& p, const Vec3& q, const Vec3& x, const Vec3& s, const Vector& normal, int axis, double scale,
           Vector& result) {
  const Bounded g_p = dot(normal, difference(p, s, scale)), g_q = dot(normal, difference(q, s, scale));
  if (!sign_is_certain(g_p) || !sign_is_certain(g_q)) return false;
  const Vector t_p = difference(p, x, scale), t_q = difference(q, x, scale);
  const Bounded l = magnitude(g_q), m = magnitude(g_p);
  const std::array<double, 3> pc = components(p), qc = components(q), xc = components(x);
  for (int i = 0; i < 3; ++i) {
    const bool zero = i == axis || (pc[i] == xc[i] && qc[i] == xc[i]);
    result[i] = zero ? Bounded{} : sum_of_products(t_p[i], l, t_q[i], m);
  }
  return true;
}

// With u = 2^-53, |c - hi| <= |lo| + error <= 1.5 u |hi|, less than 2u |c|. It stays normal when the largest component,
// which is at most 2^300, is scaled to 1. False for NaN.
bool is_fine(const Bounded& c) {
  return is_zero(c) || (std::abs(c.hi) >= 0x1p-600 && kInflation * c.error <= 0x1p-54 * std::abs(c.hi));
}

// The two leading doubles of a number divided by 2^bits. Each is truncated to 53 bits: the rest after the first is
// below 2^-52 of the number, and the rest after the second is below 2^-104.
Bounded leading(const Integer& number, long bits) {
  if (kernel::sign(number) == 0) return {};
  long exponent = 0;
  const double first = mpz_get_d_2exp(&exponent, number.get_mpz_t());
  thread_local Integer rest, head;  // kept, so that nothing is allocated
  rest = number;
  head = std::ldexp(first, 53);
  if (exponent >= 53) {
    head <<= static_cast<unsigned long>(exponent - 53);
  } else {
    head >>= static_cast<unsigned long>(53 - exponent);  // no fraction: the number has at most `exponent` bits
  }
  rest -= head;
  long rest_exponent = 0;
  const double second = mpz_get_d_2exp(&rest_exponent, rest.get_mpz_t());  // truncated
  const auto scaled = [&](double mantissa, long e) {
    return std::ldexp(mantissa, static_cast<int>(std::max(e - bits, -4000L)));
  };
  const double hi = scaled(first, exponent), lo = second == 0.0 ? 0.0 : scaled(second, rest_exponent);
  return bounded(fast_two_sum(hi, lo), 0x1p-104 * std::abs(hi) + kUnderflow);
}

}  // namespace

FineNormal fine_normal(const ExactVec3& normal) {
  const long bits = bit_length(normal);
  return {leading(normal.x, bits), leading(normal.y, bits), leading(normal.z, bits)};
}

FineNormal fine_normal(const Vec3& normal) {
  int exponent = 0;
  static_cast<void>(std::frexp(kernel::max_norm(normal), &exponent));
  const auto scaled = [&](double c) {
    return c == 0.0 ? Bounded{} : Bounded{std::ldexp(c, -exponent), 0.0, kUnderflow};
  };
  return {scaled(normal.x), scaled(normal.y), scaled(normal.z)};
}

void PlaneCrossings::start(const Vec3& x, const FineNormal& normal, const Vec3& point, int scale_exponent) {
  x_ = x;
  normal_ = normal;
  point_ = point;
  zero_axis_ = zero_axis(x, point, normal);
  scale_exponent_ = scale_exponent;
  scale_ = std::ldexp(1.0, scale_exponent);
}

std::optional<PlaneCrossings::Fine> PlaneCrossings::fine(const Vec3& p, const Vec3& q) const {
  Vector c;
  if (!cross(p, q, x_, point_, normal_, zero_axis_, scale_, c)) return std::nullopt;
  const double largest = std::max({std::abs(c[0].hi), std::abs(c[1].hi), std::abs(c[2].hi)});
  const bool usable = largest >= 0x1p-300 && largest <= 0x1p300;
  if (!usable || !is_fine(c[0]) || !is_fine(c[1]) || !is_fine(c[2])) return std::nullopt;
  Fine result;
  static_cast<void>(std::frexp(largest, &result.exponent));
  result.exponent = -result.exponent;
  const double normalisation = std::ldexp(1.0, result.exponent);
  for (int i = 0; i < 3; ++i) {
    result.direction.hi[i] = c[i].hi * normalisation;
    result.direction.lo[i] = c[i].lo * normalisation;
    result.direction.error = std::max(result.direction.error, kInflation * c[i].error * normalisation);
  }
  result.direction.error += kUnderflow;
  return result;
}

namespace {

void set_magnitude_of_dot(Integer& result, const ExactVec3& a, const ExactVec3& b) {
  kernel::set_dot(result, a, b);
  mpz_abs(result.get_mpz_t(), result.get_mpz_t());
}

// a b + c d
void set_sum_of_products(Integer& result, const Integer& a, const Integer& b, const Integer& c, const Integer& d) {
  result = a * b;
  mpz_addmul(result.get_mpz_t(), c.get_mpz_t(), d.get_mpz_t());
}

}  // namespace

void PlaneCrossings::set_exact(ScaledVec3& result, const Vec3& p, const Vec3& q, const ExactVec3& normal,
                               long fine_exponent) {
  kernel::set_difference(t_p_, p, x_);
  kernel::set_difference(t_q_, q, x_);
  kernel::set_difference(d_p_, p, point_);
  kernel::set_difference(d_q_, q, point_);
  const long t_exponent = std::min(t_p_.exponent, t_q_.exponent), d_exponent = std::min(d_p_.exponent, d_q_.exponent);
  lower_exponent(t_p_, t_exponent);
  lower_exponent(t_q_, t_exponent);
  lower_exponent(d_p_, d_exponent);
  lower_exponent(d_q_, d_exponent);
  set_magnitude_of_dot(g_p_, normal, d_p_.v);
  set_magnitude_of_dot(g_q_, normal, d_q_.v);
  set_sum_of_products(result.v.x, t_p_.v.x, g_q_, t_q_.v.x, g_p_);
  set_sum_of_products(result.v.y, t_p_.v.y, g_q_, t_q_.v.y, g_p_);
  set_sum_of_products(result.v.z, t_p_.v.z, g_q_, t_q_.v.z, g_p_);
  result.exponent = t_exponent + d_exponent + 2L * scale_exponent_ - bit_length(normal) + fine_exponent;
}

// --- Source plane ---

namespace {

ExactVec3 front_normal(const Scene& scene, const Piece& piece) {
  const auto vertices = scene.vertices();
  const Vec3& a = vertices[piece.frame[0]];
  ExactVec3 normal = cross(kernel::exact_difference(vertices[piece.frame[1]], a).v,
                           kernel::exact_difference(vertices[piece.frame[2]], a).v);
  make_primitive(normal);
  return normal;
}

// One text for one oriented plane: the primitive normal N and the number N . p of any point p in it.
std::string plane_key(const ExactVec3& normal, const Vec3& point) {
  const kernel::ScaledVec3 p = kernel::exact_vector(point);
  Integer offset = dot(normal, p.v);
  long exponent = 0;
  if (sign(offset) != 0) {
    const mp_bitcnt_t zeros = mpz_scan1(offset.get_mpz_t(), 0);
    offset >>= zeros;
    exponent = p.exponent + static_cast<long>(zeros);
  }
  std::string key;
  for (const Integer* number : {&normal.x, &normal.y, &normal.z, static_cast<const Integer*>(&offset)})
    key += number->get_str(32) + ' ';
  return key + std::to_string(exponent);
}

// Of a sheet that is not all in the plane, as when one of its faces is selected, the pieces remain, and of one that is
// buried in part.
std::vector<PanelId> panels_of(const SourcePlane& plane) {
  const Panels& all = *plane.scene_panels;
  const std::vector<std::uint32_t>& pieces = plane.pieces;
  if (all.empty() || !plane.covers.empty()) return pieces;
  std::vector<PanelId> result;
  std::map<std::uint32_t, bool> is_whole;  // by sheet
  for (const std::uint32_t piece : pieces) {
    const std::uint32_t index = all.sheet_of_piece(piece);
    if (index == Panels::kNoSheet) {
      result.push_back(piece);
      continue;
    }
    const Sheet& sheet = all.sheets()[index];
    const auto [known, is_new] = is_whole.try_emplace(index);
    if (is_new) known->second = std::ranges::includes(pieces, sheet.pieces);
    if (!known->second) result.push_back(piece);
    for (PanelId k = 0; is_new && known->second && k < sheet.panel_count; ++k) result.push_back(sheet.first_panel + k);
  }
  std::ranges::sort(result);
  return result;
}

void set_covers(const Scene& scene, SourcePlane& plane) {
  std::set<std::uint32_t> covers;
  for (const std::uint32_t piece : plane.pieces) {
    const auto of_piece = contacts(scene).covers(piece);
    covers.insert(of_piece.begin(), of_piece.end());
  }
  plane.covers.assign(covers.begin(), covers.end());
}

// Whether a cover overlaps a piece that it does not bury.
bool have_conflict(const Scene& scene, const SourcePlane& plane) {
  return std::ranges::any_of(plane.pieces, [&](std::uint32_t piece) {
    const auto own = contacts(scene).covers(piece);
    return std::ranges::any_of(plane.covers, [&](std::uint32_t cover) {
      return !std::ranges::binary_search(own, cover) && overlap(scene, scene.pieces()[piece], scene.pieces()[cover]);
    });
  });
}

// A part of the plane.
SourcePlane only(const Scene& scene, const SourcePlane& plane, std::vector<std::uint32_t> pieces) {
  SourcePlane part = plane;
  part.pieces = std::move(pieces);
  part.faces.clear();
  for (const std::uint32_t piece : part.pieces) {
    const FaceId face = scene.pieces()[piece].face;
    if (part.faces.empty() || part.faces.back() != face) part.faces.push_back(face);
  }
  set_covers(scene, part);
  return part;
}

void split_buried(const Scene& scene, const SourcePlane& plane, std::vector<SourcePlane>& result) {
  std::vector<std::uint32_t> buried, others;
  for (const std::uint32_t piece : plane.pieces) {
    (contacts(scene).covers(piece).empty() ? others : buried).push_back(piece);
  }
  if (!others.empty()) result.push_back(only(scene, plane, others));
  for (const std::uint32_t piece : buried) {
    SourcePlane& part = result.emplace_back(only(scene, plane, {piece}));
    std::ranges::copy_if(others, std::back_inserter(part.elsewhere), [&](std::uint32_t other) {
      return overlap(scene, scene.pieces()[piece], scene.pieces()[other]);
    });
    part.covers.insert(part.covers.end(), part.elsewhere.begin(), part.elsewhere.end());
    others.push_back(piece);
  }
}

std::vector<SourcePlane> with_covers(const Scene& scene, std::vector<SourcePlane> planes) {
  std::vector<SourcePlane> result;
  for (SourcePlane& plane : planes) {
    set_covers(scene, plane);
    if (plane.covers.empty() || !have_conflict(scene, plane)) {
      result.push_back(std::move(plane));
    } else {
      split_buried(scene, plane, result);
    }
  }
  return result;
}

}  // namespace

std::vector<SourcePlane> group_by_plane(const Scene& scene, const std::vector<FaceId>& faces) {
  std::vector<SourcePlane> planes;
  std::map<std::string, std::size_t> index_of_key;
  for (const FaceId id : faces) {
    const Face& face = scene.face(id);
    for (std::uint32_t p = face.first_piece; p < face.first_piece + face.piece_count; ++p) {
      const Piece& piece = scene.pieces()[p];
      const Vec3& point = scene.vertices()[piece.frame[0]];
      ExactVec3 normal = front_normal(scene, piece);
      const auto [entry, is_new] = index_of_key.try_emplace(plane_key(normal, point), planes.size());
      if (is_new) {
        const FineNormal fine = fine_normal(normal);
        const Vec3 &second = scene.vertices()[piece.frame[1]], &third = scene.vertices()[piece.frame[2]];
        planes.push_back({&panels(scene),
                          {},
                          {},
                          {},
                          {},
                          {},
                          kernel::make_direction(std::move(normal)),
                          fine,
                          point,
                          second,
                          third});
      }
      SourcePlane& plane = planes[entry->second];
      if (plane.faces.empty() || plane.faces.back() != id) plane.faces.push_back(id);
      plane.pieces.push_back(p);
    }
  }
  if (!contacts(scene).empty()) planes = with_covers(scene, std::move(planes));
  for (SourcePlane& plane : planes) plane.panels = panels_of(plane);
  return planes;
}

int side_of(const SourcePlane& plane, const Vec3& x) {
  const int filtered = sign_of_dot(plane.normal.approx, kernel::approx_difference(x, plane.point));
  return filtered != kernel::kUncertain ? filtered : kernel::orientation(plane.point, plane.second, plane.third, x);
}

namespace {

Polygon2 projected(const Scene& scene, std::span<const std::uint32_t> corners, int axis, bool reverse) {
  Polygon2 polygon;
  for (const std::uint32_t corner : corners) {
    const Vec3& p = scene.vertices()[corner];
    const double coordinates[] = {p.x, p.y, p.z};
    polygon.push_back(
        {kernel::to_rational(coordinates[(axis + 1) % 3]), kernel::to_rational(coordinates[(axis + 2) % 3])});
  }
  if (reverse) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

// Maps the bounding box of all polygons to the unit square; returns the area of the box.
Rational normalise(std::vector<Polygon2>& polygons) {
  Point2 low = polygons.front().front();
  Point2 high = low;
  for (const Polygon2& polygon : polygons) {
    for (const Point2& p : polygon) {
      low = {std::min(low.u, p.u), std::min(low.v, p.v)};
      high = {std::max(high.u, p.u), std::max(high.v, p.v)};
    }
  }
  const Rational width = high.u - low.u;
  const Rational height = high.v - low.v;
  for (Polygon2& polygon : polygons) {
    for (Point2& p : polygon) p = {(p.u - low.u) / width, (p.v - low.v) / height};
  }
  return width * height;
}

// The pieces of one face do not overlap, nor do the panels of one sheet.
bool certainly_do_not_overlap(const SourcePlane& plane) {
  if (plane.faces.size() == 1) return true;
  const Panels& all = *plane.scene_panels;
  const PanelId first = plane.panels.front();
  return all.is_joined(first) && all.sheet_of(first).panel_count == plane.panels.size();
}

}  // namespace

ProjectedArea union_area(const Scene& scene, const SourcePlane& plane) {
  const int axis = longest_axis(plane.normal.exact);
  const bool reverse = sign(plane.normal.exact[axis]) < 0;
  std::vector<Polygon2> polygons;
  for (const PanelId panel : plane.panels) {
    polygons.push_back(projected(scene, plane.scene_panels->corners(panel), axis, reverse));
  }
  Rational doubled;
  if (certainly_do_not_overlap(plane)) {
    for (const Polygon2& polygon : polygons) doubled += doubled_area(polygon);
  } else {
    const Rational box = normalise(polygons);
    doubled = box * doubled_area(join(polygons));
  }
  return {doubled / 2, axis};
}

bool is_covered(const Scene& scene, std::uint32_t piece, std::span<const std::uint32_t> by) {
  if (by.empty()) return false;
  const int axis = longest_axis(front_normal(scene, scene.pieces()[piece]));
  std::vector<Polygon2> polygons;
  const auto add = [&](std::uint32_t id) {
    const Piece& one = scene.pieces()[id];
    polygons.push_back(projected(scene, scene.corners(one), axis, sign(front_normal(scene, one)[axis]) < 0));
  };
  add(piece);
  std::ranges::for_each(by, add);
  normalise(polygons);
  return difference(std::span(polygons).first(1), std::span(polygons).subspan(1)).empty();
}

namespace {

bool overlap(const Scene& scene, const SourcePlane& plane) {
  if (certainly_do_not_overlap(plane)) return false;
  const ProjectedArea all = union_area(scene, plane);
  Rational sum;
  for (const std::uint32_t piece : plane.pieces) {
    const bool reverse = sign(plane.normal.exact[all.axis]) < 0;
    sum += doubled_area(projected(scene, scene.corners(scene.pieces()[piece]), all.axis, reverse));
  }
  return sum != 2 * all.area;
}

}  // namespace

std::vector<SourcePlane> split_by_face(const Scene& scene, const SourcePlane& plane) {
  if (plane.faces.size() == 1 || overlap(scene, plane)) return {plane};
  std::vector<SourcePlane> result;
  for (const FaceId face : plane.faces) {
    SourcePlane& one = result.emplace_back(plane);
    one.faces = {face};
    std::erase_if(one.pieces, [&](std::uint32_t piece) { return scene.pieces()[piece].face != face; });
    set_covers(scene, one);
    one.panels = panels_of(one);
    const auto& frame = scene.pieces()[one.pieces.front()].frame;
    one.point = scene.vertices()[frame[0]];
    one.second = scene.vertices()[frame[1]];
    one.third = scene.vertices()[frame[2]];
  }
  return result;
}

}  // namespace exactff::visibility
