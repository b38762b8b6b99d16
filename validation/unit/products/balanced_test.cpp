// Balanced matrices: the nearest ones inside all intervals, and proofs that there is none.
#include "matrix/balanced.h"

#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

#include <chrono>
#include <cstdlib>

#include "support/test.h"

namespace exactff::matrix {
namespace {

std::vector<Selection> patches(std::size_t count) {
  std::vector<Selection> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back({static_cast<PatchId>(i), {}, SceneId{}});
  return all;
}

Words names(std::size_t count) {
  Words all;
  for (std::size_t i = 0; i < count; ++i) all.push_back("patch " + std::to_string(1000 + i));
  return all;
}

// Bounds around a balanced matrix, at random distances of up to `width` of an entry; values within the bounds. The
// first row sees itself, so that there are no two groups that see only each other, which would need equal areas.
struct RandomMatrix {
  std::size_t size;
  double density, width;
  bool has_open;
};

Matrix random_matrix(Random& random, const RandomMatrix& kind) {
  const std::size_t n = kind.size;
  std::vector<double> x(n * n), open(n), areas(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) {
      const bool neighbours = j == i + 1 || j == 0;  // so that no row is empty
      if (!neighbours && random.unit() > kind.density) continue;
      x[i * n + j] = x[j * n + i] = (neighbours ? 0.1 : 0.0) + random.unit();
    }
    if (kind.has_open && random.unit() < 0.5) open[i] = random.unit();
  }
  for (std::size_t i = 0; i < n; ++i) {
    areas[i] = std::accumulate(&x[i * n], &x[i * n] + n, open[i]);
  }
  const auto factor = [&](double of, double area, double other) {
    if (of == 0.0) return ViewFactor{.area_from = area, .area_to = other, .claim = Claim::kZero};
    const double f = of / area, low = f * (1.0 - kind.width * random.unit()), range = f * kind.width;
    return ViewFactor{.value = low + range * random.unit(),
                      .lower = low,
                      .upper = std::min(1.0, low + range),
                      .area_from = area,
                      .area_to = other,
                      .claim = Claim::kCertified};
  };
  Matrix matrix{{patches(n), patches(n), {}}, {}, {}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) matrix.factors.entries.push_back(factor(x[i * n + j], areas[i], areas[j]));
    if (kind.has_open) matrix.open.push_back(factor(open[i], areas[i], 0.0));
  }
  for (ViewFactor& f : matrix.factors.entries) f.value = std::clamp(f.value, f.lower, f.upper);
  return matrix;
}

const std::array<std::pair<std::vector<ViewFactor> Matrix::*, std::vector<double> Balanced::*>, 3> kRest{
    {{&Matrix::back, &Balanced::back}, {&Matrix::open, &Balanced::open}, {&Matrix::buried, &Balanced::buried}}};

// `furthest`: of a row from 1. `slack`: of an interval, as a share of the entry.
void expect_balanced(const Matrix& matrix, const Balanced& found, double furthest = 0x1p-52, double slack = 0.0) {
  const std::size_t n = matrix.factors.from.size();
  ASSERT_TRUE(found.is_found());
  EXPECT_LE(found.furthest, furthest);
  const auto expect_inside = [&](const ViewFactor& f, double value) {
    EXPECT_LE(f.lower * (1.0 - slack), value);
    EXPECT_GE(f.upper * (1.0 + slack), value);
  };
  for (std::size_t i = 0; i < n; ++i) {
    CGAL::Gmpzf sum(-1.0);  // exact
    for (std::size_t j = 0; j < n; ++j) {
      const ViewFactor& f = matrix.factors.at(i, j);
      expect_inside(f, found.entries[i * n + j]);
      EXPECT_EQ(f.area_from * found.entries[i * n + j], f.area_to * found.entries[j * n + i]) << i << ' ' << j;
      sum += CGAL::Gmpzf(found.entries[i * n + j]);
    }
    for (const auto& [factors, values] : kRest) {
      if ((matrix.*factors).empty()) continue;
      expect_inside((matrix.*factors)[i], (found.*values)[i]);
      sum += CGAL::Gmpzf((found.*values)[i]);
    }
    EXPECT_LE(CGAL::abs(sum), CGAL::Gmpzf(found.furthest));
  }
}

