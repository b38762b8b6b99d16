// The bounds of radiosities on random systems and in random buildings, judged by Gaussian elimination in rationals.
#include "kernel/numbers.h"
#include "property/closed_rooms.h"
#include "radiosity/system.h"
#include "support/test.h"

namespace exactff::radiosity {
namespace {

using kernel::Rational;
using kernel::to_rational;
using validation::scaled_count;
using validation::seed_of;

using Vector = std::vector<Rational>;
using Square = std::vector<Vector>;

// a x = b, or nothing if a is singular.
std::optional<Vector> solved(Square a, Vector b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    while (pivot < n && a[pivot][k] == 0) ++pivot;
    if (pivot == n) return std::nullopt;
    std::swap(a[k], a[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      if (a[i][k] == 0) continue;
      const Rational factor = a[i][k] / a[k][k];
      for (std::size_t j = k; j < n; ++j) a[i][j] -= factor * a[k][j];
      b[i] -= factor * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

// I - rho F, where each factor of F is chosen between its bounds.
template <class Choose>
Square identity_without_reflected(const System& system, const Choose& choose) {
  const std::size_t n = system.factors.size();
  Square a(n, Vector(n, 0));
  for (std::size_t i = 0; i < n; ++i) {
    a[i][i] = 1;
    for (const Entry& entry : system.factors.row(i)) {
      a[i][entry.column] -= to_rational(system.reflectances[i]) * choose(entry);
    }
  }
  return a;
}
Rational lower_of(const Entry& entry) { return to_rational(entry.lower); }
Rational upper_of(const Entry& entry) { return to_rational(entry.upper); }

Vector exactly(const Numbers& numbers) {
  Vector result;
  for (const double number : numbers) result.push_back(to_rational(number));
  return result;
}

Vector product(const Square& a, const Vector& x) {
  Vector result(x.size(), 0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) result[i] += a[i][j] * x[j];
  }
  return result;
}

// Some factors, emissions and reflectances are 0; rows add up to between 0 and `strength`.
System random_system(Random& random, double strength) {
  const std::size_t n = 1 + random.below(7);
  const double widest = random.one_in(2) ? 0x1p-40 : random.between(0.0, 0.2);
  System system;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      if (random.one_in(4)) continue;
      const double lower = random.one_in(5) ? 0.0 : random.between(0.0, strength / static_cast<double>(n));
      const double upper = lower + random.between(0.0, widest / static_cast<double>(n));
      if (upper > 0.0) {
        system.factors.add(
            {static_cast<std::uint32_t>(j), lower, std::clamp(0.5 * lower + 0.5 * upper, lower, upper), upper});
      }
    }
    system.factors.end_row();
    system.reflectances.push_back(random.one_in(6) ? 0.0 : random.one_in(4) ? 1.0 : random.unit());
    system.emissions.push_back(random.one_in(3) ? 0.0 : random.between(0.0, 20.0));
  }
  return system;
}

void expect_holds(const System& system, const SolutionBounds& bounds, const Square& matrix, std::uint64_t s) {
  const std::optional<Vector> b = solved(matrix, exactly(system.emissions));
  ASSERT_TRUE(b) << s;
  for (std::size_t i = 0; i < b->size(); ++i) {
    EXPECT_LE(to_rational(bounds.lower[i]), (*b)[i]) << s << ' ' << i;
    EXPECT_GE(to_rational(bounds.upper[i]), (*b)[i]) << s << ' ' << i;
  }
}

bool all_positive(const Vector& x) {
  return std::ranges::all_of(x, [](const Rational& number) { return number > 0; });
}

bool is_contraction(const System& system) {
  const std::optional<Vector> z =
      solved(identity_without_reflected(system, upper_of), Vector(system.factors.size(), 1));
  return z && all_positive(*z);
}

TEST(RadiosityBounds, HoldForEveryMatrixBetweenItsBounds) {
  std::size_t bounded = 0, unbounded = 0;
  for (std::uint64_t s = 0; s < scaled_count(600); ++s) {
    Random random(seed_of(s));
    const System system = random_system(random, s % 3 == 0 ? 8.0 : 2.5);
    const SolutionBounds bounds = bounds_of(system);
    const bool contracts = is_contraction(system);
    EXPECT_TRUE(!contracts || !bounds.upper.empty()) << s;
    (bounds.upper.empty() ? unbounded : bounded) += 1;
    if (bounds.upper.empty() || !contracts) continue;  // else it may be singular beyond the patches that are reached
    expect_holds(system, bounds, identity_without_reflected(system, lower_of), s);
    expect_holds(system, bounds, identity_without_reflected(system, upper_of), s);
    for (int k = 0; k < 4; ++k) {
      const auto between = [&](const Entry& e) -> Rational {
        const Rational t = k == 0 ? Rational(static_cast<int>(random.below(2))) : to_rational(random.unit());
        return lower_of(e) + t * (upper_of(e) - lower_of(e));
      };
      expect_holds(system, bounds, identity_without_reflected(system, between), s);
    }
  }
  EXPECT_GT(bounded, scaled_count(100));
  EXPECT_GT(unbounded, scaled_count(50));
}

TEST(RadiosityBounds, AreThoseOfTheCornersUpToRoundings) {
  std::size_t judged = 0;
  for (std::uint64_t s = 0; s < scaled_count(200); ++s) {
    Random random(seed_of(s));
    const System system = random_system(random, 0.9);
    const SolutionBounds bounds = bounds_of(system);
    if (bounds.upper.empty() || !is_contraction(system)) continue;
    const Vector low = *solved(identity_without_reflected(system, lower_of), exactly(system.emissions));
    const Vector high = *solved(identity_without_reflected(system, upper_of), exactly(system.emissions));
    const Rational largest = std::ranges::max(high) * to_rational(0x1p-40);
    for (std::size_t i = 0; i < low.size(); ++i, ++judged) {
      EXPECT_LE(low[i] - to_rational(bounds.lower[i]), largest) << s << ' ' << i;
      EXPECT_LE(to_rational(bounds.upper[i]) - high[i], largest) << s << ' ' << i;
      EXPECT_TRUE(high[i] != 0 || bounds.upper[i] == 0.0) << s << ' ' << i;  // no light reaches it
      EXPECT_TRUE(system.reflectances[i] != 0.0 || bounds.upper[i] == system.emissions[i]) << s << ' ' << i;
    }
  }
  EXPECT_GT(judged, scaled_count(200));
}

// Vectors at the limit of each inequality, and their neighbours.
TEST(RadiosityBounds, InequalitiesAreAcceptedOnlyIfTheyHoldExactly) {
  std::size_t accepted = 0, refused = 0;
  const auto judge = [&](bool says, bool holds) {
    EXPECT_TRUE(!says || holds);
    (says ? accepted : refused) += 1;
  };
  for (std::uint64_t s = 0; s < scaled_count(300); ++s) {
    Random random(seed_of(s));
    const System system = random_system(random, 1.2);
    const Square a_upper = identity_without_reflected(system, upper_of);
    const Square a_lower = identity_without_reflected(system, lower_of);
    const Vector e = exactly(system.emissions);
    const auto nearly = [&](const std::optional<Vector>& x) {
      Numbers result;
      for (const Rational& number : *x) {
        double d = kernel::nearest_double(number);
        for (int k = random.integer(-3, 3); k != 0; k -= k > 0 ? 1 : -1) d = std::nextafter(d, k > 0 ? 1e300 : -1e300);
        result.push_back(d);
      }
      return result;
    };
    const auto w = solved(a_upper, e), v = solved(a_lower, e), z = solved(a_upper, Vector(e.size(), 1));
    if (!w || !v || !z) continue;
    for (int k = 0; k < 4; ++k) {
      const Numbers over = nearly(w), under = nearly(v), tiny = nearly(z);
      const Vector of_over = product(a_upper, exactly(over)), of_under = product(a_lower, exactly(under));
      const auto all = [&](const auto& holds) {
        for (std::size_t i = 0; i < e.size(); ++i) {
          if (!holds(i)) return false;
        }
        return true;
      };
      judge(is_supersolution(system, over), all([&](std::size_t i) { return of_over[i] >= e[i] && over[i] >= 0.0; }));
      judge(is_subsolution(system, under), all([&](std::size_t i) { return of_under[i] <= e[i] && under[i] >= 0.0; }));
      judge(is_contracting(system, tiny), all_positive(product(a_upper, exactly(tiny))) && all_positive(exactly(tiny)));
    }
  }
  EXPECT_GT(accepted, scaled_count(100));
  EXPECT_GT(refused, scaled_count(100));
}

// --- Scenes ---

void give_random_colours(generate::PlainScene& plain, Random& random) {
  for (generate::PlainPatch& patch : plain.patches) {
    const auto channels = [&](double largest) {
      return Rgb{largest * random.unit(), largest * random.unit(), largest * random.unit()};
    };
    const bool emits = &patch == &plain.patches.front() || random.one_in(4);
    patch.material = "material of " + patch.name;
    plain.materials.push_back(
        {.name = patch.material, .reflectance = channels(0.8), .radiosity = emits ? channels(10.0) : Rgb{}});
  }
}

Vector exact_radiosities(const Scene& scene, const matrix::Matrix& matrix, double Rgb::*colour, double t) {
  const matrix::Factors& all = matrix.factors;
  const std::size_t n = all.from.size();
  Square a(n, Vector(n, 0));
  Vector e(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Material& m = scene.material(scene.face(scene.faces_of(all.from[i]).front()).material);
    e[i] = to_rational(m.radiosity.*colour);
    const double buried = matrix.buried.empty() ? 0.0 : matrix.buried[i].value;
    const Rational times =
        buried < 1.0 ? Rational(1 / (1 - to_rational(buried))) : Rational(0);  // over what is exposed
    for (std::size_t j = 0; j < n; ++j) {
      const Rational low = to_rational(all.at(i, j).lower), high = to_rational(all.at(i, j).upper);
      a[i][j] = (i == j ? 1 : 0) - times * to_rational(m.reflectance.*colour) * (low + to_rational(t) * (high - low));
    }
  }
  return *solved(std::move(a), std::move(e));
}

TEST(Radiosity, OfRandomBuildingsIsBoundedInEveryChannel) {
  for (std::uint64_t s = 0; s < scaled_count(4); ++s) {
    Random random(seed_of(s));
    generate::PlainScene plain = validation::random_building(random).scene;
    give_random_colours(plain, random);
    const Scene scene = generate::build(plain);
    const std::vector<Selection> patches = patches_of(scene);
    const matrix::Matrix matrix = matrix::compute(
        scene, patches, patches, {.factors = {.accuracy = 1e-2, .budget = 60}, .backs = true, .open = true});
    const Solution solution = solve(scene, matrix);
    EXPECT_TRUE(!solution.reasons_against_balance.empty() || is_balanced(solution)) << s;
    const std::array<double Rgb::*, 3> colours = {&Rgb::r, &Rgb::g, &Rgb::b};
    for (std::size_t c = 0; c < 3; ++c) {
      const Channel& channel = solution.channels[c];
      if (!channel.is_bounded()) continue;
      for (const double t : {0.0, 0.5, 1.0}) {
        const Vector b = exact_radiosities(scene, matrix, colours[c], t);
        for (std::size_t i = 0; i < b.size(); ++i) {
          EXPECT_LE(to_rational(channel.radiosity[i].lower), b[i]) << s << ' ' << c << ' ' << i;
          EXPECT_GE(to_rational(channel.radiosity[i].upper), b[i]) << s << ' ' << c << ' ' << i;
        }
      }
    }
  }
}

// --- Where the light goes ---

// A room of whole numbers: what patch i sends to j is w_ij = w_ji, to backs b_i and away o_i, and its area is their
// sum. So reciprocity holds, and rows add up to 1, exactly.
struct Exchange {
  std::vector<std::vector<int>> between;
  std::vector<int> back, open;
  [[nodiscard]] std::size_t size() const { return back.size(); }
  [[nodiscard]] int area(std::size_t i) const {
    int sum = back[i] + open[i];
    for (const int w : between[i]) sum += w;
    return sum;
  }
};

Exchange random_exchange(Random& random) {
  const std::size_t n = 1 + random.below(6);
  const int most = random.integer(1, 40), lost = random.one_in(3) ? 0 : random.integer(0, 30);
  Exchange exchange{std::vector(n, std::vector<int>(n)), std::vector<int>(n), std::vector<int>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      exchange.between[i][j] = exchange.between[j][i] = random.one_in(4) ? 0 : random.integer(0, most);
    exchange.back[i] = random.one_in(2) ? 0 : random.integer(0, lost);
    exchange.open[i] = random.one_in(2) ? 0 : random.integer(0, lost);
    if (exchange.area(i) == 0) exchange.between[i][i] = 1;
  }
  return exchange;
}

// Triangles far from each other, each with a material.
Scene scene_of(Random& random, std::size_t patches, double most_reflected) {
  generate::PlainScene plain;
  for (std::size_t i = 0; i < patches; ++i) {
    generate::PlainPatch& patch = plain.patch("patch" + std::to_string(i));
    const double z = static_cast<double>(i);
    plain.add_ring(patch, {{0, 0, z}, {1, 0, z}, {0, 1, z}});
    patch.material = "material" + std::to_string(i);
    const double kd = random.one_in(4) ? most_reflected : most_reflected * random.unit();
    const double ke = random.one_in(2) ? 0.0 : random.between(0.0, 20.0);
    plain.materials.push_back({.name = patch.material, .reflectance = {kd, kd, kd}, .radiosity = {ke, ke, ke}});
  }
  return generate::build(plain);
}

// An interval that holds the share, of about this width.
ViewFactor bounds_of_share(Random& random, int part, int whole, double width) {
  const double share = static_cast<double>(part) / whole;
  if (part == 0 && random.one_in(2)) return {.area_from = static_cast<double>(whole), .area_to = 1.0};
  const double lower = std::max(0.0, share - width * random.unit() - 0x1p-50);
  const double upper = std::min(1.0, share + width * random.unit() + 0x1p-50);
  return {.value = std::clamp(share, lower, upper),
          .lower = lower,
          .upper = upper,
          .area_from = static_cast<double>(whole),
          .area_to = 1.0,
          .claim = Claim::kCertified};
}

matrix::Matrix matrix_of(Random& random, const Scene& scene, const Exchange& exchange, double width) {
  const std::vector<Selection> patches = patches_of(scene);
  matrix::Matrix matrix{{patches, patches, {}}, {}, {}, {}};
  for (std::size_t i = 0; i < exchange.size(); ++i) {
    const int area = exchange.area(i);
    for (const int w : exchange.between[i]) matrix.factors.entries.push_back(bounds_of_share(random, w, area, width));
    matrix.back.push_back(bounds_of_share(random, exchange.back[i], area, width));
    matrix.open.push_back(bounds_of_share(random, exchange.open[i], area, width));
  }
  return matrix;
}

struct TrueBalance {
  Rational emitted = 0, absorbed = 0, back = 0, open = 0;
};

// Nothing if light bounces for ever.
std::optional<TrueBalance> true_balance(const Scene& scene, const Exchange& exchange) {
  const std::size_t n = exchange.size();
  Square a(n, Vector(n, 0));
  Vector e(n, 0), rho(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Material& m = scene.material(scene.faces()[i].material);
    e[i] = to_rational(m.radiosity.r);
    rho[i] = to_rational(m.reflectance.r);
    for (std::size_t j = 0; j < n; ++j)
      a[i][j] = (i == j ? 1 : 0) - rho[i] * Rational(exchange.between[i][j]) / exchange.area(i);
  }
  const std::optional<Vector> z = solved(a, Vector(n, 1));
  if (!z || !all_positive(*z)) return std::nullopt;
  const Vector b = *solved(a, e);
  TrueBalance balance;
  for (std::size_t i = 0; i < n; ++i) {
    balance.emitted += exchange.area(i) * e[i];
    for (std::size_t j = 0; j < n; ++j) balance.absorbed += (1 - rho[i]) * exchange.between[i][j] * b[j];
    balance.back += exchange.back[i] * b[i];
    balance.open += exchange.open[i] * b[i];
  }
  return balance;
}

void expect_holds(const matrix::Sum& part, const Rational& truth, std::uint64_t s) {
  EXPECT_LE(part.lower, part.upper) << s;
  EXPECT_TRUE(!std::isfinite(part.lower) || to_rational(part.lower) <= truth) << s;
  EXPECT_TRUE(!std::isfinite(part.upper) || to_rational(part.upper) >= truth) << s;
}

// However wide the view factors are.
TEST(RadiosityBalance, HoldsTheTruthAndWhatIsPossible) {
  std::size_t finite = 0, wide = 0, gains = 0, endless = 0, without_bound = 0;
  for (std::uint64_t s = 0; s < scaled_count(600); ++s) {
    Random random(seed_of(s));
    const Exchange exchange = random_exchange(random);
    const double most_reflected = s % 5 == 0 ? 1.4 : s % 5 == 1 ? 1.0 : random.unit();
    const Scene scene = scene_of(random, exchange.size(), most_reflected);
    const double width = random.one_in(3) ? 0x1p-40 : random.between(0.0, 0.6);
    const Solution solution = solve(scene, matrix_of(random, scene, exchange, width));
    ASSERT_TRUE(solution.reasons_against_balance.empty()) << solution.reasons_against_balance[0];
    EXPECT_TRUE(is_balanced(solution)) << s;
    const Channel& channel = solution.channels[0];
    const Balance& balance = channel.balance;
    without_bound += channel.is_bounded() ? 0 : 1;
    for (const matrix::Sum& part : {balance.emitted, balance.back, balance.open}) EXPECT_GE(part.lower, 0.0) << s;
    if (most_reflected <= 1.0) {
      EXPECT_GE(balance.absorbed.lower, 0.0) << s;
      for (const matrix::Sum& part : {balance.absorbed, balance.back, balance.open}) {
        EXPECT_LE(part.upper, balance.emitted.upper) << s;
        wide += part.upper > 0.5 * balance.emitted.upper ? 1 : 0;
      }
    }
    const std::optional<TrueBalance> truth = true_balance(scene, exchange);
    if (!truth) {
      endless += 1;
      continue;
    }
    (most_reflected > 1.0 ? gains : finite) += 1;
    expect_holds(balance.emitted, truth->emitted, s);
    expect_holds(balance.absorbed, truth->absorbed, s);
    expect_holds(balance.back, truth->back, s);
    expect_holds(balance.open, truth->open, s);
  }
  for (const std::size_t count : {finite, wide, gains, without_bound}) EXPECT_GT(count, scaled_count(40));
  EXPECT_GT(endless, scaled_count(10));
}

// Emitters in boxes that are open above: the coarse bounds hold what fine view factors give.
TEST(RadiosityBalance, OfCoarseViewFactorsHoldsThatOfFineOnes) {
  for (std::uint64_t s = 0; s < scaled_count(6); ++s) {
    Random random(seed_of(s));
    generate::PlainScene plain;
    validation::add_room(plain, validation::box({0, 0, 0}, {random.between(1, 3), random.between(1, 3), 1}));
    if (random.one_in(2)) plain.patches.pop_back();
    give_random_colours(plain, random);
    const Scene scene = generate::build(plain);
    const Solution coarse = solve(scene, {.factors = {.accuracy = 0.3}}),
                   fine = solve(scene, {.factors = {.accuracy = 1e-4}});
    for (std::size_t c = 0; c < 3; ++c) {
      const Balance &a = coarse.channels[c].balance, &b = fine.channels[c].balance;
      for (matrix::Sum Balance::*part : {&Balance::emitted, &Balance::absorbed, &Balance::back, &Balance::open}) {
        EXPECT_LE((a.*part).lower, (b.*part).upper) << s;
        EXPECT_GE((a.*part).upper, (b.*part).lower) << s;
        EXPECT_GE((a.*part).lower, 0.0) << s;
        EXPECT_LE((a.*part).upper, a.emitted.upper) << s;
      }
    }
  }
}

}  // namespace
}  // namespace exactff::radiosity
