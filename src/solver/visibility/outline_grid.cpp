#include "visibility/outline_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/lanes.h"
#include "kernel/vec.h"

namespace exactff::visibility {

using kernel::cross;
using kernel::dot;
using Edge = Outlines::Edge;
using Outline = Outlines::Outline;

namespace {

constexpr double kSlack = 0x1p-32;
constexpr double kLeastAhead = 0x1p-8;
constexpr std::size_t kFewestForAGrid = 8;
constexpr double kCellsPerOutline = 0.6;
constexpr std::uint64_t kEdgesPerOutline = 4;
constexpr std::uint64_t kPairsPerExactOne = 40;  // pairs that the filter decides in the time of one exact comparison
constexpr std::size_t kOutlinesToAlign = 256;
constexpr std::size_t kFewShare = 4;  // fewer than one edge in this many counts as few
constexpr std::uint32_t kMostOwnCells = 24;
constexpr std::size_t kMostInCaches = 4096;  // outlines
constexpr std::uint32_t kStrip = 32;         // columns

// Of length 1 or very slightly less.
Vec3 unit(const Vec3& a) {
  const double s = (1.0 - 0x1p-40) / std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
  return {a.x * s, a.y * s, a.z * s};
}

}  // namespace

OutlineGrid::Range OutlineGrid::Axis::extent(int cell) const {
  return {range.low + cell / per_unit, range.low + (cell + 1) / per_unit};
}

OutlineGrid::Cells OutlineGrid::Axis::cells_inside(const Range& r) const {
  if (!((r.high - r.low) * per_unit >= 1.0)) return {1, 0};
  const double most = count;
  const auto clamped = [&](double x) { return std::clamp((x - range.low) * per_unit, 0.0, most); };
  const double low = clamped(r.low);
  const int floor_of_low = static_cast<int>(low);
  return {floor_of_low + (low > floor_of_low ? 1 : 0), static_cast<int>(clamped(r.high)) - 1};
}

void OutlineGrid::build(const Outlines& outlines, std::size_t source_count, std::span<const std::uint8_t> dropped) {
  const std::size_t count = outlines.outlines().size();
  first_ = static_cast<OutlineId>(source_count);
  everywhere_.clear();
  all_.clear();
  single_ = count < source_count + kFewestForAGrid || !choose_projection(outlines, source_count);
  if (single_) {
    for (auto o = static_cast<OutlineId>(source_count); o < count; ++o) everywhere_.push_back(o);
    return;
  }
  last_found_.assign(count, kNone);
  project(outlines);
  align(outlines, source_count);
  find_bounds(outlines);
  choose_cells(source_count);
  last_seen_.assign(static_cast<std::size_t>(u_.count) * static_cast<std::size_t>(v_.count), kNone);
  find_needed_cells(outlines, dropped);
  find_covered_cells(outlines);
  find_cells(outlines);
  fill();
  near_.resize(count + 1);
  std::copy(everywhere_.begin(), everywhere_.end(), near_.begin());
}

// w points to the middle of the source. False where some corner of the source is not ahead.
bool OutlineGrid::choose_projection(const Outlines& outlines, std::size_t source_count) {
  const auto corner = [&](EdgeId id) -> const Outlines::Corner& { return outlines.corner(outlines.edge(id).a); };
  const Outline& last = outlines.outline(static_cast<OutlineId>(source_count - 1));
  Vec3 sum;
  for (EdgeId id = 0; id < last.first + last.count; ++id) {
    const auto& [t, size] = corner(id);
    const double s = 1.0 / size;
    sum = {sum.x + t.x * s, sum.y + t.y * s, sum.z + t.z * s};
  }
  w_ = unit(sum);
  const double x = std::abs(w_.x), y = std::abs(w_.y), z = std::abs(w_.z);
  const Vec3 axis = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  e_ = unit(cross(axis, w_));
  f_ = unit(cross(w_, e_));
  for (EdgeId id = 0; id < last.first + last.count; ++id) {
    const Outlines::Corner& c = corner(id);
    if (!(dot(w_, c.t) >= 2.0 * kLeastAhead * c.size)) return false;  // NaN too
  }
  return true;
}

void OutlineGrid::project(const Outlines& outlines) {
  std::size_t corners = 0;
  for (const Edge& edge : outlines.edges()) corners = std::max<std::size_t>(corners, edge.a + 1U);
  images_.resize(corners);
  all_ahead_ = true;
  for (CornerId c = 0; c < corners; ++c) {
    const Outlines::Corner& corner = outlines.corner(c);
    const double depth = dot(w_, corner.t);
    // |t| <= sqrt(3) size
    if (depth >= 1.75 * kLeastAhead * corner.size) {
      const double inverse = 1.0 / depth;
      images_[c] = {dot(e_, corner.t) * inverse, dot(f_, corner.t) * inverse, true};
    } else {
      images_[c] = {};
      all_ahead_ = false;
    }
  }
}

bool OutlineGrid::is_ahead(const Outlines& outlines, const Outline& outline) const {
  return std::ranges::all_of(outlines.edges_of(outline), [&](const Edge& edge) { return images_[edge.a].ahead; });
}

void OutlineGrid::find_bounds(const Outlines& outlines) {
  bounds_.assign(outlines.outlines().size(), {});
  for (OutlineId o = 0; o < bounds_.size(); ++o) {
    const Outline& outline = outlines.outline(o);
    if (!is_ahead(outlines, outline)) {
      if (o >= first_) everywhere_.push_back(o);
      continue;
    }
    ImageBounds bounds;
    for (const Edge& edge : outlines.edges_of(outline)) {
      const Image& image = images_[edge.a];
      bounds.u.include(image.u);
      bounds.v.include(image.v);
    }
    bounds.u.widen(4.0 * kSlack);
    bounds.v.widen(4.0 * kSlack);
    bounds_[o] = bounds;
  }
}

// Turns the image so that the occluders' edges, on the whole, run along u: slats then share few cells. A few hundred
// occluders suffice.
void OutlineGrid::align(const Outlines& outlines, std::size_t source_count) {
  double along = 0.0, across = 0.0;  // sums of length cos 2 phi, length sin 2 phi
  const std::size_t count = outlines.outlines().size();
  const auto stride = static_cast<OutlineId>(1 + (count - source_count) / kOutlinesToAlign);
  for (OutlineId o = static_cast<OutlineId>(source_count); o < count; o += stride) {
    const Outline& outline = outlines.outline(o);
    if (!is_ahead(outlines, outline)) continue;
    for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
      const Image &a = images_[outlines.edge(id).a], &b = images_[outlines.edge(id).b];
      const double du = b.u - a.u, dv = b.v - a.v, length = std::sqrt(du * du + dv * dv);
      if (length <= kSlack) continue;
      const double weight = std::min(length, 1.0) / (length * length);
      along += (du * du - dv * dv) * weight;
      across += 2.0 * du * dv * weight;
    }
  }
  const double phi = 0.5 * std::atan2(across, along), c = std::cos(phi), s = std::sin(phi);
  for (Image& image : images_) image = {c * image.u + s * image.v, c * image.v - s * image.u, image.ahead};
}

