#include "studies/honesty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "exactff/models.h"
#include "files/parallel.h"
#include "kernel/disc.h"
#include "kernel/expect.h"
#include "models/random.h"
#include "studies/honest_families.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "view_factors/exact_scene.h"
#include "view_factors/prepared_patch.h"

namespace exactff::experiments {

namespace {

constexpr std::string_view kHonestyStage = "honesty";

double magnitude_of_error(const ViewFactor& entry) {
  return std::max(entry.value - entry.lower, entry.upper - entry.value);
}

// A_j / A_i, enclosed.
kernel::Disc ratio_of_areas(const view_factors::ExactScene& exact, const Selection& i, const Selection& j) {
  const auto area = [&](const Selection& patch) {
    return view_factors::enclosed_area_of(view_factors::parts_of(exact, patch), exact.units);
  };
  return area(j) / area(i);
}

Bounds common_part(const Bounds& a, const Bounds& b) {
  const double lower = std::max(a.lower, b.lower), upper = std::min(a.upper, b.upper);
  if (lower > upper) return {std::min(a.lower, b.lower), std::max(a.upper, b.upper), true};
  return {lower, upper, a.are_contradictory || b.are_contradictory};
}

// The bounds of F_ij as bounds of F_ji, with A_i / A_j.
Bounds turned_round(const Bounds& truth, const kernel::Disc& ratio) {
  return {std::max(0.0, lower_end(truth.lower * ratio)), std::min(1.0, upper_end(truth.upper * ratio)),
          truth.are_contradictory};
}

struct Pair {
  Scene scene;
  Selection from, to;
};

Pair pair_of(const HonestyScene& named) {
  Pair pair{scene_of(named), {}, {}};
  pair.from = pair.scene.select(named.from);
  pair.to = pair.scene.select(named.to);
  return pair;
}

// Beside an estimated error the truth is narrow, so that the ratio of the two says something.
constexpr double kNarrow = 0.5;

bool is_judged(const HonestyEntry& entry) {
  const Verdict found = verdict(entry.factor, entry.truth);
  const bool is_narrow = entry.factor.claim != Claim::kEstimated ||
                         entry.truth.upper - entry.truth.lower <= kNarrow * magnitude_of_error(entry.factor);
  return found == Verdict::kBroken || (found == Verdict::kHolds && is_narrow);
}

// The accuracy of a truth that judges the entries.
double accuracy_of_truth(std::span<const HonestyEntry> entries) {
  double accuracy = 1.0;
  for (const HonestyEntry& entry : entries) accuracy = std::min(accuracy, kNarrow * magnitude_of_error(entry.factor));
  return std::clamp(accuracy, 1e-13, 1e-2);
}

// Gives the entries their truth: from both directions with few cells, then from one with many, then from the other.
void judge(const Pair& pair, const HonestySize& size, HonestyScene& scene) {
  const view_factors::ExactScene exact(pair.scene);
  const std::array<const Selection*, 2> ends{&pair.from, &pair.to};
  const kernel::Disc ratio = ratio_of_areas(exact, *ends[scene.is_turned], *ends[!scene.is_turned]);
  const double accuracy = accuracy_of_truth(scene.entries);
  Bounds truth;
  const auto narrow = [&](bool turned, std::size_t budget) {
    const ViewFactor f =
        view_factor(pair.scene, *ends[turned], *ends[!turned],
                    {.accuracy = accuracy, .budget = budget, .both_directions = true, .certify = true});
    const Bounds found{f.lower, f.upper};
    truth = common_part(truth, turned == scene.is_turned ? found : turned_round(found, ratio));
    for (HonestyEntry& entry : scene.entries) entry.truth = truth;
  };
  for (const bool turned : {false, true}) narrow(turned, size.truth_budgets.front());
  for (const std::size_t budget : size.truth_budgets) {
    for (const bool turned : {false, true}) {
      if (std::ranges::all_of(scene.entries, is_judged)) return;
      if (budget > size.truth_budgets.front()) narrow(turned, budget);
    }
  }
}

void add_entry(const Pair& pair, Asked asked, double accuracy, std::size_t budget, HonestyScene& scene) {
  const bool by_points = asked == Asked::kPoints || asked == Asked::kCellsAndPoints;
  if (asked == Asked::kPoints) budget = 1;
  const Selection &i = scene.is_turned ? pair.to : pair.from, &j = scene.is_turned ? pair.from : pair.to;
  const ViewFactor factor = view_factor(
      pair.scene, i, j,
      {.accuracy = accuracy, .budget = budget, .sample_crowds = by_points, .certify = asked == Asked::kCertified});
  // What cells alone have found is not of interest here.
  if (by_points && factor.way != Way::kPoints) return;
  scene.entries.push_back({asked, accuracy, budget, scene.is_turned, factor, {}});
}

void fill(HonestyScene& scene, std::uint64_t number, const HonestySize& size) {
  const Pair pair = pair_of(scene);
  models::Random random(~number);  // of a stream that draws no scene
  const double accuracy = size.accuracies[random.below(size.accuracies.size())];
  const std::size_t budget = size.budgets[random.below(size.budgets.size())];
  for (const Asked asked : {Asked::kCertified, Asked::kCells, Asked::kPoints, Asked::kCellsAndPoints}) {
    add_entry(pair, asked, accuracy, budget, scene);
  }
  judge(pair, size, scene);
}

// An internal error is a result here, among thousands of others.
HonestyScene scene_with_entries(std::uint64_t number, const HonestySize& size) {
  HonestyScene scene = honesty_scene(number, size.families);
  try {
    fill(scene, number, size);
  } catch (const std::logic_error& error) {
    scene.failure = error.what();
  }
  return scene;
}

void count_entry(const HonestyEntry& entry, HonestyRow& row) {
  ++row.entries;
  row.wide += entry.factor.accurate ? 0U : 1U;
  const Verdict found = verdict(entry.factor, entry.truth);
  ++(found == Verdict::kHolds ? row.holds : found == Verdict::kOpen ? row.open : row.broken);
  if (!(magnitude_of_error(entry.factor) > 0.0)) return;
  const ErrorRatio ratio = error_ratio(entry.factor, entry.truth);
  row.worst.at_least = std::max(row.worst.at_least, ratio.at_least);
  if (found == Verdict::kHolds) row.worst.at_most = std::max(row.worst.at_most, ratio.at_most);
}

}  // namespace

Verdict verdict(const ViewFactor& entry, const Bounds& truth) {
  if (entry.upper < truth.lower || entry.lower > truth.upper) return Verdict::kBroken;
  if (entry.lower <= truth.lower && truth.upper <= entry.upper) return Verdict::kHolds;
  return Verdict::kOpen;
}

ErrorRatio error_ratio(const ViewFactor& entry, const Bounds& truth) {
  const double reported = magnitude_of_error(entry);
  EXACTFF_EXPECT(reported > 0.0);
  const double below = truth.lower - entry.value, above = entry.value - truth.upper;
  return {std::max({0.0, below, above}) / reported,
          std::max(std::abs(entry.value - truth.lower), std::abs(entry.value - truth.upper)) / reported};
}

HonestyScene honesty_scene(std::uint64_t number, HonestyFamilies families) {
  if (families == HonestyFamilies::kAlmostClosed) {
    const std::size_t family = number % kAlmostClosedFamilies.size();
    return {std::string(kAlmostClosedFamilies[family]) + ", seed " + std::to_string(number),
            kHardFamilies.size() + family + 1,
            number,
            "floor",
            "source",
            number / 32 % 2 == 0,
            {},
            {}};
  }
  constexpr std::array<const char*, 3> kModels{"karkanis", "soup", "lattice"};
  constexpr std::array<double, 4> kCovers{0.25, 0.5, 1.0, 2.0};
  constexpr std::array<std::pair<const char*, const char*>, 4> kPairs{
      {{"floor", "source"}, {"floor", "source"}, {"floor", "occ"}, {"occ", "source"}}};
  if (number % 2 == 0) {
    const std::size_t family = number / 2 % kHardFamilies.size();
    HonestyScene scene{std::string(kHardFamilies[family]) + ", seed " + std::to_string(number),
                       family + 1,
                       number,
                       "floor",
                       "source",
                       number / 32 % 2 == 0,
                       {},
                       {}};
    return scene;
  }
  models::Random random(number);
  const char* const model = kModels[random.below(kModels.size())];
  const int faces = random.integer(1, 4);
  const double cover = kCovers[random.below(kCovers.size())];
  std::pair<const char*, const char*> pair = kPairs[random.below(kPairs.size())];
  HonestyScene scene{std::string(model) + ":n=" + std::to_string(faces) + ",cover=" + text::shortest(cover) +
                         ",seed=" + std::to_string(number),
                     0,
                     0,
                     "floor",
                     "source",
                     random.one_in(2),
                     {},
                     {}};
  const Scene made = models::make_scene(scene.model);
  // All of Karkanis' triangles turn their backs to the source; those of the lattice may have collapsed.
  const bool sees_nothing = model == kModels[0] && pair == kPairs.back();
  if (sees_nothing || made.faces_of(made.select("occ")).empty()) return scene;
  std::tie(scene.from, scene.to) = pair;
  return scene;
}

Scene scene_of(const HonestyScene& named) {
  return named.family > 0 ? hard_scene(named.family - 1, named.seed) : models::make_scene(named.model);
}

std::vector<HonestyRow> honesty_rows(std::span<const HonestyScene> scenes) {
  const auto key = [](const HonestyEntry& entry) {
    const auto [claim, way] = std::pair(entry.factor.claim, entry.factor.way);
    const bool one_row = claim == Claim::kZero || way == Way::kPoints;
    return std::tuple(-static_cast<int>(claim), static_cast<int>(way), one_row ? 0.0 : -entry.accuracy);
  };
  std::map<std::tuple<int, int, double>, HonestyRow> sorted;
  for (const HonestyScene& scene : scenes) {
    for (const HonestyEntry& entry : scene.entries) {
      HonestyRow& row = sorted[key(entry)];
      row.claim = entry.factor.claim;
      row.way = entry.factor.way;
      row.accuracy = std::abs(std::get<2>(key(entry)));
      count_entry(entry, row);
    }
  }
  std::vector<HonestyRow> rows;
  for (const auto& [at, row] : sorted) rows.push_back(row);
  return rows;
}

HonestyStudy honesty_study(const HonestySize& size, int threads, const Hooks& hooks) {
  HonestyStudy study;
  study.scenes.resize(size.scenes);
  files::parallel_for(size.scenes, threads, kHonestyStage, hooks,
                      [&](std::size_t i) { study.scenes[i] = scene_with_entries(size.first + i, size); });
  study.rows = honesty_rows(study.scenes);
  for (const HonestyScene& scene : study.scenes) {
    study.contradictions += !scene.entries.empty() && scene.entries.front().truth.are_contradictory ? 1U : 0U;
    study.failures += scene.failure.empty() ? 0U : 1U;
  }
  return study;
}

std::string honesty_csv(const HonestyStudy& study) {
  constexpr std::array<std::string_view, 3> kVerdicts{"holds", "open", "broken"};
  std::string csv =
      "# each model as for exactff matrix @MODEL --from FROM --to TO; others are families and seeds of "
      "studies/honest_families.h\n"
      "# truth_lower and truth_upper: what certified enclosures of both directions have in common\n"
      "model,from,to,accuracy,budget,claim,way,factor,lower,upper,truth_lower,truth_upper,verdict\n";
  for (const HonestyScene& scene : study.scenes) {
    for (const HonestyEntry& entry : scene.entries) {
      const ViewFactor& f = entry.factor;
      csv += text::csv_field(scene.model) + ',' + (entry.turned ? scene.to : scene.from) + ',' +
             (entry.turned ? scene.from : scene.to) + ',' + text::shortest(entry.accuracy) + ',' +
             std::to_string(entry.budget) + ',' + std::string(to_string(f.claim)) + ',' + std::string(to_string(f.way));
      for (const double value : {f.value, f.lower, f.upper, entry.truth.lower, entry.truth.upper}) {
        csv += ',' + text::shortest(value);
      }
      csv += ',' + std::string(kVerdicts[static_cast<std::size_t>(verdict(f, entry.truth))]) + '\n';
    }
  }
  return csv;
}

}  // namespace exactff::experiments
