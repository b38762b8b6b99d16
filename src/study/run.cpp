// A study, step by step.
//
//   1. complete the request: sources, threads; refuse what has no receiver or no source;
//   2. exact values of every receiver and source: they also tell what there is to sample;
//   3. sweeps: defaults, what the scene gives no work to, the list of settings;
//   4. every setting for every receiver, twice: a recording call whose leaves are held against the exact visible
//      region, then the timed one. Both must give the same bits;
//   5. statistics.
// Receivers are shared out between threads; a result's place is its index, so nothing depends on their number.
#include <algorithm>
#include <bit>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "exactff/study.h"
#include "study/parallel.h"
#include "study/settings.h"
#include "study/silent_errors.h"
#include "study/statistics.h"

namespace exactff::study {
namespace {

using Clock = std::chrono::steady_clock;

// A first call this long has warmed itself up; it is not repeated for the sake of its time.
constexpr double kLongCallSeconds = 0.02;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Rgb times(const Rgb& a, const Rgb& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
Rgb times(const Rgb& a, double s) { return {a.r * s, a.g * s, a.b * s}; }
void add(Rgb& sum, const Rgb& term) {
  sum.r += term.r;
  sum.g += term.g;
  sum.b += term.b;
}

double largest_in_magnitude(const Rgb& c) {
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return std::max({c.r, c.g, c.b}, smaller);
}

Sight sight_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::kUnoccluded:
      return Sight::kVisible;
    case Outcome::kPartlyHidden:
      return Sight::kPartly;
    case Outcome::kHiddenByOne:
    case Outcome::kHiddenByUnion:
      return Sight::kHidden;
    case Outcome::kReceiverFace:
    case Outcome::kBehind:
    case Outcome::kBelowHorizon:
      break;
  }
  return Sight::kNothing;
}

Sight joined(Sight a, Sight b) {
  if (a == Sight::kNothing) return b;
  if (b == Sight::kNothing || a == b) return a;
  return Sight::kPartly;
}

// True where nothing but rays can tell the adaptive algorithm what is seen.
bool needs_rays(const FormFactor& result) {
  return std::any_of(result.planes.begin(), result.planes.end(), [](const PlaneRecord& plane) {
    return plane.outcome == Outcome::kPartlyHidden || plane.outcome == Outcome::kHiddenByUnion;
  });
}

void complete(Request& request) {
  if (request.receivers.empty()) {
    throw InputError(Problem{{},
                             0,
                             "there is no receiver in " + request.receivers_name,
                             "a comparison needs at least one point",
                             "use a finer grid, or another patch"});
  }
  if (request.sources.empty()) request.sources = request.scene->emitters();
  if (request.sources.empty()) {
    throw InputError(Problem{request.scene_name, 0, "no patch emits", "without a source there is nothing to compare",
                             "name one with --source"});
  }
  if (request.threads <= 0) request.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
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

class Runner {
 public:
  Runner(Request request, const Hooks& hooks) : hooks_(hooks) {
    complete(request);
    study_.request = std::move(request);
  }

  Study run() {
    set_up();
    find_exact_values();
    choose_settings();
    sample();
    summarise_all();
    return std::move(study_);
  }

 private:
  [[nodiscard]] const Request& request() const { return study_.request; }
  [[nodiscard]] const Scene& scene() const { return *study_.request.scene; }
  [[nodiscard]] int threads() const { return study_.request.threads; }

  void set_up() {
    const auto start = Clock::now();
    for (const Selection& source : request().sources) {
      sources_.emplace_back(scene(), source);
      radiosities_.push_back(scene().source_radiosity(source));
    }
    study_.exact_setup_seconds = seconds_since(start);
    solver_.emplace(scene());
    for (const Selection& source : request().sources) sampled_sources_.push_back(solver_->prepare(source));
    for (const Receiver& receiver : request().receivers) {
      for (std::size_t s = 0; s < sources_.size(); ++s) {
        study_.largest_rho_b = std::max(study_.largest_rho_b, largest_rho_b(receiver, s));
      }
    }
  }

  [[nodiscard]] double largest_rho_b(const Receiver& receiver, std::size_t source) const {
    return times(scene().receiver_reflectance(receiver.on), radiosities_[source]).largest();
  }

  void find_exact_values() {
    const std::size_t count = request().receivers.size();
    study_.exact.resize(count);
    sampled_.assign(count, 0);
    parallel_for(count, threads(), "exact values", hooks_, [this](std::size_t i) { find_exact_row(i); });
  }

  void find_exact_row(std::size_t i) {
    const Receiver& receiver = request().receivers[i];
    ExactRow& row = study_.exact[i];
    Enclosure sum;
    Rgb arriving;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      const FormFactor result = timed_exact(receiver, sources_[s], row.seconds);
      ExactTerm term{result.value, result.lower, result.upper, result.status, Sight::kNothing};
      for (const PlaneRecord& plane : result.planes) term.sight = joined(term.sight, sight_of(plane.outcome));
      row.sight = joined(row.sight, term.sight);
      row.certified = row.certified && result.status != Status::kNotCertified;
      if (needs_rays(result)) sampled_[i] = 1;
      row.terms.push_back(term);
      sum += result.enclosure;
      add(arriving, times(radiosities_[s], result.value));
    }
    row.form_factor = sources_.size() == 1 ? row.terms.front().value : nearest(sum);
    row.radiosity = times(scene().receiver_reflectance(receiver.on), arriving);
  }

  static double nearest(const Enclosure& sum) { return sum.nearest().value_or(0.5 * sum.lower() + 0.5 * sum.upper()); }

  FormFactor timed_exact(const Receiver& receiver, const ExactSource& source, double& seconds) const {
    auto start = Clock::now();
    const ExactOptions options{.engine = study_.request.engine};
    FormFactor result = exact_form_factor(scene(), receiver, source, options);
    double elapsed = seconds_since(start);
    if (elapsed < kLongCallSeconds) {
      start = Clock::now();
      result = exact_form_factor(scene(), receiver, source, options);
      elapsed = seconds_since(start);
    }
    seconds += elapsed;
    return result;
  }

  void choose_settings() {
    const bool anything = std::find(sampled_.begin(), sampled_.end(), 1) != sampled_.end();
    const Work work{study_.largest_rho_b, mean_face_area(request()), anything};
    Sweeps& sweeps = study_.request.sweeps;
    study::complete(sweeps, work);
    study_.left_out = leave_out(sweeps, work);
    Plan plan = combine(sweeps);
    study_.settings = std::move(plan.settings);
    study_.base = plan.base;
    study_.full_product = plan.full_product;
  }

  void sample() {
    const std::size_t count = request().receivers.size();
    study_.samples.assign(study_.settings.size(), std::vector<SampleRow>(count));
    parallel_for(count, threads(), "sampling", hooks_, [this](std::size_t i) { sample_receiver(i); });
    study_.ray_setup_seconds = solver_->build_seconds();  // built where a candidate list first was long
  }

  void sample_receiver(std::size_t i) {
    std::vector<Rgb> errors(study_.settings.size());
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      std::optional<std::vector<PlaneDrawing>> truth;
      for (std::size_t k = 0; k < study_.settings.size(); ++k) add_sample(i, s, k, truth, errors[k]);
    }
    for (std::size_t k = 0; k < study_.settings.size(); ++k) finish_sample(i, k, errors[k]);
  }

