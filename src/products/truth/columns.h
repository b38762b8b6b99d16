// The columns of a truth file. A new column is a value of Row, which Rows::compute sets, and one line in columns.cpp.
#pragma once

#include <array>
#include <string>

#include "exactff/truth.h"
#include "table/fields.h"

namespace exactff::truth {

// A receiver and a source.
struct Row {
  std::string receiver, on;  // the id, and the names of the own faces
  Vec3 point, normal;
  Vec3 unit_normal;
  double u = 0.0, v = 0.0;  // place on the grid, from 0 to 1
  std::string source;
  double exact = 0.0, lower = 0.0, upper = 0.0;
  double unoccluded = 0.0;
  Status unoccluded_status = Status::kZero;
  double visible_fraction = 0.0;
  std::array<double, 3> measures{};  // by measure_column()
  Vec3 gradient;                     // NaN at a kink
  std::array<DerivativeStatus, 3> gradient_status{};
  bool kink = false;
  Rgb radiosity;  // rho B F of each channel, rounded
  double largest_rho_b = 0.0;
  Rgb total, total_lower, total_upper;
  Status status = Status::kZero;  // the worst of all values

  // The number, or NaN where it is only an estimate.
  [[nodiscard]] double certified(double number) const;
};

// The index of a measure's column.
[[nodiscard]] std::size_t measure_column(const Measure& measure);

using Columns = table::Fields<Row>;

// Those of a request.
[[nodiscard]] Columns columns_of(const Request& request);
// All that there may be, for reading.
[[nodiscard]] const Columns& all_columns();

// --- Unit normals ---

// A normal scaled to unit length: each component is n_i / |n|, rounded once to the nearest double (ties cannot occur).
// Requires finite components, not all zero.
[[nodiscard]] Vec3 unit_normal(const Vec3& normal);

// The same, with the last result kept: consecutive rows often have the same normal.
class UnitNormal {
 public:
  [[nodiscard]] const Vec3& of(const Vec3& normal) {
    if (!(normal == normal_)) {
      unit_ = unit_normal(normal);
      normal_ = normal;
    }
    return unit_;
  }

 private:
  Vec3 normal_{0.0, 0.0, 1.0};
  Vec3 unit_{0.0, 0.0, 1.0};
};

}  // namespace exactff::truth
