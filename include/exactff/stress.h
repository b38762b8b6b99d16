// Stress: families of scenes driven from benign to extreme, and how far each way of computing a form factor follows.
//
// A family has one parameter, its stiffness, a pure number that grows: 1 over a distance, a width, an angle, or a
// count. At each stiffness the true form factor is known by a closed form, by a symmetry, or else by the exact
// method's enclosure; every method is held against it.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/enclosure.h"
#include "exactff/exact.h"
#include "exactff/study.h"

namespace exactff::stress {

// What the truth rests on.
enum class Evidence {
  kClosedForm,  // the catalogue's formulas for rectangles, evaluated in balls apart from everything else
  kSymmetry,    // a closed form and an exact symmetry of the scene
  kCertified,   // the exact method's own enclosure
};
[[nodiscard]] std::string_view to_string(Evidence evidence);

struct FamilyInfo {
  std::string_view name;  // for --family
  std::string_view title;
  std::string_view stiffness;  // what the number is
  std::string_view about;      // what happens as it grows, and why it is hard
  Evidence evidence = Evidence::kClosedForm;
};
[[nodiscard]] const std::vector<FamilyInfo>& families();

enum class Method {
  kExact,
  kAcos,             // Eq. (4) in double over the exact visible region, its corners rounded: by acos,
  kAtan2,            // by atan2(|a x b|, a . b),
  kAtan2Difference,  // by atan2 with a x (b - a)
  kAdaptive,         // Tampieri's algorithm, mended
  kAdaptiveLiteral,  // as printed
};
inline constexpr std::size_t kMethodCount = 6;
[[nodiscard]] std::string_view name_of(Method method);
[[nodiscard]] std::string_view short_name_of(Method method);

// The relative width that the truth is known to, with room to spare.
inline constexpr double kTruthIsGoodTo = 1e-35;

// One method on one scene.
struct Answer {
  bool refused = false;  // the method will not take the scene
  double value = 0.0;    // estimates F; for kExact correctly rounded
  // |value - F| / F, or |value| over the unoccluded form factor where F is 0; 0 where it is below kTruthIsGoodTo. NaN
  // where the value is no number, infinite where the method refused.
  double error = 0.0;
  double seconds = 0.0;  // median of several calls; preprocessing apart
};

struct Row {
  double stiffness = 1.0;
  Enclosure truth;
  Status status = Status::kZero;  // of the exact method
  int precision_bits = 0;         // that the certified value needed
  std::uint64_t occluders = 0;    // faces besides the source
  std::uint64_t edges = 0;        // of the visible region's boundary
  bool agrees = false;            // the exact value is what the truth rounds to
  std::array<Answer, kMethodCount> answers;

  [[nodiscard]] const Answer& of(Method method) const { return answers[static_cast<std::size_t>(method)]; }
};

struct FamilyResult {
  FamilyInfo family;
  std::vector<Row> rows;  // by rising stiffness
};

// What Tampieri's algorithm is asked for: a tolerance eps_B of this share of the unoccluded form factor, by so many
// jittered rays per undecided leaf, from seed 1.
inline constexpr double kToleranceShare = 1e-4;
inline constexpr int kRays = 64;

// Errors below which a method counts as usable.
inline constexpr std::array<double, 3> kThresholds = {1e-3, 1e-6, 1e-12};

// The largest stiffness up to which, from the first row on, the error stays below the threshold; 0 if it never does.
[[nodiscard]] double usable_up_to(const FamilyResult& result, Method method, double threshold);

struct Request {
  std::vector<std::string> families;  // empty: all
  int threads = 0;                    // 0: as many as this process may use
  std::string command_line;           // for the report's last section
};

struct Report {
  Request request;
  std::vector<FamilyResult> families;

  // Every exact value is what the truth rounds to, and none lacks its certificate.
  [[nodiscard]] bool sound() const;
};

// All but the times depends on the request alone. Throws InputError where there is no family of that name.
[[nodiscard]] Report run(Request request, const study::Hooks& hooks = {});

// Writes report.html, values.csv, summary.csv and timings.csv as study::write does: whole or not at all, over an
// earlier result only. Returns what is worth telling, such as a missing gnuplot.
std::vector<std::string> write(const Report& report, const std::filesystem::path& folder,
                               const study::Hooks& hooks = {});

// The main result in a few sentences.
[[nodiscard]] std::vector<std::string> headlines(const Report& report);

}  // namespace exactff::stress
