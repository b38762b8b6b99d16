// Runs the settings to be compared, ladder by ladder.
//
//   1. Choose receivers.
//   2. For each rung: evaluate it once and price the counted work of all receivers and seeds. End the ladder if the
//      price exceeds what is left of its budget; a setting of the sweeps is run all the same, with fewer seeds.
//   3. Evaluate the rung for every seed and receiver. A task is one seed and a few receivers; threads share the tasks.
//   4. Fit error = c * work^exponent over the rungs, for each seed separately.
//   5. Evaluate the middle rung at every receiver.
#include "study/method_runs.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "files/parallel.h"
#include "kernel/statistics.h"
#include "study/ladders.h"
#include "study/settings.h"
#include "study/statistics.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::study {
namespace {

constexpr std::size_t kReceiversPerTask = 8;
constexpr double kRoundingError = 1e-12;  // relative; smaller errors say nothing about a method

// Nanoseconds of a counted piece of work on a processor of about 2020, rounded. Used for planning only.
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

void take_evenly(std::vector<std::size_t>& chosen, const std::vector<std::size_t>& from, std::size_t count) {
  count = std::min(count, from.size());
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(from[(2 * i + 1) * from.size() / (2 * count)]);
}

class MethodRunner {
 public:
  MethodRunner(const Study& study, const jobs::KeptWork& kept, const Hooks& hooks)
      : study_(study), kept_(kept), hooks_(hooks), brightest_(largest_radiosity(study)) {
    for (const Selection& source : request().sources) radiosities_.push_back(scene().source_radiosity(source));
  }

  MethodResults run(std::vector<Ladder> ladders) {
    result_.ladders = std::move(ladders);
    result_.receivers = choose_receivers(study_.exact, request().methods.receivers);
    for (const AdaptiveOptions& setting : study_.settings) swept_.push_back(without_seed(choice_of(setting)));
    for (std::size_t l = 0; l < result_.ladders.size(); ++l) run_ladder(l);
    drop_idle_ladders();
    for (std::size_t l = 0; l < result_.ladders.size(); ++l) result_.slopes.push_back(slopes_of(l));
    return {std::move(result_), std::move(left_out_)};
  }

 private:
  // One evaluation: the sum over the sources.
  struct Outcome {
    double form_factor = 0.0;
    double radiosity_error = 0.0;
    methods::Counters counters;
  };

  [[nodiscard]] const Request& request() const { return study_.request; }
  [[nodiscard]] const Scene& scene() const { return *request().scene; }

  Outcome evaluate(methods::Evaluator& evaluator, const PreparedMethod& prepared, std::size_t i) const {
    const Receiver& receiver = request().receivers[i];
    std::vector<methods::Estimate> estimates(prepared.sources.size());
    evaluator.look_from(receiver);
    evaluator.form_factors(prepared.sources, estimates);
    Outcome outcome;
    SourceSum sum;
    for (std::size_t s = 0; s < estimates.size(); ++s) {
      sum.add(estimates[s].form_factor, study_.exact[i].terms[s].value, radiosities_[s]);
      for (const auto& counter : estimates[s].counters.list()) outcome.counters.add(counter.name, counter.count);
    }
    outcome.form_factor = sum.form_factor;
    outcome.radiosity_error = sum.radiosity_error(scene().receiver_reflectance(receiver.on));
    return outcome;
  }

