// A study: the ray-sampled adaptive algorithm judged by the exact form factor, over many receivers and a
// sweep of settings, with its tables and its report.
//
// Errors are approximate minus exact. The error in F is a pure number; the error in radiosity is, over the
// colour channels c, the rho_c * sum over sources of B_c (F~ - F) of largest magnitude, with its sign. eps_B
// is judged on the radiosity error, summed over the sources.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff::study {

// The values that each parameter of the adaptive algorithm takes. An empty list stands for the default.
struct Sweeps {
  std::vector<double> eps_b = {};            // default: max(rho B) times 10^-1 .. 10^-5
  std::vector<double> eps_a = {};            // default: 0 and the sources' mean face area times 10^-1 .. 10^-4
  std::vector<int> rays = {};                // default: 1, 4, 16, 64, 256
  std::vector<std::uint64_t> seeds = {};     // default: 1 .. 10
  std::vector<SamplePattern> patterns = {};  // default: jittered, then the other three
  std::vector<Variant> variants = {};        // default: mended, then literal
};

// Every combination of the lists where there are at most this many; else the plane eps_B x rays, and every
// other list on its own around the base.
inline constexpr std::size_t kFullProductLimit = 40;

enum class Parameter { kEpsB, kEpsA, kRays, kSeed, kPattern, kVariant };
inline constexpr std::size_t kParameterCount = 6;

[[nodiscard]] std::string_view name_of(SamplePattern pattern);
[[nodiscard]] std::string_view name_of(Variant variant);
[[nodiscard]] std::optional<SamplePattern> pattern_named(std::string_view name);
[[nodiscard]] std::optional<Variant> variant_named(std::string_view name);

// What is compared. Refers to the scene.
struct Request {
  const Scene* scene = nullptr;
  std::string scene_name;  // for titles and headers
  std::vector<Receiver> receivers;
  std::string receivers_name;      // "floor, grid 32x32", or the name of a file
  std::vector<Selection> sources;  // empty: every patch that emits
  Sweeps sweeps;
  Engine engine = Engine::kEdges;
  int threads = 0;           // 0: as many as the machine has
  std::string command_line;  // for the report's last section
};

// How much of the source a receiver sees, decided exactly.
enum class Sight { kNothing, kHidden, kPartly, kVisible };  // kNothing: behind it or below the horizon
[[nodiscard]] std::string_view name_of(Sight sight);

// One receiver and one source.
struct ExactTerm {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  Status status = Status::kZero;
  Sight sight = Sight::kNothing;
};

// One receiver and all sources.
struct ExactRow {
  std::vector<ExactTerm> terms;  // in the order of the sources
  double form_factor = 0.0;      // their sum, added as balls and rounded once
  Rgb radiosity;                 // rho * sum of B_s F_s
  Sight sight = Sight::kNothing;
  bool certified = true;
  double seconds = 0.0;
};

// One receiver and one setting, summed over the sources.
struct SampleRow {
  double form_factor = 0.0;
  double error = 0.0;
  double radiosity_error = 0.0;
  std::uint64_t leaves = 0;
  std::uint64_t rays = 0;
  std::uint64_t shaft_tests = 0;
  std::array<std::uint64_t, kLeafReasonCount> leaves_by_reason{};
  std::uint64_t silent_leaves = 0;  // sampled V = 0 or 1 while part of the leaf is visible and part is not
  std::uint64_t wrong_leaves = 0;   // sampled V = 0 while all is visible, or V = 1 while nothing is
  double seconds = 0.0;
};

// Over the receivers of one setting. p99 is the nearest-rank percentile of |error|: the smallest magnitude
// that at least 99 % of the receivers do not exceed. Errors that are no numbers are counted apart.
struct ErrorStatistics {
  double rms = 0.0;
  double mean = 0.0;  // signed
  double p99 = 0.0;
  double worst = 0.0;
  std::size_t not_a_number = 0;
};

struct Summary {
  ErrorStatistics form_factor;
  ErrorStatistics radiosity;
  ErrorStatistics radiosity_partly;  // over the receivers that see the source partly
  std::size_t violations = 0;        // receivers with |radiosity error| > eps_B, or no number
  std::uint64_t leaves = 0;
  std::uint64_t rays = 0;
  std::uint64_t silent_leaves = 0;
  std::uint64_t wrong_leaves = 0;
};

// Seconds per receiver. `partly`: over the receivers that see the source partly, if any.
struct TimeSummary {
  double median = 0.0;
  double mean = 0.0;
  double median_partly = 0.0;
  double mean_partly = 0.0;
};

// What the scene gave no work to.
struct LeftOut {
  std::string what;
  std::string why;
};

struct Study {
  Request request;  // sources, sweeps and threads filled in
  double largest_rho_b = 0.0;
  std::vector<AdaptiveOptions> settings;
  std::size_t base = 0;  // into settings: where sweeps cross
  bool full_product = false;
  std::vector<ExactRow> exact;                  // by receiver
  std::vector<std::vector<SampleRow>> samples;  // by setting, then receiver
  std::vector<Summary> summaries;               // by setting
  TimeSummary exact_time;
  std::vector<TimeSummary> times;  // by setting
  std::array<std::size_t, 4> receivers_by_sight{};
  std::vector<LeftOut> left_out;
  double exact_setup_seconds = 0.0;  // once per source
  double ray_setup_seconds = 0.0;    // once per scene
};

// How far the work is; called from one thread at a time.
struct Progress {
  std::string_view stage;
  std::size_t done = 0;
  std::size_t total = 0;
};

struct Hooks {
  std::function<void(const Progress&)> progress;
  std::function<bool()> cancelled;  // asked between receivers, from any thread
};

// The work was given up because Hooks::cancelled said so.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

// Computes everything. All but the times depends on the request alone, never on the number of threads. Times
// are wall times of single calls by a steady clock, after a first call with the same arguments.
// Throws InputError where there is no receiver or no source, and where the sampled methods refuse the scene.
[[nodiscard]] Study run(Request request, const Hooks& hooks = {});

// Throws InputError unless `folder` can be written and replaced: it does not exist, is empty, or holds
// nothing but files of an earlier study.
void check_output_folder(const std::filesystem::path& folder);

// Writes the tables and the report into a hidden sibling of `folder` and renames that at the end. Value files
// (values, exact, summary) hold no times and are the same bytes for any number of threads. Returns
// what is worth telling, such as a missing gnuplot.
std::vector<std::string> write(const Study& study, const std::filesystem::path& folder, const Hooks& hooks = {});

// The main result in a few sentences.
[[nodiscard]] std::vector<std::string> headlines(const Study& study);

}  // namespace exactff::study
