// Gebhart's exchange factors, column by column.
//
// Let y = e_j + rho F y, the radiosities where only j emits 1. Then b = eps_j F y solves b = F (eps_j e_j + rho b): it
// is column j. Of a black rest with the shares o: t = rho o + rho F t, and b = o + F t solves b = o + F rho b. Here o
// has bounds as well, and t grows with it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exactff/radiosity.h"
#include "exactff/version.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "matrix/columns.h"
#include "matrix/rows.h"
#include "radiosity/system.h"
#include "table/rows.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::radiosity {
namespace {

using kernel::above;
using kernel::below;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr BoundedValue kNotBounded{kNoNumber, 0.0, 1.0};  // a share, whatever the bounds of F

// The product of nonnegative numbers, rounded outward. Zero is exact.
double times_below(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : std::max(0.0, below(a * b)); }
double times_above(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : above(a * b); }
BoundedValue operator*(const BoundedValue& a, const BoundedValue& b) {
  return {a.value * b.value, times_below(a.lower, b.lower), times_above(a.upper, b.upper)};
}

BoundedValue within(const BoundedValue& b, double limit = kUnlimited) {
  const double upper = std::min(b.upper, limit), lower = std::min(b.lower, upper);
  return {std::isnan(b.value) ? kNoNumber : std::clamp(b.value, lower, upper), lower, upper};
}

BoundedValue emissivity_of(double rho) {
  const double eps = 1.0 - rho;
  if (rho == 0.0 || rho >= 0.5) return {eps, eps, eps};  // exact
  return {eps, below(eps), above(eps)};
}

// Column j; empty: there is no bound.
std::vector<BoundedValue> column_of(const System& all, std::size_t j) {
  System system = all;
  system.emissions.assign(all.factors.size(), 0.0);
  system.emissions[j] = 1.0;
  const SolutionBounds y = bounds_of(system);
  if (y.upper.empty()) return {};
  std::vector<BoundedValue> column = irradiances(system.factors, y);
  const BoundedValue eps = emissivity_of(system.reflectances[j]);
  for (BoundedValue& b : column) b = within(b * eps, 1.0);
  return column;
}

std::vector<BoundedValue> column_of_rest(const System& all, const std::vector<ViewFactor>& rest) {
  std::vector<BoundedValue> emissions;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const double rho = all.reflectances[i];
    emissions.push_back({rho * rest[i].value, times_below(rho, rest[i].lower), times_above(rho, rest[i].upper)});
  }
  const SolutionBounds t = bounds_of(all, emissions);
  if (t.upper.empty()) return {};
  std::vector<BoundedValue> column = irradiances(all.factors, t);
  for (std::size_t i = 0; i < column.size(); ++i) {
    const ViewFactor& o = rest[i];
    BoundedValue& b = column[i];
    const bool is_zero = o.upper == 0.0;
    b = within({b.value + o.value, is_zero ? b.lower : std::max(0.0, below(b.lower + o.lower)),
                is_zero ? b.upper : above(b.upper + o.upper)},
               1.0);
  }
  return column;
}

// eps_i A_i.
BoundedValue emitting_area(const BoundedValue& eps, double area) {
  return eps * BoundedValue{area, area * (1.0 - matrix::kRoundedAreas), area * (1.0 + matrix::kRoundedAreas)};
}

void set_conductors(Exchange::Channel& channel, const std::vector<BoundedValue>& emitting) {
  const std::size_t n = emitting.size();
  channel.conductors.resize(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) {
      const BoundedValue forth = emitting[i] * channel.factors[i * n + j],
                         back = emitting[j] * channel.factors[j * n + i];
      const BoundedValue both{0.5 * (forth.value + back.value), std::max(forth.lower, back.lower),
                              std::min(forth.upper, back.upper)};
      channel.conductors[i * n + j] = channel.conductors[j * n + i] = within(both);
    }
  }
  const auto add_rest = [&](const std::vector<BoundedValue>& factors, std::vector<BoundedValue>& conductors) {
    for (std::size_t i = 0; i < factors.size(); ++i) conductors.push_back(within(emitting[i] * factors[i]));
  };
  add_rest(channel.back, channel.conductors_to_back);
  add_rest(channel.open, channel.conductors_to_open);
}

Exchange::Channel channel_of(const Scene& scene, const matrix::Matrix& matrix, const std::vector<double>& areas,
                             const System& system, int threads, const Hooks& hooks) {
  const std::size_t n = areas.size();
  Exchange::Channel channel;
  std::vector<BoundedValue> emitting;
  for (std::size_t i = 0; i < n; ++i) {
    const BoundedValue eps = emissivity_of(system.reflectances[i]);
    channel.emissivities.push_back(eps.value);
    emitting.push_back(emitting_area(eps, areas[i]));
  }
  channel.factors.assign(n * n, kNotBounded);
  std::vector<std::vector<BoundedValue>> columns(n);
  files::parallel_for(n, threads, "exchange factors", hooks, [&](std::size_t j) { columns[j] = column_of(system, j); });
  bool all = true;
  for (std::size_t j = 0; j < n; ++j) {
    all = all && !columns[j].empty();
    for (std::size_t i = 0; i < columns[j].size(); ++i) channel.factors[i * n + j] = columns[j][i];
  }
  for (const auto& [rest, result] : {std::pair(&matrix.back, &channel.back), std::pair(&matrix.open, &channel.open)}) {
    if (rest->empty()) continue;
    *result = column_of_rest(system, *rest);
    all = all && !result->empty();
    if (result->empty()) result->assign(n, kNotBounded);
  }
  if (!all) {
    System unit = system;
    unit.emissions.assign(n, 1.0);
    Problem problem = problem_of_unbounded(scene, matrix.factors.from, unit);
    channel.no_bound = std::move(problem.why);
    channel.remedy = std::move(problem.suggestion);
  }
  set_conductors(channel, emitting);
  return channel;
}

