// A study of one scene: approximate methods compared with the exact form factor over many receivers, with tables and a
// report. Every setting of every method is run at some of the receivers, with many seeds; these runs alone decide which
// method is the best for a wanted error. Tampieri's ray-sampled adaptive algorithm is also run at every receiver, for
// values of all its parameters, and its leaves are compared with what is really visible.
//
// Errors are approximate minus exact. The error in F is a pure number. The error in radiosity is the value of rho_c *
// sum over sources of B_c (F~ - F) that has the largest magnitude over the colour channels c, with its sign. eps_B is
// compared with the error in radiosity, summed over the sources.
//
// A setting is accurate to e if its RMS error in radiosity, over the chosen receivers and the seeds, is at most e times
// the radiosity of the brightest receiver. Its time is a multiple of the exact method's: see MethodCell.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"
#include "exactff/jobs.h"
#include "exactff/methods.h"
#include "exactff/receiver.h"
#include "exactff/render.h"
#include "exactff/scene.h"

namespace exactff::study {

// The values of each parameter of the adaptive algorithm. An empty list means the default.
struct Sweeps {
  std::vector<double> eps_b = {};            // default: max(rho B) times 10^-1 .. 10^-5
  std::vector<double> eps_a = {};            // default: 0 and the sources' mean face area times 10^-1 .. 10^-4
  std::vector<int> rays = {};                // default: 1, 4, 16, 64, 256
  std::vector<std::uint64_t> seeds = {};     // default: 1 .. 10
  std::vector<SamplePattern> patterns = {};  // default: jittered, then the other three
  std::vector<Variant> variants = {};        // default: mended, then literal
  bool enabled = true;                       // false: the adaptive algorithm is not swept
};

// All combinations of the lists are run if there are at most this many. Otherwise the plane eps_B x rays is run, and
// every other list on its own with the other parameters at the base.
inline constexpr std::size_t kFullProductLimit = 40;

// A method with increasing effort. Its rungs differ in one setting, or are what no other ladder has of the sweeps.
struct Ladder {
  std::string name;                    // "area sampling, stratified"
  std::string along;                   // the setting that differs; empty if there is only one rung, or no such setting
  std::vector<methods::Choice> rungs;  // in order of increasing effort
  bool only_of_sweeps = false;         // it is there for the settings of the sweeps alone
};

// Parses "area-sampling:pattern=stratified,samples=4|16|64": the text of a method as for methods::parse, where one
// setting may have several values. Throws InputError.
[[nodiscard]] Ladder parse_ladder(std::string_view text);

// How the methods are compared with each other.
struct MethodSweep {
  bool enabled = true;               // false: only the exact method and the sweeps
  std::vector<Ladder> ladders = {};  // default: every method of the library
  std::size_t seeds = 30;            // stochastic methods run with the seeds 1 .. seeds
  std::size_t receivers = 48;        // at most this many, chosen evenly among those that see something
  double budget = 2.0;  // seconds per ladder, estimated from counted work, for no particular machine; see MethodStudy
};

// The input of a study. Keeps a reference to the scene.
struct Request {
  const Scene* scene = nullptr;
  std::string scene_name;  // for titles and headers
  std::vector<Receiver> receivers;
  std::string receivers_name;      // "floor, grid 32x32", or the name of a file
  std::vector<Selection> sources;  // empty: every patch that emits
  Sweeps sweeps;
  MethodSweep methods;
  Engine engine = Engine::kEdges;
  int threads = 0;                  // 0: as many as this process may use; times are always measured on a single thread
  std::string command_line;         // shown in the last section of the report
  double sweep_budget = 25.0;       // seconds for all settings of the adaptive algorithm, as for MethodSweep::budget
  double seconds_for_a_time = 0.1;  // approximate seconds spent on timing one setting
  std::optional<render::Camera> camera = {};  // of the report's pictures; empty: one that shows the scene
  std::optional<Vec3> up = {};                // in the pictures of the latter; empty: render::upwards()
};

inline constexpr double kNotTimed = std::numeric_limits<double>::quiet_NaN();

// How much of the source a receiver sees, decided exactly.
enum class Sight { kNothing, kHidden, kPartly, kVisible };  // kNothing: behind it or below the horizon
[[nodiscard]] std::string_view to_string(Sight sight);

// The exact result for one receiver and one source.
struct ExactTerm {
  double value = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  Status status = Status::kZero;
  Sight sight = Sight::kNothing;
  double visible_fraction = 0.0;  // NaN in scenes of more than kMostFacesForFractions faces
};
inline constexpr std::size_t kMostFacesForFractions = 5000;  // for more faces an exact fraction takes long

// The exact result for one receiver and all sources.
struct ExactRow {
  std::vector<ExactTerm> terms;  // in the order of the sources
  double form_factor = 0.0;      // their sum, added as balls and rounded once
  Rgb radiosity;                 // rho * sum of B_s F_s
  Sight sight = Sight::kNothing;
  bool certified = true;
  bool sampled = false;           // the adaptive algorithm can find the visibility only by tracing rays
  double visible_fraction = 0.0;  // mean over the sources, weighted by their areas
  double seconds = kNotTimed;
};

// The result of the adaptive algorithm for one receiver and one setting, summed over the sources.
struct SampleRow {
  double form_factor = 0.0;
  double error = 0.0;
  double radiosity_error = 0.0;
  std::uint64_t leaves = 0;
  std::uint64_t rays = 0;
  std::uint64_t shaft_tests = 0;
  std::array<std::uint64_t, kLeafReasonCount> leaves_by_reason{};
  std::uint64_t silent_leaves = 0;  // sampled V = 0 or 1, but part of the leaf is visible and part is hidden
  std::uint64_t wrong_leaves = 0;   // sampled V = 0 but all is visible, or V = 1 but nothing is
  double silent_error = 0.0;        // the form factor that silent and wrong leaves add beyond the correct amount
  double seconds = kNotTimed;
};

// Error statistics over the receivers of one setting. p99 is the nearest-rank percentile of |error|: the smallest
// magnitude that at least 99 % of the receivers do not exceed. NaN errors are only counted.
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
  std::size_t violations = 0;  // receivers with |radiosity error| > eps_B or NaN
  std::uint64_t leaves = 0;
  std::uint64_t rays = 0;
  std::uint64_t silent_leaves = 0;
  std::uint64_t wrong_leaves = 0;
  std::size_t silent_receivers = 0;  // receivers with a silent or wrong leaf
  ErrorStatistics silent;            // of SampleRow::silent_error, over the judged receivers
};

