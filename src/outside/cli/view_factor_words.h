// What the commands that compute view factors do and say alike.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exactff/jobs.h"
#include "exactff/matrix.h"
#include "flags/scene.h"

namespace exactff::cli {

// With the backs of the patches and faces in `two_sided`. Prints the scene's warnings.
[[nodiscard]] Scene load(const flags::SceneArguments& args, const std::vector<std::string>& two_sided);

// Of fronts of these columns that overlap, if any do: what to do about it. Found by estimates, before anything is
// computed.
[[nodiscard]] std::optional<Problem> problem_of_overlaps(const Scene& scene, std::span<const Selection> columns);

// The matrix in a file of exactff matrix; `options` become those of the file. Throws InputError if it is of another
// scene, or of other patches.
[[nodiscard]] matrix::Matrix matrix_in_file(const std::string& file, const Scene& scene,
                                            const std::vector<Selection>& from, const std::vector<Selection>& to,
                                            ViewFactorOptions& options);

// The flags --claim and --certify, which is short for --claim certified.
struct ClaimOptions {
  CLI::Option *claim = nullptr, *certify = nullptr;
};
ClaimOptions add_claim(CLI::App& command, bool& certify);

// For each reason why entries are wider than the accuracy: the widest of them, and what would help.
[[nodiscard]] std::vector<Problem> problems_of_width(const Scene& scene, const matrix::Matrix& matrix,
                                                     const ViewFactorOptions& options);

inline constexpr const char* kBudgetHelp =
    "Limit of work for an entry: the most cells, where one with many edges counts for several, and the most points";

inline constexpr const char* kTwoSidedHelp =
    "Patches or faces, named as in --from, whose backs are patches as well, NAME (back), with the same Kd and Ke";

// --- what `exactff matrix` says while it takes long: what would be faster ---

// A note that is printed once, on stderr, if the work is neither done after some seconds nor soon will be. It names the
// pair that takes long.
class LateNote {
 public:
  // `text` is asked for when it is told, if ever.
  explicit LateNote(std::function<std::string()> text) : text_(std::move(text)) {}

  void follow(const Progress& progress);  // several times a second

 private:
  static constexpr double kLate = 5.0, kNameable = 6.0;  // seconds; after the second, any pair that is slow has a name

  const std::function<std::string()> text_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::optional<std::size_t> done_before_;  // by a run that is continued
  bool told_ = false;
};

// These hooks (Hooks, jobs::RowHooks), of which `progress` also serves the note. Keeps a reference to it.
template <class Kind>
Kind with_note(LateNote& note, Kind hooks) {
  hooks.progress = [&note, show = std::move(hooks.progress)](const Progress& progress) {
    note.follow(progress);
    show(progress);
  };
  return hooks;
}

// "Faster: --accuracy 0.001 instead of 1e-06; a smaller --budget than 100000, for wider entries; ..."
[[nodiscard]] std::string words_on_speed(const matrix::Request& request);

}  // namespace exactff::cli
