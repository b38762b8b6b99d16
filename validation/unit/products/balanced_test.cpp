// Balanced matrices: the nearest ones inside all intervals, and proofs that there is none.
#include "matrix/balanced.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>
#include <vector>

#include "exactff/scene_files.h"
#include "generate/random.h"
#include "support/program.h"

namespace exactff::matrix {
namespace {

using generate::Random;

std::vector<Selection> patches(std::size_t count) {
  std::vector<Selection> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back({static_cast<PatchId>(i), {}});
  return all;
}

std::vector<std::string> names(std::size_t count) {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < count; ++i) all.push_back("patch " + std::to_string(1000 + i));
  return all;
}

// Bounds around a balanced matrix, at random distances of up to `width` of an entry; values within the bounds.
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
      const bool neighbours = j == i + 1;  // so that no row is empty
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

void expect_balanced(const Matrix& matrix, const Balanced& found) {
  const std::size_t n = matrix.factors.from.size();
  ASSERT_TRUE(found.is_found());
  EXPECT_LE(found.furthest, 0x1p-52);
  const auto expect_inside = [](const ViewFactor& f, double value) {
    EXPECT_LE(f.lower, value);
    EXPECT_GE(f.upper, value);
  };
  for (std::size_t i = 0; i < n; ++i) {
    long double sum = 0.0;  // of 64 bits, for the sums of doubles
    for (std::size_t j = 0; j < n; ++j) {
      const ViewFactor& f = matrix.factors.at(i, j);
      expect_inside(f, found.entries[i * n + j]);
      EXPECT_EQ(f.area_from * found.entries[i * n + j], f.area_to * found.entries[j * n + i]) << i << ' ' << j;
      sum += found.entries[i * n + j];
    }
    for (const auto& [factors, values] :
         {std::pair(&matrix.back, &found.back), {&matrix.open, &found.open}, {&matrix.buried, &found.buried}}) {
      if (factors->empty()) continue;
      expect_inside((*factors)[i], (*values)[i]);
      sum += (*values)[i];
    }
    EXPECT_LE(std::abs(sum - 1.0L), 0x1p-52L + static_cast<long double>(n) * 0x1p-64L);
  }
}

// The same minimum by Hildreth's method: the multiplier of one row after another becomes the one by which this row adds
// up, found by bisection.
class Hildreth {
 public:
  explicit Hildreth(const Matrix& matrix) : n_(matrix.factors.from.size()), matrix_(matrix), l_(n_) {
    for (int sweep = 0; sweep < 20000; ++sweep) {
      double moved = 0.0;
      for (std::size_t i = 0; i < n_; ++i) {
        const double before = l_[i];
        double low = before - 1e3, high = before + 1e3;
        for (int k = 0; k < 100; ++k) {
          l_[i] = 0.5 * (low + high);
          (row_sum(i) < area(i) ? low : high) = l_[i];
        }
        moved = std::max(moved, std::abs(l_[i] - before));
      }
      if (moved < 1e-13) return;
    }
  }
  [[nodiscard]] double x(std::size_t i, std::size_t j) const {
    const ViewFactor &f = matrix_.factors.at(i, j), &g = matrix_.factors.at(j, i);
    const double a = area(i), b = area(j);
    return clipped(std::max(a * f.lower, b * g.lower), 0.5 * (a * f.value + b * g.value),
                   std::min(a * f.upper, b * g.upper), l_[i] + l_[j]);
  }
  [[nodiscard]] double open(std::size_t i) const {
    const ViewFactor& f = matrix_.open[i];
    return clipped(area(i) * f.lower, area(i) * f.value, area(i) * f.upper, 2.0 * l_[i]);
  }
  [[nodiscard]] double area(std::size_t i) const { return matrix_.factors.at(i, 0).area_from; }

 private:
  static double clipped(double lower, double value, double upper, double l) {
    return std::clamp(value + (upper - lower) * l, lower, upper);
  }
  [[nodiscard]] double row_sum(std::size_t i) const {
    double sum = matrix_.open.empty() ? 0.0 : open(i);
    for (std::size_t j = 0; j < n_; ++j) sum += x(i, j);
    return sum;
  }

