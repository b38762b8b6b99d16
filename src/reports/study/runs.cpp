// Runs the settings of a study.
//
//   1. Plan which rungs are run, with how many seeds.
//   2. Evaluate the settings of the sweeps, and the middle rung of every other ladder, at every receiver. Compare the
//      leaves of the sweeps with the exact visible region.
//   3. Evaluate every rung for every seed at the chosen receivers. What step 2 has evaluated is taken from there.
//   4. Fit error = c * work^exponent over the rungs, for each seed separately.
// Threads share the receivers and seeds. The place of a result is its index, so nothing depends on their number.
#include "study/runs.h"

#include <algorithm>
#include <functional>
#include <map>
#include <numeric>
#include <optional>

#include "files/parallel.h"
#include "kernel/expect.h"
#include "methods/adaptive.h"
#include "study/sight.h"
#include "study/statistics.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::study {
namespace {

constexpr std::size_t kFewestSeeds = 3;  // of a setting that uses random numbers
constexpr std::size_t kProbes = 3;
constexpr double kMostBudgets = 20.0;  // that the base may take, or a probe may find a setting to take

// Nanoseconds of a counted piece of work on a processor of about 2020, rounded.
double price(std::string_view counter, std::size_t faces) {
  static const std::map<std::string_view, double> kPrices = {
      {"rays", 150.0}, {"leaves", 300.0},      {"shaft tests", 10.0},      {"samples", 20.0}, {"sub-patches", 50.0},
      {"pixels", 0.0}, {"pixels drawn", 1.5},  {"polygons", 100.0},        {"edges", 400.0},  {"occluders", 300.0},
      {"bits", 0.0},   {"not certified", 0.0}, {"rational decisions", 1e6}};
  if (counter == "exact V") return 2e4 + 400.0 * static_cast<double>(faces);
  if (counter.starts_with("leaves:")) return 0.0;  // already counted as leaves
  const auto found = kPrices.find(counter);
  return found == kPrices.end() ? 100.0 : found->second;
}

// The base setting, where the sweeps cross, is run even if it exceeds the budget, up to this limit.
double most_seconds_of_base(const Study& study) { return std::max(10.0, kMostBudgets * study.request.sweep_budget); }

// Planned seconds of each setting over all receivers.
std::vector<double> costs_of(const Study& study, const PreparedMethod& adaptive) {
  std::vector<double> costs(study.settings.size(), 0.0);
  const std::vector<std::size_t> probes = choose_receivers(study.exact, kProbes);
  const double scale =
      static_cast<double>(study.exact.size()) / static_cast<double>(std::max<std::size_t>(probes.size(), 1));
  for (std::size_t k = 0; k < costs.size(); ++k) {
    const double most = k == study.base ? most_seconds_of_base(study) : kMostBudgets * study.request.sweep_budget;
    Estimator estimator(choice_of(study.settings[k]), adaptive, most / scale);
    for (const std::size_t i : probes) {
      if (costs[k] <= most) costs[k] += scale * estimator.seconds_at(study.request.receivers[i]);
    }
  }
  return costs;
}

void require_possible(const Study& study, double base_seconds) {
  const double most = most_seconds_of_base(study);
  if (base_seconds <= most) return;
  throw InputError({.file = study.request.scene_name,
                    .what = "the ray-sampled algorithm at " + setting_name(study, study.base) +
                            " would take more than " + text::duration(most),
                    .why = "all sweeps include this setting, so it is always run",
                    .suggestion = "use a larger --eps-b, fewer --rays or receivers, or a larger --sweep-budget"});
}

methods::Counters sum_of_counters(std::span<const methods::Estimate> estimates) {
  methods::Counters sum;
  for (const methods::Estimate& one : estimates) {
    for (const auto& counter : one.counters.list()) sum.add(counter.name, counter.count);
  }
  return sum;
}

class Planner {
 public:
  Planner(Study& study, PreparedMethods& prepared) : study_(study), prepared_(prepared) {
    for (const AdaptiveOptions& setting : study.settings) swept_.push_back(without_seed(choice_of(setting)));
  }

