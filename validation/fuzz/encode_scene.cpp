#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fuzz/scene_bytes.h"
#include "fuzz/scene_bytes_format.h"

namespace exactff::validation {

using generate::PlainFace;
using generate::PlainPatch;
using generate::PlainScene;
using generate::Ring;

namespace scene_bytes {
namespace {

class Encoder {
 public:
  std::vector<std::uint8_t> run(const PlainScene& scene, Identity identity) {
    const PlainPatch& source = *std::ranges::find(scene.patches, scene.source, &PlainPatch::name);
    for (const PlainPatch& patch : scene.patches) {
      for (const PlainFace& face : patch.faces) count(face);
    }
    put(static_cast<std::size_t>(identity));
    put(1);
    put(static_cast<std::size_t>(Place::kRaw));
    put(scene.point);
    put(static_cast<std::size_t>(NormalKind::kRaw));
    put(scene.normal);
    put(source.faces.size() == 1 ? 0 : source.faces.size() + 190);
    put(0);
    put(0);
    put(scene, source);
    for (const PlainPatch& patch : scene.patches) {
      if (patch.name != scene.source) put(scene, patch);
    }
    return std::move(out_);
  }

 private:
  void count(const PlainFace& face) {
    if (++faces_ > kMaxFaces) throw std::invalid_argument("too many faces to be encoded");
    if (face.rings.size() > kMaxRings) throw std::invalid_argument("too many rings to be encoded");
    for (const Ring& ring : face.rings) {
      if (ring.size() > kMaxRingCorners) throw std::invalid_argument("too many corners to be encoded");
      corners_ += ring.size();
    }
    if (corners_ > kMaxCorners) throw std::invalid_argument("too many corners to be encoded");
  }

  void put(std::size_t value) { out_.push_back(static_cast<std::uint8_t>(value)); }
  void put(const Vec3& v) {
    for (const double c : {v.x, v.y, v.z}) {
      for (int shift = 0; shift < 64; shift += 8) put(std::bit_cast<std::uint64_t>(c) >> shift & 255);
    }
  }
  void put(const PlainScene& scene, const PlainPatch& patch) {
    for (std::size_t f = 0; f < patch.faces.size(); ++f) {
      const std::vector<Ring>& rings = patch.faces[f].rings;
      put(static_cast<std::size_t>(Op::kRaw) + (f > 0 ? kOpCount * kSamePatch : 0));
      put(rings.size() - 1);
      for (const Ring& ring : rings) {
        put(ring.size() - 3);
        for (const std::uint32_t index : ring) put(scene.vertices[index]);
      }
    }
  }

  std::size_t faces_ = 0;
  std::size_t corners_ = 0;
  std::vector<std::uint8_t> out_;
};

}  // namespace
}  // namespace scene_bytes

std::vector<std::uint8_t> encode(const PlainScene& scene, Identity identity) {
  return scene_bytes::Encoder().run(scene, identity);
}

}  // namespace exactff::validation
