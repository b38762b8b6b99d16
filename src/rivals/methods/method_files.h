// Declarations shared by the files of the methods.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "exactff/adaptive.h"
#include "exactff/methods.h"
#include "kernel/float_environment.h"

namespace exactff::methods {

// The library's methods (registry.cpp lists them).
[[nodiscard]] Method exact_method();
[[nodiscard]] Method adaptive_method();
[[nodiscard]] Method adaptive_exact_visibility_method();
[[nodiscard]] Method hemicube_method();
[[nodiscard]] Method nettle_method();
[[nodiscard]] Method wallace_method();
[[nodiscard]] Method area_sampling_method();

// Upper limits for a single setting, so that a typing error is reported at once and does not cost a long wait.
inline constexpr std::int64_t kMostSplits = 4096;
inline constexpr std::int64_t kMostRays = 65536;

// The settings "pattern", "rays" and "seed" of methods that send several rays to a sub-patch (adaptive.cpp).
[[nodiscard]] SettingSpec pattern_setting();
// True if a pattern uses the setting: the centre pattern has one ray and no seed, the regular one no seed.
[[nodiscard]] bool pattern_uses(const Settings& settings, std::string_view setting);

// Method::prepare in the standard arithmetic of all methods, whatever arithmetic the calling thread has set. look_from,
// form_factor and configure set it themselves.
template <class OnScene>
std::unique_ptr<PreparedScene> prepare_as(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  return std::make_unique<OnScene>(scene);
}

// The data that this method has prepared for a source. Throws std::invalid_argument for those of another method.
template <class Own>
const Own& own(const PreparedSource& source) {
  if (const auto* own = dynamic_cast<const Own*>(&source)) return *own;
  throw std::invalid_argument("this source was prepared by another method: use the PreparedScene of the evaluator");
}

// A scene with what a method makes of it: Data of the scene, Source of data, scene and selection, Evaluating of data,
// scene and settings.
template <class Data, class Source, class Evaluating>
class OnScene : public PreparedScene {
 public:
  explicit OnScene(const Scene& scene) : PreparedScene(scene), data_(scene) {}

  [[nodiscard]] std::unique_ptr<PreparedSource> prepare_source(const Selection& selection) const override {
    const kernel::StandardArithmetic arithmetic;
    return std::make_unique<Source>(data_, scene(), selection);
  }
  [[nodiscard]] std::unique_ptr<Evaluator> configure(const Settings& settings) const override {
    const kernel::StandardArithmetic arithmetic;
    return std::make_unique<Evaluating>(data_, scene(), settings);
  }

 private:
  Data data_;
};

}  // namespace exactff::methods
