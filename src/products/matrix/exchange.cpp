// Matrices for other programs, as text.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <set>
#include <span>

#include "exactff/matrix.h"
#include "exactff/version.h"
#include "files/numpy.h"
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

void require_square(const Factors& all, const std::string& program) {
  if (!all.from.empty() && all.from == all.to) return;
  text::refuse("the matrix has not the same patches as rows and as columns",
               program + " reads the factors of all pairs of some surfaces",
               "give --from and --to the same patches, or neither");
}

// 1 - Kd, on average over the channels. Of the first face, if faces differ.
double emittance(const Scene& scene, const Selection& patch) {
  const Rgb kd = scene.material(scene.face(scene.faces_of(patch).front()).material).reflectance;
  return std::clamp(1.0 - (kd.r + kd.g + kd.b) / 3.0, 0.0, 1.0);
}

}  // namespace

std::string view3d_text(const Scene& scene, const Matrix& matrix) {
  const Factors& all = matrix.factors;
  require_square(all, "View3D's output");
  const std::size_t count = all.from.size();
  std::string text = "exactff " + std::string(kVersion) + " 0 0 0 " + std::to_string(count);
  text.resize(std::max<std::size_t>(text.size(), 30), ' ');
  text += '\n';
  const auto add_line = [&](std::chars_format format, int digits, const auto& number) {
    for (std::size_t j = 0; j < count; ++j) text += (j > 0 ? " " : "") + digits_of(number(j), format, digits);
    text += '\n';
  };
  constexpr auto kGeneral = std::chars_format::general, kFixed = std::chars_format::fixed;
  add_line(kGeneral, 6, [&](std::size_t i) { return all.at(i, i).area_from; });
  for (std::size_t i = 0; i < count; ++i) {
    add_line(kFixed, 6, [&](std::size_t j) { return all.at(i, j).value; });
  }
  add_line(kFixed, 3, [&](std::size_t i) { return emittance(scene, all.from[i]); });
  return text;
}

namespace {

// The head of a file of OpenFOAM, and a list of lists: of each row, the text of each entry that is not 0.
template <class Text>
std::string foam_lists(const char* of, const char* object, const Factors& all, const Text& text) {
  const std::size_t count = all.from.size();
  std::string result = std::string("FoamFile\n{\n    version 2.0;\n    format ascii;\n    class ") + of +
                       ";\n    object " + object + ";\n}\n\n" + std::to_string(count) + "\n(\n";
  for (std::size_t i = 0; i < count; ++i) {
    std::string row;
    std::size_t seen = 0;
    for (std::size_t j = 0; j < count; ++j) {
      if (all.at(i, j).value > 0.0) row += (seen++ > 0 ? " " : "") + text(i, j);
    }
    result += std::to_string(seen) + '(' + row + ")\n";
  }
  return result + ")\n";
}

// An unformatted record of Fortran.
template <class T>
void add_record(std::string& bytes, const std::vector<T>& values) {
  const std::array<std::uint32_t, 1> length{static_cast<std::uint32_t>(values.size() * sizeof(T))};
  const std::string mark = files::little_endian(std::span<const std::uint32_t>(length));
  bytes += mark + files::little_endian(std::span<const T>(values)) + mark;
}

// Element and face of patches named "12:3".
std::vector<std::string> nek_faces(const Scene& scene, const Factors& all) {
  std::vector<std::string> named, numbered;
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    numbered.push_back(std::to_string(i + 1) + " 1");
    std::string name = scene.name_of(all.from[i]);
    const std::size_t colon = name.find(':');
    const auto is_number = [](std::string_view text) {
      return !text.empty() && std::ranges::all_of(text, [](char c) { return '0' <= c && c <= '9'; });
    };
    if (colon == std::string::npos || !is_number(name.substr(0, colon)) || !is_number(name.substr(colon + 1))) continue;
    name[colon] = ' ';
    named.push_back(name);
  }
  return named.size() == numbered.size() ? named : numbered;
}

}  // namespace

