// Temperatures and heats of gray surfaces, as radiosities. Heat that is taken away is a negative emission. The system
// is linear, so its solution is that of all positive emissions less that of all negative ones, each with its bounds.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "exactff/radiosity.h"
#include "kernel/float_environment.h"
#include "matrix/columns.h"
#include "matrix/rows.h"
#include "radiosity/system.h"
#include "scene/selections.h"
#include "table/rows.h"
#include "text/csv_lines.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::radiosity {
namespace {

using kernel::above;
using kernel::below;

constexpr double kRoundedPowers = 0x1p-49;  // relative, of a fourth power or root and a few products

BoundedValue exact(double x) { return {x, x, x}; }
bool is_zero(const BoundedValue& x) { return x.lower == 0.0 && x.upper == 0.0; }
// Zeros are exact.
BoundedValue operator+(const BoundedValue& a, const BoundedValue& b) {
  if (is_zero(a) || is_zero(b)) return is_zero(a) ? b : a;
  return {a.value + b.value, below(a.lower + b.lower), above(a.upper + b.upper)};
}
BoundedValue operator-(const BoundedValue& a, const BoundedValue& b) {
  if (is_zero(b)) return a;
  return {a.value - b.value, below(a.lower - b.upper), above(a.upper - b.lower)};
}
// With a factor that is not negative.
BoundedValue product(const BoundedValue& a, const BoundedValue& b) {
  if (is_zero(a) || is_zero(b)) return exact(0.0);
  return {a.value * b.value, below(std::min(a.lower * b.lower, a.lower * b.upper)),
          above(std::max(a.upper * b.lower, a.upper * b.upper))};
}
BoundedValue widened(double x, double relative) { return {x, x - relative * std::abs(x), x + relative * std::abs(x)}; }

BoundedValue black_emission(double temperature) {
  const double square = temperature * temperature;
  return widened(kStefanBoltzmann * square * square, kRoundedPowers);
}

BoundedValue temperature_of(const BoundedValue& emission) {
  const auto root = [](double e) { return std::sqrt(std::sqrt(std::max(0.0, e) / kStefanBoltzmann)); };
  return {root(emission.value), root(emission.lower) * (1.0 - kRoundedPowers),
          root(emission.upper) * (1.0 + kRoundedPowers)};
}

// What arrives if the patches emit `emission`, which is not negative. Empty: there is no bound.
std::vector<BoundedValue> arriving(const System& system, std::vector<BoundedValue> emission) {
  for (BoundedValue& one : emission) {
    for (double* end : {&one.value, &one.lower, &one.upper}) *end = std::max(0.0, *end);
  }
  const SolutionBounds radiosities = bounds_of(system, emission);
  if (radiosities.value.empty() || radiosities.upper.empty()) return {};
  return irradiances(system.factors, radiosities);
}

bool is_grey(const Rgb& kd) { return kd.r == kd.g && kd.g == kd.b; }

std::string name_of(const Scene& scene, const Selection& patch) { return text::in_quotes(scene.name_of(patch)); }

void require_materials(const Scene& scene, const std::vector<Selection>& patches, const ThermalConditions& conditions) {
  std::vector<Problem> problems;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Rgb kd = scene.material(scene.face(scene.faces_of(patches[i]).front()).material).reflectance;
    const auto complain = [&](const char* what, const char* why, const char* suggestion) {
      problems.push_back({.what = name_of(scene, patches[i]) + what, .why = why, .suggestion = suggestion});
    };
    if (!is_grey(kd))
      complain(" has a Kd that differs between channels", "heat has one emissivity 1 - Kd", "give it one Kd");
    if (kd.r > 1.0) complain(" has a Kd above 1", "its emissivity 1 - Kd would be negative", "give it a Kd below 1");
    if (kd.r == 1.0 && conditions.patches[i].heat) {
      complain(" has the Kd 1 and a Q", "what neither absorbs nor emits has no temperature",
               "give it a Kd below 1, or a T");
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
}

}  // namespace

Temperatures temperatures(const Scene& scene, const matrix::Matrix& given, const ThermalConditions& conditions) {
  const kernel::StandardArithmetic arithmetic;
  Temperatures result;
  result.patches = patches_of(scene);
  const std::size_t n = result.patches.size();
  if (given.factors.from != result.patches || given.factors.to != result.patches || given.back.empty() ||
      given.open.empty() || conditions.patches.size() != n) {
    text::refuse("the matrix is not of all patches, in their order, with backs and the sky",
                 "heat is exchanged between all of them", "compute it by exactff matrix --backs --to all,sky");
  }
  require_materials(scene, result.patches, conditions);
  const auto leads_out = [](const ViewFactor& f) { return f.upper > 0.0; };
  if (std::ranges::none_of(conditions.patches, [](const Known& known) { return known.temperature.has_value(); }) &&
      std::ranges::none_of(given.back, leads_out) && std::ranges::none_of(given.open, leads_out)) {
    text::refuse("no patch has a temperature, and nothing is open", "heats alone give temperatures no bound",
                 "give the T of at least one patch");
  }
  const Exposed exposed(given);
  const matrix::Matrix& matrix = exposed.matrix();
  System system = system_of(scene, matrix.factors, 0);
  result.claim = matrix::claim_of(matrix, true);
  const auto bounded = [](const ViewFactor& f) { return BoundedValue{f.value, f.lower, f.upper}; };
  const double square_metres = metres(scene.unit()) * metres(scene.unit());
  constexpr double kRounded = matrix::kRoundedAreas + 0x1p-50;  // with the unit and its square
  std::vector<BoundedValue> areas, eps, from_rest, black, given_flux, positive, negative;
  bool any_negative = false;
  for (std::size_t i = 0; i < n; ++i) {
    const Known& known = conditions.patches[i];
    const double area = matrix.factors.at(i, 0).area_from * square_metres, rho = system.reflectances[i];
    areas.push_back(widened(area, kRounded));
    eps.push_back(widened(1.0 - rho, 0x1p-52));
    result.areas.push_back(area);
    result.emissivities.push_back(1.0 - rho);
    const auto arrives = [&](const ViewFactor& f, double t) {
      return f.upper == 0.0 || t == 0.0 ? exact(0.0) : product(bounded(f), black_emission(t));
    };
    from_rest.push_back(arrives(matrix.back[i], conditions.back) + arrives(matrix.open[i], conditions.open));
    black.push_back(known.temperature ? black_emission(*known.temperature) : exact(0.0));
    given_flux.push_back(known.heat && area > 0.0 && *known.heat != 0.0 ? widened(*known.heat / area, 2.0 * kRounded)
                                                                        : exact(0.0));
    if (known.heat) system.reflectances[i] = 1.0;
    const BoundedValue flux = given_flux.back(), none = exact(0.0);
    positive.push_back(product(from_rest.back(), exact(system.reflectances[i])) +
                       (known.temperature  ? product(black.back(), eps.back())
                        : flux.value > 0.0 ? flux
                                           : none));
    negative.push_back(flux.value < 0.0 ? BoundedValue{-flux.value, -flux.upper, -flux.lower} : none);
    any_negative = any_negative || flux.value < 0.0;
  }
  constexpr double kMuchHeat = 1e300;
  for (std::size_t i = 0; i < n; ++i) {
    if (positive[i].upper <= kMuchHeat && negative[i].upper <= kMuchHeat) continue;
    text::refuse(name_of(scene, result.patches[i]) + " gives off more than " + text::short_number(kMuchHeat) +
                     " W per square metre",
                 "doubles end near 1.8e308, below sums of such heats",
                 "check its T or Q, and those of (back) and (open)");
  }
  system.emissions.assign(n, 0.0);
  std::vector<BoundedValue> h = arriving(system, positive);
  if (!h.empty() && any_negative) {
    const std::vector<BoundedValue> less = arriving(system, negative);
    for (std::size_t i = 0; i < less.size(); ++i) h[i] = h[i] - less[i];
    if (less.empty()) h.clear();
  }
  if (h.empty()) {
    system.emissions.assign(n, 1.0);
    Problem problem = problem_of_unbounded(scene, result.patches, system);
    result.no_bound = std::move(problem.why);
    result.remedy = "give some patch of a Kd below 1 a T, or compute narrower view factors by --accuracy or --certify";
    return result;
  }
  result.to_back = result.to_open = exact(0.0);
  BoundedValue sum = exact(0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const Known& known = conditions.patches[i];
    h[i] = h[i] + from_rest[i];
    BoundedValue leaving;
    if (known.temperature) {
      result.temperatures.push_back(exact(*known.temperature));
      result.heats.push_back(product(product(black[i] - h[i], eps[i]), areas[i]));
      leaving = product(black[i], eps[i]) + product(h[i], widened(system.reflectances[i], 0.0));
    } else {
      const BoundedValue by_eps{
          given_flux[i].value / eps[i].value,
          below(std::min(given_flux[i].lower / eps[i].lower, given_flux[i].lower / eps[i].upper)),
          above(std::max(given_flux[i].upper / eps[i].lower, given_flux[i].upper / eps[i].upper))};
      const BoundedValue emission = h[i] + by_eps;
      if (emission.upper < 0.0) {
        text::refuse("more heat is taken from " + name_of(scene, result.patches[i]) + " than arrives there",
                     "it would be colder than 0 K", "take away less heat, or give some patch a higher T");
      }
      result.temperatures.push_back(temperature_of(emission));
      result.heats.push_back(exact(*known.heat));
      leaving = h[i] + given_flux[i];
    }
    sum = sum + result.heats[i];
    const auto lost = [&](const ViewFactor& f, double t) {
      return f.upper == 0.0 ? exact(0.0) : product(product(leaving - black_emission(t), bounded(f)), areas[i]);
    };
    result.to_back = result.to_back + lost(matrix.back[i], conditions.back);
    result.to_open = result.to_open + lost(matrix.open[i], conditions.open);
  }
  result.unbalanced = sum - result.to_back - result.to_open;
  return result;
}

// --- Conditions ---

namespace {

// Takes one condition after another.
class Conditions {
 public:
  explicit Conditions(const Scene& scene) : scene_(scene), patches_(patches_of(scene)) {
    result_.patches.resize(patches_.size());
  }

