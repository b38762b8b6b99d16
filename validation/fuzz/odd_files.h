// Random input files for the whole program, as a careless or hostile user might write them: scenes of the random
// families with names that may break a reader of the outputs, receivers, truth and candidate tables and images,
// baselines, study files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

// Contents by path. Paths are relative to the folder of a case.
using Files = std::map<std::string, std::string>;

struct OddInputs {
  Files files;
  generate::PlainScene scene;  // as in in/scene.obj, unless that file was damaged
};

[[nodiscard]] OddInputs odd_inputs(generate::Random& random);

// Control characters, quotes, markup, Latin-1, blanks, texts like an option or the name of a face; no line end, no NUL.
[[nodiscard]] std::string odd_name(generate::Random& random);
// Mostly a usable number; otherwise an extreme one, one out of range, or not a number.
[[nodiscard]] std::string odd_number(generate::Random& random);

template <class T>
[[nodiscard]] const T& one_of(generate::Random& random, const std::vector<T>& items) {
  return items[random.below(items.size())];
}

}  // namespace exactff::validation
