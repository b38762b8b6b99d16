// The library's own, under the name by which tests know it, and what only tests and tools need.
#pragma once

#include <utility>
#include <vector>

#include "models/random.h"

namespace exactff {
namespace generate = models;

namespace models {

template <class T>
void shuffle(Random& random, std::vector<T>& items) {
  for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[random.below(i)]);
}

}  // namespace models
}  // namespace exactff
