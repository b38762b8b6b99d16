// The program: parse, call, print. Exit codes: 0 done, 1 a check failed, 2 bad input, 3 not as accurate or certified as
// asked, 4 internal.
#include <fcntl.h>
#include <flint/flint.h>
#include <gmp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/error.h"
#include "exactff/version.h"
#include "flags/values.h"
#include "text/escape.h"

namespace {

// --- streams that the caller has closed ---

// Opens a file that refuses every byte in the place of each closed stream. Otherwise the first file that the program
// opens would get the number of standard output, and printed text would go into that file. open() returns the lowest
// free number, so ascending order matters.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    const int wrong_way = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    (void)::open("/dev/null", wrong_way);
  }
}

// --- running out of memory ends the program with exit code 4 and a message, wherever it happens ---

// Some functions of GMP free the memory of a number before they allocate more. If that allocation fails, the number
// still points to freed memory, and its destructor must not free it again. So after a failure nothing is freed.
std::atomic<bool> has_failed = false;

// The libraries never allocate zero bytes, for which null would not be a failure.
void* or_throw(void* memory) {
  if (memory != nullptr) return memory;
  has_failed = true;
  throw std::bad_alloc();
}

void* allocate(std::size_t size) { return or_throw(std::malloc(size)); }
void* allocate_cleared(std::size_t count, std::size_t size) { return or_throw(std::calloc(count, size)); }
void* reallocate(void* memory, std::size_t size) { return or_throw(std::realloc(memory, size)); }
void* reallocate_known(void* memory, std::size_t /*old_size*/, std::size_t size) { return reallocate(memory, size); }
void release(void* memory) {
  if (!has_failed.load(std::memory_order_relaxed)) std::free(memory);
}
void release_known(void* memory, std::size_t /*size*/) { release(memory); }

// GMP and FLINT end the program with abort() when memory is exhausted. After this call they throw std::bad_alloc like
// all other code. This requires that the libraries were built with unwind tables (on x86-64 and AArch64 all are). The
// memory that they held is then lost, but the program ends soon. Called before the first thread is started.
void throw_when_out_of_memory() {
  mp_set_memory_functions(allocate, reallocate_known, release_known);
  __flint_set_memory_functions(allocate, allocate_cleared, reallocate, release);
}

// Does not allocate, and works before any stream is constructed.
[[noreturn]] void end_at_once() {
  constexpr std::string_view kMessage =
      "exactff: out of memory, or stopped by an unexpected error (no result was written); raise the memory limit\n";
  (void)!::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  std::_Exit(exactff::cli::kInternalFailure);
}
void end_where_a_library_fails(int /*signal*/) { end_at_once(); }

