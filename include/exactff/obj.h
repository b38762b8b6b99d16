// Wavefront OBJ + MTL to a Scene.
//
// Read: v, f (v, v/vt, v//vn, v/vt/vn, negative indices, any number of vertices), g, o, usemtl, mtllib,
// continuation lines, CRLF, comments. A patch is a group (g; where a file has no g, an object o); a
// repeated name continues its patch; faces before any group belong to `default`; of `g a b` the first
// name counts, with a warning. Everything else that OBJ allows and a form factor does not need (vt, vn,
// s, p, l, ...) is passed over. MTL: Kd is the reflectance, Ke the radiosity. Numbers are read with
// correct rounding.
//
// usemtl of an unknown material and a missing MTL file are warnings and give a default material (Kd 1,
// Ke 0). Everything else that is wrong is collected and thrown as one InputError with file:line.
#pragma once

#include <filesystem>
#include <istream>

#include "exactff/scene.h"

namespace exactff {

[[nodiscard]] Scene read_obj(const std::filesystem::path& path, const SceneOptions& options = {});

// The same from an open stream; `name` stands for the file in messages and locates its MTL files.
[[nodiscard]] Scene read_obj(std::istream& in, const std::filesystem::path& name, const SceneOptions& options = {});

}  // namespace exactff
