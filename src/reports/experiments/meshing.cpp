// One radiosity for each cell (experiments.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>

#include "exactff/matrix.h"
#include "exactff/radiosity.h"
#include "experiments/experiments.h"
#include "files/parallel.h"
#include "kernel/statistics.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::experiments {
namespace {

using table::counts;
using table::keys;
using table::texts;
using table::Type;

// A slope with two decimals and a true minus sign.
std::string slope_text(double slope) {
  const long hundredths = std::lround(std::abs(slope) * 100.0);
  const std::string digits = std::to_string(100 + hundredths % 100).substr(1);
  return (slope < 0.0 && hundredths > 0 ? "−" : "") + std::to_string(hundredths / 100) + '.' + digits;
}

// "1.5 %"
std::string percent(double share) { return text::rounded(100.0 * share, 2) + " %"; }

using text::counted;
using text::rounded;

constexpr double kNoError = std::numeric_limits<double>::quiet_NaN();

// --- the scene ---

struct BoxFace {
  const char *patch, *material;
  std::vector<std::uint32_t> corners;
};

// As in the file, line by line.
std::vector<BoxFace> box_faces() {
  return {{"floor", "white", {0, 1, 2, 3}},
          {"ceiling", "white", {4, 5, 9, 8}},
          {"ceiling", "white", {5, 6, 10, 9}},
          {"ceiling", "white", {6, 7, 11, 10}},
          {"ceiling", "white", {7, 4, 8, 11}},
          {"light", "light", {8, 9, 10, 11}},
          {"back", "white", {3, 2, 6, 5}},
          {"right", "green", {2, 1, 7, 6}},
          {"left", "red", {0, 3, 5}},
          {"left", "red", {0, 5, 4}},
          {"short_block", "white", {12, 13, 14, 15}},
          {"short_block", "white", {15, 19, 16, 12}},
          {"short_block", "white", {12, 16, 17, 13}},
          {"short_block", "white", {13, 17, 18, 14}},
          {"short_block", "white", {14, 18, 19, 15}},
          {"tall_block", "white", {20, 21, 22, 23}},
          {"tall_block", "white", {20, 24, 25, 21}},
          {"tall_block", "white", {21, 25, 26, 22}},
          {"tall_block", "white", {22, 26, 27, 23}},
          {"tall_block", "white", {23, 27, 24, 20}}};
}

constexpr std::array<Vec3, 28> kBoxCorners = {
    {{552.8, 0, 0},     {0, 0, 0},      {0, 0, 559.2},     {549.6, 0, 559.2}, {556, 548.8, 0},   {556, 548.8, 559.2},
     {0, 548.8, 559.2}, {0, 548.8, 0},  {343, 548.8, 227}, {343, 548.8, 332}, {213, 548.8, 332}, {213, 548.8, 227},
     {130, 165, 65},    {82, 165, 225}, {240, 165, 272},   {290, 165, 114},   {130, 0, 65},      {82, 0, 225},
     {240, 0, 272},     {290, 0, 114},  {423, 330, 247},   {265, 330, 296},   {314, 330, 456},   {472, 330, 406},
     {423, 0, 247},     {265, 0, 296},  {314, 0, 456},     {472, 0, 406}}};

double longest_side(const Scene& scene) {
  Vec3 low = scene.vertices().front(), high = low;
  for (const Vec3& v : scene.vertices()) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

// --- pictures ---

double processor_seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / static_cast<double>(CLOCKS_PER_SEC);
}

radiosity::Solution solution_of(const Scene& scene, const MeshingSize& size, int threads, const Hooks& hooks) {
  const ViewFactorOptions factors{.accuracy = size.accuracy, .budget = size.budget};
  return radiosity::solve(scene, {.factors = factors, .threads = threads}, hooks);
}

render::View view_of(const MeshingScene& place, const MeshingSize& size) {
  return {place.camera, {size.pixels, size.pixels}};
}

struct LevelPicture {
  MeshingLevel level;
  render::Picture picture;
};

LevelPicture level_picture(const MeshingScene& place, const MeshingSize& size, int parts, int threads,
                           const Hooks& hooks) {
  files::require_not_cancelled(hooks);
  const Scene cells = divided(place.scene, longest_side(place.scene) / parts).scene;
  const std::clock_t start = std::clock();
  const radiosity::Solution solution = solution_of(cells, size, threads, hooks);
  MeshingLevel level{.parts = parts, .cells = solution.patches.size()};
  level.matrix_seconds = processor_seconds_since(start);
  render::Request request{.scene = &cells, .view = view_of(place, size), .radiosities = radiosities_of(solution)};
  request.quantity = Quantity::kRadiosity;
  request.bounds = render::Bounds::kAll;
  request.threads = threads;
  render::Picture picture = render::render(request, hooks);
  level.image_seconds = picture.seconds;
  return {std::move(level), std::move(picture)};
}

// The patch that each pixel's ray meets from the front, if it does not emit; else their number.
std::vector<std::size_t> patches_in(const MeshingScene& place, const MeshingSize& size) {
  const Scene& scene = place.scene;
  const render::View view = view_of(place, size);
  std::vector<std::size_t> result;
  for (int row = 0; row < size.pixels; ++row) {
    for (int column = 0; column < size.pixels; ++column) {
      const std::optional<render::Hit> hit = render::first_hit(scene, view.ray(column + 0.5, row + 0.5));
      const bool counts = hit && !hit->back && !scene.material(scene.face(hit->face).material).emits();
      result.push_back(counts ? index_of(scene.face(hit->face).patch) : scene.patches().size());
    }
  }
  return result;
}

// --- errors ---

double brightest_of(const render::Picture& picture, const std::vector<std::size_t>& patch_of_pixel,
                    std::size_t patches) {
  double brightest = 0.0;
  for (std::size_t i = 0; i < patch_of_pixel.size(); ++i) {
    if (patch_of_pixel[i] == patches) continue;
    for (std::size_t c = 0; c < 3; ++c) brightest = std::max(brightest, picture.values[3 * i + c]);
  }
  return brightest;
}

double half_width_of(const render::Picture& picture, const std::vector<std::size_t>& patch_of_pixel,
                     std::size_t patches) {
  std::vector<double> halves;
  for (std::size_t i = 0; i < patch_of_pixel.size(); ++i) {
    if (patch_of_pixel[i] == patches) continue;
    double largest = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      largest = std::max(largest, 0.5 * (picture.upper[3 * i + c] - picture.lower[3 * i + c]));
    }
    halves.push_back(largest);
  }
  return study::error_statistics(halves).rms;
}

