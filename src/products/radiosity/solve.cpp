#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "exactff/radiosity.h"
#include "kernel/float_environment.h"
#include "matrix/rows.h"
#include "matrix/surroundings.h"
#include "radiosity/gather.h"
#include "radiosity/narrowing.h"
#include "radiosity/system.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "text/phrases.h"

namespace exactff::radiosity {
namespace {

using kernel::above;
using kernel::below;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostNames = 3;

const Material& material_of(const Scene& scene, FaceId face) { return scene.material(scene.face(face).material); }
const Material& material_of(const Scene& scene, const Selection& patch) {
  return material_of(scene, scene.faces_of(patch).front());
}

void require_one_material(const Scene& scene, const Selection& patch, std::vector<Problem>& problems) {
  const std::vector<FaceId> faces = scene.faces_of(patch);
  const Material& first = material_of(scene, faces.front());
  for (const FaceId face : faces) {
    const Material& other = material_of(scene, face);
    if (other.reflectance == first.reflectance && other.radiosity == first.radiosity) continue;
    const char* what = other.reflectance == first.reflectance ? "Ke" : "Kd";
    problems.push_back({.file = SceneInside::data(scene).file,
                        .line = scene.face(face).line,
                        .what = "the faces of patch '" + scene.name_of(patch) + "' differ in " + what,
                        .why = "'" + scene.name_of(faces.front()) + "' has material '" + first.name + "', '" +
                               scene.name_of(face) + "' has '" + other.name + "'; a patch has one radiosity",
                        .suggestion = "put the faces into separate groups, or make each a patch by --patches faces"});
    return;
  }
}

void require_complete(const Scene& scene, const matrix::Matrix& matrix) {
  const matrix::Factors& all = matrix.factors;
  const std::vector<Selection> patches = patches_of(scene);
  if (all.from == patches && all.to == patches && all.entries.size() == patches.size() * patches.size()) return;
  throw std::invalid_argument("radiosity::solve needs the factors between all patches");
}

Factors factors_of(const matrix::Factors& all) {
  Factors factors;
  for (std::size_t i = 0; i < all.from.size(); ++i) {
    for (std::size_t j = 0; j < all.to.size(); ++j) {
      const ViewFactor& f = all.at(i, j);
      if (f.upper > 0.0) factors.add({static_cast<std::uint32_t>(j), f.lower, f.value, f.upper});
    }
    factors.end_row();
  }
  return factors;
}

void take_mean_over_exposed(ViewFactor& f, const ViewFactor& buried) {
  if (f.upper == 0.0 || buried.upper == 0.0) return;
  f.lower = std::clamp(below(f.lower / above(1.0 - buried.lower)), 0.0, 1.0);
  f.upper = buried.upper < 1.0 ? std::min(1.0, above(f.upper / below(1.0 - buried.upper))) : 1.0;
  f.value = std::clamp(f.value / (1.0 - buried.value), f.lower, f.upper);
}

}  // namespace

// --- Balance ---

// Where the light goes. For each patch, A_i B_i leaves it, and A_i H_i = A_i sum_j F_ij B_j arrives.
//
// Bounce by bounce, b^0 = E and b^(n+1) = rho F b^n; B is the sum of all b^n. Let P_n = sum A_i b_i^n. Of P_n, the part
// sum A_i b_i^n back_i meets backs and sum A_i b_i^n open_i leaves. Where A_i F_ij = A_j F_ji and the rows add up to 1,
// the rest arrives:
//   sum_i A_i (F b^n)_i = sum_j A_j b_j^n sum_i F_ji = sum_j A_j b_j^n (1 - back_j - open_j)
// Of this, sum A_i (1 - rho_i) (F b^n)_i is absorbed, and sum A_i rho_i (F b^n)_i = P_(n+1) leaves again. So
//   P_n = absorbed_n + back_n + open_n + P_(n+1),   P_0 = emitted,
//   emitted = (what bounces 0 to N lose to the three) + P_(N+1).
//
// Four inequalities follow. They clip the sums, which are as wide as the view factors make them.
// 1. back, open >= 0: no factor of their products is negative.
// 2. absorbed >= 0 if every rho_i <= 1: likewise.
// 3. absorbed + back + open <= emitted if every rho_i <= 1: P_(N+1) >= 0 for every N, and the three sums over the
//    bounces do not fall. This holds even where B is infinite.
// 4. absorbed + back + open = emitted if B is finite: P_n -> 0. No rho is limited.
// So each of the three is at most emitted less the others' lower bounds (3 or 4), and at least emitted less the others'
// upper bounds (4). 3 and 4 need reciprocity and rows that add up to 1; Solution::reasons_against_balance is empty
// then.
//
// back_i and open_i need not be computed: where a row adds up to 1, back_i + open_i = 1 - sum_j F_ij, its loss, and
// each of the two is at most that. It is 0 where that is proved (ProvedZeros), and the loss where the other is 0.

namespace {

using matrix::Sum;

constexpr std::array<Sum Balance::*, 4> kWays = {&Balance::absorbed, &Balance::back, &Balance::open, &Balance::lost};
using matrix::kRoundedAreas;

bool is_zero(const Sum& x) { return x.lower == 0.0 && x.upper == 0.0; }

// The interval of all sums. Zero is exact.
Sum operator+(const Sum& a, const Sum& b) {
  if (is_zero(a)) return b;
  if (is_zero(b)) return a;
  return {below(a.lower + b.lower), above(a.upper + b.upper)};
}

// The interval of all products with a number of [b.lower, b.upper], 0 <= b.lower. An upper bound may be infinite.
Sum times_nonnegative(const Sum& a, const Sum& b) {
  if (is_zero(a) || is_zero(b)) return {};
  const auto product = [](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : x * y; };
  return {below(std::min(product(a.lower, b.lower), product(a.lower, b.upper))),
          above(std::max(product(a.upper, b.lower), product(a.upper, b.upper)))};
}

Sum one_minus(double rho) { return rho == 1.0 ? Sum{} : Sum{below(1.0 - rho), above(1.0 - rho)}; }

Sum operator-(const Sum& a, const Sum& b) { return a + Sum{-b.upper, -b.lower}; }

// What both hold. Empty, with lower > upper, if that is nothing.
Sum common(const Sum& a, const Sum& b) { return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)}; }

