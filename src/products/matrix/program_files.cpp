// Files of other programs, a row of kFormats each, and the archive for NumPy.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <set>
#include <span>

#include "exactff/matrix.h"
#include "exactff/version.h"
#include "files/numpy.h"
#include "kernel/float_environment.h"
#include "matrix/rows.h"
#include "scene/selections.h"
#include "text/encoding.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::matrix {
namespace {

std::string digits_of(double value, std::chars_format format, int digits) {
  std::array<char, 64> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format, digits).ptr;
  return {buffer.data(), end};
}

// --- View3D and EnergyPlus ---

// 1 - Kd, on average over the channels. Of the first face, if faces differ.
double emittance(const Scene& scene, const Selection& patch) {
  const Rgb kd = scene.material(scene.face(scene.faces_of(patch).front()).material).reflectance;
  return std::clamp(1.0 - (kd.r + kd.g + kd.b) / 3.0, 0.0, 1.0);
}

Texts view3d(const Square& all) {
  std::string text = "exactff " + std::string(kVersion) + " 0 0 0 " + std::to_string(all.size());
  text.resize(std::max<std::size_t>(text.size(), 30), ' ');
  text += '\n';
  const auto add_line = [&](std::chars_format format, int digits, const auto& number) {
    for (std::size_t j = 0; j < all.size(); ++j) text += (j > 0 ? " " : "") + digits_of(number(j), format, digits);
    text += '\n';
  };
  constexpr auto kGeneral = std::chars_format::general, kFixed = std::chars_format::fixed;
  add_line(kGeneral, 6, [&](std::size_t i) { return all.areas[i]; });
  for (std::size_t i = 0; i < all.size(); ++i) {
    add_line(kFixed, 6, [&](std::size_t j) { return all.at(i, j); });
  }
  add_line(kFixed, 3, [&](std::size_t i) { return emittance(*all.scene, all.patches[i]); });
  return {text};
}

// A field of an input file of EnergyPlus, where commas, semicolons, exclamation marks and ends of lines mean something.
std::string energyplus_name(const std::string& given) {
  const std::string name = text::in_utf8(given);
  const bool is_plain = std::ranges::none_of(
      name, [](char c) { return c == ',' || c == ';' || c == '!' || static_cast<unsigned char>(c) < 0x20; });
  if (is_plain && !name.empty() && text::trimmed(name) == name) return name;
  text::refuse("the name " + text::in_quotes(name) + " cannot stand in an input file of EnergyPlus",
               "a comma, a semicolon or an exclamation mark ends a field there, and blanks around a name are lost",
               "rename the patch, or the zone");
}

Texts energyplus(const Square& all) {
  std::vector<std::string> names;
  std::set<std::string> distinct;
  for (const Selection& patch : all.patches) {
    names.push_back(energyplus_name(all.scene->name_of(patch)));
    if (distinct.insert(text::in_lower_case(names.back())).second) continue;
    text::refuse("two patches are named " + text::in_quotes(names.back()) + " apart from upper and lower case",
                 "EnergyPlus does not tell them apart", "rename one");
  }
  std::string text = "! exactff " + std::string(kVersion) + " matrix, scene hash " + all.scene->hash() +
                     "\nZoneProperty:UserViewFactors:bySurfaceName,\n  " + energyplus_name(all.zone);
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < names.size(); ++j) {
      text += ",\n  " + names[i] + ", " + names[j] + ", " + text::shortest(all.at(i, j));
    }
  }
  return {text + ";\n"};
}

// --- OpenFOAM ---

std::string foam_head(const std::string& of, std::string_view object) {
  return "FoamFile\n{\n    version 2.0;\n    format ascii;\n    class " + of + ";\n    location \"constant\";\n" +
         "    object " + std::string(object) + ";\n}\n\n";
}

template <class Rows, class Text>
std::string foam_lists(const Rows& rows, const Text& text) {
  std::string result = std::to_string(rows.size()) + "\n(\n";
  for (const auto& row : rows) {
    result += std::to_string(row.size()) + '(';
    for (std::size_t k = 0; k < row.size(); ++k) result += (k > 0 ? " " : "") + text(row[k]);
    result += ")\n";
  }
  return result + ")\n";
}

bool is_number(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return '0' <= c && c <= '9'; });
}

