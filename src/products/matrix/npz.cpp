#include <algorithm>
#include <cstdint>

#include "exactff/matrix.h"
#include "files/numpy.h"
#include "kernel/float_environment.h"
#include "matrix/row_facts.h"
#include "scene/selections.h"

namespace exactff::matrix {
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
  const kernel::StandardArithmetic arithmetic;
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
