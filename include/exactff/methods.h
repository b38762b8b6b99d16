// One interface for every method of computing form factors: the exact method and the approximate methods that it
// judges; and form factors of many receivers, by several threads.
//
// A text names a method and its settings, for example
//
//   hemicube:resolution=200,rotation=15
//
// A method works in stages that can be timed separately: per scene, per source, per choice of settings and thread, per
// receiver, and per receiver and source. Five lines lead from a scene to a value:
//
//   const methods::Choice choice = methods::parse("wallace:splits=8");
//   const auto on_scene = choice.method->prepare(scene);                                 // shared between threads
//   const auto light = on_scene->prepare_source(scene.select("light"));                  // shared between threads
//   const auto evaluator = on_scene->configure(choice.settings);                         // one for each thread
//   const double f = evaluator->form_factor(receiver, *light).form_factor;
//
// Your own algorithm can use the same interface: derive from PreparedScene and Evaluator, describe the method and its
// settings in a Method, and pass it to add_method(). From then on parse() knows its name, and every function that takes
// a Choice accepts it. The complete code:
//
//   using namespace exactff;
//   struct Guess : methods::Evaluator {                     // F of a small source, no shadows
//     double scale;
//     void look_from(const Receiver& receiver) override;    // keep what depends on the receiver alone
//     methods::Estimate form_factor(const methods::PreparedSource& source) override;
//   };
//   struct GuessOnScene : methods::PreparedScene {
//     using PreparedScene::PreparedScene;
//     std::unique_ptr<methods::Evaluator> configure(const Settings& settings) const override {
//       auto guess = std::make_unique<Guess>();
//       guess->scale = settings.number("scale");
//       return guess;
//     }
//   };
//   methods::add_method({.name = "guess", .summary = "a guess",
//                        .settings = {number_setting("scale", 1.0, 0.0, 10.0, "a factor on everything")},
//                        .prepare = [](const Scene& scene) { return std::make_unique<GuessOnScene>(scene); }});
//
// Inside the library a method is one function in src/rivals/methods, in the list of registry.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "exactff/exact.h"
#include "exactff/jobs.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "exactff/settings.h"

namespace exactff::methods {

// ----------------------------------------------------------------------------------------------------------- results

// Amounts of work by name: "rays", "leaves", "pixels". Holds a few named numbers without allocating memory.
class Counters {
 public:
  struct Counter {
    std::string_view name;
    std::uint64_t count = 0;
  };
  static constexpr std::size_t kMost = 16;

  // Adds to the counter of that name and creates it if it is new. `name` must remain valid as long as the program runs.
  // Throws std::logic_error for more than kMost names.
  void add(std::string_view name, std::uint64_t count);
  [[nodiscard]] std::uint64_t operator[](std::string_view name) const;  // 0 if there is no such counter
  [[nodiscard]] std::span<const Counter> list() const { return {counters_.data(), size_}; }

 private:
  std::array<Counter, kMost> counters_{};
  std::size_t size_ = 0;
};

struct Estimate {
  double form_factor = 0.0;
  Counters counters;
};

// ------------------------------------------------------------------------------------------------------------ stages

// The data of a method that depend on the source alone. Immutable; threads may share it.
class PreparedSource {
 public:
  explicit PreparedSource(const Selection& selection) : selection_(selection) {}
  virtual ~PreparedSource() = default;
  [[nodiscard]] const Selection& selection() const { return selection_; }

 private:
  Selection selection_;
};

// One choice of settings, with the working memory of one thread. Values depend on the scene, the settings, the receiver
// and the source alone, never on earlier evaluations or other threads.
//
// The library's own methods return a finite form factor for every scene. It lies in [0, 1] unless the method's own
// formula can leave this range (Method::can_leave_unit). A value outside [0, 1] because of rounding is set to the
// nearer end; a value outside because of the formula is kept, and one beyond the largest double becomes the largest
// double. Only literal variants can be negative. For a method of your own, the study counts values that are not finite
// and leaves them out of error statistics.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  // Computes the data that depend on the receiver alone, such as the item buffer of a hemicube. The values requested
  // next are for this receiver. Throws InputError, here or at the first value, if the receiver is not finite or has a
  // zero normal.
  virtual void look_from(const Receiver& receiver) = 0;
  // The form factor to one source. Requires a call of look_from before, and a source prepared by the PreparedScene that
  // made this evaluator.
  [[nodiscard]] virtual Estimate form_factor(const PreparedSource& source) = 0;

  // The form factors to many sources from the current receiver: the same values as one by one. `estimates` has the same
  // length as `sources`.
  virtual void form_factors(std::span<const PreparedSource* const> sources, std::span<Estimate> estimates);

  [[nodiscard]] Estimate form_factor(const Receiver& receiver, const PreparedSource& source) {
    look_from(receiver);
    return form_factor(source);
  }
};

// The data of a method that depend on the scene alone. Immutable; threads may share it. Keeps a reference to the scene.
class PreparedScene {
 public:
  explicit PreparedScene(const Scene& scene) : scene_(scene) {}
  virtual ~PreparedScene() = default;
  PreparedScene(const PreparedScene&) = delete;
  PreparedScene& operator=(const PreparedScene&) = delete;

  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] virtual std::unique_ptr<PreparedSource> prepare_source(const Selection& selection) const;
  // An evaluator for one thread. It keeps a reference to this object. `settings` must be those of the method.
  [[nodiscard]] virtual std::unique_ptr<Evaluator> configure(const Settings& settings) const = 0;

 private:
  const Scene& scene_;
};

