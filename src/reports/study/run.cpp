// A study, step by step.
//
//   1. Complete the request: sources, threads. Refuse a request without receivers or sources.
//   2. Compute the exact values of every receiver and source. They also show what there is to sample.
//   3. Choose sweeps and ladders: defaults, without those that cannot affect the scene. Join them to one list of
//      ladders, whose rungs are the settings, and plan how much of it is run (runs.h).
//   4. Run the settings (runs.h).
//   5. Compute a profile along a line.
//   6. Measure the times of every setting, with nothing else running.
//   7. Compute statistics.
// Threads share the receivers. The place of a result is its index, so nothing depends on the number of threads.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "exactff/study.h"
#include "files/parallel.h"
#include "files/stopwatch.h"
#include "jobs/kept_work.h"
#include "kernel/float_environment.h"
#include "kernel/statistics.h"
#include "methods/adaptive.h"
#include "scene/scene.h"
#include "study/runs.h"
#include "study/settings.h"
#include "study/sight.h"
#include "study/statistics.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::study {
namespace {

void complete(Request& request) {
  require_scene(request.scene);
  if (request.receivers.empty()) {
    text::refuse("there are no receivers in " + request.receivers_name, "a comparison needs at least one receiver",
                 "use a finer grid or another patch");
  }
  if (request.sources.empty()) request.sources = request.scene->emitters();
  if (request.sources.empty()) {
    text::refuse(request.scene_name, "no patch emits", "without a source there is nothing to compare",
                 "name a source with --source");
  }
  if (request.threads <= 0) request.threads = files::usable_threads();
}

// Sums and means of radiosities below this bound do not overflow, whatever the number of receivers.
constexpr double kMostRadiosity = 1e290;

void require_moderate(double radiosity, const Request& request) {
  if (radiosity <= kMostRadiosity) return;
  text::refuse(request.scene_name,
               "a receiver that sees only the sources would have a radiosity of " + text::shortest(radiosity),
               "a comparison adds and averages radiosities; sums overflow above " + text::shortest(kMostRadiosity),
               "reduce the emissions (Ke); form factors do not depend on them");
}

double mean_face_area(const Request& request) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Selection& source : request.sources) {
    for (FaceId face : request.scene->faces_of(source)) {
      sum += request.scene->face(face).area;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

constexpr std::uint64_t kStatuses = 4, kSights = 4;

template <class Words>
void fields(Words& words, ExactRow& row) {
  for (ExactTerm& term : row.terms) {
    words(term.value, term.lower, term.upper, term.visible_fraction);
    words.choice(term.status, kStatuses);
    words.choice(term.sight, kSights);
  }
  words(row.form_factor, row.radiosity.r, row.radiosity.g, row.radiosity.b, row.visible_fraction);
  words.choice(row.sight, kSights);
  words(row.certified, row.sampled);
}

class Runner {
 public:
  Runner(Request request, const Hooks& hooks, jobs::Journal* journal) : hooks_(hooks), journal_(journal) {
    complete(request);
    study_.request = std::move(request);
  }

  Study run() {
    set_up();
    find_exact_values();
    choose_settings();
    plan_runs(study_, choose_ladders(), prepared_);
    run_settings();
    if (request().methods.enabled) draw_profile();
    measure_times(study_, hooks_);
    if (!study_.settings.empty()) study_.ray_setup_seconds = ray_setup_seconds();
    summarise();
    return std::move(study_);
  }

 private:
  [[nodiscard]] const Request& request() const { return study_.request; }
  [[nodiscard]] const Scene& scene() const { return *study_.request.scene; }
  [[nodiscard]] const Sweeps& sweeps() const { return study_.request.sweeps; }
  [[nodiscard]] int threads() const { return study_.request.threads; }

  void set_up() {
    for (const Selection& source : request().sources) {
      sources_.emplace_back(scene(), source);
      radiosities_.push_back(scene().source_radiosity(source));
      areas_.push_back(0.0);
      for (const FaceId face : scene().faces_of(source)) areas_.back() += scene().face(face).area;
    }
    for (const Receiver& receiver : request().receivers) {
      double of_all_sources = 0.0;
      for (std::size_t s = 0; s < sources_.size(); ++s) {
        const double rho_b = largest_rho_b(scene(), receiver, radiosities_[s]);
        study_.largest_rho_b = std::max(study_.largest_rho_b, rho_b);
        of_all_sources += rho_b;
      }
      require_moderate(of_all_sources, request());
    }
    request_hash_ = jobs::short_hash(text_of_exact_values(request()));
  }

  void find_exact_values() {
    const std::size_t count = request().receivers.size();
    study_.exact.resize(count);
    const jobs::KeptWork kept(journal_, request_hash_);
    files::parallel_for(count, threads(), "exact values", hooks_, [&](std::size_t i) {
      ExactRow& row = study_.exact[i];
      row.terms.resize(sources_.size());
      kept.get(
          "exact/" + std::to_string(i), [&] { row = exact_row(request().receivers[i]); },
          [&](auto& words) { fields(words, row); });
    });
  }

  [[nodiscard]] ExactRow exact_row(const Receiver& receiver) const {
    ExactRow row;
    Enclosure sum;
    Rgb arriving;
    double visible = 0.0, whole = 0.0;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      const bool fractions = scene().faces().size() <= kMostFacesForFractions;
      const ExactOptions options{.engine = request().engine, .visible_fraction = fractions};
      const FormFactor result = exact_form_factor(scene(), receiver, sources_[s], options);
      ExactTerm term{result.value,     result.lower,
                     result.upper,     result.status,
                     sight_of(result), result.visible_fraction.value_or(std::numeric_limits<double>::quiet_NaN())};
      row.sight = joined(row.sight, term.sight);
      row.certified = row.certified && result.status != Status::kNotCertified;
      row.sampled = row.sampled || needs_rays(result);
      row.terms.push_back(term);
      sum += result.enclosure;
      add(arriving, times(radiosities_[s], result.value));
      visible += areas_[s] * term.visible_fraction;
      whole += areas_[s];
    }
    row.form_factor = sources_.size() == 1 ? row.terms.front().value : nearest(sum);
    row.radiosity = times(scene().receiver_reflectance(receiver.on), arriving);
    row.visible_fraction = sources_.size() == 1 ? row.terms.front().visible_fraction : visible / whole;
    return row;
  }

  static double nearest(const Enclosure& sum) { return sum.nearest().value_or(0.5 * sum.lower() + 0.5 * sum.upper()); }

  // Derived from the exact values before anything is sampled.
  [[nodiscard]] Scope scope() const {
    const auto sampled = [](const ExactRow& row) { return row.sampled; };
    const auto seen = [](const ExactRow& row) { return row.sight == Sight::kPartly || row.sight == Sight::kVisible; };
    return {study_.largest_rho_b, mean_face_area(request()), std::ranges::any_of(study_.exact, sampled),
            std::ranges::any_of(study_.exact, seen)};
  }

  void choose_settings() {
    if (!sweeps().enabled) {
      return leave_out({{"the ray-sampled algorithm over its own tolerances",
                         "the comparison is about named methods (--sweep runs it, too)"}});
    }
    Sweeps& sweeps = study_.request.sweeps;
    study::complete(sweeps, scope());
    leave_out(study::leave_out(sweeps, scope()));
    SettingPlan plan = combine(sweeps);
    study_.settings = std::move(plan.settings);
    study_.base = plan.base;
    study_.full_product = plan.full_product;
    leave_out_settings(over_budget(study_, adaptive()));
  }

  [[nodiscard]] const PreparedMethod& adaptive() { return prepared_.of(methods::method_named("adaptive")); }

  std::vector<Ladder> choose_ladders() {
    MethodSweep& methods = study_.request.methods;
    if (!methods.enabled) methods.ladders = {parse_ladder("exact")};
    if (methods.ladders.empty()) methods.ladders = default_ladders(study_.largest_rho_b);
    leave_out(study::leave_out(methods.ladders, scope()));
    std::vector<Ladder> ladders = methods.ladders;
    add_sweeps(ladders, study_.settings);
    return ladders;
  }

  void leave_out(std::vector<LeftOut> items) { std::ranges::move(items, std::back_inserter(study_.left_out)); }

  void leave_out_settings(const std::vector<std::size_t>& dropped) {
    if (dropped.empty()) return;
    std::vector<std::string> names;
    for (const std::size_t k : dropped) names.push_back(setting_name(study_, k));
    leave_out(
        {{text::counted(names.size(), "setting") + " of the ray-sampled algorithm (" + text::enumerate(names) + ')',
          "the counted work of all settings would take more than the budget of " +
              text::duration(request().sweep_budget) + " for this scene (--sweep-budget)"}});
    std::vector<AdaptiveOptions> kept;
    std::size_t base = 0;
    for (std::size_t k = 0; k < study_.settings.size(); ++k) {
      if (k == study_.base) base = kept.size();
      if (std::ranges::find(dropped, k) == dropped.end()) kept.push_back(study_.settings[k]);
    }
    study_.base = base;
    study_.settings = std::move(kept);
  }

  void run_settings() {
    const MethodSweep& methods = request().methods;
    const jobs::KeptWork kept(
        journal_, request_hash_ + '-' + std::to_string(methods.seeds) + '-' + std::to_string(methods.receivers));
    study::run_settings(study_, sources_, prepared_, kept, hooks_);
  }

  void draw_profile() {
    auto profile = find_profile(study_, sources_, hooks_);
    if (auto* why = std::get_if<LeftOut>(&profile)) {
      leave_out({std::move(*why)});
    } else {
      study_.profile = std::move(std::get<Profile>(profile));
    }
  }

  // Of the structure, which is built at the first long candidate list.
  [[nodiscard]] double ray_setup_seconds() {
    const auto evaluator = adaptive().scene->configure(methods::method_named("adaptive").defaults());
    return dynamic_cast<const methods::RecursionEvaluator&>(*evaluator).build_seconds();
  }

  void summarise() {
    for (const ExactRow& row : study_.exact) ++study_.receivers_by_sight[static_cast<std::size_t>(row.sight)];
    for (std::size_t k = 0; k < study_.settings.size(); ++k) {
      study_.summaries.push_back(study::summarise(study_.samples[k], study_, study_.settings[k].eps_b));
    }
  }

  const Hooks& hooks_;
  jobs::Journal* journal_;
  std::string request_hash_;
  Study study_;
  std::vector<ExactSource> sources_;
  std::vector<Rgb> radiosities_;
  std::vector<double> areas_;
  PreparedMethods prepared_{study_.request};
};

}  // namespace

