// PLY, in text and in binary.
//
// 1. The header declares elements (vertex, face, others) with typed properties. Counts are compared with the length of
//    the file before anything is read: no memory is taken on a header's word.
// 2. Elements are read in their order. x, y and z of a vertex, vertex_indices of a face and one whole number that names
//    its patch count; everything else is passed over.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "files/numpy.h"
#include "formats/mesh_input.h"
#include "formats/ply_header.h"
#include "formats/writers.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::formats {
namespace {

// --- Rows ---

// The rows of a PLY file, one for each vertex or face: lines of text, or binary values in either byte order.
//
// Both kinds have the same functions, in the order of a row's properties:
//   next()             goes to the next row; false if there is none
//   real(type)         reads a number; whole types are exact
//   whole(type)        reads a whole number
//   list_size(types)   reads the size of a list, never more than the file can hold
//   pass_over(property)
//   finish()           ends the row
//   place()            of the row, for messages

// A line is a row; blank lines are none. After a fault, the rest of the row reads as zeros.
class TextRows {
 public:
  TextRows(std::string_view bytes, const PlyHeader& header, MeshInput& input)
      : input_(input), lines_(bytes.substr(header.bytes), header.lines) {}

  bool next() {
    do {
      if (!lines_.next(line_)) return false;
      rest_ = text::trimmed(line_.text);
    } while (rest_.empty());
    sound_ = true;
    return true;
  }

  double real(PlyType) {
    const std::string_view word = take();
    if (!sound_) return 0.0;
    const text::ParsedNumber number = text::parse_number(word);
    if (number.fault != text::NumberFault::kNone)
      fail(describe(number.fault, word), "a coordinate is one exact number", advice(number.fault));
    return number.value;
  }

  std::int64_t whole(PlyType) {
    const std::string_view word = take();
    if (!sound_) return 0;
    const auto number = whole_number(word);
    if (!number) fail(text::in_quotes(word) + " is not a whole number", "it is an index or a count", "correct it");
    return number.value_or(0);
  }

  std::size_t list_size(const PlyProperty& list) {
    const std::int64_t size = whole(*list.count_type);
    if (size >= 0 && static_cast<std::uint64_t>(size) <= rest_.size()) return static_cast<std::size_t>(size);
    fail("a list of " + std::to_string(size) + " items", "the line does not hold them", "correct the count");
    return 0;
  }

  void pass_over(const PlyProperty& property) {
    const std::size_t words = property.count_type ? list_size(property) : 1;
    for (std::size_t i = 0; i < words && sound_; ++i) (void)take();
  }

  void finish() {
    if (!sound_ || text::trimmed(rest_).empty()) return;
    fail("a line has more values than the header declares", "each line is one vertex or one face",
         "correct the header or the line");
  }

  [[nodiscard]] FilePlace place() const { return at_line(line_.number); }
  [[nodiscard]] bool is_sound() const { return sound_; }

  // After the last row.
  void warn_about_rest() {
    if (next()) {
      input_.warn(place(), "the header declares fewer lines than the file has", "the others are ignored",
                  "are the counts in the header right?");
    } else {
      input_.warn_if_cut_off(lines_, line_.number);
    }
  }
  // The number of bytes that a row has at least: one digit and a blank or line end for each value.
  static std::size_t least_bytes(const PlyElement& element) { return 2 * element.properties.size(); }
  [[nodiscard]] std::size_t bytes_left() const { return lines_.bytes_left() + 1; }  // the last line may have no end

 private:
  std::string_view take() {
    const std::string_view word = sound_ ? text::take_word(rest_) : std::string_view{};
    if (sound_ && word.empty()) {
      fail("a line has fewer values than the header declares", "each line is one vertex or one face",
           "correct the header or the line");
    }
    return word;
  }
  void fail(std::string what, std::string why, std::string suggestion) {
    if (sound_) input_.fail(place(), std::move(what), std::move(why), std::move(suggestion));
    sound_ = false;
  }

  MeshInput& input_;
  text::PlainLines lines_;
  text::TextLine line_;
  std::string_view rest_;
  bool sound_ = true;
};

// Where a binary file ends too early or a list has no valid size, nothing after it can be read.
template <std::endian kOrder>
class BinaryRows {
 public:
  BinaryRows(std::string_view bytes, const PlyHeader& header, MeshInput& input)
      : input_(input), bytes_(bytes), at_(header.bytes) {}

