// The hemicube: M. F. Cohen and D. P. Greenberg, "The Hemi-Cube: A Radiosity Solution for Complex Environments" (1985).
//
//   1. half a cube is placed on x, its top perpendicular to the normal, turned about the normal by an angle;
//   2. every face of the scene except the receiver's own is drawn into the item buffers of the cube's five faces;
//   3. the form factor of a face is the sum of the delta form factors of the pixels that show its front;
//   4. each transparent face is drawn on top of the others, counted, and taken off again.
// One item buffer serves all sources. Here coplanar faces hide each other like any face in front: see item_buffer.h for
// which one wins.
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>

#include "adaptive/plane_side.h"
#include "adaptive/sampled_scene.h"
#include "adaptive/value_range.h"
#include "kernel/poll.h"
#include "methods/item_buffer.h"
#include "methods/method_files.h"

namespace exactff::methods {

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

}  // namespace exactff::methods
