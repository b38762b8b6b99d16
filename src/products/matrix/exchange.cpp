// Matrices for other programs, as text.
#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include "exactff/matrix.h"
#include "exactff/version.h"
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
