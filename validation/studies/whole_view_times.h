// Karkanis' question in one sweep: all that is seen from one point, as exact regions with their form factors.
//
// His triangles, all before one square source and, in a second kind of scene, spread around the point; the teapot, a
// forest and a closed room from points on their floors. Each time is that of one whole view.
#pragma once

#include "experiments/experiments.h"

namespace exactff::experiments {

struct WholeViewSize {
  std::vector<int> triangles = {50, 100, 200, 500, 1000, 2000, 5000, 10'000, 20'000, 50'000, 100'000};
  struct Model {
    std::string name;
    std::string on;  // the patch that the points lie on
  };
  std::vector<Model> models = {
      {"teapot:segments=16", "floor"}, {"forest:n=10000", "ground"}, {"closed-room:boxes=30", "ceiling"}};
  std::uint64_t points = 16;  // in each of the models
};

// Results that are the same on every run.
struct WholeViewRow {
  std::string scene;
  std::size_t faces = 0;
  std::size_t seen = 0;    // faces, or of several points the sum
  std::uint64_t arcs = 0;  // edges of the view, in parts
  double open = 0.0;       // the share that meets nothing, on average
  bool holds_one = true;   // the balls of all shares together contain 1
  double seconds = 0.0;    // not the same on every run
};
[[nodiscard]] std::vector<WholeViewRow> whole_view_rows(const WholeViewSize& size, const Hooks& hooks);

[[nodiscard]] Result whole_view_times(const WholeViewSize& size, const Hooks& hooks);
[[nodiscard]] Result whole_view_times(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
