// Runs the settings of a study at the chosen receivers.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "exactff/study.h"
#include "jobs/kept_work.h"
#include "study/radiosity.h"

namespace exactff::study {

// A method prepared for a scene and its sources.
struct PreparedMethod {
  std::unique_ptr<methods::PreparedScene> scene;
  std::vector<std::unique_ptr<methods::PreparedSource>> owned;
  std::vector<const methods::PreparedSource*> sources;

  PreparedMethod(const methods::Method& method, const Scene& given, std::span<const Selection> selections);
};

// The settings of a choice with this seed; seed 0 leaves them unchanged.
[[nodiscard]] Settings with_seed(const methods::Choice& choice, std::uint64_t seed);

struct MethodResults {
  MethodStudy methods;
  std::vector<LeftOut> left_out;
};
// Values of every ladder at chosen receivers, and of its middle rung at all receivers. `study` must have its exact
// values and the settings of its sweeps.
[[nodiscard]] MethodResults run_methods(const Study& study, std::vector<Ladder> ladders, const jobs::KeptWork& kept,
                                        const Hooks& hooks);

// The largest error of the channels of the receiver's radiosity, and the sum of the form factors.
struct SourceSum {
  double form_factor = 0.0;
  Rgb error;  // of what arrives, before the receiver's reflectance

  void add(double value, double exact, const Rgb& radiosity) {
    form_factor += value;
    study::add(error, times(radiosity, value - exact));
  }
  [[nodiscard]] double radiosity_error(const Rgb& reflectance) const {
    return largest_in_magnitude(times(reflectance, error));
  }
};

// The receivers that a study examines in detail: evenly spaced among those that see the source partly, and for one
// third among those that see all of it; other receivers if there are too few. Ascending.
[[nodiscard]] std::vector<std::size_t> choose_receivers(const std::vector<ExactRow>& exact, std::size_t count);

// The planned time for a method's counted work, in seconds. Uses fixed prices, so that no plan depends on a clock.
[[nodiscard]] double planned_seconds(const methods::Counters& counters, std::size_t faces);

}  // namespace exactff::study
