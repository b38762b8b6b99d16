// Random input files of the whole program, written by somebody careless or hostile: scenes of the random families under
// names that some reader of the outputs may choke on, receivers, truth and candidate tables, baselines, study files.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generate/plain_scene.h"
#include "generate/random.h"

namespace exactff::validation {

// By their paths relative to the folder of a case.
using Files = std::map<std::string, std::string>;

struct OddInputs {
  Files files;
  generate::PlainScene scene;  // as in/scene.obj has it, unless that was spoilt
};

[[nodiscard]] OddInputs odd_inputs(generate::Random& random);

// Control characters, quotes, markup, Latin-1, blanks, what looks like an option or a face's name; no line end, no NUL.
[[nodiscard]] std::string odd_name(generate::Random& random);
// Mostly a usable number; else an extreme one, one out of range, or none at all.
[[nodiscard]] std::string odd_number(generate::Random& random);

template <class T>
[[nodiscard]] const T& one_of(generate::Random& random, const std::vector<T>& items) {
  return items[random.below(items.size())];
}

}  // namespace exactff::validation
