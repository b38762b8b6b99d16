// Reads Wavefront OBJ and MTL files into a Scene.
//
// Read: v, f (v, v/vt, v//vn, v/vt/vn, negative indices, any number of vertices), g, o, usemtl, mtllib, continuation
// lines, CRLF, comments. A patch is a group (g; in a file without g, an object o). A repeated name continues its patch.
// Faces before any group belong to `default`. For `g a b` the first name counts, with a warning. Other OBJ statements,
// which a form factor does not need (vt, s, p, l, ...), are ignored. MTL: Kd is the reflectance, Ke the radiosity.
// Numbers are read with correct rounding. vn, d, Tr and illum affect no value; they are read for diagnoses
// (Face::file_normals, Material::see_through).
//
// An unknown material in usemtl and a missing MTL file cause a warning and give a default material (Kd 1, Ke 0). All
// other errors are collected and thrown as one InputError with file:line.
#pragma once

#include <filesystem>
#include <istream>

#include "exactff/scene.h"

namespace exactff {

[[nodiscard]] Scene read_obj(const std::filesystem::path& path, const SceneOptions& options = {});

// As above, from an open stream. `name` stands for the file in messages and locates its MTL files.
[[nodiscard]] Scene read_obj(std::istream& in, const std::filesystem::path& name, const SceneOptions& options = {});

}  // namespace exactff