Sum interval(const BoundedValue& q) { return {q.lower, q.upper}; }
Sum interval(const ViewFactor& f) { return {f.lower, f.upper}; }

constexpr Sum kAnyShare{0.0, 1.0};

Sum row_to_patches(const matrix::Factors& factors, std::size_t row) {
  Sum sum;
  for (std::size_t j = 0; j < factors.to.size(); ++j) sum = sum + interval(factors.at(row, j));
  return sum;
}

// What is known of the system, for the inequalities.
struct Laws {
  bool loses_at_each_bounce = false;  // every rho_i <= 1
  bool adds_up = false;               // reciprocity, and rows that add up to 1
  bool is_finite = false;             // B is
};

// Of what leaves a patch, the shares that meet backs, leave, or do either.
struct Losses {
  std::vector<matrix::Sum> back, open, lost;
  bool is_possible = true;  // the bounds of every row hold 1, as far as it must add up to 1
};
Losses losses_of(const Scene& scene, const matrix::Matrix& matrix, bool adds_up) {
  const bool knows_all = !matrix.back.empty() && !matrix.open.empty();
  const matrix::ProvedZeros zeros =
      knows_all ? matrix::ProvedZeros{} : matrix::proved_zeros(scene, matrix.factors.from);
  Losses losses;
  for (std::size_t i = 0; i < matrix.factors.from.size(); ++i) {
    if (matrix.factors.at(i, 0).area_from == 0.0) {  // buried as a whole
      for (auto* of : {&losses.back, &losses.open, &losses.lost}) of->emplace_back();
      continue;
    }
    const auto share = [i](const std::vector<ViewFactor>& computed, const std::vector<bool>& is_zero) {
      return !computed.empty() ? interval(computed[i]) : is_zero[i] ? Sum{} : kAnyShare;
    };
    Sum back = share(matrix.back, zeros.back), open = share(matrix.open, zeros.open), lost = back + open;
    const Sum left = adds_up ? common(lost, Sum{1.0, 1.0} - row_to_patches(matrix.factors, i)) : lost;
    if (left.lower > left.upper) {
      losses.is_possible = false;
    } else {
      lost = common(left, kAnyShare);
      const Sum of_back = lost - open, of_open = lost - back;
      back = common(back, {of_back.lower, lost.upper});
      open = common(open, {of_open.lower, lost.upper});
    }
    losses.back.push_back(back);
    losses.open.push_back(open);
    losses.lost.push_back(lost);
  }
  return losses;
}

