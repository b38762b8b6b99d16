// A scene: named patches of planar polygonal faces with materials. Coordinates are kept exactly as given.
//
// A Scene is immutable and safe to share between threads. SceneBuilder makes one from vertices and
// faces; read_scene (scene_files.h) makes one from a file.
#pragma once

#include <cstdint>
#include <filesystem>
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
// Every scene made in a process has its own number, counted from 1. A scene that is moved keeps it.
enum class SceneId : std::uint64_t {};

// A unit of length. Scenes need none; it is kept for people and for files.
enum class Unit { kNone, kMillimetre, kCentimetre, kMetre, kInch, kFoot };
[[nodiscard]] std::string_view name_of(Unit unit);     // "mm", "cm", "m", "in", "ft"; "" for none
[[nodiscard]] double metres(Unit unit);                // in one of it, rounded once; 1 for none
[[nodiscard]] Unit unit_named(std::string_view text);  // throws InputError for another text

// A face may have two sets of texture coordinates, 0 and 1.
inline constexpr int kTextureSets = 2;

template <class Id>
requires std::is_enum_v<Id>
constexpr std::size_t index_of(Id id) { return static_cast<std::size_t>(id); }

struct Material {
  std::string name;
  Rgb reflectance{1.0, 1.0, 1.0};  // Kd
  Rgb radiosity{0.0, 0.0, 0.0};    // Ke
  // What the file says about transparency: "d 0.3", "Tr 0.7" or "illum 7"; empty if nothing. No value depends on it;
  // the scene's warnings name the faces that nevertheless occlude.
  std::string see_through = {};
  std::string file = {};  // the place of that statement
  std::size_t line = 0;

  [[nodiscard]] bool emits() const { return radiosity.largest() > 0.0; }
};

// How a face entered the scene.
enum class FaceShape {
  kPlanar,        // exactly planar: kept as the polygon it is
  kTriangulated,  // not exactly planar: cut into triangles, each exact
  kZeroArea,      // all vertices on one line: ignored
  kSkipped,       // unusable, dropped on request (--skip-bad-faces)
};

// What the normals in the file (vn) say about the front of a face. The winding alone decides; this is for diagnoses.
enum class FileNormals {
  kNone,        // nothing, or they lie within about 6 degrees of the face's plane
  kAgree,       // they point to the front
  kContradict,  // they point to the back
};

struct Face {
  PatchId patch{};
  MaterialId material{};
  std::uint32_t number = 0;  // k of NAME:k: counted from 1 within its patch in file order, ignored faces included
  FaceShape shape = FaceShape::kPlanar;
  std::size_t line = 0;  // line of its definition in the file; 0 if made by the API
  // Vertex indices. The first ring is the outer one, the others are holes. The front is the side from which the outer
  // ring runs counter-clockwise.
  std::vector<std::vector<std::uint32_t>> rings;
  std::uint32_t first_piece = 0;  // index into Scene::pieces()
  std::uint32_t piece_count = 0;
  // Half the outer ring's Newell vector, correctly rounded: it points to the front, and its length is the area of the
  // outer ring. If its largest component is not within [2^-900, 2^1000), the vector is first scaled by a power of two
  // so that this component lies in [1/2, 1).
  Vec3 newell;
  double area = 0.0;          // in the square of the scene's unit of length; an estimate, clamped to positive doubles
  double out_of_plane = 0.0;  // largest distance of a vertex from the mean plane, divided by the diameter (estimate)
  bool transparent = false;   // occludes nothing; may be a source, and receivers may lie on it
  bool flipped = false;       // Scene::with_flipped has turned it round
  bool is_twin = false;       // the other side of a face, made by matrix::with_two_sided; it belongs to no solid
  FileNormals file_normals = FileNormals::kNone;
};

struct Patch {
  std::string name;
  std::vector<FaceId> faces;
};

// A convex, exactly planar part of a face, with at least three corners and positive area. Corners run counter-clockwise
// as seen from the face's front; some may lie in the middle of a straight side. The pieces of a face do not overlap and
// together cover the face exactly.
struct Piece {
  FaceId face{};
  std::uint32_t first_corner = 0;
  std::uint32_t corner_count = 0;
  std::uint32_t frame[3] = {0, 0, 0};  // vertex indices of three corners not on a line, in order
  bool transparent = false;            // as its face
};

// The object that a name selects: a whole patch, or one of its faces (NAME:k). Functions that take a selection throw
// std::invalid_argument if it was made by another scene or has ids that the scene does not have.
struct Selection {
  PatchId patch{};
  std::optional<FaceId> face;
  SceneId scene;  // that it is of; not compared