void OutlineGrid::choose_cells(std::size_t source_count) {
  u_.range = v_.range = {kInfinity, -kInfinity};
  for (OutlineId o = 0; o < source_count; ++o) {
    u_.range.include(bounds_[o].u);
    v_.range.include(bounds_[o].v);
  }
  const double whole_width = u_.range.high - u_.range.low, whole_height = v_.range.high - v_.range.low;
  double width = 0.0, height = 0.0;
  std::size_t count = 0;
  for (OutlineId o = first_; o < bounds_.size(); ++o) {
    const auto& [u, v] = bounds_[o];
    if (u.empty()) continue;
    width += std::min(u.high - u.low, whole_width);
    height += std::min(v.high - v.low, whole_height);
    ++count;
  }
  // Cells have the shape of the mean outline, but are no smaller than the region over which the images' slack spreads.
  const double cells = std::max(1.0, kCellsPerOutline * static_cast<double>(count));
  const double mean_width = std::max(width / static_cast<double>(std::max<std::size_t>(count, 1)), kSlack);
  const double mean_height = std::max(height / static_cast<double>(std::max<std::size_t>(count, 1)), kSlack);
  const double wide = whole_width / mean_width, high = whole_height / mean_height;  // in mean outlines
  const double factor = std::sqrt(cells / (wide * high));
  const auto set = [&](Axis& axis, double wanted, double extent) {
    const double finest = std::max(1.0, std::floor(extent / (8.0 * kSlack)));
    axis.count = static_cast<int>(std::clamp(std::round(wanted), 1.0, std::min(cells, finest)));
    axis.per_unit = axis.count / extent;
    too_fine_ = too_fine_ || wanted > 2.0 * finest;
  };
  too_fine_ = false;
  set(u_, wide * factor, whole_width);
  set(v_, high * factor, whole_height);
}