// Of the pixels for which the predicate holds.
template <class Counts>
MeshingErrors errors_where(const Counts& counts, const std::vector<double>& errors, const render::Picture& judged,
                           const render::Picture& reference) {
  std::vector<double> counted_errors;
  double sum = 0.0, expected = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!counts(i)) continue;
    counted_errors.push_back(errors[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      sum += judged.values[3 * i + c];
      expected += reference.values[3 * i + c];
    }
  }
  if (counted_errors.empty()) return {};
  const study::ErrorStatistics found = study::error_statistics(counted_errors);
  return {.pixels = counted_errors.size(),
          .mean_ratio = expected > 0.0 ? sum / expected : 1.0,
          .rms = found.rms,
          .p99 = found.p99,
          .worst = found.worst};
}

double share_of_worst_tenth(const std::vector<double>& errors) {
  std::vector<double> squares;
  for (const double e : errors) {
    if (!std::isnan(e)) squares.push_back(e * e);
  }
  std::ranges::sort(squares, std::greater<>());
  double tenth = 0.0, sum = 0.0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (10 * i < squares.size()) tenth += squares[i];
    sum += squares[i];
  }
  return sum > 0.0 ? tenth / sum : 0.0;
}

void set_errors(MeshingLevel& level, const render::Picture& judged, const render::Picture& reference,
                const MeshingStudy& study, double brightest) {
  const std::vector<double> errors = render::errors_of(judged, reference).signed_errors;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const bool counts = study.patch_of_pixel[i] < study.patches.size();
    level.errors.push_back(counts ? errors[i] / brightest : kNoError);
  }
  level.all = errors_where([&](std::size_t i) { return study.patch_of_pixel[i] < study.patches.size(); }, level.errors,
                           judged, reference);
  for (std::size_t p = 0; p < study.patches.size(); ++p) {
    level.patches.push_back(
        errors_where([&](std::size_t i) { return study.patch_of_pixel[i] == p; }, level.errors, judged, reference));
  }
  level.share_of_worst_tenth = share_of_worst_tenth(level.errors);
}