  void run_ladder(std::size_t l) {
    const Ladder& ladder = result_.ladders[l];
    std::optional<PreparedMethod> prepared;
    try {
      prepared.emplace(*ladder.rungs.front().method, scene(), request().sources);
    } catch (const InputError& refusal) {
      left_out_.push_back({"method " + ladder.name, text::csv_comment(refusal.what())});
      return;
    }
    constexpr double kOfSweeps = 0.25;  // their settings have been run at every receiver, too
    double left = request().methods.budget * (ladder.only_of_sweeps ? kOfSweeps : 1.0);
    std::size_t ended = ladder.rungs.size();
    std::vector<std::size_t> skipped;
    for (std::size_t rung = 0; rung < ladder.rungs.size(); ++rung) {
      MethodCell cell = new_cell(l, rung);
      const bool swept = !cell.settings.empty();
      if (rung >= ended && !swept) {
        skipped.push_back(rung);
        continue;
      }
      const double of_seed = plan(cell, *prepared);
      if (of_seed * static_cast<double>(cell.seeds.size()) > left) {
        ended = std::min(ended, rung);
        if (!swept) {
          skipped.push_back(rung);
          continue;
        }
        keep_seeds(cell, std::max(1.0, left / of_seed));
      }
      left = std::max(0.0, left - of_seed * static_cast<double>(cell.seeds.size()));
      fill(cell, *prepared);
      summarise(cell);
      result_.cells.push_back(std::move(cell));
    }
    if (!skipped.empty()) tell_truncation(ladder, skipped);
    add_field(l, ended, *prepared);
  }

  static void keep_seeds(MethodCell& cell, double most) {
    if (most >= static_cast<double>(cell.seeds.size())) return;
    cell.seeds.resize(static_cast<std::size_t>(most));
    cell.values.resize(cell.seeds.size());
    cell.radiosity_errors.resize(cell.seeds.size());
  }

  // Drops ladders that were refused, or over the budget from the first rung on. The ladders after them move up.
  void drop_idle_ladders() {
    std::vector<Ladder> kept;
    std::vector<std::size_t> place(result_.ladders.size(), 0);
    for (std::size_t l = 0; l < result_.ladders.size(); ++l) {
      const bool has_cells = std::any_of(result_.cells.begin(), result_.cells.end(),
                                         [&](const MethodCell& cell) { return cell.ladder == l; });
      place[l] = kept.size();
      if (has_cells) kept.push_back(result_.ladders[l]);
    }
    for (MethodCell& cell : result_.cells) cell.ladder = place[cell.ladder];
    for (MethodField& field : result_.fields) field.ladder = place[field.ladder];
    result_.ladders = std::move(kept);
  }

  [[nodiscard]] MethodCell new_cell(std::size_t l, std::size_t rung) const {
    MethodCell cell;
    cell.ladder = l;
    cell.rung = rung;
    const methods::Choice& choice = result_.ladders[l].rungs[rung];
    if (!choice.method->stochastic(choice.settings)) {
      cell.seeds = {0};
    } else {
      for (std::size_t seed = 1; seed <= request().methods.seeds; ++seed) cell.seeds.push_back(seed);
    }
    cell.values.resize(cell.seeds.size());
    cell.radiosity_errors.resize(cell.seeds.size());
    for (std::size_t k = 0; k < swept_.size(); ++k) {
      if (swept_[k] == choice) cell.settings.push_back(k);
    }
    return cell;
  }

  [[nodiscard]] const methods::Choice& rung_of(const MethodCell& cell) const {
    return result_.ladders[cell.ladder].rungs[cell.rung];
  }

  // The planned time of all receivers with one seed.
  [[nodiscard]] double plan(MethodCell& cell, const PreparedMethod& prepared) const {
    if (result_.receivers.empty()) return 0.0;
    const auto evaluator = prepared.scene->configure(with_seed(rung_of(cell), cell.seeds.front()));
    const std::size_t middle = result_.receivers[result_.receivers.size() / 2];
    const Outcome outcome = evaluate(*evaluator, prepared, middle);
    cell.planned_seconds = planned_seconds(outcome.counters, scene().faces().size());
    return static_cast<double>(result_.receivers.size()) * cell.planned_seconds;
  }

  void fill(MethodCell& cell, const PreparedMethod& prepared) {
    kept_.get(
        "method/" + jobs::short_hash(rung_of(cell).text()), [&] { compute(cell, prepared); },
        [&](auto& words) {
          words(cell.work);
          for (std::size_t s = 0; s < cell.seeds.size(); ++s) words(cell.values[s], cell.radiosity_errors[s]);
        });
  }

