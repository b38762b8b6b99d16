#include "text/text_file.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <system_error>

#include "exactff/error.h"

namespace exactff::text {

namespace {

[[noreturn]] void refuse_binary(const std::string& file, std::string_view block, const std::string& purpose) {
  const bool utf16 = block.starts_with("\xFF\xFE") || block.starts_with("\xFE\xFF");
  throw InputError({file, 0, utf16 ? "is UTF-16 text" : "is not a text file",
                    utf16 ? "only UTF-8 is read" : "it contains zero bytes",
                    utf16 ? "save it as UTF-8" : "give " + purpose});
}

[[noreturn]] void cannot_read(const std::string& file, const std::string& purpose) {
  const std::string reason = errno != 0 ? std::strerror(errno) : "reading failed";
  throw InputError({file, 0, "cannot be read to its end", reason, "give " + purpose + " that can be read"});
}

std::size_t read_block(std::istream& in, std::span<char> block, const std::string& file, const std::string& purpose) {
  if (!in) return 0;
  errno = 0;
  try {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
  } catch (const std::ios_base::failure&) {
    cannot_read(file, purpose);
  }
  if (in.bad()) cannot_read(file, purpose);
  return static_cast<std::size_t>(in.gcount());
}

}  // namespace

void require_text(std::string_view bytes, const std::string& file, const std::string& purpose) {
  if (bytes.find('\0') != std::string_view::npos) refuse_binary(file, bytes, purpose);
}

std::size_t read_text_block(std::istream& in, std::span<char> block, const std::string& file,
                            const std::string& purpose) {
  const std::size_t count = read_block(in, block, file, purpose);
  require_text({block.data(), count}, file, purpose);
  return count;
}

std::string read_text(std::istream& in, const std::string& file, const std::string& purpose) {
  std::string text;
  std::array<char, 1 << 16> block{};
  while (const std::size_t count = read_text_block(in, block, file, purpose)) text.append(block.data(), count);
  return text;
}

std::ifstream open_text_file(const std::filesystem::path& path, const std::string& purpose) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError({path.string(), 0, "is a folder", "a file is needed", "name " + purpose + " in this folder"});
  }
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError({path.string(), 0, "cannot be opened", std::strerror(errno), "check the path"});
  return in;
}

std::string read_file(const std::filesystem::path& path, const std::string& purpose) {
  std::error_code ignored;
  const bool device = std::filesystem::is_character_file(path, ignored);
  std::ifstream in = open_text_file(path, purpose);
  std::string bytes;
  std::array<char, 1 << 16> block{};
  const std::string file = path.string();
  while (const std::size_t count = (device ? read_text_block : read_block)(in, block, file, purpose))
    bytes.append(block.data(), count);
  return bytes;
}

std::string read_text_file(const std::filesystem::path& path, const std::string& purpose) {
  std::ifstream in = open_text_file(path, purpose);
  return read_text(in, path.string(), purpose);
}

}  // namespace exactff::text