// Outlines that meet inside the source meet at a point of the grid, so bounds may be clamped to just beyond the grid.
// The integers then stay below 2^15. Subtracting one before truncation rounds downwards. This is also outwards for
// upper bounds, since their signs are changed.
//
// Let there be p cells in a unit of u and q in one of v. Images are known to within kSlack, which is at most
// kSlack (p + q) in cells; none is further away than 2^9, so that what is computed before clamping errs by less than
// 2^-41 (p + q). Of the slack, 4 kSlack (p + q), more than 2^-31 (p + q) is left. That is more than 2^-28 of a step,
// since a cell has 0x7F00 / (columns + rows + 2) steps and the grid is no wider or higher than 2^10, so that p + q is
// at least (columns + rows) / 2^10; what is computed after clamping errs by less than 2^-35 of a step.
EXACTFF_CLONES OutlineGrid::Octagon OutlineGrid::octagon(const Outlines& outlines, OutlineId id) const {
  using namespace kernel::lanes;
  const double wide = u_.count, high = v_.count;
  const double slack = 4.0 * kSlack * (u_.per_unit + v_.per_unit);
  Four least = four(kInfinity), most = -least;
  if (bounds_[id].u.empty()) std::swap(least, most);
  const Outline& outline = outlines.outline(id);
  for (EdgeId edge = outline.first; edge < outline.first + outline.count && !bounds_[id].u.empty(); ++edge) {
    const Image& image = images_[outlines.edge(edge).a];
    const double u = (image.u - u_.range.low) * u_.per_unit, v = (image.v - v_.range.low) * v_.per_unit;
    const Four at{u, v, u + v, u - v};
    least = smaller(least, at);
    most = larger(most, at);
  }
  const Four whole_low{-1.0, -1.0, -1.0, -high - 1.0},
      whole_high{wide + 1.0, high + 1.0, wide + high + 1.0, wide + 1.0};
  const double steps = 0x7F00 / (wide + high + 2.0);  // a cell
  const auto down = [&](const Four& at) {
    return __builtin_convertvector(__builtin_convertvector(at * steps - 1.0, FourInts), FourShorts);
  };
  const FourShorts low = down(smaller(larger(least - slack, whole_low), whole_high)),
                   top = down(-larger(smaller(most + slack, whole_high), whole_low));
  return __builtin_shufflevector(low, top, 0, 1, 2, 3, 4, 5, 6, 7);
}

OutlineGrid::Octagon OutlineGrid::reach(const Octagon& bounds) {
  return -__builtin_shufflevector(bounds, bounds, 4, 5, 6, 7, 0, 1, 2, 3);
}