  // `truth` is drawn where the first setting asks for it.
  void add_sample(std::size_t i, std::size_t s, std::size_t k, std::optional<std::vector<PlaneDrawing>>& truth,
                  Rgb& error) {
    const Receiver& receiver = request().receivers[i];
    SampleRow& row = study_.samples[k][i];
    AdaptiveOptions options = study_.settings[k];
    const double rho_b = largest_rho_b(receiver, s);
    options.record_leaves = true;
    const AdaptiveResult recorded = solver_->form_factor(receiver, sampled_sources_[s], rho_b, options);
    options.record_leaves = false;
    const auto start = Clock::now();
    const AdaptiveResult result = solver_->form_factor(receiver, sampled_sources_[s], rho_b, options);
    row.seconds += seconds_since(start);
    require_same(recorded, result);
    add_counts(row, result);
    const double value = study_.exact[i].terms[s].value;
    row.form_factor += result.form_factor;
    add(error, times(radiosities_[s], result.form_factor - value));
    if (sampled_leaves(result) == 0) return;
    if (!truth) truth = draw_visibility(scene(), receiver, sources_[s]);
    const SampledVerdict verdict = judge_leaves(recorded.leaf_list, *truth);
    row.silent_leaves += verdict.silent;
    row.wrong_leaves += verdict.wrong;
  }

  static void require_same(const AdaptiveResult& a, const AdaptiveResult& b) {
    const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
    if (bits(a.form_factor) != bits(b.form_factor) || a.leaves != b.leaves || a.rays != b.rays) {
      throw std::logic_error("the adaptive algorithm gave two results for one receiver and setting");
    }
  }

  static std::uint64_t sampled_leaves(const AdaptiveResult& result) {
    return result.leaves_by_reason[static_cast<std::size_t>(LeafReason::kSampledVisible)] +
           result.leaves_by_reason[static_cast<std::size_t>(LeafReason::kSampledHidden)];
  }

  static void add_counts(SampleRow& row, const AdaptiveResult& result) {
    row.leaves += result.leaves;
    row.rays += result.rays;
    row.shaft_tests += result.shaft_tests;
    for (std::size_t r = 0; r < kLeafReasonCount; ++r) row.leaves_by_reason[r] += result.leaves_by_reason[r];
  }

  void finish_sample(std::size_t i, std::size_t k, const Rgb& error) {
    SampleRow& row = study_.samples[k][i];
    row.error = row.form_factor - study_.exact[i].form_factor;
    row.radiosity_error = largest_in_magnitude(times(scene().receiver_reflectance(request().receivers[i].on), error));
  }

  void summarise_all() {
    for (const ExactRow& row : study_.exact) ++study_.receivers_by_sight[static_cast<std::size_t>(row.sight)];
    std::vector<double> seconds;
    for (const ExactRow& row : study_.exact) seconds.push_back(row.seconds);
    study_.exact_time = summarise_times(seconds, study_.exact);
    for (std::size_t k = 0; k < study_.settings.size(); ++k) {
      study_.summaries.push_back(summarise(study_.samples[k], study_.exact, study_.settings[k].eps_b));
      for (std::size_t i = 0; i < seconds.size(); ++i) seconds[i] = study_.samples[k][i].seconds;
      study_.times.push_back(summarise_times(seconds, study_.exact));
    }
  }

  const Hooks& hooks_;
  Study study_;
  std::vector<ExactSource> sources_;
  std::vector<Rgb> radiosities_;
  std::optional<AdaptiveSolver> solver_;
  std::vector<AdaptiveSource> sampled_sources_;
  std::vector<char> sampled_;  // by receiver; not vector<bool>, whose neighbours share bytes between threads
};

}  // namespace

std::string_view name_of(Sight sight) {
  switch (sight) {
    case Sight::kNothing:
      return "faces away";
    case Sight::kHidden:
      return "hidden";
    case Sight::kPartly:
      return "partly hidden";
    case Sight::kVisible:
      return "visible";
  }
  return {};
}

Study run(Request request, const Hooks& hooks) { return Runner(std::move(request), hooks).run(); }

}  // namespace exactff::study
