// Runs the program under test the way a script would.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
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

// The program with its standard error in a file, its standard output nowhere, and whatever `prepare` does to the new
// process first. Whoever starts it waits for it.
class RunningProgram {
 public:
  RunningProgram(
      const std::string& program, const std::vector<std::string>& arguments, std::filesystem::path error_file,
      const std::function<void()>& prepare = [] {});

  void send(int signal) const;
  // As a shell tells it: 128 + the signal where one ended the program.
  int wait() const;
  [[nodiscard]] bool has_ended() const;  // does not wait; wait() tells how
  [[nodiscard]] int process() const { return child_; }
  [[nodiscard]] std::string error() const;

 private:
  std::filesystem::path error_file_;
  int child_ = 0;
};

// A directory of its own that disappears with the object.
class TemporaryDirectory {
 public:
  explicit TemporaryDirectory(const std::filesystem::path& parent = std::filesystem::temp_directory_path());
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  // Writes a file and returns where it is.
  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

// A variable of this process's environment that has another value while the object lives.
class EnvironmentVariable {
 public:
  EnvironmentVariable(std::string name, const std::string& value);
  ~EnvironmentVariable();
  EnvironmentVariable(const EnvironmentVariable&) = delete;
  EnvironmentVariable& operator=(const EnvironmentVariable&) = delete;

 private:
  std::string name_;
  std::optional<std::string> before_;
};

// Where syncing costs nothing, if there is such a place; else where temporary files are.
[[nodiscard]] std::filesystem::path memory_folder();

// What a file holds; its size, 0 where there is none.
[[nodiscard]] std::string text_of(const std::filesystem::path& path);
[[nodiscard]] std::uintmax_t size_of(const std::filesystem::path& path);

// `point FILE --at ... --normal ... --source ... --plain` for a scene written as OBJ with 17 digits.
[[nodiscard]] ProgramRun run_point_plain(const std::string& program, const std::string& name,
                                         const generate::PlainScene& scene);

}  // namespace exactff::validation
