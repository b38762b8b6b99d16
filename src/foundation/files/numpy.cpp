#include "files/numpy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/crc.hpp>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <system_error>

#include "kernel/expect.h"
#include "text/encoding.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::files {

// --- one array, written ---

namespace {

constexpr std::string_view kMagicNumber = "\x93NUMPY";
constexpr std::size_t kAlignment = 64;  // of the elements in the file, so that they can be mapped into memory

// As Python writes a tuple: (), (3,), (3, 4).
std::string tuple(std::span<const std::size_t> shape) {
  std::string text = "(";
  for (const std::size_t extent : shape) text += (text.size() > 1 ? " " : "") + std::to_string(extent) + ",";
  if (shape.size() > 1) text.pop_back();
  return text + ")";
}

}  // namespace

std::string npy_header(std::string_view type, std::span<const std::size_t> shape) {
  std::string text = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': " + tuple(shape) + ", }";
  const std::size_t before = kMagicNumber.size() + 4;  // two bytes of version, two of the length
  text.append(kAlignment - 1 - (before + text.size()) % kAlignment, ' ');
  text += '\n';
  if (text.size() > 0xffff) {
    text::refuse("the array has " + std::to_string(shape.size()) + " axes", "NumPy files hold fewer", "use fewer axes");
  }
  std::string bytes(kMagicNumber);
  bytes += {'\1', '\0', static_cast<char>(text.size() & 0xff), static_cast<char>(text.size() >> 8)};
  return bytes + text;
}

std::size_t npy_count(const std::filesystem::path& path, std::span<const std::size_t> shape) {
  std::size_t count = 1;
  for (const std::size_t extent : shape) {
    if (__builtin_mul_overflow(count, extent, &count)) {
      text::refuse(path, "an array of the shape " + tuple(shape) + " has more than 2^64 elements", "no file holds them",
                   "use a smaller array");
    }
  }
  return count;
}

// --- one array, read ---

namespace {

// What follows a key in the header, a Python dictionary: {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }.
// Empty if there is no such key.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t at = header.find("'" + std::string(key) + "':");
  return at == std::string_view::npos ? std::string_view() : text::trimmed(header.substr(at + key.size() + 3));
}

class NpyReader {
 public:
  explicit NpyReader(const std::filesystem::path& path)
      : path_(path), bytes_(text::read_file(path, "a NumPy array")), rest_(bytes_) {}

  NpyArray read() {
    if (!is_npy(rest_)) damaged("is no NumPy file");
    const std::string_view header = take_header();
    const std::string_view type = needed(header, "descr");
    NpyArray array{shape_of(needed(header, "shape")), {}};
    const std::size_t count = npy_count(path_, array.shape);
    if (type.find("f8") != std::string_view::npos) {
      read_elements<double, std::uint64_t>(type, count, array.values);
    } else if (type.find("f4") != std::string_view::npos) {
      read_elements<float, std::uint32_t>(type, count, array.values);
    } else {
      text::refuse(path_, "holds elements of the type " + text::in_quotes(type), "float64 and float32 are read",
                   "save array.astype(float)");
    }
    if (needed(header, "fortran_order").starts_with("True")) transpose(array);
    return array;
  }

 private:
  [[noreturn]] void damaged(const std::string& what) const {
    text::refuse(path_, what, "its numbers cannot be read", "write it again with numpy.save");
  }

  // Version 1.0 has two bytes of length, later ones four.
  std::string_view take_header() {
    constexpr std::size_t kVersion = 6;
    const bool is_first = rest_.size() > kVersion && rest_[kVersion] == '\1';
    const std::size_t start = kVersion + (is_first ? 4 : 6);
    if (rest_.size() < start) damaged("is cut off in its header");
    std::size_t length = 0;
    for (std::size_t i = start; i-- > kVersion + 2;) length = length << 8U | static_cast<unsigned char>(rest_[i]);
    if (rest_.size() - start < length) damaged("is cut off in its header");
    const std::string_view header = rest_.substr(start, length);
    rest_.remove_prefix(start + length);
    return header;
  }

  std::string_view needed(std::string_view header, const std::string& key) const {
    const std::string_view value = value_of(header, key);
    if (value.empty()) damaged("has no '" + key + "' in its header");
    return value.substr(0, 80);
  }

  std::vector<std::size_t> shape_of(std::string_view text) const {
    const std::size_t end = text.find(')');
    if (!text.starts_with('(') || end == std::string_view::npos) damaged("has no shape in its header");
    const std::string all(text.substr(0, end + 1));
    std::vector<std::size_t> shape;
    for (text = text.substr(1, end - 1); !text::trimmed(text).empty();) {
      text = text::trimmed(text);
      const auto number = std::from_chars(text.data(), text.data() + text.size(), shape.emplace_back());
      if (number.ec != std::errc{}) damaged("has an impossible shape in its header: " + text::in_quotes(all));
      text.remove_prefix(static_cast<std::size_t>(number.ptr - text.data()));
      if (text.starts_with(',')) text.remove_prefix(1);
    }
    return shape;
  }

