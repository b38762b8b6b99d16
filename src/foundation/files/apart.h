// No output replaces what is read, or another output.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace exactff::files {

// What is read or written, and what it is called in messages: "SCENE", "--npz", "the journal of -o". Perhaps nothing.
struct NamedFile {
  std::string called;
  std::filesystem::path file;
};

// All throw an InputError that names both files. Links, symbolic and hard, and other spellings of a name are followed.
// Pipes and devices may have any number of uses.

void require_not_read(const NamedFile& output, std::span<const NamedFile> read);
void require_not_read(const std::filesystem::path& output, std::span<const std::filesystem::path> read);
void require_apart(std::span<const NamedFile> outputs);
// Of a folder that is replaced as a whole.
void require_none_inside(const NamedFile& folder, std::span<const NamedFile> read, std::span<const NamedFile> written);

}  // namespace exactff::files
