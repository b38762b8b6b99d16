#include "matrix/again.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "text/phrases.h"
#include "view_factors/pairs.h"

namespace exactff::matrix {
namespace {

// One line for each entry. Doubles read back to the same bits.
void append(std::string& text, const ViewFactor& f) {
  for (const double number : {f.value, f.lower, f.upper, f.area_from, f.area_to}) text += text::shortest(number) + ' ';
  for (const std::size_t number :
       {static_cast<std::size_t>(f.claim), static_cast<std::size_t>(f.way), static_cast<std::size_t>(f.limit),
        static_cast<std::size_t>(f.accurate ? 1 : 0), f.cells, f.event_cells}) {
    text += std::to_string(number) + ' ';
  }
  text += '\n';
}

bool read(std::istream& in, ViewFactor& f) {
  unsigned claim = 0, way = 0, limit = 0;
  in >> f.value >> f.lower >> f.upper >> f.area_from >> f.area_to >> claim >> way >> limit >> f.accurate >> f.cells >>
      f.event_cells;
  f.claim = static_cast<Claim>(claim);
  f.way = static_cast<Way>(way);
  f.limit = static_cast<Limit>(limit);
  return !in.fail() && !to_string(f.claim).empty() && !to_string(f.way).empty() && !to_string(f.limit).empty();
}

// The patches of these entries, each once, and the entries among them.
struct Part {
  Part(const Again& again, const Factors& factors) {
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

// A pair counts for all of its entries.
Hooks shifted(const AgainHooks& with, std::size_t entries) {
  const auto show = [&with, entries](const Progress& progress) {
    Progress shown = progress;
    shown.done = with.done + progress.done * entries / std::max<std::size_t>(progress.total, 1);
    shown.total = with.total;
    if (with.hooks.progress) with.hooks.progress(shown);
  };
  return {.progress = show, .cancelled = with.hooks.cancelled};
}

}  // namespace

void compute_again(const Scene& scene, const Again& again, const AgainHooks& with, Factors& factors,
                   const std::function<void(std::size_t)>& take) {
  if (again.entries.empty()) return;
  const kernel::StandardArithmetic arithmetic;
  const std::size_t columns = factors.to.size();
  const Part part(again, factors);
  const view_factors::Pairs pairs(scene, part.patches, part.patches, again.factors);
  std::set<std::size_t> unique;
  for (const std::size_t entry : again.entries) unique.insert(pairs.pair_of(part.entry_in_part(entry, columns)));
  const std::vector<std::size_t> wanted(unique.begin(), unique.end());
  const auto put = [&](std::size_t entry, const ViewFactor& f) {
    const std::size_t place = part.entry_in_all(entry, columns);
    factors.entries[place] = f;
    take(place);
  };
  files::parallel_for(
      wanted.size(), with.threads, "view factors again", shifted(with, again.entries.size()), [&](std::size_t i) {
        const std::vector<std::size_t>& entries = pairs.entries_of(wanted[i]);
        const std::string name = name_of(scene, again.factors, part.entry_in_all(entries.front(), columns));
        const auto kept = with.journal != nullptr ? with.journal->find(name) : std::nullopt;
        if (kept) {
          std::istringstream in(*kept);
          std::vector<ViewFactor> known(entries.size());
          if (std::ranges::all_of(known, [&](ViewFactor& f) { return read(in, f); })) {
            for (std::size_t k = 0; k < entries.size(); ++k) put(entries[k], known[k]);
            return;
          }
        }
        std::string text;
        pairs.compute(wanted[i], [&](std::size_t entry, const ViewFactor& f) {
          put(entry, f);
          append(text, f);
        });
        if (with.journal != nullptr) with.journal->add(name, text);
      });
}

}  // namespace exactff::matrix
