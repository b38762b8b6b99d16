#include "studies/view_factors.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernel/vec.h"
#include "studies/small_scene.h"
#include "text/phrases.h"

namespace exactff::experiments {

namespace {

using kernel::sum;
using text::counted;
using text::rounded;

void add_parallelogram(SmallScene& scene, const std::string& name, const Vec3& o, const Vec3& u, const Vec3& v) {
  scene.add(name, {o, sum(o, u), sum(sum(o, u), v), sum(o, v)});
}

// The sides of a parallelepiped with right-handed edges, in opposite pairs, fronts outward, or inward.
void add_sides(SmallScene& scene, const std::array<std::string, 6>& names, const Vec3& o,
               const std::array<Vec3, 3>& edges, bool inward) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = edges[i], &b = edges[(i + 1) % 3], &c = edges[(i + 2) % 3];
    add_parallelogram(scene, names[2 * i], o, inward ? b : c, inward ? c : b);
    add_parallelogram(scene, names[2 * i + 1], sum(o, a), inward ? c : b, inward ? b : c);
  }
}

WidthCurve width_curve(const std::string& name, const Scene& scene, const char* from, const char* to, bool certify,
                       const ViewFactorSize& size, const Hooks& hooks) {
  WidthCurve curve{name, certify ? Claim::kCertified : Claim::kEstimated, {}};
  const Selection i = scene.select(from), j = scene.select(to);
  for (const double accuracy : size.accuracies) {
    const ViewFactorOptions options{.accuracy = accuracy, .sample_crowds = false, .certify = certify};
    ViewFactor f;
    const double seconds = median_seconds([&] {
      f = matrix::compute(scene, {&i, 1}, {&j, 1}, {.factors = options, .threads = 1}, hooks).factors.entries.front();
    });
    curve.places.push_back({accuracy, f.upper - f.lower, seconds, f.cells});
  }
  return curve;
}

// ---------------------------------------------------------------------------------------------------------- sentences

std::string sums_sentence(const ViewFactorStudy& study) {
  const auto hold = static_cast<std::size_t>(
      std::ranges::count_if(study.sums, [](const matrix::Sum& s) { return s.lower <= 1.0 && s.upper >= 1.0; }));
  double widest = 0.0;
  for (const matrix::Sum& sum : study.sums) widest = std::max(widest, sum.upper - sum.lower);
  return "In a closed room with a tilted cube, the sum 1 that a row must have lies inside the bounds of " +
         text::counted_of(hold, study.sums.size(), "row") + ". They are at most " + rounded(widest, 2) + " wide.";
}

std::string claims_sentence(const ViewFactorStudy& study, const ViewFactorSize& size) {
  std::vector<std::string> parts;
  for (const Claim claim : {Claim::kZero, Claim::kCertified, Claim::kEstimated}) {
    const auto count = std::ranges::count(study.matrix.entries, claim, &ViewFactor::claim);
    if (count > 0) parts.push_back(std::to_string(count) + ' ' + std::string(to_string(claim)));
  }
  return "Of its entries, at an accuracy of " + accuracy_text(size.accuracy) + " and with " +
         std::to_string(size.budget) + " cells at most, " + text::enumerate(parts) + '.';
}

// ------------------------------------------------------------------------------------------------------------ figures

page::Figure width_figure(const ViewFactorStudy& study) {
  std::vector<page::Series> series;
  for (const WidthCurve& curve : study.curves) {
    page::Series one{curve.name + ", " + std::string(to_string(curve.claim)), {}, static_cast<int>(series.size()) + 1};
    for (const WidthAtAccuracy& place : curve.places) one.points.emplace_back(place.seconds, place.width);
    series.push_back(one);
  }
  return {"view-factors.widths", "Width of an entry against time",
          "One mark for each accuracy asked for. Time on one thread, which depends on the machine.",
          page::line_plot({.x = "seconds", .y = "upper − lower"}, series)};
}

// In the order of Claim.
constexpr const char* kShortClaims[] = {"estimated", "certified", "zero"};

