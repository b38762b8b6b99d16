#include "radiosity/narrowing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "matrix/columns.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "view_factors/pairs.h"

namespace exactff::radiosity {
namespace {

constexpr int kMostRounds = 12;
constexpr std::uint8_t kMostHalvings = 50;
constexpr double kFirstSlack = 4.0, kLeastSlack = 0.05;  // of the width that is wanted
constexpr double kLeastShare = 1.0 / 32.0;               // of the width of an entry, in one round
constexpr double kLeftToOthers = 0.1;  // of what a row may add, where entries that cannot be narrower use it up
constexpr int kMostIterations = 200;

// A channel of which narrower bounds are wanted.
struct Goal {
  System system;
  Numbers value;       // B, an estimate
  double width = 0.0;  // t
};

// The width of bounds as a share of the brightest radiosity.
double share_of(double lower, double upper, double brightest) {
  return upper == lower ? 0.0 : (upper - lower) / brightest;
}

// Nothing if the bounds are narrow enough, or if nothing is known that would help.
std::optional<Goal> goal_of(System system, double width) {
  const SolutionBounds bounds = bounds_of(system);
  if (bounds.value.empty()) return std::nullopt;
  Goal goal{std::move(system), bounds.value, 0.0};
  if (bounds.upper.empty()) {
    if (may_have_no_solution(goal.system)) return std::nullopt;
    goal.width = width * std::ranges::max(goal.value);
    return goal;
  }
  const double brightest = std::ranges::max(bounds.lower);
  goal.width = width * brightest;
  for (std::size_t i = 0; i < bounds.lower.size(); ++i) {
    if (share_of(bounds.lower[i], bounds.upper[i], brightest) > width) return goal;
  }
  return std::nullopt;
}

// Step 1: what each row may add, and what it adds.
struct Row {
  double may_add = 0.0, adds = 0.0;
};
std::vector<Row> rows_of(const Goal& goal, double slack) {
  const System& system = goal.system;
  const double most = slack * goal.width;
  std::vector<Row> rows(system.factors.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double sum = 0.0;
    for (const Entry& entry : system.factors.row(i)) sum += (entry.upper - entry.lower) * goal.value[entry.column];
    rows[i].adds = system.reflectances[i] * sum;
  }
  Numbers d(rows.size(), most);
  for (int k = 0; k < kMostIterations; ++k) {
    double change = 0.0;
    Numbers next;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double from_others = system.reflectances[i] * sum_of_values(system.factors.row(i), d);
      rows[i].may_add = std::max(most - from_others, 0.0);
      next.push_back(std::min(most, rows[i].adds + from_others));
      change = std::max(change, d[i] - next[i]);
    }
    d = std::move(next);
    if (change <= 1e-3 * most) break;
  }
  return rows;
}

// Step 2: the widths of these entries, as shares of what they are, so that they add at most `most`. Work > 0.
struct Share {
  double added = 0.0, work = 1.0;
};
Numbers shares_left(const std::vector<Share>& shares, double most) {
  std::vector<std::size_t> order(shares.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    const double x = shares[a].added * shares[b].work, y = shares[b].added * shares[a].work;
    return x > y || (x == y && a < b);
  });
  double rest = 0.0, roots = 0.0;
  for (const Share& share : shares) rest += share.added;
  Numbers left(shares.size(), 1.0);
  if (rest <= most) return left;
  double limit = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Share& share = shares[order[k]];
    rest -= share.added;
    roots += std::sqrt(share.work * share.added);
    limit = (most - rest) / roots;
    const bool is_last = k + 1 == order.size();
    if (limit > 0.0 && (is_last || shares[order[k + 1]].added <= limit * limit * shares[order[k + 1]].work)) {
      break;
    }
  }
  for (std::size_t k = 0; k < shares.size(); ++k) {
    left[k] = std::min(1.0, limit * std::sqrt(shares[k].work / shares[k].added));
  }
  return left;
}

class Plan {
 public:
  Plan(const matrix::Factors& factors, double accuracy, const std::vector<std::uint8_t>& halvings)
      : factors_(factors), accuracy_(accuracy), halvings_(halvings), wanted_(halvings) {}

