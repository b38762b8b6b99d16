#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "exactff/radiosity.h"
#include "kernel/float_environment.h"
#include "matrix/row_facts.h"
#include "radiosity/balance.h"
#include "radiosity/narrowing.h"
#include "radiosity/system.h"
#include "scene/scene.h"
#include "text/phrases.h"

namespace exactff::radiosity {
namespace {

using kernel::above;
using kernel::below;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<double Rgb::*, 3> kChannels = {&Rgb::r, &Rgb::g, &Rgb::b};
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

}  // namespace

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

namespace {

double estimated_irradiance(std::span<const Entry> row, const Numbers& value) {
  if (value.empty()) return kUnknown;
  double sum = 0.0;
  for (const Entry& entry : row) sum += entry.value * value[entry.column];
  return sum;
}

BoundedValue between(double value, double lower, double upper) {
  return {std::isfinite(value) ? std::clamp(value, lower, upper) : 0.5 * lower + 0.5 * upper, lower, upper};
}

void set_bounded(Channel& channel, const System& system, const SolutionBounds& bounds) {
  for (std::size_t i = 0; i < system.factors.size(); ++i) {
    const auto row = system.factors.row(i);
    const double value = bounds.value.empty() ? kUnknown : bounds.value[i];
    channel.radiosity.push_back(between(value, bounds.lower[i], bounds.upper[i]));
    channel.irradiance.push_back(
        between(estimated_irradiance(row, bounds.value), sum_below(row, bounds.lower), sum_above(row, bounds.upper)));
  }
}

void set_unbounded(Channel& channel, const System& system, const Numbers& value) {
  for (std::size_t i = 0; i < system.factors.size(); ++i) {
    channel.radiosity.push_back({value.empty() ? kUnknown : value[i], system.emissions[i], kInfinity});
    channel.irradiance.push_back({estimated_irradiance(system.factors.row(i), value), 0.0, kInfinity});
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
  for (const ViewFactor& f : matrix.factors.entries) solution.claim = matrix::weaker(solution.claim, f.claim);
  const auto is_wide = [](const ViewFactor& f) { return !f.accurate; };
  solution.wide = static_cast<std::size_t>(std::ranges::count_if(matrix.factors.entries, is_wide));
  solution.claim_of_balance = solution.claim;
  for (const auto* column : {&matrix.back, &matrix.open}) {
    for (const ViewFactor& f : *column) {
      solution.claim_of_balance = matrix::weaker(solution.claim_of_balance, f.claim);
    }
  }
}

}  // namespace

std::vector<Selection> patches_of(const Scene& scene) {
  std::vector<Selection> patches;
  std::vector<Problem> problems;
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const Selection patch{static_cast<PatchId>(p), {}, scene.id()};
    if (scene.faces_of(patch).empty()) continue;
    patches.push_back(patch);
    require_one_material(scene, patch, problems);
  }
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
  set_colours(scene, factors.from, kChannels[channel], system);
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
  for (std::size_t c = 0; c < kChannels.size(); ++c) {
    const System before{{}, system.reflectances, system.emissions};
    set_colours(scene, solution.patches, kChannels[c], system);
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