  void compute(MethodCell& cell, const PreparedMethod& prepared) {
    const std::size_t receivers = result_.receivers.size();
    cell.work = 0.0;  // a journal may have had another value
    cell.values.assign(cell.seeds.size(), std::vector<double>(receivers));
    cell.radiosity_errors = cell.values;
    const std::size_t chunks = (receivers + kReceiversPerTask - 1) / kReceiversPerTask;
    std::vector<double> work(cell.seeds.size() * chunks, 0.0);
    const auto task = [&](std::size_t t) {
      const std::size_t seed = t / chunks, first = t % chunks * kReceiversPerTask;
      const auto evaluator = prepared.scene->configure(with_seed(rung_of(cell), cell.seeds[seed]));
      for (std::size_t r = first; r < std::min(first + kReceiversPerTask, receivers); ++r) {
        const Outcome outcome = evaluate(*evaluator, prepared, result_.receivers[r]);
        cell.values[seed][r] = outcome.form_factor;
        cell.radiosity_errors[seed][r] = outcome.radiosity_error;
        work[t] += main_work(outcome.counters);
      }
    };
    const std::string stage = result_.ladders[cell.ladder].name;
    files::parallel_for(work.size(), request().threads, stage, hooks_, task);
    for (const double w : work) cell.work += w;
    cell.work /= static_cast<double>(std::max<std::size_t>(receivers * cell.seeds.size(), 1));
  }

  void summarise(MethodCell& cell) const {
    cell.error = statistics(cell, [](Sight) { return true; });
    cell.error_partly = statistics(cell, [](Sight sight) { return sight == Sight::kPartly; });
    cell.error_visible = statistics(cell, [](Sight sight) { return sight == Sight::kVisible; });
  }

  template <class Takes>
  [[nodiscard]] ErrorStatistics statistics(const MethodCell& cell, const Takes& takes) const {
    std::vector<double> errors;
    for (const std::vector<double>& of_seed : cell.radiosity_errors) append(errors, of_seed, takes);
    return error_statistics(errors);
  }

  template <class Takes>
  void append(std::vector<double>& errors, const std::vector<double>& of_seed, const Takes& takes) const {
    for (std::size_t r = 0; r < of_seed.size(); ++r) {
      if (takes(study_.exact[result_.receivers[r]].sight)) errors.push_back(of_seed[r]);
    }
  }

  void tell_truncation(const Ladder& ladder, const std::vector<std::size_t>& skipped) {
    std::vector<std::string> names;
    for (const std::size_t rung : skipped) names.push_back(rung_text(ladder, rung));
    left_out_.push_back(
        {"method " + ladder.name +
             (ladder.along.empty() ? std::string() : ", " + ladder.along + ' ' + text::enumerate(names)),
         "its counted work would take more than the budget of " + text::duration(request().methods.budget) +
             " for a method on this scene (--method-budget)"});
  }

  // `rungs`: how many rungs of the ladder were run before its budget ended.
  void add_field(std::size_t l, std::size_t rungs, const PreparedMethod& prepared) {
    const Ladder& ladder = result_.ladders[l];
    if (rungs == 0 || ladder.only_of_sweeps || ladder.rungs.front().method->name == "exact") return;
    MethodField field{l, std::min(ladder.rungs.size() / 2, rungs - 1), {}, {}};
    const methods::Choice& choice = ladder.rungs[field.rung];
    const std::uint64_t seed = choice.method->stochastic(choice.settings) ? 1 : 0;
    kept_.get(
        "field/" + jobs::short_hash(choice.text()),
        [&] {
          const std::size_t count = study_.exact.size();
          field.radiosity_errors.assign(count, 0.0);
          field.form_factors = field.radiosity_errors;
          files::parallel_for((count + kReceiversPerTask - 1) / kReceiversPerTask, request().threads, ladder.name,
                              hooks_, [&](std::size_t t) {
                                const auto evaluator = prepared.scene->configure(with_seed(choice, seed));
                                for (std::size_t i = t * kReceiversPerTask;
                                     i < std::min((t + 1) * kReceiversPerTask, count); ++i) {
                                  const Outcome outcome = evaluate(*evaluator, prepared, i);
                                  field.radiosity_errors[i] = outcome.radiosity_error;
                                  field.form_factors[i] = outcome.form_factor;
                                }
                              });
        },
        [&](auto& words) { words(field.radiosity_errors, field.form_factors); });
    result_.fields.push_back(std::move(field));
  }