  bool next() {
    row_ = at_;
    sound_ = true;
    return at_ < bytes_.size();
  }

  double real(PlyType type) {
    if (type == PlyType::kFloat32) return finite(take<float>());
    if (type == PlyType::kFloat64) return finite(take<double>());
    return static_cast<double>(whole(type));
  }

  std::int64_t whole(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return take<std::int8_t>();
      case PlyType::kUint8:
        return take<std::uint8_t>();
      case PlyType::kInt16:
        return take<std::int16_t>();
      case PlyType::kUint16:
        return take<std::uint16_t>();
      case PlyType::kInt32:
        return take<std::int32_t>();
      default:
        return take<std::uint32_t>();
    }
  }

  std::size_t list_size(const PlyProperty& list) {
    const std::size_t start = at_;
    const std::int64_t size = whole(*list.count_type);
    if (size >= 0 && static_cast<std::uint64_t>(size) <= bytes_left() / size_of(list.type))
      return static_cast<std::size_t>(size);
    input_.give_up(at_byte(start), "a list of " + std::to_string(size) + " items",
                   "only " + std::to_string(bytes_left()) + " bytes follow", "the file is damaged or incomplete");
  }

  void pass_over(const PlyProperty& property) {
    const std::size_t items = property.count_type ? list_size(property) : 1;
    require(items * size_of(property.type));
    at_ += items * size_of(property.type);
  }

  void finish() {}
  [[nodiscard]] FilePlace place() const { return at_byte(row_); }
  [[nodiscard]] bool is_sound() const { return sound_; }

  void warn_about_rest() {
    if (at_ == bytes_.size()) return;
    input_.warn(at_byte(at_), "the header declares fewer data than the file has", "the others are ignored",
                "are the counts in the header right?");
  }
  static std::size_t least_bytes(const PlyElement& element) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties)
      bytes += size_of(property.count_type.value_or(property.type));
    return bytes;
  }
  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size() - at_; }

 private:
  void require(std::size_t bytes) {
    if (bytes <= bytes_left()) return;
    input_.give_up(at_byte(bytes_.size()), "the file ends too early", "the header declares more data",
                   "is the file complete?");
  }

  template <class T>
  T take() {
    require(sizeof(T));
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    if constexpr (kOrder != std::endian::native) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  double finite(double value) {
    if (std::isfinite(value)) return value;
    input_.fail(place(), "a coordinate is not a finite number", "a coordinate is one exact number",
                "give finite coordinates");
    sound_ = false;
    return 0.0;
  }

  MeshInput& input_;
  std::string_view bytes_;
  std::size_t at_;
  std::size_t row_ = 0;
  bool sound_ = true;
};

// --- Reader ---

// The face property that tells patches apart.
struct PatchProperty {
  std::optional<std::size_t> place;
  std::string prefix;  // of the patch's name, before its number
};

template <class Rows>
class PlyReader {
 public:
  PlyReader(std::string_view bytes, PlyHeader header, MeshInput& input)
      : header_(std::move(header)), input_(input), rows_(bytes, header_, input) {}

  Scene run() {
    const auto* const vertices = element("vertex");
    if (vertices != nullptr) vertex_count_ = vertices->count;
    for (const PlyElement& element : header_.elements) read(element);
    rows_.warn_about_rest();
    return input_.build();
  }

 private:
  const PlyElement* element(std::string_view name) const {
    for (const PlyElement& element : header_.elements) {
      if (element.name == name) return &element;
    }
    return nullptr;
  }

