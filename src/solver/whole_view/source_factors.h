// Form factors of several sources at one point. Where the sources are most of the scene, one sweep over the whole view
// (view.h) finds them all; elsewhere they are found one by one. The values, bounds and statuses are the same.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/exact.h"
#include "exactff/view.h"

namespace exactff::whole_view {

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
    Workspace workspace;
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

 private:
  void look_around(const Receiver& receiver, const ExactOptions& options, Results& memory) const;
  void take_from_view(std::size_t source, const WholeView& view, FormFactor& factor) const;

  const Scene& scene_;
  std::vector<ExactSource> sources_;
  Sky sky_;
  bool faces_ = false;     // every source is a face; else the sweep is by patch
  bool in_view_ = false;   // the view has a form factor of every source
  bool are_most_ = false;  // a sweep costs less than one by one
};

}  // namespace exactff::whole_view
