#include "fuzz/scene_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "fuzz/scene_bytes_format.h"
#include "generate/vectors.h"
#include "kernel/vec.h"

namespace exactff::validation {

using generate::PlainFace;
using generate::PlainPatch;
using generate::PlainScene;
using generate::Ring;
using generate::operator+;
using generate::operator-;
using generate::operator*;

namespace scene_bytes {
namespace {

using Rings = std::vector<Corners>;
using kernel::is_finite;

struct DecodedFace {
  std::size_t patch = 0;  // 0 is the source
  Rings rings;
  bool keyhole = false;
};

class Decoder {
 public:
  explicit Decoder(std::span<const std::uint8_t> bytes) : in_(bytes) {}

  FuzzCase run() {
    FuzzCase out;
    (void)in_.next();  // the corpus has a byte here
    out.seed = in_.next();
    read_header();
    while (!in_.done() && faces_.size() < kMaxFaces && corner_count() < kMaxCorners) instruction();
    place_receiver_on_faces();
    out.scene = scene();
    return out;
  }

 private:
  void read_header() {
    place_ = static_cast<Place>(in_.below(kPlaceCount));
    if (place_ == Place::kLattice) point_ = in_.lattice_point();
    if (place_ == Place::kRaw) point_ = in_.raw_point();
    const auto kind = static_cast<NormalKind>(in_.below(kNormalCount));
    if (kind == NormalKind::kLattice) normal_ = in_.lattice_point();
    if (kind == NormalKind::kRaw) normal_ = in_.raw_point();
    if (normal_ == Vec3{}) normal_.z = 1.0;
    // Most sources have one face.
    const std::size_t size = in_.next();
    source_faces_ = size < 192 ? 1 : size - 190;
    exponent_ = static_cast<std::int8_t>(in_.next());
    merge_corners_ = in_.below(2) == 1;
  }

  // --- corners ---

  // A new corner or an existing one.
  Vec3 corner() {
    const std::uint8_t choice = in_.next();
    if (choice < 160 || faces_.empty()) return in_.lattice_point();
    return some_corner(choice);
  }

  [[nodiscard]] Vec3 some_corner(std::size_t choice) const {
    const DecodedFace& face = faces_[choice % faces_.size()];
    const Corners& ring = face.rings.front();
    return ring[choice / faces_.size() % ring.size()];
  }

  // --- instructions ---

  void instruction() {
    const std::uint8_t byte = in_.next();
    const auto op = static_cast<Op>(byte % kOpCount);
    flags_ = static_cast<std::uint8_t>(byte / kOpCount);
    switch (op) {
      case Op::kSpike:
        return add_spike();
      case Op::kIdleCorner:
        return add_idle_corner();
      case Op::kNudge:
        return nudge();
      case Op::kSlide:
        return slide();
      case Op::kTiles:
        return add_tiles();
      default:
        return add(new_face(op));
    }
  }

  Rings new_face(Op op) {
    switch (op) {
      case Op::kParallelogram:
        return {parallelogram()};
      case Op::kRectangle:
        return {flat_rectangle()};
      case Op::kStar:
        return {polygon(true)};
      case Op::kRing:
        return {polygon(false)};
      case Op::kFrame:
        return frame();
      case Op::kCopy:
        return copy();
      case Op::kCover:
        return cover();
      case Op::kThroughReceiver:
        return {through_receiver()};
      case Op::kNeighbour:
        return {neighbour()};
      case Op::kRaw:
        return raw_rings();
      default:
        return {triangle()};
    }
  }

  Corners triangle() {
    const Vec3 a = corner();
    const Vec3 b = corner();
    return {a, b, corner()};
  }

  Corners parallelogram() {
    const Vec3 a = corner();
    const Vec3 b = corner();
    const Vec3 c = corner();
    return {a, b, b + (c - a), c};
  }

  Corners flat_rectangle() {
    const Plane where = in_.plane();
    return in_.rectangle().corners(where);
  }

