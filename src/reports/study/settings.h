// Which settings of which methods a study runs: the sweeps of the adaptive algorithm, and the ladders of all methods. A
// ladder is one method with settings of rising effort; a rung is one of these settings.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "exactff/study.h"
#include "methods/adaptive.h"

namespace exactff::study {

// What the exact values show about the work that a method has in the scene.
struct Scope {
  double largest_rho_b = 0.0;     // over receivers and sources
  double mean_source_area = 0.0;  // of a face
  bool anything_sampled = true;   // some receiver has a source hidden in part, or by several occluders together
  bool anything_seen = true;
};

// Fills empty lists with the defaults, drops repetitions, checks ranges. Throws InputError.
void complete(Sweeps& sweeps, const Scope& scope);

// Shortens every list that cannot affect the results to one value, and returns the reasons.
[[nodiscard]] std::vector<LeftOut> leave_out(Sweeps& sweeps, const Scope& scope);

struct SettingPlan {
  std::vector<AdaptiveOptions> settings;
  std::size_t base = 0;
  bool full_product = false;
};
// Requires completed sweeps. No setting occurs twice. The order depends on the lists alone.
[[nodiscard]] SettingPlan combine(const Sweeps& sweeps);

// The setting as one of the method `adaptive`.
[[nodiscard]] methods::Choice choice_of(const AdaptiveOptions& setting);

// With this parameter of a method at its default.
[[nodiscard]] methods::Choice without(methods::Choice choice, std::string_view parameter);

// The settings that differ from `from` in this one parameter of the method `adaptive` only, including `from`.
[[nodiscard]] std::vector<std::size_t> line_through(const std::vector<AdaptiveOptions>& settings, std::size_t from,
                                                    std::string_view parameter);
// The index of the setting in the list.
[[nodiscard]] std::optional<std::size_t> find_setting(const std::vector<AdaptiveOptions>& settings,
                                                      const AdaptiveOptions& wanted);

// Every method of the library over its range of effort. The values of eps_B are tenths of the largest rho B.
[[nodiscard]] std::vector<Ladder> default_ladders(double largest_rho_b);

// Gives every setting of the sweeps a rung, whatever its seed: of a ladder that has it or goes along eps_B with the
// same other settings, or else of a new ladder after the others of its method. Those without a line along eps_B share
// one.
void add_sweeps(std::vector<Ladder>& ladders, std::span<const AdaptiveOptions> settings);

// The choice with the default seed, and with the defaults of what does not affect it.
[[nodiscard]] methods::Choice without_seed(methods::Choice choice);

// Removes the ladders that cannot show anything, and returns the reasons.
[[nodiscard]] std::vector<LeftOut> leave_out(std::vector<Ladder>& ladders, const Scope& scope);

// The value of the setting that varies along the ladder, at this rung: "64". Empty if no setting varies.
[[nodiscard]] std::string rung_text(const Ladder& ladder, std::size_t rung);
// "area sampling, stratified, samples 64".
[[nodiscard]] std::string rung_name(const Ladder& ladder, std::size_t rung);
// Of a setting of the sweeps, as its rung is named: "adaptive, 16 rays, ε_B 0.0123". A seed that is not that of the
// base is added.
[[nodiscard]] std::string setting_name(const Study& study, std::size_t setting);

// With this seed; seed 0 leaves the choice unchanged.
[[nodiscard]] methods::Choice with_seed(methods::Choice choice, std::uint64_t seed);

// A method that is prepared for a scene and its sources.
struct PreparedMethod {
  std::unique_ptr<methods::PreparedScene> scene;
  std::vector<std::unique_ptr<methods::PreparedSource>> owned;
  std::vector<const methods::PreparedSource*> sources;

  PreparedMethod(const methods::Method& method, const Scene& given, std::span<const Selection> selections);
};

// Prepares a method when it is first needed. Throws InputError, each time, if it refuses the scene.
class PreparedMethods {
 public:
  explicit PreparedMethods(const Request& request) : request_(request) {}
  [[nodiscard]] const PreparedMethod& of(const methods::Method& method);

 private:
  const Request& request_;
  std::map<const methods::Method*, PreparedMethod> prepared_;
};

// A setting of a prepared method, with the working memory of one thread.
class ReadySetting {
 public:
  ReadySetting(const PreparedMethod& prepared, const Settings& settings)
      : evaluator_(prepared.scene->configure(settings)),
        sources_(prepared.sources),
        estimates_(prepared.sources.size()) {}

  // The values of all sources, in their order; valid until the next call.
  std::span<const methods::Estimate> look_from(const Receiver& receiver) {
    evaluator_->look_from(receiver);
    evaluator_->form_factors(sources_, estimates_);
    return estimates_;
  }
  // Null if the method is not a recursion (methods/adaptive_settings.h).
  [[nodiscard]] methods::RecursionEvaluator* recursion() {
    return dynamic_cast<methods::RecursionEvaluator*>(evaluator_.get());
  }

 private:
  std::unique_ptr<methods::Evaluator> evaluator_;
  std::span<const methods::PreparedSource* const> sources_;
  std::vector<methods::Estimate> estimates_;
};

}  // namespace exactff::study