std::string text_of_exact_values(const Request& request) {
  std::string text = request.scene->hash();
  const auto put = [&](const std::string& part) { text += '\n' + part; };
  for (const Receiver& r : request.receivers) {
    for (const double c : {r.point.x, r.point.y, r.point.z, r.normal.x, r.normal.y, r.normal.z}) put(text::shortest(c));
    for (const FaceId face : r.on) put(std::to_string(index_of(face)));
    if (r.on.empty()) put("free");
  }
  for (const Selection& source : request.sources) put(request.scene->name_of(source));
  return text;
}

Study run(Request request, const Hooks& hooks, jobs::Journal* journal) {
  const kernel::StandardArithmetic arithmetic;
  return Runner(std::move(request), hooks, journal).run();
}

// --- Timing ---

// Times of settings, as multiples of the exact method's time.
//
//   1. Measure the exact method at every chosen receiver.
//   2. For each setting, go through receivers in rounds. At each of them call the exact method, then the setting: both
//      meet the same machine, with its clock and what other programs take of it.
//   3. The time at a receiver is the median of the ratios times the exact method's median time there over all settings.
//
// Other programs may run. Long calls are measured by the processor time of the thread. Reading that clock can take
// microseconds, so short calls are measured on the steady clock: they are seldom interrupted, and a median leaves out
// those that are. They follow a first call with the same arguments, and very short ones are repeated. Long calls need
// no such warming up.

