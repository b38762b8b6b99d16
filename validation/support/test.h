// What nearly every test includes: GoogleTest, the usual standard headers, folders and files of a test, the program as
// a script runs it, and the words of messages.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "support/complaint.h"
#include "support/folder.h"
#include "support/holds.h"
#include "support/program.h"

namespace exactff {

using Words = std::vector<std::string>;  // of a command line

namespace validation {

inline Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

inline testing::AssertionResult is_part(const char*, const char*, const std::string& text, const std::string& part) {
  if (holds(text, part)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << part << "\" is not in:\n" << text;
}

}  // namespace validation

using validation::complaint;
using validation::EnvironmentVariable;
using validation::holds;
using validation::joined;
using validation::memory_folder;
using validation::names_in;
using validation::ProgramRun;
using validation::run_exactff;
using validation::run_program;
using validation::RunningProgram;
using validation::size_of;
using validation::TemporaryDirectory;
using validation::text_of;
using validation::write_text;

}  // namespace exactff

#define EXPECT_HOLDS(text, part) EXPECT_PRED_FORMAT2(exactff::validation::is_part, text, part)
