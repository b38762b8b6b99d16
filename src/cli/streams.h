// Standard streams that whoever started the program may have closed.
#pragma once

namespace exactff::cli {

// Puts something that refuses every byte in the place of closed streams. The first file that the program opens would
// otherwise take the number of standard output, and what is printed would go into that file.
void occupy_closed_streams();

}  // namespace exactff::cli
