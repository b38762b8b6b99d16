// A scene as plain data that can be transformed, divided and written, with the receiver and source that it is intended
// for. Nothing is checked here: SceneBuilder and the readers check.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff::models {

using Ring = std::vector<std::uint32_t>;

// One face: the outer ring first, then holes (even-odd).
struct PlainFace {
  std::vector<Ring> rings;
};

struct PlainPatch {
  std::string name;
  std::string material;  // name in PlainScene::materials; empty: none
  std::vector<PlainFace> faces;
};

struct PlainScene {
  std::vector<std::string> comments;
  std::vector<Material> materials;
  std::vector<Vec3> vertices;
  std::vector<PlainPatch> patches;
  std::string source = "source";
  Vec3 point;
  Vec3 normal{0.0, 0.0, 1.0};

  // Adds a face. Its corners become new vertices.
  void add_ring(PlainPatch& patch, const std::vector<Vec3>& corners);
  void add_rings(PlainPatch& patch, const std::vector<std::vector<Vec3>>& rings);
  [[nodiscard]] PlainPatch& patch(std::string_view name);  // the patch of that name; created if it does not exist
};

// The shortest decimal that reads back to the same double, or 17 significant digits.
enum class Digits { kShortest, kSeventeen };

// Returns Wavefront OBJ text. Comment lines state receiver and source. A face with holes becomes one keyhole ring,
// because OBJ has no holes. `mtl` is the file name after mtllib; empty: none.
[[nodiscard]] std::string to_obj(const PlainScene& scene, const std::string& mtl = {},
                                 Digits digits = Digits::kShortest);
[[nodiscard]] std::string to_mtl(const PlainScene& scene);
[[nodiscard]] std::string to_text(double value, Digits digits = Digits::kShortest);

// Joins the rings of one face along bridges into a single ring that bounds the same region. Requires that the rings lie
// in one plane and do not meet: who makes the face knows that.
[[nodiscard]] Ring keyhole(const std::vector<Vec3>& vertices, const PlainFace& face);

// Builds the scene with SceneBuilder, and throws what it throws. For a scene without holes the hash is the same as
// after writing with to_obj() and to_mtl() and reading. `name` stands for the file in messages.
[[nodiscard]] Scene build(const PlainScene& scene, const std::string& name = {}, const SceneOptions& options = {});
[[nodiscard]] Receiver receiver_of(const PlainScene& scene);

}  // namespace exactff::models
