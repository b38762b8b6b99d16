// Scene files: which format a file has; it is read or written accordingly.
#include "exactff/scene_files.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "files/numpy.h"
#include "formats/mesh_input.h"
#include "formats/stl.h"
#include "formats/writers.h"
#include "kernel/float_environment.h"
#include "scene/scene.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {
namespace formats {
namespace {

enum class Format { kObj, kGltf, kPly, kStlText, kStlBinary, kOff, kView3d };

// A format that exactff does not read.
struct ForeignKind {
  std::string_view name;                        // "a Collada file"
  std::string_view converter;                   // completes "convert it, for example with ..."
  std::string_view extensions = {};             // words, which count where the content tells nothing
  std::array<std::string_view, 2> starts = {};  // the first bytes of a file
  std::string_view element = {};                // in a file that begins with "<"
};

constexpr std::size_t kLookedAt = std::size_t{1} << 16;  // bytes of a file that show its format

constexpr std::string_view kAssimp = "assimp export IN OUT.obj, or Blender; both keep the names of objects";
constexpr std::string_view kBlender = "Blender: export Wavefront (.obj), which keeps the names of objects";
constexpr std::string_view kMeshio =
    "python3 -m exactff convert IN OUT.obj, which keeps the names of groups (it needs exactff for Python and meshio)";
constexpr std::string_view kScript =
    "a script that gives exactff.Scene its polygons and their names (data/guide/scenes.md shows one)";
constexpr std::string_view kCad = "FreeCAD, or gmsh IN -2 -o OUT.stl";

// Those that are recognised below, not only by the table.
constexpr ForeignKind kAbaqus{"an Abaqus or CalculiX file", kMeshio, "", {"*HEADING", "*Heading"}};
constexpr ForeignKind kNastran{"a Nastran file", kMeshio, ".bdf .nas .fem"};
constexpr ForeignKind kVtk{"a VTK file", kMeshio, ".vtk .vtu", {"# vtk DataFile"}, "<VTKFile"};
constexpr ForeignKind kVtp{"a VTK file of polygons", "ParaView: save as PLY, without names", ".vtp"};
constexpr ForeignKind k3ds{"a 3DS file", kAssimp, ".3ds"};
constexpr ForeignKind kStep{"a STEP file", kCad, ".stp .step"};
constexpr ForeignKind kIges{"an IGES file", kCad, ".igs .iges"};
constexpr ForeignKind kDxf{"a DXF file", kCad, ".dxf", {"AutoCAD Binary DXF"}};
constexpr ForeignKind kIfc{"an IFC file",
                           "IfcConvert --use-element-names IN OUT.obj, which keeps the names of elements", ".ifc"};
constexpr ForeignKind kEnergyPlus{"an EnergyPlus input file",
                                  "geomeppy in Python, whose surfaces have a Name and coords, and exactff.Scene "
                                  "(data/guide/scenes.md shows a script)",
                                  ".idf .imf"};
constexpr ForeignKind kEpJson{"an EnergyPlus input file (epJSON)", kScript, ".epjson"};
constexpr ForeignKind kRadiance{"a Radiance scene", kScript, ".rad"};
constexpr ForeignKind kPbrt{"a pbrt scene", "pbrt --toply IN, which writes its triangle meshes as PLY files", ".pbrt"};
constexpr ForeignKind kFoam{"an OpenFOAM file",
                            "surfaceMeshExtract OUT.obj in the folder of the case, which keeps the names of patches"};

constexpr std::array<ForeignKind, 42> kForeign = {{
    kAbaqus,
    kNastran,
    kVtk,
    kVtp,
    k3ds,
    kStep,
    kIges,
    kDxf,
    kIfc,
    kEnergyPlus,
    kEpJson,
    kRadiance,
    kPbrt,
    {"a Gmsh file", kMeshio, "", {"$MeshFormat"}},
    {"a Fluent mesh", kMeshio, "", {"(0 \""}},
    {"a Gmsh or Fluent mesh (.msh)", kMeshio, ".msh"},
    {"an Abaqus, CalculiX or AVS file (.inp)", kMeshio, ".inp"},
    {"a Medit file", kMeshio, "", {"MeshVersionFormatted"}},
    {"an HDF5 file (CGNS, MED, XDMF data)", kMeshio, ".med .cgns", {"\x89HDF\r\n\x1a\n"}},
    {"a NetCDF file (Exodus)", kMeshio, ".exo", {"CDF\x01", "CDF\x02"}},
    {"a NumPy file", "meshio or trimesh in Python", "", {"\x93NUMPY"}},
    {"a Collada file", kAssimp, ".dae", {}, "<COLLADA"},
    {"an FBX file", kAssimp, ".fbx", {"Kaydara FBX Binary", "; FBX"}},
    {"an X3D file", kAssimp, ".x3d", {"#X3D"}, "<X3D"},
    {"an XDMF file", kMeshio, "", {}, "<Xdmf"},
    {"a VRML file", kAssimp, ".wrl", {"#VRML"}},
    {"a DirectX file", kAssimp, "", {"xof 0"}},
    {"an Open Inventor file", kAssimp, "", {"#Inventor"}},
    {"a USD file", kBlender, ".usd .usda .usdc", {"PXR-USDC", "#usda"}},
    {"a Blender file", kBlender, ".blend", {"BLENDER"}},
    {"a Maya file", "Maya: export Wavefront (.obj)", "", {"//Maya ASCII"}},
    {"a Rhino file (.3dm)", "Rhino: export Wavefront (.obj)", ".3dm", {"3D Geometry File Format"}},
    {"a SketchUp file", "SketchUp: export OBJ", ".skp"},
    {"a DWG file", kCad, ".dwg", {"AC10"}},
    {"an Open CASCADE file (.brep)", kCad, "", {"DBRep_DrawableShape", "CASCADE Topology"}},
    {"a gbXML file", "a BIM program: export Wavefront (.obj)", ".gbxml", {}, "<gbXML"},
    {"a Mitsuba scene", "the OBJ and PLY files that it names, which exactff reads", "", {}, "<scene version"},
    {"a ZIP archive (3MF, USDZ, FCStd, KMZ or other)", "its unpacker", "", {"PK\x03\x04"}},
    {"a file compressed by gzip", "gunzip", "", {"\x1f\x8b"}},
    {"a file compressed by zstd (a new Blender file?)",
     "unzstd, or Blender: export Wavefront",
     "",
     {"\x28\xb5\x2f\xfd"}},
    {"a file compressed by bzip2", "bunzip2", "", {"BZh"}},
    {"a file compressed by xz", "unxz", "", {"\xfd\x37zXZ"}},
}};

// The first of the table that has it.
template <class HasIt>
std::optional<ForeignKind> find_kind(const HasIt& has_it) {
  const auto* const found = std::ranges::find_if(kForeign, has_it);
  return found == kForeign.end() ? std::nullopt : std::optional(*found);
}

bool contains(std::string_view bytes, std::string_view part) { return bytes.find(part) != std::string_view::npos; }

ForeignKind markup_kind(std::string_view head) {
  if (contains(head, "<VTKFile") && contains(head, "\"PolyData\"")) return kVtp;
  const auto has_it = [&](const ForeignKind& kind) { return !kind.element.empty() && contains(head, kind.element); };
  if (const auto kind = find_kind(has_it)) return *kind;
  if (contains(head, "<html") || contains(head, "<!DOCTYPE html") || contains(head, "<!doctype html"))
    return {"a web page", "the page's own link to the file"};
  return {"an XML file", kAssimp};
}

ForeignKind json_kind(std::string_view head) {
  if (contains(head, "\"BuildingSurface:Detailed\"") || contains(head, "\"Building\"")) return kEpJson;
  return {"a JSON file", "its own program"};
}

// The first group of a DXF file: code 0, value SECTION.
bool is_dxf(std::string_view head) { return text::take_word(head) == "0" && text::take_word(head) == "SECTION"; }

// Text of a kind without a signature, by words that begin lines.
std::optional<ForeignKind> text_kind(std::string_view head) {
  text::PlainLines lines(head);
  for (text::TextLine line; lines.next(line);) {
    std::string_view rest = line.text;
    const std::string_view word = text::take_word(rest), second = text::take_word(rest);
    const std::string start = text::in_lower_case(word);
    if (word.size() > 1 && word[0] == '*' && word[1] != '*') return kAbaqus;
    if ((start == "begin" && text::in_lower_case(second) == "bulk") || word == "GRID" || word.starts_with("GRID,") ||
        word.starts_with("GRID*"))
      return kNastran;
    if (start == "buildingsurface:detailed," || start == "zone," || start.starts_with("version,")) return kEnergyPlus;
    if (word == "WorldBegin" || (word == "Shape" && second.starts_with('"'))) return kPbrt;
    if (word == "FoamFile") return kFoam;
    if (second == "polygon" || (word == "void" && (second == "plastic" || second == "light" || second == "glass")))
      return kRadiance;
  }
  return std::nullopt;
}

// Lines of 80 columns; those of the first section end in S and a number.
bool is_iges(std::string_view head) {
  constexpr std::size_t kSection = 72;
  std::string_view line = head.substr(0, head.find_first_of("\r\n"));
  if (line.size() != 80 || line[kSection] != 'S') return false;
  return text::trimmed(line.substr(kSection + 1)) == "1" || text::trimmed(line.substr(kSection + 1)) == "0000001";
}

// A chunk 0x4D4D whose length is that of the file.
bool is_3ds(std::string_view bytes) {
  if (bytes.size() < 6 || !bytes.starts_with("MM")) return false;
  std::uint32_t length = 0;
  files::read_little_endian(bytes.substr(2), std::span(&length, 1));
  return length == bytes.size();
}

bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < StlLayout::kHead) return false;
  return bytes.size() == StlLayout::kHead + StlLayout::triangle_count(bytes) * StlLayout::kTriangle;
}

