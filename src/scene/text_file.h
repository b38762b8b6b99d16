// Input files as text: read whole, or refused with a message that says why.
#pragma once

#include <filesystem>
#include <istream>
#include <string>

namespace exactff {

// Throws InputError where there is no such file, it is a directory, cannot be read to its end, or holds zero bytes
// (binary data, UTF-16, a device that never ends). `purpose` completes "give ...": "a Wavefront OBJ file".
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path, const std::string& purpose);

// The same from an open stream, called `file` in messages.
[[nodiscard]] std::string read_text(std::istream& in, const std::string& file, const std::string& purpose);

}  // namespace exactff
