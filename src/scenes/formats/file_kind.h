// Which format a file has.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace exactff::formats {

enum class Format { kObj, kPly, kStlText, kStlBinary, kOff, kView3d };

// The extension in lower case, with its dot.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);

// A format that exactff does not read.
struct ForeignKind {
  std::string_view name;       // "a glTF file"
  std::string_view converter;  // completes "convert it, for example with ..."
};
// By the content; by the extension only if the content tells nothing and does not begin as that of an OBJ file.
[[nodiscard]] std::optional<ForeignKind> foreign_kind(std::string_view bytes, const std::filesystem::path& path);

// By the content, otherwise by the extension, otherwise OBJ.
[[nodiscard]] Format format_of(std::string_view bytes, const std::filesystem::path& path);

}  // namespace exactff::formats
