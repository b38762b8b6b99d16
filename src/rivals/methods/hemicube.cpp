// The hemicube: M. F. Cohen and D. P. Greenberg, "The Hemi-Cube: A Radiosity Solution for Complex Environments" (1985).
//
//   1. half a cube is placed on x, its top perpendicular to the normal, turned about the normal by an angle;
//   2. every face of the scene except the receiver's own is drawn into the item buffers of the cube's five faces;
//   3. the form factor of a face is the sum of the delta form factors of the pixels that show its front;
//   4. each transparent face is drawn on top of the others, counted, and taken off again.
// One item buffer serves all sources. Here coplanar faces hide each other like any face in front: see hemicube.h for
// which one wins.
#include "methods/hemicube.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>

#include "adaptive/sampled_scene.h"
#include "kernel/expect.h"
#include "kernel/lanes.h"
#include "kernel/poll.h"
#include "methods/method_files.h"

namespace exactff::methods {

using kernel::lanes::Four;

using namespace adaptive;

namespace {

constexpr int kHighestResolution = 4096;

struct Frame {
  Vec3 u, v, n;

  [[nodiscard]] Vec3 operator()(const Vec3& p) const { return {dot(u, p), dot(v, p), dot(n, p)}; }
};

// At 0 degrees u is the axis that the normal is furthest from (the first of equals), made perpendicular to it; the
// angle turns u towards v = n x u.
Frame frame_about(const Vec3& n, double degrees) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const Vec3 axis = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  const Vec3 off = axis - n * dot(axis, n);
  const Vec3 u = off * (1.0 / length(off));
  if (degrees == 0.0) return {u, cross(n, u), n};
  const double angle = degrees * (std::numbers::pi / 180.0);
  const Vec3 turned = u * std::cos(angle) + cross(n, u) * std::sin(angle);
  return {turned, cross(n, turned), n};
}

// The number of items at the beginning that are equal to the first one.
std::size_t run_length(std::span<const std::uint32_t> items) {
  const std::uint32_t item = items[0];
  std::size_t length = 1;
  // Four at a time without a branch between them.
  while (length + 4 <= items.size() && ((items[length] ^ item) | (items[length + 1] ^ item) |
                                        (items[length + 2] ^ item) | (items[length + 3] ^ item)) == 0) {
    length += 4;
  }
  while (length < items.size() && items[length] == item) ++length;
  return length;
}

// Four sums in parallel, because each addition waits for the previous one.
double sum_of(std::span<const double> values) {
  double sums[4] = {};
  std::size_t k = 0;
  for (; k + 4 <= values.size(); k += 4) {
    for (std::size_t lane = 0; lane < 4; ++lane) sums[lane] += values[k + lane];
  }
  for (; k < values.size(); ++k) sums[0] += values[k];
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

class HemicubeOnScene;

class Hemicube : public Evaluator {
 public:
  Hemicube(const HemicubeOnScene& on_scene, const HemicubePixels& pixels, double rotation)
      : on_scene_(on_scene), pixels_(pixels), rotation_(rotation) {}

  void look_from(const Receiver& receiver) override;
  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& source) override;

 private:
  struct Share {
    double form_factor = 0.0;
    std::uint64_t pixels = 0;
  };

  void render(const ReceiverView& view);
  void draw(std::uint32_t piece, const ReceiverView& view);
  void draw_transparent_faces(const ReceiverView& view);
  template <class Counts>
  void add_up(const Counts& counts);

  const HemicubeOnScene& on_scene_;
  const HemicubePixels& pixels_;
  double rotation_;
  Frame frame_;
  std::vector<Vec3> points_;   // of the scene, in the frame
  std::vector<Vec3> corners_;  // of the current piece
  std::vector<char> front_;    // by piece: x is in front of it
  ItemBuffer buffer_;
  std::vector<Share> shares_;  // by face
  std::uint64_t drawn_ = 0;
};

struct HemicubeSource : PreparedSource {
  HemicubeSource(const Scene& scene, const Selection& chosen) : PreparedSource(chosen), faces(scene.faces_of(chosen)) {}
  std::vector<FaceId> faces;
};

class HemicubeOnScene : public PreparedScene {
 public:
  explicit HemicubeOnScene(const Scene& given) : PreparedScene(given), scaled(given) {
    for (const Piece& piece : given.pieces()) {
      const std::vector<Vec3>& p = scaled.points;
      normals.push_back(plane_normal(p[piece.frame[0]], p[piece.frame[1]], p[piece.frame[2]]));
      has_transparent_faces = has_transparent_faces || piece.transparent;
    }
  }