// Sums of products, rounded outward, clipped by 1 and 2. The channel has its radiosities and irradiances.
Balance sums_of(const Channel& channel, const System& system, const std::vector<double>& areas, const Losses& losses,
                const Laws& laws) {
  Balance balance;
  for (std::size_t i = 0; i < system.factors.size(); ++i) {
    const double given = areas[i], emission = system.emissions[i];
    const Sum area{given * (1.0 - kRoundedAreas), given * (1.0 + kRoundedAreas)};
    const Sum leaving = times_nonnegative(interval(channel.radiosity[i]), area);
    const Sum arriving = times_nonnegative(interval(channel.irradiance[i]), area);
    balance.emitted = balance.emitted + times_nonnegative({emission, emission}, area);
    balance.absorbed = balance.absorbed + times_nonnegative(one_minus(system.reflectances[i]), arriving);
    balance.back = balance.back + times_nonnegative(leaving, losses.back[i]);
    balance.open = balance.open + times_nonnegative(leaving, losses.open[i]);
    balance.lost = balance.lost + times_nonnegative(leaving, losses.lost[i]);
  }
  for (Sum* part : {&balance.emitted, &balance.back, &balance.open, &balance.lost})
    part->lower = std::max(0.0, part->lower);
  if (laws.loses_at_each_bounce) balance.absorbed.lower = std::max(0.0, balance.absorbed.lower);
  if (laws.is_finite) return balance;
  for (Sum Balance::*way : kWays) (balance.*way).upper = std::numeric_limits<double>::infinity();
  return balance;
}

// Whether the sums contradict 4: then some bound does not hold.
bool is_contradiction(const Balance& sums) {
  const Sum gone = sums.absorbed + sums.lost;
  return gone.lower > sums.emitted.upper || gone.upper < sums.emitted.lower;
}

// By what the other parts leave of what is emitted.
void clip(Sum& part, const Sum& a, const Sum& b, const Sum& emitted, const Laws& laws) {
  const Sum rest = emitted - (a + b);
  part.upper = std::min(part.upper, rest.upper);
  if (a.lower >= 0.0 && b.lower >= 0.0) part.upper = std::min(part.upper, emitted.upper);  // without a rounding
  if (laws.is_finite) part.lower = std::max(part.lower, rest.lower);
}

// Clipped by 3 and 4 as well. Requires sums that are no contradiction, if B is finite.
Balance clip(const Balance& sums, const Laws& laws) {
  Balance clipped = sums;
  if (!laws.adds_up || !(laws.is_finite || laws.loses_at_each_bounce)) return clipped;
  clip(clipped.absorbed, sums.lost, {}, sums.emitted, laws);
  clip(clipped.lost, sums.absorbed, {}, sums.emitted, laws);
  clip(clipped.back, sums.absorbed, sums.open, sums.emitted, laws);
  clip(clipped.open, sums.absorbed, sums.back, sums.emitted, laws);
  return clipped;
}

// --- One channel ---

