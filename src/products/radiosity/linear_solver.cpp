// The only place that calls Eigen.
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <cstdint>

#include "radiosity/system.h"

namespace exactff::radiosity {
namespace {

constexpr double kTolerance = 1e-10;  // of the residual of one run, relative to the one before it
constexpr double kSmallResidual = 1e-9;
constexpr Eigen::Index kMostIterations = 500;
constexpr int kRefinements = 2;

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int64_t>;

Matrix identity_without_reflected(const System& system, double Entry::*number) {
  const auto size = static_cast<Eigen::Index>(system.factors.size());
  Matrix a(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    a.startVec(i);
    const auto row = static_cast<std::size_t>(i);
    bool has_diagonal = false;
    const auto add_diagonal = [&](double reflected) {
      a.insertBack(i, i) = 1.0 - reflected;
      has_diagonal = true;
    };
    for (const Entry& entry : system.factors.row(row)) {
      const auto column = static_cast<Eigen::Index>(entry.column);
      const double reflected = system.reflectances[row] * entry.*number;
      if (column > i && !has_diagonal) add_diagonal(0.0);
      if (column == i) {
        add_diagonal(reflected);
      } else {
        a.insertBack(i, column) = -reflected;
      }
    }
    if (!has_diagonal) add_diagonal(0.0);
  }
  a.finalize();
  return a;
}

}  // namespace

Numbers approximate_solution(const System& system, double Entry::*number, const Numbers& b) {
  const Matrix a = identity_without_reflected(system, number);
  const Eigen::Map<const Eigen::VectorXd> given(b.data(), static_cast<Eigen::Index>(b.size()));
  const double scale = given.lpNorm<Eigen::Infinity>();
  if (scale == 0.0) return Numbers(b.size());
  const Eigen::VectorXd right = given / scale;  // squares of large or small numbers are not needed
  Eigen::BiCGSTAB<Matrix> solver;
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(kMostIterations);
  solver.compute(a);
  Eigen::VectorXd x = solver.solve(right);
  for (int i = 0; i < kRefinements && x.allFinite(); ++i) x += solver.solve(right - a * x);
  if (!x.allFinite() || !((right - a * x).norm() <= kSmallResidual * right.norm())) return {};
  x *= scale;
  if (!x.allFinite()) return {};
  return {x.begin(), x.end()};
}

}  // namespace exactff::radiosity
