#include "cli/streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <initializer_list>

namespace exactff::cli {

// open() returns the lowest free number, so ascending order matters.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    const int wrong_way = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    (void)::open("/dev/null", wrong_way);
  }
}

}  // namespace exactff::cli
