#include "cli/memory.h"

#include <fcntl.h>
#include <flint/flint.h>
#include <gmp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "cli/exit_code.h"

#ifdef EXACTFF_HAS_JEMALLOC
#include <jemalloc/jemalloc.h>

// Read by jemalloc at the first allocation.
extern "C" {
__attribute__((visibility("default"))) const char* malloc_conf = nullptr;
}
#endif

namespace exactff::cli {

namespace {

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

// Does not allocate, and works before any stream is constructed.
[[noreturn]] void end_at_once() {
  constexpr std::string_view kMessage =
      "exactff: out of memory, or stopped by an unexpected error (no result was written); raise the memory limit\n";
  (void)!::write(STDERR_FILENO, kMessage.data(), kMessage.size());
  std::_Exit(kInternalFailure);
}

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

// Whether the system refuses memory at some point, instead of ending a process that uses too much.
bool memory_may_end() { return is_limited(RLIMIT_AS) || is_limited(RLIMIT_DATA) || never_overcommits(); }

#ifdef EXACTFF_HAS_JEMALLOC
// If there is no memory for a thread's cache, jemalloc 5.3.0 does not notice, and the thread's first allocation
// dereferences a null pointer. Code outside jemalloc cannot detect this. So threads have no caches if memory may end.
// Otherwise they have them, since the caches are a large part of jemalloc's speed.
void do_without_caches() { malloc_conf = "tcache:false"; }

// As long as there is only one thread, it may have its cache after all: it has just freed a hundred times the memory
// that a cache takes, and no other thread can take that memory before the cache is made.
void give_the_only_thread_its_cache() {
  if (malloc_conf == nullptr) return;  // caches are on
  std::array<void*, 32> pieces{};
  constexpr std::size_t kBytes = 64 << 10;
  for (void*& piece : pieces) piece = ::mallocx(kBytes, 0);
  bool enabled = std::ranges::count(pieces, nullptr) == 0;
  for (void* piece : pieces) {
    if (piece != nullptr) ::dallocx(piece, 0);
  }
  if (enabled) ::mallctl("thread.tcache.enabled", nullptr, nullptr, &enabled, sizeof enabled);
}
#endif

// glibc calls abort() if it cannot register the destructor of a thread_local variable. If there is no memory while it
// is loaded, oneTBB 2022, which Embree uses, reads through a null pointer.
void end_where_a_library_fails(int /*signal*/) { end_at_once(); }

// From main() on, such a read is a fault of ours. A sanitizer's handler is left alone.
void let_faults_be_faults() {
  struct sigaction now {};
  if (::sigaction(SIGSEGV, nullptr, &now) == 0 && now.sa_handler == end_where_a_library_fails)
    std::signal(SIGSEGV, SIG_DFL);
}

void prepare_before_the_first_allocation(int /*count*/, char** /*arguments*/, char** /*environment*/) {
  std::set_terminate(end_at_once);  // the constructors of the libraries allocate, too
  if (!memory_may_end()) return;
  std::signal(SIGABRT, end_where_a_library_fails);
  std::signal(SIGSEGV, end_where_a_library_fails);
#ifdef EXACTFF_HAS_JEMALLOC
  do_without_caches();
#endif
}

// The loader calls this function before it initialises any library.
__attribute__((section(".preinit_array"), used)) void (*const kBeforeAll)(int, char**,
                                                                          char**) = prepare_before_the_first_allocation;

}  // namespace

void throw_when_out_of_memory() {
  let_faults_be_faults();
#ifdef EXACTFF_HAS_JEMALLOC
  give_the_only_thread_its_cache();
#endif
  mp_set_memory_functions(allocate, reallocate_known, release_known);
  __flint_set_memory_functions(allocate, allocate_cleared, reallocate, release);
}

}  // namespace exactff::cli
