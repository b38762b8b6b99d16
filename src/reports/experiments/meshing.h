// How good is one radiosity per patch? The Cornell box is cut into ever smaller cells, each with one radiosity after
// all bounces, and a picture gathers these by exact form factors (exactff render --radiosity). Its pixels are compared
// with those from the finest cells: how large is the error, how fast does it fall, and where does it sit?
//
// The direct light is the same in all pictures, since a lamp has one radiosity. What differs is the light that a cell
// reflects: it varies over the cell, and its mean stands for all of it.
#pragma once

#include <optional>

#include "exactff/render.h"
#include "experiments/support.h"

namespace exactff::experiments {

struct MeshingSize {
  std::vector<int> parts = {2, 3, 4, 8};  // cells of 1 / 2, ... of the box's longest side; the last is the reference
  int pixels = 64;                        // on a side of the picture
  double accuracy = 1e-3;                 // of view factors
  std::size_t budget = 100;               // cells or points of one
};

struct MeshingScene {
  Scene scene;
  render::Camera camera;
};
// That of data/scenes/cornell_box.obj, and its published camera.
[[nodiscard]] MeshingScene cornell_box();

// Errors over the brightest pixel of the reference.
struct MeshingErrors {
  std::size_t pixels = 0;
  double mean_ratio = 0.0;  // of the sums of all pixels and channels
  double rms = 0.0, p99 = 0.0, worst = 0.0;
};
struct MeshingLevel {
  int parts = 0;
  std::size_t cells = 0;
  double half_width = 0.0;  // between the bounds of a pixel, RMS, over the brightest
  MeshingErrors all = {};
  std::vector<MeshingErrors> patches = {};           // of the scene
  std::vector<double> errors = {};                   // by pixel; NaN where none is compared
  double share_of_worst_tenth = 0.0;                 // of the squared errors
  double matrix_seconds = 0.0, image_seconds = 0.0;  // processor time
};
struct MeshingStudy {
  std::vector<std::string> patches;
  std::vector<std::size_t> patch_of_pixel;  // index in patches; of pixels that are not compared their number
  std::vector<MeshingLevel> levels;         // without the reference
  MeshingLevel reference;                   // without errors
  std::optional<double> slope;              // of the RMS error against the cells' size
};
[[nodiscard]] MeshingStudy meshing_study(const MeshingScene& place, const MeshingSize& size, int threads,
                                         const Hooks& hooks);

[[nodiscard]] Result meshing(const MeshingScene& place, const MeshingSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result meshing(const Effort& effort, const Hooks& hooks);
// Down to 1 / 16: hours.
[[nodiscard]] Result fine_meshing(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
