// A method that is ready to be called for a scene and its sources.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

struct PreparedMethod {
  std::unique_ptr<methods::PreparedScene> scene;
  std::vector<std::unique_ptr<methods::PreparedSource>> owned;
  std::vector<const methods::PreparedSource*> sources;

  PreparedMethod(const methods::Method& method, const Scene& given, std::span<const Selection> selections);
};

// Prepares a method when it is first needed. Throws InputError, each time, if it refuses the scene.
class PreparedMethods {
 public:
  explicit PreparedMethods(const Request& request) : request_(request) {}
  [[nodiscard]] const PreparedMethod& of(const methods::Method& method);

 private:
  const Request& request_;
  std::map<const methods::Method*, PreparedMethod> prepared_;
};

// With this seed; seed 0 leaves the choice unchanged.
[[nodiscard]] methods::Choice with_seed(methods::Choice choice, std::uint64_t seed);

}  // namespace exactff::study
