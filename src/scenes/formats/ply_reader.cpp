// PLY, in text and in binary.
//
// 1. The header declares elements (vertex, face, others) with typed properties. Counts are compared with the length of
//    the file before anything is read: no memory is taken on a header's word.
// 2. Elements are read in their order. x, y and z of a vertex, vertex_indices of a face and one whole number that names
//    its patch count; everything else is passed over.
#include <unordered_map>
#include <utility>

#include "formats/ply_rows.h"
#include "formats/readers.h"
#include "text/phrases.h"

namespace exactff::formats {

namespace {

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
  const PlyElement* element(std::string_view name) const;
  void read(const PlyElement& element);
  void tell_strips(const PlyElement& element);
  void require_bytes(const PlyElement& element);
  void read_vertices(const PlyElement& element);
  void read_faces(const PlyElement& element);
  PatchProperty patch_property(const PlyElement& element);
  std::vector<std::uint32_t> read_ring(const PlyProperty& list);
  PatchId patch_numbered(std::int64_t number, const std::string& prefix);
  template <class ReadRow>
  void for_each_row(const PlyElement& element, const ReadRow& read_row);

  const PlyHeader header_;
  MeshInput& input_;
  Rows rows_;
  std::uint64_t vertex_count_ = 0;  // as declared
  std::unordered_map<std::int64_t, PatchId> patches_;
};

template <class Rows>
const PlyElement* PlyReader<Rows>::element(std::string_view name) const {
  for (const PlyElement& element : header_.elements) {
    if (element.name == name) return &element;
  }
  return nullptr;
}

template <class Rows>
void PlyReader<Rows>::read(const PlyElement& element) {
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
template <class Rows>
void PlyReader<Rows>::tell_strips(const PlyElement& strips) {
  const char* const what = "triangle strips (tristrips) are not read";
  const char* const why = "exactff reads faces, the element face";
  const char* const suggestion = "convert them to faces, for example with Blender or MeshLab";
  const PlyElement* const faces = element("face");
  if (faces == nullptr || faces->count == 0) input_.give_up(at_line(strips.line), what, why, suggestion);
  input_.warn(at_line(strips.line), what, why, suggestion);
}

template <class Rows>
void PlyReader<Rows>::require_bytes(const PlyElement& element) {
  const std::size_t least = Rows::least_bytes(element);
  if (element.count <= rows_.bytes_left() / least) return;
  input_.give_up(at_line(element.line),
                 std::to_string(element.count) + " times " + text::in_quotes(element.name) + " of at least " +
                     text::counted(least, "byte") + " are declared",
                 "only " + std::to_string(rows_.bytes_left()) + " bytes follow", "is the file complete?");
}

template <class Rows>
template <class ReadRow>
void PlyReader<Rows>::for_each_row(const PlyElement& element, const ReadRow& read_row) {
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

template <class Rows>
void PlyReader<Rows>::read_vertices(const PlyElement& element) {
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

template <class Rows>
PatchProperty PlyReader<Rows>::patch_property(const PlyElement& element) {
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

template <class Rows>
void PlyReader<Rows>::read_faces(const PlyElement& element) {
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
    input_.add_face(patch.place ? patch_numbered(number, patch.prefix) : input_.default_patch(), std::move(ring),
                    rows_.place());
  });
}

template <class Rows>
std::vector<std::uint32_t> PlyReader<Rows>::read_ring(const PlyProperty& list) {
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

template <class Rows>
PatchId PlyReader<Rows>::patch_numbered(std::int64_t number, const std::string& prefix) {
  const auto [place, is_new] = patches_.try_emplace(number);
  if (is_new) {
    const auto named = header_.patch_names.find(number);
    place->second = input_.patch(named != header_.patch_names.end() ? named->second : prefix + std::to_string(number));
  }
  return place->second;
}

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

}  // namespace exactff::formats
