#include "files/npy_file.h"

#include "text/refuse.h"

namespace exactff::files {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
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
  const std::size_t before = kMagic.size() + 4;  // two bytes of version, two of the length
  text.append(kAlignment - 1 - (before + text.size()) % kAlignment, ' ');
  text += '\n';
  if (text.size() > 0xffff) {
    text::refuse("the array has " + std::to_string(shape.size()) + " axes", "NumPy files hold fewer", "use fewer axes");
  }
  std::string bytes(kMagic);
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

}  // namespace exactff::files
