#include "study/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "study/text.h"

namespace exactff::study {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class SpawnActions {
 public:
  SpawnActions() { ::posix_spawn_file_actions_init(&actions_); }
  ~SpawnActions() { ::posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;

  void open(int descriptor, const char* path, int flags) {
    ::posix_spawn_file_actions_addopen(&actions_, descriptor, path, flags, 0600);
  }
  [[nodiscard]] const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

// Our environment but for the locale: the scripts are UTF-8 wherever they run.
class Utf8Environment {
 public:
  Utf8Environment() {
    for (char** entry = environ; *entry != nullptr; ++entry) {
      if (!std::string_view(*entry).starts_with("LC_ALL=")) entries_.push_back(*entry);
    }
    entries_.push_back(locale_.data());
    entries_.push_back(nullptr);
  }
  [[nodiscard]] char* const* get() const { return entries_.data(); }

 private:
  std::string locale_ = "LC_ALL=C.UTF-8";
  std::vector<char*> entries_;
};

// The exit status, or nothing where the program is not there. No shell: no name needs quoting.
std::pair<bool, int> run(const fs::path& script, const fs::path& out, const fs::path& err) {
  SpawnActions actions;
  actions.open(STDIN_FILENO, "/dev/null", O_RDONLY);
  actions.open(STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  actions.open(STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  std::string program = "gnuplot", defaults = "-d", file = script.string();
  const std::array<char*, 4> arguments = {program.data(), defaults.data(), file.data(), nullptr};
  const Utf8Environment environment;
  pid_t child = 0;
  if (::posix_spawnp(&child, "gnuplot", actions.get(), nullptr, arguments.data(), environment.get()) != 0) {
    return {false, 0};
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) return {false, 0};
  return {true, status};
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

void remove_between(std::string& text, std::string_view begin, std::string_view end) {
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    const std::size_t close = text.find(end, at + begin.size());
    if (close == std::string::npos) return;
    text.erase(at, close + end.size() - at);
  }
}

}  // namespace

PlotResult run_gnuplot(std::string_view script, const fs::path& scratch) {
  const fs::path in = scratch / "figure.gp", out = scratch / "figure.svg", err = scratch / "figure.err";
  std::ofstream(in, std::ios::binary) << script;
  const auto [started, status] = run(in, out, err);
  PlotResult result;
  if (!started) {
    result.outcome = PlotResult::Outcome::kNoProgram;
  } else {
    result.svg = contents(out);
    result.message = contents(err);
    const bool drawn = status == 0 && result.svg.find("</svg>") != std::string::npos;
    result.outcome = drawn ? PlotResult::Outcome::kDrawn : PlotResult::Outcome::kFailed;
  }
  std::error_code ignored;
  for (const fs::path& file : {in, out, err}) fs::remove(file, ignored);
  return result;
}

std::string inlined(std::string_view svg, std::string_view prefix, std::string_view title) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t end = svg.rfind("</svg>");
  if (begin == std::string_view::npos || end == std::string_view::npos) return {};
  std::string text(svg.substr(begin, end + 6 - begin));
  remove_between(text, "<title>", "</title>");
  remove_between(text, "<desc>", "</desc>");
  remove_between(text, "xmlns=\"", "\"");
  remove_between(text, "xmlns:xlink=\"", "\"");
  const std::string mark(prefix);
  replace_all(text, "id='", "id='" + mark + '-');
  replace_all(text, "id=\"", "id=\"" + mark + '-');
  replace_all(text, "xlink:href='#", "href='#" + mark + '-');
  replace_all(text, "url(#", "url(#" + mark + '-');
  replace_all(text, " color=\"black\"", "");
  replace_all(text, "'black'", "'currentColor'");
  replace_all(text, "\"black\"", "\"currentColor\"");
  text.insert(4, " role=\"img\" aria-label=\"" + html(title) + "\"");
  return text;
}

}  // namespace exactff::study