std::string words_of_white(const Scene& scene, const std::vector<Selection>& patches, const Numbers& reflectances) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (reflectances[i] >= 1.0) names.push_back(scene.name_of(patches[i]));
  }
  if (const std::size_t count = names.size(); count > kMostNames) {
    names.resize(kMostNames - 1);
    names.push_back(std::to_string(count - names.size()) + " others");
  }
  return text::enumerate(names);
}

BoundedValue between(double value, double lower, double upper) {
  return {std::isfinite(value) ? std::clamp(value, lower, upper) : 0.5 * lower + 0.5 * upper, lower, upper};
}

void set_bounded(Channel& channel, const System& system, const SolutionBounds& bounds) {
  for (std::size_t i = 0; i < system.factors.size(); ++i) {
    const double value = bounds.value.empty() ? kUnknown : bounds.value[i];
    channel.radiosity.push_back(between(value, bounds.lower[i], bounds.upper[i]));
  }
  channel.irradiance = irradiances(system.factors, bounds);
  for (BoundedValue& b : channel.irradiance) b = between(b.value, b.lower, b.upper);
}

void set_unbounded(Channel& channel, const System& system, const Numbers& value) {
  for (std::size_t i = 0; i < system.factors.size(); ++i) {
    const double irradiance = value.empty() ? kUnknown : sum_of_values(system.factors.row(i), value);
    channel.radiosity.push_back({value.empty() ? kUnknown : value[i], system.emissions[i], kInfinity});
    channel.irradiance.push_back({irradiance, 0.0, kInfinity});
  }
}

// Sums that are a contradiction are kept as they are, to show it.
void set_balance(Channel& channel, const System& system, const std::vector<double>& areas, const Losses& losses,
                 bool adds_up) {
  const bool loses = std::ranges::all_of(system.reflectances, [](double rho) { return rho <= 1.0; });
  const Laws laws{.loses_at_each_bounce = loses, .adds_up = adds_up, .is_finite = channel.is_bounded()};
  const Balance sums = sums_of(channel, system, areas, losses, laws);
  channel.is_balanced = losses.is_possible && (!laws.is_finite || !is_contradiction(sums));
  channel.balance = channel.is_balanced ? clip(sums, laws) : sums;
}

Channel solve_channel(const Scene& scene, const std::vector<Selection>& patches, const System& system) {
  const SolutionBounds bounds = bounds_of(system);
  Channel channel;
  if (bounds.upper.empty()) {
    Problem problem = problem_of_unbounded(scene, patches, system);
    channel.no_bound = std::move(problem.why);
    channel.remedy = std::move(problem.suggestion);
    set_unbounded(channel, system, may_have_no_solution(system) ? Numbers{} : bounds.value);
  } else {
    set_bounded(channel, system, bounds);
  }
  return channel;
}

void set_colours(const Scene& scene, const std::vector<Selection>& patches, double Rgb::*colour, System& system) {
  system.reflectances.clear();
  system.emissions.clear();
  for (const Selection& patch : patches) {
    const Material& material = material_of(scene, patch);
    system.reflectances.push_back(material.reflectance.*colour);
    system.emissions.push_back(material.radiosity.*colour);
  }
}

void set_claims(const matrix::Matrix& matrix, Solution& solution) {
  const auto is_wide = [](const ViewFactor& f) { return !f.accurate; };
  solution.wide = static_cast<std::size_t>(std::ranges::count_if(matrix.factors.entries, is_wide));
  solution.claim = matrix::claim_of(matrix, false);
  solution.claim_of_balance = matrix::claim_of(matrix, true);
}

}  // namespace

bool is_balanced(const Solution& solution) {
  return std::ranges::all_of(solution.channels, [](const Channel& channel) { return channel.is_balanced; });
}

