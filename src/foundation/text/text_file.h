// Input files, read as a whole or refused with the reason.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <istream>
#include <span>
#include <string>
#include <string_view>

namespace exactff::text {

// Throws InputError if the file does not exist, is a directory, cannot be read to its end, or contains NUL bytes
// (binary data, UTF-16, a device that never ends). `purpose` completes "give ...": "a Wavefront OBJ file".
[[nodiscard]] std::string read_text_file(const std::filesystem::path& path, const std::string& purpose);

// The same from an open stream, called `file` in messages.
[[nodiscard]] std::string read_text(std::istream& in, const std::string& file, const std::string& purpose);

// The same for a file that may be binary. A device is read only if it gives text: it might never end.
[[nodiscard]] std::string read_file(const std::filesystem::path& path, const std::string& purpose);
// Throws InputError if the bytes are no text, as read_text_file does.
void require_text(std::string_view bytes, const std::string& file, const std::string& purpose);

// read_text_file in two steps, for files that need not be held as a whole. A block is full unless the file ends in it;
// returns 0 at the end.
[[nodiscard]] std::ifstream open_text_file(const std::filesystem::path& path, const std::string& purpose);
[[nodiscard]] std::size_t read_text_block(std::istream& in, std::span<char> block, const std::string& file,
                                          const std::string& purpose);

}  // namespace exactff::text