std::string_view without_mark(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  return bytes;
}

bool is_ply(std::string_view head) { return head.starts_with("ply\n") || head.starts_with("ply\r"); }

// The first word that is not in a comment.
std::string_view first_word(std::string_view head) {
  text::PlainLines lines(head);
  for (text::TextLine line; lines.next(line);) {
    std::string_view rest = line.text.substr(0, line.text.find('#'));
    const std::string_view word = text::take_word(rest);
    if (!word.empty()) return word;
  }
  return {};
}

bool is_off(std::string_view word) {
  const std::string_view letters = word.substr(0, word.find_first_of("0123456789", 1));
  return letters == "OFF" || letters == "COFF" || letters == "NOFF" || letters == "CNOFF" || letters == "STOFF" ||
         letters == "4OFF" || letters == "nOFF" || letters == "STCOFF" || letters == "STNOFF" || letters == "STCNOFF";
}

// A record F 3 or F 3a: an OBJ file has no face of one vertex that comes before all vertices.
bool is_view3d(std::string_view head) {
  text::PlainLines lines(head);
  for (text::TextLine line; lines.next(line);) {
    std::string_view rest = line.text.substr(0, line.text.find('!'));
    const std::string_view word = text::take_word(rest);
    if (word == "F" || word == "f") {
      const std::string_view geometry = text::take_word(rest);
      return (geometry == "3" || text::in_lower_case(geometry) == "3a") && text::trimmed(rest).empty();
    }
    if (!word.empty() && word != "T" && word != "t" && word != "C" && word != "c" && word != "/") return false;
  }
  return false;
}