  [[nodiscard]] LadderSlopes slopes_of(std::size_t l) const {
    return {slope(l, Sight::kPartly), slope(l, Sight::kVisible)};
  }

  [[nodiscard]] std::optional<Slope> slope(std::size_t l, Sight sight) const {
    std::vector<const MethodCell*> cells;
    for (const MethodCell& cell : result_.cells) {
      if (cell.ladder == l && cell.work > 0.0) cells.push_back(&cell);
    }
    // Settings of the sweeps may have fewer seeds than the others, and need not be in any order of effort.
    std::erase_if(cells, [&](const MethodCell* cell) { return cell->seeds.size() < cells.front()->seeds.size(); });
    if (cells.size() < 3 || result_.ladders[l].along.empty()) return std::nullopt;
    std::vector<double> exponents;
    for (std::size_t seed = 0; seed < cells.front()->seeds.size(); ++seed) {
      std::vector<std::pair<double, double>> points;
      for (const MethodCell* cell : cells) {
        std::vector<double> errors;
        append(errors, cell->radiosity_errors[seed], [&](Sight s) { return s == sight; });
        const double rms = error_statistics(errors).rms;
        if (rms > kRoundingError * brightest_) points.emplace_back(cell->work, rms);
      }
      const auto exponent = points.size() == cells.size() ? kernel::fitted_slope(points) : std::nullopt;
      if (exponent) exponents.push_back(*exponent);
    }
    if (exponents.empty()) return std::nullopt;
    const double middle = kernel::mean(exponents), half = kernel::mean_half_width(exponents);
    return Slope{middle, middle - half, middle + half, exponents.size(), cells.size()};
  }

  const Study& study_;
  const jobs::KeptWork& kept_;
  const Hooks& hooks_;
  const double brightest_;
  std::vector<Rgb> radiosities_;
  std::vector<methods::Choice> swept_;  // the settings of the sweeps, without their seeds
  MethodStudy result_;
  std::vector<LeftOut> left_out_;
};

}  // namespace

PreparedMethod::PreparedMethod(const methods::Method& method, const Scene& given, std::span<const Selection> selections)
    : scene(method.prepare(given)) {
  for (const Selection& selection : selections) {
    owned.push_back(scene->prepare_source(selection));
    sources.push_back(owned.back().get());
  }
}

Settings with_seed(const methods::Choice& choice, std::uint64_t seed) {
  Settings settings = choice.settings;
  if (seed > 0) settings.set("seed", static_cast<std::int64_t>(seed));
  return settings;
}

std::vector<std::size_t> choose_receivers(const std::vector<ExactRow>& exact, std::size_t count) {
  std::vector<std::size_t> partly, visible;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    if (exact[i].sight == Sight::kPartly) partly.push_back(i);
    if (exact[i].sight == Sight::kVisible) visible.push_back(i);
  }
  const std::size_t of_visible = std::max(count / 3, count - std::min(count, partly.size()));
  std::vector<std::size_t> chosen;
  take_evenly(chosen, visible, of_visible);
  take_evenly(chosen, partly, count - chosen.size());
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

double planned_seconds(const methods::Counters& counters, std::size_t faces) {
  double nanoseconds = 1000.0;
  for (const auto& counter : counters.list()) {
    nanoseconds += price(counter.name, faces) * static_cast<double>(counter.count);
  }
  return 1e-9 * nanoseconds;
}

MethodResults run_methods(const Study& study, std::vector<Ladder> ladders, const jobs::KeptWork& kept,
                          const Hooks& hooks) {
  return MethodRunner(study, kept, hooks).run(std::move(ladders));
}

}  // namespace exactff::study