  // Corners in one plane, in any order or sorted around their middle.
  Corners polygon(bool sorted) {
    const Plane where = in_.plane();
    std::vector<std::pair<double, double>> flat(3 + in_.below(6));
    double u_sum = 0.0;
    double v_sum = 0.0;
    for (auto& [u, v] : flat) {
      u = in_.coordinate();
      v = in_.coordinate();
      u_sum += u;
      v_sum += v;
    }
    const auto count = static_cast<double>(flat.size());
    const auto angle = [&](const auto& p) { return std::atan2(p.second - v_sum / count, p.first - u_sum / count); };
    if (sorted) std::ranges::stable_sort(flat, [&](const auto& p, const auto& q) { return angle(p) > angle(q); });
    Corners out;
    for (const auto& [u, v] : flat) out.push_back(where.at(u, v));
    return out;
  }

  // A rectangle with one or two holes, which may touch it or each other.
  Rings frame() {
    const Plane where = in_.plane();
    const Rectangle outer = in_.rectangle();
    Rings out{outer.corners(where)};
    const std::size_t holes = 1 + in_.below(2);
    for (std::size_t i = 0; i < holes; ++i) {
      const std::size_t left = in_.below(16);
      const std::size_t low = in_.below(16);
      const std::size_t right = left + 1 + in_.below(16 - left);
      const std::size_t high = low + 1 + in_.below(16 - low);
      out.push_back(outer.part(left, low, right, high).corners(where));
      if ((flags_ & kOther) != 0) out.back().pop_back();  // a triangle
      std::ranges::reverse(out.back());
    }
    return out;
  }

  // A copy of a face, at the same place or one lattice step away.
  Rings copy() {
    if (faces_.empty()) return {triangle()};
    Rings out = faces_[in_.below(faces_.size())].rings;
    if ((flags_ & kOther) == 0) return out;
    const Vec3 step = in_.lattice_point();
    for (Corners& ring : out) {
      for (Vec3& v : ring) v = v + step;
    }
    return out;
  }

  // A face moved along its rays towards the receiver or away from it: its shadow has the same sides.
  Rings cover() {
    if (faces_.empty()) return {triangle()};
    constexpr std::array kFactors{0.5, 0.25, 0.75, 2.0, 0x1p-30, -0.5, 1.0, 1.0 / 3.0};
    Rings out = faces_[in_.below(faces_.size())].rings;
    const double factor = kFactors[in_.below(kFactors.size())];
    for (Corners& ring : out) {
      for (Vec3& v : ring) v = point_ + factor * (v - point_);
    }
    return out;
  }

  // A parallelogram with the receiver at a corner, on a side, inside, or only in its plane.
  Corners through_receiver() {
    const Vec3 u = corner() - point_;
    const Vec3 v = corner() - point_;
    const auto at = [&](double s, double t) { return point_ + (s * u + t * v); };
    switch (in_.below(4)) {
      case 0:
        return {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
      case 1:
        return {at(-1, 0), at(1, 0), at(1, 1), at(-1, 1)};
      case 2:
        return {at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)};
      default:
        return {at(1, 0), at(1, 1), at(0, 1)};
    }
  }

  // A face that shares a side, or a part of one, with another face.
  Corners neighbour() {
    if (faces_.empty()) return triangle();
    const Corners& ring = faces_[in_.below(faces_.size())].rings.front();
    const std::size_t i = in_.below(ring.size());
    const Vec3 a = ring[i];
    Vec3 b = ring[(i + 1) % ring.size()];
    if ((flags_ & kOther) != 0) b = a + 0.5 * (b - a);
    return {b, a, corner()};
  }

  // A rectangle in four tiles of one patch, some of them missing.
  void add_tiles() {
    const Plane where = in_.plane();
    const Rectangle whole = in_.rectangle();
    const std::size_t missing = in_.below(16);
    const std::size_t u = 1 + in_.below(15);
    const std::size_t v = 1 + in_.below(15);
    const std::array parts{whole.part(0, 0, u, v), whole.part(u, 0, 16, v), whole.part(0, v, u, 16),
                           whole.part(u, v, 16, 16)};
    for (std::size_t k = 0; k < parts.size(); ++k) {
      if ((missing >> k & 1) == 0) add({parts[k].corners(where)});
      flags_ |= kSamePatch;
    }
  }