// ----------------------------------------------------------------------------------------------------------- methods

struct Method {
  std::string name;     // letters, digits and hyphens
  std::string summary;  // one sentence
  std::string source;   // where it was published; may be empty
  std::vector<SettingSpec> settings;
  // One pass from a receiver gives the values of all sources: its cost does not grow with their number.
  bool all_sources_at_once = false;
  // Throws InputError if the method cannot handle the scene.
  std::function<std::unique_ptr<PreparedScene>(const Scene&)> prepare;
  // True if a setting can change a value, given the other settings. Empty: all settings can.
  std::function<bool(const Settings&, std::string_view setting)> uses = {};
  // Throws InputError if settings are incompatible. Empty: all combinations are allowed.
  std::function<void(const Settings&)> check = {};
  // True if the formula itself, without any rounding, can give a value outside [0, 1]. Empty: it cannot.
  std::function<bool(const Settings&)> can_leave_unit = {};

  [[nodiscard]] Settings defaults() const { return Settings(settings); }
  // True if the values depend on the seed.
  [[nodiscard]] bool stochastic(const Settings& chosen) const;
  // The settings, with those that cannot change a value set to their defaults, so that equal results compare equal.
  [[nodiscard]] Settings normalised(const Settings& chosen) const;
};

// All methods in the order of registration. The pointers stay valid as long as the program runs.
[[nodiscard]] std::vector<const Method*> all_methods();
// Throws InputError that lists the closest names if there is no such method.
[[nodiscard]] const Method& method_named(std::string_view name);
// Throws std::logic_error if the name is already used or contains anything but letters, digits and hyphens, or if
// `prepare` is empty.
const Method& add_method(Method method);

// A method and its settings.
struct Choice {
  const Method* method = nullptr;
  Settings settings;

  [[nodiscard]] std::string text() const;        // "hemicube:resolution=100,rotation=0"
  [[nodiscard]] std::string short_text() const;  // "hemicube"
  friend bool operator==(const Choice&, const Choice&) = default;
};

// Parses NAME or NAME:SETTING=VALUE,...; blanks are allowed anywhere between. Throws one InputError that lists all
// errors and the allowed values.
[[nodiscard]] Choice parse(std::string_view text);

// Name, summary and every setting with its meaning, unit, default and range, one setting per line.
[[nodiscard]] std::string description(const Method& method);

}  // namespace exactff::methods

// ------------------------------------------------------------------------------------------------- many receivers

// Form factors of many receivers, computed by several threads. The values are those of the functions for one receiver,
// whatever the number of threads.
//
// The receivers are not stored: threads ask for them one by one, so a million of them need no memory besides the
// caller's own arrays. Results are handed over as soon as they are known, from any thread and in any order.
namespace exactff::batch {

// `get` sets point, normal and own faces of receiver i. `receiver` is an object that the thread reuses; the other
// fields need not be set. Called from any thread.
struct Receivers {
  std::size_t count = 0;
  std::function<void(std::size_t i, Receiver& receiver)> get;
};
// Keeps a reference.
[[nodiscard]] Receivers receivers_in(std::span<const Receiver> receivers);

// How the work is done. No value depends on it.
struct Run {
  int threads = 0;  // 0: as many as this process may use
  // `progress` is called from the calling thread alone, about 50 times a second even while nothing gets ready, and
  // counts receivers. `cancelled` is called from any thread, and as often from the calling one: it may test there what
  // only that thread can know, such as a signal. After a cancellation or an exception, the other threads end first.
  Hooks hooks = {};
};

// Each calls `take` once for every receiver and source. Concurrent calls of `take` are for different receivers. What
// the functions throw is what those for one receiver throw, and Cancelled.
void exact_form_factors(
    const Scene& scene, const Receivers& receivers, std::span<const ExactSource* const> sources,
    const ExactOptions& options, const Run& run,
    const std::function<void(std::size_t receiver, std::size_t source, const FormFactor& result)>& take);

// What is open, all directions that meet nothing, as a source: value, bounds, status and enclosure of WholeView::open
// (view.h) as a FormFactor, without records. Throws InputError for a visible fraction or a gradient.
void sky_factors(const Scene& scene, const Receivers& receivers, const ExactOptions& options, const Run& run,
                 const std::function<void(std::size_t receiver, const FormFactor& result)>& take);

// As above, by any method. `estimates` are in the order of the sources, which `scene` must have prepared.
void form_factors(const methods::PreparedScene& scene, const Settings& settings, const Receivers& receivers,
                  std::span<const methods::PreparedSource* const> sources, const Run& run,
                  const std::function<void(std::size_t receiver, std::span<const methods::Estimate> estimates)>& take);

// The faces that receivers probably were meant to lie on (exactff::find_faces), by `tolerance`, or else face_tolerance.
void find_faces(const Scene& scene, const Receivers& receivers, std::optional<double> tolerance, const Run& run,
                const std::function<void(std::size_t receiver, const NearFaces& near)>& take);

}  // namespace exactff::batch
