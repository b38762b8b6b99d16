// STL, in text and in binary: triangles, each with its own copy of its vertices.
//
// Vertices become one vertex only if their doubles are equal. The stored normals do not count: the front of a triangle
// is the side from which its vertices run counter-clockwise, as STL prescribes.
#include "formats/stl.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "files/numpy.h"
#include "formats/mesh_input.h"
#include "formats/writers.h"
#include "kernel/vec.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::formats {
namespace {

// --- Reader ---

// Adds triangles to the scene.
class Triangles {
 public:
  explicit Triangles(MeshInput& input) : input_(input), positions_(input) {}

  void add(PatchId patch, const std::array<Vec3, 3>& corners, const FilePlace& place) {
    std::vector<std::uint32_t> ring;
    for (const Vec3& corner : corners) ring.push_back(positions_.vertex(corner, place));
    input_.add_face(patch, input_.no_material(), std::move(ring), place);
  }

 private:
  MeshInput& input_;
  SharedVertices positions_;
};

// Keywords are recognised in any case and need not be alone on their lines.
class StlTextReader {
 public:
  StlTextReader(std::string_view text, MeshInput& input) : input_(input), lines_(text), triangles_(input) {}

  Scene run() {
    while (lines_.next(line_)) {
      rest_ = line_.text;
      while (read_statement()) continue;
    }
    if (in_facet_) fail("the file ends within a facet", "a triangle has three vertices", "is the file complete?");
    input_.warn_if_cut_off(lines_, line_.number);
    return input_.build();
  }

 private:
  // False at the end of the line.
  bool read_statement() {
    const std::string_view word = text::take_word(rest_);
    if (word.empty()) return false;
    if (same(word, "vertex")) {
      read_vertex();
    } else if (same(word, "facet")) {
      start_facet();
    } else if (same(word, "endfacet")) {
      end_facet();
    } else if (same(word, "outer")) {
      expect("loop");
    } else if (same(word, "solid")) {
      start_solid();
      return false;
    } else if (!same(word, "endloop")) {
      if (!same(word, "endsolid"))
        fail("unknown keyword " + text::in_quotes(word), "it is no part of an STL file", "correct or remove the line");
      return false;
    }
    return true;
  }

  // The name is the rest of the line.
  void start_solid() {
    ++solids_;
    patch_.reset();
    const std::string_view name = text::trimmed(rest_);
    if (!name.empty()) {
      name_ = name;
    } else if (solids_ == 1) {
      name_ = kDefaultPatch;
    } else {
      numbered_ = "solid_" + std::to_string(solids_);
      name_ = numbered_;
    }
  }

  void start_facet() {
    if (in_facet_) fail("a facet within a facet", "endfacet is missing", "correct it");
    in_facet_ = true;
    facet_line_ = line_.number;
    corner_count_ = 0;
    expect("normal");
    for (int i = 0; i < 3; ++i) (void)text::take_word(rest_);
  }

  void read_vertex() {
    const Vec3 position = input_.take_point(rest_, line_.number, "write vertex x y z");
    if (!in_facet_) return fail("a vertex outside a facet", "it belongs to no triangle", "write facet before it");
    if (corner_count_ < 3) corners_[corner_count_] = position;
    ++corner_count_;
  }

  void end_facet() {
    if (!in_facet_) return fail("endfacet without a facet", "there is no triangle to end", "write facet before it");
    in_facet_ = false;
    if (corner_count_ != 3) {
      return fail("a facet has " + text::counted(corner_count_, "vertex", "vertices"), "it is a triangle",
                  "write three vertices");
    }
    if (!patch_) patch_ = input_.patch(name_);
    triangles_.add(*patch_, corners_, at_line(facet_line_));
  }

