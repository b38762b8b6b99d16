// Runs every family at every stiffness with every method.
//
//   1. Make the scene and its true value.
//   2. Run the exact method. Its value must be what the true value rounds to.
//   3. Take the exact visible region with its corners rounded to doubles, and evaluate Eq. (4) over it in three ways.
//   4. Run Tampieri's algorithm, mended and literal. Its tolerance eps_B is a ten-thousandth of the unoccluded form
//      factor: the choice of a user who knows roughly what to expect.
//   5. Measure times: the median of several calls within a time limit.
// The place of a scene in the report is its index, so that nothing but the times depends on the number of threads.
#include "stress/stress.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>

#include "exactff/adaptive.h"
#include "files/parallel.h"
#include "files/stopwatch.h"
#include "kernel/ball.h"
#include "stress/families.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::stress {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kTruthDigits = 40;

// |value - truth| / scale
double relative_difference(double value, const Enclosure& truth, const Enclosure& scale) {
  if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
  constexpr long kBits = 256;
  const auto at_bits = [](const Enclosure& of) { return kernel::with_bits(EnclosureInside::ball(of), kBits); };
  const double error =
      std::abs(kernel::nearest_to_midpoint((kernel::to_ball(value, kBits) - at_bits(truth)) / at_bits(scale)));
  return error < kTruthIsGoodTo ? 0.0 : error;
}

template <class Compute>
double median_seconds(const Compute& compute) {
  constexpr std::size_t kMostCalls = 7;
  constexpr double kLimit = 0.05;
  return files::median_seconds(compute, kMostCalls, kLimit);
}

class Trial {
 public:
  Trial(const Case& scene_case, Row& row)
      : case_(scene_case), row_(row), source_(case_.scene, case_.scene.select("source")) {}

  void run() {
    row_.stiffness = case_.stiffness;
    row_.occluders = case_.scene.faces().size() - 1;
    run_exact();
    run_formula(Method::kAcos, AngleFormula::kAcos);
    run_formula(Method::kAtan2, AngleFormula::kAtan2);
    run_formula(Method::kAtan2Difference, AngleFormula::kAtan2Difference);
    run_adaptive();
  }

 private:
  Answer& answer(Method method) { return row_.answers[static_cast<std::size_t>(method)]; }

  [[nodiscard]] FormFactor exact(const ExactOptions& options = {}) const {
    return exact_form_factor(case_.scene, case_.receiver, source_, options);
  }

  void run_exact() {
    const FormFactor result = exact();
    row_.status = result.status;
    row_.precision_bits = result.precision_bits;
    row_.edges = result.planes.front().edges;
    region_is_whole_ = result.planes.front().outcome == Outcome::kUnoccluded;
    const std::vector<FaceId> none;
    unoccluded_ = exact({.digits = kTruthDigits, .only_occluders = &none}).enclosure;
    row_.tolerance = kToleranceShare * unoccluded_.upper();
    row_.truth = case_.truth ? case_.truth->value() : exact({.digits = kTruthDigits}).enclosure;
    // A ball of radius 0 about 0 is a proved zero.
    zero_ = row_.truth.lower() == 0.0 && row_.truth.upper() == 0.0;
    row_.agrees = row_.truth.nearest() == result.value && row_.truth.overlaps(result.enclosure) &&
                  (result.status == Status::kZero) == zero_;
    record(Method::kExact, result.value, median_seconds([&] { (void)exact(); }));
  }

  void record(Method method, double value, double seconds) {
    const double error = relative_difference(value, row_.truth, zero_ ? unoccluded_ : row_.truth);
    const double number = std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value;  // avoids -nan
    answer(method) = {.refused = false, .value = number, .error = error, .seconds = seconds};
  }

  [[nodiscard]] std::vector<Polygon> region() const {
    std::vector<Polygon> polygons;
    for (PlaneDrawing& plane : draw_visibility(case_.scene, case_.receiver, source_)) {
      for (Loop& loop : region_is_whole_ ? plane.clipped_source : plane.visible) polygons.push_back(loop.corners);
    }
    return polygons;
  }

