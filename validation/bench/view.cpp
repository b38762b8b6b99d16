// The whole view against a loop over all sources: Karkanis' triangles, and a closed room of quadrilaterals.
#include "exactff/view.h"

#include <benchmark/benchmark.h>

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/scenes.h"
#include "exactff/models.h"
#include "generate/plain_scene.h"

namespace exactff::bench {

namespace {

// Every face is a source.
struct ViewScene {
  explicit ViewScene(Scene made, Receiver seen_from) : scene(std::move(made)), receiver(std::move(seen_from)) {
    for (std::uint32_t k = 0; k < scene.faces().size(); ++k) {
      const Selection face{.patch = scene.faces()[k].patch, .face = FaceId{k}, .scene = scene.id()};
      if (scene.faces()[k].piece_count > 0) sources.emplace_back(scene, face);
    }
  }

  Scene scene;
  Receiver receiver;
  std::deque<ExactSource> sources;
};

std::unique_ptr<ViewScene> karkanis(int n, int cover) {
  return std::make_unique<ViewScene>(
      models::make_scene("karkanis:floor=0,n=" + std::to_string(n) + ",cover=" + std::to_string(cover)),
      Receiver{.point = {0, 0, 0}, .normal = {0, 0, 1}, .on = {}, .id = {}});
}

// A closed room of 2m x 2m x m cells, seen from inside.
std::unique_ptr<ViewScene> closed_room(int m) {
  generate::PlainScene plain;
  generate::PlainPatch& walls = plain.patch("walls");
  const auto add_wall = [&](const Vec3& corner, const Vec3& u, int count_u, const Vec3& v, int count_v) {
    const auto at = [&](int i, int j) {
      return Vec3{corner.x + i * u.x + j * v.x, corner.y + i * u.y + j * v.y, corner.z + i * u.z + j * v.z};
    };
    for (int i = 0; i < count_u; ++i) {
      for (int j = 0; j < count_v; ++j) {
        plain.add_ring(walls, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  };
  const double w = 2.0 * m, h = m;
  const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  add_wall({0, 0, 0}, x, 2 * m, y, 2 * m);
  add_wall({0, 0, h}, y, 2 * m, x, 2 * m);
  add_wall({0, 0, 0}, z, m, x, 2 * m);
  add_wall({0, w, 0}, x, 2 * m, z, m);
  add_wall({0, 0, 0}, y, 2 * m, z, m);
  add_wall({w, 0, 0}, z, m, y, 2 * m);
  return std::make_unique<ViewScene>(
      generate::build(plain),
      Receiver{.point = {0.37 * w, 0.59 * w, 0.43 * h}, .normal = {0.3, -0.2, 1}, .on = {}, .id = {}});
}

using Maker = std::function<std::unique_ptr<ViewScene>()>;

void loop(benchmark::State& state, const ViewScene& s) {
  Workspace workspace;
  FormFactor result;
  for (auto _ : state) {
    for (const ExactSource& source : s.sources) {
      exact_form_factor(s.scene, s.receiver, source, {}, result, workspace);
      keep(result.value);
    }
  }
}

void sweep(benchmark::State& state, const ViewScene& s) {
  ViewWorkspace workspace;
  WholeView result;
  for (auto _ : state) {
    view(s.scene, s.receiver, {.faces = true}, result, workspace);
    keep(result.open.value);
  }
  state.counters["seen"] = static_cast<double>(result.patches.size());
}

void add(const std::string& scene, const Maker& make) {
  const auto made = std::make_shared<std::unique_ptr<ViewScene>>();
  for (const auto& [subject, run] : {std::pair{"loop", &loop}, std::pair{"sweep", &sweep}}) {
    benchmark::RegisterBenchmark((std::string("view/") + subject + '/' + scene).c_str(), [=, run = run](
                                                                                             benchmark::State& state) {
      if (!*made) *made = make();
      run(state, **made);
    })->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace

void add_view() {
  add("karkanis/500", [] { return karkanis(500, 1); });
  add("karkanis/10000", [] { return karkanis(10'000, 1); });
  add("covered/10000", [] { return karkanis(10'000, 20); });
  add("room/1600", [] { return closed_room(10); });
}

}  // namespace exactff::bench