OpenFoamFiles openfoam_files(const Scene&, const Matrix& matrix) {
  const Factors& all = matrix.factors;
  require_square(all, "OpenFOAM");
  return {foam_lists("scalarListList", "F", all,
                     [&](std::size_t i, std::size_t j) { return text::shortest(all.at(i, j).value); }),
          foam_lists("labelListList", "globalFaceFaces", all,
                     [](std::size_t, std::size_t j) { return std::to_string(j); })};
}

std::string calculix_text(const Scene&, const Matrix& matrix) {
  const Factors& all = matrix.factors;
  require_square(all, "CalculiX");
  const std::size_t count = all.from.size();
  std::vector<double> diagonal, others, environment;
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < count; ++j) sum += all.at(i, j).value;
    diagonal.push_back(all.at(i, i).value);
    environment.push_back(std::max(0.0, 1.0 - sum));
  }
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t i = j + 1; i < count; ++i) others.push_back(all.at(i, j).value);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i + 1; j < count; ++j) others.push_back(all.at(i, j).value);
  constexpr std::size_t kLargestRecord =
      (std::size_t{1} << 31) - 16;  // longer ones are split, by each compiler in its way
  if (others.size() * sizeof(double) > kLargestRecord) {
    text::refuse("the matrix has " + text::counted(count, "row") + ", too many for a file of CalculiX",
                 "a record of Fortran ends at 2 GiB", "use fewer patches");
  }
  std::string version = "Version 2.20", bytes;
  version.resize(80, ' ');
  const std::span<const std::uint8_t> letters(reinterpret_cast<const std::uint8_t*>(version.data()), version.size());
  add_record(bytes, std::vector<std::uint8_t>(letters.begin(), letters.end()));
  for (const std::vector<double>& record : {diagonal, others, environment}) add_record(bytes, record);
  return bytes;
}

std::string moose_text(const Scene&, const Matrix& matrix) {
  const Factors& all = matrix.factors;
  require_square(all, "MOOSE");
  std::string text = "subdomain_id";
  for (std::size_t j = 1; j <= all.to.size(); ++j) text += ",vf_to_" + std::to_string(j);
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    text += '\n' + std::to_string(i + 1);
    for (std::size_t j = 0; j < all.to.size(); ++j) text += ',' + text::shortest(all.at(i, j).value);
  }
  return text + '\n';
}

std::string nek_text(const Scene& scene, const Matrix& matrix) {
  const Factors& all = matrix.factors;
  require_square(all, "Nek5000");
  const std::vector<std::string> faces = nek_faces(scene, all);
  std::string text = std::to_string(faces.size()) + '\n';
  const auto wall = [&](std::size_t i) { return std::to_string(i + 1) + ' ' + faces[i] + ' '; };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    std::string seen;
    std::size_t count = 0;
    for (std::size_t j = 0; j < faces.size(); ++j) {
      if (all.at(i, j).value == 0.0) continue;
      seen += wall(j) + text::shortest(all.at(i, j).value) + '\n';
      ++count;
    }
    text += wall(i) + std::to_string(count) + '\n' + seen;
  }
  return text;
}

namespace {

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

}  // namespace

std::string energyplus_text(const Scene& scene, const Matrix& matrix, const std::string& zone) {
  const Factors& all = matrix.factors;
  require_square(all, "EnergyPlus");
  std::vector<std::string> names;
  std::set<std::string> distinct;
  for (const Selection& patch : all.from) {
    names.push_back(energyplus_name(scene.name_of(patch)));
    if (distinct.insert(text::in_lower_case(names.back())).second) continue;
    text::refuse("two patches are named " + text::in_quotes(names.back()) + " apart from upper and lower case",
                 "EnergyPlus does not tell them apart", "rename one");
  }
  std::string text = "! exactff " + std::string(kVersion) + " matrix, scene hash " + scene.hash() +
                     "\nZoneProperty:UserViewFactors:bySurfaceName,\n  " + energyplus_name(zone);
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < names.size(); ++j) {
      text += ",\n  " + names[i] + ", " + names[j] + ", " + text::shortest(all.at(i, j).value);
    }
  }
  return text + ";\n";
}

}  // namespace exactff::matrix
