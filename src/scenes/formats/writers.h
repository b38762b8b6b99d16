// The writers, each of one format. They return the bytes of the file and add what it does not hold to `losses`.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"

namespace exactff::formats {

// What a format does not hold of a scene, as warnings about the file to be written.
class Losses {
 public:
  explicit Losses(const std::filesystem::path& path) : file_(path.string()) {}

  void add(std::string what, std::string why, std::string suggestion) {
    problems_.push_back({file_, 0, std::move(what), std::move(why), std::move(suggestion)});
  }
  // For formats without materials: adds Kd and Ke of the faces, if they are not 1 and 0.
  void add_materials(const Scene& scene, const std::string& format);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] std::vector<Problem> take() { return std::move(problems_); }

 private:
  std::string file_;
  std::vector<Problem> problems_;
};

// The shortest decimals that read back to the same doubles: "START x y z", and a line end.
void append_point(std::string& out, std::string_view start, const Vec3& point);
// "COMMENT unit mm", which readers of the format find; empty if the scene states no unit.
[[nodiscard]] std::string unit_line(const Scene& scene, const std::string& comment);

[[nodiscard]] bool needs_mtl(const Scene& scene);
// `mtl` is the name of the material file; empty if there is none.
[[nodiscard]] std::string write_obj(const Scene& scene, const std::string& mtl, Losses& losses);
// To be called with the same scene: material names are changed in the same way.
[[nodiscard]] std::string write_mtl(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_off(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_ply_text(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_ply_binary(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_stl_text(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_stl_binary(const Scene& scene, Losses& losses);
[[nodiscard]] std::string write_view3d(const Scene& scene, Losses& losses);

// --- Output faces ---

// The faces of a scene as polygons that a format can hold.

enum class Polygons {
  kAny,          // any number of corners, not always convex or planar, but without holes
  kFourCorners,  // convex and planar
  kTriangles,
};

struct OutputFace {
  FaceId face{};
  std::vector<std::uint32_t> corners;
};

// Their number, and the numbers of the vertices, counted from 0.
[[nodiscard]] std::string corner_words(const OutputFace& face);

// In the order of the faces. A face that does not fit is cut at its own vertices, exactly. Faces that cannot be used
// are left out. Faces without area are kept as they are, if the format can hold them. `format` is its name in messages.
[[nodiscard]] std::vector<OutputFace> output_faces(const Scene& scene, Polygons polygons, const std::string& format,
                                                   Losses& losses);

// --- Output names ---

// Names as a format can hold them.

// No format holds line breaks, zero bytes, blanks at the ends of a name, or an empty name.
struct NameRules {
  bool one_word = false;          // no blanks
  char comment = '\0';            // begins a comment
  bool only_before_word = false;  // ... only at the beginning of a word
  bool joins_lines = false;       // a backslash at the end of a line joins it with the next
};

// The names in their order, with '_' for what the format does not hold. They stay distinct. Tells what has changed;
// `noun` says what is named: "patch".
[[nodiscard]] std::vector<std::string> output_names(std::vector<std::string> names, const NameRules& rules,
                                                    const std::string& noun, Losses& losses);

[[nodiscard]] std::vector<std::string> patch_names(const Scene& scene);
// True if all faces are in one patch with the name of faces that belong to none.
[[nodiscard]] bool has_only_default_patch(const Scene& scene);

// The name as the format can hold it.
[[nodiscard]] std::string fit_name(std::string name, const NameRules& rules);

}  // namespace exactff::formats
