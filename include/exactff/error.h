// The user's mistakes. Numerical outcomes are statuses, never exceptions. A program's own mistakes are std::logic_error
// with words: an object used after it was moved from; and, as std::invalid_argument, an id that does not exist or a
// source or selection of another scene.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace exactff {

// One thing wrong with the input (or worth a warning), in the fixed wording
// "FILE:LINE: problem (why it matters); suggestion". Empty parts are left out.
struct Problem {
  std::string file = {};
  std::size_t line = 0;  // from 1; 0 where no line applies
  std::string what = {};
  std::string why = {};
  std::string suggestion = {};

  [[nodiscard]] std::string message() const;
};

// Bad input: every problem found, in the order of the input. what() holds one message a line.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(Problem problem);

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace exactff
