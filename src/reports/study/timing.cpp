#include "study/timing.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "files/parallel.h"
#include "files/stopwatch.h"
#include "kernel/statistics.h"
#include "study/method_runs.h"
#include "study/radiosity.h"

namespace exactff::study {
namespace {

constexpr double kLongCallSeconds = 0.02;  // a first call this long needs no warm-up
constexpr std::size_t kMostTimed = 256;    // receivers
constexpr std::size_t kFewestTimed = 12;
constexpr std::size_t kFewestInCell = 4;

template <class Call>
double typical_time(const Call& call) {
  const double first = files::seconds_of(call);
  return first >= kLongCallSeconds ? first : files::median_seconds(call, 3, std::numeric_limits<double>::infinity());
}

class Stopwatch {
 public:
  Stopwatch(const Study& study, const Hooks& hooks) : study_(study), hooks_(hooks) {}

  Times run() {
    total_ = 1 + study_.settings.size() + study_.methods.cells.size();
    prepare();
    choose();
    time_exact();
    for (std::size_t k = 0; k < study_.settings.size(); ++k) time_setting(k);
    if (solver_) times_.ray_setup = solver_->build_seconds();  // built at the first long candidate list
    time_methods();
    return std::move(times_);
  }

 private:
  [[nodiscard]] const Request& request() const { return study_.request; }
  [[nodiscard]] const Scene& scene() const { return *request().scene; }

  void prepare() {
    times_.exact_setup = files::seconds_of([&] {
      for (const Selection& source : request().sources) sources_.emplace_back(scene(), source);
    });
    if (study_.settings.empty()) return;
    solver_.emplace(scene());
    for (const Selection& source : request().sources) {
      sampled_sources_.push_back(solver_->prepare(source));
      radiosities_.push_back(scene().source_radiosity(source));
    }
  }

  void choose() {
    std::vector<std::size_t> order = spread_order(study_.exact.size());
    order.resize(std::min(order.size(), kMostTimed));
    const auto is_partly = [&](std::size_t i) { return study_.exact[i].sight == Sight::kPartly; };
    if (std::none_of(order.begin(), order.end(), is_partly)) {
      for (std::size_t i = 0; i < study_.exact.size() && order.size() < kMostTimed + 3; ++i) {
        if (is_partly(i)) order.push_back(i);
      }
    }
    order_ = std::move(order);
  }

  void report() {
    files::require_not_cancelled(hooks_);
    if (hooks_.progress) hooks_.progress({"times", ++done_, total_});
  }

  // Calls measure(i) for receivers until the time is used up. Always includes some that see the source partly, if there
  // are any.
  template <class Measure>
  void spend(double seconds, std::size_t fewest, const std::vector<std::size_t>& order, const Measure& measure) {
    const auto start = std::chrono::steady_clock::now();
    const std::chrono::duration<double> limit(seconds);
    std::size_t done = 0, partly = 0;
    const std::size_t all_partly = static_cast<std::size_t>(std::count_if(
        order.begin(), order.end(), [&](std::size_t i) { return study_.exact[i].sight == Sight::kPartly; }));
    for (const std::size_t i : order) {
      const bool is_partly = study_.exact[i].sight == Sight::kPartly;
      const bool spent = std::chrono::steady_clock::now() - start > limit && done >= fewest;
      if (spent && partly >= std::min<std::size_t>(3, all_partly)) break;
      if (spent && !is_partly) continue;
      measure(i);
      ++done;
      partly += is_partly ? 1 : 0;
    }
  }

  void time_exact() {
    FormFactor result;
    times_.exact.assign(study_.exact.size(), kNotTimed);
    spend(4.0 * request().seconds_for_a_time, kFewestTimed, order_, [&](std::size_t i) {
      times_.receivers.push_back(i);
      const ExactOptions options{.engine = request().engine};
      double sum = 0.0;
      for (const ExactSource& source : sources_) {
        sum += typical_time([&] { exact_form_factor(scene(), request().receivers[i], source, options, result); });
      }
      times_.exact[i] = sum;
    });
    std::sort(times_.receivers.begin(), times_.receivers.end());
    report();
  }

  void time_setting(std::size_t k) {
    std::vector<double>& seconds = times_.samples.emplace_back(study_.exact.size(), kNotTimed);
    spend(request().seconds_for_a_time, kFewestTimed, order_, [&](std::size_t i) {
      const Receiver& receiver = request().receivers[i];
      double form_factor = 0.0;
      seconds[i] = 0.0;
      for (std::size_t s = 0; s < sampled_sources_.size(); ++s) {
        const double rho_b = largest_rho_b(scene(), receiver, radiosities_[s]);
        double value = 0.0;
        seconds[i] += typical_time([&] {
          value = solver_->form_factor(receiver, sampled_sources_[s], rho_b, study_.settings[k]).form_factor;
        });
        form_factor += value;
      }
      const double before = study_.samples[k][i].form_factor;
      if (form_factor != before && !(std::isnan(form_factor) && std::isnan(before))) {
        throw std::logic_error("the adaptive algorithm gave two results for one receiver and setting");
      }
    });
    report();
  }

  void time_methods() {
    const MethodStudy& methods = study_.methods;
    std::vector<std::size_t> order;
    for (const std::size_t k : spread_order(methods.receivers.size())) order.push_back(methods.receivers[k]);
    for (std::size_t first = 0, l = 0; l < methods.ladders.size(); ++l) {
      const methods::Choice& choice = methods.ladders[l].rungs.front();
      std::optional<PreparedMethod> prepared;
      times_.method_setup.push_back(
          files::seconds_of([&] { prepared.emplace(*choice.method, scene(), request().sources); }));
      for (; first < methods.cells.size() && methods.cells[first].ladder == l; ++first) {
        time_cell(methods.cells[first], *prepared, order);
      }
    }
  }

  void time_cell(const MethodCell& cell, const PreparedMethod& prepared, const std::vector<std::size_t>& order) {
    const methods::Choice& choice = study_.methods.ladders[cell.ladder].rungs[cell.rung];
    const auto evaluator = prepared.scene->configure(with_seed(choice, cell.seeds.front()));
    std::vector<methods::Estimate> estimates(prepared.sources.size());
    std::vector<double> all, partly;
    spend(request().seconds_for_a_time, kFewestInCell, order, [&](std::size_t i) {
      all.push_back(typical_time([&] {
        evaluator->look_from(request().receivers[i]);
        evaluator->form_factors(prepared.sources, estimates);
      }));
      if (study_.exact[i].sight == Sight::kPartly) partly.push_back(all.back());
    });
    const auto mean_of = [](const std::vector<double>& list) { return list.empty() ? kNotTimed : kernel::mean(list); };
    times_.cells.push_back({mean_of(all), mean_of(partly)});
    report();
  }

  const Study& study_;
  const Hooks& hooks_;
  Times times_;
  std::vector<ExactSource> sources_;
  std::optional<AdaptiveSolver> solver_;
  std::vector<AdaptiveSource> sampled_sources_;
  std::vector<Rgb> radiosities_;
  std::vector<std::size_t> order_;
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

Times measure_times(const Study& study, const Hooks& hooks) { return Stopwatch(study, hooks).run(); }

}  // namespace exactff::study
