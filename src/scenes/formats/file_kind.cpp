#include "formats/file_kind.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "formats/stl_layout.h"
#include "text/nearest_names.h"
#include "text/text_lines.h"

namespace exactff::formats {

namespace {

constexpr std::size_t kLookedAt = std::size_t{1} << 16;  // bytes of a file that show its format

constexpr std::string_view kAssimp = "assimp export IN OUT.obj, or Blender";
constexpr std::string_view kBlender = "Blender: export Wavefront (.obj)";
constexpr std::string_view kMeshio = "meshio convert IN OUT.ply, or ParaView";
constexpr std::string_view kCad = "FreeCAD, or gmsh IN -2 -o OUT.stl";
constexpr std::string_view kUnpack = "its unpacker";

struct Signature {
  std::string_view bytes;
  ForeignKind kind;
};

// The first bytes of a file.
constexpr std::array<Signature, 30> kSignatures = {{
    {"glTF", {"a binary glTF file (.glb)", kAssimp}},
    {"# vtk DataFile", {"a legacy VTK file", kMeshio}},
    {"Kaydara FBX Binary", {"an FBX file", kAssimp}},
    {"; FBX", {"an FBX file in text", kAssimp}},
    {"BLENDER", {"a Blender file", kBlender}},
    {"xof 0", {"a DirectX file", kAssimp}},
    {"#VRML", {"a VRML file", kAssimp}},
    {"#X3D", {"an X3D file", kAssimp}},
    {"#Inventor", {"an Open Inventor file", kAssimp}},
    {"PXR-USDC", {"a USD file", kBlender}},
    {"#usda", {"a USD file in text", kBlender}},
    {"//Maya ASCII", {"a Maya file", "Maya: export Wavefront (.obj)"}},
    {"3D Geometry File Format", {"a Rhino file (.3dm)", "Rhino: export Wavefront (.obj)"}},
    {"AutoCAD Binary DXF", {"a DXF file", kCad}},
    {"AC10", {"a DWG file", kCad}},
    {"DBRep_DrawableShape", {"an Open CASCADE file (.brep)", kCad}},
    {"CASCADE Topology", {"an Open CASCADE file (.brep)", kCad}},
    {"$MeshFormat", {"a Gmsh file", kMeshio}},
    {"MeshVersionFormatted", {"a Medit file", kMeshio}},
    {"*HEADING", {"an Abaqus file", kMeshio}},
    {"*Heading", {"an Abaqus file", kMeshio}},
    {"\x89HDF\r\n\x1a\n", {"an HDF5 file (CGNS, MED, XDMF data)", kMeshio}},
    {"CDF\x01", {"a NetCDF file (Exodus)", kMeshio}},
    {"CDF\x02", {"a NetCDF file (Exodus)", kMeshio}},
    {"\x93NUMPY", {"a NumPy file", "meshio or trimesh in Python"}},
    {"PK\x03\x04", {"a ZIP archive (3MF, USDZ, FCStd, KMZ or other)", kUnpack}},
    {"\x1f\x8b", {"a file compressed by gzip", "gunzip"}},
    {"\x28\xb5\x2f\xfd", {"a file compressed by zstd (a new Blender file?)", "unzstd, or Blender: export Wavefront"}},
    {"BZh", {"a file compressed by bzip2", "bunzip2"}},
    {"\xfd"
     "7zXZ",
     {"a file compressed by xz", "unxz"}},
}};

bool contains(std::string_view bytes, std::string_view part) { return bytes.find(part) != std::string_view::npos; }

// STEP and IFC are schemes of one file format.
ForeignKind step_kind(std::string_view head) {
  if (contains(head, "IFC")) return {"an IFC file", "IfcConvert IN OUT.obj"};
  return {"a STEP file", kCad};
}

std::optional<ForeignKind> markup_kind(std::string_view head) {
  if (contains(head, "<VTKFile")) return ForeignKind{"a VTK XML file", kMeshio};
  if (contains(head, "<COLLADA")) return ForeignKind{"a Collada file", kAssimp};
  if (contains(head, "<X3D")) return ForeignKind{"an X3D file", kAssimp};
  if (contains(head, "<Xdmf")) return ForeignKind{"an XDMF file", kMeshio};
  if (contains(head, "<gbXML")) return ForeignKind{"a gbXML file", "a BIM program: export Wavefront (.obj)"};
  if (contains(head, "<html") || contains(head, "<!DOCTYPE html") || contains(head, "<!doctype html"))
    return ForeignKind{"a web page", "the page's own link to the file"};
  return ForeignKind{"an XML file", kAssimp};
}

// The first group of a DXF file: code 0, value SECTION.
bool is_dxf(std::string_view head) { return text::take_word(head) == "0" && text::take_word(head) == "SECTION"; }

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
  std::size_t length = 0;
  for (std::size_t i = 6; i-- > 2;) length = length << 8U | static_cast<unsigned char>(bytes[i]);
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

}  // namespace

std::string lower_extension(const std::filesystem::path& path) {
  return text::in_lower_case(path.extension().string());
}

std::optional<ForeignKind> foreign_kind(std::string_view bytes) {
  const std::string_view head = without_mark(bytes.substr(0, kLookedAt));
  if (is_binary_stl(bytes)) return std::nullopt;
  for (const Signature& signature : kSignatures) {
    if (head.starts_with(signature.bytes)) return signature.kind;
  }
  if (is_dxf(head)) return ForeignKind{"a DXF file", kCad};
  if (is_iges(head)) return ForeignKind{"an IGES file", kCad};
  if (is_3ds(bytes)) return ForeignKind{"a 3DS file", kAssimp};
  std::string_view start = head;
  start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
  if (start.starts_with("ISO-10303-21;")) return step_kind(head);
  if (start.starts_with("<")) return markup_kind(head);
  if (start.starts_with("{")) {
    const bool gltf = contains(head, "\"asset\"") || contains(head, "\"meshes\"") || contains(head, "\"accessors\"");
    return gltf ? ForeignKind{"a glTF file", kAssimp} : ForeignKind{"a JSON file", "its own program"};
  }
  return std::nullopt;
}

Format format_of(std::string_view bytes, const std::filesystem::path& path) {
  const std::string_view head = without_mark(bytes.substr(0, kLookedAt));
  const std::string extension = lower_extension(path);
  if (is_ply(head)) return Format::kPly;
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

}  // namespace exactff::formats