  // False if there is nothing to run.
  bool plan(const Ladder& ladder, std::size_t place) {
    const PreparedMethod* const prepared = prepared_or_left_out(ladder);
    if (prepared == nullptr) return false;
    const std::size_t rungs = ladder.rungs.size(), before = study_.methods.cells.size();
    left_ = request().methods.budget;
    ended_ = rungs;
    std::vector<std::size_t> skipped;
    for (std::size_t rung = 0; rung < rungs; ++rung) {
      MethodCell cell = new_cell(ladder.rungs[rung]);
      cell.ladder = place;
      cell.rung = rung;
      if (is_affordable(cell, ladder, *prepared)) {
        study_.methods.cells.push_back(std::move(cell));
      } else {
        skipped.push_back(rung);
      }
    }
    if (!skipped.empty()) tell_truncation(ladder, skipped);
    if (ended_ > 0 && !ladder.only_of_sweeps && ladder.rungs.front().method->name != "exact") {
      study_.methods.fields.push_back({place, std::min(rungs / 2, ended_ - 1), {}, {}});
    }
    return study_.methods.cells.size() > before;
  }

 private:
  [[nodiscard]] const Request& request() const { return study_.request; }

  [[nodiscard]] const PreparedMethod* prepared_or_left_out(const Ladder& ladder) {
    try {
      return &prepared_.of(*ladder.rungs.front().method);
    } catch (const InputError& refusal) {
      study_.left_out.push_back({"method " + ladder.name, text::csv_comment(refusal.what())});
      return nullptr;
    }
  }

  [[nodiscard]] MethodCell new_cell(const methods::Choice& choice) const {
    MethodCell cell;
    const std::size_t seeds = choice.method->stochastic(choice.settings) ? request().methods.seeds : 0;
    for (std::size_t seed = 1; seed <= seeds; ++seed) cell.seeds.push_back(seed);
    if (seeds == 0) cell.seeds = {0};
    for (std::size_t k = 0; k < swept_.size(); ++k) {
      if (swept_[k] == choice) cell.settings.push_back(k);
    }
    return cell;
  }

  // Takes the cost from what is left. A setting of the sweeps is always affordable, with fewer seeds.
  bool is_affordable(MethodCell& cell, const Ladder& ladder, const PreparedMethod& prepared) {
    const bool swept = !cell.settings.empty();
    if (cell.rung >= ended_ && !swept) return false;
    const auto rungs_left = static_cast<double>(ladder.rungs.size() - cell.rung);
    const double share = ladder.only_of_sweeps ? left_ / rungs_left : left_;
    const double of_seed = price_seed(cell, ladder.rungs[cell.rung], prepared, share);
    if (of_seed * static_cast<double>(cell.seeds.size()) > share) {
      if (!ladder.only_of_sweeps) ended_ = std::min(ended_, cell.rung);
      if (!swept) return false;
      keep_seeds(cell, share / of_seed);
    }
    left_ = std::max(0.0, left_ - of_seed * static_cast<double>(cell.seeds.size()));
    return true;
  }

  // The planned time of all chosen receivers with one seed.
  [[nodiscard]] double price_seed(MethodCell& cell, const methods::Choice& choice, const PreparedMethod& prepared,
                                  double most) const {
    const std::vector<std::size_t>& receivers = study_.methods.receivers;
    if (receivers.empty()) return 0.0;
    const auto count = static_cast<double>(receivers.size());
    const Receiver& middle = request().receivers[receivers[receivers.size() / 2]];
    cell.planned_seconds = Estimator(with_seed(choice, cell.seeds.front()), prepared, most / count).seconds_at(middle);
    return count * cell.planned_seconds;
  }

  static void keep_seeds(MethodCell& cell, double most) {
    const std::size_t kept = std::max(kFewestSeeds, static_cast<std::size_t>(most));
    if (kept < cell.seeds.size()) cell.seeds.resize(kept);
  }

  void tell_truncation(const Ladder& ladder, const std::vector<std::size_t>& skipped) {
    std::vector<std::string> names;
    for (const std::size_t rung : skipped) names.push_back(rung_text(ladder, rung));
    study_.left_out.push_back(
        {"method " + ladder.name +
             (ladder.along.empty() ? std::string() : ", " + ladder.along + ' ' + text::enumerate(names)),
         "its counted work would take more than the budget of " + text::duration(request().methods.budget) +
             " for a method on this scene (--method-budget)"});
  }