// The range of u of the segment's points whose v lies in the given range, widened by the slack.
OutlineGrid::Range OutlineGrid::part_within(const Image& a, const Image& b, const Range& v) {
  const double rise = b.v - a.v;
  double s = 0.0, t = 1.0;
  if (std::abs(rise) > 16.0 * kSlack) {
    s = (v.low - 4.0 * kSlack - a.v) / rise;
    t = (v.high + 4.0 * kSlack - a.v) / rise;
    if (s > t) std::swap(s, t);
    s = std::clamp(s, 0.0, 1.0);
    t = std::clamp(t, 0.0, 1.0);
  }
  Range u{a.u + s * (b.u - a.u), a.u + s * (b.u - a.u)};
  u.include(a.u + t * (b.u - a.u));
  u.widen(4.0 * kSlack);
  return u;
}

template <class Visit>
bool OutlineGrid::for_few_cells(const Cells& columns, const Cells& rows, const Visit& visit) const {
  constexpr int kFew = 1;  // beyond the first, in each direction
  if (columns.last - columns.first > kFew && rows.last - rows.first > kFew) return false;
  for (int j = rows.first; j <= rows.last; ++j) {
    for (int i = columns.first; i <= columns.last; ++i) visit(static_cast<std::size_t>(j * u_.count + i));
  }
  return true;
}

template <class Visit>
void OutlineGrid::for_each_cell_of(const Outlines& outlines, OutlineId id, const Visit& visit) {
  const Cells columns = u_.cells(bounds_[id].u), rows = v_.cells(bounds_[id].v);
  if (!is_needed(columns, rows) || for_few_cells(columns, rows, visit)) return;
  const Outline& outline = outlines.outline(id);
  spans_.assign(static_cast<std::size_t>(rows.last - rows.first + 1), {kInfinity, -kInfinity});
  for (EdgeId edge = outline.first; edge < outline.first + outline.count; ++edge) {
    const Image &a = images_[outlines.edge(edge).a], &b = images_[outlines.edge(edge).b];
    Range own{std::min(a.v, b.v), std::max(a.v, b.v)};
    own.widen(4.0 * kSlack);
    const Cells crossed = v_.cells(own);
    for (int j = crossed.first; j <= crossed.last; ++j) {
      const Range part = part_within(a, b, v_.extent(j));
      Range& span = spans_[static_cast<std::size_t>(j - rows.first)];
      span.include(part.low);
      span.include(part.high);
    }
  }
  for (int j = rows.first; j <= rows.last; ++j) {
    const Cells filled = u_.cells(spans_[static_cast<std::size_t>(j - rows.first)]);
    for (int i = filled.first; i <= filled.last; ++i) visit(static_cast<std::size_t>(j * u_.count + i));
  }
}

// Every corner of the cell lies on the inner side of every edge, further from it than the error of the edge's line.
// That error is the slack at the edge's ends, and proportionally more beyond them.
bool OutlineGrid::covers(const Outlines& outlines, const Outline& outline, const Range& u, const Range& v) const {
  double orientation = 0.0;
  for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
    const Image &a = images_[outlines.edge(id).a], &b = images_[outlines.edge(id).b];
    const double du = b.u - a.u, dv = b.v - a.v, length = std::sqrt(du * du + dv * dv);
    for (const double pu : {u.low, u.high}) {
      for (const double pv : {v.low, v.high}) {
        const double area = du * (pv - a.v) - dv * (pu - a.u);
        const double reach = std::abs(pu - a.u) + std::abs(pv - a.v) + length;
        if (orientation == 0.0) orientation = area;
        if (!(std::copysign(1.0, orientation) * area > 16.0 * kSlack * reach)) return false;
      }
    }
  }
  return true;
}

void OutlineGrid::find_needed_cells(const Outlines& outlines, std::span<const std::uint8_t> dropped) {
  const std::size_t kept = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 0));
  all_needed_ = dropped.empty() || kept > dropped.size() / kFewShare;
  if (all_needed_) return;
  const auto wide = static_cast<std::size_t>(u_.count), stride = wide + 1;
  needed_.assign(stride * (static_cast<std::size_t>(v_.count) + 1), 0);
  for (EdgeId id = 0; id < dropped.size(); ++id) {
    const Image &a = images_[outlines.edge(id).a], &b = images_[outlines.edge(id).b];
    if (dropped[id] != 0 || !a.ahead || !b.ahead) continue;
    for_each_cell_of_edge(a, b, [&](std::size_t cell) { needed_[(cell / wide + 1) * stride + cell % wide + 1] = 1; });
  }
  for (std::size_t at = stride + 1; at < needed_.size(); ++at) {
    if (at % stride != 0) needed_[at] += needed_[at - 1] + needed_[at - stride] - needed_[at - stride - 1];
  }
}