  friend bool operator==(const Selection& a, const Selection& b) { return a.patch == b.patch && a.face == b.face; }
};

// Buried. Where solids touch, parts of faces neither send nor receive light: the floor under a box, the bottom of the
// box on the floor of a closed room, both sides of the contact of two boxes. A *solid* is a closed surface; at an edge,
// it goes on to the face that ends the wedge behind a face, so boxes that share edges are two solids. Where a face of a
// solid lies on a face that is not its own, in the same plane and with the opposite front, that face is buried. A solid
// that encloses volume behind its fronts, as a box does, buries parts of any face; a room, with its fronts inside, only
// those of other solids' faces. Not buried are the two sides of a sheet, or of a lamp without thickness, the party wall
// of two rooms, anything on a floor that is no part of a closed surface, and what touches transparent faces. Decided
// exactly; the whole rule is in scene/contacts.h.
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

  // Texture coordinates, for lightmaps (render.h): one for each corner of the face, through all rings in order; empty
  // if the face has none in this set. No other value depends on them, nor does hash(). They are kept by all functions
  // that change faces: new corners on an edge or in a face get coordinates between those of the ends of the cut on
  // which they lie, in doubles. Where a face returns to a position, that position's first coordinates count for its
  // parts. Throws std::invalid_argument for a face that the scene does not have, and for another set.
  [[nodiscard]] std::span<const TexturePoint> texture(FaceId face, int set = 0) const;
  [[nodiscard]] bool has_texture(int set = 0) const;  // of any face

  // The faces of a selection, without ignored and skipped ones.
  [[nodiscard]] std::vector<FaceId> faces_of(const Selection& selection) const;

  // Selects "NAME" or "NAME:k". A patch whose name is exactly the text has priority. Throws InputError that lists the
  // closest patch names if nothing matches.
  [[nodiscard]] Selection select(std::string_view name) const;
  // The same, and if no patch is called NAME, all patches NAME:1, NAME/2, ... and NAME:k:1, ...: the cells of a divided
  // patch, or those of PatchMode. If there are none, and the text is a pattern, all patches whose names
  // match it, as fnmatch(3) says: * stands for any text, ? for one character, [...] for one of several, and \ makes the
  // next character an ordinary one. If no patch matches, all faces NAME:k that do. Patches without area are left out if
  // others match. In the order of the file.
  [[nodiscard]] std::vector<Selection> select_all(std::string_view name) const;
  // Whether the text has one of the characters * ? [.
  [[nodiscard]] static bool is_pattern(std::string_view name);
  [[nodiscard]] std::string name_of(const Selection& selection) const;
  [[nodiscard]] std::string name_of(FaceId face) const;  // "NAME:k", or "NAME" for a patch of one face
  // Faces of one patch: "NAME:1+2", in their order; "" for none.
  [[nodiscard]] std::string name_of(std::span<const FaceId> faces) const;

  // Every patch that has an emitting face, in file order.
  [[nodiscard]] std::vector<Selection> emitters() const;

  // B_s of a source: its Ke, or 1 in each channel if it emits nothing. Throws InputError if faces of the selection
  // differ in Ke.
  [[nodiscard]] Rgb source_radiosity(const Selection& source) const;
  // rho_r of a receiver with these own faces (Receiver::on): Kd of the first; (1,1,1) for a receiver that lies on no
  // face. Throws std::invalid_argument if the scene does not have that face.
  [[nodiscard]] Rgb receiver_reflectance(std::span<const FaceId> on) const;

  // The same scene with the faces of the selections turned round: their fronts become their backs. A face in several
  // selections is turned once.
  [[nodiscard]] Scene with_flipped(std::span<const Selection> selections) const;
  [[nodiscard]] Scene with_flipped(const Selection& selection) const { return with_flipped(std::span(&selection, 1)); }

  // The same scene with the faces of the selections transparent: they occlude nothing, and light passes through them
  // unchanged. They may still be sources and have receivers on them.
  [[nodiscard]] Scene with_transparent(std::span<const Selection> selections) const;

  // What with_flipped and with_transparent have changed: a patch if all its faces with area were changed, else its
  // faces.
  [[nodiscard]] std::vector<Selection> flipped() const;
  [[nodiscard]] std::vector<Selection> transparent() const;

  // Warnings: first those about materials that let light through, but occlude here (Material::see_through); then those
  // of the builder, in file order.
  [[nodiscard]] std::span<const Problem> warnings() const;

  // 64-bit FNV-1a hash over everything that affects values: vertices, rings, names, materials, transparent faces. 16
  // lower-case hexadecimal digits.
  [[nodiscard]] std::string hash() const;

  // Of its coordinates. Temperatures, and conductors for ESATAN, depend on it; no other value does, nor hash().
  [[nodiscard]] Unit unit() const;
  // The same scene with this unit stated. No coordinate changes.
  [[nodiscard]] Scene with_unit(Unit unit) const;

  // The files that it was read from: its own and its MTL files. None for a scene that was generated or built.
  [[nodiscard]] std::span<const std::filesystem::path> files() const;

  // Number of edges that an odd number of faces use, matched by vertex positions. A closed solid has none.
  [[nodiscard]] std::size_t open_edge_count() const;

 private:
  // The library's own sources reach the private parts of a public class through a friend. A private header defines it:
  // here scene/scene.h.
  friend struct SceneInside;
  friend class SceneBuilder;
  struct Data;
  [[nodiscard]] const Data& data() const;
  explicit Scene(std::unique_ptr<Data> data);
  void set_warnings_of_glass();
  std::unique_ptr<Data> data_;
};