  void add(const Goal& goal, double slack) {
    const std::vector<Row> rows = rows_of(goal, slack);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].adds > rows[i].may_add) narrow_row(goal, i, rows[i].may_add);
    }
  }

  // Whether some bounds stay too wide because entries that cannot be narrower make them so.
  [[nodiscard]] bool is_limited() const { return is_limited_; }

  // By the number of halvings.
  [[nodiscard]] std::map<std::uint8_t, std::vector<std::size_t>> entries() const {
    std::map<std::uint8_t, std::vector<std::size_t>> entries;
    for (std::size_t e = 0; e < wanted_.size(); ++e) {
      if (wanted_[e] > halvings_[e]) entries[wanted_[e]].push_back(e);
    }
    return entries;
  }

 private:
  [[nodiscard]] bool can_be_narrower(std::size_t entry) const {
    return factors_.entries[entry].limit == Limit::kNone && halvings_[entry] < kMostHalvings;
  }

  void narrow_row(const Goal& goal, std::size_t i, double may_add) {
    std::vector<std::size_t> entries;
    std::vector<Share> shares;
    double most = may_add;
    for (const Entry& f : goal.system.factors.row(i)) {
      const double adds = goal.system.reflectances[i] * (f.upper - f.lower) * goal.value[f.column];
      if (!(adds > 0.0)) continue;
      const std::size_t entry = i * factors_.to.size() + f.column;
      if (can_be_narrower(entry)) {
        entries.push_back(entry);
        shares.push_back({adds, static_cast<double>(std::max<std::size_t>(factors_.entries[entry].cells, 1))});
      } else {
        most -= adds;
      }
    }
    is_limited_ = is_limited_ || most < kLeftToOthers * may_add;
    const Numbers left = shares_left(shares, std::max(most, kLeftToOthers * may_add));
    for (std::size_t k = 0; k < entries.size(); ++k) {
      if (left[k] < 1.0) want(entries[k], left[k]);
    }
  }

  void want(std::size_t entry, double share) {
    const ViewFactor& f = factors_.entries[entry];
    const double halvings = std::ceil(std::log2(accuracy_ / (std::max(share, kLeastShare) * (f.upper - f.lower))));
    const double most = kMostHalvings, least = halvings_[entry] + 1.0;
    wanted_[entry] = std::max(wanted_[entry], static_cast<std::uint8_t>(std::clamp(halvings, least, most)));
  }

  const matrix::Factors& factors_;
  const double accuracy_;
  const std::vector<std::uint8_t>& halvings_;
  std::vector<std::uint8_t> wanted_;
  bool is_limited_ = false;
};

std::vector<Goal> goals_of(const Scene& scene, const matrix::Matrix& matrix, double width) {
  std::vector<Goal> goals;
  const Exposed exposed(matrix);
  for (std::size_t c = 0; c < kChannelNames.size(); ++c) {
    System system = system_of(scene, exposed.matrix().factors, c);
    const auto is_same = [&](const Goal& goal) {
      return goal.system.reflectances == system.reflectances && goal.system.emissions == system.emissions;
    };
    if (std::ranges::any_of(goals, is_same)) continue;
    std::optional<Goal> goal = goal_of(std::move(system), width);
    if (goal) goals.push_back(std::move(*goal));
  }
  return goals;
}

std::map<std::uint8_t, std::vector<std::size_t>> entries_of(const std::vector<Goal>& goals,
                                                            const matrix::Factors& factors, double accuracy,
                                                            const std::vector<std::uint8_t>& halvings) {
  for (double slack = kFirstSlack; slack >= kLeastSlack; slack *= 0.5) {
    Plan plan(factors, accuracy, halvings);
    for (const Goal& goal : goals) plan.add(goal, slack);
    auto entries = plan.entries();
    if (!entries.empty() || plan.is_limited()) return entries;
  }
  return {};
}

// --- Entries again ---

// Entries of a matrix that are computed again, with a smaller accuracy. Those that the journal holds, if there is one,
// are not computed, and others are added as soon as they are known.
struct Again {
  ViewFactorOptions factors;
  std::vector<std::size_t> entries;  // row by row, of the factors between all of from = to
  const Hooks& hooks;
  jobs::Journal* journal = nullptr;
  std::size_t done = 0, total = 0;  // of all rounds, for progress
  int threads = 0;
};

// The patches of these entries, each once, and the entries among them.
struct Part {
  Part(const Again& again, const matrix::Factors& factors) {
    std::set<std::size_t> needed;
    for (const std::size_t entry : again.entries) {
      needed.insert(entry / factors.to.size());
      needed.insert(entry % factors.to.size());
    }
    rows.assign(needed.begin(), needed.end());
    for (const std::size_t row : rows) patches.push_back(factors.from[row]);
  }

  [[nodiscard]] std::size_t place_of(std::size_t row) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(rows, row) - rows.begin());
  }
  [[nodiscard]] std::size_t entry_in_part(std::size_t entry, std::size_t columns) const {
    return place_of(entry / columns) * rows.size() + place_of(entry % columns);
  }
  [[nodiscard]] std::size_t entry_in_all(std::size_t entry, std::size_t columns) const {
    return rows[entry / rows.size()] * columns + rows[entry % rows.size()];
  }

  std::vector<std::size_t> rows;
  std::vector<Selection> patches;
};

// All that a pair depends on.
std::string name_of(const Scene& scene, const ViewFactorOptions& options, std::size_t entry) {
  return scene.hash() + ':' + text::shortest(options.accuracy) + ':' + std::to_string(options.budget) +
         (options.certify ? ":certify" : "") + (options.both_directions ? ":both" : "") +
         (options.sample_crowds ? "" : ":cells") + ':' + std::to_string(entry);
}