// Only the claims that are made, so that their names have room.
page::Figure claim_figure(const ViewFactorStudy& study) {
  page::Map map;
  map.quantity = "claim";
  map.columns = map.rows = static_cast<int>(study.patches.size());
  map.width = map.height = static_cast<double>(study.patches.size());
  map.colours = page::MapColours::kClasses;
  map.x = "to patch";
  map.y = "from patch, the first at the top";
  std::array<double, std::size(kShortClaims)> number{};
  for (std::size_t c = 0; c < number.size(); ++c) {
    if (std::ranges::find(study.matrix.entries, static_cast<Claim>(c), &ViewFactor::claim) ==
        study.matrix.entries.end())
      continue;
    number[c] = static_cast<double>(map.classes.size());
    map.classes.emplace_back(kShortClaims[c]);
  }
  for (int i = 0; i < map.rows; ++i) {
    for (int j = 0; j < map.columns; ++j) {
      const ViewFactor& f = study.matrix.at(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
      map.cells.push_back({j + 1, map.rows - i, number[static_cast<std::size_t>(f.claim)]});
    }
  }
  return {"view-factors.claims", "What is claimed of each entry",
          "Patches in order: " + text::enumerate(study.patches) + '.', page::map_plot(map)};
}

page::Figure sum_figure(const ViewFactorStudy& study) {
  std::vector<page::Series> series{{"1", {{0.0, 0.0}, {static_cast<double>(study.sums.size()) + 1.0, 0.0}}, 0}};
  for (std::size_t i = 0; i < study.sums.size(); ++i) {
    const double x = static_cast<double>(i) + 1.0;
    series.push_back({i == 0 ? "row, from its lower to its upper bound" : "",
                      {{x, study.sums[i].lower - 1.0}, {x, study.sums[i].upper - 1.0}},
                      1});
  }
  return {"view-factors.sums", "Rows of a closed room, less 1",
          "Every bar must meet the line. Rows in the order of the table.",
          page::line_plot({.x = "row", .y = "sum of the row − 1", .log_x = false, .log_y = false}, series)};
}

// ------------------------------------------------------------------------------------------------------------- tables

NumberTable width_table(const ViewFactorStudy& study) {
  NumberTable table{"Width and cells of an entry, by the accuracy asked for",
                    {"scene, claim", "accuracy", "upper − lower", "cells"},
                    {}};
  for (const WidthCurve& curve : study.curves) {
    for (const WidthAtAccuracy& place : curve.places) {
      table.rows.push_back({curve.name + ", " + std::string(to_string(curve.claim)), accuracy_text(place.accuracy),
                            rounded(place.width, 2), std::to_string(place.cells)});
    }
  }
  return table;
}

CsvFile matrix_table(const ViewFactorStudy& study) {
  TableWriter table("view factors of a room of 1 x 1 x 1 with a tilted cube in its middle",
                    {"from", "to", "factor", "lower", "upper", "claim"});
  for (std::size_t i = 0; i < study.patches.size(); ++i) {
    for (std::size_t j = 0; j < study.patches.size(); ++j) {
      const ViewFactor& f = study.matrix.at(i, j);
      table.row() << study.patches[i] << study.patches[j] << f.value << f.lower << f.upper << to_string(f.claim);
    }
  }
  return table.finish("view-factors.csv", "view factors of a closed room");
}

CsvFile width_file(const ViewFactorStudy& study) {
  TableWriter table("width of one entry by the accuracy asked for", {"scene", "claim", "accuracy", "width", "cells"});
  for (const WidthCurve& curve : study.curves) {
    for (const WidthAtAccuracy& place : curve.places) {
      table.row() << curve.name << to_string(curve.claim) << place.accuracy << place.width
                  << std::uint64_t{place.cells};
    }
  }
  return table.finish("view-factor-widths.csv", "widths of view factors by accuracy");
}

}  // namespace

Scene scene_of_plates() {
  SmallScene scene;
  add_parallelogram(scene, "below", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_parallelogram(scene, "above", {0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  add_parallelogram(scene, "plate", {0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0});
  return scene.build();
}

// The cube's edges are orthogonal and 9/32 long, and all coordinates are doubles.
Scene scene_of_cube_in_room() {
  SmallScene scene;
  add_sides(scene, {"left", "right", "front", "back", "floor", "ceiling"}, {}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
            true);
  constexpr double s = 0x1p-5, h = 0x1p-6;
  add_sides(scene, {"cube1", "cube2", "cube3", "cube4", "cube5", "cube6"}, {0.5 - 5 * h, 0.5 + 7 * h, 0.5 - 13 * h},
            {{{8 * s, -4 * s, 1 * s}, {1 * s, 4 * s, 8 * s}, {-4 * s, -7 * s, 4 * s}}}, false);
  return scene.build();
}

std::string accuracy_text(double accuracy) {
  const double exponent = std::round(std::log10(accuracy));
  if (std::abs(accuracy / std::pow(10.0, exponent) - 1.0) > 1e-9) return text::rounded(accuracy, 2);
  return exponent == 0.0 ? "1" : "10" + text::superscript(static_cast<int>(exponent));
}

ViewFactorStudy view_factor_study(const ViewFactorSize& size, int threads, const Hooks& hooks) {
  const Scene plates = scene_of_plates(), room = scene_of_cube_in_room();
  ViewFactorStudy study;
  for (const bool certify : {true, false}) {
    study.curves.push_back(width_curve("plates", plates, "below", "above", certify, size, hooks));
    study.curves.push_back(width_curve("room", room, "floor", "ceiling", certify, size, hooks));
  }
  std::vector<Selection> all;
  for (std::uint32_t i = 0; i < room.patches().size(); ++i) {
    all.push_back({PatchId{i}, {}, room.id()});
    study.patches.push_back(room.name_of(all.back()));
  }
  const ViewFactorOptions options{.accuracy = size.accuracy, .budget = size.budget};
  const matrix::Matrix made = matrix::compute(room, all, all, {.factors = options, .threads = threads}, hooks);
  study.matrix = made.factors;
  study.sums = row_sums(made);
  return study;
}

Result view_factors(const ViewFactorSize& size, int threads, const Hooks& hooks) {
  const ViewFactorStudy study = view_factor_study(size, threads, hooks);
  return {.name = "view-factors",
          .title = "View factors from patch to patch",
          .paragraphs = {sums_sentence(study), claims_sentence(study, size)},
          .tables = {width_table(study)},
          .figures = {width_figure(study), claim_figure(study), sum_figure(study)},
          .values = {matrix_table(study), width_file(study)}};
}

Result view_factors(const Effort& effort, const Hooks& hooks) {
  ViewFactorSize size;
  if (effort.abridged) size.accuracies = {1e-2, 1e-6};
  return view_factors(size, effort.threads, hooks);
}

}  // namespace exactff::experiments
