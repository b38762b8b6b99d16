// What the readers of all formats share: the scene being built, and the problems found so far; and these readers.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "exactff/scene.h"
#include "text/text_lines.h"

namespace exactff::formats {

inline constexpr std::string_view kDefaultPatch = "default";
inline constexpr std::string_view kNoMaterial = "(none)";
inline constexpr std::string_view kObstruction = "(obstruction)";  // material of View3D surfaces that only hide others

// A place in a file: a line of text, or a byte of binary data, counted from 0.
struct FilePlace {
  std::size_t line = 0;
  std::optional<std::size_t> byte;
};
inline FilePlace at_line(std::size_t number) { return {number, std::nullopt}; }
inline FilePlace at_byte(std::size_t offset) { return {0, offset}; }

// A whole number in decimal, with or without a sign; nothing if the word is none or does not fit.
[[nodiscard]] std::optional<std::int64_t> whole_number(std::string_view word);

class MeshInput {
 public:
  enum class Materials { kNoneFirst, kOfReader };  // the first one is no_material(), or all are the reader's

  // `kind` completes "give ..." and "is it ...?": "a PLY file".
  MeshInput(const std::filesystem::path& path, const SceneOptions& options, std::string kind,
            Materials materials = Materials::kNoneFirst);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] SceneBuilder& builder() { return builder_; }
  [[nodiscard]] text::ProblemList& problems() { return problems_; }
  [[nodiscard]] std::size_t vertex_count() const { return builder_.vertex_count(); }
  [[nodiscard]] MaterialId no_material() const { return MaterialId{0}; }  // Kd 1, Ke 0

  void fail(const FilePlace& place, std::string what, std::string why, std::string suggestion);
  void warn(const FilePlace& place, std::string what, std::string why, std::string suggestion);
  // For problems after which nothing in the file has a meaning. Those collected before are thrown with it.
  [[noreturn]] void give_up(const FilePlace& place, std::string what, std::string why, std::string suggestion);

  // Removes three words from the front of `words` and reads them as coordinates. A faulty one is collected and read
  // as 0. `usage` says how the line is to be written: "write v x y z".
  Vec3 take_point(std::string_view& words, std::size_t line, const char* usage);
  std::uint32_t add_vertex(const Vec3& position, const FilePlace& place);

  PatchId patch(std::string_view name) { return builder_.patch(name); }
  PatchId default_patch();
  MaterialId material(Material material) { return builder_.add_material(std::move(material)); }
  // False, with a problem, if it has fewer than three and bad faces are rejected.
  bool is_polygon(std::size_t corners, const FilePlace& place);
  void add_face(PatchId patch, MaterialId material, std::vector<std::uint32_t> ring, const FilePlace& place,
                std::vector<std::vector<std::uint32_t>> holes = {});

  // Warns if the last line of a text has no end.
  template <class Lines>
  void warn_if_cut_off(const Lines& lines, std::size_t last_line) {
    if (!lines.is_cut_off()) return;
    warn(at_line(last_line), "the last line does not end with a newline", "the file may have been cut off there",
         "add a newline if the file is complete");
  }
  // Throws the problems collected, or one if there are no faces.
  [[nodiscard]] Scene build();

 private:
  [[nodiscard]] Problem problem(const FilePlace& place, std::string what, std::string why,
                                std::string suggestion) const;

  std::string file_;
  SceneOptions options_;
  std::string kind_;
  SceneBuilder builder_;
  text::ProblemList problems_;
  std::optional<PatchId> default_patch_;  // made at its first face
  std::size_t face_count_ = 0;
};

// --- Shared vertices ---

struct HashOfPosition {
  // Differs from run to run, so that no file can be made of positions of one hash. The numbers do not depend on it.
  std::uint64_t seed = static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());

  std::size_t operator()(const Vec3& position) const;
};

// Vertices of files that repeat them for every triangle. Positions are one vertex if their doubles are equal, so 0 and
// -0 are; in the order of their first appearance.
class SharedVertices {
 public:
  explicit SharedVertices(MeshInput& input) : input_(input) {}

  std::uint32_t vertex(const Vec3& position, const FilePlace& place);

 private:
  MeshInput& input_;
  std::unordered_map<Vec3, std::uint32_t, HashOfPosition> numbers_;
};

// --- Several files ---

// The files that `path` means: see scene_files.h.
[[nodiscard]] std::vector<std::filesystem::path> files_named(const std::filesystem::path& path);
[[nodiscard]] Scene read_several(const std::filesystem::path& path, const std::vector<std::filesystem::path>& files,
                                 const SceneOptions& options);

// --- Readers ---

// With the unit that the file states, if it does.
[[nodiscard]] SceneOptions with_unit_of(std::string_view bytes, SceneOptions options);

// The readers, each of one format. `bytes` is the whole file, `path` names it in messages.

// Each throws InputError with all problems found.
[[nodiscard]] Scene read_obj(std::string_view text, const std::filesystem::path& path, const SceneOptions& options);
// `bytes`: a .gltf file, or a .glb file.
[[nodiscard]] Scene read_gltf(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& options);
[[nodiscard]] Scene read_off(std::string_view text, const std::filesystem::path& path, const SceneOptions& options);
[[nodiscard]] Scene read_ply(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& options);
[[nodiscard]] Scene read_stl_text(std::string_view text, const std::filesystem::path& path,
                                  const SceneOptions& options);
[[nodiscard]] Scene read_stl_binary(std::string_view bytes, const std::filesystem::path& path,
                                    const SceneOptions& options);
[[nodiscard]] Scene read_view3d(std::string_view text, const std::filesystem::path& path, const SceneOptions& options);

}  // namespace exactff::formats