// The same minimum as a quadratic program, solved by CGAL in exact numbers.
class ExactMinimum {
 public:
  explicit ExactMinimum(const Matrix& matrix) : n_(matrix.factors.from.size()) {
    const Factors& all = matrix.factors;
    for (int i = 0; i < size(); ++i) program_.set_b(i, area(all, i));
    for (int i = 0; i < size(); ++i) {
      for (int j = i; j < size(); ++j) {
        const ViewFactor &f = all.at(i, j), &g = all.at(j, i);
        const double a = area(all, i), b = area(all, j);
        add(i, j, std::max(a * f.lower, b * g.lower), 0.5 * (a * f.value + b * g.value),
            std::min(a * f.upper, b * g.upper));
      }
      for (const auto& [factors, values] : kRest) {
        if ((matrix.*factors).empty()) continue;
        const ViewFactor& f = (matrix.*factors)[i];
        add(i, i, area(all, i) * f.lower, area(all, i) * f.value, area(all, i) * f.upper);
      }
    }
    solution_ = CGAL::solve_quadratic_program(program_, CGAL::Gmpzf());
  }
  [[nodiscard]] bool is_infeasible() const { return solution_.is_infeasible(); }

  void expect_at(const Matrix& matrix, const Balanced& found) const {
    ASSERT_TRUE(found.is_found());
    auto x = solution_.variable_values_begin();
    for (std::size_t i = 0; i < n_; ++i) {
      const double a = matrix.factors.at(i, i).area_from;
      for (std::size_t j = i; j < n_; ++j) EXPECT_NEAR(CGAL::to_double(*x++), a * found.entries[i * n_ + j], 1e-11 * a);
      for (const auto& [factors, values] : kRest) {
        if ((matrix.*factors).empty()) continue;
        EXPECT_NEAR(CGAL::to_double(*x++), a * (found.*values)[i], 1e-11 * a);
      }
    }
  }

 private:
  [[nodiscard]] int size() const { return static_cast<int>(n_); }
  static double area(const Factors& all, int i) { return all.at(i, i).area_from; }

  void add(int i, int j, double lower, double value, double upper) {
    program_.set_l(variables_, true, lower);
    program_.set_u(variables_, true, upper);
    program_.set_a(variables_, i, 1.0);
    if (i != j) program_.set_a(variables_, j, 1.0);
    if (const double weight = (i == j ? 2.0 : 4.0) / (upper - lower); upper > lower) {
      program_.set_d(variables_, variables_, weight);  // of half the square
      program_.set_c(variables_, -weight * value);
    }
    ++variables_;
  }

  std::size_t n_;
  int variables_ = 0;
  CGAL::Quadratic_program<double> program_{CGAL::EQUAL};
  CGAL::Quadratic_program_solution<CGAL::Gmpzf> solution_;
};

TEST(Balanced, RandomMatricesAreTheMinimaOfAnotherMethod) {
  Random random(61);
  int impossible = 0;
  for (int round = 0; round < 60; ++round) {
    const std::size_t n = 3 + random.below(6);
    Matrix matrix = random_matrix(random, {n, 0.3 + 0.7 * random.unit(), 0.01 + 0.3 * random.unit(), round % 2 == 0});
    if (round % 3 == 0) {  // a pair that may be too small by too much
      const double share = 1.0 - 0.5 * random.unit();
      for (ViewFactor* f : {&matrix.factors.entries[1], &matrix.factors.entries[n]}) {
        f->value *= share, f->lower *= share, f->upper *= share;
      }
    }
    const Balanced found = balanced_of(matrix, names(n));
    const ExactMinimum exact(matrix);
    ASSERT_EQ(exact.is_infeasible(), found.is_impossible());
    impossible += static_cast<int>(found.is_impossible());
    if (found.is_impossible()) continue;
    expect_balanced(matrix, found);
    exact.expect_at(matrix, found);
  }
  EXPECT_GE(impossible, 5);
}

TEST(Balanced, RoundingKeepsBothIdentitiesWhateverTheAreas) {
  Random random(7);
  for (int round = 0; round < 4000; ++round) {
    const std::size_t n = 2 + random.below(round % 8 == 0 ? 30 : 6);
    const RandomMatrix kind{n, round % 3 == 0 ? 0.0 : random.unit(), std::exp2(-30.0 * random.unit()), round % 5 == 0};
    const Matrix matrix = random_matrix(random, kind);
    expect_balanced(matrix, balanced_of(matrix, names(n)));
  }
  // With intervals of a few roundings there may be none.
  for (int round = 0; round < 1000; ++round) {
    const std::size_t n = 2 + random.below(6);
    const Matrix matrix = random_matrix(random, {n, random.unit(), std::exp2(-30.0 - 16.0 * random.unit()), false});
    const Balanced found = balanced_of(matrix, names(n));
    if (found.is_found()) expect_balanced(matrix, found, 0x1p-51, 0x1p-42);
  }
}

