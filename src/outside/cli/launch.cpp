#include "cli/launch.h"

#include <dlfcn.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <system_error>

#include "exactff/error.h"

namespace exactff::cli {
namespace {

namespace fs = std::filesystem;

// The variables that launchers set: Open MPI's mpirun; the MPICH family and srun --mpi=pmi2; srun --mpi=pmix.
constexpr std::array kRanks = {"OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"};
constexpr std::array kSizes = {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"};

template <class Names>
std::optional<int> number_in_environment(const Names& names) {
  for (const char* name : names) {
    const char* text = std::getenv(name);
    int number = 0;
    if (text != nullptr && std::from_chars(text, text + std::strlen(text), number).ec == std::errc{}) return number;
  }
  return std::nullopt;
}

bool launched_with_others() {
  const std::optional<int> size = number_in_environment(kSizes);
  return size ? *size > 1 : number_in_environment(kRanks).has_value();
}

[[noreturn]] void refuse(std::string why_not) {
  throw InputError(
      {.what = "several processes were started together, but MPI is not available: " + std::move(why_not),
       .why = "each process would do all the work",
       .suggestion =
           "start only one process, use --shard, or build exactff with libboost-mpi-dev and libopenmpi-dev installed"});
}

// The module is beside the program in the build folder, or where it is installed.
fs::path module_path() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {"exactff_mpi.so", EXACTFF_INSTALLED_MPI}) {
    if (fs::exists(folder / place, error)) return folder / place;
  }
  refuse("this program was built without it");
}

}  // namespace

int launched_rank() { return number_in_environment(kRanks).value_or(0); }

std::unique_ptr<jobs::Team> join_team() {
  if (!launched_with_others()) return nullptr;
  // RTLD_GLOBAL: Open MPI loads its own components, which need its symbols. The module is never closed.
  void* module = ::dlopen(module_path().c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (module == nullptr) refuse(::dlerror());
  using Join = jobs::Team*();
  auto* const join = reinterpret_cast<Join*>(::dlsym(module, "exactff_join_mpi"));
  if (join == nullptr) refuse(::dlerror());
  std::unique_ptr<jobs::Team> team(join());
  return team->size() > 1 ? std::move(team) : nullptr;
}

}  // namespace exactff::cli
