// Files: input as text, read whole or refused with a message that says why; and where output belongs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <istream>
#include <span>
#include <string>

namespace exactff {

// Throws InputError where there is no such file, it is a directory, cannot be read to its end, or holds zero bytes
// (binary data, UTF-16, a device that never ends). `purpose` completes "give ...": "a Wavefront OBJ file".
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path, const std::string& purpose);

// The same from an open stream, called `file` in messages.
[[nodiscard]] std::string read_text(std::istream& in, const std::string& file, const std::string& purpose);

// The same in two steps, for what need not be held whole. A block is full unless the file ends in it; 0 at its end.
[[nodiscard]] std::ifstream open_text_file(const std::filesystem::path& path, const std::string& purpose);
[[nodiscard]] std::size_t read_text_block(std::istream& in, std::span<char> block, const std::string& file,
                                          const std::string& purpose);

// Where a file that takes the place of `path` belongs: where a symbolic link leads to, else the path itself.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path);

}  // namespace exactff