  std::size_t n_;
  const Matrix& matrix_;
  std::vector<double> l_;
};

TEST(Balanced, RandomMatricesAreTheMinimaOfAnotherMethod) {
  Random random(61);
  for (int round = 0; round < 60; ++round) {
    const std::size_t n = 3 + random.below(6);
    const Matrix matrix =
        random_matrix(random, {n, 0.3 + 0.7 * random.unit(), 0.3 * random.unit(), random.below(2) == 0});
    const Balanced found = balanced_of(matrix, names(n));
    expect_balanced(matrix, found);
    const Hildreth other(matrix);
    for (std::size_t i = 0; i < n && found.is_found(); ++i) {
      const double area = other.area(i);
      for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(area * found.entries[i * n + j], other.x(i, j), 1e-7 * area);
      if (matrix.open.empty()) continue;
      EXPECT_NEAR(area * found.open[i], other.open(i), 1e-7 * area);
    }
  }
}

TEST(Balanced, RoundingKeepsBothIdentitiesWhateverTheAreas) {
  Random random(7);
  for (int round = 0; round < 40; ++round) {
    const std::size_t n = 2 + random.below(30);
    const Matrix matrix = random_matrix(random, {n, random.unit(), std::exp2(-40.0 * random.unit()), false});
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
  std::vector<std::string> moved(n);
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

// EXACTFF_TEST_SCALE=16 is the size of a building of 4,872 patches.
TEST(Balanced, ManyPatchesAreBalancedInSeconds) {
  const char* const scale = std::getenv("EXACTFF_TEST_SCALE");
  const std::size_t n = scale == nullptr ? 304 : 304 * static_cast<std::size_t>(std::stoul(scale)) + 8;
  Random random(4872);
  const Matrix matrix = random_matrix(random, {n, 0.2, 1e-3, true});
  const std::vector<std::string> all = names(n);
  const auto start = std::chrono::steady_clock::now();
  const Balanced found = balanced_of(matrix, all);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  EXPECT_TRUE(found.is_found());
  EXPECT_LE(found.furthest, 0x1p-52);
  EXPECT_LT(taken.count(), 10.0);
  RecordProperty("seconds", std::to_string(taken.count()));
}

// --- Scenes ---

std::vector<Selection> whole_scene(const Scene& scene) {
  std::vector<Selection> all;
  for (std::size_t i = 0; i < scene.patches().size(); ++i) all.push_back({static_cast<PatchId>(i), {}, scene.id()});
  return all;
}

TEST(Balanced, RoomsOfTheRepositoryAre) {
  std::vector<const char*> names{"cornell_box.obj",     "slats.obj",         "formats/box345.vs3",
                                 "formats/gunter1.vs3", "formats/test4.vs3", "formats/gunter2.vs3",
                                 "blinds_room.obj",     "office.obj"};
  if (std::getenv("EXACTFF_TEST_SCALE") == nullptr) names.resize(5);  // the others take half a minute
  for (const char* name : names) {
    SCOPED_TRACE(name);
    const Scene scene = read_scene(std::string(EXACTFF_DATA_DIR "/scenes/") + name);
    const Matrix matrix = compute(scene, whole_scene(scene), whole_scene(scene),
                                  {.factors = {.accuracy = 0.1}, .backs = true, .open = true});
    expect_balanced(matrix, balanced(scene, matrix));
  }
}

class BalanceCommand : public testing::Test {
 protected:
  [[nodiscard]] std::string file(const std::string& name) const { return (folder_.path() / name).string(); }
  [[nodiscard]] validation::ProgramRun run(std::vector<std::string> flags) const {
    flags.insert(flags.begin(), {"matrix", scene_});
    return validation::run_exactff(flags);
  }

  const std::string scene_ = EXACTFF_DATA_DIR "/scenes/formats/test4.vs3";
  const validation::TemporaryDirectory folder_;
};

TEST_F(BalanceCommand, WritesTheSameFromAFileOnAnyNumberOfThreads) {
  ASSERT_EQ(run({"--backs", "--to", "all,sky", "--accuracy", "1e-3", "-o", file("m.csv")}).exit_code, 0);
  ASSERT_EQ(run({"--balance", "--accuracy", "1e-3", "--threads", "1", "-o", file("b.csv")}).exit_code, 0);
  const validation::ProgramRun again =
      run({"--balance", "--matrix", file("m.csv"), "--threads", "2", "-o", file("again.csv")});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.output.find("the same double"), std::string::npos);
  EXPECT_EQ(validation::text_of(file("b.csv")), validation::text_of(file("again.csv")));
  const Scene scene = read_scene(scene_);
  const NamedMatrix named = read_named(file("b.csv"));
  const table::Table table = table::read(file("b.csv"));
  Matrix matrix{{whole_scene(scene), whole_scene(scene), named.entries}, named.back, named.open, named.buried};
  const Balanced found = balanced(scene, matrix);
  EXPECT_EQ(table.numbers(table.column("balanced").value())[1], found.entries[1]);
}

TEST_F(BalanceCommand, ProvesThatAPlantedMatrixIsImpossible) {
  ASSERT_EQ(run({"--backs", "--to", "all,sky", "--certify", "--accuracy", "1e-3", "-o", file("m.csv")}).exit_code, 0);
  std::string text = validation::text_of(file("m.csv"));
  NamedMatrix named = read_named(file("m.csv"));
  const Scene scene = read_scene(scene_);
  for (std::size_t j = 0; j < named.to.size(); ++j) {
    for (const std::size_t k : {j, j * named.to.size()}) {
      ViewFactor& f = named.entries[k];
      f.value *= 0.9, f.lower *= 0.9, f.upper *= 0.9;
    }
  }
  const Matrix planted{{whole_scene(scene), whole_scene(scene), named.entries}, named.back, named.open, named.buried};
  table::write(table_of(scene, planted, options_of(named.head)), file("planted.csv"));
  const validation::ProgramRun run = this->run({"--balance", "--matrix", file("planted.csv"), "-o", file("b.csv")});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.error.find("there is no balanced matrix: the row of 'srf-1' misses 1"), std::string::npos) << run.error;
  EXPECT_FALSE(std::filesystem::exists(file("b.csv")));
}

TEST_F(BalanceCommand, RefusesWhatNeedNotAddUp) {
  const auto refused = [&](const std::vector<std::string>& flags, const std::string& why) {
    const validation::ProgramRun found = run(flags);
    EXPECT_EQ(found.exit_code, 2);
    EXPECT_NE(found.error.find(why), std::string::npos) << found.error;
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