  Study& study_;
  PreparedMethods& prepared_;
  std::vector<methods::Choice> swept_;  // the settings of the sweeps, without their seeds
  double left_ = 0.0;                   // of the budget of the current ladder
  std::size_t ended_ = 0;               // its first rung that was over the budget
};

// --- running ---

constexpr std::size_t kReceiversPerTask = 8;

// The work that errors are plotted and fitted against: samples or pixels, otherwise the work of a recursion or a
// splitting.
double main_work(const methods::Counters& counters) {
  for (const char* name : {"samples", "pixels drawn"}) {
    if (counters[name] > 0) return static_cast<double>(counters[name]);
  }
  double sum = 0.0;
  for (const char* name : {"sub-patches", "leaves", "rays", "exact V"}) sum += static_cast<double>(counters[name]);
  return sum;
}

template <class Words>
void fields(Words& words, SampleRow& row) {
  words(row.form_factor, row.error, row.radiosity_error, row.silent_error, row.leaves, row.rays, row.shaft_tests);
  for (std::uint64_t& leaves : row.leaves_by_reason) words(leaves);
  words(row.silent_leaves, row.wrong_leaves);
}

std::uint64_t sampled_leaves(const AdaptiveResult& result) {
  return result.leaves_by_reason[static_cast<std::size_t>(LeafReason::kSampledVisible)] +
         result.leaves_by_reason[static_cast<std::size_t>(LeafReason::kSampledHidden)];
}

void add_counts(SampleRow& row, const AdaptiveResult& result) {
  row.leaves += result.leaves;
  row.rays += result.rays;
  row.shaft_tests += result.shaft_tests;
  for (std::size_t r = 0; r < kLeafReasonCount; ++r) row.leaves_by_reason[r] += result.leaves_by_reason[r];
}

// A setting with a seed, run at every receiver.
struct EverywhereRun {
  methods::Choice choice;
  const PreparedMethod& prepared;
  bool swept;  // one of the sweeps, so that its work is recorded, too
  std::vector<SampleRow>& rows;
};

class Runs {
 public:
  Runs(Study& study, std::span<const ExactSource> sources, PreparedMethods& prepared, const jobs::KeptWork& kept,
       const Hooks& hooks)
      : study_(study), sources_(sources), prepared_(prepared), kept_(kept), hooks_(hooks) {
    for (const Selection& source : request().sources) radiosities_.push_back(scene().source_radiosity(source));
  }

  void run() {
    choose_judged();
    run_everywhere();
    for (MethodCell& cell : result().cells) run_cell(cell);
    for (std::size_t l = 0; l < result().ladders.size(); ++l) result().slopes.push_back(slopes_of(study_, l));
  }

 private:
  // One evaluation: the sum over the sources.
  struct Outcome {
    double form_factor = 0.0;
    double radiosity_error = 0.0;
    double work = 0.0;
  };
  // The exact visible region of each source, drawn when it is first needed.
  using Truths = std::vector<std::optional<std::vector<PlaneDrawing>>>;

  [[nodiscard]] const Request& request() const { return study_.request; }
  [[nodiscard]] const Scene& scene() const { return *request().scene; }
  [[nodiscard]] MethodStudy& result() const { return study_.methods; }

  void choose_judged() {
    constexpr std::size_t kLargeScene = 300, kJudged = 32;
    if (study_.settings.empty()) return;
    if (scene().faces().size() > kLargeScene) {
      study_.judged = choose_receivers(study_.exact, kJudged);
      study_.left_out.push_back({"silent errors at all but " + text::counted(study_.judged.size(), "receiver"),
                                 "the exact visible region of so many faces takes long to draw"});
    } else {
      for (std::size_t i = 0; i < study_.exact.size(); ++i) study_.judged.push_back(i);
    }
  }

  Outcome evaluate(ReadySetting& setting, std::size_t i) const {
    const Receiver& receiver = request().receivers[i];
    const std::span<const methods::Estimate> estimates = setting.look_from(receiver);
    Outcome outcome;
    Rgb error;  // of what arrives, before the receiver's reflectance
    for (std::size_t s = 0; s < estimates.size(); ++s) {
      outcome.form_factor += estimates[s].form_factor;
      add(error, times(radiosities_[s], estimates[s].form_factor - study_.exact[i].terms[s].value));
    }
    outcome.work = main_work(sum_of_counters(estimates));
    outcome.radiosity_error = largest_in_magnitude(times(scene().receiver_reflectance(receiver.on), error));
    return outcome;
  }

  [[nodiscard]] const methods::Choice& rung_of(const MethodCell& cell) const {
    return result().ladders[cell.ladder].rungs[cell.rung];
  }

  // The index of the setting of the sweeps that is this one with this seed.
  [[nodiscard]] std::optional<std::size_t> swept_as(const MethodCell& cell, std::uint64_t seed) const {
    for (const std::size_t k : cell.settings) {
      if (seed == 0 || study_.settings[k].seed == seed) return k;
    }
    return std::nullopt;
  }

