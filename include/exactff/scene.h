// A scene: named patches of planar polygonal faces with materials, held exactly as they were given.
//
// A Scene is immutable and safe to share between threads. SceneBuilder makes one from vertices and
// faces; read_obj (obj.h) makes one from a Wavefront file.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "exactff/error.h"
#include "exactff/geometry.h"

namespace exactff {

enum class PatchId : std::uint32_t {};
enum class FaceId : std::uint32_t {};
enum class MaterialId : std::uint32_t {};
// Every scene made in a process has a number of its own, from 1; a scene that is moved keeps it.
enum class SceneId : std::uint64_t {};
inline constexpr SceneId kAnyScene{0};

template <class Id>
requires std::is_enum_v<Id>
constexpr std::size_t index_of(Id id) { return static_cast<std::size_t>(id); }

struct Material {
  std::string name;
  Rgb reflectance{1.0, 1.0, 1.0};  // Kd
  Rgb radiosity{0.0, 0.0, 0.0};    // Ke

  [[nodiscard]] bool emits() const { return radiosity.largest() > 0.0; }
};

// How a face entered the scene.
enum class FaceShape {
  kPlanar,        // exactly planar: kept as the polygon it is
  kTriangulated,  // not exactly planar: cut into triangles, each exact
  kZeroArea,      // all vertices on one line: ignored
  kSkipped,       // unusable, dropped on request (--skip-bad-faces)
};

struct Face {
  PatchId patch{};
  MaterialId material{};
  std::uint32_t number = 0;  // k of NAME:k: from 1 within its patch in file order, ignored ones counted
  FaceShape shape = FaceShape::kPlanar;
  std::size_t line = 0;  // where the file defines it; 0 if made by the API
  // Vertex indices; the first ring is the outer one, the others are holes. The front is the side from
  // which the outer ring runs counter-clockwise.
  std::vector<std::vector<std::uint32_t>> rings;
  std::uint32_t first_piece = 0;  // into Scene::pieces()
  std::uint32_t piece_count = 0;
  // Half the outer ring's Newell vector, correctly rounded: the front normal, as long as the ring's area. Where the
  // largest component is not within [2^-900, 2^1000) the vector is first scaled into [1/2, 1) by a power of two.
  Vec3 newell;
  double area = 0.0;          // square of the scene's unit of length; an estimate, clamped to positive doubles
  double out_of_plane = 0.0;  // largest distance of a vertex from the mean plane over the diameter (estimate)
};

struct Patch {
  std::string name;
  std::vector<FaceId> faces;
};

// A convex, exactly planar part of a face with at least three corners and positive area. Corners run
// counter-clockwise seen from the face's front; corners in the middle of a straight side are possible.
// The pieces of a face do not overlap and together make up the face exactly.
struct Piece {
  FaceId face{};
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
  std::uint32_t frame[3] = {0, 0, 0};  // vertex indices of three corners not on a line, in order
};

// What a name selects: a whole patch, or one of its faces (NAME:k). Wherever a selection is taken, one that a scene
// made is refused for another scene, and so are ids that the scene does not have (std::invalid_argument).
struct Selection {
  PatchId patch{};
  std::optional<FaceId> face;
  SceneId scene = kAnyScene;  // that made it; not compared

  friend bool operator==(const Selection& a, const Selection& b) { return a.patch == b.patch && a.face == b.face; }
};

class Scene {
 public:
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  [[nodiscard]] SceneId id() const;
  [[nodiscard]] std::span<const Vec3> vertices() const;
  [[nodiscard]] std::span<const Material> materials() const;
  [[nodiscard]] std::span<const Patch> patches() const;
  [[nodiscard]] std::span<const Face> faces() const;
  [[nodiscard]] std::span<const Piece> pieces() const;
  [[nodiscard]] std::span<const std::uint32_t> corners(const Piece& piece) const;

