// The contents of a glTF 2.0 file, by the package tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <string_view>

#include "formats/mesh_input.h"

namespace exactff::formats {

// Members of the types that glTF prescribes, and the bytes of all buffers. Indices are not checked. Reads no files but
// those of the buffers, which become files of the scene. Throws InputError.
[[nodiscard]] tinygltf::Model load_gltf(std::string_view bytes, const std::filesystem::path& path, MeshInput& input);

}  // namespace exactff::formats