// Seconds per receiver. The `_partly` fields are over the receivers that see the source partly, if any.
struct TimeSummary {
  double median = 0.0;
  double mean = 0.0;
  double median_partly = 0.0;
  double mean_partly = 0.0;
};

// The results of one rung of a ladder at the chosen receivers: of one setting.
//
// Times are those of one thread at work. At each receiver in turn, the exact method and the setting are called, in
// several rounds. The time at a receiver is the median over the rounds of the ratio of the two, times the median time
// of the exact method there; so the machine's speed may drift. `seconds` is the mean over all chosen receivers. A slow
// setting is measured at some of them, and its time at the others is taken to be in proportion to the exact method's.
struct MethodCell {
  std::size_t ladder = 0;
  std::size_t rung = 0;
  std::vector<std::size_t> settings;                  // those of Study::settings that are this one, with whatever seed
  std::vector<std::uint64_t> seeds;                   // a single 0 if the method uses no random numbers
  std::vector<std::vector<double>> values;            // F, by seed, then by chosen receiver
  std::vector<std::vector<double>> radiosity_errors;  // the same
  ErrorStatistics error;                              // errors in radiosity, over seeds and receivers
  ErrorStatistics error_partly;                       // where the source is partly hidden
  ErrorStatistics error_visible;                      // where it is wholly visible
  double work = 0.0;             // samples or pixels, or else leaves and rays, per receiver on average
  double planned_seconds = 0.0;  // of one evaluation, by counted work
  double seconds = kNotTimed;    // per receiver for all sources
  double seconds_partly = kNotTimed;
  // The quartiles of the ratios over the rounds, averaged over the receivers as the times are.
  double ratio_low = kNotTimed;
  double ratio_high = kNotTimed;
};

// The exponent of error = c * work^exponent, fitted over the rungs for each seed: the mean over the seeds, with its
// 95 % confidence interval by Student's t. A single seed has no interval.
struct Slope {
  double exponent = 0.0;
  double low = 0.0;
  double high = 0.0;
  std::size_t seeds = 0;
  std::size_t rungs = 0;
};

