// Which settings of the sweeps are too expensive for a scene.
#include <algorithm>
#include <numeric>

#include "kernel/expect.h"
#include "study/method_runs.h"
#include "study/radiosity.h"
#include "study/settings.h"
#include "text/phrases.h"

namespace exactff::study {
namespace {

constexpr std::size_t kProbes = 3;
constexpr double kLeafNanoseconds = 300.0;
constexpr double kMostBudgets = 20.0;  // that a probe may find a setting to take, before it is stopped
// The base setting, where the sweeps cross, is run even if it exceeds the budget, up to this limit.
double most_seconds_of_base(const Study& study) { return std::max(10.0, kMostBudgets * study.request.sweep_budget); }

class SweepPlan {
 public:
  SweepPlan(const Study& study, std::span<const ExactSource> sources, const AdaptiveSolver& solver,
            std::span<const AdaptiveSource> sampled_sources)
      : study_(study), sources_(sources), solver_(solver), sampled_sources_(sampled_sources) {}

  // Planned seconds of each setting over all receivers. A setting is not followed to its end once it exceeds what it
  // may take.
  std::vector<double> costs() const {
    const std::vector<std::size_t> probes = choose_receivers(study_.exact, kProbes);
    std::vector<double> result(study_.settings.size(), 0.0);
    if (probes.empty()) return result;
    const double scale = static_cast<double>(study_.exact.size()) / static_cast<double>(probes.size());
    for (const std::size_t i : probes) {
      for (std::size_t s = 0; s < sources_.size(); ++s) add_costs(i, s, scale, result);
    }
    return result;
  }

 private:
  // Comparing the leaves with the visible region costs the number of its edges times the number of leaves that sampling
  // decided.
  void add_costs(std::size_t i, std::size_t s, double scale, std::vector<double>& result) const {
    const Request& request = study_.request;
    const Receiver& receiver = request.receivers[i];
    const Scene& scene = *request.scene;
    std::uint64_t edges = 0;
    for (const PlaneRecord& plane : exact_form_factor(scene, receiver, sources_[s]).planes) edges += plane.edges;
    const double rho_b = largest_rho_b(scene, receiver, scene.source_radiosity(request.sources[s]));
    for (std::size_t k = 0; k < result.size(); ++k) {
      if (result[k] > most_seconds(k)) continue;
      AdaptiveOptions options = study_.settings[k];
      const double most_leaves = most_seconds(k) / (1e-9 * scale * kLeafNanoseconds);
      options.most_leaves = 1 + static_cast<std::uint64_t>(std::min(most_leaves, 1e18));
      const AdaptiveResult found = solver_.form_factor(receiver, sampled_sources_[s], rho_b, options);
      const auto of = [&](LeafReason reason) { return found.leaves_by_reason[static_cast<std::size_t>(reason)]; };
      const std::uint64_t judged = of(LeafReason::kSampledVisible) + of(LeafReason::kSampledHidden);
      const double nanoseconds = 60.0 * static_cast<double>(found.rays) +
                                 kLeafNanoseconds * static_cast<double>(found.leaves) +
                                 10.0 * static_cast<double>(found.shaft_tests) +
                                 20.0 * static_cast<double>(judged) * static_cast<double>(edges);
      result[k] += 1e-9 * scale * nanoseconds;
    }
  }

  [[nodiscard]] double most_seconds(std::size_t k) const {
    return k == study_.base ? most_seconds_of_base(study_) : kMostBudgets * study_.request.sweep_budget;
  }

  const Study& study_;
  std::span<const ExactSource> sources_;
  const AdaptiveSolver& solver_;
  std::span<const AdaptiveSource> sampled_sources_;
};

void require_possible(const Study& study, double base_seconds) {
  const double most = most_seconds_of_base(study);
  if (base_seconds <= most) return;
  throw InputError({.file = study.request.scene_name,
                    .what = "the ray-sampled algorithm at " + setting_name(study, study.base) +
                            " would take more than " + text::duration(most),
                    .why = "all sweeps include this setting, so it is always run",
                    .suggestion = "use a larger --eps-b, fewer --rays or receivers, or a larger --sweep-budget"});
}

}  // namespace

std::vector<std::size_t> over_budget(const Study& study, std::span<const ExactSource> sources,
                                     const AdaptiveSolver& solver, std::span<const AdaptiveSource> sampled_sources) {
  EXACTFF_EXPECT(study.exact.size() == study.request.receivers.size() && !study.settings.empty());
  const std::vector<double> costs = SweepPlan(study, sources, solver, sampled_sources).costs();
  require_possible(study, costs[study.base]);
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
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

}  // namespace exactff::study