  static bool same(std::string_view word, std::string_view keyword) {
    const auto equal = [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; };
    return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(), equal);
  }
  void expect(std::string_view keyword) {
    const std::string_view word = text::take_word(rest_);
    if (same(word, keyword)) return;
    fail(text::in_quotes(word) + " instead of " + std::string(keyword), "the line is not a line of an STL file",
         "correct it");
  }
  void fail(std::string what, std::string why, std::string suggestion) {
    input_.fail(at_line(line_.number), std::move(what), std::move(why), std::move(suggestion));
  }

  MeshInput& input_;
  text::PlainLines lines_;
  text::TextLine line_;
  std::string_view rest_;
  Triangles triangles_;
  std::size_t solids_ = 0;
  std::string_view name_ = kDefaultPatch;  // of the current solid
  std::string numbered_;
  std::optional<PatchId> patch_;  // made at its first face
  bool in_facet_ = false;
  std::size_t facet_line_ = 0;
  std::array<Vec3, 3> corners_{};
  std::size_t corner_count_ = 0;
};

// The numbers of the triangle that begins at `offset`: a normal and three vertices.
using Numbers = std::array<float, 12>;

std::array<Vec3, 3> corners_at(std::string_view bytes, std::size_t offset) {
  Numbers n{};
  files::read_little_endian(bytes.substr(offset), std::span<float>(n));
  return {Vec3{n[3], n[4], n[5]}, Vec3{n[6], n[7], n[8]}, Vec3{n[9], n[10], n[11]}};
}

}  // namespace

Scene read_stl_text(std::string_view text, const std::filesystem::path& path, const SceneOptions& options) {
  MeshInput input(path, options, "an STL file");
  return StlTextReader(text, input).run();
}

Scene read_stl_binary(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& options) {
  MeshInput input(path, options, "an STL file");
  if (bytes.size() < StlLayout::kHead) {
    input.give_up(at_byte(bytes.size()), "the file ends within its header of 84 bytes",
                  "a binary STL file begins with 80 bytes and the number of triangles", "is the file complete?");
  }
  const std::size_t count = StlLayout::triangle_count(bytes);
  const std::size_t held = (bytes.size() - StlLayout::kHead) / StlLayout::kTriangle;
  if (count > held) {
    input.give_up(at_byte(StlLayout::kTitle), "the file declares " + text::counted(count, "triangle"),
                  "its length is enough for " + std::to_string(held), "is it a complete binary STL file?");
  }
  if (count == 0) {
    input.give_up(at_byte(StlLayout::kTitle), "the file declares 0 triangles",
                  held == 0 ? "there is nothing to compute with"
                            : "its length is enough for " + text::counted(held, "triangle") +
                                  ", so its program did not write the number",
                  held == 0 ? "export the scene again"
                            : "export the scene again, or write the number into the 4 bytes from byte 80 on");
  }
  Triangles triangles(input);
  const PatchId patch = input.default_patch();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t offset = StlLayout::kHead + i * StlLayout::kTriangle;
    const std::array<Vec3, 3> corners = corners_at(bytes, offset);
    if (std::all_of(corners.begin(), corners.end(), kernel::is_finite)) {
      triangles.add(patch, corners, at_byte(offset));
    } else {
      input.fail(at_byte(offset), "triangle " + std::to_string(i + 1) + " has a coordinate that is not finite",
                 "a coordinate is one exact number", "give finite coordinates");
    }
  }
  if (bytes.size() > StlLayout::kHead + count * StlLayout::kTriangle) {
    input.warn(at_byte(StlLayout::kHead + count * StlLayout::kTriangle), "the file goes on after its last triangle",
               "the rest is ignored", "is the number of triangles in its header right?");
  }
  return input.build();
}

// --- Writer: in text with doubles and one solid for each patch; in binary with floats ---