  [[nodiscard]] std::unique_ptr<PreparedSource> prepare_source(const Selection& selection) const override {
    return std::make_unique<HemicubeSource>(scene(), selection);
  }

  [[nodiscard]] std::unique_ptr<Evaluator> configure(const Settings& settings) const override {
    const kernel::StandardArithmetic arithmetic;
    return std::make_unique<Hemicube>(*this, pixels(static_cast<int>(settings.whole("resolution"))),
                                      settings.number("rotation"));
  }

  const ScaledScene scaled;
  std::vector<Normal> normals;  // by piece
  bool has_transparent_faces = false;

 private:
  // Made once per resolution.
  const HemicubePixels& pixels(int resolution) const {
    const std::scoped_lock lock(mutex_);
    return pixels_.try_emplace(resolution, resolution).first->second;
  }

  mutable std::mutex mutex_;
  mutable std::map<int, HemicubePixels> pixels_;
};

void Hemicube::look_from(const Receiver& receiver) {
  const kernel::StandardArithmetic arithmetic;
  const ReceiverView view = view_from(receiver, on_scene_.scaled);
  shares_.assign(on_scene_.scene().faces().size(), {});
  drawn_ = 0;
  if (max_norm(view.point) > kFarthest) return;
  render(view);
  add_up([&](std::uint32_t) { return true; });
  if (on_scene_.has_transparent_faces) draw_transparent_faces(view);
}

void Hemicube::render(const ReceiverView& view) {
  frame_ = frame_about(view.unit_normal, rotation_);
  points_.clear();
  for (const Vec3& p : on_scene_.scaled.points) points_.push_back(frame_(p - view.point));
  buffer_.start(pixels_);
  const auto pieces = on_scene_.scene().pieces();
  front_.assign(pieces.size(), 0);
  for (std::uint32_t k = 0; k < pieces.size(); ++k) {
    if (!pieces[k].transparent && !view.is_own(k)) draw(k, view);
  }
}

void Hemicube::draw_transparent_faces(const ReceiverView& view) {
  const auto pieces = on_scene_.scene().pieces();
  const ItemBuffer opaque = buffer_;
  for (std::uint32_t k = 0; k < pieces.size(); ++k) {
    if (!pieces[k].transparent || view.is_own(k)) continue;
    draw(k, view);
    if (k + 1 < pieces.size() && pieces[k + 1].face == pieces[k].face) continue;
    add_up([&](std::uint32_t item) { return pieces[item].face == pieces[k].face; });
    buffer_ = opaque;
  }
}

// The plane's form is computed in the scene's coordinates, with a normal whose largest component is 1. So a plane
// parallel to two axes has the same form to the last bit, whichever of its pieces it is computed from.
void Hemicube::draw(std::uint32_t index, const ReceiverView& view) {
  const Piece& piece = on_scene_.scene().pieces()[index];
  corners_.clear();
  bool above = false;
  for (const std::uint32_t v : on_scene_.scene().corners(piece)) {
    corners_.push_back(points_[v]);
    above = above || points_[v].z > 0.0;
  }
  if (!above) return;
  kernel::poll();
  const int side = side_of_x(view, on_scene_.scaled, piece, on_scene_.normals[index]);
  if (side == 0) return;
  front_[index] = side > 0 ? 1 : 0;
  const Vec3& given = on_scene_.normals[index].value;
  const double largest = max_norm(given);
  if (!(largest > 0.0)) return;
  const Vec3 normal{given.x / largest, given.y / largest, given.z / largest};
  const double distance = std::abs(dot(normal, view.point - on_scene_.scaled.points[piece.frame[0]]));
  const double sign = side > 0 ? -1.0 : 1.0;
  const double scale = sign / std::max(distance, std::numeric_limits<double>::min());
  buffer_.draw({corners_, side < 0, frame_(normal) * scale, index});
  ++drawn_;
}

// Adds up pixels in runs that show the same piece, of the pieces that count.
template <class Counts>
void Hemicube::add_up(const Counts& counts) {
  const auto pieces = on_scene_.scene().pieces();
  const std::vector<std::uint32_t>& items = buffer_.items();
  for (std::size_t first = 0, next = 0; first < items.size(); first = next) {
    const std::uint32_t item = items[first];
    next = first + run_length({items.data() + first, items.size() - first});
    if (item == ItemBuffer::kNothing || front_[item] == 0 || !counts(item)) continue;
    Share& share = shares_[index_of(pieces[item].face)];
    share.form_factor += sum_of({pixels_.form_factors().data() + first, next - first});
    share.pixels += next - first;
  }
}

Estimate Hemicube::form_factor(const PreparedSource& source) {
  const kernel::StandardArithmetic arithmetic;
  Estimate result;
  std::uint64_t pixels = 0;
  for (const FaceId face : own<HemicubeSource>(source).faces) {
    result.form_factor += shares_[index_of(face)].form_factor;
    pixels += shares_[index_of(face)].pixels;
  }
  result.form_factor = move_into_range(result.form_factor, Formula::kUnit);
  result.counters.add("pixels", pixels);
  result.counters.add("pixels drawn", pixels_.count());
  result.counters.add("polygons", drawn_);
  return result;
}

}  // namespace

