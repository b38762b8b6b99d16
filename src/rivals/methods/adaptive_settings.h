// The code shared by Tampieri's algorithm and its control with exact visibility.
#pragma once

#include "adaptive/patch_visibility.h"
#include "exactff/adaptive.h"
#include "exactff/methods.h"

namespace exactff::methods {

// eps_B, eps_A and depth_cap.
[[nodiscard]] std::vector<SettingSpec> tolerance_settings();
void take_tolerances(const Settings& settings, AdaptiveOptions& options);
// Throws InputError if only the depth cap would end the recursion.
void check_tolerances(const Settings& settings);

class RecursionEvaluator : public Evaluator {
 public:
  RecursionEvaluator(const AdaptiveSolver& solver, const Scene& scene, const AdaptiveOptions& options)
      : scene_(scene), solver_(solver), options_(options) {}
  void look_from(const Receiver& receiver) override { receiver_ = receiver; }

 protected:
  // Counts "leaves", "rays", and the leaves by reason: "leaves: V=1" and so on.
  [[nodiscard]] Estimate estimate(const AdaptiveSource& source, const Rgb& radiosity,
                                  adaptive::PatchVisibility* visibility = nullptr) const;
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Receiver& receiver() const { return receiver_; }

 private:
  const Scene& scene_;
  const AdaptiveSolver& solver_;
  AdaptiveOptions options_;
  Receiver receiver_;
};

}  // namespace exactff::methods