  Rings raw_rings() {
    Rings out(1 + in_.below(kMaxRings));
    for (Corners& ring : out) {
      ring.resize(3 + in_.below(kMaxRingCorners - 2));
      for (Vec3& v : ring) v = in_.raw_point();
    }
    return out;
  }

  void add(Rings rings) {
    if (!std::ranges::all_of(rings, [](const Corners& ring) { return std::ranges::all_of(ring, &is_finite); })) return;
    if ((flags_ & kReversed) != 0) {
      for (Corners& ring : rings) std::ranges::reverse(ring);
    }
    if (faces_.size() >= source_faces_ && (patches_ == 1 || (flags_ & kSamePatch) == 0)) ++patches_;
    faces_.push_back({patches_ - 1, std::move(rings), (flags_ & kKeyhole) != 0});
  }

  // --- changes of the last face ---

  Corners* last_ring() {
    if (faces_.empty()) return nullptr;
    Corners& ring = faces_.back().rings.front();
    return ring.size() < kMaxRingCorners ? &ring : nullptr;
  }

  // A spike from a corner towards another corner or a random point, and back.
  void add_spike() {
    Corners* ring = last_ring();
    if (ring == nullptr) return;
    const std::size_t i = in_.below(ring->size());
    const Vec3 from = (*ring)[i];
    const Vec3 towards = (flags_ & kOther) != 0 ? corner() : (*ring)[in_.below(ring->size())];
    const Vec3 tip = from + 0.5 * (towards - from);
    Corners spike{from};
    if ((flags_ & kReversed) != 0) spike.push_back(from + 0.25 * (towards - from));
    spike.push_back(tip);
    if ((flags_ & kReversed) != 0) spike.push_back(spike[1]);
    ring->insert(ring->begin() + static_cast<std::ptrdiff_t>(i), spike.begin(), spike.end());
  }

  // A repeated corner, or a corner in the middle of a side.
  void add_idle_corner() {
    Corners* ring = last_ring();
    if (ring == nullptr) return;
    const std::size_t i = in_.below(ring->size());
    const Vec3 a = (*ring)[i];
    const Vec3 b = (*ring)[(i + 1) % ring->size()];
    const Vec3 idle = (flags_ & kOther) != 0 ? a : a + 0.5 * (b - a);
    ring->insert(ring->begin() + static_cast<std::ptrdiff_t>(i) + 1, idle);
  }

  void nudge() {
    Corners* ring = last_ring();
    if (ring == nullptr) return;
    Vec3& v = (*ring)[in_.below(ring->size())];
    double& c = component(v, in_.below(3));
    const double towards = (flags_ & kOther) != 0 ? 1e300 : -1e300;
    c = std::nextafter(c, towards);
  }

  void slide() {
    Corners* ring = last_ring();
    if (ring == nullptr) return;
    Vec3& v = (*ring)[in_.below(ring->size())];
    const int exponent = static_cast<std::int8_t>(in_.next()) * ((flags_ & kOther) != 0 ? 7 : 1);
    const Vec3 slid = point_ + std::ldexp(1.0, exponent) * (v - point_);
    if (is_finite(slid)) v = slid;
  }

  // --- the whole ---

  [[nodiscard]] std::size_t corner_count() const {
    std::size_t count = 0;
    for (const DecodedFace& face : faces_) {
      for (const Corners& ring : face.rings) count += ring.size();
    }
    return count;
  }

  // Faces placed relative to the receiver stay where they are: after the change they may or may not meet it.
  void place_receiver_on_faces() {
    if (faces_.empty()) return;
    const Corners& ring = faces_.back().rings.front();
    const Vec3& a = ring[0];
    const Vec3& b = ring[1];
    if (place_ == Place::kCorner) point_ = a;
    if (place_ == Place::kMiddle) point_ = a + 0.5 * (b - a);
    if (place_ == Place::kInPlane) point_ = (a + (a - b)) + (a - ring[2]);
    if (!is_finite(point_)) point_ = {};
  }