Method hemicube_method() {
  return {.name = "hemicube",
          .summary = "the scene is drawn on the pixels of half a cube; the form factor of each pixel is exact",
          .source = "M. F. Cohen and D. P. Greenberg, The Hemi-Cube (1985)",
          .settings = {whole_setting("resolution", 100, 2, kHighestResolution,
                                     "pixels along a side of the top face; the side faces have half as many rows",
                                     "pixels", 2),
                       number_setting("rotation", 0.0, -360.0, 360.0, "rotation about the normal", "degrees")},
          .all_sources_at_once = true,
          .prepare = prepare_as<HemicubeOnScene>};
}

// --- Item buffer ---

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

// --- Hemicube pixels ---

HemicubePixels::HemicubePixels(int resolution) : resolution_(resolution), form_factors_(count()) {
  EXACTFF_EXPECT(resolution >= 2 && resolution % 2 == 0);
  set_top();
  set_sides();
}

std::size_t HemicubePixels::first(int face) const {
  const auto n = static_cast<std::size_t>(resolution_);
  return face == 0 ? 0 : n * n + static_cast<std::size_t>(face - 1) * (n / 2 * n);
}

// Of each eight pixels that are equal by mirror symmetry, one is computed.
void HemicubePixels::set_top() {
  const int n = resolution_, half = n / 2;
  const auto line = [n](int i) { return static_cast<double>(2 * i - n) / n; };
  const auto set = [&](int row, int column, double f) {
    form_factors_[static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column)] = f;
  };
  for (int row = 0; row < half; ++row) {
    for (int column = 0; column <= row; ++column) {
      const double u0 = line(column), u1 = line(column + 1), v0 = line(row), v1 = line(row + 1);
      const SubPatch pixel = make_sub_patch(std::array<Vec3, 4>{{{u0, v0, 1}, {u0, v1, 1}, {u1, v1, 1}, {u1, v0, 1}}});
      const double f = unoccluded_form_factor(pixel, {0, 0, 1});
      for (const auto& [a, b] : {std::pair(row, column), std::pair(column, row)}) {
        for (const int i : {a, n - 1 - a}) {
          set(i, b, f);
          set(i, n - 1 - b, f);
        }
      }
    }
  }
}

// Of each two pixels of the first side, one is computed; the other sides are equal to the first.
void HemicubePixels::set_sides() {
  const int n = resolution_, half = n / 2;
  double* const side = form_factors_.data() + first(1);
  const auto at = [&](int row, int column) -> double& {
    return side[static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column)];
  };
  for (int row = 0; row < half; ++row) {
    const double n0 = 2.0 * row / n, n1 = 2.0 * (row + 1) / n;
    for (int column = 0; column < half; ++column) {
      const double v0 = static_cast<double>(2 * column - n) / n, v1 = static_cast<double>(2 * (column + 1) - n) / n;
      const SubPatch pixel = make_sub_patch(std::array<Vec3, 4>{{{1, v0, n0}, {1, v0, n1}, {1, v1, n1}, {1, v1, n0}}});
      at(row, column) = at(row, n - 1 - column) = unoccluded_form_factor(pixel, {0, 0, 1});
    }
  }
  const std::size_t size = first(2) - first(1);
  for (int face = 2; face < kHemicubeFaces; ++face) std::copy_n(side, size, form_factors_.data() + first(face));
}

}  // namespace exactff::methods
