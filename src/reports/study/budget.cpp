#include "study/budget.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "kernel/expect.h"
#include "methods/adaptive.h"
#include "study/ladders.h"
#include "study/settings.h"
#include "study/sight.h"
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

}  // namespace

double planned_seconds(const methods::Counters& counters, std::size_t faces) {
  double nanoseconds = 1000.0;
  for (const auto& counter : counters.list()) {
    nanoseconds += price(counter.name, faces) * static_cast<double>(counter.count);
  }
  return 1e-9 * nanoseconds;
}

Estimator::Estimator(const methods::Choice& choice, const PreparedMethod& prepared, double most_seconds)
    : prepared_(prepared), evaluator_(prepared.scene->configure(choice.settings)) {
  if (auto* recursion = dynamic_cast<methods::RecursionEvaluator*>(evaluator_.get())) {
    const double most_leaves = most_seconds / (1e-9 * price("leaves", 0));
    recursion->stop_at(1 + static_cast<std::uint64_t>(std::min(most_leaves, 1e18)));
  }
}

double Estimator::seconds_at(const Receiver& receiver) {
  std::vector<methods::Estimate> estimates(prepared_.sources.size());
  evaluator_->look_from(receiver);
  evaluator_->form_factors(prepared_.sources, estimates);
  methods::Counters sum;
  for (const methods::Estimate& one : estimates) {
    for (const auto& counter : one.counters.list()) sum.add(counter.name, counter.count);
  }
  return planned_seconds(sum, prepared_.scene->scene().faces().size());
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

}  // namespace exactff::study
