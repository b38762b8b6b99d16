// STL, in text and in binary: triangles, each with its own copy of its vertices.
//
// Vertices become one vertex only if their doubles are equal. The stored normals do not count: the front of a triangle
// is the side from which its vertices run counter-clockwise, as STL prescribes.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <utility>

#include "formats/mesh_input.h"
#include "formats/position_table.h"
#include "formats/readers.h"
#include "formats/stl_layout.h"
#include "kernel/vec.h"
#include "text/phrases.h"

namespace exactff::formats {

namespace {

// Adds triangles to the scene.
class Triangles {
 public:
  explicit Triangles(MeshInput& input) : input_(input) {}

  void add(PatchId patch, const std::array<Vec3, 3>& corners, const FilePlace& place) {
    std::vector<std::uint32_t> ring(3);
    for (std::size_t i = 0; i < 3; ++i) {
      bool is_new = false;
      ring[i] = positions_.number(corners[i], is_new);
      if (is_new) input_.add_vertex(corners[i], place);
    }
    input_.add_face(patch, std::move(ring), place);
  }

 private:
  MeshInput& input_;
  PositionTable positions_;
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
  bool read_statement();
  void start_solid();
  void start_facet();
  void read_vertex();
  void end_facet();

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

// False at the end of the line.
bool StlTextReader::read_statement() {
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
void StlTextReader::start_solid() {
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

void StlTextReader::start_facet() {
  if (in_facet_) fail("a facet within a facet", "endfacet is missing", "correct it");
  in_facet_ = true;
  facet_line_ = line_.number;
  corner_count_ = 0;
  expect("normal");
  for (int i = 0; i < 3; ++i) (void)text::take_word(rest_);
}

void StlTextReader::read_vertex() {
  const Vec3 position = input_.take_point(rest_, line_.number, "write vertex x y z");
  if (!in_facet_) return fail("a vertex outside a facet", "it belongs to no triangle", "write facet before it");
  if (corner_count_ < 3) corners_[corner_count_] = position;
  ++corner_count_;
}

void StlTextReader::end_facet() {
  if (!in_facet_) return fail("endfacet without a facet", "there is no triangle to end", "write facet before it");
  in_facet_ = false;
  if (corner_count_ != 3) {
    return fail("a facet has " + text::counted(corner_count_, "vertex", "vertices"), "it is a triangle",
                "write three vertices");
  }
  if (!patch_) patch_ = input_.patch(name_);
  triangles_.add(*patch_, corners_, at_line(facet_line_));
}

float little_endian_float(const char* bytes) {
  std::array<char, sizeof(float)> raw{};
  std::memcpy(raw.data(), bytes, raw.size());
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<float>(raw);
}

// The vertices of the triangle that begins at `offset`; the normal comes before them.
std::array<Vec3, 3> corners_at(std::string_view bytes, std::size_t offset) {
  std::array<double, 9> values{};
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = little_endian_float(bytes.data() + offset + (3 + i) * sizeof(float));
  return {Vec3{values[0], values[1], values[2]}, Vec3{values[3], values[4], values[5]},
          Vec3{values[6], values[7], values[8]}};
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

}  // namespace exactff::formats