// --- what is told ---

std::string fraction(int parts) { return parts == 1 ? "1" : "1/" + std::to_string(parts); }

std::string meshing_verdict(const MeshingStudy& study) {
  std::vector<std::string> found;
  for (const MeshingLevel& level : study.levels) {
    found.push_back("by " + percent(level.all.rms) + " with cells of " + fraction(level.parts) + " of the box (" +
                    std::to_string(level.cells) + " cells)");
  }
  return "One radiosity for each cell makes the picture of all light wrong, measured by its brightest pixel (RMS), " +
         text::enumerate(found) + '.';
}

std::string slope_sentence(const MeshingStudy& study) {
  if (!study.slope) return {};
  return "The error falls with the size of the cells to the power " + slope_text(*study.slope) +
         ": cells half as long "
         "have " +
         rounded(std::exp2(-*study.slope), 2) + " times the error.";
}

std::string method_sentence(const MeshingStudy& study, const MeshingSize& size) {
  return "Every picture has " + std::to_string(size.pixels) + " × " + std::to_string(size.pixels) +
         " pixels and is compared with that of " + counted(study.reference.cells, "cell") + " of " +
         fraction(study.reference.parts) +
         " of the box, which has an error of its own: what is left there is not "
         "counted, so errors of cells hardly larger are too small. " +
         counted(study.levels.front().all.pixels, "pixel") +
         " count, those that show a surface that does not emit. All gather light by exact form factors at their "
         "points. The radiosities come from view factors of accuracy " +
         rounded(size.accuracy) + " with at most " + std::to_string(size.budget) +
         " cells each. Their bounds leave the reference within ±" + percent(study.reference.half_width) +
         " (RMS); the values, of which these errors are, are much closer.";
}

std::string place_sentence(const MeshingStudy& study) {
  const MeshingLevel& level = study.levels.back();
  std::size_t worst = 0;
  for (std::size_t p = 1; p < study.patches.size(); ++p) {
    if (level.patches[p].rms > level.patches[worst].rms) worst = p;
  }
  return "Of cells of " + fraction(level.parts) + " of the box, the tenth of the pixels with the largest errors has " +
         percent(level.share_of_worst_tenth) + " of the squared error. The RMS error is largest on '" +
         study.patches[worst] + "', " + percent(level.patches[worst].rms) +
         ". Errors sit along edges where surfaces meet, and where a block stands before another surface: there a "
         "near cell gives most of the light, and its own light varies most.";
}

NumberTable meshing_table(const MeshingStudy& study) {
  NumberTable table{"Errors over the brightest pixel, and means over those of the reference",
                    {"surface", "cells", "pixels", "mean", "RMS", "99 %", "worst"},
                    {}};
  const auto add = [&](const std::string& name, const MeshingLevel& level, const MeshingErrors& errors) {
    if (errors.pixels == 0) return;
    table.rows.push_back({name, fraction(level.parts), std::to_string(errors.pixels), rounded(errors.mean_ratio, 4),
                          percent(errors.rms), percent(errors.p99), percent(errors.worst)});
  };
  for (const MeshingLevel& level : study.levels) add("all", level, level.all);
  for (std::size_t p = 0; p < study.patches.size(); ++p) {
    for (const MeshingLevel& level : study.levels) add(study.patches[p], level, level.patches[p]);
  }
  return table;
}