bool OutlineGrid::is_needed(const Cells& columns, const Cells& rows) const {
  if (columns.first > columns.last || rows.first > rows.last) return false;
  if (all_needed_) return true;
  const auto sum = [&](int row, int column) {
    return needed_[static_cast<std::size_t>(row * (u_.count + 1) + column)];
  };
  return sum(rows.last + 1, columns.last + 1) - sum(rows.first, columns.last + 1) - sum(rows.last + 1, columns.first) +
             sum(rows.first, columns.first) !=
         0;
}

void OutlineGrid::find_covered_cells(const Outlines& outlines) {
  coverer_.assign(static_cast<std::size_t>(u_.count) * static_cast<std::size_t>(v_.count), kNone);
  for (OutlineId o = first_; o < outlines.outlines().size(); ++o) {
    const Cells columns = u_.cells_inside(bounds_[o].u), rows = v_.cells_inside(bounds_[o].v);
    if (!is_needed(columns, rows)) continue;
    for (int j = rows.first; j <= rows.last; ++j) {
      for (int i = columns.first; i <= columns.last; ++i) {
        OutlineId& coverer = coverer_[static_cast<std::size_t>(j * u_.count + i)];
        if (coverer == kNone && is_needed({i, i}, {j, j}) &&
            covers(outlines, outlines.outline(o), u_.extent(i), v_.extent(j))) {
          coverer = o;
        }
      }
    }
  }
}

void OutlineGrid::find_cells(const Outlines& outlines) {
  cells_.clear();
  outline_begin_.assign(1, 0);
  cell_begin_.assign(coverer_.size() + 1, 0);
  octagons_.resize(outlines.outlines().size());
  for (OutlineId o = 0; o < outlines.outlines().size(); ++o) {
    if (o >= first_ && !bounds_[o].u.empty()) {
      for_each_cell_of(outlines, o, [&](std::size_t cell) {
        cells_.push_back(static_cast<std::uint32_t>(cell));
        if (belongs(o, cell)) ++cell_begin_[cell + 1];
      });
    }
    outline_begin_.push_back(static_cast<std::uint32_t>(cells_.size()));
    const bool counts = o < first_ || bounds_[o].u.empty() || outline_begin_[o] < outline_begin_[o + 1];
    if (counts) octagons_[o] = octagon(outlines, o);
  }
}

void OutlineGrid::fill() {
  for (std::size_t cell = 1; cell < cell_begin_.size(); ++cell) cell_begin_[cell] += cell_begin_[cell - 1];
  members_.resize(cell_begin_.back());
  next_.assign(cell_begin_.begin(), cell_begin_.end() - 1);
  for (OutlineId o = first_; o + 1 < outline_begin_.size(); ++o) {
    for (std::uint32_t at = outline_begin_[o]; at < outline_begin_[o + 1]; ++at) {
      if (belongs(o, cells_[at])) members_[next_[cells_[at]]++] = o;
    }
  }
}

// A counting sort by each outline's first cell, row by row in strips of some columns. Outlines without cells come
// first.
std::span<const OutlineId> OutlineGrid::in_order(std::size_t count) {
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), OutlineId{0});
  if (single_ || count < kMostInCaches) return order_;
  const auto columns = static_cast<std::uint32_t>(u_.count), rows = static_cast<std::uint32_t>(v_.count);
  const std::uint32_t strip = std::min(kStrip, columns);
  const auto place = [&](std::uint32_t cell) {
    const std::uint32_t row = cell / columns, column = cell % columns;
    return (column / strip * rows + row) * strip + column % strip + 1;
  };
  const auto key = [&](OutlineId o) {
    return outline_begin_[o] == outline_begin_[o + 1] ? 0 : place(cells_[outline_begin_[o]]);
  };
  next_.assign(std::size_t{columns / strip + 1} * rows * strip + 2, 0);
  for (OutlineId o = 0; o < count; ++o) ++next_[key(o) + 1];
  std::partial_sum(next_.begin(), next_.end(), next_.begin());
  for (OutlineId o = 0; o < count; ++o) order_[next_[key(o)]++] = o;
  return order_;
}

