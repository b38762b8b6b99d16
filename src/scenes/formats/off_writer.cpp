// OFF, in text.
#include "formats/output_faces.h"
#include "formats/output_names.h"

namespace exactff::formats {

std::string write_off(const Scene& scene, Losses& losses) {
  const std::vector<OutputFace> faces = output_faces(scene, Polygons::kAny, "OFF", losses);
  losses.add_materials(scene, "OFF");
  if (!has_only_default_patch(scene))
    losses.add("the patches and their names are lost", "OFF has only one list of faces",
               "write OBJ or PLY to keep them");
  std::string out = "OFF\n" + std::to_string(scene.vertices().size()) + ' ' + std::to_string(faces.size()) + " 0\n";
  for (const Vec3& vertex : scene.vertices()) {
    append_number(out, vertex.x);
    (out += ' ', append_number(out, vertex.y));
    (out += ' ', append_number(out, vertex.z));
    out += '\n';
  }
  for (const OutputFace& face : faces) {
    out += std::to_string(face.corners.size());
    for (const std::uint32_t corner : face.corners) (out += ' ') += std::to_string(corner);
    out += '\n';
  }
  return out;
}

}  // namespace exactff::formats
