// What is shared by Tampieri's algorithm and its control with exact visibility.
#pragma once

#include <utility>
#include <vector>

#include "adaptive/sub_patch.h"
#include "exactff/adaptive.h"
#include "exactff/methods.h"

namespace exactff::methods {

class RecursionEvaluator : public Evaluator {
 public:
  RecursionEvaluator(const AdaptiveSolver& solver, const Scene& scene, const AdaptiveOptions& options)
      : scene_(scene), solver_(solver), options_(options) {}
  void look_from(const Receiver& receiver) override {
    receiver_ = receiver;
    is_buried_ = buried_under(scene_, receiver).has_value();
  }

  // Splitting stops at this number of leaves; 0: no bound.
  void stop_at(std::uint64_t leaves) { options_.most_leaves = leaves; }
  // From now on the result behind every value is kept until it is taken; if `leaves`, with its leaves, or at most so
  // many of the largest.
  void keep_results(bool leaves, std::size_t most = 0) {
    keeps_results_ = true;
    options_.record_leaves = leaves;
    options_.most_recorded_leaves = most;
  }
  [[nodiscard]] std::vector<AdaptiveResult> take_results() { return std::exchange(results_, {}); }
  [[nodiscard]] double build_seconds() const { return solver_.build_seconds(); }

 protected:
  // Counts "leaves", "rays", and the leaves by reason: "leaves: V=1" and so on.
  [[nodiscard]] Estimate estimate(const AdaptiveSource& source, const Rgb& radiosity,
                                  adaptive::PatchVisibility* visibility = nullptr);
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const Receiver& receiver() const { return receiver_; }

 private:
  const Scene& scene_;
  const AdaptiveSolver& solver_;
  AdaptiveOptions options_;
  Receiver receiver_;
  bool is_buried_ = false;  // the receiver: it sees nothing
  bool keeps_results_ = false;
  std::vector<AdaptiveResult> results_;
};

}  // namespace exactff::methods