namespace {

constexpr double kLong = 1e-4, kShortest = 5e-6;  // seconds: calls by processor time; repeated calls together
constexpr std::size_t kFewestRounds = 3, kMostRounds = 5;
constexpr std::size_t kFewestReceivers = 12;

// A planned time is this many times the true one, or less: prices of rays and samples are high, those of pixels low.
double overpriced(const methods::Method& method) { return method.all_sources_at_once ? 0.5 : 4.0; }

// Evaluates one setting, and knows how often to repeat it at each receiver.
class Subject {
 public:
  Subject(const PreparedMethod& prepared, const Settings& settings) : setting_(prepared, settings) {}

  [[nodiscard]] double value(const Receiver& receiver) {
    double sum = 0.0;
    for (const methods::Estimate& estimate : setting_.look_from(receiver)) sum += estimate.form_factor;
    return sum;
  }

  // Of one call at the receiver of this place. The first call at a place finds out how long it takes.
  [[nodiscard]] double seconds(const Receiver& receiver, std::size_t place) {
    if (repeats_.size() <= place) repeats_.resize(place + 1, 0);
    int& repeats = repeats_[place];
    if (repeats == 0 || repeats == kByProcessorTime) {
      const double start = files::thread_seconds();
      const double once = files::seconds_of([&] { setting_.look_from(receiver); }),
                   of_thread = files::thread_seconds() - start;
      if (repeats == 0) {
        repeats = once > kLong ? kByProcessorTime
                               : static_cast<int>(std::ceil(kShortest / std::max(kShortest / 100.0, once)));
      }
      if (repeats == kByProcessorTime) return of_thread;
    }
    setting_.look_from(receiver);  // what was called before may have taken the caches
    return files::seconds_of([&] {
             for (int k = 0; k < repeats; ++k) setting_.look_from(receiver);
           }) /
           repeats;
  }