  template <class Element, class Bits>
  void read_elements(std::string_view type, std::size_t count, std::vector<double>& values) const {
    if (rest_.size() / sizeof(Bits) != count || rest_.size() % sizeof(Bits) != 0) {
      damaged("has " + std::to_string(rest_.size()) + " bytes of elements, not those of " + std::to_string(count) +
              " numbers");
    }
    const bool reversed = (type.find('>') != std::string_view::npos) == (std::endian::native == std::endian::little);
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      std::array<char, sizeof(Bits)> bytes;
      std::memcpy(bytes.data(), rest_.data() + i * sizeof(Bits), sizeof(Bits));
      if (reversed) std::ranges::reverse(bytes);
      values.push_back(double{std::bit_cast<Element>(bytes)});
    }
  }

  // From Fortran order, in which the first index runs fastest, to C order.
  static void transpose(NpyArray& array) {
    const std::vector<double> given = array.values;
    std::vector<std::size_t> index(array.shape.size(), 0);
    for (double& value : array.values) {
      std::size_t at = 0;
      for (std::size_t axis = index.size(); axis-- > 0;) at = at * array.shape[axis] + index[axis];
      value = given[at];
      for (std::size_t axis = index.size(); axis-- > 0 && ++index[axis] == array.shape[axis];) index[axis] = 0;
    }
  }

  std::filesystem::path path_;
  std::string bytes_;
  std::string_view rest_;
};

}  // namespace

bool is_npy(std::string_view bytes) { return bytes.starts_with(kMagicNumber); }

bool is_npy_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::array<char, kMagicNumber.size()> bytes{};
  std::ifstream in(path, std::ios::binary);
  return in.read(bytes.data(), bytes.size()) && is_npy({bytes.data(), bytes.size()});
}

NpyArray read_npy(const std::filesystem::path& path) { return NpyReader(path).read(); }

// --- several arrays ---

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

// --- several arrays, read ---

namespace {

template <class T>
T number_in(std::string_view bytes, std::size_t at) {
  T value{};
  if (at + sizeof(T) <= bytes.size()) read_little_endian(bytes.substr(at, sizeof(T)), std::span<T>(&value, 1));
  return value;
}

}  // namespace

NpzReader::NpzReader(const std::filesystem::path& path)
    : path_(path), bytes_(text::read_file(path, "a table in an archive of NumPy")) {
  constexpr std::size_t kHeader = 30, kNpyStart = 10;
  const std::string_view all = bytes_;
  for (std::size_t at = 0; number_in<std::uint32_t>(all, at) == kLocalHeader;) {
    const auto method = number_in<std::uint16_t>(all, at + 8);
    const auto checksum = number_in<std::uint32_t>(all, at + 14), size = number_in<std::uint32_t>(all, at + 18);
    const std::size_t name = number_in<std::uint16_t>(all, at + 26), extra = number_in<std::uint16_t>(all, at + 28);
    const std::size_t start = at + kHeader + name + extra;
    if (method != kStored) damaged("holds compressed arrays");
    if (start + size > all.size()) damaged("is cut off");
    const std::string_view content = all.substr(start, size);
    boost::crc_32_type found;
    found.process_bytes(content.data(), content.size());
    if (found.checksum() != checksum) damaged("has an array whose checksum is wrong");
    const std::size_t header = kNpyStart + number_in<std::uint16_t>(content, 8);
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
  if (!value_of(found->header, "descr").starts_with('\'' + std::string(type))) {
    damaged("has other elements than " + text::in_quotes(type) + " in its array " + text::in_quotes(name));
  }
  return *found;
}

std::vector<std::string> NpzReader::texts(std::string_view name) const {
  const Array& found = array(name, "<U");
  const std::string_view width_text = value_of(found.header, "descr").substr(3);
  std::size_t width = 0;
  std::from_chars(width_text.data(), width_text.data() + width_text.size(), width);
  if (width == 0 || found.elements.size() % (4 * width) != 0) damaged("has a damaged array " + text::in_quotes(name));
  std::vector<std::string> texts(found.elements.size() / (4 * width));
  for (std::size_t i = 0; i < found.elements.size() / 4; ++i) {
    const auto code = number_in<std::uint32_t>(found.elements, 4 * i);
    if (code != 0) text::append_utf8(texts[i / width], code);
  }
  return texts;
}

std::string NpzReader::word(std::string_view name) const { return std::string(elements(name, "|S")); }

void NpzReader::damaged(const std::string& what) const {
  text::refuse(path_, what, "its arrays cannot be read", "write it again");
}

}  // namespace exactff::files
