#include "methods/item_buffer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kernel/lanes.h"

namespace exactff::methods {

using namespace adaptive;

namespace {

// (column, row, depth) axes of each face in terms of (u, v, n). Forms and points are turned in the same way.
Vec3 turn_to(int face, const Vec3& p) {
  switch (face) {
    case 1:
      return {p.y, p.z, p.x};
    case 2:
      return {p.y, p.z, -p.x};
    case 3:
      return {p.x, p.z, p.y};
    case 4:
      return {p.x, p.z, -p.y};
    default:
      return p;
  }
}

// The depth of a point inside each of the four sides of the frustum; the side faces end at the horizon.
std::array<double, 4> depths_inside(int face, const Vec3& p) {
  return {p.z - p.x, p.z + p.x, p.z - p.y, face == 0 ? p.z + p.y : p.y};
}

void clip_by(int face, std::size_t side, const std::vector<Vec3>& polygon, std::vector<Vec3>& clipped) {
  clipped.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& p = polygon[i];
    const Vec3& q = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double at_p = depths_inside(face, p)[side], at_q = depths_inside(face, q)[side];
    if (at_p >= 0.0) clipped.push_back(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0))
      clipped.push_back(p + (q - p) * (at_p / (at_p - at_q)));
  }
}

// A bit for each side. `all`: all corners are outside it. `any`: some corner is.
struct Outcodes {
  unsigned all = 15;
  unsigned any = 0;
};

Outcodes outcodes(int face, const std::vector<Vec3>& polygon) {
  Outcodes codes;
  for (const Vec3& p : polygon) {
    unsigned code = 0;
    const std::array<double, 4> inside = depths_inside(face, p);
    for (std::size_t side = 0; side < inside.size(); ++side) code |= (inside[side] < 0.0 ? 1U : 0U) << side;
    codes.all &= code;
    codes.any |= code;
  }
  return codes;
}

using kernel::lanes::Four;
using FourItems = std::uint32_t __attribute__((vector_size(16)));

// Fills pixels of a row, four at a time. The nearness of the k-th is slope (first + 2 k) + rest.
EXACTFF_CLONES
void fill(double slope, double first, double rest, int count, std::uint32_t item, double* nearness,
          std::uint32_t* items) {
  int k = 0;
  for (Four column = Four{0.0, 2.0, 4.0, 6.0} + first; k + 4 <= count; k += 4, column += 8.0) {
    const Four here = slope * column + rest, before = kernel::lanes::load(nearness + k);
    const kernel::lanes::FourMask nearer = here > before;
    kernel::lanes::store(nearer ? here : before, nearness + k);
    FourItems shown;
    std::memcpy(&shown, items + k, sizeof shown);
    shown = __builtin_convertvector(nearer, FourItems) != 0 ? FourItems{} + item : shown;
    std::memcpy(items + k, &shown, sizeof shown);
  }
  for (; k < count; ++k) {
    const double here = slope * (first + 2.0 * k) + rest;
    if (!(here > nearness[k])) continue;
    nearness[k] = here;
    items[k] = item;
  }
}

}  // namespace

void ItemBuffer::start(const HemicubePixels& pixels) {
  pixels_ = &pixels;
  n_ = pixels.resolution();
  items_.assign(pixels.count(), kNothing);
  nearness_.assign(pixels.count(), 0.0);
}

void ItemBuffer::draw(const SeenItem& seen) {
  const double sign = seen.clockwise ? 1.0 : -1.0;
  sides_.clear();
  for (std::size_t k = 0; k < seen.corners.size(); ++k) {
    sides_.push_back(cross(seen.corners[k], seen.corners[k + 1 < seen.corners.size() ? k + 1 : 0]) * sign);
  }
  for (int face = 0; face < kHemicubeFaces; ++face) {
    Span columns{}, rows{};
    if (clip_to_frustum(seen, face, columns, rows)) draw_on(face, seen, columns, rows);
  }
}

