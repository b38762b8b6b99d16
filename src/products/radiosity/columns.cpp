// Solutions as tables: a row for each patch and channel.
#include "matrix/columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/radiosity.h"
#include "exactff/version.h"
#include "kernel/float_environment.h"
#include "table/fields.h"
#include "text/text_lines.h"
#include "vtk/vtk.h"

namespace exactff::radiosity {
namespace {

using table::Cell;
using table::Strength;
using table::Type;
using Field = table::Field<SolutionFile::Row>;

constexpr std::string_view kTableKind = "radiosity";
constexpr const char* kAdvice = "use the file as `exactff radiosity` wrote it";

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kNoUpperBound = std::numeric_limits<double>::infinity();

// What an empty field means: what is infinite or not known is one.
enum class Empty { kNone, kZero, kUnbounded };

template <auto Of, Empty Meaning>
Field number(std::string name, std::string unit, Strength strength) {
  return {{std::move(name), Type::kNumber, std::move(unit), strength},
          [](const SolutionFile::Row& row) -> Cell {
            const double value = Of(row);
            return std::isfinite(value) ? Cell(value) : Cell();
          },
          [](SolutionFile::Row& row, const Cell& cell) {
            const double* const value = std::get_if<double>(&cell);
            constexpr double kEmpty = Meaning == Empty::kZero ? 0.0 : Meaning == Empty::kNone ? kNan : kNoUpperBound;
            Of(row) = value != nullptr ? *value : kEmpty;
            return true;
          }};
}

template <auto Quantity>
void add_bounded(std::vector<Field>& list, const std::string& name, const std::string& lower,
                 const std::string& upper) {
  list.push_back(
      number<[](auto& row) -> auto& { return (row.*Quantity).value; }, Empty::kNone>(name, "Ke", Strength::kEstimated));
  list.push_back(
      number<[](auto& row) -> auto& { return (row.*Quantity).lower; }, Empty::kZero>(lower, "Ke", Strength::kStated));
  list.push_back(number<[](auto& row) -> auto& { return (row.*Quantity).upper; }, Empty::kUnbounded>(
      upper, "Ke", Strength::kStated));
}

Field channel() {
  return {{.name = "channel", .type = Type::kText, .key = true},
          [](const SolutionFile::Row& row) -> Cell { return kChannelNames.at(row.channel); },
          [](SolutionFile::Row& row, const Cell& cell) {
            const auto found = std::ranges::find(kChannelNames, std::get<std::string_view>(cell));
            row.channel = static_cast<std::size_t>(found - kChannelNames.begin());
            return found != kChannelNames.end();
          }};
}

Field claim() {
  return {{.name = "claim", .type = Type::kText, .strength = Strength::kProved},
          [](const SolutionFile::Row& row) -> Cell { return row.claim ? to_string(*row.claim) : kNoBound; },
          [](SolutionFile::Row& row, const Cell& cell) {
            const auto word = std::get<std::string_view>(cell);
            row.claim = matrix::named<Claim>(word);
            return row.claim || word == kNoBound;
          }};
}

table::Fields<SolutionFile::Row> columns(bool variation) {
  using Row = SolutionFile::Row;
  std::vector<Field> list = {table::member_field<&Row::patch, Row>({.name = "patch", .key = true}), channel()};
  add_bounded<&Row::radiosity>(list, "radiosity", "lower", "upper");
  add_bounded<&Row::irradiance>(list, "irradiance", "irradiance_lower", "irradiance_upper");
  list.push_back(claim());
  list.push_back(
      number<[](auto& row) -> auto& { return row.area; }, Empty::kZero>("area", "area", Strength::kEstimated));
  if (variation) {
    list.push_back(number<[](auto& row) -> auto& { return row.variation; }, Empty::kNone>("variation", "Ke",
                                                                                          Strength::kEstimated));
  }
  return {std::string(kTableKind), std::move(list)};
}

}  // namespace

table::Table table_of(const Scene& scene, const Solution& solution, const ViewFactorOptions& options,
                      const Origin& origin) {
  const kernel::StandardArithmetic arithmetic;
  table::Head head;
  matrix::set_scene(head, scene);
  if (origin.divided) head.set("divided", *origin.divided);
  if (!origin.two_sided.empty()) head.set("two_sided", origin.two_sided);
  matrix::set_options(head, options);
  head.set("wide_entries", std::uint64_t{solution.wide});
  if (solution.width) {
    head.set("width", *solution.width);
    head.set("entries_again", std::uint64_t{solution.computed_again});
  }
  const bool varies = !solution.channels.front().variation.empty();
  const table::Fields<SolutionFile::Row> fields = columns(varies);
  table::Table table(fields.kind(), std::move(head), fields.columns());
  SolutionFile::Row row;
  for (std::size_t i = 0; i < solution.patches.size(); ++i) {
    row.patch = scene.name_of(solution.patches[i]);
    row.area = solution.areas[i];
    for (row.channel = 0; row.channel < solution.channels.size(); ++row.channel) {
      const Channel& channel = solution.channels[row.channel];
      row.radiosity = channel.radiosity[i];
      row.irradiance = channel.irradiance[i];
      row.claim = channel.is_bounded() ? std::optional(solution.claim) : std::nullopt;
      if (varies) row.variation = channel.variation[i];
      fields.append(row, table);
    }
  }
  return table;
}

SolutionFile read_solution(const std::filesystem::path& path) {
  const kernel::StandardArithmetic arithmetic;
  const table::Table table = table::read(path);
  text::ProblemList problems;
  const auto complain = [&](std::size_t line, std::string what) {
    problems.add({path.string(), line, std::move(what), "the file contradicts itself", kAdvice});
  };
  const table::Head& head = table.head();
  SolutionFile file{.file = path.string(), .scene_hash = head.text("scene_hash").value_or("")};
  if (table.kind() != kTableKind || file.scene_hash.empty()) {
    complain(1, "is no table of radiosities, or does not say of which scene");
    problems.throw_if_any();
  }
  file.origin = {head.number("divided"), head.list("two_sided")};
  if (file.origin.divided && !(*file.origin.divided > 0.0)) complain(1, "the scene was divided by no positive length");
  file.options = matrix::options_of(head);
  file.wide = head.count("wide_entries").value_or(0);
  file.width = head.number("width");
  const table::Fields<SolutionFile::Row> fields = columns(true);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    SolutionFile::Row row;
    const auto bad = fields.read(table, i, row);
    const BoundedValue& b = row.radiosity;
    if (bad) {
      complain(table.line_of(i), "column " + text::in_quotes(*bad) + " has an impossible value");
    } else if (!(0.0 <= b.lower && b.lower <= b.upper) || b.value < b.lower || b.value > b.upper ||
               (std::isfinite(b.upper) && std::isnan(b.value))) {
      complain(table.line_of(i), "the radiosity is not within its bounds, or negative");
    }
    if (row.claim) file.claim = matrix::weaker(file.claim, *row.claim);
    file.rows.push_back(std::move(row));
  }
  problems.throw_if_any();
  return file;
}

// --- For ParaView ---

void write_vtk(const Scene& scene, const Solution& solution, const std::filesystem::path& file) {
  const kernel::StandardArithmetic arithmetic;
  const auto field = [&](const char* name, std::vector<BoundedValue> Channel::*quantity, double BoundedValue::*number) {
    return vtk::field_of_faces(scene, name, solution.patches, kChannelNames.size(), [&](std::size_t i, std::size_t c) {
      return (solution.channels[c].*quantity)[i].*number;
    });
  };
  vtk::write_faces(scene,
                   {field("radiosity", &Channel::radiosity, &BoundedValue::value),
                    field("lower", &Channel::radiosity, &BoundedValue::lower),
                    field("upper", &Channel::radiosity, &BoundedValue::upper),
                    field("irradiance", &Channel::irradiance, &BoundedValue::value)},
                   {"exactff " + std::string(kVersion) + ", radiosity"}, file);
}

}  // namespace exactff::radiosity
