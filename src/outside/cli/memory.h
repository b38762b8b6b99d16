// Running out of memory ends the program with exit code 4 and a message, wherever it happens. Before main() begins, and
// before the first allocation, memory.cpp arranges that uncaught exceptions end the program in this way and that
// jemalloc does not crash.
#pragma once

namespace exactff::cli {

// GMP and FLINT end the program with abort() when memory is exhausted. After this call they throw std::bad_alloc like
// all other code. This requires that the libraries were built with unwind tables (on x86-64 and AArch64 all are). The
// memory that they held is then lost, so this is for programs that end soon after. Call it before the first thread is
// started.
void throw_when_out_of_memory();

}  // namespace exactff::cli