namespace {

// The unit normal, for programs that look at it; zero if the arithmetic of doubles finds none.
Vec3 rough_normal(const std::array<Vec3, 3>& corners) {
  Vec3 a = kernel::difference(corners[1], corners[0]), b = kernel::difference(corners[2], corners[0]);
  for (Vec3* const v : {&a, &b}) {
    const double size = kernel::max_norm(*v);
    if (!(size > 0.0) || !std::isfinite(size)) return {};
    *v = {v->x / size, v->y / size, v->z / size};
  }
  const Vec3 n = kernel::cross(a, b);
  const double length = std::hypot(n.x, n.y, n.z);
  if (!(length > 0.0)) return {};
  return {n.x / length + 0.0, n.y / length + 0.0, n.z / length + 0.0};
}

std::array<Vec3, 3> corners_of(const Scene& scene, const OutputFace& face) {
  const auto& vertices = scene.vertices();
  return {vertices[face.corners[0]], vertices[face.corners[1]], vertices[face.corners[2]]};
}

void append_facet(std::string& out, const std::array<Vec3, 3>& corners) {
  append_point(out, "  facet normal ", rough_normal(corners));
  out += "    outer loop\n";
  for (const Vec3& corner : corners) append_point(out, "      vertex ", corner);
  out += "    endloop\n  endfacet\n";
}

// Places in the list of faces, for each patch.
std::vector<std::vector<std::size_t>> faces_by_patch(const Scene& scene, const std::vector<OutputFace>& faces) {
  std::vector<std::vector<std::size_t>> places(scene.patches().size());
  for (std::size_t i = 0; i < faces.size(); ++i) places[index_of(scene.face(faces[i].face).patch)].push_back(i);
  return places;
}

bool is_float(double value) { return static_cast<double>(static_cast<float>(value)) == value; }

void tell_rounding(const Scene& scene, Losses& losses) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  std::size_t rounded = 0;
  for (const Vec3& v : scene.vertices()) {
    if (kernel::max_norm(v) > kLargest) {
      text::refuse(losses.file(), "a coordinate exceeds the largest float", "binary STL has only floats",
                   "write STL as text, or PLY");
    }
    if (!is_float(v.x) || !is_float(v.y) || !is_float(v.z)) ++rounded;
  }
  if (rounded == 0) return;
  losses.add(text::counted_of(rounded, scene.vertices().size(), "vertice") + (rounded == 1 ? " is" : " are") +
                 " moved by rounding",
             "binary STL has floats, not doubles, so faces may lose their plane or their area",
             "write STL as text, or PLY, to keep the coordinates");
}

}  // namespace

std::string write_stl_text(const Scene& scene, Losses& losses) {
  const std::vector<OutputFace> faces = output_faces(scene, Polygons::kTriangles, "STL", losses);
  const std::vector<std::string> patches = output_names(patch_names(scene), {}, "patch", losses);
  losses.add_materials(scene, "STL");
  const auto places = faces_by_patch(scene, faces);
  std::string out;
  for (std::size_t patch = 0; patch < patches.size(); ++patch) {
    if (places[patch].empty()) continue;
    out += "solid " + patches[patch] + '\n';
    for (const std::size_t place : places[patch]) append_facet(out, corners_of(scene, faces[place]));
    out += "endsolid " + patches[patch] + '\n';
  }
  return out;
}

std::string write_stl_binary(const Scene& scene, Losses& losses) {
  const std::vector<OutputFace> faces = output_faces(scene, Polygons::kTriangles, "STL", losses);
  losses.add_materials(scene, "STL");
  if (!has_only_default_patch(scene))
    losses.add("the patches and their names are lost", "binary STL has none", "write STL as text to keep them");
  tell_rounding(scene, losses);
  std::string out = "written by " + text::program_version();
  out.resize(StlLayout::kTitle, ' ');
  const auto count = static_cast<std::uint32_t>(faces.size());
  out += files::little_endian(std::span(&count, 1));
  for (const OutputFace& face : faces) {
    const auto [a, b, c] = corners_of(scene, face);
    Numbers numbers{};
    auto next = numbers.begin();
    for (const Vec3& v : {rough_normal({a, b, c}), a, b, c})
      for (const double number : {v.x, v.y, v.z}) *next++ = static_cast<float>(number);
    (out += files::little_endian(std::span<const float>(numbers))).append(2, '\0');
  }
  return out;
}

}  // namespace exactff::formats