std::uint64_t OutlineGrid::unsorted_pairs(const Outlines& outlines) const {
  const std::uint64_t edges = outlines.edges().size();
  if (single_) return edges * everywhere_.size();
  std::uint64_t not_ahead = 0;
  if (!all_ahead_) {
    for (const Edge& edge : outlines.edges()) not_ahead += images_[edge.a].ahead && images_[edge.b].ahead ? 0U : 1U;
  }
  std::uint64_t in_cells = 0;
  for (std::size_t cell = 0; too_fine_ && cell < coverer_.size(); ++cell) {
    const std::uint64_t members = cell_begin_[cell + 1] - cell_begin_[cell];
    in_cells += kPairsPerExactOne * kEdgesPerOutline * members * members;
  }
  return edges * everywhere_.size() + not_ahead * outlines.outlines().size() + in_cells;
}

template <class Visit>
void OutlineGrid::for_each_cell_of_edge(const Image& a, const Image& b, const Visit& visit) const {
  Range u{std::min(a.u, b.u), std::max(a.u, b.u)}, v{std::min(a.v, b.v), std::max(a.v, b.v)};
  u.widen(4.0 * kSlack);
  v.widen(4.0 * kSlack);
  const Cells rows = v_.cells(v);
  if (for_few_cells(u_.cells(u), rows, visit)) return;
  for (int j = rows.first; j <= rows.last; ++j) {
    const Cells columns = u_.cells(part_within(a, b, v_.extent(j)));
    for (int i = columns.first; i <= columns.last; ++i) visit(static_cast<std::size_t>(j * u_.count + i));
  }
}

std::span<const OutlineId> OutlineGrid::all_occluders() {
  if (all_.empty()) {
    for (OutlineId o = first_; o < last_found_.size(); ++o) all_.push_back(o);
  }
  return all_;
}

std::span<const OutlineId> OutlineGrid::find_near(const Outlines& outlines, EdgeId first, unsigned wanted) {
  if (single_) return everywhere_;
  const OutlineId own = outlines.edge(first).outline;
  const Octagon own_reach = reach(octagons_[own]);
  std::size_t count = everywhere_.size();
  const auto visit = [&](std::size_t cell) {
    if (last_seen_[cell] == first) return;
    last_seen_[cell] = first;
    for (std::uint32_t m = cell_begin_[cell]; m < cell_begin_[cell + 1]; ++m) {
      const OutlineId o = members_[m];
      near_[count] = o;  // without branches, which would be unpredictable
      count += static_cast<std::size_t>(last_found_[o] != first) &
               static_cast<std::size_t>(kernel::lanes::nowhere_larger(octagons_[o], own_reach));
      last_found_[o] = first;
    }
  };
  const std::uint32_t begin = outline_begin_[own], end = outline_begin_[own + 1];
  if (all_needed_ && begin < end && end - begin <= kMostOwnCells) {
    for (std::uint32_t at = begin; at < end; ++at) visit(cells_[at]);
    return std::span(near_).first(count);
  }
  for (EdgeId id = first; wanted >> (id - first) != 0; ++id) {
    if ((wanted >> (id - first) & 1U) == 0) continue;
    const Image &a = images_[outlines.edge(id).a], &b = images_[outlines.edge(id).b];
    if (!a.ahead || !b.ahead) return all_occluders();  // it may be anywhere
    for_each_cell_of_edge(a, b, visit);
  }
  return std::span(near_).first(count);
}

}  // namespace exactff::visibility