// Squares that were turned: their areas miss 1 by a few roundings, so products with them are far apart in patterns that
// hardly change.
TEST(Balanced, RoundingCopesWithAreasBesidePowersOfTwo) {
  Random random(8);
  for (int round = 0; round < 500; ++round) {
    const std::size_t n = 4 + random.below(4);
    std::vector<double> areas(n);
    for (double& area : areas) area = 1.0 + std::exp2(-53) * (static_cast<double>(random.below(17)) - 8.0);
    Matrix matrix{{patches(n), patches(n), {}}, {}, {}, {}};
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const double f = 1.0 / static_cast<double>(n - 1), radius = i == j ? 0.0 : 1e-6;
        matrix.factors.entries.push_back({.value = i == j ? 0.0 : f,
                                          .lower = i == j ? 0.0 : f - radius,
                                          .upper = i == j ? 0.0 : f + radius,
                                          .area_from = areas[i],
                                          .area_to = areas[j]});
      }
    }
    expect_balanced(matrix, balanced_of(matrix, names(n)));
  }
}

// Row i has the number order[i] now.
Matrix reordered(const Matrix& matrix, const std::vector<std::size_t>& order) {
  const std::size_t n = order.size();
  Matrix result = matrix;
  for (std::size_t i = 0; i < n; ++i) {
    result.open[order[i]] = matrix.open[i];
    for (std::size_t j = 0; j < n; ++j) result.factors.entries[order[i] * n + order[j]] = matrix.factors.at(i, j);
  }
  return result;
}

TEST(Balanced, TheOrderOfPatchesChangesNoBit) {
  Random random(3);
  constexpr std::size_t n = 40;
  const Matrix matrix = random_matrix(random, {n, 0.5, 0.1, true});
  const Balanced found = balanced_of(matrix, names(n));
  expect_balanced(matrix, found);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  generate::shuffle(random, order);
  Words moved(n);
  for (std::size_t i = 0; i < n; ++i) moved[order[i]] = names(n)[i];
  const Balanced other = balanced_of(reordered(matrix, order), moved);
  ASSERT_TRUE(other.is_found());
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(found.open[i], other.open[order[i]]);
    for (std::size_t j = 0; j < n; ++j) EXPECT_EQ(found.entries[i * n + j], other.entries[order[i] * n + order[j]]);
  }
}

// Two groups of three, each of which sees only the other one: {0, 1, 2} have more area than {3, 4, 5}, so reciprocity
// forbids that all rows add up to 1, and no single row shows it.
Matrix unequal_halves() {
  Matrix matrix{{patches(6), patches(6), std::vector<ViewFactor>(36)}, {}, {}, {}};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      ViewFactor& f = matrix.factors.entries[i * 6 + j];
      f.area_from = i < 3 ? 1.01 : 1.0;
      f.area_to = j < 3 ? 1.01 : 1.0;
      if ((i < 3) != (j < 3)) {
        f = {.value = 0.333, .lower = 0.2, .upper = 0.5, .area_from = f.area_from, .area_to = f.area_to};
        f.claim = Claim::kCertified;
      }
    }
  }
  return matrix;
}

TEST(Balanced, WhereThereIsNoneRowsProveIt) {
  const Balanced halves = balanced_of(unequal_halves(), names(6));
  EXPECT_FALSE(halves.is_found());
  EXPECT_EQ(halves.lacking, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(halves.exceeding, (std::vector<std::size_t>{3, 4, 5}));
  EXPECT_NEAR(halves.gap, 0.03 / 6.03, 1e-12);
  EXPECT_EQ(halves.claim, Claim::kCertified);

  Random random(5);
  for (int round = 0; round < 20; ++round) {
    const std::size_t n = 4 + random.below(20), row = random.below(n);
    Matrix matrix = random_matrix(random, {n, 0.6, 0.01, true});
    for (std::size_t j = 0; j < n; ++j) {  // every entry of one row, and its other direction
      for (ViewFactor* f : {&matrix.factors.entries[row * n + j], &matrix.factors.entries[j * n + row]}) {
        if (f->upper > 0.0) *f = {0.9 * f->value, 0.9 * f->lower, 0.9 * f->upper, f->area_from, f->area_to, f->claim};
      }
    }
    matrix.open[row] = {.area_from = matrix.open[row].area_from};
    const Balanced found = balanced_of(matrix, names(n));
    EXPECT_FALSE(found.is_found());
    EXPECT_EQ(found.lacking, std::vector<std::size_t>{row});
    EXPECT_TRUE(found.exceeding.empty());
  }
}

TEST(Balanced, DirectionsThatContradictEachOtherAreNamed) {
  Random random(9);
  Matrix matrix = random_matrix(random, {5, 1.0, 0.01, false});
  ViewFactor& f = matrix.factors.entries[1 * 5 + 3];
  f.lower = f.value = f.upper = 1.02 * f.upper;
  const Balanced found = balanced_of(matrix, names(5));
  ASSERT_EQ(found.apart.size(), 1U);
  EXPECT_EQ(found.apart.front().row, 1U);
  EXPECT_EQ(found.apart.front().column, 3U);
  EXPECT_FALSE(found.is_found());
}

TEST(Balanced, RoomsOfTheRepositoryAre) {
  std::vector<const char*> names{
      "scenes/cornell_box.obj",    "scenes/slats.obj",           "scenes/triangular_cavity.obj",
      "scenes/formats/box345.vs3", "scenes/formats/gunter1.vs3", "scenes/formats/test4.vs3",
      "field/room_with_cube.obj",  "field/plates.obj",           "scenes/formats/gunter2.vs3",
      "scenes/blinds_room.obj",    "scenes/office.obj"};
  if (std::getenv("EXACTFF_TEST_SCALE") == nullptr) names.resize(8);  // the others take half a minute
  for (const char* name : names) {
    SCOPED_TRACE(name);
    const Scene scene = read_scene(std::string(EXACTFF_DATA_DIR "/") + name);
    const Matrix matrix = compute(scene, all_patches(scene), all_patches(scene),
                                  {.factors = {.accuracy = 0.1}, .backs = true, .open = true});
    const Balanced found = balanced(scene, matrix);
    expect_balanced(matrix, found);
    if (matrix.factors.from.size() <= 10) ExactMinimum(matrix).expect_at(matrix, found);
  }
}

class BalanceCommand : public testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  [[nodiscard]] ProgramRun run(const Words& flags) const { return run_exactff(joined({"matrix", scene_}, flags)); }

  const std::string scene_ = EXACTFF_DATA_DIR "/scenes/formats/test4.vs3";
  const TemporaryDirectory folder_;
};

