// The scenes that are timed: a receiver, a square source and n occluders between them.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <optional>
#include <string>

#include "exactff/exact.h"
#include "generate/plain_scene.h"

namespace exactff::bench {

// Ready for queries: the bounding-volume tree, which a scene builds once, exists.
struct BenchScene {
  explicit BenchScene(const generate::PlainScene& plain);

  // The expected result of rays, computed on first use.
  [[nodiscard]] double visible_fraction() const;

  Scene scene;
  ExactSource source;
  Receiver receiver;

 private:
  mutable std::optional<double> visible_fraction_;
};

// Computes the value even if it is not used. (DoNotOptimize of an object that may change spoils doubles with GCC 12.)
template <class Value>
void keep(const Value& value) {
  benchmark::DoNotOptimize(value);
}

using Body = std::function<void(benchmark::State&, const BenchScene&)>;

// Registers SUBJECT/SCENE/N for every kind of scene and N = 10^2 .. 10^6. A scene is made when first needed, outside
// the timing, and kept.
void add_for_every_scene(const std::string& subject, const Body& body);

// The same, but the body makes the scene.
using MakerBody = std::function<void(benchmark::State&, const std::function<generate::PlainScene()>& make)>;
void add_maker_for_every_scene(const std::string& subject, const MakerBody& body);

// What is measured. Each registers its benchmarks; names are SUBJECT/SCENE/N.
void add_engines();  // certified/ENGINE, visible/ENGINE; memory, meaningful only in a process of its own
void add_rays();     // rays/coherent, rays/incoherent
void add_view();     // view/loop, view/sweep

}  // namespace exactff::bench
