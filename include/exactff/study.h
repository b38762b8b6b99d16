// A study of one scene: approximate methods judged by the exact form factor, over many receivers. Tampieri's
// ray-sampled adaptive algorithm is swept over all its parameters at every receiver; all methods are run against one
// another, with rising effort and many seeds, at a choice of the receivers. With its tables and its report.
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
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"
#include "exactff/methods.h"
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

// A method with rising effort: its rungs differ in one setting.
struct Ladder {
  std::string name;                    // "area sampling, stratified"
  std::string along;                   // the setting that differs; empty where there is one rung only
  std::vector<methods::Choice> rungs;  // by rising effort
};

// "area-sampling:pattern=stratified,samples=4|16|64": a method's text as methods::parse takes it, where one setting may
// have several values. Throws InputError.
[[nodiscard]] Ladder parse_ladder(std::string_view text);

// How the methods are run against one another.
struct MethodSweep {
  bool enabled = true;
  std::vector<Ladder> ladders = {};  // default: every method of the library
  std::size_t seeds = 30;            // 1 .. seeds, of stochastic methods
  std::size_t receivers = 48;        // at most, chosen evenly among those that see something
  double budget = 2.0;  // seconds for a ladder by its counted work, on no machine in particular; see MethodStudy
};

// What is compared. Refers to the scene.
struct Request {
  const Scene* scene = nullptr;
  std::string scene_name;  // for titles and headers
  std::vector<Receiver> receivers;
  std::string receivers_name;      // "floor, grid 32x32", or the name of a file
  std::vector<Selection> sources;  // empty: every patch that emits
  Sweeps sweeps;
  MethodSweep methods;
  Engine engine = Engine::kEdges;
  int threads = 0;                  // 0: as many as this process may use; times are measured on one, alone
  std::string command_line;         // for the report's last section
  double sweep_budget = 15.0;       // seconds for all settings of the adaptive algorithm, as MethodSweep::budget
  double seconds_for_a_time = 0.1;  // spent on the times of one setting, about
};

inline constexpr double kNotTimed = std::numeric_limits<double>::quiet_NaN();

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
  double visible_fraction = 0.0;  // NaN in scenes of more than kMostFacesForFractions faces
};
inline constexpr std::size_t kMostFacesForFractions = 5000;  // beyond, an exact fraction takes long

// One receiver and all sources.
struct ExactRow {
  std::vector<ExactTerm> terms;  // in the order of the sources
  double form_factor = 0.0;      // their sum, added as balls and rounded once
  Rgb radiosity;                 // rho * sum of B_s F_s
  Sight sight = Sight::kNothing;
  bool certified = true;
  bool sampled = false;           // nothing but rays can tell the adaptive algorithm what is seen
  double visible_fraction = 0.0;  // mean over the sources, weighted by their areas
  double seconds = kNotTimed;
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
  double silent_error = 0.0;        // what silent and wrong leaves add to the form factor beyond what they should
  double seconds = kNotTimed;
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
  std::size_t silent_receivers = 0;  // those with a silent or wrong leaf
  ErrorStatistics silent;            // of SampleRow::silent_error, over the judged receivers
};

// Seconds per receiver. `partly`: over the receivers that see the source partly, if any.
struct TimeSummary {
  double median = 0.0;
  double mean = 0.0;
  double median_partly = 0.0;
  double mean_partly = 0.0;
};

// One rung of a ladder at the chosen receivers.
struct MethodCell {
  std::size_t ladder = 0;
  std::size_t rung = 0;
  std::vector<std::uint64_t> seeds;                   // one, 0, where the method draws nothing at random
  std::vector<std::vector<double>> values;            // F by seed, then chosen receiver
  std::vector<std::vector<double>> radiosity_errors;  // the same
  ErrorStatistics error;                              // of the radiosity, over seeds and receivers
  ErrorStatistics error_partly;                       // where the source is partly hidden
  ErrorStatistics error_visible;                      // where it is wholly visible
  double work = 0.0;  // samples or pixels, else leaves and rays, of a receiver in the mean
  // Per receiver and all sources, by the median over repetitions and then the mean over receivers; NaN if not timed.
  double seconds = kNotTimed;
  double seconds_partly = kNotTimed;
};

