#include "truth/columns.h"

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "exactff/enclosure.h"
#include "kernel/ball.h"
#include "kernel/expect.h"
#include "kernel/vec.h"

namespace exactff::truth {
namespace {

using table::Cell;
using table::Column;
using table::Strength;
using table::Type;
using Field = table::Field<Row>;

constexpr std::string_view kKink = "kink";

// A number that Of finds in the row, to read it or to set it.
template <auto Of>
Field number(std::string name, std::string unit, Strength strength) {
  return {{std::move(name), Type::kNumber, std::move(unit), strength},
          [](const Row& row) -> Cell {
            const double value = Of(row);
            return std::isnan(value) ? Cell() : Cell(value);
          },
          [](Row& row, const Cell& cell) {
            const double* const value = std::get_if<double>(&cell);
            Of(row) = value != nullptr ? *value : std::numeric_limits<double>::quiet_NaN();
            return true;
          }};
}

// A column for each coordinate of a vector.
template <auto Member>
void add_vector(std::vector<Field>& list, const std::array<std::string, 3>& names, const std::string& unit,
                Strength strength) {
  list.push_back(number<[](auto& row) -> auto& { return (row.*Member).x; }>(names[0], unit, strength));
  list.push_back(number<[](auto& row) -> auto& { return (row.*Member).y; }>(names[1], unit, strength));
  list.push_back(number<[](auto& row) -> auto& { return (row.*Member).z; }>(names[2], unit, strength));
}

// A column for each channel: "total_r", "total_g", "total_b".
template <auto Member>
void add_channels(std::vector<Field>& list, const std::string& name, const std::string& unit, Strength strength) {
  list.push_back(number<[](auto& row) -> auto& { return (row.*Member).r; }>(name + "_r", unit, strength));
  list.push_back(number<[](auto& row) -> auto& { return (row.*Member).g; }>(name + "_g", unit, strength));
  list.push_back(number<[](auto& row) -> auto& { return (row.*Member).b; }>(name + "_b", unit, strength));
}

template <auto Member>
Field one(std::string name, std::string unit, Strength strength) {
  return number < [](auto& row) -> auto& { return row.*Member; }
  > (std::move(name), std::move(unit), strength);
}

template <auto Member>
Field text(std::string name, bool key = false) {
  return table::member_field<Member, Row>({.name = std::move(name), .key = key});
}

template <class Word>
bool read_word(const Cell& cell, std::span<const Word> words, Word& word) {
  for (const Word one : words) {
    if (std::get<std::string_view>(cell) != to_string(one)) continue;
    word = one;
    return true;
  }
  return false;
}

constexpr std::array kStatuses = {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified};
constexpr std::array kDerivativeStatuses = {DerivativeStatus::kCertified, DerivativeStatus::kZero,
                                            DerivativeStatus::kUnderflow, DerivativeStatus::kEnclosed};

template <auto Member>
Field status(std::string name) {
  return {{.name = std::move(name), .type = Type::kText, .strength = Strength::kProved},
          [](const Row& row) -> Cell { return to_string(row.*Member); },
          [](Row& row, const Cell& cell) { return read_word<Status>(cell, kStatuses, row.*Member); }};
}

template <std::size_t Axis>
Field derivative_status(std::string name) {
  return {{.name = std::move(name), .type = Type::kText, .strength = Strength::kProved},
          [](const Row& row) -> Cell { return row.kink ? kKink : to_string(row.gradient_status[Axis]); },
          [](Row& row, const Cell& cell) {
            row.kink = std::get<std::string_view>(cell) == kKink;
            return row.kink || read_word<DerivativeStatus>(cell, kDerivativeStatuses, row.gradient_status[Axis]);
          }};
}

template <std::size_t Index>
Field measure(std::string name, std::string unit) {
  return number < [](auto& row) -> auto& { return row.measures[Index]; }
  > (std::move(name), std::move(unit), Strength::kCertified);
}

constexpr std::array kOptionalColumns = {
    OptionalColumn{"unoccluded", "Add a column: the form factor without occluders", &Request::unoccluded},
    OptionalColumn{"fraction", "Add a column: the visible fraction of the source", &Request::visible_fraction},
    OptionalColumn{"gradient",
                   "Add columns: the derivatives of the form factor by the receiver's point (dF_dx, dF_dy, dF_dz, per "
                   "unit of length; empty where they do not exist) and their status (certified, zero, underflow, "
                   "enclosed or kink)",
                   &Request::gradient},
    OptionalColumn{"unit-normals",
                   "Add columns ux,uy,uz: the normal scaled to length 1, correctly rounded; the values belong to the "
                   "exact normals in nx,ny,nz",
                   &Request::unit_normals},
    OptionalColumn{"uv", "Add columns u,v: the place of a cell on its grid, from 0 to 1", &Request::uv}};

std::vector<Field> fields(const Request& wanted) {
  std::vector<Field> list = {text<&Row::receiver>("receiver", true), text<&Row::on>("on")};
  add_vector<&Row::point>(list, {"x", "y", "z"}, "length", Strength::kGiven);
  add_vector<&Row::normal>(list, {"nx", "ny", "nz"}, "of any length", Strength::kGiven);
  if (wanted.unit_normals) add_vector<&Row::unit_normal>(list, {"ux", "uy", "uz"}, "", Strength::kCertified);
  if (wanted.uv) {
    list.push_back(one<&Row::u>("u", "", Strength::kCertified));
    list.push_back(one<&Row::v>("v", "", Strength::kCertified));
  }
  list.push_back(text<&Row::source>("source", true));
  list.push_back(one<&Row::exact>("exact", "", Strength::kCertified));
  list.push_back(one<&Row::lower>("lower", "", Strength::kProved));
  list.push_back(one<&Row::upper>("upper", "", Strength::kProved));
  if (wanted.unoccluded) {
    list.push_back(one<&Row::unoccluded>("unoccluded", "", Strength::kCertified));
    list.push_back(status<&Row::unoccluded_status>("unoccluded_status"));
  }
  if (wanted.visible_fraction) {
    list.push_back(one<&Row::visible_fraction>("visible_fraction", "", Strength::kCertified));
  }
  std::array<bool, 3> measures{};
  for (const Measure& one : wanted.measures) measures[measure_column(one)] = true;
  if (measures[0]) list.push_back(measure<0>("solid_angle", "sr"));
  if (measures[1]) list.push_back(measure<1>("overcast", ""));
  if (measures[2]) list.push_back(measure<2>("sphere", ""));
  if (wanted.gradient) {
    add_vector<&Row::gradient>(list, {"dF_dx", "dF_dy", "dF_dz"}, "1/length", Strength::kCertified);
    list.push_back(derivative_status<0>("dF_dx_status"));
    list.push_back(derivative_status<1>("dF_dy_status"));
    list.push_back(derivative_status<2>("dF_dz_status"));
  }
  add_channels<&Row::radiosity>(list, "radiosity", "Ke", Strength::kEstimated);
  list.push_back(one<&Row::largest_rho_b>("largest_rho_b", "Ke", Strength::kEstimated));
  const std::string unit = wanted.total ? unit_of(*wanted.total, wanted.ke) : "";
  if (wanted.total) add_channels<&Row::total>(list, "total", unit, Strength::kCertified);
  if (wanted.radiosities) {
    add_channels<&Row::total_lower>(list, "total_lower", unit, Strength::kProved);
    add_channels<&Row::total_upper>(list, "total_upper", unit, Strength::kProved);
  }
  list.push_back(status<&Row::status>("status"));
  return list;
}

}  // namespace

double Row::certified(double number) const {
  return status == Status::kNotCertified ? std::numeric_limits<double>::quiet_NaN() : number;
}

std::size_t measure_column(const Measure& measure) {
  return measure.sphere ? 2 : measure.kind == MeasureKind::kOvercast ? 1 : 0;
}

std::span<const OptionalColumn> optional_columns() { return kOptionalColumns; }

Columns columns_of(const Request& request) { return {"truth", fields(request)}; }

const Columns& all_columns() {
  static const Columns kAll = [] {
    Request all;
    for (const OptionalColumn& one : kOptionalColumns) all.*one.wanted = true;
    all.measures = {{.kind = MeasureKind::kSolidAngle}, {.kind = MeasureKind::kOvercast}, {.sphere = true}};
    all.total = Quantity::kRadiosity;
    all.radiosities.emplace();
    return columns_of(all);
  }();
  return kAll;
}

// --- Unit normals ---

// n_i / |n| in balls of rising precision, until the ball rounds to one double.
//
// Why this ends: the ball never has to decide a tie. A midpoint of two doubles, and every double but 0 and +-1 in this
// range, is p / 2^k with p odd and k >= 1. If n_i / |n| were such a number, then n_j^2 + n_l^2 = n_i^2 (4^k - p^2) /
// p^2, so that 4^k - p^2 were a sum of two rational squares, hence of two integer squares. But 4^k - p^2 is 3 modulo 4.
// The values 0 and +-1 are no ties.

namespace {

double component(double value, const Vec3& normal) {
  if (value == 0.0) return 0.0;
  for (long bits = 128;; bits *= 2) {
    const Ball x = kernel::to_ball(normal.x, bits), y = kernel::to_ball(normal.y, bits),
               z = kernel::to_ball(normal.z, bits);
    const Ball length = sqrt(x * x + y * y + z * z);
    if (const auto nearest = EnclosureInside::of(kernel::to_ball(value, bits) / length).nearest()) return *nearest;
  }
}

}  // namespace

Vec3 unit_normal(const Vec3& normal) {
  EXACTFF_EXPECT(kernel::is_finite(normal) && !(normal == Vec3{}));
  return {component(normal.x, normal), component(normal.y, normal), component(normal.z, normal)};
}

}  // namespace exactff::truth