 private:
  static constexpr int kByProcessorTime = -1;

  ReadySetting setting_;
  std::vector<int> repeats_;
};

// What was measured for one setting.
struct Rounds {
  std::vector<std::vector<double>> exact, ratios;  // by place, then round
};

class Stopwatch {
 public:
  Stopwatch(Study& study, const Hooks& hooks) : study_(study), hooks_(hooks), total_(1 + study.methods.cells.size()) {}

  void run() {
    const methods::Choice exact = exact_choice();
    study_.exact_setup_seconds =
        files::seconds_of([&] { exact_method_.emplace(*exact.method, scene(), request().sources); });
    exact_.emplace(*exact_method_, exact.settings);
    choose();
    time_exact();
    time_cells();
    finish();
  }

 private:
  [[nodiscard]] const Request& request() const { return study_.request; }
  [[nodiscard]] const Scene& scene() const { return *request().scene; }
  [[nodiscard]] const Receiver& receiver(std::size_t place) const { return request().receivers[receivers_[place]]; }
  [[nodiscard]] bool is_partly(std::size_t place) const {
    return study_.exact[receivers_[place]].sight == Sight::kPartly;
  }

  [[nodiscard]] methods::Choice exact_choice() const {
    methods::Choice choice = methods::parse("exact");
    if (request().engine == Engine::kBoolean) choice.settings.set("engine", std::string("boolean"));
    if (request().engine == Engine::kBoth) choice.settings.set("engine", std::string("both"));
    return choice;
  }

  void choose() {
    std::vector<std::size_t> all = study_.methods.receivers;
    if (all.empty()) {
      all = spread_order(study_.exact.size());
      all.resize(std::min(all.size(), request().methods.receivers));
    }
    receivers_ = order_of_timing(all, study_.exact);
    exact_seconds_.resize(receivers_.size());
  }

  void report() {
    files::require_not_cancelled(hooks_);
    if (hooks_.progress) hooks_.progress({"times", ++done_, total_});
  }

  // Calls round() until the time is used up, or half of it by enough rounds.
  template <class Round>
  void repeat(double seconds, const Round& round) {
    double spent = 0.0;
    for (std::size_t done = 0; done < kMostRounds; ++done) {
      if (spent > 3.0 * seconds || (2.0 * spent > seconds && done >= kFewestRounds)) break;
      files::require_not_cancelled(hooks_);
      spent += files::seconds_of(round);
    }
  }

  // As many receivers as a round of this planned time for each has time for.
  [[nodiscard]] std::size_t count_within(double seconds, double planned) const {
    const double most = std::min(seconds / planned, static_cast<double>(receivers_.size()));
    return std::max(static_cast<std::size_t>(most), std::min(kFewestReceivers, receivers_.size()));
  }