  [[nodiscard]] const Patch& patch(PatchId id) const { return patches()[index_of(id)]; }
  [[nodiscard]] const Face& face(FaceId id) const { return faces()[index_of(id)]; }
  [[nodiscard]] const Material& material(MaterialId id) const { return materials()[index_of(id)]; }
  [[nodiscard]] std::span<const Piece> pieces_of(FaceId id) const;

  // The faces that a selection stands for (ignored and skipped ones left out).
  [[nodiscard]] std::vector<FaceId> faces_of(const Selection& selection) const;

  // "NAME" or "NAME:k"; an exact patch name wins. Throws InputError that names the closest patches.
  [[nodiscard]] Selection select(std::string_view name) const;
  [[nodiscard]] std::string name_of(const Selection& selection) const;
  [[nodiscard]] std::string name_of(FaceId face) const;  // "NAME:k", or "NAME" for a patch of one face

  // Every patch with a face that emits, in file order.
  [[nodiscard]] std::vector<Selection> emitters() const;

  // B_s of a source: its Ke, or 1 in each channel where it emits nothing. Throws InputError if faces
  // of the selection differ in Ke.
  [[nodiscard]] Rgb source_radiosity(const Selection& source) const;
  // rho_r of a receiver on `face`: Kd of that face; (1,1,1) for a free receiver. A face that the scene does not have is
  // refused (std::invalid_argument).
  [[nodiscard]] Rgb receiver_reflectance(std::optional<FaceId> face) const;

  // The same scene with the faces of the selections turned round: their fronts become their backs. A face that several
  // of them name is turned once.
  [[nodiscard]] Scene with_flipped(std::span<const Selection> selections) const;
  [[nodiscard]] Scene with_flipped(const Selection& selection) const { return with_flipped(std::span(&selection, 1)); }

  // What the builder found worth saying, in file order.
  [[nodiscard]] std::span<const Problem> warnings() const;

  // 64-bit FNV-1a hash over everything that affects values: vertices, rings, names,
  // materials; 16 lower-case hexadecimal digits.
  [[nodiscard]] std::string hash() const;

  // Edges that an odd number of faces use, by vertex position: none in a closed solid.
  [[nodiscard]] std::size_t open_edge_count() const;

  struct Data;
  [[nodiscard]] const Data& data() const;  // for the library's own modules

 private:
  friend class SceneBuilder;
  explicit Scene(std::unique_ptr<Data> data);
  std::unique_ptr<Data> data_;
};

enum class BadFaces { kReject, kSkip };
enum class PatchMode { kGroups, kFaces };  // --patches faces: every face becomes a patch NAME:k

struct SceneOptions {
  BadFaces bad_faces = BadFaces::kReject;
  PatchMode patches = PatchMode::kGroups;
};

// Collects vertices, materials, patches and faces, then checks and freezes them. Any finite double is
// legal; a NaN or infinite coordinate is an input error.
class SceneBuilder {
 public:
  explicit SceneBuilder(std::string file = {}, SceneOptions options = {});
  SceneBuilder(SceneBuilder&&) noexcept;
  SceneBuilder& operator=(SceneBuilder&&) noexcept;
  ~SceneBuilder();

  std::uint32_t add_vertex(const Vec3& position);
  [[nodiscard]] std::size_t vertex_count() const;
  MaterialId add_material(Material material);
  PatchId patch(std::string_view name);  // the patch of that name, made if it is new
  // Rings of vertex indices, the outer one first; orientation of holes is irrelevant (even-odd). The vertices may
  // follow later. Throws std::invalid_argument for a patch or material that this builder has not made.
  void add_face(PatchId patch, MaterialId material, std::vector<std::vector<std::uint32_t>> rings,
                std::size_t line = 0);
  void warn(Problem warning);

  // Checks every face, triangulates what is not planar or not convex, and freezes the scene. Throws one
  // InputError with all problems found. The builder is empty afterwards.
  [[nodiscard]] Scene build();

 private:
  struct State;
  [[nodiscard]] State& state() const;
  std::unique_ptr<State> state_;
};

}  // namespace exactff
