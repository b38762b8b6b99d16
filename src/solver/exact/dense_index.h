// Numbers items from 0 in the order in which they are first requested.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace exactff::exact {

class DenseIndex {
 public:
  // Forgets all items. From now on, item i is below `count`.
  void clear(std::size_t count) {
    first_ = next_ = 0;
    number_.assign(count, kNone);
  }
  // The number of item i, and whether it is new.
  struct Found {
    std::uint32_t number;
    bool is_new;
  };
  Found find(std::uint32_t i) {
    const bool is_new = number_[i] == kNone || number_[i] < first_;
    if (is_new) number_[i] = next_++;
    return {number_[i] - first_, is_new};
  }
  // Starts again from 0, without clearing the table.
  void restart() { first_ = next_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::uint32_t first_ = 0, next_ = 0;
  std::vector<std::uint32_t> number_;
};

}  // namespace exactff::exact