// The agglomeration: for each patch of the mesh and each of its faces, the coarse face. Patches NAME:1, NAME:2, ... in
// succession are coarse faces of one patch NAME.
std::vector<std::vector<std::size_t>> agglomeration(const Square& all) {
  std::vector<std::vector<std::size_t>> mesh;
  std::string next;
  std::size_t coarse = 0;
  for (const Selection& patch : all.patches) {
    const std::string name = all.scene->name_of(patch);
    coarse = !mesh.empty() && name == next ? coarse + 1 : 0;
    if (coarse == 0) mesh.emplace_back();
    const std::size_t colon = name.rfind(':');
    next = coarse > 0 || (colon != std::string::npos && name.substr(colon) == ":1")
               ? name.substr(0, colon + 1) + std::to_string(coarse + 2)
               : "";
    mesh.back().insert(mesh.back().end(), all.scene->faces_of(patch).size(), coarse);
  }
  return mesh;
}

Texts openfoam(const Square& all) {
  std::vector<std::vector<double>> factors(all.size());
  std::vector<std::vector<std::size_t>> faces(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (all.at(i, j) <= 0.0) continue;
      factors[i].push_back(all.at(i, j));
      faces[i].push_back(j);
    }
  }
  const auto whole = [](std::size_t number) { return std::to_string(number); };
  std::string all_faces = "1(" + whole(all.size()) + '(';  // of the one process
  for (std::size_t k = 0; k < all.size(); ++k) all_faces += (k > 0 ? " " : "") + whole(k);
  all_faces += "))\n";
  return {foam_head("scalarListList", "F") + foam_lists(factors, text::shortest),
          foam_head("labelListList", kOpenFoamFiles[0]) + foam_lists(faces, whole),
          foam_head("labelListList", kOpenFoamFiles[1]) + foam_lists(agglomeration(all), whole),
          foam_head("mapDistribute", kOpenFoamFiles[2]) + whole(all.size()) + '\n' + all_faces + all_faces +
              "0 0\n0()\n0()\n"};
}

// --- CalculiX ---

// An unformatted record of Fortran.
template <class T>
void add_record(std::string& bytes, const std::vector<T>& values) {
  const std::array<std::uint32_t, 1> length{static_cast<std::uint32_t>(values.size() * sizeof(T))};
  const std::string mark = files::little_endian(std::span<const std::uint32_t>(length));
  bytes += mark + files::little_endian(std::span<const T>(values)) + mark;
}

Texts calculix(const Square& all) {
  std::vector<double> diagonal, others, environment;
  for (std::size_t i = 0; i < all.size(); ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < all.size(); ++j) sum += all.at(i, j);
    diagonal.push_back(all.at(i, i));
    environment.push_back(std::max(0.0, 1.0 - sum));
  }
  for (std::size_t j = 0; j < all.size(); ++j)
    for (std::size_t i = j + 1; i < all.size(); ++i) others.push_back(all.at(i, j));
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j) others.push_back(all.at(i, j));
  constexpr std::size_t kLargestRecord =
      (std::size_t{1} << 31) - 16;  // longer ones are split, by each compiler in its way
  if (others.size() * sizeof(double) > kLargestRecord) {
    text::refuse("the matrix has " + text::counted(all.size(), "row") + ", too many for a file of CalculiX",
                 "a record of Fortran ends at 2 GiB", "use fewer patches");
  }
  std::string version = "Version 2.20", bytes;
  version.resize(80, ' ');
  const std::span<const std::uint8_t> letters(reinterpret_cast<const std::uint8_t*>(version.data()), version.size());
  add_record(bytes, std::vector<std::uint8_t>(letters.begin(), letters.end()));
  for (const std::vector<double>& record : {diagonal, others, environment}) add_record(bytes, record);
  return {bytes};
}

// --- MOOSE, Nek5000, ESATAN ---

Texts moose(const Square& all) {
  std::string text = "subdomain_id";
  for (std::size_t j = 1; j <= all.size(); ++j) text += ",vf_to_" + std::to_string(j);
  for (std::size_t i = 0; i < all.size(); ++i) {
    text += '\n' + std::to_string(i + 1);
    for (std::size_t j = 0; j < all.size(); ++j) text += ',' + text::shortest(all.at(i, j));
  }
  return {text + '\n'};
}