  void run_formula(Method method, AngleFormula formula) {
    if (polygons_.empty()) polygons_ = region();
    const auto compute = [&] {
      return form_factor_in_double(polygons_, case_.receiver.point, case_.receiver.normal, formula);
    };
    constexpr int kCalls = 32;  // a single call is shorter than the resolution of the clock
    const double value = compute();
    const double seconds = median_seconds([&] {
      volatile double kept = 0.0;
      for (int i = 0; i < kCalls; ++i) kept = kept + compute();
    });
    record(method, value, seconds / kCalls);
  }

  void run_adaptive() {
    try {
      const AdaptiveSolver solver(case_.scene);
      const AdaptiveSource source = solver.prepare(source_.selection());
      AdaptiveOptions options;
      options.eps_b = row_.tolerance;
      options.rays = kRays;
      for (const auto& [method, variant] :
           {std::pair{Method::kAdaptive, Variant::kMended}, {Method::kAdaptiveLiteral, Variant::kLiteral}}) {
        options.variant = variant;
        const auto compute = [&] { return solver.form_factor(case_.receiver, source, 1.0, options).form_factor; };
        const double value = compute();
        record(method, value, median_seconds([&] { (void)compute(); }));
      }
    } catch (const InputError&) {
      for (Method method : {Method::kAdaptive, Method::kAdaptiveLiteral}) {
        answer(method) = {.refused = true, .value = 0.0, .error = kInfinity, .seconds = 0.0};
      }
    }
  }

  const Case& case_;
  Row& row_;
  ExactSource source_;
  Enclosure unoccluded_;
  bool zero_ = false;
  bool region_is_whole_ = false;
  std::vector<Polygon> polygons_;
};

[[noreturn]] void refuse_family(const std::string& name) {
  std::vector<std::string> names;
  for (const Family& family : all_families()) names.emplace_back(family.info.name);
  text::refuse("there is no family '" + name + "'", {},
               "exactff stress --list prints them all: " + text::enumerate(names));
}

const Family& family_named(const std::string& name) {
  for (const Family& family : all_families()) {
    if (family.info.name == name) return family;
  }
  refuse_family(name);
}

std::vector<const Family*> select_families(const std::vector<std::string>& names) {
  std::vector<const Family*> list;
  if (names.empty()) {
    for (const Family& family : all_families()) list.push_back(&family);
  }
  for (const std::string& name : names) {
    const Family* family = &family_named(name);
    if (std::find(list.begin(), list.end(), family) == list.end()) list.push_back(family);
  }
  return list;
}

void keep_finished(std::span<const std::atomic<std::size_t>> rows, Report& report) {
  std::vector<FamilyResult> kept;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    FamilyResult& family = report.families[i];
    if (rows[i] == family.rows.size()) {
      kept.push_back(std::move(family));
    } else {
      report.unfinished.emplace_back(family.family.name);
    }
  }
  if (kept.empty()) throw Cancelled();
  report.families = std::move(kept);
}

// --- judgement ---

struct MethodNames {
  std::string_view name, short_name;
};
// Indexed by Method.
constexpr std::array<MethodNames, kMethodCount> kMethodNames = {
    {{"exact", "exact"},
     {"Eq. (4) in double on the exact region, acos", "acos"},
     {"Eq. (4) in double on the exact region, atan2", "atan2"},
     {"Eq. (4) in double on the exact region, atan2 with a × (b − a)", "atan2-difference"},
     {"Tampieri's algorithm as mended", "tampieri"},
     {"Tampieri's algorithm as printed", "tampieri-literal"}}};

// The largest stiffness such that all rows up to it are good; 0 if the first one is not.
template <class IsGood>
double good_up_to(const FamilyResult& result, const IsGood& is_good) {
  const auto bad = std::ranges::find_if_not(result.rows, is_good);
  return bad == result.rows.begin() ? 0.0 : std::prev(bad)->stiffness;
}

std::string words_of(const FamilyResult& result, double reach) {
  return !result.rows.empty() && reach == result.rows.back().stiffness ? "all" : stiffness_text(reach);
}

// Whether the method refuses the scene after the last one at which it is good enough.
bool next_is_refused(const FamilyResult& result, Method method, double reach) {
  for (const Row& row : result.rows) {
    if (row.stiffness > reach) return row.of(method).refused;
  }
  return false;
}

}  // namespace

