#include "page/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>
#include <utility>
#include <vector>

#include "text/characters.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::page {
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

// Our environment with another locale: the scripts are UTF-8 on every machine.
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

// Restores the default action of SIGXFSZ (file size limit exceeded) in the child, whatever this process does.
class SpawnAttributes {
 public:
  SpawnAttributes() {
    ::posix_spawnattr_init(&attributes_);
    sigset_t restored;
    ::sigemptyset(&restored);
    ::sigaddset(&restored, SIGXFSZ);
    ::posix_spawnattr_setsigdefault(&attributes_, &restored);
    ::posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnAttributes() { ::posix_spawnattr_destroy(&attributes_); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;
  [[nodiscard]] const posix_spawnattr_t* get() const { return &attributes_; }

 private:
  posix_spawnattr_t attributes_{};
};

struct Child {
  int error = 0;  // why it could not be started; 0 if it was
  int status = 0;
  std::string given_up;  // why it was ended early; empty if it was not
};

bool has_ended(pid_t child, int& status) {
  const pid_t result = ::waitpid(child, &status, WNOHANG);
  return result == child || (result < 0 && errno != EINTR);
}

void wait_for(pid_t pid, const std::function<bool()>& cancelled, Child& child) {
  constexpr auto kLongest = std::chrono::seconds(60);
  const auto start = std::chrono::steady_clock::now();
  for (auto pause = std::chrono::milliseconds(1); !has_ended(pid, child.status);) {
    if (cancelled && cancelled()) child.given_up = "interrupted";
    if (std::chrono::steady_clock::now() - start > kLongest) child.given_up = "it took longer than a minute";
    if (!child.given_up.empty()) {
      ::kill(pid, SIGKILL);
      while (::waitpid(pid, &child.status, 0) < 0 && errno == EINTR) {
      }
      return;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::milliseconds(20));
  }
}

// Started without a shell, so no name needs quoting.
Child run(const fs::path& script, const fs::path& out, const fs::path& err, const std::function<bool()>& cancelled) {
  SpawnActions actions;
  actions.open(STDIN_FILENO, "/dev/null", O_RDONLY);
  actions.open(STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  actions.open(STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
  const SpawnAttributes attributes;
  std::string program = "gnuplot", defaults = "-d", file = script.string();
  const std::array<char*, 4> arguments = {program.data(), defaults.data(), file.data(), nullptr};
  const Utf8Environment environment;
  Child child;
  pid_t pid = 0;
  child.error = ::posix_spawnp(&pid, "gnuplot", actions.get(), attributes.get(), arguments.data(), environment.get());
  if (child.error == 0) wait_for(pid, cancelled, child);
  return child;
}

bool is_missing(const Child& child) {
  const bool unable = WIFEXITED(child.status) && WEXITSTATUS(child.status) == 127;
  return child.error == ENOENT || child.error == EACCES || (child.error == 0 && unable);
}

std::string complaint(const Child& child, const fs::path& err) {
  constexpr std::size_t kShown = 500;
  if (child.error != 0) return std::strerror(child.error);
  if (!child.given_up.empty()) return child.given_up;
  return std::string(text::beginning(contents(err), kShown));
}

void remove_between(std::string& text, std::string_view begin, std::string_view end) {
  for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
    const std::size_t close = text.find(end, at + begin.size());
    if (close == std::string::npos) return;
    text.erase(at, close + end.size() - at);
  }
}

}  // namespace

PlotResult run_gnuplot(std::string_view script, const fs::path& scratch, const std::function<bool()>& cancelled) {
  const fs::path in = scratch / "figure.gp", out = scratch / "figure.svg", err = scratch / "figure.err";
  PlotResult result;
  std::ofstream file(in, std::ios::binary);
  file << script;
  file.close();
  if (!file) {
    result.message = "its script could not be written; the disk may be full";
  } else if (const Child child = run(in, out, err, cancelled); is_missing(child)) {
    result.outcome = PlotResult::Outcome::kNoProgram;
  } else {
    result.svg = contents(out);
    result.message = complaint(child, err);
    const bool drawn = child.error == 0 && child.status == 0 && result.svg.find("</svg>") != std::string::npos;
    if (drawn) result.outcome = PlotResult::Outcome::kDrawn;
  }
  std::error_code ignored;
  for (const fs::path& used : {in, out, err}) fs::remove(used, ignored);
  return result;
}

std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view title) {
  const std::size_t begin = svg.find("<svg");
  const std::size_t end = svg.rfind("</svg>");
  if (begin == std::string_view::npos || end == std::string_view::npos) return {};
  std::string text(svg.substr(begin, end + 6 - begin));
  remove_between(text, "<title>", "</title>");
  remove_between(text, "<desc>", "</desc>");
  remove_between(text, "xmlns=\"", "\"");
  remove_between(text, "xmlns:xlink=\"", "\"");
  const std::string mark(prefix);
  text::replace_all(text, "id='", "id='" + mark + '-');
  text::replace_all(text, "id=\"", "id=\"" + mark + '-');
  text::replace_all(text, "xlink:href='#", "href='#" + mark + '-');
  text::replace_all(text, "url(#", "url(#" + mark + '-');
  text::replace_all(text, " color=\"black\"", "");
  text::replace_all(text, "'black'", "'currentColor'");
  text::replace_all(text, "\"black\"", "\"currentColor\"");
  text::replace_all(text, "fill=\"#ffffff\"",
                    "fill=\"none\"");  // a background of its own; the page has one for every figure
  text::replace_all(text, "stroke-width='0.178'", "stroke-width='0.3'");  // open marks, which are thin on a phone
  text.insert(4, " role=\"img\" aria-label=\"" + text::html(title) + "\"");
  return text;
}

}  // namespace exactff::page
