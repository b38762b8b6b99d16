#include "cli/exit_code.h"

#include <exception>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>

#include "exactff/error.h"
#include "text/escape.h"

namespace exactff::cli {
namespace {

constexpr const char* kOutOfMemory =
    "exactff: out of memory (the scene and the request need more than is available); nothing was written; use a "
    "smaller scene or grid or fewer --threads, or raise the limit\n";

}  // namespace

int exit_code_of(const std::function<int()>& command) {
  try {
    return command();
  } catch (const InputError& error) {
    std::cerr << "exactff: " << error.what() << '\n';
    return kBadInput;
  } catch (const std::bad_alloc&) {
    std::cerr << kOutOfMemory;
  } catch (const std::length_error&) {  // more than any memory could hold
    std::cerr << kOutOfMemory;
  } catch (const std::system_error& error) {
    std::cerr << "exactff: the operating system refused a request: " << text::printable(error.what())
              << " (a thread could not be started or a file could not be opened); nothing was written; try --threads "
                 "1, or raise the limits\n";
  } catch (const std::exception& error) {
    std::cerr << "exactff: internal failure: " << text::printable(error.what())
              << " (this is a bug in exactff); please report it with the scene and the command line\n";
  }
  return kInternalFailure;
}

}  // namespace exactff::cli
