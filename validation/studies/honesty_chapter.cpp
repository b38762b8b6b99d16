// What the report says about the honesty of view factors.
#include <algorithm>
#include <cmath>

#include "studies/honesty.h"
#include "text/phrases.h"

namespace exactff::experiments {

namespace {

using text::counted;
using text::rounded;

std::string_view word_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kHolds:
      return "holds";
    case Verdict::kOpen:
      return "open";
    case Verdict::kBroken:
      return "broken";
  }
  return {};
}

struct Sums {
  std::size_t entries = 0, open = 0, broken = 0;
};

Sums sums_of(const HonestyStudy& study) {
  Sums sums;
  for (const HonestyRow& row : study.rows) {
    sums.entries += row.entries;
    sums.open += row.open;
    sums.broken += row.broken;
  }
  return sums;
}

// ---------------------------------------------------------------------------------------------------------- sentences

// "estimated by points"
std::string words_of(Claim claim, Way way) {
  return std::string(to_string(claim)) + (claim == Claim::kEstimated ? " by " + std::string(to_string(way)) : "");
}

// "2 of 854 estimated by points"
std::vector<std::string> broken_claims(const HonestyStudy& study) {
  std::vector<std::string> claims;
  for (const auto& [claim, way] :
       {std::pair(Claim::kZero, Way::kCells), std::pair(Claim::kCertified, Way::kCells),
        std::pair(Claim::kEstimated, Way::kCells), std::pair(Claim::kEstimated, Way::kPoints)}) {
    std::size_t entries = 0, broken = 0;
    for (const HonestyRow& row : study.rows) {
      if (row.claim != claim || row.way != way) continue;
      entries += row.entries;
      broken += row.broken;
    }
    if (broken == 0) continue;
    claims.push_back(std::to_string(broken) + " of " + std::to_string(entries) + ' ' + words_of(claim, way));
  }
  return claims;
}

std::string broken_sentence(const HonestyStudy& study) {
  const Sums sums = sums_of(study);
  const std::string of = counted(sums.entries, "view factor") + " in " + counted(study.scenes.size(), "random scene");
  if (sums.broken > 0) {
    return "The true error is proved to exceed the reported one for " + std::to_string(sums.broken) + " of " + of +
           ": " + text::enumerate(broken_claims(study)) + '.';
  }
  return "No true error of " + of + " is proved to exceed the reported one.";
}

std::string failure_sentence(const HonestyStudy& study) {
  const auto failed =
      std::ranges::find_if(study.scenes, [](const HonestyScene& scene) { return !scene.failure.empty(); });
  if (failed == study.scenes.end()) return {};
  return "In " + counted(study.failures, "scene") +
         " a cell fails its own check, which is an internal error of exactff, and the entries after it are missing. "
         "The "
         "first one is @" +
         failed->model + ": " + failed->failure + '.';
}

// ------------------------------------------------------------------------------------------------------------- figure

page::Figure error_figure(const HonestyStudy& study) {
  using page::Series;
  Series by_cells{"estimated by cells", {}, 1}, by_points{"estimated by points", {}, 2}, certified{"certified", {}, 3};
  double low = 1.0, high = 0.0;
  for (const HonestyScene& scene : study.scenes) {
    for (const HonestyEntry& entry : scene.entries) {
      const ViewFactor& f = entry.factor;
      const double reported = std::max(f.value - f.lower, f.upper - f.value);
      if (!(reported > 0.0)) continue;
      const double error = error_ratio(f, entry.truth).at_most * reported;
      low = std::min(low, reported);
      high = std::max(high, reported);
      (f.claim == Claim::kCertified ? certified
       : f.way == Way::kCells       ? by_cells
                                    : by_points)
          .points.emplace_back(reported, error);
    }
  }
  const Series diagonal{"true = reported", {{low, low}, {high, high}}, 0};
  return {"honesty.errors", "True error of view factors against the reported error",
          "One point for each entry. The true error is drawn at the largest value that the truth leaves possible, so a "
          "point above the line is a doubt, and not yet a wrong error.",
          page::scatter_plot({.x = "reported error", .y = "true error, at most"},
                             {diagonal, certified, by_cells, by_points})};
}