page::Figure meshing_figure(const MeshingStudy& study) {
  Series rms{"RMS", {}, 1}, p99{"99 % of the pixels", {}, 2}, worst{"worst", {}, 3};
  Series first{"size", {}, 0}, second{"size²", {}, 0};
  for (const MeshingLevel& level : study.levels) {
    const double at = 1.0 / level.parts, against = at * study.levels.back().parts;
    rms.points.emplace_back(at, level.all.rms);
    p99.points.emplace_back(at, level.all.p99);
    worst.points.emplace_back(at, level.all.worst);
    first.points.emplace_back(at, study.levels.back().all.rms * against);
    second.points.emplace_back(at, study.levels.back().all.rms * against * against);
  }
  return {
      "meshing.error", "Error of the picture against the size of cells",
      "Error over the brightest pixel, against the longest side of cells over that of the box. Dashed: the first and "
      "the second power of the size.",
      page::line_plot(Axes{.x = "size of cells / size of the box", .y = "error / brightest pixel"},
                      {rms, p99, worst, first, second})};
}

page::Figure error_map(const MeshingLevel& level, const MeshingSize& size) {
  page::Map map;
  map.quantity = "error / brightest pixel";
  map.columns = map.rows = size.pixels;
  map.colours = page::MapColours::kDiverging;
  map.width = map.height = size.pixels;
  map.x = "column";
  map.y = "row, from below";
  map.largest = level.all.p99 > 0.0 ? level.all.p99 : 1.0;
  for (std::size_t i = 0; i < level.errors.size(); ++i) {
    if (std::isnan(level.errors[i])) continue;
    const int pixel = static_cast<int>(i);
    map.cells.push_back({pixel % size.pixels + 1, size.pixels - pixel / size.pixels, level.errors[i]});
  }
  return {"meshing.map-" + std::to_string(level.parts), "Where cells of " + fraction(level.parts) + " of the box err",
          "The picture, pixel by pixel. Red: too bright; blue: too dark. Errors beyond ±" + rounded(map.largest) +
              " (the 99th percentile) have the colour of that value.",
          page::map_plot(map)};
}

CsvFile meshing_values(const MeshingStudy& study) {
  table::Rows rows =
      rows_of("meshing",
              "errors of pictures from cells of one radiosity against that of the finest cells, over its brightest "
              "pixel; half_width: of the bounds of a pixel, RMS",
              {keys("parts", Type::kCount), counts("cells"), keys("patch"), counts("pixels"),
               estimates("mean_ratio,rms,p99,worst,half_width")});
  const auto add = [&](const MeshingLevel& level, const std::string& patch, const MeshingErrors& e) {
    if (e.pixels == 0) return;
    rows << level.parts << level.cells << patch << e.pixels << e.mean_ratio << e.rms << e.p99 << e.worst
         << level.half_width;
  };
  for (const MeshingLevel& level : study.levels) {
    add(level, "all", level.all);
    for (std::size_t p = 0; p < study.patches.size(); ++p) add(level, study.patches[p], level.patches[p]);
  }
  return csv_file(std::move(rows), "meshing.csv", "errors of gathered pictures by the size of cells and by surface");
}

CsvFile meshing_map_values(const MeshingStudy& study, const MeshingSize& size) {
  table::Rows rows = rows_of(
      "meshing", "errors of pictures from cells of one radiosity, pixel by pixel from the top left, over the brightest",
      {keys("parts,column,row", Type::kCount), texts("patch"), estimates("error")});
  const auto pixels = static_cast<std::size_t>(size.pixels);
  for (const MeshingLevel& level : study.levels) {
    for (std::size_t i = 0; i < level.errors.size(); ++i) {
      if (std::isnan(level.errors[i])) continue;
      rows << level.parts << i % pixels << i / pixels << study.patches[study.patch_of_pixel[i]] << level.errors[i];
    }
  }
  return csv_file(std::move(rows), "meshing-map.csv", "errors of gathered pictures by pixel");
}