Report run(Request request, const Hooks& hooks) {
  if (request.threads <= 0) request.threads = files::usable_threads();
  Report report{std::move(request), {}, {}};
  struct ScenePlace {
    const Family* family;
    std::size_t result, row;
  };
  std::vector<ScenePlace> places;
  for (const Family* family : select_families(report.request.families)) {
    const std::size_t count = family->stiffnesses.size();
    for (std::size_t row = 0; row < count; ++row) places.push_back({family, report.families.size(), row});
    report.families.push_back({family->info, std::vector<Row>(count)});
  }
  std::vector<std::atomic<std::size_t>> finished(report.families.size());  // rows
  try {
    files::parallel_for(places.size(), report.request.threads, "stiff scenes", hooks, [&](std::size_t i) {
      const ScenePlace& place = places[i];
      const Case scene_case = place.family->make(place.family->stiffnesses[place.row]);
      Trial(scene_case, report.families[place.result].rows[place.row]).run();
      ++finished[place.result];
    });
  } catch (const Cancelled&) {
    keep_finished(finished, report);
  }
  return report;
}

std::string_view to_string(Evidence evidence) {
  constexpr std::array<std::string_view, 3> kNames = {"closed form", "symmetry", "certified enclosure"};
  return kNames[static_cast<std::size_t>(evidence)];
}

std::string_view name_of(Method method) { return kMethodNames[static_cast<std::size_t>(method)].name; }
std::string_view short_name_of(Method method) { return kMethodNames[static_cast<std::size_t>(method)].short_name; }

const std::vector<FamilyInfo>& families() {
  static const std::vector<FamilyInfo> list = [] {
    std::vector<FamilyInfo> infos;
    for (const Family& family : all_families()) infos.push_back(family.info);
    return infos;
  }();
  return list;
}

double usable_up_to(const FamilyResult& result, Method method, double threshold) {
  return good_up_to(result, [&](const Row& row) { return row.of(method).error < threshold; });  // not NaN
}

bool has_tolerance(Method method) { return method == Method::kAdaptive || method == Method::kAdaptiveLiteral; }

double kept_up_to(const FamilyResult& result, Method method) {
  return good_up_to(result, [&](const Row& row) {
    const Answer& answer = row.of(method);
    const double error = std::abs(answer.value - row.truth.nearest().value_or(row.truth.lower()));
    return !answer.refused && error <= row.tolerance;  // not NaN
  });
}

bool Report::sound() const {
  return std::all_of(families.begin(), families.end(), [](const FamilyResult& family) {
    return std::all_of(family.rows.begin(), family.rows.end(),
                       [](const Row& row) { return row.agrees && row.status != Status::kNotCertified; });
  });
}

std::string stiffness_text(double stiffness) {
  if (stiffness == 0.0) return "–";
  constexpr double kSmallEnoughToWrite = 1e4;
  if (stiffness < kSmallEnoughToWrite) return text::shortest(stiffness);
  int exponent = 0;
  if (std::frexp(stiffness, &exponent) == 0.5) return "2" + text::superscript(exponent - 1);
  const int decade = static_cast<int>(std::lround(std::log10(stiffness)));
  if (std::stod("1e" + std::to_string(decade)) == stiffness) return "10" + text::superscript(decade);
  return text::rounded(stiffness);
}

std::string error_text(const Answer& answer) {
  if (answer.refused) return "refused";
  if (std::isnan(answer.error)) return "no number";
  return answer.error == 0.0 ? "0" : text::rounded(answer.error, 2);
}

std::string reach_text(const FamilyResult& result, Method method, double threshold) {
  return words_of(result, usable_up_to(result, method, threshold));
}

std::string reaches_text(const FamilyResult& result, Method method) {
  std::string text;
  double reach = kept_up_to(result, method);
  if (has_tolerance(method)) {
    text = words_of(result, reach);
  } else {
    reach = usable_up_to(result, method, kThresholds.front());
    for (const double threshold : kThresholds)
      text += (text.empty() ? "" : " · ") + reach_text(result, method, threshold);
    if (text == "all · all · all") return "all";
  }
  return next_is_refused(result, method, reach) ? text + " (refused)" : text;
}

}  // namespace exactff::stress
