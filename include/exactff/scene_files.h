// Reads scenes from files of several formats, and writes them.
//
// read_scene recognises the format by the content of the file and, where that leaves a choice, by its extension:
//
// - Wavefront OBJ with MTL: see read_obj.
// - PLY, in text and in both binary forms. Faces are polygons. An integer property `patch` (otherwise `material_index`)
//   of the faces makes patches `patch_N` (`material_N`), or of the name that a comment "patch N NAME" gives.
// - STL, in text and binary. A solid is a patch, with the rest of its line as its name. Vertices with equal doubles are
//   one vertex. Fronts follow from the order of the vertices; stored normals are ignored.
// - glTF 2.0 (.gltf with its buffers, .glb). A patch is a node that has a mesh; NAME/MATERIAL for each material where
//   the mesh has several. Its name is that of the node, else of the mesh, else of the nearest node above. A repeated
//   name continues its patch. Nodes of the default scene; their transforms are applied exactly, a rotation as that of
//   its quaternion divided by its length, and each coordinate is rounded once. Equal positions are one vertex. Kd is
//   the base colour factor, Ke the emissive factor times KHR_materials_emissive_strength: images do not count.
//   TEXCOORD_0 and TEXCOORD_1 are Scene::texture, with v upwards. Fronts follow from the order of the vertices. Units
//   are metres. Points, lines, skins, morph targets, lights and cameras are left out.
// - OFF, in text.
// - View3D (.vs3). A surface is a patch; a combined surface belongs to the patch of the other one. Obstruction surfaces
//   of one name are a patch, those without a name the patch `obstructions`. Kd is 1 - emittance. Subsurfaces are cut
//   from their base exactly, or refused.
//
// A line "# unit mm" (OBJ, OFF) or "comment unit mm" (PLY) among the first 20 is Scene::unit, which the writers keep.
//
// Files without materials get Kd 1 and Ke 0. Text is read as doubles, correctly rounded, even where a PLY header says
// float. Names that are not UTF-8 are read as Latin-1 (Windows-1252), with a warning. Files of other known kinds (VTK,
// STEP, IFC, Abaqus, Nastran, EnergyPlus, ...) are refused with the name of a converter.
#pragma once

#include <filesystem>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// Throws one InputError with all problems found, each with a line, or an offset in bytes in a binary file.
//
// "a.stl+b.stl+c.glb" are several files, unless there is a file of that name. Each name is as long as there is such a
// file. A patch `default` has the name of its file, without extension; a name that several files use becomes
// FILE/NAME, as do different materials of one name. All are converted into the unit of the first file
// (SceneOptions::convert_to), if any states one. Faces have no lines.
[[nodiscard]] Scene read_scene(const std::filesystem::path& path, const SceneOptions& options = {});

// As above, from the bytes of the file. `path` stands for it in messages, gives the extension and locates MTL files.
[[nodiscard]] Scene read_scene(std::string_view bytes, const std::filesystem::path& path,
                               const SceneOptions& options = {});

// Reads Wavefront OBJ and MTL files.
//
// Read: v, vt (Scene::texture, set 0), f (v, v/vt, v//vn, v/vt/vn, negative indices, any number of vertices), g, o,
// usemtl, mtllib, continuation lines, CRLF, comments. A patch is a group (g; in a file without g, an object o). A
// repeated name continues its patch. Faces before any group belong to `default`. For `g a b` the first name counts,
// with a warning. A face with a vt that does not exist or is no number gets no texture coordinates, with a warning.
// Other OBJ statements, which a form factor does not need (s, p, l, ...), are ignored. MTL: Kd is the reflectance, Ke
// the radiosity. Numbers are read with correct rounding. vn, d, Tr and illum affect no value; they are read for
// diagnoses (Face::file_normals, Material::see_through).
//
// An unknown material in usemtl and a missing MTL file cause a warning and give a default material (Kd 1, Ke 0). All
// other errors are collected and thrown as one InputError with file:line.
[[nodiscard]] Scene read_obj(const std::filesystem::path& path, const SceneOptions& options = {});
// As above, from an open stream. `name` stands for the file in messages and locates its MTL files.
[[nodiscard]] Scene read_obj(std::istream& in, const std::filesystem::path& name, const SceneOptions& options = {});

// A file of names for faces: NAME=SELECTOR on each line (with_names); # begins a comment. Throws InputError with lines.
[[nodiscard]] std::vector<FaceName> read_names(const std::filesystem::path& path);

enum class Encoding {
  kDefault,  // binary for PLY, text for the others
  kText,     // PLY, STL
  kBinary,   // PLY with doubles, little-endian; STL, whose binary form has floats
};

// The files that hold a scene, and what they do not hold.
struct SceneFiles {
  struct File {
    std::filesystem::path path;
    std::string bytes;
  };
  std::vector<File> files;  // the last one is the one asked for; before it, its MTL file
  std::vector<Problem> losses;
};

// The format follows from the extension of `path`: .obj, .ply, .stl, .off or .vs3. Nothing is written. Doubles are kept
// except in binary STL. Faces that the format cannot hold are cut into polygons that it can, at existing vertices, so
// that form factors do not change. Throws InputError for another extension, or an encoding that the format lacks.
[[nodiscard]] SceneFiles scene_files(const Scene& scene, const std::filesystem::path& path,
                                     Encoding encoding = Encoding::kDefault);

}  // namespace exactff