TEST_F(BalanceCommand, WritesTheSameFromAFileOnAnyNumberOfThreads) {
  ASSERT_EQ(run({"--backs", "--to", "all,sky", "--accuracy", "1e-3", "-o", file("m.csv")}).exit_code, 0);
  ASSERT_EQ(run({"--balance", "--accuracy", "1e-3", "--threads", "1", "-o", file("b.csv")}).exit_code, 0);
  const ProgramRun again = run({"--balance", "--matrix", file("m.csv"), "--threads", "2", "-o", file("again.csv")});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_HOLDS(again.output, "the same double");
  EXPECT_EQ(text_of(file("b.csv")), text_of(file("again.csv")));
  const Scene scene = read_scene(scene_);
  const NamedMatrix named = read_named(file("b.csv"));
  const table::Table table = table::read(file("b.csv"));
  Matrix matrix{{all_patches(scene), all_patches(scene), named.entries}, named.back, named.open, named.buried};
  const Balanced found = balanced(scene, matrix);
  EXPECT_EQ(table.numbers(table.column("balanced").value())[1], found.entries[1]);
}

TEST_F(BalanceCommand, ProvesThatAPlantedMatrixIsImpossible) {
  ASSERT_EQ(run({"--backs", "--to", "all,sky", "--certify", "--accuracy", "1e-3", "-o", file("m.csv")}).exit_code, 0);
  std::string text = text_of(file("m.csv"));
  NamedMatrix named = read_named(file("m.csv"));
  const Scene scene = read_scene(scene_);
  for (std::size_t j = 0; j < named.to.size(); ++j) {
    for (const std::size_t k : {j, j * named.to.size()}) {
      ViewFactor& f = named.entries[k];
      f.value *= 0.9, f.lower *= 0.9, f.upper *= 0.9;
    }
  }
  const Matrix planted{{all_patches(scene), all_patches(scene), named.entries}, named.back, named.open, named.buried};
  table::write(table_of(scene, planted, options_of(named.head)), file("planted.csv"));
  const ProgramRun run = this->run({"--balance", "--matrix", file("planted.csv"), "-o", file("b.csv")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_HOLDS(run.error, "there is no balanced matrix: the row of 'srf-1' misses 1");
  EXPECT_FALSE(std::filesystem::exists(file("b.csv")));
}

TEST_F(BalanceCommand, RefusesWhatNeedNotAddUp) {
  const auto refused = [&](const Words& flags, const std::string& why) {
    const ProgramRun found = run(flags);
    EXPECT_EQ(found.exit_code, 2);
    EXPECT_HOLDS(found.error, why);
  };
  refused({"--balance", "--transparent", "srf-1"}, "some faces are transparent");
  refused({"--balance", "--from", "srf-1"}, "not the same patches as rows and as columns");
  refused({"--balance", "--from", "srf-1", "--to", "srf-1"}, "not every patch is a column");
  refused({"--balance", "-o", file("x.csv"), "--shard", "1/2"}, "--shard is given with --balance");
  ASSERT_EQ(run({"--accuracy", "1e-2", "-o", file("m.csv")}).exit_code, 0);
  refused({"--balance", "--matrix", file("m.csv")}, "what meets backs is not computed");
}

}  // namespace
}  // namespace exactff::matrix
