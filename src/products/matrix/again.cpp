#include "matrix/again.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "files/parallel.h"
#include "matrix/columns.h"
#include "text/phrases.h"
#include "view_factors/pairs.h"

namespace exactff::matrix {
namespace {

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

// One line for each entry. Returns false, and takes nothing, if the text has other lines.
template <class Put>
bool take_kept(std::string_view text, const std::vector<std::size_t>& entries, const Put& put) {
  std::vector<Entry> lines(entries.size());
  for (Entry& line : lines) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos || !columns().read_csv(text.substr(0, end), line)) return false;
    text.remove_prefix(end + 1);
  }
  for (std::size_t k = 0; k < entries.size(); ++k) put(entries[k], lines[k].factor);
  return text.empty();
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
  files::parallel_for(
      wanted.size(), with.threads, "view factors again", shifted(with, again.entries.size()), [&](std::size_t i) {
        const std::vector<std::size_t>& entries = pairs.entries_of(wanted[i]);
        const std::string name = name_of(scene, again.factors, part.entry_in_all(entries.front(), width));
        const auto kept = with.journal != nullptr ? with.journal->find(name) : std::nullopt;
        if (kept && take_kept(*kept, entries, put)) return;
        std::string text;
        Entry line;
        pairs.compute(wanted[i], [&](std::size_t entry, const ViewFactor& f) {
          put(entry, f);
          line.factor = f;
          columns().append_csv(line, text);
        });
        if (with.journal != nullptr) with.journal->add(name, text);
      });
}

}  // namespace exactff::matrix