Problem problem_of_unbounded(const Scene& scene, const std::vector<Selection>& patches, const System& system) {
  constexpr double kMuchLight = 1e300;
  const std::string narrower = "compute narrower view factors by --accuracy, --width or --budget";
  if (may_have_no_solution(system)) {
    return {.why = "Kd is 1 or more on " + words_of_white(scene, patches, system.reflectances) +
                   ", and the bounds of the view factors do not prove that enough light is absorbed elsewhere or "
                   "leaves",
            .suggestion = "lower Kd there, or " + narrower};
  }
  if (const double most = std::ranges::max(system.emissions); most > kMuchLight) {
    return {
        .why = "Ke is up to " + text::short_number(most) + ", and doubles end near 1.8e308, below sums of such light",
        .suggestion = "scale Ke down: radiosities scale with it"};
  }
  return {.why =
              "the bounds of the view factors are so wide that they do not prove that less light is reflected than "
              "arrives",
          .suggestion = narrower};
}

std::vector<Selection> patches_of(const Scene& scene) {
  std::vector<Selection> patches = all_patches(scene);
  std::vector<Problem> problems;
  for (const Selection& patch : patches) require_one_material(scene, patch, problems);
  if (!problems.empty()) throw InputError(std::move(problems));
  return patches;
}

Exposed::Exposed(const matrix::Matrix& given) : given_(given) {
  if (given.buried.empty()) return;
  matrix::Matrix& result = made_.emplace(given);
  const std::size_t columns = given.factors.to.size();
  for (std::size_t i = 0; i < given.buried.size(); ++i) {
    const ViewFactor& buried = given.buried[i];
    for (std::size_t j = 0; j < columns; ++j) {
      ViewFactor& f = result.factors.entries[i * columns + j];
      take_mean_over_exposed(f, buried);
      f.area_from *= 1.0 - buried.value;
      f.area_to *= 1.0 - given.buried[j].value;
    }
    if (!result.back.empty()) take_mean_over_exposed(result.back[i], buried);
    if (!result.open.empty()) take_mean_over_exposed(result.open[i], buried);
  }
}

System system_of(const Scene& scene, const matrix::Factors& factors, std::size_t channel) {
  System system{factors_of(factors), {}, {}};
  set_colours(scene, factors.from, kColours[channel], system);
  return system;
}

Solution solve(const Scene& scene, const matrix::Matrix& given) {
  const kernel::StandardArithmetic arithmetic;
  require_complete(scene, given);
  const Exposed exposed(given);
  const matrix::Matrix& matrix = exposed.matrix();
  Solution solution;
  solution.patches = matrix.factors.from;
  for (std::size_t i = 0; i < solution.patches.size(); ++i) {
    solution.areas.push_back(matrix.factors.at(i, 0).area_from);
  }
  solution.reasons_against_balance =
      matrix::reasons_against_one(scene, matrix.factors, {.back = true, .open = true});  // or what is left
  const bool adds_up = solution.reasons_against_balance.empty();
  solution.lost_is_rest = matrix.back.empty() || matrix.open.empty();
  const Losses losses = losses_of(scene, matrix, adds_up);
  System system{factors_of(matrix.factors), {}, {}};
  for (std::size_t c = 0; c < kColours.size(); ++c) {
    const System before{{}, system.reflectances, system.emissions};
    set_colours(scene, solution.patches, kColours[c], system);
    const bool is_same = c > 0 && before.reflectances == system.reflectances && before.emissions == system.emissions;
    Channel& channel = solution.channels[c];
    channel = is_same ? solution.channels[c - 1] : solve_channel(scene, solution.patches, system);
    if (!is_same) set_balance(channel, system, solution.areas, losses, adds_up);
  }
  set_claims(matrix, solution);
  return solution;
}

matrix::Options matrix_options(const Options& options) {
  if (options.width) require_width(*options.width);
  return {.factors = options.factors, .backs = options.backs, .threads = options.threads};
}

Solution solve(const Scene& scene, const Options& options, const Hooks& hooks) {
  const std::vector<Selection> patches = patches_of(scene);
  matrix::Matrix matrix = matrix::compute(scene, patches, patches, matrix_options(options), hooks);
  return solve_within(scene, matrix, options, nullptr, hooks);
}

std::string_view claim_text(const Solution& solution, const Channel& channel) {
  return channel.is_bounded() ? to_string(solution.claim) : kNoBound;
}

}  // namespace exactff::radiosity
