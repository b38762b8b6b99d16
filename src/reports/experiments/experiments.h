// The experiments of the report that do not concern one scene with its grid of receivers: they repeat what Karkanis
// measured or claimed, with exact values, or measure what only exact values can.
//
// An experiment is one source file, its functions here and one line of the list in experiments.cpp. It generates its
// scenes from fixed seeds and returns sentences, figures and tables. Tables of values are the same bytes on every run
// and for any number of threads. Results that depend on the clock are in tables of times and in sentences.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/methods.h"
#include "exactff/render.h"
#include "exactff/study.h"
#include "page/chapter.h"
#include "page/gnuplot.h"
#include "table/rows.h"

namespace exactff::experiments {

using page::Axes;
using page::CsvFile;
using page::NumberTable;
using page::Points;
using page::Series;
using Result = page::Chapter;

struct Effort {
  bool abridged = false;  // a first look: coarser grids, fewer settings and receivers, experiments of some seconds
  int threads = 0;        // 0: as many as this process may use; values do not depend on it, times are those of one
};

struct Experiment {
  std::string_view name;  // letters, digits and hyphens
  Result (*run)(const Effort&, const Hooks&) = nullptr;
  bool by_name_only = false;  // "all" leaves it out: it takes long
};

// In the order of the report.
[[nodiscard]] std::span<const Experiment> all_experiments();

// Throws an InputError that names the closest existing names.
[[nodiscard]] const Experiment& experiment_named(std::string_view name);

// --- shared by several experiments ---

// `experiment`: its name. `about`: what the rows are.
[[nodiscard]] table::Rows rows_of(std::string_view experiment, std::string about,
                                  std::initializer_list<table::Columns> columns);
[[nodiscard]] CsvFile csv_file(table::Rows rows, std::string file, std::string holds);
// Columns of results.
[[nodiscard]] table::Columns estimates(std::string_view names, std::string unit = {});

// --- hemicube-scatter ---
//
// Karkanis' two plots. For every triangle of scenes like his: the hemicube's form factor against the exact one, and the
// hemicube's absolute error divided by the exact value, against the exact value.
//
// A triangle that the hemicube misses has no place on a logarithmic axis. Such triangles are counted and drawn
// separately.

struct ScatterSize {
  int scenes = 10;  // seeds 1, 2, ...
  int triangles = 200;
  std::vector<int> resolutions = {100, 200, 400};  // the first one is drawn
};

struct ScatterPoint {
  int scene = 1;
  int triangle = 1;
  double exact = 0.0;
  std::vector<double> hemicube;  // indexed by resolution
};

// Every triangle of every scene, including hidden ones.
[[nodiscard]] std::vector<ScatterPoint> scatter_points(const ScatterSize& size, int threads, const Hooks& hooks);

[[nodiscard]] Result hemicube_scatter(const ScatterSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result hemicube_scatter(const Effort& effort, const Hooks& hooks);

// --- karkanis-times ---
//
// Karkanis' timings: the time for all patches seen from one point, against the number of patches.
//
// For 50, 100, 200 and 500 triangles he measured 0.2 s, 2.8 s, 300 s and about 8 h on a 300 MHz Pentium II, in floating
// point. Here every triangle of such a scene is the source in turn, and its form factor is certified, with and without
// the shaft that excludes most of the other triangles.

struct TimesSize {
  std::vector<int> triangles = {50, 100, 200, 500, 1000, 2000, 5000, 10000};
  int same_bits_up_to = 500;  // triangles: up to here, values with and without the shaft are compared
  double budget = 20.0;       // seconds; a measurement without the shaft that would take longer is left out
};

// Results that are the same on every run.
struct WorkRow {
  int triangles = 0;
  std::size_t visible = 0;
  double sum = 0.0;                                     // of the form factors
  std::uint64_t looked_at = 0;                          // pairs of a source and a face that the shaft's tree leaves
  std::optional<std::uint64_t> looked_at_without = {};  // the same without the shaft, if compared
  std::optional<std::size_t> differences = {};          // values that differ without the shaft, if compared
};
[[nodiscard]] WorkRow work_row(int triangles, bool compare);

// ln(t1 / t0) / ln(n1 / n0)
[[nodiscard]] double local_exponent(int n0, double t0, int n1, double t1);

[[nodiscard]] Result karkanis_times(const TimesSize& size, const Hooks& hooks);
[[nodiscard]] Result karkanis_times(const Effort& effort, const Hooks& hooks);

// --- meshing ---
//
// How good is one radiosity per patch? The Cornell box is cut into ever smaller cells, each with one radiosity after
// all bounces, and a picture gathers these by exact form factors (exactff render --radiosity). Its pixels are compared
// with those from the finest cells: how large is the error, how fast does it fall, and where does it sit?
//
// The direct light is the same in all pictures, since a lamp has one radiosity. What differs is the light that a cell
// reflects: it varies over the cell, and its mean stands for all of it.

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
[[nodiscard]] Result fine_meshing(const Effort& effort, const Hooks& hooks);  // down to 1 / 16

}  // namespace exactff::experiments
