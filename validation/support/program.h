// Runs the program under test the way a script would.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "generate/plain_scene.h"

namespace exactff::validation {

struct ProgramRun {
  std::string output;  // standard output
  int exit_code = -1;
};

// Standard error goes to the test's own.
[[nodiscard]] ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments);

// A directory of its own that disappears with the object.
class TemporaryDirectory {
 public:
  TemporaryDirectory();
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  // Writes a file and returns where it is.
  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

// `point FILE --at ... --normal ... --source ... --plain` for a scene written as OBJ with 17 digits.
[[nodiscard]] ProgramRun run_point_plain(const std::string& program, const std::string& name,
                                         const generate::PlainScene& scene);

}  // namespace exactff::validation
