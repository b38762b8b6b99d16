#include "cli/memory.h"

#include <flint/flint.h>
#include <gmp.h>

#include <cstdlib>
#include <new>

namespace exactff::cli {

namespace {

// The libraries never ask for nothing, where null would be no failure.
void* or_throw(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

void* allocate(std::size_t size) { return or_throw(std::malloc(size)); }
void* allocate_cleared(std::size_t count, std::size_t size) { return or_throw(std::calloc(count, size)); }
void* reallocate(void* memory, std::size_t size) { return or_throw(std::realloc(memory, size)); }
void* reallocate_known(void* memory, std::size_t /*old_size*/, std::size_t size) { return reallocate(memory, size); }
void release(void* memory) { std::free(memory); }
void release_known(void* memory, std::size_t /*size*/) { std::free(memory); }

}  // namespace

void throw_when_out_of_memory() {
  mp_set_memory_functions(allocate, reallocate_known, release_known);
  __flint_set_memory_functions(allocate, allocate_cleared, reallocate, release);
}

}  // namespace exactff::cli
