// Times of calls in seconds, on a steady clock or of the processor.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <vector>

namespace exactff::files {

// Processor time of this thread, which does not depend on what else the machine does.
inline double thread_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

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
