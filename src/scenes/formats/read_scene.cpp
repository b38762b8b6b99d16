#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "exactff/scene_files.h"
#include "formats/file_kind.h"
#include "formats/readers.h"
#include "kernel/float_environment.h"
#include "scene/scene_data.h"
#include "text/text_file.h"

namespace exactff {

namespace {

constexpr const char* kAnyFormat = "an OBJ, PLY, STL, OFF or View3D file";

}  // namespace

Scene read_scene(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  const std::string file = path.string();
  if (bytes.empty())
    throw InputError({file, 0, "is empty", "there is nothing to compute with", std::string("give ") + kAnyFormat});
  if (const auto kind = formats::foreign_kind(bytes, path)) {
    throw InputError({file, 0, "is " + std::string(kind->name),
                      std::string("exactff reads OBJ, PLY, STL, OFF and View3D"),
                      "convert it, for example with " + std::string(kind->converter)});
  }
  const formats::Format format = formats::format_of(bytes, path);
  switch (format) {
    case formats::Format::kPly:
      return formats::read_ply(bytes, path, options);
    case formats::Format::kStlBinary:
      return formats::read_stl_binary(bytes, path, options);
    default:
      break;
  }
  text::require_text(bytes, file, kAnyFormat);
  switch (format) {
    case formats::Format::kStlText:
      return formats::read_stl_text(bytes, path, options);
    case formats::Format::kOff:
      return formats::read_off(bytes, path, options);
    case formats::Format::kView3d:
      return formats::read_view3d(bytes, path, options);
    default:
      return formats::read_obj(bytes, path, options);
  }
}

Scene read_scene(const std::filesystem::path& path, const SceneOptions& options) {
  return SceneInside::read_from(path, read_scene(text::read_file(path, kAnyFormat), path, options));
}

}  // namespace exactff
