// The layout of a header (OpenEXR file layout, version 2): attributes (name, 0, type, 0, size in 4 bytes, value), then
// a 0. A file of several parts has a header for each, then a 0.
#include "exr/exr_guard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace exactff::exr {
namespace {

constexpr std::uint32_t kOfSeveralParts = 0x1000;
constexpr double kMostCompression = 5000.0;  // of a file's bytes; zlib reaches 1032
constexpr double kAlwaysAllowed = 1 << 20;   // bytes
constexpr double kBytesOfOffset = 8.0;       // of a piece of the image in the table of offsets
constexpr double kMostRowsOfPiece = 256.0;   // of any compression
constexpr double kFurthest = 1 << 30;        // so that sums of coordinates fit

// Reads little-endian numbers. Nothing beyond the end.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}

  [[nodiscard]] std::size_t left() const { return rest_.size(); }
  [[nodiscard]] std::optional<std::string_view> take(std::size_t count) {
    if (count > rest_.size()) return std::nullopt;
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  [[nodiscard]] std::optional<std::uint32_t> number() {
    const auto taken = take(4);
    if (!taken) return std::nullopt;
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i)
      value = value << 8U | static_cast<unsigned char>((*taken)[static_cast<std::size_t>(i)]);
    return value;
  }
  // Up to a 0, which is skipped. A name has at most 255 bytes.
  [[nodiscard]] std::optional<std::string_view> name() {
    const std::size_t end = rest_.substr(0, 256).find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view taken = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return taken;
  }

 private:
  std::string_view rest_;
};

struct FixedSize {
  std::string_view type;
  std::size_t bytes;
};
constexpr std::array kFixedSizes = {
    FixedSize{"box2i", 16},      FixedSize{"box2f", 16},   FixedSize{"chromaticities", 32},
    FixedSize{"compression", 1}, FixedSize{"double", 8},   FixedSize{"envmap", 1},
    FixedSize{"float", 4},       FixedSize{"int", 4},      FixedSize{"keycode", 28},
    FixedSize{"lineOrder", 1},   FixedSize{"m33f", 36},    FixedSize{"m44f", 64},
    FixedSize{"m33d", 72},       FixedSize{"m44d", 128},   FixedSize{"rational", 8},
    FixedSize{"tiledesc", 9},    FixedSize{"timecode", 8}, FixedSize{"v2i", 8},
    FixedSize{"v2f", 8},         FixedSize{"v2d", 16},     FixedSize{"v3i", 12},
    FixedSize{"v3f", 12},        FixedSize{"v3d", 24},     FixedSize{"deepImageState", 1}};

// The parts of a header that decide how much memory is needed.
struct Sizes {
  std::array<std::int32_t, 4> data{};  // least x and y, greatest x and y
  bool has_data = false;
  std::uint64_t bytes_per_pixel = 0;
  std::uint32_t tile_width = 0, tile_height = 0;  // 0: scan lines
  std::uint32_t pieces = 0;                       // as declared; 0: not declared
};

bool is_sound_list_of_channels(std::string_view value, Sizes& sizes) {
  Cursor cursor(value);
  for (;;) {
    const auto name = cursor.name();
    if (!name) return false;
    if (name->empty()) return cursor.left() == 0;
    const auto kind = cursor.number();
    if (!kind || *kind > 2 || !cursor.take(12)) return false;
    sizes.bytes_per_pixel += *kind == 1 ? 2 : 4;
  }
}

bool is_sound_list_of_texts(std::string_view value) {
  Cursor cursor(value);
  while (cursor.left() > 0) {
    const auto size = cursor.number();
    if (!size || !cursor.take(*size)) return false;
  }
  return true;
}

bool is_sound_preview(std::string_view value) {
  Cursor cursor(value);
  const auto width = cursor.number(), height = cursor.number();
  return width && height && (*height == 0 || *width <= cursor.left() / 4 / *height) &&
         4 * std::uint64_t{*width} * *height == cursor.left();
}

bool is_sound_value(std::string_view name, std::string_view type, std::string_view value, Sizes& sizes) {
  const auto fixed = std::ranges::find(kFixedSizes, type, &FixedSize::type);
  if (fixed != kFixedSizes.end() && value.size() != fixed->bytes) return false;
  if (type == "chlist") return is_sound_list_of_channels(value, sizes);
  if (type == "stringvector") return is_sound_list_of_texts(value);
  if (type == "preview") return is_sound_preview(value);
  if (type == "floatvector") return value.size() % 4 == 0;
  if (type == "idmanifest") return value.size() >= 4;
  Cursor cursor(value);
  if (name == "dataWindow" && type == "box2i") {
    sizes.has_data = true;
    for (std::int32_t& bound : sizes.data) bound = static_cast<std::int32_t>(*cursor.number());
  }
  if (name == "chunkCount" && type == "int") sizes.pieces = *cursor.number();
  if (name == "tiles" && type == "tiledesc") {
    sizes.tile_width = *cursor.number();
    sizes.tile_height = *cursor.number();
    return sizes.tile_width > 0 && sizes.tile_height > 0;
  }
  return true;
}

std::string fault_of(const Sizes& sizes, double file_bytes) {
  const auto side = [](std::int32_t least, std::int32_t greatest) {
    return static_cast<double>(greatest) - static_cast<double>(least) + 1.0;
  };
  if (!sizes.has_data) return "it has no data window";
  const double width = side(sizes.data[0], sizes.data[2]), height = side(sizes.data[1], sizes.data[3]);
  if (!(width >= 1.0 && height >= 1.0)) return "its data window is empty";
  if (std::ranges::any_of(sizes.data, [](double bound) { return std::abs(bound) > kFurthest; })) {
    return "its data window is too far away";
  }
  const double per_pixel = static_cast<double>(std::max<std::uint64_t>(sizes.bytes_per_pixel, 1));
  const double tile_width = sizes.tile_width, tile_height = sizes.tile_height;
  const double most = std::max(kMostCompression * file_bytes, kAlwaysAllowed);
  const double pieces = tile_width > 0.0 ? (width / tile_width) * (height / tile_height) : height / kMostRowsOfPiece;
  if (width * height * per_pixel <= most && tile_width * tile_height * per_pixel <= most &&
      kBytesOfOffset * std::max<double>(pieces, sizes.pieces) <= file_bytes) {
    return {};
  }
  return "it declares more pixels than its bytes can hold";
}

// Takes one header.
std::string fault_of_header(Cursor& cursor, double file_bytes) {
  static constexpr const char* kCutOff = "its header is cut off or damaged";
  Sizes sizes;
  for (;;) {
    const auto name = cursor.name();
    if (!name) return kCutOff;
    if (name->empty()) return fault_of(sizes, file_bytes);
    const auto type = cursor.name();
    const auto size = cursor.number();
    const auto value = type && size ? cursor.take(*size) : std::nullopt;
    if (!value || !is_sound_value(*name, *type, *value, sizes)) return kCutOff;
  }
}

}  // namespace

bool has_magic_number(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

std::string fault_of_headers(std::string_view bytes) {
  const auto file_bytes = static_cast<double>(bytes.size());
  Cursor cursor(bytes);
  const auto magic = cursor.number(), version = cursor.number();
  if (!magic || !version) return "it ends within its first bytes";
  for (;;) {
    if (std::string fault = fault_of_header(cursor, file_bytes); !fault.empty()) return fault;
    if ((*version & kOfSeveralParts) == 0) return {};
    Cursor ahead = cursor;
    const auto next = ahead.name();
    if (!next) return "its headers have no end";
    if (next->empty()) return {};
  }
}

}  // namespace exactff::exr
