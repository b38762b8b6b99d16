// The scenes that are timed: a receiver, a square source and n occluders between them.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <optional>
#include <string>

#include "exactff/exact.h"
#include "generate/plain_scene.h"

namespace exactff::bench {

// Ready to be asked: the bounding-volume tree, which a scene makes once, is there.
struct BenchScene {
  explicit BenchScene(const generate::PlainScene& plain);

  // What a measurement must come out at, computed when first asked for.
  [[nodiscard]] double value() const;
  [[nodiscard]] double visible_fraction() const;

  Scene scene;
  ExactSource source;
  Receiver receiver;

 private:
  mutable std::optional<double> value_, visible_fraction_;
};

// Computes the value, whatever becomes of it. (DoNotOptimize of something that may change spoils doubles with GCC 12.)
template <class Value>
void keep(const Value& value) {
  benchmark::DoNotOptimize(value);
}

using Body = std::function<void(benchmark::State&, const BenchScene&)>;

// Registers SUBJECT/SCENE/N for every kind of scene and N = 10^2 .. 10^6. A scene is made when first needed, outside
// the timing, and kept.
void add_for_every_scene(const std::string& subject, const Body& body);

// The same, but the scene is made afresh and left to the body.
using MakerBody = std::function<void(benchmark::State&, const std::function<generate::PlainScene()>& make)>;
void add_maker_for_every_scene(const std::string& subject, const MakerBody& body);

}  // namespace exactff::bench
