// Refuses input that no line belongs to: flags that contradict each other, or a file or folder as a whole; or a line.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "exactff/error.h"

namespace exactff::text {

[[noreturn]] inline void refuse(std::string what, std::string why, std::string suggestion) {
  throw InputError({.what = std::move(what), .why = std::move(why), .suggestion = std::move(suggestion)});
}

[[noreturn]] inline void refuse(const std::filesystem::path& file, std::size_t line, std::string what, std::string why,
                                std::string suggestion) {
  throw InputError(Problem{file.string(), line, std::move(what), std::move(why), std::move(suggestion)});
}

[[noreturn]] inline void refuse(const std::filesystem::path& file, std::string what, std::string why,
                                std::string suggestion) {
  refuse(file, 0, std::move(what), std::move(why), std::move(suggestion));
}

}  // namespace exactff::text