  // Returns what is wrong with it.
  [[nodiscard]] std::optional<Problem> add(const Condition& one) {
    const auto& [t, q] = one.known;
    if (t.has_value() == q.has_value()) {
      return Problem{.what = t ? "there are both T and Q" : "there is neither T nor Q",
                     .why = "one follows from the other",
                     .suggestion = "give one of them, and leave the other one out"};
    }
    if (const double number = t ? *t : *q; !std::isfinite(number) || (t && number < 0.0)) {
      return Problem{.what = (t ? "T is " : "Q is ") + text::shortest(number),
                     .why = t ? "temperatures are in K" : "heats are finite, in W",
                     .suggestion = t ? "add 273.15 to degrees Celsius" : "give a number"};
    }
    if (one.name == matrix::kBack || one.name == matrix::kOpen) {
      (one.name == matrix::kBack ? result_.back : result_.open) = t.value_or(0.0);
      if (!q) return std::nullopt;
      return Problem{
          .what = one.name + " has a Q", .why = "it is black, at a temperature", .suggestion = "give it a T"};
    }
    try {
      return add_patches(one);
    } catch (const InputError& error) {
      return error.problems().front();
    }
  }

  // Throws InputError, in `file` if that is not empty, for patches without a condition.
  [[nodiscard]] ThermalConditions take(const std::filesystem::path& file) {
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < patches_.size(); ++i) {
      const Known& known = result_.patches[i];
      if (!known.temperature && !known.heat && missing.size() < 4) missing.push_back(name_of(scene_, patches_[i]));
    }
    if (missing.size() > 3) missing.back() = "others";
    if (missing.empty()) return std::move(result_);
    const std::string none = text::enumerate(missing), why = "every patch has a temperature or gives off heat",
                      advice = "give the Q 0 to a patch that only reflects and emits again";
    if (file.empty()) text::refuse("neither T nor Q has " + none, why, advice);
    text::refuse(file, "has no row for " + none, why, advice);
  }

