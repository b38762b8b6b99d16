// STL: in text with doubles and one solid for each patch; in binary with floats.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "formats/mesh_input.h"
#include "formats/output_faces.h"
#include "formats/output_names.h"
#include "formats/stl_layout.h"
#include "kernel/vec.h"
#include "text/phrases.h"

namespace exactff::formats {

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
  out += "  facet normal";
  append_point(out, rough_normal(corners));
  out += "\n    outer loop\n";
  for (const Vec3& corner : corners) {
    out += "      vertex";
    append_point(out, corner);
    out += '\n';
  }
  out += "    endloop\n  endfacet\n";
}

// Places in the list of faces, for each patch.
std::vector<std::vector<std::size_t>> faces_by_patch(const Scene& scene, const std::vector<OutputFace>& faces) {
  std::vector<std::vector<std::size_t>> places(scene.patches().size());
  for (std::size_t i = 0; i < faces.size(); ++i) places[index_of(scene.face(faces[i].face).patch)].push_back(i);
  return places;
}

void append_little_endian(std::string& out, std::uint32_t value, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i));
}

void append_floats(std::string& out, const Vec3& v) {
  for (const double c : {v.x, v.y, v.z})
    append_little_endian(out, std::bit_cast<std::uint32_t>(static_cast<float>(c)), sizeof(float));
}

bool is_float(double value) { return static_cast<double>(static_cast<float>(value)) == value; }

void tell_rounding(const Scene& scene, Losses& losses) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  std::size_t rounded = 0;
  for (const Vec3& v : scene.vertices()) {
    if (kernel::max_norm(v) > kLargest) {
      throw InputError({losses.file(), 0, "a coordinate exceeds the largest float", "binary STL has only floats",
                        "write STL as text, or PLY"});
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
  append_little_endian(out, static_cast<std::uint32_t>(faces.size()), 4);
  for (const OutputFace& face : faces) {
    const std::array<Vec3, 3> corners = corners_of(scene, face);
    append_floats(out, rough_normal(corners));
    for (const Vec3& corner : corners) append_floats(out, corner);
    append_little_endian(out, 0, 2);
  }
  return out;
}

}  // namespace exactff::formats
