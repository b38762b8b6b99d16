// What finer meshes cost: the teapot with ever more triangles, and scenes of polygons beside the same cut into
// triangles. A time is that of one certified value, the mean over a grid of receivers.
#include <benchmark/benchmark.h>

#include <string>
#include <utility>
#include <vector>

#include "bench/scenes.h"
#include "bench/subjects.h"
#include "exactff/exact.h"
#include "exactff/models.h"
#include "exactff/receiver.h"
#include "exactff/scene_files.h"
#include "scene/edges.h"
#include "scene/shaft_tree.h"

namespace exactff::bench {

namespace {

// Every piece of every face as a fan of triangles.
Scene in_triangles(const Scene& scene) {
  SceneBuilder builder;
  for (const Vec3& v : scene.vertices()) builder.add_vertex(v);
  const MaterialId material = builder.add_material({});
  for (const Face& face : scene.faces()) {
    const PatchId patch = builder.patch(scene.patch(face.patch).name);
    for (std::uint32_t k = 0; k < face.piece_count; ++k) {
      const auto corners = scene.corners(scene.pieces()[face.first_piece + k]);
      for (std::size_t c = 2; c < corners.size(); ++c) {
        builder.add_face(patch, material, {{corners[0], corners[c - 1], corners[c]}});
      }
    }
  }
  return builder.build();
}

struct Grid {
  Grid(Scene made, const char* floor, const char* lamp, int side)
      : scene(std::move(made)),
        source(scene, scene.select(lamp)),
        receivers(grid_receivers(scene, scene.select(floor), {side, side})) {
    (void)shaft_tree(scene);
    (void)edges_per_silhouette(scene);  // and the edges, where they will be used
  }

  Scene scene;
  ExactSource source;
  std::vector<Receiver> receivers;
};

using Maker = Grid (*)(int);

// One iteration is one receiver after the other.
void certified(benchmark::State& state, const Grid& grid) {
  std::size_t i = 0;
  FormFactor result;
  double looked_at = 0.0, silhouettes = 0.0, edges = 0.0;
  for (auto _ : state) {
    exact_form_factor(grid.scene, grid.receivers[i], grid.source, {}, result);
    keep(result.value);
    i = (i + 1) % grid.receivers.size();
  }
  for (const Receiver& receiver : grid.receivers) {
    exact_form_factor(grid.scene, receiver, grid.source, {}, result);
    looked_at += static_cast<double>(result.planes.front().tree_edges);
    silhouettes += static_cast<double>(result.planes.front().silhouettes);
    edges += static_cast<double>(result.planes.front().edges);
  }
  const auto count = static_cast<double>(grid.receivers.size());
  state.counters["triangles"] = static_cast<double>(grid.scene.pieces().size());
  state.counters["looked_at"] = looked_at / count;
  state.counters["silhouettes"] = silhouettes / count;
  state.counters["edges"] = edges / count;
}

void add(const std::string& name, Maker make, int argument) {
  benchmark::RegisterBenchmark(name.c_str(), [make, argument](benchmark::State& state) {
    certified(state, make(argument));
  })->Unit(benchmark::kMicrosecond);
}

Grid teapot(int segments) {
  return {models::make_scene("teapot:segments=" + std::to_string(segments)), "floor", "light", 24};
}

Grid of_polygons(Scene scene, const char* lamp, int triangles) {
  return {triangles != 0 ? in_triangles(scene) : std::move(scene), "floor", lamp, 24};
}
Grid cornell(int triangles) {
  return of_polygons(read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj"), "light", triangles);
}
Grid blinds(int triangles) {
  return of_polygons(read_obj(EXACTFF_DATA_DIR "/scenes/blinds_room.obj"), "window", triangles);
}
Grid closed_room(int triangles) { return of_polygons(models::make_scene("closed-room"), "lamp", triangles); }

}  // namespace

void add_refinement() {
  for (const int segments : {4, 8, 16, 32, 64}) {
    add("refinement/teapot/" + std::to_string(segments), teapot, segments);
  }
  for (const auto& [name, make] :
       {std::pair{"cornell", &cornell}, std::pair{"blinds", &blinds}, std::pair{"closed", &closed_room}}) {
    add(std::string("refinement/") + name + "/polygons", make, 0);
    add(std::string("refinement/") + name + "/triangles", make, 1);
  }
}

}  // namespace exactff::bench