// Element and face of patches named "12:3".
std::vector<std::string> nek_faces(const Square& all) {
  std::vector<std::string> named, numbered;
  for (std::size_t i = 0; i < all.size(); ++i) {
    numbered.push_back(std::to_string(i + 1) + " 1");
    std::string name = all.scene->name_of(all.patches[i]);
    const std::size_t colon = name.find(':');
    if (colon == std::string::npos || !is_number(name.substr(0, colon)) || !is_number(name.substr(colon + 1))) continue;
    name[colon] = ' ';
    named.push_back(name);
  }
  return named.size() == numbered.size() ? named : numbered;
}

Texts nek(const Square& all) {
  const std::vector<std::string> faces = nek_faces(all);
  std::string text = std::to_string(faces.size()) + '\n';
  const auto wall = [&](std::size_t i) { return std::to_string(i + 1) + ' ' + faces[i] + ' '; };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    std::string seen;
    std::size_t count = 0;
    for (std::size_t j = 0; j < faces.size(); ++j) {
      if (all.at(i, j) == 0.0) continue;
      seen += wall(j) + text::shortest(all.at(i, j)) + '\n';
      ++count;
    }
    text += wall(i) + std::to_string(count) + '\n' + seen;
  }
  return {text};
}

// Nodes are numbered from 1; after the patches comes the rest. Each pair once.
Texts esatan(const Square& all) {
  std::string text = "# exactff " + std::string(kVersion) + ", radiative conductors in " +
                     (all.scene->unit() == Unit::kNone ? "squares of the scene's unit of length" : "m^2") +
                     ", scene hash " + all.scene->hash() + '\n';
  std::size_t nodes = 0;
  const auto name = [&](const std::string& node) {
    text += "# node " + std::to_string(++nodes) + ": " + text::in_quotes(node) + '\n';
  };
  for (const Selection& patch : all.patches) name(all.scene->name_of(patch));
  for (const auto& [rest, values] : all.rest) name(std::string(rest));
  const double square_metres = metres(all.scene->unit()) * metres(all.scene->unit());
  const auto add = [&](std::size_t i, std::size_t j, double conductor) {
    if (conductor <= 0.0) return;
    conductor *= square_metres;
    text += "GR(" + std::to_string(i) + ", " + std::to_string(j) + ") = " + text::shortest(conductor) + ";\n";
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) add(i + 1, j + 1, all.at(i, j));
    for (std::size_t k = 0; k < all.rest.size(); ++k) add(i + 1, all.size() + k + 1, all.rest[k].second[i]);
  }
  return {text};
}

constexpr std::string_view kNumbers = "bounds and names; patches are numbered in the order of the rows";
constexpr std::array kFormats{
    ProgramFormat{"view3d", "View3D", ".out", "Write the matrix as View3D does, with six decimals",
                  "bounds, names, and all but six decimals: factors below 5e-7 become 0", false, view3d},
    ProgramFormat{"energyplus", "EnergyPlus", ".idf", "Write view factors for the input file of EnergyPlus", "bounds",
                  false, energyplus},
    ProgramFormat{"openfoam", "OpenFOAM", "",
                  "Write F as OpenFOAM's viewFactorsGen does, and globalFaceFaces, finalAgglom and mapDist beside it",
                  "bounds and names; patches must be in the order of constant/polyMesh/boundary", false, openfoam},
    ProgramFormat{"calculix", "CalculiX", ".vwf", "Write the file (.vwf) that *VIEWFACTOR, READ of CalculiX 2.20 reads",
                  kNumbers, false, calculix},
    ProgramFormat{"moose", "MOOSE", "", "Write CSV as MOOSE's ViewFactorVectorPostprocessor does", kNumbers, false,
                  moose},
    ProgramFormat{"nek", "Nek5000", "",
                  "Write view factors for Nek5000 and NekRS; a patch named 12:3 is face 3 of element 12",
                  "bounds; names, unless all are as 12:3; patches are numbered in the order of the rows", false, nek},
    ProgramFormat{"esatan", "ESATAN", ".gr",
                  "Write the conductors in m^2 as lines GR(1, 2) = ...; computes backs and the sky, too",
                  "bounds; comments have the names", true, esatan}};

}  // namespace

std::span<const ProgramFormat> program_formats() { return kFormats; }

Square square_of(const ProgramFormat& format, const Scene& scene, const Matrix& matrix, std::string zone) {
  const Factors& all = matrix.factors;
  if (all.from.empty() || all.from != all.to) {
    text::refuse("the matrix has not the same patches as rows and as columns",
                 std::string(format.program) + " reads the factors of all pairs of some surfaces",
                 "give --from and --to the same patches, or neither");
  }
  Square square{.scene = &scene, .patches = all.from, .zone = std::move(zone)};
  for (std::size_t i = 0; i < all.from.size(); ++i) square.areas.push_back(all.at(i, 0).area_from);
  for (const ViewFactor& f : all.entries) square.values.push_back(f.value);
  return square;
}

