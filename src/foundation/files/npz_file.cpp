#include "files/npz_file.h"

#include <algorithm>
#include <boost/crc.hpp>
#include <charconv>
#include <limits>

#include "kernel/expect.h"
#include "text/encoding.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::files {
namespace {

constexpr std::uint32_t kLocalHeader = 0x04034b50, kCentralHeader = 0x02014b50, kEnd = 0x06054b50;
constexpr std::uint16_t kVersionNeeded = 20, kStored = 0;
// 1 January 1980, the first day that the format knows: the bytes depend on the arrays alone.
constexpr std::uint16_t kTime = 0, kDate = (1U << 5U) | 1U;

template <class T>
std::string bytes_of(const T& value) {
  return little_endian(std::span<const T>(&value, 1));
}

template <class... Numbers>
std::string bytes_of_all(const Numbers&... numbers) {
  return (bytes_of(numbers) + ...);
}

std::vector<std::uint32_t> characters_of(const std::string& given) {
  const std::string text = text::in_utf8(given);
  std::vector<std::uint32_t> codes;
  for (std::size_t at = 0; at < text.size();) {
    const text::Character character = text::character_at(text, at);
    codes.push_back(character.code);
    at += character.bytes;
  }
  return codes;
}

}  // namespace

void NpzFile::require_room(std::size_t bytes) const {
  if (written_ + bytes <= std::numeric_limits<std::uint32_t>::max()) return;
  text::refuse("the .npz file would be larger than 4 GiB", "its directory counts bytes in 32 bits",
               "write fewer rows at a time");
}

void NpzFile::append(const std::string& bytes) {
  require_room(bytes.size());
  written_ += bytes.size();
  file_.append(bytes);
}

void NpzFile::add_bytes(std::string_view name, const std::string& header, const std::string& elements) {
  EXACTFF_EXPECT(std::ranges::find(entries_, std::string(name) + ".npy", &Entry::name) == entries_.end());
  boost::crc_32_type checksum;
  checksum.process_bytes(header.data(), header.size());
  checksum.process_bytes(elements.data(), elements.size());
  require_room(header.size() + elements.size());
  const Entry entry{std::string(name) + ".npy", checksum.checksum(),
                    static_cast<std::uint32_t>(header.size() + elements.size()), static_cast<std::uint32_t>(written_)};
  append(bytes_of_all(kLocalHeader, kVersionNeeded, std::uint16_t{0}, kStored, kTime, kDate, entry.checksum, entry.size,
                      entry.size, static_cast<std::uint16_t>(entry.name.size()), std::uint16_t{0}) +
         entry.name);
  append(header);
  append(elements);
  entries_.push_back(entry);
}

void NpzFile::add_texts(std::string_view name, const std::vector<std::string>& texts) {
  std::vector<std::vector<std::uint32_t>> all;
  std::size_t longest = 1;
  for (const std::string& text : texts) longest = std::max(longest, all.emplace_back(characters_of(text)).size());
  std::string elements;
  for (std::vector<std::uint32_t>& codes : all) {
    codes.resize(longest, 0);
    elements += little_endian(std::span<const std::uint32_t>(codes));
  }
  const std::size_t count = texts.size();
  add_bytes(name, npy_header("<U" + std::to_string(longest), std::span(&count, 1)), elements);
}

void NpzFile::add_word(std::string_view name, std::string_view word) {
  add_bytes(name, npy_header("|S" + std::to_string(word.size()), {}), std::string(word));
}