enum class BadFaces { kReject, kSkip };
// What a patch is. In the last three, the patches of a group NAME are NAME/1, NAME/2, ... by falling area; areas that
// are the same float are ordered by the lowest of their vertices (by x, then y, then z) in which they differ. So names
// do not depend on the order of faces. Faces of a group are neighbours if they have an edge in common, by the positions
// of its ends. Faces without area belong to NAME/1.
enum class PatchMode {
  kGroups,  // a group of the file
  kFaces,   // every face, NAME:k
  kPlanes,  // neighbours in exactly one plane, with their fronts on one side
  kSmooth,  // neighbours whose fronts differ by less than an angle; decided exactly
  kParts,   // neighbours
};

struct SceneOptions {
  BadFaces bad_faces = BadFaces::kReject;
  PatchMode patches = PatchMode::kGroups;
  double smooth_degrees = 30.0;  // from 0 to 180
  Unit unit = Unit::kNone;       // of a file that does not state its own
  // Coordinates are multiplied by the exact ratio of the file's unit and this one, and rounded once, with a warning
  // that counts them. An InputError if the unit of the file is not known.
  Unit convert_to = Unit::kNone;
};
// "groups", "faces", "planes", "smooth", "smooth:20" (degrees), "parts". Throws InputError for another text.
[[nodiscard]] SceneOptions scene_options(std::string_view patches, BadFaces bad_faces = BadFaces::kReject);

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
  PatchId patch(std::string_view name);  // the patch of this name, created if it is new
  // Rings of vertex indices, the outer ring first. The orientation of holes is irrelevant (even-odd rule). The vertices
  // may be added later. Throws std::invalid_argument for a patch or material that this builder has not made.
  void add_face(PatchId patch, MaterialId material, std::vector<std::vector<std::uint32_t>> rings,
                std::size_t line = 0);
  // The face added last is the other side of another one (Face::is_twin).
  void mark_as_twin();
  // The normal that the file states for the face added last, of any length (Face::file_normals).
  void state_normal(const Vec3& normal);
  // Texture coordinates of the face added last, one for each corner through all rings in order (Scene::texture); none
  // if one of them is not finite. Throws std::invalid_argument for another number of them, or another set.
  void state_texture(int set, std::vector<TexturePoint> corners);
  void warn(Problem warning);
  void set_unit(Unit unit);  // instead of SceneOptions::unit
  // The scene was read from this file, too (Scene::files).
  void read_from(std::filesystem::path file);

  // Checks every face, triangulates faces that are not planar or not convex, and freezes the scene. Throws one
  // InputError with all problems found. The builder is empty afterwards.
  [[nodiscard]] Scene build();

 private:
  struct State;
  [[nodiscard]] State& state() const;
  std::unique_ptr<State> state_;
};

// --- Names of faces ---

// A name for the faces that a selector finds, of those with area. A selector is one of
//   box:X0,Y0,Z0,X1,Y1,Z1   faces with all corners in the box
//   normal:X,Y,Z[:DEGREES]  faces whose front is within the angle (default 5) of the direction, or at it; exact
//   plane:A,B,C,D[:DISTANCE]  faces with all corners at most that far (default 0: exactly) from A x + B y + C z = D
//   NAME:1-20,25            faces of a patch by number
//   NAME                    what Scene::select_all() finds
// or several with " & " between them: the faces that all of them find.
struct FaceName {
  std::string name;
  std::string selector;
};
[[nodiscard]] FaceName face_name(std::string_view text);  // "NAME=SELECTOR"; throws InputError for another text
// The same scene in which these faces are patches of these names, new or existing. All selectors are about the given
// scene; of two that find a face, the later one counts. Faces are numbered anew; patches that are left without faces
// vanish. A warning names patches that are merged. Throws InputError for a selector that cannot be read or finds
// nothing.
[[nodiscard]] Scene with_names(const Scene& scene, std::span<const FaceName> names);
// The same scene with other patches (PatchMode), each group of which is a patch of the given scene.
[[nodiscard]] Scene with_patches(const Scene& scene, const SceneOptions& patches);