  void run_everywhere() {
    study_.samples.assign(study_.settings.size(), std::vector<SampleRow>(study_.exact.size()));
    std::vector<EverywhereRun> runs;
    for (std::size_t k = 0; k < study_.settings.size(); ++k) {
      const methods::Choice choice = choice_of(study_.settings[k]);
      runs.push_back({choice, prepared_.of(*choice.method), true, study_.samples[k]});
    }
    std::vector<std::vector<SampleRow>> of_fields(result().fields.size());
    std::vector<const std::vector<SampleRow>*> rows_of_fields;
    for (std::size_t f = 0; f < of_fields.size(); ++f) {
      const MethodCell& cell = cell_of(result().fields[f]);
      const auto swept = swept_as(cell, cell.seeds.front());
      rows_of_fields.push_back(swept ? &study_.samples[*swept] : &of_fields[f]);
      if (swept) continue;
      of_fields[f].resize(study_.exact.size());
      const methods::Choice choice = with_seed(rung_of(cell), cell.seeds.front());
      runs.push_back({choice, prepared_.of(*choice.method), false, of_fields[f]});
    }
    run_everywhere(runs);
    for (std::size_t f = 0; f < of_fields.size(); ++f) {
      for (const SampleRow& row : *rows_of_fields[f]) {
        result().fields[f].radiosity_errors.push_back(row.radiosity_error);
        result().fields[f].form_factors.push_back(row.form_factor);
      }
    }
  }

  [[nodiscard]] const MethodCell& cell_of(const MethodField& field) const {
    return *std::ranges::find_if(
        result().cells, [&](const MethodCell& cell) { return cell.ladder == field.ladder && cell.rung == field.rung; });
  }

  void run_everywhere(const std::vector<EverywhereRun>& runs) {
    std::string names;
    for (const EverywhereRun& run : runs) names += run.choice.text() + '\n';
    const std::string name = "everywhere/" + jobs::short_hash(names) + '/';
    const std::size_t count = study_.exact.size(), tasks = (count + kReceiversPerTask - 1) / kReceiversPerTask;
    files::parallel_for(tasks, request().threads, "every receiver", hooks_, [&](std::size_t task) {
      std::vector<ReadySetting> settings;
      for (const EverywhereRun& run : runs) settings.emplace_back(run.prepared, run.choice.settings);
      for (std::size_t i = task * kReceiversPerTask; i < std::min((task + 1) * kReceiversPerTask, count); ++i) {
        const auto compute = [&] {
          Truths truths(sources_.size());
          for (std::size_t k = 0; k < runs.size(); ++k) runs[k].rows[i] = sample(runs[k], settings[k], i, truths);
        };
        kept_.get(name + std::to_string(i), compute, [&](auto& words) {
          for (const EverywhereRun& run : runs) fields(words, run.rows[i]);
        });
      }
    });
  }

  SampleRow sample(const EverywhereRun& run, ReadySetting& setting, std::size_t i, Truths& truths) const {
    auto* const recursion = run.swept ? setting.recursion() : nullptr;
    if (recursion != nullptr) recursion->keep_results(std::ranges::binary_search(study_.judged, i));
    const Outcome outcome = evaluate(setting, i);
    SampleRow row;
    row.form_factor = outcome.form_factor;
    row.error = row.form_factor - study_.exact[i].form_factor;
    row.radiosity_error = outcome.radiosity_error;
    if (recursion == nullptr) return row;
    const std::vector<AdaptiveResult> results = recursion->take_results();
    for (std::size_t s = 0; s < results.size(); ++s) {
      add_counts(row, results[s]);
      if (results[s].leaf_list.empty() || sampled_leaves(results[s]) == 0) continue;
      if (!truths[s]) truths[s] = draw_visibility(scene(), request().receivers[i], sources_[s]);
      const SampledVerdict verdict = judge_leaves(results[s].leaf_list, *truths[s]);
      row.silent_leaves += verdict.silent;
      row.wrong_leaves += verdict.wrong;
      row.silent_error += verdict.error;
    }
    return row;
  }

  void run_cell(MethodCell& cell) {
    const std::size_t receivers = result().receivers.size();
    cell.values.assign(cell.seeds.size(), std::vector<double>(receivers));
    cell.radiosity_errors = cell.values;
    kept_.get(
        "method/" + jobs::short_hash(rung_of(cell).text()), [&] { compute(cell); },
        [&](auto& words) {
          words(cell.work);
          for (std::size_t s = 0; s < cell.seeds.size(); ++s) {
            words.list_of(receivers, cell.values[s]);
            words.list_of(receivers, cell.radiosity_errors[s]);
          }
        });
    summarise(cell, study_);
  }