  PlainScene scene() const {
    PlainScene out;
    out.point = point_;
    out.normal = normal_;
    for (const DecodedFace& face : faces_) {
      PlainPatch& patch = out.patch(face.patch == 0 ? out.source : std::string("o").append(std::to_string(face.patch)));
      out.add_rings(patch, face.rings);
      if (face.keyhole) join_rings(out.vertices, patch.faces.back());
    }
    if (merge_corners_) merge_corners(out);
    return rescaled(std::move(out));
  }

  static void join_rings(const std::vector<Vec3>& vertices, PlainFace& face) {
    try {
      face.rings = {generate::keyhole(vertices, face)};
    } catch (const std::invalid_argument&) {  // they touch, so no bridge is possible
    }
  }

  // Equal corners become one vertex.
  static void merge_corners(PlainScene& scene) {
    std::map<std::tuple<double, double, double>, std::uint32_t> first;
    std::vector<Vec3> vertices;
    for (PlainPatch& patch : scene.patches) {
      for (PlainFace& face : patch.faces) {
        for (Ring& ring : face.rings) {
          for (std::uint32_t& index : ring) {
            const Vec3& v = scene.vertices[index];
            const auto [entry, is_new] =
                first.try_emplace({v.x, v.y, v.z}, static_cast<std::uint32_t>(vertices.size()));
            if (is_new) vertices.push_back(v);
            index = entry->second;
          }
        }
      }
    }
    scene.vertices = std::move(vertices);
  }

  // Most of the 256 exponents leave the scene unchanged.
  [[nodiscard]] PlainScene rescaled(PlainScene scene) const {
    if (std::abs(exponent_) < 100) return scene;
    PlainScene out = scene;
    generate::scale(out, std::ldexp(1.0, exponent_ > 0 ? (exponent_ - 99) * 36 : (exponent_ + 99) * 36));
    return is_finite(out.point) && std::ranges::all_of(out.vertices, &is_finite) ? out : scene;
  }

  Numbers in_;
  Place place_ = Place::kOrigin;
  Vec3 point_;
  Vec3 normal_{0.0, 0.0, 1.0};
  std::size_t source_faces_ = 1;
  int exponent_ = 0;
  bool merge_corners_ = false;
  std::uint8_t flags_ = 0;
  std::size_t patches_ = 1;
  std::vector<DecodedFace> faces_;
};

Scene build_what_can_be(const PlainScene& plain) {
  SceneBuilder builder({}, {.bad_faces = BadFaces::kSkip});
  for (const Vec3& vertex : plain.vertices) builder.add_vertex(vertex);
  const MaterialId material = builder.add_material({});
  for (const PlainPatch& patch : plain.patches) {
    const PatchId id = builder.patch(patch.name);
    for (const PlainFace& face : patch.faces) builder.add_face(id, material, face.rings);
  }
  return builder.build();
}

// Leaves out the faces that a scene cannot contain.
PlainScene usable_part(const PlainScene& plain) {
  const Scene built = build_what_can_be(plain);
  PlainScene out = plain;
  std::size_t i = 0;  // faces in the order in which they were added
  for (PlainPatch& patch : out.patches) {
    std::vector<PlainFace> usable;
    for (PlainFace& face : patch.faces) {
      if (built.faces()[i++].shape != FaceShape::kSkipped) usable.push_back(std::move(face));
    }
    patch.faces = std::move(usable);
  }
  std::erase_if(out.patches, [](const PlainPatch& patch) { return patch.faces.empty(); });
  return out;
}

}  // namespace
}  // namespace scene_bytes

std::optional<FuzzCase> decode(std::span<const std::uint8_t> bytes) {
  FuzzCase out = scene_bytes::Decoder(bytes).run();
  out.scene = scene_bytes::usable_part(out.scene);
  const bool has_source =
      std::ranges::any_of(out.scene.patches, [&](const PlainPatch& patch) { return patch.name == out.scene.source; });
  return has_source ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace exactff::validation
