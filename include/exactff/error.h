// Errors in the input. Numerical outcomes are statuses, never exceptions. Programming errors are reported as
// std::logic_error with a message, for example for an object used after it was moved from. Its subclass
// std::invalid_argument is thrown for an id that does not exist and for a source or selection of another scene.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace exactff {

// One problem in the input, or one warning. The wording is always "FILE:LINE: problem (why it matters); suggestion".
// Empty parts are left out.
struct Problem {
  std::string file = {};
  std::size_t line = 0;  // counted from 1; 0 if no line applies
  std::string what = {};
  std::string why = {};
  std::string suggestion = {};

  [[nodiscard]] std::string message() const;
};

// Bad input: all problems found, in the order of the input. what() has one message per line.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(Problem problem);

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace exactff
