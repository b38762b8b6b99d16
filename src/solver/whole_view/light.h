// The light of several sources at one point: their form factors, and sums of these with weights, correctly rounded in
// each channel.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/exact.h"
#include "exactff/view.h"
#include "kernel/ball.h"

namespace exactff::whole_view {

// The view of another measure, from what the last call of view() found for this receiver, with the same workspace and
// the same options otherwise. Both measures are of a sphere, or neither is.
void measure_again(const Scene& scene, const Receiver& receiver, const ViewOptions& options, WholeView& result,
                   ViewWorkspace& workspace);

// Computes every patch by both engines of the solver of single sources, and throws std::logic_error where a value, a
// status or a ball of `seen` is not the same. Patches with transparent faces and values that are not certified are left
// out. Requires that `seen` is the view of this receiver with these options.
void require_agreement(const Scene& scene, const Receiver& receiver, const ViewOptions& options, const WholeView& seen);

// --- Source factors ---

// Form factors of several sources at one point. Where the sources are most of the scene, one sweep over the whole view
// (view.h) finds them all; elsewhere they are found one by one. The values, bounds and statuses are the same.

// The name of the sky: all directions above the horizon that meet nothing.
inline constexpr std::string_view kSky = "sky";

enum class Sky { kLeftOut, kLastSource };

// Immutable; threads may share it. Keeps a reference to the scene.
class SourceFactors {
 public:
  SourceFactors(const Scene& scene, std::span<const Selection> sources, Sky sky);

  [[nodiscard]] std::size_t count() const { return sources_.size() + (sky_ == Sky::kLastSource ? 1 : 0); }
  [[nodiscard]] bool is_sky(std::size_t source) const { return source == sources_.size(); }
  [[nodiscard]] std::string name_of(std::size_t source) const;
  // B_s (scene.h); 1 for the sky.
  [[nodiscard]] Rgb radiosity(std::size_t source) const;

  // Objects that a thread reuses from point to point.
  struct Results {
    std::vector<FormFactor> factors;  // of the last point, by source
    ViewWorkspace workspace;
    WholeView view;
  };

  // Whether find_all() makes a sweep, so that all together cost less than one by one.
  [[nodiscard]] bool sweeps(const ExactOptions& options) const;

  // Sets results.factors, or `factors`. What a sweep finds has value, bounds, status and enclosure, but no records. So
  // has the sky, of which there is no visible fraction either.
  void find_all(const Receiver& receiver, const ExactOptions& options, Results& results) const {
    find_all(receiver, options, results.factors, results);
  }
  void find_all(const Receiver& receiver, const ExactOptions& options, std::vector<FormFactor>& factors,
                Results& memory) const;
  void find_one(const Receiver& receiver, std::size_t source, const ExactOptions& options, FormFactor& factor,
                Results& memory) const;
  // The same for another measure, without a new search: right after find_all, or find_one, with the same memory for the
  // same receiver, and source. Requires that both measures are of a sphere, or neither is, and one engine alone. Sets
  // value, bounds, status, enclosure and precision.
  void measure_all(const Receiver& receiver, const ExactOptions& options, std::vector<FormFactor>& factors,
                   Results& memory) const;
  void measure_one(const Receiver& receiver, std::size_t source, const ExactOptions& options, FormFactor& factor,
                   Results& memory) const;

 private:
  void look_around(const Receiver& receiver, const ExactOptions& options, Results& memory) const;
  [[nodiscard]] ViewOptions all_of(const ExactOptions& options) const;
  void take_from_view(std::size_t source, const WholeView& view, FormFactor& factor) const;

  const Scene& scene_;
  std::vector<ExactSource> sources_;
  Sky sky_;
  bool faces_ = false;     // every source is a face; else the sweep is by patch
  bool in_view_ = false;   // the view has a form factor of every source
  bool are_most_ = false;  // a sweep costs less than one by one
};

// --- Light ---

// One channel is  pi^pi_power (emitted + reflectance * sum over sources of radiosity * F).
struct LightFormula {
  Rgb emitted = {};
  Rgb reflectance{1.0, 1.0, 1.0};
  int pi_power = 0;  // -1, 0 or 1
};

enum class FaceSide { kFront, kBack };
// What a point shows that lies on these faces, of which the first counts: its back reflects as its front, but does not
// emit. A point on no face reflects everything.
[[nodiscard]] LightFormula light_formula(const Scene& scene, std::span<const FaceId> on, FaceSide side,
                                         Quantity quantity, KeMeans ke);
// B_s of each source, or 1 for form factors and for the sky. Throws InputError if the light of the scene, called
// `scene_name`, is negative or so strong that sums could overflow.
[[nodiscard]] std::vector<Rgb> light_weights(const Scene& scene, const SourceFactors& sources, Quantity quantity,
                                             const std::string& scene_name);

// Whether the light of the scene, called `scene_name`, is negative or so strong that sums could overflow. `sum`: of the
// sources' radiosities.
[[nodiscard]] std::optional<Problem> problem_of_strength(const Scene& scene, const Rgb& sum,
                                                         const std::string& scene_name);

struct CertifiedNumber {
  double value = 0.0;  // correctly rounded if certified
  double lower = 0.0;  // if certified, the neighbours of value; both 0 if the number is proved to be 0
  double upper = 0.0;
  bool certified = true;
};
using Channels = std::array<CertifiedNumber, 3>;

// The sources with their weights. Immutable; threads may share it. Keeps a reference to the sources.
class Light {
 public:
  // `radiosities`: one for each source, finite and not negative.
  Light(const SourceFactors& sources, std::vector<Rgb> radiosities);

  // Objects that a thread reuses from point to point.
  struct Results {
    SourceFactors::Results at;      // of the last point
    std::vector<FormFactor> finer;  // the same with more digits, where a channel needed them
  };

  // Computes all form factors, then the channels. Numbers in the formula must be finite and not negative.
  //
  // Raises the precision until both ends of each channel's ball round to the same double. A channel is not certified if
  // a form factor would need more than 65,536 bits for that: if the channel were exactly halfway between two doubles.
  [[nodiscard]] Channels at(const Receiver& receiver, const LightFormula& formula, const ExactOptions& options,
                            Results& results) const;
  // The same from form factors that are there already: those of `results`, of the last at() of any Light with the same
  // sources, at the same receiver with the same options.
  [[nodiscard]] Channels again(const Receiver& receiver, const LightFormula& formula, const ExactOptions& options,
                               Results& results) const;

 private:
  [[nodiscard]] Ball ball(const std::vector<FormFactor>& factors, const LightFormula& formula, int channel,
                          long bits) const;
  [[nodiscard]] CertifiedNumber channel(const Receiver& receiver, const LightFormula& formula, int channel,
                                        const ExactOptions& options, Results& results) const;
  [[nodiscard]] bool is_zero(const std::vector<FormFactor>& factors, const LightFormula& formula, int channel) const;
  [[nodiscard]] bool same_weights(const LightFormula& formula, int a, int b) const;

  const SourceFactors& sources_;
  std::vector<Rgb> radiosities_;
};

}  // namespace exactff::whole_view
