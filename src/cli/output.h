// Small helpers of the commands: text to numbers and faces, files written whole or not at all.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <string>

#include "exactff/scene.h"

namespace exactff::cli {

std::string percent(double share);
std::string pad(const std::string& text, std::size_t width);

// A finite double, read with correct rounding; InputError names the flag.
double parse_finite(const std::string& text, const std::string& flag);

// "NAME:k", or "NAME" of a patch with one face.
FaceId select_face(const Scene& scene, const std::string& name);

// Writes beside `path` and renames: the file appears whole or not at all. Throws InputError.
void write_whole_file(const std::filesystem::path& path, const std::string& text);

// Throws InputError if what was printed could not be written (a full disk, say).
void check_output(std::ostream& out);

}  // namespace exactff::cli
