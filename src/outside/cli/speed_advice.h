// What `exactff matrix` says while it takes long: what would be faster.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "exactff/matrix.h"
#include "exactff/progress.h"

namespace exactff::cli {

// A note that is printed once, on stderr, if the work is neither done after some seconds nor soon will be. It names the
// pair that takes long.
class LateNote {
 public:
  explicit LateNote(std::string text) : text_(std::move(text)) {}

  void follow(const Progress& progress);  // several times a second

 private:
  static constexpr double kLate = 5.0, kNameable = 6.0;  // seconds; after the second, any pair that is slow has a name

  const std::string text_;
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