  static Outcome outcome_of(const SampleRow& row) {
    return {row.form_factor, row.radiosity_error, static_cast<double>(row.leaves + row.rays)};
  }

  void compute(MethodCell& cell) {
    const std::vector<std::size_t>& receivers = result().receivers;
    const PreparedMethod& prepared = prepared_.of(*rung_of(cell).method);
    cell.work = 0.0;  // a journal may have had other values
    cell.values.assign(cell.seeds.size(), std::vector<double>(receivers.size()));
    cell.radiosity_errors = cell.values;
    const std::size_t chunks = (receivers.size() + kReceiversPerTask - 1) / kReceiversPerTask;
    std::vector<double> work(cell.seeds.size() * chunks, 0.0);
    const auto task = [&](std::size_t t) {
      const std::size_t seed = t / chunks, first = t % chunks * kReceiversPerTask;
      const auto swept = swept_as(cell, cell.seeds[seed]);
      ReadySetting setting(prepared, with_seed(rung_of(cell), cell.seeds[seed]).settings);
      for (std::size_t r = first; r < std::min(first + kReceiversPerTask, receivers.size()); ++r) {
        const Outcome outcome =
            swept ? outcome_of(study_.samples[*swept][receivers[r]]) : evaluate(setting, receivers[r]);
        cell.values[seed][r] = outcome.form_factor;
        cell.radiosity_errors[seed][r] = outcome.radiosity_error;
        work[t] += outcome.work;
      }
    };
    files::parallel_for(work.size(), request().threads, result().ladders[cell.ladder].name, hooks_, task);
    for (const double w : work) cell.work += w;
    cell.work /= static_cast<double>(std::max<std::size_t>(receivers.size() * cell.seeds.size(), 1));
  }

  Study& study_;
  std::span<const ExactSource> sources_;
  PreparedMethods& prepared_;
  const jobs::KeptWork& kept_;
  const Hooks& hooks_;
  std::vector<Rgb> radiosities_;
};

}  // namespace

double planned_seconds(const methods::Counters& counters, std::size_t faces) {
  double nanoseconds = 1000.0;
  for (const auto& counter : counters.list()) {
    nanoseconds += price(counter.name, faces) * static_cast<double>(counter.count);
  }
  return 1e-9 * nanoseconds;
}

Estimator::Estimator(const methods::Choice& choice, const PreparedMethod& prepared, double most_seconds)
    : faces_(prepared.scene->scene().faces().size()), setting_(prepared, choice.settings) {
  if (auto* recursion = setting_.recursion()) {
    const double most_leaves = most_seconds / (1e-9 * price("leaves", 0));
    recursion->stop_at(1 + static_cast<std::uint64_t>(std::min(most_leaves, 1e18)));
  }
}

double Estimator::seconds_at(const Receiver& receiver) {
  return planned_seconds(sum_of_counters(setting_.look_from(receiver)), faces_);
}

std::vector<std::size_t> over_budget(const Study& study, const PreparedMethod& adaptive) {
  EXACTFF_EXPECT(study.exact.size() == study.request.receivers.size() && !study.settings.empty());
  const std::vector<double> costs = costs_of(study, adaptive);
  require_possible(study, costs[study.base]);
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater<>{}, [&](std::size_t k) { return costs[k]; });
  double total = std::accumulate(costs.begin(), costs.end(), 0.0);
  std::vector<std::size_t> dropped;
  for (const std::size_t k : order) {
    if (total <= study.request.sweep_budget) break;
    if (k == study.base) continue;
    total -= costs[k];
    dropped.push_back(k);
  }
  return dropped;
}

void plan_runs(Study& study, std::vector<Ladder> ladders, PreparedMethods& methods) {
  study.methods.receivers = choose_receivers(study.exact, study.request.methods.receivers);
  Planner planner(study, methods);
  for (Ladder& ladder : ladders) {
    if (planner.plan(ladder, study.methods.ladders.size())) study.methods.ladders.push_back(std::move(ladder));
  }
}

void run_settings(Study& study, std::span<const ExactSource> sources, PreparedMethods& methods,
                  const jobs::KeptWork& kept, const Hooks& hooks) {
  Runs(study, sources, methods, kept, hooks).run();
}

}  // namespace exactff::study
