// Sources that many occluders hide together: from scratch, and with what hid the source from a neighbour.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "bench/scenes.h"
#include "bench/subjects.h"
#include "generate/families.h"

namespace exactff::bench {

namespace {

using generate::PlainScene;

// Triangles, 50 of them on every ray to the source.
PlainScene deep(int n) { return generate::soup({.n = n, .seed = 1, .cover = 50.0}); }

// About n abutting squares that together are an eighth wider than the source looks, so that neighbours see nothing.
PlainScene wall(int n) {
  PlainScene scene = generate::tiles({.n = static_cast<int>(std::lround(std::sqrt(n)))});
  for (const generate::PlainFace& face : scene.patch("occ").faces) {
    for (const std::uint32_t corner : face.rings.front()) scene.vertices[corner].z = 0.4375;
  }
  return scene;
}

void hidden(benchmark::State& state, const BenchScene& s, bool from_scratch) {
  FormFactor result;
  Workspace workspace;
  Receiver receiver = s.receiver;
  for (auto _ : state) {
    receiver.point.x = receiver.point.x == 0.0 ? 0x1p-10 : 0.0;
    exact_form_factor(s.scene, receiver, s.source, {.from_scratch = from_scratch}, result, workspace);
    keep(result.value);
  }
  if (result.status != Status::kZero) state.SkipWithError("something is visible");
  state.counters["candidates"] = static_cast<double>(result.planes.front().candidates);
  state.counters["cover"] = static_cast<double>(result.planes.front().cover);
}

}  // namespace

void add_covers() {
  static std::map<std::string, std::unique_ptr<BenchScene>> made;
  for (const auto& [scene, make] : {std::pair{"deep", &deep}, std::pair{"wall", &wall}}) {
    for (const int n : {100, 1000, 10'000}) {
      for (const auto& [subject, from_scratch] : {std::pair{"scratch", true}, std::pair{"neighbour", false}}) {
        const std::string name = std::string(scene) + '/' + std::to_string(n);
        const auto run = [name, make = make, n, from_scratch = from_scratch](benchmark::State& state) {
          std::unique_ptr<BenchScene>& known = made[name];
          if (!known) known = std::make_unique<BenchScene>(make(n));
          hidden(state, *known, from_scratch);
        };
        benchmark::RegisterBenchmark((std::string("covers/") + subject + '/' + name).c_str(), run)
            ->Unit(benchmark::kMicrosecond);
      }
    }
  }
}

}  // namespace exactff::bench
