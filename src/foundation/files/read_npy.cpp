#include "files/read_npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>

#include "files/npy_file.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::files {
namespace {

constexpr std::string_view kMagicNumber = "\x93NUMPY";

// The header is a Python dictionary: {'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }
class NpyReader {
 public:
  explicit NpyReader(const std::filesystem::path& path)
      : path_(path), bytes_(text::read_file(path, "a NumPy array")), rest_(bytes_) {}

  NpyArray read() {
    if (!is_npy(rest_)) damaged("is no NumPy file");
    const std::string_view header = take_header();
    const std::string_view type = value_of(header, "descr");
    NpyArray array{shape_of(value_of(header, "shape")), {}};
    const std::size_t count = npy_count(path_, array.shape);
    if (type.find("f8") != std::string_view::npos) {
      read_elements<double, std::uint64_t>(type, count, array.values);
    } else if (type.find("f4") != std::string_view::npos) {
      read_elements<float, std::uint32_t>(type, count, array.values);
    } else {
      text::refuse(path_, "holds elements of the type " + text::in_quotes(type), "float64 and float32 are read",
                   "save array.astype(float)");
    }
    if (value_of(header, "fortran_order").starts_with("True")) transpose(array);
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

  std::string_view value_of(std::string_view header, const std::string& key) const {
    const std::size_t at = header.find("'" + key + "':");
    if (at == std::string_view::npos) damaged("has no '" + key + "' in its header");
    return text::trimmed(header.substr(at + key.size() + 3).substr(0, 80));
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

}  // namespace exactff::files
