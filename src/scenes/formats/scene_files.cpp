#include "exactff/scene_files.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "formats/file_kind.h"
#include "formats/writers.h"
#include "kernel/float_environment.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff {

namespace formats {

void append_number(std::string& out, double value) {
  std::array<char, 40> text{};
  out.append(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
}

void append_point(std::string& out, const Vec3& point) {
  for (const double coordinate : {point.x, point.y, point.z}) {
    out += ' ';
    append_number(out, coordinate);
  }
}

void Losses::add_materials(const Scene& scene, const std::string& format) {
  const auto is_lost = [](const Material& m) { return m.emits() || m.reflectance != Rgb{1.0, 1.0, 1.0}; };
  const auto lost = std::count_if(scene.materials().begin(), scene.materials().end(), is_lost);
  if (lost == 0) return;
  add("Kd and Ke of " + text::counted(static_cast<std::uint64_t>(lost), "material") + " are lost",
      format + " has no materials", "write OBJ to keep them");
}

}  // namespace formats

namespace {

// The MTL file goes first: an OBJ file that is there has its materials.
void write_wavefront(const Scene& scene, const std::filesystem::path& path, SceneFiles& result,
                     formats::Losses& losses) {
  std::filesystem::path mtl;
  if (formats::needs_mtl(scene)) {
    mtl = path;
    mtl.replace_extension(".mtl");
    result.files.push_back({mtl, formats::write_mtl(scene, losses)});
  }
  result.files.push_back({path, formats::write_obj(scene, mtl.filename().string(), losses)});
}

struct Writer {
  std::string_view extension;
  std::string (*text)(const Scene&, formats::Losses&);
  std::string (*binary)(const Scene&, formats::Losses&);
  bool binary_by_default = false;
};

constexpr std::array<Writer, 4> kWriters = {{{".ply", formats::write_ply_text, formats::write_ply_binary, true},
                                             {".stl", formats::write_stl_text, formats::write_stl_binary},
                                             {".off", formats::write_off, nullptr},
                                             {".vs3", formats::write_view3d, nullptr}}};

}  // namespace

SceneFiles scene_files(const Scene& scene, const std::filesystem::path& path, Encoding encoding) {
  const kernel::StandardArithmetic arithmetic;
  const std::string extension = formats::lower_extension(path);
  const auto* const writer = std::find_if(kWriters.begin(), kWriters.end(),
                                          [&](const Writer& candidate) { return candidate.extension == extension; });
  const bool wavefront = extension == ".obj";
  if (!wavefront && writer == kWriters.end()) {
    throw InputError({path.string(), 0, "no format is known for the extension " + text::in_quotes(extension),
                      "the extension says which format to write", "name a file .obj, .ply, .stl, .off or .vs3"});
  }
  if (encoding == Encoding::kBinary && (wavefront || writer->binary == nullptr)) {
    throw InputError(
        {path.string(), 0, "the format has no binary form", "only PLY and STL have one", "leave the encoding out"});
  }
  SceneFiles result;
  formats::Losses losses(path);
  if (wavefront) {
    write_wavefront(scene, path, result, losses);
  } else {
    const bool binary = encoding == Encoding::kDefault ? writer->binary_by_default : encoding == Encoding::kBinary;
    result.files.push_back({path, (binary ? writer->binary : writer->text)(scene, losses)});
  }
  result.losses = losses.take();
  return result;
}

}  // namespace exactff
