// Marks on items, all of which are forgotten at once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace exactff::visibility {

class RunMarks {
 public:
  // Forgets all marks, in the existing memory. From now on, item i is below `count`.
  void clear(std::size_t count) {
    marked_in_.resize(count, 0);
    if (++run_ != 0) return;
    std::fill(marked_in_.begin(), marked_in_.end(), 0U);
    run_ = 1;
  }
  void set(std::uint32_t i) { marked_in_[i] = run_; }
  [[nodiscard]] bool is_set(std::uint32_t i) const { return marked_in_[i] == run_; }

 private:
  std::uint32_t run_ = 0;
  std::vector<std::uint32_t> marked_in_;  // by item: the last run that marked it
};

}  // namespace exactff::visibility
