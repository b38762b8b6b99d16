#include "whole_view/depths.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/expect.h"
#include "kernel/vec.h"

namespace exactff::whole_view {

using kernel::Approx3;
using kernel::max_norm;

namespace {

bool is_moderate(double size) { return size >= 0x1p-200 && size <= 0x1p200; }

InverseDepth inverse_depth(const Approx3& e, const Approx3& f, const Approx3& s) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double size_e = max_norm(e), size_f = max_norm(f), size_s = max_norm(s);
  if (!is_moderate(size_e) || !is_moderate(size_f) || !is_moderate(size_s)) return {{}, kInfinity};
  const Approx3 n{e.y * f.z - e.z * f.y, e.z * f.x - e.x * f.z, e.x * f.y - e.y * f.x};
  const double c = n.x * s.x + n.y * s.y + n.z * s.z;
  const double area = size_e * size_f, error_c = 0x1p-47 * area * size_s;
  if (!(std::abs(c) > 4.0 * error_c)) return {{}, kInfinity};
  const Vec3 slope{n.x / c, n.y / c, n.z / c};
  const double steepness = max_norm(slope);
  const double component = (0x1p-50 * area + steepness * error_c) / (std::abs(c) - error_c) + 0x1p-53 * steepness;
  const double error = 1.001 * (3.0 * component + 0x1p-48 * steepness);
  return std::isfinite(error) ? InverseDepth{slope, error} : InverseDepth{{}, kInfinity};
}

}  // namespace

void Depths::start(const Scene& scene, const Vec3& x, int scale_exponent) {
  vertices_ = scene.vertices();
  x_ = x;
  scale_ = std::ldexp(1.0, scale_exponent);
  depths_.clear();
  pieces_.clear();
  exact_at_.clear();
  exact_count_ = 0;
}

void Depths::add(const Piece& piece) {
  const auto scaled = [&](const Vec3& p, const Vec3& q) -> Approx3 {
    const Approx3 d = kernel::approx_difference(p, q);
    return {d.x * scale_, d.y * scale_, d.z * scale_};
  };
  const Vec3 &a = vertices_[piece.frame[0]], &b = vertices_[piece.frame[1]], &c = vertices_[piece.frame[2]];
  depths_.push_back(inverse_depth(scaled(b, a), scaled(c, a), scaled(a, x_)));
  pieces_.push_back(&piece);
  exact_at_.push_back(kNone);
}

const Depths::Exact& Depths::exact(OutlineId outline) {
  std::uint32_t& at = exact_at_[outline];
  if (at != kNone) return exact_[at];
  at = static_cast<std::uint32_t>(exact_count_++);
  if (exact_.size() < exact_count_) exact_.emplace_back();
  Exact& result = exact_[at];
  const auto& frame = pieces_[outline]->frame;
  kernel::set_difference(first_, vertices_[frame[1]], vertices_[frame[0]]);
  kernel::set_difference(second_, vertices_[frame[2]], vertices_[frame[0]]);
  kernel::set_cross(result.normal, first_.v, second_.v);
  kernel::set_difference(first_, vertices_[frame[0]], x_);
  kernel::set_dot(result.offset, result.normal, first_.v);
  result.exponent = first_.exponent;
  EXACTFF_EXPECT(kernel::sign(result.offset) != 0);
  if (kernel::sign(result.offset) < 0) {
    kernel::negate(result.normal);
    mpz_neg(result.offset.get_mpz_t(), result.offset.get_mpz_t());
  }
  return result;
}

int Depths::compare(Outlines& outlines, OutlineId p, OutlineId q, CornerId corner) {
  const Outlines::Corner& c = outlines.corner(corner);
  const InverseDepth &a = depths_[p], &b = depths_[q];
  const double difference = (a.slope.x * c.t.x + a.slope.y * c.t.y + a.slope.z * c.t.z) -
                            (b.slope.x * c.t.x + b.slope.y * c.t.y + b.slope.z * c.t.z);
  const double error = (a.error + b.error) * c.size;
  if (difference > error) return 1;
  if (difference < -error) return -1;
  const auto has_it = [&](OutlineId o) {
    const Outlines::Outline& outline = outlines.outline(o);
    for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
      if (outlines.edge(id).a == corner) return true;
    }
    return false;
  };
  if (has_it(p) && has_it(q)) return 0;
  const Exact &f = exact(p), &g = exact(q);
  const kernel::ExactVec3& t = outlines.exact(corner);
  kernel::set_dot(dot_, f.normal, t);
  left_ = dot_ * g.offset;
  kernel::set_dot(dot_, g.normal, t);
  right_ = dot_ * f.offset;
  if (g.exponent > f.exponent) left_ <<= static_cast<mp_bitcnt_t>(g.exponent - f.exponent);
  if (f.exponent > g.exponent) right_ <<= static_cast<mp_bitcnt_t>(f.exponent - g.exponent);
  const int order = cmp(left_, right_);
  return order < 0 ? -1 : order > 0 ? 1 : 0;
}

}  // namespace exactff::whole_view
