// Preloaded under mpirun: rank SLOW_RANK is slow to end after the others have finished, as on a loaded machine.

#include <dlfcn.h>

#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>

extern "C" int MPI_Finalize() {
  auto* const finalize = reinterpret_cast<int (*)()>(::dlsym(RTLD_DEFAULT, "PMPI_Finalize"));
  const int result = finalize();
  const char* rank = std::getenv("OMPI_COMM_WORLD_RANK");
  const char* slow = std::getenv("SLOW_RANK");
  if (rank != nullptr && slow != nullptr && std::string_view(rank) == slow)
    std::this_thread::sleep_for(std::chrono::seconds(1));
  return result;
}
