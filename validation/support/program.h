// Runs the tested program as a script would.
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
  std::string error;  // standard error, which the test repeats on its own
};
[[nodiscard]] ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments);
#ifdef EXACTFF_PROGRAM
[[nodiscard]] inline ProgramRun run_exactff(const std::vector<std::string>& arguments) {
  return run_program(EXACTFF_PROGRAM, arguments);
}
#endif

// The running program. Its standard error goes to a file, its standard output is discarded, and `prepare` is called in
// the new process first. The owner must wait for it.
class RunningProgram {
 public:
  RunningProgram(
      const std::string& program, const std::vector<std::string>& arguments, std::filesystem::path error_file,
      const std::function<void()>& prepare = [] {});

  void send(int signal) const;
  // The exit code as a shell reports it: 128 + the signal if a signal ended the program.
  int wait() const;
  [[nodiscard]] bool has_ended() const;  // does not wait; wait() returns the exit code
  [[nodiscard]] int process() const { return child_; }
  [[nodiscard]] std::string error() const;

 private:
  std::filesystem::path error_file_;
  int child_ = 0;
};

// A new directory that is removed with the object.
class TemporaryDirectory {
 public:
  explicit TemporaryDirectory(const std::filesystem::path& parent = std::filesystem::temp_directory_path());
  ~TemporaryDirectory();
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  // Writes a file and returns its path.
  [[nodiscard]] std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

// Sets a variable of this process's environment during the lifetime of the object.
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

// A folder in memory, where syncing is free, if there is one; otherwise the folder for temporary files.
[[nodiscard]] std::filesystem::path memory_folder();

// The contents of a file; its size, which is 0 if there is no such file.
[[nodiscard]] std::string text_of(const std::filesystem::path& path);
[[nodiscard]] std::uintmax_t size_of(const std::filesystem::path& path);

// Runs `point FILE --at ... --normal ... --source ... --plain` for a scene written as OBJ with 17 digits.
[[nodiscard]] ProgramRun run_point_plain(const std::string& program, const std::string& name,
                                         const generate::PlainScene& scene);

}  // namespace exactff::validation
