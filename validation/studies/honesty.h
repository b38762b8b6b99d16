// Whether view factors keep their word: in random scenes, how often the true error of an entry exceeds the one that is
// reported with it, for each claim and accuracy.
//
// Every second scene has a floor, a source above it and one to four faces between, of the models karkanis, soup and
// lattice; the others are made to break what is claimed (honest_families.h). The factor between two patches of it is
// asked for as certified, as estimated by cells, and by points, of the patch and of cells; the scene's number draws
// accuracy and budget. The truth is what two certified enclosures have in common, one of F_ij and one of F_ji, computed
// apart. They are narrowed until they judge the entries, or their cells are used up. An error counts only if it is
// proved: the entry's interval and the truth have no number in common. Where they overlap without the truth being
// inside, the entry is left open.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "exactff/jobs.h"
#include "exactff/view_factors.h"

namespace exactff::experiments {

enum class HonestyFamilies {
  kAll,           // models and hard families, by turns
  kAlmostClosed,  // those of rooms, dishes and streets that almost close
};

struct HonestySize {
  HonestyFamilies families = HonestyFamilies::kAll;
  std::uint64_t first = 1;  // the numbers of the scenes: first, first + 1, ...
  std::uint64_t scenes = 100;
  std::vector<double> accuracies = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8};
  std::vector<std::size_t> budgets = {30, 100, 300};          // cells of an entry
  std::vector<std::size_t> truth_budgets = {100, 600, 3000};  // cells of each enclosure: at first, and at last
};

// What is proved about a view factor.
struct Bounds {
  double lower = 0.0, upper = 1.0;
  bool are_contradictory = false;  // the two enclosures are disjoint: one of them is wrong
};

enum class Verdict {
  kHolds,   // the truth lies inside the entry's interval
  kOpen,    // they overlap: the truth is not known well enough
  kBroken,  // they are disjoint: the true error exceeds the reported one
};
[[nodiscard]] Verdict verdict(const ViewFactor& entry, const Bounds& truth);

// The true error over the reported one. The truth is an interval, so the quotient is one.
struct ErrorRatio {
  double at_least = 0.0, at_most = 0.0;
};
// Requires an interval with a width.
[[nodiscard]] ErrorRatio error_ratio(const ViewFactor& entry, const Bounds& truth);

// How an entry was asked for. `kPoints`: with a budget of one cell, so that points tell of the whole patch.
// `kCellsAndPoints`: points tell of the cells that are not known when the budget is used up. What comes back may be a
// better one.
enum class Asked { kCertified, kCells, kPoints, kCellsAndPoints };
struct HonestyEntry {
  Asked asked = Asked::kCertified;
  double accuracy = 0.0;
  std::size_t budget = 0;
  bool turned = false;  // F_ji instead of F_ij
  ViewFactor factor;
  Bounds truth;  // of the same direction
};

struct HonestyScene {
  std::string model;
  std::size_t family = 0;  // of honest_families.h, from 1 on; 0: a model of the library
  std::uint64_t seed = 0;  // of such a family
  std::string from, to;
  bool is_turned = false;  // entries are of F_ji
  std::vector<HonestyEntry> entries;
  std::string failure;  // a cell failed its own check: there are no further entries
};

// All entries of one claim, way and accuracy. Proved zeros are one row, and entries by points another: their accuracy
// is 0.
struct HonestyRow {
  Claim claim = Claim::kZero;
  Way way = Way::kCells;
  double accuracy = 0.0;
  std::size_t entries = 0, holds = 0, open = 0, broken = 0;
  std::size_t wide = 0;  // wider than the accuracy asked for
  ErrorRatio worst;      // the largest of each, at_most only of entries that hold
};

struct HonestyStudy {
  std::vector<HonestyScene> scenes;
  std::vector<HonestyRow> rows;    // by claim, the strongest first, then by accuracy, the largest first
  std::size_t contradictions = 0;  // scenes whose two enclosures are disjoint
  std::size_t failures = 0;
};

// A random scene's model, and the names of the two patches. Depends on the number alone.
[[nodiscard]] HonestyScene honesty_scene(std::uint64_t number, HonestyFamilies families = HonestyFamilies::kAll);
[[nodiscard]] Scene scene_of(const HonestyScene& named);
[[nodiscard]] HonestyStudy honesty_study(const HonestySize& size, int threads, const Hooks& hooks);
[[nodiscard]] std::vector<HonestyRow> honesty_rows(std::span<const HonestyScene> scenes);

// All entries, one a line, with their true values.
[[nodiscard]] std::string honesty_csv(const HonestyStudy& study);

}  // namespace exactff::experiments