CsvFile meshing_times(const MeshingStudy& study) {
  table::Rows rows =
      rows_of("meshing", "processor seconds of the radiosities, and of the picture",
              {keys("parts", Type::kCount), counts("cells"), estimates("matrix_seconds,image_seconds", "s")});
  const auto add = [&](const MeshingLevel& level) {
    rows << level.parts << level.cells << level.matrix_seconds << level.image_seconds;
  };
  std::ranges::for_each(study.levels, add);
  add(study.reference);
  return csv_file(std::move(rows), "meshing-times.csv", "processor time by the size of cells");
}

}  // namespace

MeshingScene cornell_box() {
  SceneBuilder builder;
  for (const Vec3& corner : kBoxCorners) builder.add_vertex(corner);
  const std::vector<Material> materials = {
      {.name = "white", .reflectance = {0.725, 0.71, 0.68}},
      {.name = "light", .reflectance = {0.0, 0.0, 0.0}, .radiosity = {17.0, 12.0, 4.0}},
      {.name = "green", .reflectance = {0.14, 0.45, 0.091}},
      {.name = "red", .reflectance = {0.63, 0.065, 0.05}}};  // in the order of their use
  std::vector<MaterialId> ids;
  for (const Material& material : materials) ids.push_back(builder.add_material(material));
  for (const BoxFace& face : box_faces()) {
    const auto place = std::ranges::find(materials, face.material, &Material::name);
    builder.add_face(builder.patch(face.patch), ids[static_cast<std::size_t>(place - materials.begin())],
                     {face.corners});
  }
  return {builder.build(), {.eye = {278, 273, -800}, .look = {278, 273, 0}, .fov = 39.30764811610662}};
}

MeshingStudy meshing_study(const MeshingScene& place, const MeshingSize& size, int threads, const Hooks& hooks) {
  MeshingStudy study;
  for (const Patch& patch : place.scene.patches()) study.patches.push_back(patch.name);
  study.patch_of_pixel = patches_in(place, size);
  std::vector<LevelPicture> all;
  for (const int parts : size.parts) all.push_back(level_picture(place, size, parts, threads, hooks));
  const render::Picture& reference = all.back().picture;
  const double brightest = brightest_of(reference, study.patch_of_pixel, study.patches.size());
  Points points;
  for (LevelPicture& one : all) {
    one.level.half_width = half_width_of(one.picture, study.patch_of_pixel, study.patches.size()) / brightest;
    if (&one == &all.back()) break;
    set_errors(one.level, one.picture, reference, study, brightest);
    points.emplace_back(1.0 / one.level.parts, one.level.all.rms);
    study.levels.push_back(std::move(one.level));
  }
  study.reference = std::move(all.back().level);
  study.slope = kernel::fitted_slope(points);
  return study;
}

Result meshing(const MeshingScene& place, const MeshingSize& size, int threads, const Hooks& hooks) {
  const MeshingStudy study = meshing_study(place, size, threads, hooks);
  std::vector<page::Figure> figures{meshing_figure(study)};
  for (auto level = study.levels.rbegin(); level != study.levels.rend(); ++level) {
    figures.push_back(error_map(*level, size));
  }
  std::vector<std::string> paragraphs{meshing_verdict(study), slope_sentence(study), place_sentence(study),
                                      method_sentence(study, size)};
  std::erase(paragraphs, "");
  return {.name = "meshing",
          .title = "One radiosity for each cell",
          .paragraphs = std::move(paragraphs),
          .tables = {meshing_table(study)},
          .figures = std::move(figures),
          .values = {meshing_values(study), meshing_map_values(study, size)},
          .times = {meshing_times(study)}};
}

Result meshing(const Effort& effort, const Hooks& hooks) {
  MeshingSize size;
  if (effort.abridged) size = {.parts = {1, 2}, .pixels = 24, .budget = 20};
  return meshing(cornell_box(), size, effort.threads, hooks);
}

Result fine_meshing(const Effort& effort, const Hooks& hooks) {
  MeshingSize size;
  size.parts = effort.abridged ? std::vector{1, 2, 4} : std::vector{2, 3, 4, 8, 16};
  Result result = meshing(cornell_box(), size, effort.threads, hooks);
  result.name = "meshing-fine";
  return result;
}

}  // namespace exactff::experiments
