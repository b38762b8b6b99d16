// The names of a file that are not UTF-8. They are converted, and the user is told once for each file.
#pragma once

#include <set>
#include <string>
#include <string_view>

#include "exactff/error.h"

namespace exactff {

class ConvertedNames {
 public:
  void add(std::size_t line, std::string_view name);
  [[nodiscard]] const std::set<std::string>& names() const { return names_; }  // as they are in the file
  [[nodiscard]] Problem warning(const std::string& file) const;                // requires at least one name

 private:
  std::set<std::string> names_;
  std::string first_;
  std::size_t first_line_ = 0;
};

}  // namespace exactff
