// Handles standard streams that the caller has closed.
#pragma once

namespace exactff::cli {

// Opens a file that refuses every byte in the place of each closed stream. Otherwise the first file that the program
// opens would get the number of standard output, and printed text would go into that file.
void occupy_closed_streams();

}  // namespace exactff::cli
