// A scene as plain data that can be turned over, cut up and written out, with the receiver and source it is
// meant for. Nothing is checked here: SceneBuilder and the readers do that.
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
  std::string material;  // of PlainScene::materials; empty: none
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

  // Each adds its corners as new vertices.
  void add_ring(PlainPatch& patch, const std::vector<Vec3>& corners);
  void add_rings(PlainPatch& patch, const std::vector<std::vector<Vec3>>& rings);
  [[nodiscard]] PlainPatch& patch(std::string_view name);  // of that name, made if it is new
};

// The shortest decimal that reads back to the same double, or 17 significant digits.
enum class Digits { kShortest, kSeventeen };

// Wavefront text. Comment lines state receiver and source. A face with holes becomes one keyhole ring, for OBJ
// has no holes. `mtl` is the file named after mtllib; empty: none.
[[nodiscard]] std::string to_obj(const PlainScene& scene, const std::string& mtl = {},
                                 Digits digits = Digits::kShortest);
[[nodiscard]] std::string to_mtl(const PlainScene& scene);
[[nodiscard]] std::string to_text(double value, Digits digits = Digits::kShortest);

// The rings of one face joined along bridges into a single ring that bounds the same region. Requires rings that
// meet nowhere, in one plane.
[[nodiscard]] Ring keyhole(const std::vector<Vec3>& vertices, const PlainFace& face);

// Through SceneBuilder; throws what it throws. Without holes it has the hash that to_obj() and to_mtl() read back to.
// `name` stands for the file in messages.
[[nodiscard]] Scene build(const PlainScene& scene, const std::string& name = {}, const SceneOptions& options = {});
[[nodiscard]] Receiver receiver_of(const PlainScene& scene);

// Every coordinate times `factor` (the normal stays); exact for powers of two short of under- and overflow.
void scale(PlainScene& scene, double factor);

}  // namespace exactff::models