bool is_obj_keyword(std::string_view word) {
  constexpr std::array<std::string_view, 13> kKeywords = {"v", "vn",     "vt",     "vp", "f",  "g",   "o",
                                                          "s", "mtllib", "usemtl", "l",  "fo", "call"};
  return std::ranges::find(kKeywords, word) != kKeywords.end();
}

// `start` is the text without leading blanks.
bool is_gltf(std::string_view start, std::string_view extension) {
  if (start.starts_with("glTF") || extension == ".glb" || extension == ".gltf") return true;
  return start.starts_with("{") &&
         (contains(start, "\"asset\"") || contains(start, "\"meshes\"") || contains(start, "\"accessors\""));
}

std::string_view without_blanks(std::string_view head) {
  head.remove_prefix(std::min(head.find_first_not_of(" \t\r\n"), head.size()));
  return head;
}

// The extension in lower case, with its dot.
std::string lower_extension(const std::filesystem::path& path) {
  return text::in_lower_case(path.extension().string());
}

// By the content, otherwise by the extension, otherwise OBJ.
Format format_of(std::string_view bytes, const std::filesystem::path& path) {
  const std::string_view head = without_mark(bytes.substr(0, kLookedAt));
  const std::string extension = lower_extension(path);
  if (is_ply(head)) return Format::kPly;
  if (is_gltf(without_blanks(head), extension)) return Format::kGltf;
  if (is_binary_stl(bytes)) return Format::kStlBinary;
  const std::string_view word = first_word(head);
  const bool binary = contains(head, std::string_view("\0", 1));
  if (text::in_lower_case(word) == "solid") return binary ? Format::kStlBinary : Format::kStlText;
  if (is_off(word)) return Format::kOff;
  if (extension == ".ply") return Format::kPly;
  if (extension == ".off") return Format::kOff;
  if (extension == ".stl") return binary ? Format::kStlBinary : Format::kStlText;
  if (extension == ".vs3" || (extension != ".obj" && is_view3d(head))) return Format::kView3d;
  return Format::kObj;
}

