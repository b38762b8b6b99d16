// Arbitrary bytes as a PLY file.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz/scene_file_checks.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  exactff::validation::check_scene_file({reinterpret_cast<const char*>(data), size}, "s.ply");
  return 0;
}
