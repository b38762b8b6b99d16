// PLY with doubles, in text or little-endian binary. The patch of a face is its property `patch`; comments give names.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "formats/mesh_input.h"
#include "formats/output_faces.h"
#include "formats/output_names.h"
#include "text/phrases.h"

namespace exactff::formats {

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
  std::string out = std::string("ply\nformat ") + format + " 1.0\ncomment written by " + text::program_version() + '\n';
  for (std::size_t i = 0; content.has_patches && i < content.patches.size(); ++i)
    out += "comment patch " + std::to_string(i) + ' ' + content.patches[i] + '\n';
  out += "element vertex " + std::to_string(scene.vertices().size()) +
         "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
         std::to_string(content.faces.size()) + "\nproperty list " + (content.long_lists ? "uint" : "uchar") +
         " uint vertex_indices\n";
  if (content.has_patches) out += "property uint patch\n";
  return out + "end_header\n";
}

template <class T>
void append_raw(std::string& out, T value) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  out.append(raw.data(), raw.size());
}

}  // namespace

std::string write_ply_text(const Scene& scene, Losses& losses) {
  const PlyContent content = content_of(scene, losses);
  std::string out = header_of(scene, content, "ascii");
  for (const Vec3& vertex : scene.vertices()) {
    append_number(out, vertex.x);
    (out += ' ', append_number(out, vertex.y));
    (out += ' ', append_number(out, vertex.z));
    out += '\n';
  }
  for (const OutputFace& face : content.faces) {
    out += std::to_string(face.corners.size());
    for (const std::uint32_t corner : face.corners) (out += ' ') += std::to_string(corner);
    if (content.has_patches) (out += ' ') += std::to_string(index_of(scene.face(face.face).patch));
    out += '\n';
  }
  return out;
}

std::string write_ply_binary(const Scene& scene, Losses& losses) {
  const PlyContent content = content_of(scene, losses);
  std::string out = header_of(scene, content, "binary_little_endian");
  for (const Vec3& vertex : scene.vertices()) {
    for (const double coordinate : {vertex.x, vertex.y, vertex.z}) append_raw(out, coordinate);
  }
  for (const OutputFace& face : content.faces) {
    const auto count = static_cast<std::uint32_t>(face.corners.size());
    if (content.long_lists)
      append_raw(out, count);
    else
      append_raw(out, static_cast<std::uint8_t>(count));
    for (const std::uint32_t corner : face.corners) append_raw(out, corner);
    if (content.has_patches) append_raw(out, static_cast<std::uint32_t>(scene.face(face.face).patch));
  }
  return out;
}

}  // namespace exactff::formats
