#include <memory>
#include <vector>

#include "exactff/methods.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "text/refuse.h"
#include "whole_view/light.h"

namespace exactff::batch {
namespace {

// Starting threads takes as long as a few pairs in a simple scene.
constexpr std::size_t kFewPairs = 16;

using files::Body;

// What a thread keeps from receiver to receiver, only to avoid reallocation.
struct ExactMemory {
  Receiver receiver;
  FormFactor result;
  Workspace workspace;
};

struct MethodMemory {
  Receiver receiver;
  std::unique_ptr<methods::Evaluator> evaluator;
  std::vector<methods::Estimate> estimates;
};

std::size_t few(std::size_t sources) { return sources == 0 ? kFewPairs : kFewPairs / sources; }

void share(std::size_t receivers, std::size_t few, const char* stage, const Run& run,
           const std::function<Body()>& make_body) {
  constexpr std::size_t kLargestBlock = 64;  // receivers, of which some take microseconds
  const files::Loop loop{
      .count = receivers, .threads = run.threads, .stage = stage, .few = few, .largest_block = kLargestBlock};
  files::parallel_for(loop, run.hooks, make_body);
}

}  // namespace

Receivers receivers_in(std::span<const Receiver> receivers) {
  return {receivers.size(), [receivers](std::size_t i, Receiver& receiver) {
            receiver.point = receivers[i].point;
            receiver.normal = receivers[i].normal;
            receiver.on = receivers[i].on;
          }};
}

void exact_form_factors(
    const Scene& scene, const Receivers& receivers, std::span<const ExactSource* const> sources,
    const ExactOptions& options, const Run& run,
    const std::function<void(std::size_t receiver, std::size_t source, const FormFactor& result)>& take) {
  share(receivers.count, few(sources.size()), "form factors", run, [&]() -> Body {
    return [&, memory = std::make_shared<ExactMemory>()](std::size_t i) {
      receivers.get(i, memory->receiver);
      for (std::size_t s = 0; s < sources.size(); ++s) {
        exact_form_factor(scene, memory->receiver, *sources[s], options, memory->result, memory->workspace);
        take(i, s, memory->result);
      }
    };
  });
}

void sky_factors(const Scene& scene, const Receivers& receivers, const ExactOptions& options, const Run& run,
                 const std::function<void(std::size_t receiver, const FormFactor& result)>& take) {
  const kernel::StandardArithmetic arithmetic;
  if (options.visible_fraction || options.gradient || options.vertices) {
    text::refuse("a visible fraction or a gradient of the sky is requested", "the sky has no area, and no vertices",
                 "leave it out, or leave out the sky");
  }
  const whole_view::SourceFactors sky(scene, {}, whole_view::Sky::kLastSource);
  share(receivers.count, 1, "the sky", run, [&]() -> Body {
    return [&, memory = std::make_shared<ExactMemory>(),
            results = std::make_shared<whole_view::SourceFactors::Results>()](std::size_t i) {
      receivers.get(i, memory->receiver);
      sky.find_one(memory->receiver, 0, options, memory->result, *results);
      take(i, memory->result);
    };
  });
}

void form_factors(const methods::PreparedScene& scene, const Settings& settings, const Receivers& receivers,
                  std::span<const methods::PreparedSource* const> sources, const Run& run,
                  const std::function<void(std::size_t receiver, std::span<const methods::Estimate> estimates)>& take) {
  share(receivers.count, 1, "estimates", run, [&]() -> Body {
    auto memory = std::make_shared<MethodMemory>();
    memory->evaluator = scene.configure(settings);
    memory->estimates.resize(sources.size());
    return [&, memory](std::size_t i) {
      receivers.get(i, memory->receiver);
      memory->evaluator->look_from(memory->receiver);
      memory->evaluator->form_factors(sources, memory->estimates);
      take(i, memory->estimates);
    };
  });
}

void find_faces(const Scene& scene, const Receivers& receivers, std::optional<double> tolerance, const Run& run,
                const std::function<void(std::size_t receiver, const NearFaces& near)>& take) {
  share(receivers.count, kFewPairs, "faces of receivers", run, [&]() -> Body {
    return [&, receiver = std::make_shared<Receiver>()](std::size_t i) {
      receivers.get(i, *receiver);
      take(i, exactff::find_faces(scene, *receiver, tolerance.value_or(face_tolerance(scene, receiver->point))));
    };
  });
}

}  // namespace exactff::batch
