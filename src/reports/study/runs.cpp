// Runs the settings of a study.
//
//   1. Plan which rungs are run, with how many seeds (budget.h).
//   2. Evaluate the settings of the sweeps, and the middle rung of every other ladder, at every receiver. Compare the
//      leaves of the sweeps with the exact visible region.
//   3. Evaluate every rung for every seed at the chosen receivers. What step 2 has evaluated is taken from there.
//   4. Fit error = c * work^exponent over the rungs, for each seed separately.
// Threads share the receivers and seeds. The place of a result is its index, so nothing depends on their number.
#include "study/runs.h"

#include <algorithm>
#include <optional>

#include "files/parallel.h"
#include "methods/adaptive.h"
#include "study/radiosity.h"
#include "study/settings.h"
#include "study/sight.h"
#include "study/silent_errors.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::study {
namespace {

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

  Outcome evaluate(methods::Evaluator& evaluator, const PreparedMethod& prepared, std::size_t i) const {
    const Receiver& receiver = request().receivers[i];
    std::vector<methods::Estimate> estimates(prepared.sources.size());
    evaluator.look_from(receiver);
    evaluator.form_factors(prepared.sources, estimates);
    Outcome outcome;
    methods::Counters counters;
    Rgb error;  // of what arrives, before the receiver's reflectance
    for (std::size_t s = 0; s < estimates.size(); ++s) {
      outcome.form_factor += estimates[s].form_factor;
      add(error, times(radiosities_[s], estimates[s].form_factor - study_.exact[i].terms[s].value));
      for (const auto& counter : estimates[s].counters.list()) counters.add(counter.name, counter.count);
    }
    outcome.work = main_work(counters);
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
      std::vector<std::unique_ptr<methods::Evaluator>> evaluators;
      for (const EverywhereRun& run : runs) evaluators.push_back(run.prepared.scene->configure(run.choice.settings));
      for (std::size_t i = task * kReceiversPerTask; i < std::min((task + 1) * kReceiversPerTask, count); ++i) {
        const auto compute = [&] {
          Truths truths(sources_.size());
          for (std::size_t k = 0; k < runs.size(); ++k) runs[k].rows[i] = sample(runs[k], *evaluators[k], i, truths);
        };
        kept_.get(name + std::to_string(i), compute, [&](auto& words) {
          for (const EverywhereRun& run : runs) fields(words, run.rows[i]);
        });
      }
    });
  }

  SampleRow sample(const EverywhereRun& run, methods::Evaluator& evaluator, std::size_t i, Truths& truths) const {
    auto* const recursion = run.swept ? dynamic_cast<methods::RecursionEvaluator*>(&evaluator) : nullptr;
    if (recursion != nullptr) recursion->keep_results(std::ranges::binary_search(study_.judged, i));
    const Outcome outcome = evaluate(evaluator, run.prepared, i);
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
      const auto evaluator = prepared.scene->configure(with_seed(rung_of(cell), cell.seeds[seed]).settings);
      for (std::size_t r = first; r < std::min(first + kReceiversPerTask, receivers.size()); ++r) {
        const Outcome outcome =
            swept ? outcome_of(study_.samples[*swept][receivers[r]]) : evaluate(*evaluator, prepared, receivers[r]);
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

void run_settings(Study& study, std::span<const ExactSource> sources, PreparedMethods& methods,
                  const jobs::KeptWork& kept, const Hooks& hooks) {
  Runs(study, sources, methods, kept, hooks).run();
}

}  // namespace exactff::study
