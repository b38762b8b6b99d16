#include "whole_view/windows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/expect.h"
#include "kernel/lanes.h"
#include "kernel/poll.h"
#include "kernel/vec.h"

namespace exactff::whole_view {

using kernel::Approx3;

// --- Depths ---

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
  depths_.push_back(kernel::inverse_depth(scaled(b, a), scaled(c, a), scaled(a, x_)));
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
    const auto edges = outlines.edges_of(outlines.outline(o));
    return std::ranges::find(edges, corner, &Outlines::Edge::a) != edges.end();
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
  return kernel::compare(left_, right_);
}

// --- Windows ---

namespace {

constexpr std::size_t kFewEdges = 11;  // outlines with an edge in the window; measured
constexpr int kMostSplits = 14;
constexpr int kMostStuck = 3;  // splits in a row that leave most outlines in some quarter

double component(const kernel::Approx3& t, int axis) { return axis == 0 ? t.x : axis == 1 ? t.y : t.z; }

struct FourDirections {
  kernel::lanes::Four x, y, z;
};

// The corners of a window.
template <class Window>
EXACTFF_INLINE FourDirections corners_of(const Window& window) {
  const kernel::lanes::Four u{window.u_low, window.u_high, window.u_high, window.u_low},
      v{window.v_low, window.v_low, window.v_high, window.v_high}, s = kernel::lanes::four(window.sign);
  return window.axis == 0   ? FourDirections{s, u, v}
         : window.axis == 1 ? FourDirections{v, s, u}
                            : FourDirections{u, v, s};
}

}  // namespace

void Windows::Index::sort(std::size_t outlines) {
  begin_.assign(outlines + 1, 0);
  for (const Entry& entry : entries_) ++begin_[entry.outline + 1];
  for (std::size_t o = 0; o < outlines; ++o) begin_[o + 1] += begin_[o];
  next_.assign(begin_.begin(), begin_.end());
  places_.resize(entries_.size());
  for (const Entry& entry : entries_) places_[next_[entry.outline]++] = entry.place;
}

void Windows::find(const Outlines& outlines, std::span<const InverseDepth> depths) {
  outlines_ = &outlines;
  depths_ = depths;
  all_seen_.clear();
  window_begin_.assign(1, 0);
  seen_.clear();
  hidden_.clear();
  rivals_.clear();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) start({axis, sign, -1.0, 1.0, -1.0, 1.0});
  }
  seen_.sort(outlines.outlines().size());
  hidden_.sort(outlines.outlines().size());
}

// With r = s t[axis] > 0, a corner is seen in the cell's coordinates (t[i] / r, t[j] / r). The components of t have a
// relative error of 2u, so a sign is certain, a comparison of two is certain beyond 4u of the larger, and a quotient
// errs by 6u of itself. 2^-22 of the largest quotient covers this and the rounding to float.
bool Windows::enters_face(const Outlines::Outline& outline, const Window& face, Member& member) const {
  constexpr double kSlack = 0x1p-50, kAhead = 0x1p-12;
  constexpr float kUnbounded = std::numeric_limits<float>::infinity();
  const int i = (face.axis + 1) % 3, j = (face.axis + 2) % 3;
  bool right = true, left = true, above = true, below = true, behind = true, ahead = true;
  double u_low = INFINITY, u_high = -INFINITY, v_low = INFINITY, v_high = -INFINITY;
  for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
    const Outlines::Corner& corner = outlines_->corner(outlines_->edge(id).a);
    const double r = face.sign * component(corner.t, face.axis), u = component(corner.t, i), v = component(corner.t, j);
    const double slack = kSlack * corner.size;
    if (!(slack >= 0.0)) right = left = above = below = behind = ahead = false;  // NaN
    behind = behind && r <= 0.0;
    right = right && u - r > slack;
    left = left && -u - r > slack;
    above = above && v - r > slack;
    below = below && -v - r > slack;
    ahead = ahead && r > kAhead * corner.size;
    if (!ahead) continue;
    u_low = std::min(u_low, u / r);
    u_high = std::max(u_high, u / r);
    v_low = std::min(v_low, v / r);
    v_high = std::max(v_high, v / r);
  }
  if (behind || right || left || above || below) return false;
  member.lines = outline.count > kLastLine ? ~Lines{0} : (Lines{1} << outline.count) - 1;
  if (!ahead) {
    member.u_low = member.v_low = -kUnbounded;
    member.u_high = member.v_high = kUnbounded;
    return true;
  }
  const double wide =
      0x1p-22 * (1.0 + std::max({std::abs(u_low), std::abs(u_high), std::abs(v_low), std::abs(v_high)}));
  member.u_low = static_cast<float>(u_low - wide);
  member.u_high = static_cast<float>(u_high + wide);
  member.v_low = static_cast<float>(v_low - wide);
  member.v_high = static_cast<float>(v_high + wide);
  return true;
}

void Windows::start(const Window& face) {
  members_.clear();
  const auto outlines = outlines_->outlines();
  for (OutlineId o = 0; o < outlines.size(); ++o) {
    Member member{.outline = o};
    if (enters_face(outlines[o], face, member)) members_.push_back(member);
  }
  const std::size_t count = members_.size();
  filter(face, 0, count);
  members_.erase(members_.begin(), members_.begin() + static_cast<std::ptrdiff_t>(count));
  split(face, 0, 0, 0);
}