void refuse_as_network(const matrix::ProgramFormat& format, const std::string& what, const std::string& remedy) {
  text::refuse(what, "a network of " + std::string(format.program) + " has one conductor for a pair of nodes", remedy);
}

void refuse_colours(const matrix::ProgramFormat& format) {
  refuse_as_network(format, "Kd differs between red, green and blue", "give materials of one Kd in all channels");
}

}  // namespace

void require_exchangeable(const Scene& scene, const matrix::ProgramFormat* format) {
  const kernel::StandardArithmetic arithmetic;
  matrix::Factors none{patches_of(scene), {}, {}};
  std::optional<Numbers> first;
  for (std::size_t c = 0; c < kChannelNames.size(); ++c) {
    const Numbers reflectances = system_of(scene, none, c).reflectances;
    for (std::size_t i = 0; i < reflectances.size(); ++i) {
      if (reflectances[i] <= 1.0) continue;
      text::refuse("the Kd of " + text::in_quotes(scene.name_of(none.from[i])) + " is above 1",
                   "its emissivity 1 - Kd would be negative", "give its material a Kd of at most 1");
    }
    if (!first) first = reflectances;
    if (format != nullptr && *first != reflectances) refuse_colours(*format);
  }
}

Exchange exchange(const Scene& scene, const matrix::Matrix& given, int threads, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  Exchange result;
  result.patches = patches_of(scene);
  if (given.factors.from != result.patches || given.factors.to != result.patches) {
    text::refuse("the matrix is not of all patches, in their order", "light bounces between all of them",
                 "leave out --from and --to");
  }
  require_exchangeable(scene);
  const Exposed exposed(given);
  const matrix::Matrix& matrix = exposed.matrix();
  for (std::size_t i = 0; i < result.patches.size(); ++i) result.areas.push_back(matrix.factors.at(i, 0).area_from);
  result.claim = matrix::claim_of(matrix, true);
  std::vector<Numbers> reflectances;
  for (std::size_t c = 0; c < kChannelNames.size(); ++c) {
    System system = system_of(scene, matrix.factors, c);
    reflectances.push_back(system.reflectances);
    const auto before = std::ranges::find(reflectances, system.reflectances);
    const auto same = static_cast<std::size_t>(before - reflectances.begin());
    result.channels.push_back(same < c ? result.channels[same]
                                       : channel_of(scene, matrix, result.areas, system, threads, hooks));
  }
  if (reflectances[0] == reflectances[1] && reflectances[0] == reflectances[2]) result.channels.resize(1);
  return result;
}

matrix::Square square_of(const matrix::ProgramFormat& format, const Scene& scene, const Exchange& exchange) {
  if (exchange.channels.size() != 1) refuse_colours(format);
  if (!exchange.channels.front().is_bounded()) {
    refuse_as_network(format, "some exchange factors have no bound", "lower Kd below 1");
  }
  const Exchange::Channel& grey = exchange.channels.front();
  const auto values_of = [](const std::vector<BoundedValue>& all) {
    Numbers values;
    for (const BoundedValue& one : all) values.push_back(one.value);
    return values;
  };
  matrix::Square square{
      .scene = &scene, .patches = exchange.patches, .areas = exchange.areas, .values = values_of(grey.conductors)};
  if (!grey.back.empty()) square.rest.emplace_back(matrix::kBack, values_of(grey.conductors_to_back));
  if (!grey.open.empty()) square.rest.emplace_back(matrix::kOpen, values_of(grey.conductors_to_open));
  return square;
}

table::Table table_of(const Scene& scene, const Exchange& exchange, const ViewFactorOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  using table::Strength;
  table::Head head;
  matrix::set_scene(head, scene);
  matrix::set_options(head, options);
  table::Rows rows(
      "exchange", std::move(head),
      {table::keys("from,to,channel"), table::numbers("exchange", Strength::kEstimated),
       table::numbers("lower,upper", Strength::kStated), table::numbers("conductor", Strength::kEstimated, "area"),
       table::numbers("conductor_lower,conductor_upper", Strength::kStated, "area"),
       table::texts("claim", Strength::kProved)});
  const auto known = [](double x) { return std::isfinite(x) ? std::optional(x) : std::nullopt; };
  const std::size_t n = exchange.patches.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::string from = scene.name_of(exchange.patches[i]);
    for (std::size_t c = 0; c < exchange.channels.size(); ++c) {
      const Exchange::Channel& channel = exchange.channels[c];
      const std::string_view name = exchange.channels.size() == 1 ? "all" : kChannelNames[c];
      const std::string_view claim = channel.is_bounded() ? to_string(exchange.claim) : kNoBound;
      const auto add = [&](std::string_view to, const BoundedValue& b, const BoundedValue& g) {
        rows << from << to << name << known(b.value) << b.lower << known(b.upper) << known(g.value) << g.lower
             << known(g.upper) << claim;
      };
      for (std::size_t j = 0; j < n; ++j) {
        add(scene.name_of(exchange.patches[j]), channel.factors[i * n + j], channel.conductors[i * n + j]);
      }
      if (!channel.back.empty()) add(matrix::kBack, channel.back[i], channel.conductors_to_back[i]);
      if (!channel.open.empty()) add(matrix::kOpen, channel.open[i], channel.conductors_to_open[i]);
    }
  }
  return rows.take();
}

}  // namespace exactff::radiosity
