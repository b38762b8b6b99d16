// A study, step by step.
//
//   1. Complete the request: sources, threads. Refuse a request without receivers or sources.
//   2. Compute the exact values of every receiver and source. They also show what there is to sample.
//   3. Choose sweeps and ladders: defaults, without those that cannot affect the scene. Join them to one list of
//      ladders, whose rungs are the settings, and plan how much of it is run (runs.h).
//   4. Run the settings (runs.h).
//   5. Find where visibility changes in kind; compute a profile along a line.
//   6. Measure the times of every setting, with nothing else running.
//   7. Compute statistics.
// Threads share the receivers. The place of a result is its index, so nothing depends on the number of threads.
#include <algorithm>
#include <iterator>
#include <limits>

#include "exactff/study.h"
#include "files/parallel.h"
#include "jobs/kept_work.h"
#include "kernel/float_environment.h"
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

// Everything that the exact values depend on.
std::string request_text(const Request& request) {
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
    if (request().methods.enabled) look_closer();
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
    request_hash_ = jobs::short_hash(request_text(request()));
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

  void look_closer() {
    auto edges = find_shadow_edges(request(), sources_, hooks_);
    if (auto* why = std::get_if<LeftOut>(&edges)) {
      leave_out({std::move(*why)});
    } else {
      study_.edge_distance = std::move(std::get<ShadowEdges>(edges).distance);
      study_.edge_resolution = std::get<ShadowEdges>(edges).resolution;
    }
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

Study run(Request request, const Hooks& hooks, jobs::Journal* journal) {
  const kernel::StandardArithmetic arithmetic;
  return Runner(std::move(request), hooks, journal).run();
}

}  // namespace exactff::study
