#include <algorithm>
#include <stdexcept>

#include "exactff/methods.h"

namespace exactff::methods {

void Counters::add(std::string_view name, std::uint64_t count) {
  for (std::size_t i = 0; i < size_; ++i) {
    if (counters_[i].name != name) continue;
    counters_[i].count += count;
    return;
  }
  if (size_ == kMost) throw std::logic_error("too many counters");
  counters_[size_++] = {name, count};
}

std::uint64_t Counters::operator[](std::string_view name) const {
  const auto counters = list();
  const auto found = std::find_if(counters.begin(), counters.end(), [&](const Counter& c) { return c.name == name; });
  return found == counters.end() ? 0 : found->count;
}

void Evaluator::form_factors(std::span<const PreparedSource* const> sources, std::span<Estimate> estimates) {
  for (std::size_t i = 0; i < sources.size(); ++i) estimates[i] = form_factor(*sources[i]);
}

std::unique_ptr<PreparedSource> PreparedScene::prepare_source(const Selection& selection) const {
  return std::make_unique<PreparedSource>(selection);
}

}  // namespace exactff::methods