  void time_exact() {
    const double seconds = 4.0 * request().seconds_for_a_time;
    receivers_.resize(count_within(seconds, planned_exact()));
    repeat(seconds, [&] {
      for (std::size_t p = 0; p < receivers_.size(); ++p) {
        exact_seconds_[p].push_back(exact_->seconds(receiver(p), p));
      }
    });
    report();
  }

  [[nodiscard]] double planned_exact() const {
    for (const MethodCell& cell : study_.methods.cells) {
      const methods::Choice& choice = study_.methods.ladders[cell.ladder].rungs[cell.rung];
      if (choice.method->name == "exact") return std::max(kShortest, cell.planned_seconds);
    }
    return kShortest;
  }

  void time_cells() {
    const MethodStudy& methods = study_.methods;
    std::size_t c = 0;
    for (std::size_t l = 0; l < methods.ladders.size(); ++l) {
      const methods::Choice& choice = methods.ladders[l].rungs.front();
      std::optional<PreparedMethod> prepared;
      study_.methods.setup_seconds.push_back(
          files::seconds_of([&] { prepared.emplace(*choice.method, scene(), request().sources); }));
      for (; c < methods.cells.size() && methods.cells[c].ladder == l; ++c) time_cell(methods.cells[c], *prepared);
    }
  }

  void time_cell(const MethodCell& cell, const PreparedMethod& prepared) {
    const methods::Choice& choice = study_.methods.ladders[cell.ladder].rungs[cell.rung];
    Rounds& rounds = rounds_.emplace_back();
    if (choice.method->name != "exact") {
      Subject subject(prepared, with_seed(choice, cell.seeds.front()).settings);
      const double planned = planned_exact() + std::max(kShortest, cell.planned_seconds / overpriced(*choice.method));
      const std::size_t count = count_within(request().seconds_for_a_time, planned);
      rounds.exact.resize(count);
      rounds.ratios.resize(count);
      check_value(subject, cell);
      repeat(request().seconds_for_a_time, [&] { add_round(subject, rounds); });
    }
    report();
  }

  void add_round(Subject& subject, Rounds& rounds) {
    for (std::size_t p = 0; p < rounds.exact.size(); ++p) {
      const double exact = exact_->seconds(receiver(p), p), seconds = subject.seconds(receiver(p), p);
      exact_seconds_[p].push_back(exact);
      rounds.exact[p].push_back(exact);
      rounds.ratios[p].push_back(seconds / exact);
    }
  }

  void check_value(Subject& subject, const MethodCell& cell) const {
    if (study_.methods.receivers.empty() || cell.values.empty()) return;
    const double before = cell.values.front().front();
    const double now = subject.value(request().receivers[study_.methods.receivers.front()]);
    if (now != before && !(std::isnan(now) && std::isnan(before))) {
      throw std::logic_error("a method gave two results for one receiver and setting");
    }
  }

  void finish() {
    for (std::size_t p = 0; p < receivers_.size(); ++p) {
      exact_medians_.push_back(kernel::median(exact_seconds_[p]));
      study_.exact[receivers_[p]].seconds = exact_medians_[p];
    }
    study_.exact_time = summary_of(exact_medians_);
    study_.times.resize(study_.settings.size());
    std::vector<double> speeds;
    for (std::size_t c = 0; c < rounds_.size(); ++c) {
      set_times(study_.methods.cells[c], rounds_[c]);
      if (!rounds_[c].exact.empty()) speeds.push_back(exact_speed(rounds_[c]));
    }
    study_.timed = receivers_;
    std::ranges::sort(study_.timed);
    if (speeds.empty()) return;
    study_.exact_fastest = kernel::nearest_rank(speeds, 0.05);
    study_.exact_slowest = kernel::nearest_rank(speeds, 0.95);
  }

  void set_times(MethodCell& cell, const Rounds& rounds) {
    const bool is_exact = rounds.exact.empty();
    std::vector<double> seconds = is_exact ? exact_medians_ : std::vector<double>();
    for (std::size_t p = 0; p < rounds.ratios.size(); ++p) {
      seconds.push_back(kernel::median(rounds.ratios[p]) * exact_medians_[p]);
    }
    const TimeSummary summary = summary_of(seconds);
    cell.seconds = summary.mean;
    if (summary.mean_partly > 0.0) cell.seconds_partly = summary.mean_partly;
    cell.ratio_low = is_exact ? 1.0 : ratio_at(rounds, 0.25);
    cell.ratio_high = is_exact ? 1.0 : ratio_at(rounds, 0.75);
    for (const std::size_t k : cell.settings) {
      study_.times[k] = summary;
      for (std::size_t p = 0; p < seconds.size(); ++p) study_.samples[k][receivers_[p]].seconds = seconds[p];
    }
  }

