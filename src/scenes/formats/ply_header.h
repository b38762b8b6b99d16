// The header of a PLY file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/mesh_input.h"

namespace exactff::formats {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

[[nodiscard]] std::size_t size_of(PlyType type);
[[nodiscard]] inline bool is_whole(PlyType type) { return type < PlyType::kFloat32; }

struct PlyProperty {
  std::string name;
  PlyType type{};                       // of a list: of its items
  std::optional<PlyType> count_type{};  // of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::size_t line = 0;
  std::vector<PlyProperty> properties;

  // Where the property is among the others.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const;
};

enum class PlyEncoding { kText, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyEncoding encoding{};
  std::vector<PlyElement> elements;
  std::map<std::int64_t, std::string> patch_names;  // of comments "patch NUMBER NAME", which exactff writes
  std::size_t lines = 0;
  std::size_t bytes = 0;  // the data begin here
};

// Throws the first problem: after it, nothing in the file has a meaning.
[[nodiscard]] PlyHeader read_ply_header(std::string_view bytes, MeshInput& input);

}  // namespace exactff::formats
