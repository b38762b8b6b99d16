// The parts of `exactff point`: flags and warnings (point.cpp), values, output, the table of several sources.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "exactff/adaptive.h"
#include "exactff/exact.h"
#include "exactff/methods.h"
#include "exactff/receiver.h"
#include "exactff/view.h"
#include "flags/scene.h"
#include "flags/values.h"

namespace exactff::cli {

// --- One receiver ---

// The flags of one receiver, and warnings on where it lies. Shared by `exactff point` and `exactff view`.

struct OneReceiver {
  flags::ThreeNumbers at, normal;
  bool sphere = false;  // without a normal
  std::string on;

  void add_to(CLI::App& app);
  // The normal of a sphere is (0, 0, 0).
  [[nodiscard]] Receiver make(const Scene& scene) const;
};

// No front, and the back of some face.
[[nodiscard]] bool sees_only_backs(const WholeView& seen);

// A typing error in --at or --on would otherwise go unnoticed.
void warn_if_off_its_face(const Scene& scene, const Receiver& receiver);
// For a receiver that sees backs: which surfaces are probably turned the wrong way. Nothing of large scenes, where this
// would take longer than the values.
void warn_of_turned_surfaces(const Scene& scene);
// Says on stderr that x lies near a face that is not its own, and what would follow if it were: effect(receiver there),
// which is empty if nothing would. Or that the receiver looks away from the front of its own face. Or, if it sees
// nothing but backs, and would see something on the face before it, how to place it there.
void warn_of_near_face(const Scene& scene, const Receiver& receiver, const std::function<bool()>& sees_no_front,
                       const std::function<std::string(const Receiver&)>& effect);

// --- Point ---

inline constexpr std::uint64_t kMostPointLeaves = 10'000'000;  // takes some seconds
inline constexpr std::uint64_t kMostDrawnLeaves = 50'000;

struct PointArguments {
  flags::SceneArguments scene;
  OneReceiver receiver;
  std::vector<std::string> sources;
  std::vector<double> reflectance;
  flags::PrecisionArguments precision;
  flags::EngineArgument engine;
  flags::MeasureArgument measure;
  flags::ThreeNumbers up;
  bool fraction = false;
  bool exact_fraction = false;
  bool gradient = false;
  bool vertices = false;
  flags::ThreeNumbers along;
  bool plain = false;
  bool json = false;
  bool explain = false;
  std::string svg;
  std::string method;
};

// The result for one source.
struct PointTerm {
  struct Share {
    FaceId face{};
    double alone = 0.0;  // the part of the unoccluded form factor that this occluder alone hides
  };

  Selection source = {};
  bool emits = true;  // otherwise it counts with a radiosity of 1
  FormFactor exact = {};
  std::optional<double> unoccluded = {};
  std::vector<Share> shares = {};
  std::optional<methods::Estimate> estimate = {};  // by the method of --method
  std::optional<AdaptiveResult> adaptive = {};     // of it, if it is a recursion; with the leaves to draw
  Rgb radiosity = {};                              // rho B F, an estimate in double
};

struct PointResult {
  Receiver receiver = {};
  Measure measure = {};
  Rgb reflectance = {};
  std::vector<PointTerm> sources = {};
  bool every_patch = false;            // --source all
  bool stacked = false;                // of these, some lie in one plane over each other, and each counts fully
  std::optional<WholeView> seen = {};  // if the values of all sources are taken from it
  std::size_t emitters = 0;
  Enclosure sum = {};              // of the form factors of all sources
  Enclosure sum_of_emitters = {};  // of those that emit
  Rgb radiosity = {};              // sum of rho B F over the emitters; over all sources if none emits
  Rgb radiosity_of_others = {};    // over the sources that emit nothing, if others emit

  [[nodiscard]] bool is_mixed() const { return emitters > 0 && emitters < sources.size(); }
};

// `--plain`: "0" is a proved zero; a positive value that rounds to zero prints "0.0".
[[nodiscard]] std::string plain_value(const FormFactor& result);
// The value and dF/dx, dF/dy, dF/dz, separated by tabs; the value and "kink" where there are none. "0" is a proved
// zero, "0.0" an underflow or a derivative whose ball contains 0.
[[nodiscard]] std::string plain_gradient(const FormFactor& result);
[[nodiscard]] std::string value_text(const FormFactor& result, int digits);
// To the precision of --digits, else the nearest double; "between" its bounds if the ball does not determine it.
[[nodiscard]] std::string sum_words(const Enclosure& sum, int digits);
// JSON of a vector, a ball, and of what is asked for: the scene, the receiver without its faces, and the measure.
[[nodiscard]] nlohmann::ordered_json numbers_json(const Vec3& v);
[[nodiscard]] nlohmann::ordered_json numbers_json(const Rgb& c);
[[nodiscard]] nlohmann::ordered_json ball_json(const Enclosure& enclosure);
[[nodiscard]] nlohmann::ordered_json question_json(const std::string& path, const Scene& scene,
                                                   const Receiver& receiver, const Measure& measure);
void print_point_table(const PointArguments& args, const Scene& scene, const PointResult& point);
void print_point_json(const PointArguments& args, const Scene& scene, const PointResult& point);
void draw_point(const PointArguments& args, const Scene& scene, const PointResult& point);

}  // namespace exactff::cli