  // The quantile of the ratios at each receiver, averaged like the times.
  [[nodiscard]] double ratio_at(const Rounds& rounds, double share) const {
    double sum = 0.0, exact = 0.0;
    for (std::size_t p = 0; p < rounds.ratios.size(); ++p) {
      sum += kernel::nearest_rank(rounds.ratios[p], share) * exact_medians_[p];
      exact += exact_medians_[p];
    }
    return sum / exact;
  }

  // Means over all receivers, from those at the first of them.
  [[nodiscard]] TimeSummary summary_of(const std::vector<double>& seconds) const {
    std::vector<double> partly, exact_partly;
    for (std::size_t p = 0; p < seconds.size(); ++p) {
      if (!is_partly(p)) continue;
      partly.push_back(seconds[p]);
      exact_partly.push_back(exact_medians_[p]);
    }
    std::vector<double> all_partly;
    for (std::size_t p = 0; p < receivers_.size(); ++p) {
      if (is_partly(p)) all_partly.push_back(exact_medians_[p]);
    }
    const std::span<const double> exact(exact_medians_.data(), seconds.size());
    return {kernel::median(seconds), in_proportion(seconds, exact, exact_medians_), kernel::median(partly),
            in_proportion(partly, exact_partly, all_partly)};
  }

  static double in_proportion(std::span<const double> seconds, std::span<const double> exact,
                              std::span<const double> all_exact) {
    return seconds.empty() ? 0.0 : kernel::mean(all_exact) * (kernel::mean(seconds) / kernel::mean(exact));
  }

  [[nodiscard]] double exact_speed(const Rounds& rounds) const {
    double here = 0.0, usual = 0.0;
    for (std::size_t p = 0; p < rounds.exact.size(); ++p) {
      here += kernel::median(rounds.exact[p]);
      usual += exact_medians_[p];
    }
    return here / usual;
  }

  Study& study_;
  const Hooks& hooks_;
  std::vector<std::size_t> receivers_;  // a place is an index into them
  std::optional<PreparedMethod> exact_method_;
  std::optional<Subject> exact_;
  std::vector<std::vector<double>> exact_seconds_;  // by place, over all settings
  std::vector<double> exact_medians_;
  std::vector<Rounds> rounds_;  // by cell; empty for the exact method
  std::size_t done_ = 0;
  std::size_t total_ = 0;
};

}  // namespace

// Multiples, modulo the count, of about the golden section of the count.
std::vector<std::size_t> spread_order(std::size_t count) {
  std::vector<std::size_t> order;
  if (count == 0) return order;
  auto step =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(0.6180339887 * static_cast<double>(count))));
  while (std::gcd(step, count) != 1) ++step;
  for (std::size_t k = 0; k < count; ++k) order.push_back((count / 2 + k * step) % count);
  return order;
}

std::vector<std::size_t> order_of_timing(const std::vector<std::size_t>& receivers,
                                         const std::vector<ExactRow>& exact) {
  std::vector<std::pair<double, std::size_t>> placed;
  for (const bool partly : {true, false}) {
    std::vector<std::size_t> group;
    std::ranges::copy_if(receivers, std::back_inserter(group),
                         [&](std::size_t i) { return (exact[i].sight == Sight::kPartly) == partly; });
    const std::vector<std::size_t> order = spread_order(group.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      placed.emplace_back((static_cast<double>(k) + 0.5) / static_cast<double>(order.size()), group[order[k]]);
    }
  }
  std::ranges::stable_sort(placed, {}, &std::pair<double, std::size_t>::first);
  std::vector<std::size_t> order;
  for (const auto& [place, receiver] : placed) order.push_back(receiver);
  return order;
}

void measure_times(Study& study, const Hooks& hooks) { Stopwatch(study, hooks).run(); }

}  // namespace exactff::study
