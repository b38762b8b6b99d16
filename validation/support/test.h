// What nearly every test includes: GoogleTest, the usual standard headers, the public headers of the library, scenes by
// hand and at random, folders and files of a test, the program as a script runs it, and the words of messages.
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

#include "exactff/adaptive.h"
#include "exactff/check.h"
#include "exactff/enclosure.h"
#include "exactff/error.h"
#include "exactff/exact.h"
#include "exactff/exr.h"
#include "exactff/geometry.h"
#include "exactff/jobs.h"
#include "exactff/matrix.h"
#include "exactff/methods.h"
#include "exactff/models.h"
#include "exactff/radiosity.h"
#include "exactff/receiver.h"
#include "exactff/region.h"
#include "exactff/render.h"
#include "exactff/scene.h"
#include "exactff/scene_files.h"
#include "exactff/settings.h"
#include "exactff/slips.h"
#include "exactff/study.h"
#include "exactff/table.h"
#include "exactff/truth.h"
#include "exactff/view.h"
#include "exactff/view_factors.h"
#include "support/complaint.h"
#include "support/folder.h"
#include "support/holds.h"
#include "support/program.h"
#include "support/random_scenes.h"
#include "support/shapes.h"

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