  void read(const PlyElement& element) {
    if (element.properties.empty()) return;
    require_bytes(element);
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element);
    if (element.name == "tristrips" && element.count > 0) tell_strips(element);
    for_each_row(element, [&] {
      for (const PlyProperty& property : element.properties) rows_.pass_over(property);
    });
  }

  // Without other faces, nothing would be left.
  void tell_strips(const PlyElement& strips) {
    const char* const what = "triangle strips (tristrips) are not read";
    const char* const why = "exactff reads faces, the element face";
    const char* const suggestion = "convert them to faces, for example with Blender or MeshLab";
    const PlyElement* const faces = element("face");
    if (faces == nullptr || faces->count == 0) input_.give_up(at_line(strips.line), what, why, suggestion);
    input_.warn(at_line(strips.line), what, why, suggestion);
  }

  void require_bytes(const PlyElement& element) {
    const std::size_t least = Rows::least_bytes(element);
    if (element.count <= rows_.bytes_left() / least) return;
    input_.give_up(at_line(element.line),
                   std::to_string(element.count) + " times " + text::in_quotes(element.name) + " of at least " +
                       text::counted(least, "byte") + " are declared",
                   "only " + std::to_string(rows_.bytes_left()) + " bytes follow", "is the file complete?");
  }

  template <class ReadRow>
  void for_each_row(const PlyElement& element, const ReadRow& read_row) {
    for (std::uint64_t i = 0; i < element.count; ++i) {
      if (!rows_.next()) {
        input_.give_up(at_line(element.line),
                       "the file ends after " + std::to_string(i) + " of " + std::to_string(element.count) + " times " +
                           text::in_quotes(element.name),
                       "the header declares more", "is the file complete?");
      }
      read_row();
      rows_.finish();
    }
  }

  void read_vertices(const PlyElement& element) {
    std::vector<double Vec3::*> target(element.properties.size(), nullptr);
    for (const auto& [name, coordinate] :
         {std::pair("x", &Vec3::x), std::pair("y", &Vec3::y), std::pair("z", &Vec3::z)}) {
      const auto place = element.find(name);
      if (!place || element.properties[*place].count_type) {
        input_.give_up(at_line(element.line), std::string("the vertices have no coordinate ") + name,
                       "a point needs x, y and z", "declare property double " + std::string(name));
      }
      target[*place] = coordinate;
    }
    for_each_row(element, [&] {
      Vec3 position{};
      for (std::size_t i = 0; i < target.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (target[i] == nullptr)
          rows_.pass_over(property);
        else
          position.*target[i] = rows_.real(property.type);
      }
      input_.add_vertex(position, rows_.place());
    });
  }

  PatchProperty patch_property(const PlyElement& element) {
    for (const auto& [name, prefix] : {std::pair("patch", "patch_"), std::pair("material_index", "material_")}) {
      const auto place = element.find(name);
      if (!place) continue;
      const PlyProperty& property = element.properties[*place];
      if (is_whole(property.type) && !property.count_type) return {place, prefix};
      input_.warn(at_line(element.line), "property " + text::in_quotes(name) + " of the faces is not an integer",
                  "it does not tell patches apart", "declare property int " + std::string(name));
    }
    return {};
  }

  void read_faces(const PlyElement& element) {
    auto list = element.find("vertex_indices");
    if (!list) list = element.find("vertex_index");
    if (!list || !element.properties[*list].count_type || !is_whole(element.properties[*list].type)) {
      input_.give_up(at_line(element.line), "the faces have no list of integers vertex_indices",
                     "it holds the vertices of each face", "declare property list uchar int vertex_indices");
    }
    const PatchProperty patch = patch_property(element);
    for_each_row(element, [&] {
      std::vector<std::uint32_t> ring;
      std::int64_t number = 0;
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (i == *list) {
          ring = read_ring(property);
        } else if (patch.place == i) {
          number = rows_.whole(property.type);
        } else {
          rows_.pass_over(property);
        }
      }
      if (!rows_.is_sound()) return;
      input_.add_face(patch.place ? patch_numbered(number, patch.prefix) : input_.default_patch(), input_.no_material(),
                      std::move(ring), rows_.place());
    });
  }

  std::vector<std::uint32_t> read_ring(const PlyProperty& list) {
    const std::size_t size = rows_.list_size(list);
    std::vector<std::uint32_t> ring;
    ring.reserve(size);  // not more than the file has bytes
    for (std::size_t i = 0; i < size && rows_.is_sound(); ++i) {
      const std::int64_t index = rows_.whole(list.type);
      ring.push_back(static_cast<std::uint32_t>(index));
      if (index >= 0 && std::cmp_less(index, vertex_count_)) continue;
      input_.fail(rows_.place(), "vertex " + std::to_string(index) + " does not exist",
                  "the file has " + text::counted(vertex_count_, "vertex", "vertices") + ", counted from 0",
                  "correct the index");
    }
    return ring;
  }

  PatchId patch_numbered(std::int64_t number, const std::string& prefix) {
    const auto [place, is_new] = patches_.try_emplace(number);
    if (is_new) {
      const auto named = header_.patch_names.find(number);
      place->second =
          input_.patch(named != header_.patch_names.end() ? named->second : prefix + std::to_string(number));
    }
    return place->second;
  }

  const PlyHeader header_;
  MeshInput& input_;
  Rows rows_;
  std::uint64_t vertex_count_ = 0;  // as declared
  std::unordered_map<std::int64_t, PatchId> patches_;
};