bool is_limited(__rlimit_resource resource) {
  rlimit limit{};
  return ::getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

// In mode 2, Linux refuses memory that it might not have.
bool never_overcommits() {
  const int file = ::open("/proc/sys/vm/overcommit_memory", O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  char mode = '0';
  const bool read = ::read(file, &mode, 1) == 1;
  ::close(file);
  return read && mode == '2';
}

// Libraries that do not notice that memory ends: glibc calls abort() if it cannot register the destructor of a
// thread_local variable. If there is no memory while it is loaded, oneTBB 2022, which Embree uses, reads through a null
// pointer, and so does jemalloc 5.3.0 if there is none for a thread's cache. These signals are handled only where the
// system refuses memory at some point, instead of ending a process that uses too much.
void prepare_before_the_first_allocation(int /*count*/, char** /*arguments*/, char** /*environment*/) {
  std::set_terminate(end_at_once);  // the constructors of the libraries allocate, too
  if (!is_limited(RLIMIT_AS) && !is_limited(RLIMIT_DATA) && !never_overcommits()) return;
  std::signal(SIGABRT, end_where_a_library_fails);
  std::signal(SIGSEGV, end_where_a_library_fails);
}

// The loader calls this function before it initialises any library.
__attribute__((section(".preinit_array"), used)) void (*const kBeforeAll)(int, char**,
                                                                          char**) = prepare_before_the_first_allocation;

// --- the command line ---

constexpr const char* kDescription =
    "exactff: exact form factors from a point to a polygonal source, with occluders\n"
    "\n"
    "The form factor F from a point x to a patch s is the share of the diffuse light leaving x that reaches s\n"
    "directly:\n"
    "  F = integral over the part of s visible from x of  max(0, cos th_r) max(0, cos th_s) / (pi r^2) dA\n"
    "r is the distance, th_r and th_s are the angles to the normals at x and on s. A receiver is a point x with its\n"
    "normal. A source is a patch s. An occluder is a face between them that hides part of s. A value is certified if\n"
    "it is proved to be F rounded to the nearest double.\n"
    "\n"
    "`exactff help COMMAND` explains a command and its flags. Start with `exactff info SCENE`, which lists the names\n"
    "of the patches. Then, for example:\n"
    "  exactff point SCENE --at X Y Z --normal NX NY NZ --source NAME\n"
    "  exactff compare SCENE --on NAME --grid 32x32 -o DIR\n"
    "  exactff truth SCENE --on NAME --grid 32x32 -o truth.csv\n"
    "  exactff check truth.csv CANDIDATE.csv --max-abs 1e-4";

void prepare_for_the_worst() {
  occupy_closed_streams();
  throw_when_out_of_memory();
  std::signal(SIGXFSZ, SIG_IGN);  // writing beyond a limit on file sizes then fails, as on a full disk
}

int end_of_parsing(const CLI::App& app, const CLI::ParseError& error) {
  if (exactff::cli::launched_rank() > 0) return 0;  // under mpirun only rank 0 prints it
  std::ostringstream out, err;
  const bool done = app.exit(error, out, err) == 0;  // --help, --version
  std::string words = err.str();
  constexpr std::string_view kExcludes = " excludes ";
  if (const std::size_t at = words.find(kExcludes); error.get_name() == "ExcludesError" && at != std::string::npos)
    words.replace(at, kExcludes.size(), " cannot be given with ");
  std::cerr << exactff::text::printable(words, "\n");
  std::cout << out.str();
  return done ? 0 : exactff::cli::kBadInput;
}

// The exit code, if there is nothing to run.
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (argc > 1 && *argv[1] != '-') exactff::cli::require_command(app, argv[1]);
  exactff::cli::refuse_flags_without_values(app, words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) exactff::cli::refuse_misused_flags(app, words);
    return end_of_parsing(app, error);
  }
  for (const CLI::App* command : app.get_subcommands()) exactff::flags::require_outputs_apart(*command);
  return std::nullopt;
}

// Under mpirun, every process finds the same mistake, and only rank 0 tells it.
std::optional<int> parse_and_tell_once(CLI::App& app, int argc, char** argv) {
  try {
    return parse(app, argc, argv);
  } catch (const exactff::InputError&) {
    if (exactff::cli::launched_rank() > 0) return 0;
    throw;
  }
}

int parse_and_run(int argc, char** argv) {
  CLI::App app(kDescription, "exactff");
  app.formatter(exactff::cli::help_formatter());
  app.set_version_flag("--version", std::string("exactff ") + exactff::kVersion);
  app.require_subcommand(0, 1);
  const std::vector<exactff::cli::Command> commands = exactff::cli::add_commands(app);
  if (const std::optional<int> exit_code = parse_and_tell_once(app, argc, argv)) return *exit_code;
  for (const exactff::cli::Command& command : commands) {
    if (command.app->parsed()) return exactff::cli::unless_interrupted(command.run);
  }
  std::cerr << app.help() << "\nGive one of the commands.\n";
  return exactff::cli::kBadInput;
}

}  // namespace

int main(int argc, char** argv) {
  prepare_for_the_worst();
  return exactff::cli::exit_code_of([&] {
    const int exit_code = parse_and_run(argc, argv);
    exactff::cli::check_output(std::cout);
    return exit_code;
  });
}