// --- Cells ---

// A scene whose faces are cut into cells, each a patch.
struct DividedScene {
  Scene scene;
  std::size_t faces_cut = 0;
  std::size_t cells = 0;  // with the faces that are not cut
  // A bound to within rounding of how far corners of cells lie from where they belong: from the plane of their face,
  // and along edges from the point that was rounded. In the scene's unit of length.
  double largest_deviation = 0.0;
};

// Cuts every face into cells, no side of which is longer than `length` (but for one part in 10^9). Cells of the patch
// NAME are patches NAME:1, NAME:2, ..., which Scene::select_all("NAME") finds; a lone cell keeps its name. Corners are
// rounded to doubles once, and all faces along an edge that is cut share its points, T-junctions included, so closed
// surfaces stay closed. A cell is exactly planar: one that rounding bends is cut into triangles, with a side that may
// be longer. Faces without area are left out; what is flipped or transparent stays so. Throws InputError for a length
// that is not positive or that would make more than 4 million cells, and if a patch has a name that a cell of another
// could have.
[[nodiscard]] DividedScene divided(const Scene& scene, double length);

// --- Gaps ---

// A scene in which corners that almost meet are one.
struct WeldedScene {
  // Faces that lie closer to each other than the length, face to face. They stay two.
  struct Sheets {
    Selection one, other;  // faces of the new scene
    double apart =
        0.0;  // the largest distance found, an estimate; 0 if the faces had different corners and now share all
  };
  Scene scene;
  std::size_t corners_before = 0, corners = 0;  // positions
  double largest_move = 0.0;                    // of a corner; in the scene's unit of length
  std::size_t junctions = 0;                    // corners added to an edge of a face, each counted once a face
  std::vector<FaceId> vanished;                 // faces of the given scene that have no area any more
  std::vector<Sheets> sheets;                   // at most one for two patches
};

// Corners linked by distances of at most `length` (decided exactly) become one. Each coordinate is the lower median of
// theirs. Edges that leave an axis by less than about that become parallel to it, so walls along axes are planar again.
// Where an open edge passes an end of another one within `length`, the face gets it as a corner. These steps are
// repeated until they change nothing, so welding again with the same length changes nothing. The result does not
// depend on the order of faces and vertices. Faces that are not exactly planar then
// are their triangles (FaceShape). Faces never merge. Those without area are left out; what is flipped or transparent
// stays so. Throws InputError for a length that is not positive, and for one so large that a corner would move by more
// than eight times of it.
[[nodiscard]] WeldedScene welded(const Scene& scene, double length);

// The smallest length, to about two digits, with which welded() leaves the fewest open edges (Scene::open_edge_count).
// Tried are lengths up to 1/256 of the scene's size and 1/16 of the median open edge that make no face vanish but
// slivers. What exact T-junctions leave open is no gap; nor is what parts free sheets, unless it is a rounding.
struct Gap {
  double length = 0.0;
  std::size_t open_edges_before = 0, open_edges = 0;
};
// Nothing if no such length closes any.
[[nodiscard]] std::optional<Gap> gap(const Scene& scene);

// Every face cut into triangles at its own vertices: a face that is not planar into those that it stands for (see
// SceneBuilder). Patches, materials and what is transparent stay, and so does every form factor between patches. Faces
// are numbered anew; those without area, and skipped ones, are left out.
[[nodiscard]] Scene triangulated(const Scene& scene);

// What a scene contains, patch by patch: the rows of `exactff info`. For people who look at a scene; estimates.
struct PatchSummary {
  std::string name;
  std::size_t face_count = 0;         // including ignored faces
  double area = 0.0;                  // in the square of the scene's unit of length; finite
  std::optional<Vec3> front;          // mean unit normal; empty if the faces have different directions
  std::vector<MaterialId> materials;  // in the order of first use
  bool emits = false;
  Vec3 centre = {}, low = {}, high = {};  // of its area, and the box of its faces with area
};

[[nodiscard]] PatchSummary summarise(const Scene& scene, PatchId id);
// Of every patch, in the order of the scene.
[[nodiscard]] std::vector<PatchSummary> summarise(const Scene& scene);
// The sum of the patches' areas; finite.
[[nodiscard]] double total_area(const std::vector<PatchSummary>& rows);

}  // namespace exactff
