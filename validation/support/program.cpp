#include "support/program.h"

#include <stdlib.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace exactff::validation {

namespace {

std::string quoted(const std::string& word) {
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace

ProgramRun run_program(const std::string& program, const std::vector<std::string>& arguments) {
  std::string command = quoted(program);
  for (const std::string& argument : arguments) command += ' ' + quoted(argument);
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  ProgramRun run;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe))
    run.output.append(buffer.data(), count);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  return run;
}

TemporaryDirectory::TemporaryDirectory() {
  std::string name = (std::filesystem::temp_directory_path() / "exactff_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary directory");
  path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryDirectory::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return path_ / name;
}

ProgramRun run_point_plain(const std::string& program, const std::string& name, const generate::PlainScene& scene) {
  constexpr auto kDigits = generate::Digits::kSeventeen;
  const TemporaryDirectory directory;
  const std::filesystem::path path = directory.write(name + ".obj", generate::to_obj(scene, "", kDigits));
  std::vector<std::string> arguments{"point", path.string()};
  const auto add = [&](const char* flag, const Vec3& v) {
    arguments.insert(arguments.end(), {flag, generate::to_text(v.x, kDigits), generate::to_text(v.y, kDigits),
                                       generate::to_text(v.z, kDigits)});
  };
  add("--at", scene.point);
  add("--normal", scene.normal);
  arguments.insert(arguments.end(), {"--source", scene.source, "--plain"});
  return run_program(program, arguments);
}

}  // namespace exactff::validation