// By the content; by the extension only if the content tells nothing and does not begin as that of an OBJ file.
std::optional<ForeignKind> foreign_kind(std::string_view bytes, const std::filesystem::path& path) {
  const std::string_view head = without_mark(bytes.substr(0, kLookedAt));
  if (is_binary_stl(bytes)) return std::nullopt;
  const auto starts = [&](std::string_view start) { return !start.empty() && head.starts_with(start); };
  const auto starts_it = [&](const ForeignKind& kind) { return std::ranges::any_of(kind.starts, starts); };
  if (const auto kind = find_kind(starts_it)) return kind;
  if (is_dxf(head)) return kDxf;
  if (is_iges(head)) return kIges;
  if (is_3ds(bytes)) return k3ds;
  const std::string_view start = without_blanks(head);
  if (start.starts_with("ISO-10303-21;")) return contains(head, "IFC") ? kIfc : kStep;  // schemes of one file format
  if (start.starts_with("<")) return markup_kind(head);
  if (is_gltf(start, lower_extension(path))) return std::nullopt;
  if (start.starts_with("{")) return json_kind(head);
  if (format_of(bytes, path) != Format::kObj || is_obj_keyword(first_word(head))) return std::nullopt;
  const std::string extension = lower_extension(path);
  const auto has_extension = [&](const ForeignKind& kind) {
    const std::vector<std::string_view> all = text::words(kind.extensions);
    return std::ranges::find(all, extension) != all.end();
  };
  if (const auto kind = find_kind(has_extension)) return kind;
  return extension == ".obj" ? std::nullopt : text_kind(head);
}

}  // namespace
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
    text::refuse(path, "no format is known for the extension " + text::in_quotes(extension),
                 "the extension says which format to write",
                 "name a file .obj, .ply, .stl, .off or .vs3; glTF is only read");
  }
  if (encoding == Encoding::kBinary && (wavefront || writer->binary == nullptr)) {
    text::refuse(path, "the format has no binary form", "only PLY and STL have one", "leave the encoding out");
  }
  SceneFiles result;
  formats::Losses losses(path);
  if (wavefront) {
    write_wavefront(scene, path, result, losses);
  } else {
    const bool binary = encoding == Encoding::kDefault ? writer->binary_by_default : encoding == Encoding::kBinary;
    result.files.push_back({path, (binary ? writer->binary : writer->text)(scene, losses)});
  }
  for (const int set : {0, 1}) {
    if (!scene.has_texture(set) || (wavefront && set == 0)) continue;
    losses.add("texture coordinates are lost" + std::string(wavefront ? ", those of set 1" : ""),
               wavefront ? "OBJ has one set" : "the format has none that exactff writes",
               "only lightmaps need them; write OBJ to keep set 0");
    break;
  }
  if (scene.unit() != Unit::kNone && (extension == ".stl" || extension == ".vs3")) {
    losses.add("the unit " + std::string(name_of(scene.unit())) + " is lost", "the format has no place for it",
               "give --unit where you read it");
  }
  result.losses = losses.take();
  return result;
}

// --- Reading ---

namespace {

constexpr const char* kAnyFormat = "an OBJ, glTF, PLY, STL, OFF or View3D file";

}  // namespace

Scene read_scene(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& given) {
  const SceneOptions options = formats::with_unit_of(bytes, given);
  const kernel::StandardArithmetic arithmetic;
  const std::string file = path.string();
  if (bytes.empty())
    text::refuse(file, "is empty", "there is nothing to compute with", std::string("give ") + kAnyFormat);
  if (const auto kind = formats::foreign_kind(bytes, path)) {
    text::refuse(file, "is " + std::string(kind->name), "exactff reads OBJ, glTF, PLY, STL, OFF and View3D",
                 "convert it, for example with " + std::string(kind->converter));
  }
  const formats::Format format = formats::format_of(bytes, path);
  if (format == formats::Format::kPly) return formats::read_ply(bytes, path, options);
  if (format == formats::Format::kStlBinary) return formats::read_stl_binary(bytes, path, options);
  if (format == formats::Format::kGltf) return formats::read_gltf(bytes, path, options);
  text::require_text(bytes, file, kAnyFormat);
  if (format == formats::Format::kStlText) return formats::read_stl_text(bytes, path, options);
  if (format == formats::Format::kOff) return formats::read_off(bytes, path, options);
  if (format == formats::Format::kView3d) return formats::read_view3d(bytes, path, options);
  return formats::read_obj(bytes, path, options);
}

Scene read_scene(const std::filesystem::path& path, const SceneOptions& options) {
  const std::vector<std::filesystem::path> files = formats::files_named(path);
  if (files.size() > 1) return formats::read_several(path, files, options);
  return SceneInside::read_from(path, read_scene(text::read_file(path, kAnyFormat), path, options));
}

std::vector<FaceName> read_names(const std::filesystem::path& path) {
  const std::string text = text::read_text_file(path, "a file of names for faces");
  text::ProblemList problems;
  std::vector<FaceName> names;
  text::TextLines lines(text);
  for (text::TextLine line; lines.next(line);) {
    if (line.text.empty()) continue;
    try {
      names.push_back(face_name(line.text));
    } catch (const InputError& error) {
      Problem problem = error.problems().front();
      problem.file = path.string();
      problem.line = line.number;
      problems.add(std::move(problem));
    }
  }
  problems.throw_if_any();
  return names;
}

}  // namespace exactff