// The pixels to test: those around the clipped polygon, and one more on every side for rounding errors.
bool ItemBuffer::clip_to_frustum(const SeenItem& seen, int face, Span& columns, Span& rows) {
  polygon_.clear();
  for (const Vec3& p : seen.corners) polygon_.push_back(turn_to(face, p));
  const Outcodes codes = outcodes(face, polygon_);
  if (codes.all != 0) return false;
  for (std::size_t side = 0; side < 4; ++side) {
    if ((codes.any >> side & 1U) == 0) continue;
    clip_by(face, side, polygon_, clipped_);
    polygon_.swap(clipped_);
  }
  if (polygon_.empty()) return false;
  double left = 1.0, right = -1.0, low = 1.0, high = -1.0;
  for (const Vec3& p : polygon_) {
    if (!(p.z > 0.0)) continue;  // at x itself
    const double a = std::clamp(p.x / p.z, -1.0, 1.0), b = std::clamp(p.y / p.z, -1.0, 1.0);
    left = std::min(left, a);
    right = std::max(right, a);
    low = std::min(low, b);
    high = std::max(high, b);
  }
  const auto place = [this](double t) { return static_cast<int>(std::floor((t + 1.0) * 0.5 * n_)); };
  const int base = face == 0 ? 0 : n_ / 2;
  columns = {std::max(0, place(left) - 1), std::min(n_ - 1, place(right) + 1)};
  rows = {std::max(0, place(low) - base - 1), std::min(pixels_->rows(face) - 1, place(high) - base + 1)};
  return !columns.empty() && !rows.empty();
}

void ItemBuffer::draw_on(int face, const SeenItem& seen, const Span& columns, const Span& rows) {
  forms_.clear();
  for (const Vec3& side : sides_) {
    const Vec3 turned = turn_to(face, side);
    forms_.push_back({turned.x, turned.y, turned.z * n_});
  }
  const Vec3 near = turn_to(face, seen.nearness);
  for (int row = rows.first; row <= rows.last; ++row) {
    const Span span = inside(row_of(face, row), columns);
    if (span.empty()) continue;
    const double near_in_row = near.y * row_of(face, row) + near.z * n_;
    const std::size_t start = pixels_->first(face) + static_cast<std::size_t>(row) * static_cast<std::size_t>(n_);
    const std::size_t pixel = start + static_cast<std::size_t>(span.first);
    fill(near.x, column_of(span.first), near_in_row, span.last - span.first + 1, seen.item, &nearness_[pixel],
         &items_[pixel]);
  }
}

// A form is monotone in the column, in floating point too: a division finds the approximate column of its sign change,
// and the form itself decides.
ItemBuffer::Span ItemBuffer::inside(double row, Span columns) const {
  for (const Form& form : forms_) {
    const double rest = form.row * row + form.depth;
    if (form.column == 0.0) {
      if (rest < 0.0 || (rest == 0.0 && !(form.row > 0.0))) return {1, 0};
      continue;
    }
    const bool rising = form.column > 0.0;
    const auto holds = [&](int column) {
      const double value = form.column * column_of(column) + rest;
      return rising ? value >= 0.0 : value > 0.0;
    };
    const double crossing = (n_ - 1 - rest / form.column) * 0.5;
    int at = static_cast<int>(std::clamp(crossing, columns.first - 1.0, columns.last + 1.0));
    if (rising) {
      while (at > columns.first && holds(at - 1)) --at;
      while (at <= columns.last && (at < columns.first || !holds(at))) ++at;
      columns.first = std::max(columns.first, at);
    } else {
      while (at < columns.last && holds(at + 1)) ++at;
      while (at >= columns.first && (at > columns.last || !holds(at))) --at;
      columns.last = std::min(columns.last, at);
    }
    if (columns.empty()) break;
  }
  return columns;
}

}  // namespace exactff::methods