// error = c * work^exponent, fitted over the rungs for each seed; the mean over the seeds with its 95 % confidence
// interval by Student's t, which a single seed has not.
struct Slope {
  double exponent = 0.0;
  double low = 0.0;
  double high = 0.0;
  std::size_t seeds = 0;
  std::size_t rungs = 0;
};

struct LadderSlopes {
  std::optional<Slope> partly;   // over the receivers that see the source partly
  std::optional<Slope> visible;  // over those that see all of it
};

// The middle rung of a ladder at every receiver, with its first seed.
struct MethodField {
  std::size_t ladder = 0;
  std::size_t rung = 0;
  std::vector<double> radiosity_errors;
};

// A ladder ends before the rung that would take its counted work (rays, pixels, ...), at a fixed price for each, over
// the budget: what is run depends on the request alone, never on a clock.
struct MethodStudy {
  std::vector<Ladder> ladders;
  std::vector<std::size_t> receivers;  // chosen: indices into Study::exact, ascending
  std::vector<MethodCell> cells;       // by ladder, then rung
  std::vector<LadderSlopes> slopes;    // by ladder
  std::vector<MethodField> fields;     // of those ladders whose middle rung was run
  std::vector<double> setup_seconds;   // by ladder: once per scene and source
};

// The exact radiosity along the line of receivers where most see the source partly, with what others make of it.
struct Profile {
  std::string where;                // "row 12 of floor"
  std::vector<Receiver> receivers;  // in order
  std::vector<double> position;     // of each, distance from the first, in the scene's unit
  std::vector<double> exact;        // radiosity, largest channel
  std::vector<double> kinks;        // positions where what is visible changes in kind, to 2^-20 of the length
  struct Curve {
    std::string name;
    std::vector<double> radiosity;
  };
  std::vector<Curve> others;
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
  std::vector<std::size_t> timed;  // the receivers whose times were measured
  // The receivers whose leaves were held against the exact visible region, ascending: all, or a choice in large scenes,
  // where drawing that region takes long. Only these have silent and wrong leaves.
  std::vector<std::size_t> judged;
  MethodStudy methods;
  // By receiver: its distance to the nearest place on its face where what is visible changes in kind, to three quarters
  // of `edge_resolution`; empty where the receivers are no grid.
  std::vector<double> edge_distance;
  double edge_resolution = 0.0;
  std::optional<Profile> profile;
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

// Finished work in a file beside the result, so that what was interrupted can go on where it was. Pieces of work have
// names; what is damaged in the file counts as not done. From any thread.
class Journal {
 public:
  enum class Existing { kRefuse, kResume, kReplace };  // where there is one already

  // Throws InputError where the file cannot be written, another process is at it, or it is only to be refused.
  Journal(const std::filesystem::path& file, Existing existing);
  ~Journal();  // a journal with nothing in it is removed
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  [[nodiscard]] std::optional<std::string> find(const std::string& name) const;
  void add(const std::string& name, std::string_view bytes);
  [[nodiscard]] std::size_t size() const;  // pieces of work
  [[nodiscard]] const std::filesystem::path& path() const;
  void remove();  // all is done

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// Where the journal of a folder of results is: beside it.
[[nodiscard]] std::filesystem::path journal_of_folder(const std::filesystem::path& folder);

// The work was given up because Hooks::cancelled said so.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

// Computes everything. All but the times depends on the request alone, never on the number of threads. Times are
// measured afterwards, one thread at work and nothing else: the median of three calls by a steady clock, after a first
// call with the same arguments. Values that `journal` has are taken from it, and those found are kept there. Throws
// InputError where there is no receiver or no source, and where the sampled methods refuse the scene.
[[nodiscard]] Study run(Request request, const Hooks& hooks = {}, Journal* journal = nullptr);

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
