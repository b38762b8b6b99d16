// Times of calls on a steady clock, in seconds.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace exactff::files {

template <class Call>
double seconds_of(const Call& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The median over at most `most` calls; no further call begins once they have taken `limit` seconds together.
template <class Call>
double median_seconds(const Call& call, std::size_t most, double limit) {
  std::vector<double> times;
  for (double total = 0.0; times.size() < most && total < limit; total += times.back()) {
    times.push_back(seconds_of(call));
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

}  // namespace exactff::files