// ------------------------------------------------------------------------------------------------------------- tables

CsvFile entry_table(const HonestyStudy& study) {
  table::Rows rows = rows_of(
      "honesty",
      "view factors in random scenes, each model as for exactff matrix @MODEL --from FROM --to TO; other models are "
      "families and seeds of studies/honest_families.h; "
      "truth_lower and truth_upper: what certified enclosures of both directions have in common",
      {table::keys("model,from,to"), table::keys("accuracy", table::Type::kNumber),
       table::keys("budget", table::Type::kCount), table::texts("claim,way"),
       table::numbers("factor,lower,upper", table::Strength::kStated),
       table::numbers("truth_lower,truth_upper", table::Strength::kProved), table::texts("verdict")});
  for (const HonestyScene& scene : study.scenes) {
    for (const HonestyEntry& entry : scene.entries) {
      const ViewFactor& f = entry.factor;
      rows << scene.model << (entry.turned ? scene.to : scene.from) << (entry.turned ? scene.from : scene.to)
           << entry.accuracy << entry.budget << to_string(f.claim) << to_string(f.way) << f.value << f.lower << f.upper
           << entry.truth.lower << entry.truth.upper << word_of(verdict(f, entry.truth));
    }
  }
  return csv_file(std::move(rows), "honesty.csv", "view factors in random scenes, with their true values");
}

CsvFile row_table(const HonestyStudy& study) {
  table::Rows rows = rows_of(
      "honesty",
      "true errors of view factors over the reported ones, by claim and accuracy (0: all); "
      "at_least: the largest ratio that is proved; at_most: the largest possible one of entries that hold",
      {table::keys("claim,way"), table::keys("accuracy", table::Type::kNumber),
       table::counts("entries,holds,open,broken,wide"), table::numbers("at_least,at_most", table::Strength::kProved)});
  for (const HonestyRow& row : study.rows) {
    rows << to_string(row.claim) << to_string(row.way) << row.accuracy << row.entries << row.holds << row.open
         << row.broken << row.wide << row.worst.at_least << row.worst.at_most;
  }
  return csv_file(std::move(rows), "honesty-rows.csv", "true errors of view factors over the reported ones");
}

// "10⁻³"
std::string accuracy_text(double accuracy) {
  return "10" + text::superscript(static_cast<int>(std::round(std::log10(accuracy))));
}

std::string name_of(const HonestyRow& row) {
  const std::string claim = words_of(row.claim, row.way);
  return row.accuracy > 0.0 ? claim + ", " + accuracy_text(row.accuracy) : claim;
}

}  // namespace

NumberTable honesty_table(std::span<const HonestyRow> rows) {
  NumberTable table{"True error against the reported one, by claim and accuracy",
                    {"claim", "entries", "within", "open", "exceeded", "worst true / reported", "wider than asked"},
                    {}};
  for (const HonestyRow& row : rows) {
    const bool has_ratio = row.claim != Claim::kZero;
    table.rows.push_back({name_of(row), std::to_string(row.entries), std::to_string(row.holds),
                          std::to_string(row.open), std::to_string(row.broken),
                          has_ratio ? rounded(row.worst.at_least, 2) : "", std::to_string(row.wide)});
  }
  return table;
}

Result honesty_chapter(const HonestyStudy& study) {
  Result result{.name = "honesty", .title = "View factors: true errors against reported ones"};
  result.paragraphs = {broken_sentence(study), failure_sentence(study)};
  std::erase(result.paragraphs, "");
  result.tables = {honesty_table(study.rows)};
  result.figures = {error_figure(study)};
  result.values = {entry_table(study), row_table(study)};
  return result;
}

}  // namespace exactff::experiments
