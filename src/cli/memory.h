// What happens where memory ends: exit code 4 and a message, wherever it is. Before main() begins, and before the first
// allocation, memory.cpp has what nobody catches end the program so, and jemalloc kept from crashing.
#pragma once

namespace exactff::cli {

// GMP and FLINT end the program with abort() when memory is exhausted. After this call they throw std::bad_alloc like
// everything else, to whom the libraries were built with unwind tables (on x86-64 and AArch64 all are). What they held
// is lost then, so it is for programs that end soon after. Call it before the first thread is started.
void throw_when_out_of_memory();

}  // namespace exactff::cli