// One line for each entry. Returns false, and takes nothing, if the text has other lines.
template <class Put>
bool take_kept(std::string_view text, const std::vector<std::size_t>& entries, const Put& put) {
  std::vector<matrix::Entry> lines(entries.size());
  for (matrix::Entry& line : lines) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos || !matrix::columns().read_csv(text.substr(0, end), line)) return false;
    text.remove_prefix(end + 1);
  }
  for (std::size_t k = 0; k < entries.size(); ++k) put(entries[k], lines[k]);
  return text.empty();
}

// A pair counts for all of its entries.
Hooks shifted(const Again& with) {
  const auto show = [&with](const Progress& progress) {
    Progress shown = progress;
    shown.done = with.done + progress.done * with.entries.size() / std::max<std::size_t>(progress.total, 1);
    shown.total = with.total;
    if (with.hooks.progress) with.hooks.progress(shown);
  };
  return {.progress = show, .cancelled = with.hooks.cancelled};
}

// Replaces the entries by those that view_factor gives with the options, and those that follow from them (transposes)
// as well. Calls take(entry), of all that are replaced, from any thread.
void compute(const Scene& scene, const Again& again, matrix::Factors& factors,
             const std::function<void(std::size_t)>& take) {
  if (again.entries.empty()) return;
  const std::size_t width = factors.to.size();
  const Part part(again, factors);
  const view_factors::Pairs pairs(scene, part.patches, part.patches, again.factors);
  std::set<std::size_t> unique;
  for (const std::size_t entry : again.entries) unique.insert(pairs.pair_of(part.entry_in_part(entry, width)));
  const std::vector<std::size_t> wanted(unique.begin(), unique.end());
  const auto put = [&](std::size_t entry, const ViewFactor& f) {
    const std::size_t place = part.entry_in_all(entry, width);
    factors.entries[place] = f;
    take(place);
  };
  files::parallel_for(wanted.size(), again.threads, "view factors again", shifted(again), [&](std::size_t i) {
    const std::vector<std::size_t>& entries = pairs.entries_of(wanted[i]);
    const std::string name = name_of(scene, again.factors, part.entry_in_all(entries.front(), width));
    const auto kept = again.journal != nullptr ? again.journal->find(name) : std::nullopt;
    if (kept && take_kept(*kept, entries, put)) return;
    std::string text;
    matrix::Entry line;
    pairs.compute(wanted[i], [&](std::size_t entry, const ViewFactor& f) {
      put(entry, f);
      static_cast<ViewFactor&>(line) = f;
      matrix::columns().append_csv(line, text);
    });
    if (again.journal != nullptr) again.journal->add(name, text);
  });
}

}  // namespace

void require_width(double width) {
  if (width > 0.0 && std::isfinite(width)) return;
  text::refuse("the width of bounds is " + text::shortest(width), "it is a share of the brightest radiosity",
               "give a positive number, for example 1e-3");
}

double accuracy_for(double width) { return std::min(0.5, 4.0 * width); }

Narrowed narrow(const Scene& scene, matrix::Matrix& matrix, const Options& options, jobs::Journal* journal,
                const Hooks& hooks) {
  require_width(*options.width);
  Narrowed result{std::vector<std::uint8_t>(matrix.factors.entries.size()), 0};
  const double accuracy = options.factors.accuracy;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto entries = entries_of(goals_of(scene, matrix, *options.width), matrix.factors, accuracy, result.halvings);
    if (entries.empty()) break;
    Again again{options.factors, {}, hooks, journal, 0, 0, options.threads};
    for (const auto& [halvings, of_accuracy] : entries) again.total += of_accuracy.size();
    // The most accurate first: transposes of these need not be computed less accurately before.
    for (auto level = entries.rbegin(); level != entries.rend(); ++level) {
      const std::uint8_t halvings = level->first;
      again.factors.accuracy = std::ldexp(accuracy, -halvings);
      again.entries = level->second;
      std::erase_if(again.entries, [&](std::size_t entry) { return result.halvings[entry] >= halvings; });
      compute(scene, again, matrix.factors, [&](std::size_t entry) { result.halvings[entry] = halvings; });
      again.done += level->second.size();
    }
  }
  result.entries = static_cast<std::size_t>(std::ranges::count_if(result.halvings, [](auto h) { return h > 0; }));
  return result;
}

Solution solve_within(const Scene& scene, matrix::Matrix& matrix, const Options& options, jobs::Journal* journal,
                      const Hooks& hooks) {
  const std::size_t again = options.width ? narrow(scene, matrix, options, journal, hooks).entries : 0;
  Solution solution = solve(scene, matrix);
  solution.width = options.width;
  solution.computed_again = again;
  return solution;
}

Widest widest_bounds(const Solution& solution) {
  const kernel::StandardArithmetic arithmetic;
  Widest widest;
  for (std::size_t c = 0; c < solution.channels.size(); ++c) {
    const std::vector<BoundedValue>& all = solution.channels[c].radiosity;
    const double brightest = all.empty() ? 0.0 : std::ranges::max(all, {}, &BoundedValue::lower).lower;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double share = share_of(all[i].lower, all[i].upper, brightest);
      if (share > widest.share) widest = {i, c, share};
    }
  }
  return widest;
}

}  // namespace exactff::radiosity
