// Form factors of many receivers, computed by several threads. The values are those of the functions for one receiver
// (exact.h, methods.h), whatever the number of threads.
//
// The receivers are not stored: threads ask for them one by one, so a million of them need no memory besides the
// caller's own arrays. Results are handed over as soon as they are known, from any thread and in any order.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "exactff/exact.h"
#include "exactff/methods.h"
#include "exactff/progress.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

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
