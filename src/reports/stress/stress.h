// Stress tests: families of scenes that become more and more extreme, to find how far each way of computing a form
// factor stays accurate.
//
// A family has one parameter, its stiffness: a growing pure number, such as 1 over a distance, a width or an angle, or
// a count. At each stiffness the true form factor is known from a closed form, from a symmetry, or otherwise from the
// exact method's enclosure. Every method is compared with it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/enclosure.h"
#include "exactff/exact.h"
#include "exactff/jobs.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "exactff/table.h"

namespace exactff::stress {

// The source of the true value.
enum class Evidence {
  kClosedForm,  // the catalogue's formulas for rectangles, evaluated in balls, independently of everything else
  kSymmetry,    // a closed form, and an exact symmetry of the scene
  kCertified,   // the exact method's own enclosure
};
[[nodiscard]] std::string_view to_string(Evidence evidence);

// A scene with its receiver and source, and what is known about the result.
struct Case {
  double stiffness = 1.0;
  Scene scene;
  Receiver receiver;
  std::optional<Enclosure> truth;  // none: compared with the exact method's own enclosure
};

// A list of stiffnesses, and a function that makes the scene for one of them: one receiver, one patch `source`, one
// patch `occluder`.
struct Family {
  std::string_view name;  // the name for --family
  std::string_view title;
  std::string_view stiffness;       // the meaning of the number
  std::string_view about;           // what happens as it grows, and why that is hard
  std::vector<double> stiffnesses;  // ascending
  Case (*make)(double stiffness);
  Evidence evidence = Evidence::kClosedForm;
};
[[nodiscard]] const std::vector<Family>& all_families();  // in the order of the report

enum class Method {
  kExact,
  kAcos,             // Eq. (4) in double over the exact visible region with rounded corners: angles by acos
  kAtan2,            // the same, angles by atan2(|a x b|, a . b)
  kAtan2Difference,  // the same, angles by atan2 with a x (b - a)
  kAdaptive,         // Tampieri's algorithm, mended variant (adaptive.h)
  kAdaptiveLiteral,  // Tampieri's algorithm, literal variant: as printed
};
inline constexpr std::size_t kMethodCount = 6;
inline constexpr std::array<Method, kMethodCount> kMethods = {Method::kExact,    Method::kAcos,
                                                              Method::kAtan2,    Method::kAtan2Difference,
                                                              Method::kAdaptive, Method::kAdaptiveLiteral};
[[nodiscard]] std::string_view name_of(Method method);
[[nodiscard]] std::string_view short_name_of(Method method);

// Upper bound, with a margin, of the relative width of the truth.
inline constexpr double kTruthIsGoodTo = 1e-35;

// One method on one scene.
struct Answer {
  bool refused = false;  // the method does not accept the scene
  double value = 0.0;    // an estimate of F; for kExact it is correctly rounded
  // |value - F| / F; if F is 0, |value| over the unoccluded form factor. Set to 0 if below kTruthIsGoodTo. NaN if the
  // value is NaN, infinite if the method refused the scene.
  double error = 0.0;
};

struct Row {
  double stiffness = 1.0;
  Enclosure truth;
  Status status = Status::kZero;  // status of the exact method
  int precision_bits = 0;         // precision that the certified value needed
  double exact_seconds = 0.0;     // of the exact method, without preprocessing: median of several calls
  std::uint64_t occluders = 0;    // faces besides the source
  std::uint64_t edges = 0;        // of the visible region's boundary
  bool agrees = false;            // the exact value is the truth, rounded
  double tolerance = 0.0;         // eps_B of Tampieri's algorithm: kToleranceShare of the unoccluded form factor
  std::array<Answer, kMethodCount> answers;

  [[nodiscard]] const Answer& of(Method method) const { return answers[static_cast<std::size_t>(method)]; }
};

struct FamilyResult {
  const Family* family = nullptr;
  std::vector<Row> rows;  // in order of increasing stiffness
};

// The settings of Tampieri's algorithm: a tolerance eps_B of this share of the unoccluded form factor, this many
// jittered rays per undecided leaf, and seed 1.
inline constexpr double kToleranceShare = 1e-4;
inline constexpr int kRays = 64;

// A method counts as usable while its error is below the threshold.
inline constexpr std::array<double, 3> kThresholds = {1e-3, 1e-6, 1e-12};

// The largest stiffness such that the error stays below the threshold from the first row up to it; 0 if that fails in
// the first row.
[[nodiscard]] double usable_up_to(const FamilyResult& result, Method method, double threshold);

// Whether a method is given a tolerance, and is therefore judged by it and not by the thresholds.
[[nodiscard]] bool has_tolerance(Method method);
// The largest stiffness such that |value - F| <= tolerance from the first row up to it; 0 if that fails in the first
// row.
[[nodiscard]] double kept_up_to(const FamilyResult& result, Method method);

struct Request {
  std::vector<std::string> families;  // empty: all
  int threads = 0;                    // 0: as many as this process may use
};

struct Report {
  std::vector<FamilyResult> families;
  std::size_t unfinished = 0;  // families that the hooks cut off; they are not among the others

  // True if every exact value is the truth, rounded, and none has the status kNotCertified.
  [[nodiscard]] bool sound() const;
};

// Runs the families. Everything except the times depends on the request alone. If the hooks cancel, the result holds
// the families that are finished. Throws Cancelled if there are none, and InputError if there is no family of a given
// name.
[[nodiscard]] Report run(const Request& request, const Hooks& hooks = {});

// A row for each family and stiffness, with the values and errors of all methods. No byte depends on a clock.
[[nodiscard]] table::Table table_of(const Report& report);

// The main result in a few sentences.
[[nodiscard]] std::vector<std::string> headlines(const Report& report);

// Powers from 10000 on as "10³⁰⁰" and "2⁵²", smaller numbers as "4096", 0 as "–".
[[nodiscard]] std::string stiffness_text(double stiffness);

// "3.4·10⁻¹⁷", "refused", "no number".
[[nodiscard]] std::string error_text(const Answer& answer);

// Up to which stiffness a method keeps its error below a threshold: "all" if to the family's end, otherwise the last
// such stiffness, or "–".
[[nodiscard]] std::string reach_text(const FamilyResult& result, Method method, double threshold);

// The same for every threshold: "10⁸ · 10⁵ · 100", or "all". Of a method with a tolerance: up to which stiffness it
// keeps it. Adds "(refused)" if the method then refuses the scene.
[[nodiscard]] std::string reaches_text(const FamilyResult& result, Method method);

}  // namespace exactff::stress