void Windows::split(const Window& window, std::size_t first, int depth, int stuck) {
  const std::size_t edges = drop_hidden(window, first);
  const std::size_t count = members_.size() - first;
  if (edges <= kFewEdges || depth == kMostSplits || stuck == kMostStuck) {
    keep(first);
    return;
  }
  if (depth < 6) kernel::poll();
  const double u = 0.5 * (window.u_low + window.u_high), v = 0.5 * (window.v_low + window.v_high);
  const std::array<Window, 4> quarters = {{{window.axis, window.sign, window.u_low, u, window.v_low, v},
                                           {window.axis, window.sign, u, window.u_high, window.v_low, v},
                                           {window.axis, window.sign, window.u_low, u, v, window.v_high},
                                           {window.axis, window.sign, u, window.u_high, v, window.v_high}}};
  const std::size_t last = members_.size();
  for (const Window& quarter : quarters) {
    filter(quarter, first, last);
    const bool is_stuck = 8 * (members_.size() - last) > 7 * count;
    split(quarter, last, depth + 1, is_stuck ? stuck + 1 : 0);
    members_.resize(last);
  }
}

// Appends the members from first to last that may be seen in the window.
EXACTFF_CLONES void Windows::filter(const Window& window, std::size_t first, std::size_t last) {
  using namespace kernel::lanes;
  const auto [x, y, z] = corners_of(window);
  const auto edges = outlines_->edges();
  members_.reserve(members_.size() + (last - first));
  for (std::size_t m = first; m < last; ++m) {
    Member member = members_[m];
    if (member.u_low > window.u_high || member.u_high < window.u_low || member.v_low > window.v_high ||
        member.v_high < window.v_low) {
      continue;
    }
    const Outlines::Outline& outline = outlines_->outline(member.outline);
    bool outside = false;
    Lines rest = 0;
    for (std::uint32_t i = 0; i < outline.count; ++i) {
      const Lines bit = Lines{1} << std::min(i, std::uint32_t{kLastLine});
      if ((member.lines & bit) == 0) continue;
      const Outlines::Edge& edge = edges[outline.first + i];
      const Four height = edge.normal.x * x + edge.normal.y * y + edge.normal.z * z;
      if (lane_bits(height < -edge.error) == 15) {
        outside = true;
        break;
      }
      if (lane_bits(height > edge.error) != 15) rest |= bit;
    }
    if (outside) continue;
    member.lines = rest;
    members_.push_back(member);
  }
}

// Returns the number of outlines left that have an edge in the window.
EXACTFF_CLONES std::size_t Windows::drop_hidden(const Window& window, std::size_t first) {
  using namespace kernel::lanes;
  std::size_t edges = 0, covers = 0, nearest = 0;
  double nearest_depth = 0.0;
  const double u = 0.5 * (window.u_low + window.u_high), v = 0.5 * (window.v_low + window.v_high), s = window.sign;
  const Vec3 centre = window.axis == 0 ? Vec3{s, u, v} : window.axis == 1 ? Vec3{v, s, u} : Vec3{u, v, s};
  for (std::size_t m = first; m < members_.size(); ++m) {
    if (members_[m].lines != 0) {
      ++edges;
      continue;
    }
    const InverseDepth& depth = depths_[members_[m].outline];
    const double here = depth.slope.x * centre.x + depth.slope.y * centre.y + depth.slope.z * centre.z;
    if (covers++ > 0 && here <= nearest_depth) continue;
    nearest = m;
    nearest_depth = here;
  }
  if (covers == 0) return edges;
  const auto [x, y, z] = corners_of(window);
  const OutlineId by = members_[nearest].outline;
  const InverseDepth near = depths_[by];
  const Four near_w = near.slope.x * x + near.slope.y * y + near.slope.z * z;
  std::size_t kept = first;
  edges = 0;
  for (std::size_t m = first; m < members_.size(); ++m) {
    const Member& member = members_[m];
    const InverseDepth& depth = depths_[member.outline];
    const Four w = depth.slope.x * x + depth.slope.y * y + depth.slope.z * z;
    if (m != nearest && lane_bits(near_w - w > near.error + depth.error) == 15) {
      hidden_.add(member.outline, {by, member.lines, 0});
      continue;
    }
    edges += member.lines != 0 ? 1U : 0U;
    members_[kept++] = member;
  }
  members_.resize(kept);
  return edges;
}

void Windows::keep(std::size_t first) {
  if (members_.size() == first) return;
  const auto window = static_cast<std::uint32_t>(window_begin_.size() - 1);
  for (std::size_t m = first; m < members_.size(); ++m) {
    const Member& member = members_[m];
    seen_.add(member.outline, {window, member.lines, static_cast<std::uint32_t>(all_seen_.size())});
    all_seen_.push_back(member);
    if (member.lines != 0) continue;
    for (std::size_t k = first; k < m; ++k) {
      if (members_[k].lines == 0) rivals_.emplace_back(members_[k].outline, member.outline);
    }
  }
  window_begin_.push_back(static_cast<std::uint32_t>(all_seen_.size()));
}

}  // namespace exactff::whole_view