std::vector<std::pair<std::filesystem::path, std::string>> files_of(const ProgramFormat& format, const Square& square,
                                                                    const std::filesystem::path& path) {
  std::vector<std::pair<std::filesystem::path, std::string>> files;
  for (std::string& text : format.texts(square)) {
    files.emplace_back(files.empty() ? path : path.parent_path() / kOpenFoamFiles[files.size() - 1], std::move(text));
  }
  return files;
}

// --- NumPy ---

namespace {

// [value - radius, value + radius] holds the bounds.
double radius_of(const ViewFactor& f) {
  const double radius = std::max(f.upper - f.value, f.value - f.lower);
  return radius == 0.0 ? 0.0 : kernel::above(radius);
}

ViewFactor with_value(ViewFactor f, double value) {
  f.value = value;
  return f;
}

// `balanced`: the values to take, or null.
void add_column(files::NpzFile& file, const std::string& name, const std::vector<ViewFactor>& column,
                const std::vector<double>* balanced) {
  if (column.empty()) return;
  std::vector<double> values, radii;
  for (std::size_t i = 0; i < column.size(); ++i) {
    const ViewFactor f = balanced == nullptr ? column[i] : with_value(column[i], (*balanced)[i]);
    values.push_back(f.value);
    radii.push_back(radius_of(f));
  }
  file.add(name, values);
  file.add(name + "_radius", radii);
}

void add_sums_of(files::NpzFile& file, const Matrix& matrix) {
  if (matrix.sums.empty()) return;
  std::vector<std::string> names;
  for (const GroupSum& sum : matrix.sums) names.push_back(sum.name);
  std::vector<double> values, radii;
  for (std::size_t i = 0; i < matrix.factors.from.size(); ++i) {
    for (const GroupSum& sum : matrix.sums) {
      values.push_back(sum.factors[i].value);
      radii.push_back(radius_of(sum.factors[i]));
    }
  }
  file.add_texts("sum_of", names);
  file.add("sum", values);
  file.add("sum_radius", radii);
}

}  // namespace

void write_npz(const Scene& scene, const Matrix& matrix, const std::filesystem::path& path, const Balanced* balanced) {
  const Factors& all = matrix.factors;
  std::vector<double> values, factors, radii, area_from, area_to;
  std::vector<std::int64_t> columns, starts{0};
  std::vector<std::string> claims, ways;
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    for (std::size_t j = 0; j < all.to.size(); ++j) {
      const ViewFactor& computed = all.at(i, j);
      if (i == 0) area_to.push_back(computed.area_to);
      if (computed.claim == Claim::kZero) continue;
      const ViewFactor f =
          balanced == nullptr ? computed : with_value(computed, balanced->entries[(i * all.to.size()) + j]);
      values.push_back(f.value);
      factors.push_back(computed.value);
      radii.push_back(radius_of(f));
      columns.push_back(static_cast<std::int64_t>(j));
      claims.emplace_back(to_string(f.claim));
      ways.emplace_back(to_string(f.way));
    }
    starts.push_back(static_cast<std::int64_t>(values.size()));
    area_from.push_back(area_of_row(matrix, i));
  }
  files::NpzFile file(path);
  file.add_word("format", "csr");
  file.add("shape", std::vector{static_cast<std::int64_t>(all.from.size()), static_cast<std::int64_t>(all.to.size())});
  file.add("indptr", starts);
  file.add("indices", columns);
  file.add("data", values);
  if (balanced != nullptr) file.add("factor", factors);
  file.add("radius", radii);
  file.add_texts("claim", claims);
  file.add_texts("way", ways);
  file.add_texts("from", names_of(scene, all.from));
  file.add_texts("to", names_of(scene, all.to));
  file.add("area_from", area_from);
  file.add("area_to", area_to);
  add_column(file, "back", matrix.back, balanced == nullptr ? nullptr : &balanced->back);
  add_column(file, "open", matrix.open, balanced == nullptr ? nullptr : &balanced->open);
  add_column(file, "buried", matrix.buried, balanced == nullptr ? nullptr : &balanced->buried);
  if (balanced == nullptr) add_sums_of(file, matrix);
  file.commit();
}

}  // namespace exactff::matrix