struct LadderSlopes {
  std::optional<Slope> partly;   // over the receivers that see the source partly
  std::optional<Slope> visible;  // over the receivers that see all of it
};

// The results of the middle rung of a ladder at every receiver, with its first seed. Not of ladders of the sweeps only.
struct MethodField {
  std::size_t ladder = 0;
  std::size_t rung = 0;
  std::vector<double> radiosity_errors;
  std::vector<double> form_factors;
};

// The comparison of the methods. A ladder stops before the rung whose counted work (rays, pixels, ...), at a fixed
// price per unit, would exceed the budget. The set of rungs run therefore depends on the request alone, never on a
// clock. Settings of the sweeps are run nevertheless, with fewer seeds, but with three at least.
struct MethodStudy {
  std::vector<Ladder> ladders;
  std::vector<std::size_t> receivers;  // the chosen receivers: indices into Study::exact, ascending
  std::vector<MethodCell> cells;       // by ladder, then rung
  std::vector<LadderSlopes> slopes;    // by ladder
  std::vector<MethodField> fields;     // for the ladders whose middle rung was run
  std::vector<double> setup_seconds;   // by ladder: once per scene and source
};

// The exact radiosity, and the values of other methods, along the line of receivers where most see the source partly.
struct Profile {
  std::string where;                // "row 12 of floor"
  std::vector<Receiver> receivers;  // in order
  std::vector<double> position;     // distance of each from the first, in the scene's unit of length
  std::vector<double> exact;        // radiosity, largest channel
  std::vector<double> kinks;        // positions where Sight changes for some source, to 2^-20 of the length
  struct Curve {
    std::string name;
    std::vector<double> radiosity;
  };
  std::vector<Curve> others;
};

struct Study {
  Request request;  // sources, sweeps and threads filled in
  double largest_rho_b = 0.0;
  std::vector<AdaptiveOptions> settings;  // of the sweeps; none, and no samples, summaries or times, without them
  std::size_t base = 0;                   // index into settings: the point where the sweeps cross
  bool full_product = false;
  std::vector<ExactRow> exact;                  // by receiver
  std::vector<std::vector<SampleRow>> samples;  // by setting, then receiver
  std::vector<Summary> summaries;               // by setting
  TimeSummary exact_time;
  std::vector<TimeSummary> times;  // by setting; the means are those of its MethodCell
  // The exact method's time while one setting was measured, divided by its median over all: the 5th and the 95th
  // percentile over the settings. Far from 1 on a machine whose speed drifted.
  double exact_fastest = 1.0;
  double exact_slowest = 1.0;
  std::array<std::size_t, 4> receivers_by_sight{};
  std::vector<std::size_t> timed;  // the receivers that were timed
  // The receivers whose leaves were compared with the exact visible region, in ascending order: all of them, or some of
  // them in large scenes, where drawing that region takes long. Only these have silent and wrong leaves.
  std::vector<std::size_t> judged;
  MethodStudy methods;
  std::optional<Profile> profile;
  std::vector<LeftOut> left_out;
  double exact_setup_seconds = 0.0;  // once per source
  double ray_setup_seconds = 0.0;    // once per scene
};

// Runs the study. Everything except the times depends on the request alone, not on the number of threads. Times are
// measured afterwards with one thread and no other work (MethodCell). Values in `journal` are taken from it, and new
// values are stored there. Throws InputError if there is no receiver or no source, if the sources' radiosities are too
// large to be added (beyond 1e290), or if the sampled methods do not accept the scene.
[[nodiscard]] Study run(Request request, const Hooks& hooks = {}, jobs::Journal* journal = nullptr);

// Writes tables and one HTML page with figures into a hidden folder beside `folder`, and renames it at the end. The
// value files (values, exact, summary) contain no times and have the same bytes for any number of threads. Returns
// notes for the user, such as a missing gnuplot. Throws InputError unless `folder` can be written and replaced: it does
// not exist, is empty, or contains only files of an earlier study; throws Cancelled.
std::vector<std::string> write_report(const Study& study, const std::filesystem::path& folder, const Hooks& hooks = {});

}  // namespace exactff::study