 private:
  std::optional<Problem> add_patches(const Condition& one) {
    double area = 0.0;
    std::vector<std::size_t> rows;
    for (const Selection& patch : scene_.select_all(one.name)) {
      const auto found = std::ranges::find(patches_, patch);
      if (found == patches_.end()) {
        return Problem{.what = text::in_quotes(one.name) + " is no patch",
                       .why = "temperatures are of whole patches",
                       .suggestion = "name a patch"};
      }
      rows.push_back(static_cast<std::size_t>(found - patches_.begin()));
      area += area_of(scene_, patch);
    }
    for (const std::size_t row : rows) {
      Known& known = result_.patches[row];
      if (known.temperature || known.heat) {
        return Problem{.what = name_of(scene_, patches_[row]) + " has two rows",
                       .why = "one of them would be ignored",
                       .suggestion = "remove one"};
      }
      known = one.known;
      if (known.heat && rows.size() > 1) *known.heat *= area_of(scene_, patches_[row]) / area;
    }
    return std::nullopt;
  }

  const Scene& scene_;
  std::vector<Selection> patches_;
  ThermalConditions result_;
};

}  // namespace

ThermalConditions conditions_of(const Scene& scene, std::span<const Condition> all) {
  const kernel::StandardArithmetic arithmetic;
  Conditions conditions(scene);
  std::vector<Problem> problems;
  for (const Condition& one : all) {
    if (std::optional<Problem> problem = conditions.add(one)) problems.push_back(std::move(*problem));
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return conditions.take({});
}

ThermalConditions read_conditions(const Scene& scene, const std::filesystem::path& file) {
  const kernel::StandardArithmetic arithmetic;
  Conditions conditions(scene);
  text::CsvLines lines(file, "a CSV file with the columns patch, T, Q");
  text::CsvDialect dialect;
  text::ProblemList problems;
  std::vector<std::string> head, fields;
  const auto complain = [&](std::string what, std::string why, std::string suggestion) {
    problems.add({file.string(), lines.number(), std::move(what), std::move(why), std::move(suggestion)});
  };
  const auto field = [&](std::string_view name) -> std::string {
    const auto found = std::ranges::find(head, name);
    const auto at = static_cast<std::size_t>(found - head.begin());
    return at < fields.size() ? fields[at] : std::string();
  };
  const auto add_row = [&] {
    Condition one{field("patch"), {}};
    for (const auto& [name, known] : {std::pair("T", &one.known.temperature), std::pair("Q", &one.known.heat)}) {
      const std::string text = field(name);
      if (text.empty()) continue;
      const text::ParsedNumber number = dialect.number(text);
      if (number.fault != text::NumberFault::kNone) {
        return complain(describe(number.fault, text), "T and Q are numbers", advice(number.fault));
      }
      *known = number.value;
    }
    if (std::optional<Problem> problem = conditions.add(one)) {
      complain(std::move(problem->what), std::move(problem->why), std::move(problem->suggestion));
    }
  };
  for (std::string_view line; lines.next(line);) {
    if (text::is_csv_comment(line)) continue;
    const bool is_head = head.empty();
    if (is_head) dialect = text::CsvDialect(line);
    if (!dialect.split(line, is_head ? head : fields)) {
      complain("a quotation mark is not closed in its line, or text follows it", "the fields cannot be separated",
               "write a quotation mark inside quotes twice");
    } else if (is_head) {
      const auto has = [&](std::string_view name) { return std::ranges::find(head, name) != head.end(); };
      if (has("patch") && (has("T") || has("Q"))) continue;
      complain("the first line has not the columns patch, T, Q", "they say what the numbers are", "write patch,T,Q");
      break;
    } else {
      add_row();
    }
  }
  problems.throw_if_any();
  return conditions.take(file);
}

// --- Files ---

table::Table table_of(const Scene& scene, const Temperatures& found, const ViewFactorOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  using table::Strength;
  table::Head head;
  matrix::set_scene(head, scene);
  matrix::set_options(head, options);
  table::Rows rows(
      "temperatures", std::move(head),
      {table::keys("patch"), table::numbers("temperature", Strength::kEstimated, "K"),
       table::numbers("temperature_lower,temperature_upper", Strength::kStated, "K"),
       table::numbers("heat", Strength::kEstimated, "W"),
       table::numbers("heat_lower,heat_upper", Strength::kStated, "W"), table::numbers("emissivity", Strength::kGiven),
       table::numbers("area", Strength::kEstimated, "m2"), table::texts("claim", Strength::kProved)});
  const std::string_view claim = to_string(found.claim);
  for (std::size_t i = 0; i < found.patches.size(); ++i) {
    const BoundedValue &t = found.temperatures[i], &q = found.heats[i];
    rows << scene.name_of(found.patches[i]) << t.value << t.lower << t.upper << q.value << q.lower << q.upper
         << found.emissivities[i] << found.areas[i] << claim;
  }
  constexpr std::optional<double> kNone;
  for (const auto& [name, q] : {std::pair(matrix::kBack, found.to_back), std::pair(matrix::kOpen, found.to_open)}) {
    rows << name << kNone << kNone << kNone << -q.value << -q.upper << -q.lower << kNone << kNone << claim;
  }
  return rows.take();
}

}  // namespace exactff::radiosity