void require_text(std::string_view bytes, MeshInput& input) {
  const std::size_t zero = bytes.find('\0');
  if (zero == std::string_view::npos) return;
  input.give_up(at_byte(zero), "a zero byte in a text file", "the header says format ascii", "is the file damaged?");
}

}  // namespace

Scene read_ply(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& options) {
  MeshInput input(path, options, "a PLY file");
  PlyHeader header = read_ply_header(bytes, input);
  switch (header.encoding) {
    case PlyEncoding::kText:
      require_text(bytes, input);
      return PlyReader<TextRows>(bytes, std::move(header), input).run();
    case PlyEncoding::kLittleEndian:
      return PlyReader<BinaryRows<std::endian::little>>(bytes, std::move(header), input).run();
    default:
      return PlyReader<BinaryRows<std::endian::big>>(bytes, std::move(header), input).run();
  }
}

// --- Writer ---

// PLY with doubles, in text or little-endian binary. The patch of a face is its property `patch`; comments give names.

namespace {

struct PlyContent {
  std::vector<OutputFace> faces;
  std::vector<std::string> patches;
  bool has_patches = false;
  bool long_lists = false;  // more than 255 corners
};

PlyContent content_of(const Scene& scene, Losses& losses) {
  PlyContent content;
  content.faces = output_faces(scene, Polygons::kAny, "PLY", losses);
  content.patches = output_names(patch_names(scene), {}, "patch", losses);
  content.has_patches = !has_only_default_patch(scene);
  content.long_lists = std::any_of(content.faces.begin(), content.faces.end(),
                                   [](const OutputFace& face) { return face.corners.size() > 255; });
  losses.add_materials(scene, "PLY");
  return content;
}

std::string header_of(const Scene& scene, const PlyContent& content, const char* format) {
  std::string out = std::string("ply\nformat ") + format + " 1.0\n" + unit_line(scene, "comment") +
                    "comment written by " + text::program_version() + '\n';
  for (std::size_t i = 0; content.has_patches && i < content.patches.size(); ++i)
    out += "comment patch " + std::to_string(i) + ' ' + content.patches[i] + '\n';
  out += "element vertex " + std::to_string(scene.vertices().size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string(content.faces.size()) + "\nproperty list " + (content.long_lists ? "uint" : "uchar") +
         " uint vertex_indices\n";
  if (content.has_patches) out += "property uint patch\n";
  return out + "end_header\n";
}

}  // namespace

std::string write_ply_text(const Scene& scene, Losses& losses) {
  const PlyContent content = content_of(scene, losses);
  std::string out = header_of(scene, content, "ascii");
  for (const Vec3& vertex : scene.vertices()) append_point(out, "", vertex);
  for (const OutputFace& face : content.faces) {
    out += corner_words(face);
    if (content.has_patches) (out += ' ') += std::to_string(index_of(scene.face(face.face).patch));
    out += '\n';
  }
  return out;
}

std::string write_ply_binary(const Scene& scene, Losses& losses) {
  const PlyContent content = content_of(scene, losses);
  std::string out = header_of(scene, content, "binary_little_endian");
  const auto append = [&](const auto& values) {
    out += files::little_endian(std::span(std::data(values), std::size(values)));
  };
  for (const Vec3& vertex : scene.vertices()) append(std::array{vertex.x, vertex.y, vertex.z});
  for (const OutputFace& face : content.faces) {
    const std::size_t count = face.corners.size();
    content.long_lists ? append(std::array{static_cast<std::uint32_t>(count)})
                       : append(std::array{static_cast<std::uint8_t>(count)});
    append(face.corners);
    if (content.has_patches) append(std::array{static_cast<std::uint32_t>(scene.face(face.face).patch)});
  }
  return out;
}

}  // namespace exactff::formats