void NpzFile::commit() {
  const std::uint64_t begin = written_;
  for (const Entry& entry : entries_) {
    append(bytes_of_all(kCentralHeader, kVersionNeeded, kVersionNeeded, std::uint16_t{0}, kStored, kTime, kDate,
                        entry.checksum, entry.size, entry.size, static_cast<std::uint16_t>(entry.name.size()),
                        std::uint64_t{0}, std::uint32_t{0}, entry.offset) +
           entry.name);
  }
  const auto count = static_cast<std::uint16_t>(entries_.size());
  const auto size = static_cast<std::uint32_t>(written_ - begin);
  append(bytes_of_all(kEnd, std::uint16_t{0}, std::uint16_t{0}, count, count, size, static_cast<std::uint32_t>(begin),
                      std::uint16_t{0}));
  file_.commit();
}

// --- Reading ---

namespace {

template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value{};
  if (at + sizeof(T) <= bytes.size()) read_little_endian(bytes.substr(at, sizeof(T)), std::span<T>(&value, 1));
  return value;
}

// The value after "'KEY': " in the header of an array.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  return at == std::string_view::npos ? std::string_view() : header.substr(at + key.size());
}

}  // namespace

NpzReader::NpzReader(const std::filesystem::path& path)
    : path_(path), bytes_(text::read_file(path, "a table in an archive of NumPy")) {
  constexpr std::size_t kHeader = 30, kNpyStart = 10;
  const std::string_view all = bytes_;
  for (std::size_t at = 0; number_at<std::uint32_t>(all, at) == kLocalHeader;) {
    const auto method = number_at<std::uint16_t>(all, at + 8);
    const auto checksum = number_at<std::uint32_t>(all, at + 14), size = number_at<std::uint32_t>(all, at + 18);
    const std::size_t name = number_at<std::uint16_t>(all, at + 26), extra = number_at<std::uint16_t>(all, at + 28);
    const std::size_t start = at + kHeader + name + extra;
    if (method != kStored) damaged("holds compressed arrays");
    if (start + size > all.size()) damaged("is cut off");
    const std::string_view content = all.substr(start, size);
    boost::crc_32_type found;
    found.process_bytes(content.data(), content.size());
    if (found.checksum() != checksum) damaged("has an array whose checksum is wrong");
    const std::size_t header = kNpyStart + number_at<std::uint16_t>(content, 8);
    if (header > content.size()) damaged("has an array that is cut off");
    arrays_.push_back({std::string(all.substr(at + kHeader, name)), content.substr(0, header), content.substr(header)});
    at = start + size;
  }
  if (arrays_.empty()) damaged("is no archive of NumPy arrays");
}

const NpzReader::Array* NpzReader::find(std::string_view name) const {
  const auto found = std::ranges::find(arrays_, std::string(name) + ".npy", &Array::name);
  return found == arrays_.end() ? nullptr : &*found;
}

const NpzReader::Array& NpzReader::array(std::string_view name, std::string_view type) const {
  const Array* const found = find(name);
  if (found == nullptr) damaged("has no array " + text::in_quotes(name));
  if (!value_of(found->header, "'descr': '").starts_with(type)) {
    damaged("has other elements than " + text::in_quotes(type) + " in its array " + text::in_quotes(name));
  }
  return *found;
}

std::vector<std::string> NpzReader::texts(std::string_view name) const {
  const Array& found = array(name, "<U");
  const std::string_view width_text = value_of(found.header, "'descr': '<U");
  std::size_t width = 0;
  std::from_chars(width_text.data(), width_text.data() + width_text.size(), width);
  if (width == 0 || found.elements.size() % (4 * width) != 0) damaged("has a damaged array " + text::in_quotes(name));
  std::vector<std::string> texts(found.elements.size() / (4 * width));
  for (std::size_t i = 0; i < found.elements.size() / 4; ++i) {
    const auto code = number_at<std::uint32_t>(found.elements, 4 * i);
    if (code != 0) text::append_utf8(texts[i / width], code);
  }
  return texts;
}

std::string NpzReader::word(std::string_view name) const { return std::string(elements(name, "|S")); }

void NpzReader::damaged(const std::string& what) const {
  text::refuse(path_, what, "its arrays cannot be read", "write it again");
}

}  // namespace exactff::files
