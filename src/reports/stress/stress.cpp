// Runs every family at every stiffness with every method.
//
//   1. Make the scene and its true value.
//   2. Run the exact method. Its value must be what the true value rounds to.
//   3. Take the exact visible region with its corners rounded to doubles, and evaluate Eq. (4) over it in three ways.
//   4. Run Tampieri's algorithm, mended and literal. Its tolerance eps_B is a ten-thousandth of the unoccluded form
//      factor: the choice of a user who knows roughly what to expect.
//   5. Measure the time of the exact method: the median of several calls.
// The place of a scene in the report is its index, so that nothing but that time depends on the number of threads.
#include "stress/stress.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "exactff/adaptive.h"
#include "files/parallel.h"
#include "files/stopwatch.h"
#include "kernel/ball.h"
#include "kernel/vec.h"
#include "table/rows.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::stress {

using kernel::cross;
using kernel::dot;
using kernel::length;

namespace {

// --- Eq. (4) in double ---

// Eq. (4) of F. Tampieri (1992) in plain double, in the three forms that programs use: the results of careful and of
// careless code. Each estimates the form factor of a region from its boundary.

enum class AngleFormula {
  kAcos,             // unit vectors a and b, acos(a . b), a x b
  kAtan2,            // atan2(|a x b|, a . b)
  kAtan2Difference,  // the same, but a x b is computed as a x (b - a)
};

// A closed polygon, counter-clockwise seen from the front of the source; holes are clockwise.
using Polygon = std::vector<Vec3>;

Vec3 unit(const Vec3& a) {
  const double r = length(a);
  return {a.x / r, a.y / r, a.z / r};
}

double term_by_acos(const Vec3& a, const Vec3& b, const Vec3& n) {
  const Vec3 p = unit(a), q = unit(b);
  const Vec3 c = cross(p, q);
  const double sine = length(c);
  return sine == 0.0 ? 0.0 : std::acos(std::clamp(dot(p, q), -1.0, 1.0)) * dot(n, c) / sine;
}

double term_by_atan2(const Vec3& a, const Vec3& b, const Vec3& a_cross_b, const Vec3& n) {
  const double sine = length(a_cross_b);
  return sine == 0.0 ? 0.0 : std::atan2(sine, dot(a, b)) * dot(n, a_cross_b) / sine;
}

double term(const Vec3& a, const Vec3& b, const Vec3& n, AngleFormula formula) {
  switch (formula) {
    case AngleFormula::kAcos:
      return term_by_acos(a, b, n);
    case AngleFormula::kAtan2:
      return term_by_atan2(a, b, cross(a, b), n);
    case AngleFormula::kAtan2Difference:
      break;
  }
  return term_by_atan2(a, b, cross(a, kernel::difference(b, a)), n);
}

// -1/(2 pi |n|) times the sum over the edges of angle n . (a x b) / |a x b|, with a and b relative to x. Nothing is
// clamped, but the angle of two unit vectors is 0 or pi if their product rounds beyond 1. An edge with a x b = 0 adds
// nothing.
double form_factor_in_double(std::span<const Polygon> region, const Vec3& x, const Vec3& normal, AngleFormula formula) {
  const Vec3 n = unit(normal);
  double sum = 0.0;
  for (const Polygon& polygon : region) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      sum +=
          term(kernel::difference(polygon[i], x), kernel::difference(polygon[(i + 1) % polygon.size()], x), n, formula);
    }
  }
  return -0.5 * std::numbers::inv_pi * sum;
}

