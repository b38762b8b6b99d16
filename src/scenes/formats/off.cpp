// OFF (Object File Format of Geomview), in text: a keyword, three counts, one line for each vertex and each face.
#include <utility>

#include "formats/mesh_input.h"
#include "formats/writers.h"
#include "text/phrases.h"

namespace exactff::formats {
namespace {

class OffReader {
 public:
  OffReader(std::string_view text, MeshInput& input) : input_(input), lines_(text) {}

  Scene run() {
    read_header();
    read_vertices();
    read_faces();
    if (next_line()) {
      input_.warn(at_line(line_.number), "the file goes on after its last face", "the rest is ignored",
                  "are the counts in its header right?");
    } else {
      input_.warn_if_cut_off(lines_, line_.number);
    }
    return input_.build();
  }

 private:
  // Goes to the next line that is not blank.
  bool next_line() {
    do {
      if (!lines_.next(line_)) return false;
      rest_ = text::trimmed(line_.text.substr(0, line_.text.find('#')));
    } while (rest_.empty());
    return true;
  }

  void require_line(const char* what, std::uint64_t read, std::uint64_t count) {
    if (next_line()) return;
    give_up("the file ends after " + std::to_string(read) + " of " + std::to_string(count) + " " + what,
            "its header declares more", "is it complete?");
  }

  void read_header() {
    if (!next_line()) input_.give_up({}, "is empty", "there is nothing to compute with", "give an OFF file");
    read_keyword();
    if (text::trimmed(rest_).empty() && !next_line())
      give_up("the file ends before its counts", "they say how many vertices and faces follow", "is it complete?");
    vertices_ = take_count();
    faces_ = take_count();  // a third number, of edges, is of no use
  }

  // The keyword is OFF, with letters before it for what the lines of vertices hold after x y z: ST texture coordinates,
  // C a colour, N a normal. Some programs write the counts on the same line, without a blank.
  void read_keyword() {
    std::string_view word = rest_.substr(0, rest_.find_first_of(" \t0123456789"));
    const std::string keyword(word);
    std::string_view rest = rest_;
    const std::string_view whole = text::take_word(rest);
    if (whole.find("4OFF") != std::string_view::npos || whole.find("nOFF") != std::string_view::npos)
      give_up("a file of kind " + text::in_quotes(whole), "its points are not in three dimensions", "give an OFF file");
    if (word.starts_with("ST")) word.remove_prefix(2);
    if (word.starts_with("C")) word.remove_prefix(1);
    if (word.starts_with("N")) word.remove_prefix(1);
    if (word != "OFF") {
      give_up("the first word is not OFF, but " + text::in_quotes(keyword), "an OFF file begins with it",
              "is it an OFF file?");
    }
    rest_.remove_prefix(keyword.size());
    if (text::trimmed(rest_).starts_with("BINARY"))
      give_up("a binary OFF file", "exactff reads OFF in text", "convert it to text");
  }

  std::uint64_t take_count() {
    const std::string_view word = text::take_word(rest_);
    const auto count = whole_number(word);
    if (!count || *count < 0)
      give_up(text::in_quotes(word) + " is not a count", "the counts say how many vertices and faces follow",
              "write VERTICES FACES EDGES");
    constexpr std::uint64_t kLeastBytes = 2;  // a digit and a line end
    if (static_cast<std::uint64_t>(*count) <= lines_.bytes_left() / kLeastBytes + 1)
      return static_cast<std::uint64_t>(*count);
    give_up("the file declares " + std::to_string(*count) + " vertices or faces",
            "only " + std::to_string(lines_.bytes_left()) + " bytes follow", "is it complete?");
  }

  // Colours and normals after x, y and z are ignored.
  void read_vertices() {
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      require_line("vertices", i, vertices_);
      input_.add_vertex(input_.take_point(rest_, line_.number, "write x y z"), at_line(line_.number));
    }
  }

  void read_faces() {
    for (std::uint64_t i = 0; i < faces_; ++i) {
      require_line("faces", i, faces_);
      read_face();
    }
  }

  // A colour after the vertices is ignored.
  void read_face() {
    const FilePlace place = at_line(line_.number);
    const std::string_view word = text::take_word(rest_);
    const auto size = whole_number(word);
    if (!size || *size < 0 || static_cast<std::uint64_t>(*size) > rest_.size()) {
      return input_.fail(place, text::in_quotes(word) + " is not the number of vertices of a face",
                         "the line must hold as many indices", "write NUMBER INDEX...");
    }
    std::vector<std::uint32_t> ring;
    for (std::int64_t i = 0; i < *size; ++i) {
      const std::string_view corner = text::take_word(rest_);
      const auto index = whole_number(corner);
      if (!index || *index < 0 || static_cast<std::uint64_t>(*index) >= vertices_) {
        const std::string what = index ? "vertex " + std::to_string(*index) + " does not exist"
                                       : text::in_quotes(corner) + " is not an index";
        return input_.fail(place, what,
                           "the file has " + text::counted(vertices_, "vertex", "vertices") + ", counted from 0",
                           "correct the index");
      }
      ring.push_back(static_cast<std::uint32_t>(*index));
    }
    input_.add_face(input_.default_patch(), input_.no_material(), std::move(ring), place);
  }

  [[noreturn]] void give_up(std::string what, std::string why, std::string suggestion) {
    input_.give_up(at_line(line_.number), std::move(what), std::move(why), std::move(suggestion));
  }

  MeshInput& input_;
  text::PlainLines lines_;
  text::TextLine line_;
  std::string_view rest_;  // of the line, without its comment
  std::uint64_t vertices_ = 0;
  std::uint64_t faces_ = 0;
};

}  // namespace

Scene read_off(std::string_view text, const std::filesystem::path& path, const SceneOptions& options) {
  MeshInput input(path, options, "an OFF file");
  return OffReader(text, input).run();
}

// --- Writer ---

std::string write_off(const Scene& scene, Losses& losses) {
  const std::vector<OutputFace> faces = output_faces(scene, Polygons::kAny, "OFF", losses);
  losses.add_materials(scene, "OFF");
  if (!has_only_default_patch(scene))
    losses.add("the patches and their names are lost", "OFF has only one list of faces",
               "write OBJ or PLY to keep them");
  std::string out = "OFF\n" + unit_line(scene, "#") + std::to_string(scene.vertices().size()) + ' ' +
                    std::to_string(faces.size()) + " 0\n";
  for (const Vec3& vertex : scene.vertices()) append_point(out, "", vertex);
  for (const OutputFace& face : faces) (out += corner_words(face)) += '\n';
  return out;
}

}  // namespace exactff::formats