// --- trials ---

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
    row_.truth = case_.truth ? *case_.truth : exact({.digits = kTruthDigits}).enclosure;
    // A ball of radius 0 about 0 is a proved zero.
    zero_ = row_.truth.lower() == 0.0 && row_.truth.upper() == 0.0;
    row_.agrees = row_.truth.nearest() == result.value && row_.truth.overlaps(result.enclosure) &&
                  (result.status == Status::kZero) == zero_;
    record(Method::kExact, result.value);
    constexpr std::size_t kMostCalls = 7;
    constexpr double kLimit = 0.05;  // seconds of all calls
    row_.exact_seconds = files::median_seconds([&] { (void)exact(); }, kMostCalls, kLimit);
  }

  void record(Method method, double value) {
    const double error = relative_difference(value, row_.truth, zero_ ? unoccluded_ : row_.truth);
    const double number = std::isnan(value) ? std::numeric_limits<double>::quiet_NaN() : value;  // avoids -nan
    answer(method) = {.refused = false, .value = number, .error = error};
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
    record(method, form_factor_in_double(polygons_, case_.receiver.point, case_.receiver.normal, formula));
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
        record(method, solver.form_factor(case_.receiver, source, 1.0, options).form_factor);
      }
    } catch (const InputError&) {
      for (Method method : {Method::kAdaptive, Method::kAdaptiveLiteral}) {
        answer(method) = {.refused = true, .value = 0.0, .error = kInfinity};
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
  for (const Family& family : all_families()) names.emplace_back(family.name);
  text::refuse("there is no family '" + name + "'", {},
               "exactff stress --list prints them all: " + text::enumerate(names));
}

const Family& family_named(const std::string& name) {
  for (const Family& family : all_families()) {
    if (family.name == name) return family;
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
      ++report.unfinished;
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

Report run(const Request& request, const Hooks& hooks) {
  const int threads = request.threads > 0 ? request.threads : files::usable_threads();
  Report report;
  struct ScenePlace {
    const Family* family;
    std::size_t result, row;
  };
  std::vector<ScenePlace> places;
  for (const Family* family : select_families(request.families)) {
    const std::size_t count = family->stiffnesses.size();
    for (std::size_t row = 0; row < count; ++row) places.push_back({family, report.families.size(), row});
    report.families.push_back({family, std::vector<Row>(count)});
  }
  std::vector<std::atomic<std::size_t>> finished(report.families.size());  // rows
  try {
    files::parallel_for(places.size(), threads, "stiff scenes", hooks, [&](std::size_t i) {
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

// --- what was found ---

namespace {

constexpr int kPrintedDigits = 30;
constexpr std::optional<double> kNone;

}  // namespace

table::Table table_of(const Report& report) {
  table::Head head;
  head.set("about", std::string("every family, stiffness and method"));
  head.set("error",
           std::string("|value - truth| / truth; where the truth is 0, |value| over the unoccluded form factor; "
                       "0 below truth_is_good_to; no value where the method refuses the scene"));
  head.set("truth_is_good_to", kTruthIsGoodTo);
  head.set("tampieri", "eps_B " + text::shortest(kToleranceShare) + " of the unoccluded form factor, " +
                           std::to_string(kRays) + " jittered rays, seed 1");
  table::Columns answers;
  for (const Method method : kMethods) {
    const auto strength = method == Method::kExact ? table::Strength::kCertified : table::Strength::kEstimated;
    const std::string name(short_name_of(method));
    answers.push_back({name + "_value", table::Type::kNumber, "", strength});
    answers.push_back({name + "_error", table::Type::kNumber, "", table::Strength::kEstimated});
  }
  table::Rows rows(
      "stress values", std::move(head),
      {table::keys("family"), table::keys("stiffness", table::Type::kNumber), table::texts("truth,evidence"),
       table::flags("agrees"), table::texts("status", table::Strength::kProved),
       table::counts("precision_bits,occluders,edges"), answers, table::texts("refused_by")});
  for (const FamilyResult& family : report.families) {
    for (const Row& r : family.rows) {
      rows << family.family->name << r.stiffness << r.truth.decimals(kPrintedDigits).value_or(r.truth.midpoint())
           << to_string(family.family->evidence) << r.agrees << exactff::to_string(r.status) << r.precision_bits
           << r.occluders << r.edges;
      std::string refused_by;
      for (const Method method : kMethods) {
        const Answer& answer = r.of(method);
        if (answer.refused) {
          refused_by += (refused_by.empty() ? "" : " ") + std::string(short_name_of(method));
          rows << kNone << kNone;
        } else {
          rows << answer.value << answer.error;
        }
      }
      rows << refused_by;
    }
  }
  return rows.take();
}

namespace {

struct Tally {
  std::size_t independent = 0;  // compared with a closed form or a symmetry
  std::size_t agreeing = 0;     // of these
  std::size_t certified = 0;    // compared with the exact method's own enclosure
  int most_bits = 0;
  double smallest = std::numeric_limits<double>::infinity();  // smallest positive form factor with an independent truth
};

Tally tally(const Report& report) {
  Tally t;
  for (const FamilyResult& family : report.families) {
    const bool independent = family.family->evidence != Evidence::kCertified;
    for (const Row& row : family.rows) {
      ++(independent ? t.independent : t.certified);
      t.most_bits = std::max(t.most_bits, row.precision_bits);
      if (!independent) continue;
      t.agreeing += row.agrees ? 1U : 0U;
      const double value = row.of(Method::kExact).value;
      if (value > 0.0) t.smallest = std::min(t.smallest, value);
    }
  }
  return t;
}

std::string exact_sentence(const Report& report) {
  const Tally t = tally(report);
  std::string text;
  if (t.independent > 0) {
    text = "The exact value agrees with an independent closed form or symmetry, rounded to a double, in " +
           text::counted_of(t.agreeing, t.independent, "scene");
    if (std::isfinite(t.smallest)) text += ", down to a form factor of " + text::rounded(t.smallest, 2);
    text += t.certified > 0 ? "; " : ". ";
  }
  if (t.certified > 0) {
    text += (text.empty() ? "In " : "in ") + text::counted(t.certified, "scene") +
            " no independent value exists; there it is compared with its own enclosure at higher precision. ";
  }
  if (t.most_bits > 0) text += "The proof needed at most " + std::to_string(t.most_bits) + " bits.";
  return text;
}

bool to_the_end(const FamilyResult& family, Method method, double threshold) {
  return usable_up_to(family, method, threshold) == family.rows.back().stiffness;
}

std::size_t families_kept(const Report& report, Method method, double threshold) {
  return static_cast<std::size_t>(
      std::count_if(report.families.begin(), report.families.end(),
                    [&](const FamilyResult& family) { return to_the_end(family, method, threshold); }));
}

std::size_t refusals(const Report& report, Method method) {
  std::size_t count = 0;
  for (const FamilyResult& family : report.families) {
    count += static_cast<std::size_t>(
        std::count_if(family.rows.begin(), family.rows.end(), [&](const Row& row) { return row.of(method).refused; }));
  }
  return count;
}

std::string thresholds_kept(const Report& report, Method method) {
  return " keeps its error below 10⁻³ to the end in " + std::to_string(families_kept(report, method, kThresholds[0])) +
         " of " + text::counted(report.families.size(), "family", "families") + ", below 10⁻⁶ in " +
         std::to_string(families_kept(report, method, kThresholds[1])) + " and below 10⁻¹² in " +
         std::to_string(families_kept(report, method, kThresholds[2]));
}

std::string tolerance_kept(const Report& report, Method method) {
  const auto kept = std::count_if(report.families.begin(), report.families.end(), [&](const FamilyResult& family) {
    return kept_up_to(family, method) == family.rows.back().stiffness;
  });
  return " keeps the tolerance that it was given (" + text::rounded(kToleranceShare) +
         " of the unoccluded form factor) to the end in " + std::to_string(kept) + " of " +
         text::counted(report.families.size(), "family", "families");
}

std::string method_sentence(const Report& report, Method method) {
  std::string text = std::string(name_of(method)) +
                     (has_tolerance(method) ? tolerance_kept(report, method) : thresholds_kept(report, method));
  if (const std::size_t refused = refusals(report, method); refused > 0) {
    text += "; it refuses " + text::counted(refused, "scene") + " because single precision would merge corners";
  }
  return text + '.';
}

}  // namespace

std::vector<std::string> headlines(const Report& report) {
  std::vector<std::string> sentences = {exact_sentence(report)};
  for (Method method : kMethods) {
    if (method != Method::kExact) sentences.push_back(method_sentence(report, method));
  }
  return sentences;
}

}  // namespace exactff::stress
