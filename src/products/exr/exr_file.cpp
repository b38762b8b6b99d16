// Reading OpenEXR files. Only this source and the writer know the library.
#include "exr/exr_file.h"

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <string_view>

#include "files/numpy.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::exr {

// --- Exr guard ---

// Checks of a file's bytes before the library reads them: it trusts many of the sizes in a header.

// The layout of a header (OpenEXR file layout, version 2): attributes (name, 0, type, 0, size in 4 bytes, value), then
// a 0. A file of several parts has a header for each, then a 0.

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

bool has_magic_number(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

// Why the headers of an OpenEXR file cannot be read safely; empty if they can: every attribute lies within the file and
// has the size that its type demands, and the pixels and the tables of offsets are not larger than the file can fill.
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

namespace {

// The bytes of the file. A read beyond them is refused.
class ByteStream : public Imf::IStream {
 public:
  ByteStream(const std::string& bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}

  bool read(char* to, int count) override {
    const auto wanted = static_cast<std::uint64_t>(std::max(count, 0));
    if (at_ > bytes_.size() || wanted > bytes_.size() - at_) throw IEX_NAMESPACE::InputExc("the file is cut off");
    std::memcpy(to, bytes_.data() + at_, wanted);
    at_ += wanted;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t position) override { at_ = position; }

 private:
  const std::string& bytes_;
  std::uint64_t at_ = 0;
};

Window window_of(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

Kind kind_of(Imf::PixelType type) {
  return type == Imf::HALF ? Kind::kHalf : type == Imf::UINT ? Kind::kWhole : Kind::kFloat;
}

bool is_lossy(const Imf::Header& header) {
  const Imf::Compression kind = header.compression();
  return kind == Imf::PXR24_COMPRESSION || kind == Imf::DWAA_COMPRESSION || kind == Imf::DWAB_COMPRESSION;
}

bool is_deep(const Imf::Header& header) {
  return header.hasType() && (header.type() == Imf::DEEPSCANLINE || header.type() == Imf::DEEPTILE);
}

std::string full_name(const std::string& part, const std::string& channel) {
  return part.empty() || channel.starts_with(part + '.') ? channel : part + '.' + channel;
}

}  // namespace

struct ExrFile::Content {
  std::string bytes;
  std::string name;
  std::optional<ByteStream> stream;
  std::optional<Imf::MultiPartInputFile> file;
  std::vector<Channel> channels;
  std::mutex mutex;  // the library's file has one position

  [[noreturn]] void refuse(const std::string& what, const std::string& why) const {
    text::refuse(name, what, why, "write it again with the program that made it");
  }
  // Calls the library; what it throws becomes an InputError.
  template <class Call>
  void guard(const Call& call) {
    try {
      call();
    } catch (const IEX_NAMESPACE::BaseExc& error) {
      refuse("is damaged", error.what());
    } catch (const std::length_error& error) {
      refuse("is damaged", error.what());
    }
  }

  void open() {
    if (!has_magic_number(bytes)) {
      text::refuse(name, "is no OpenEXR file", "its first four bytes are others", "give an .exr file");
    }
    if (const std::string fault = fault_of_headers(bytes); !fault.empty()) refuse("is damaged", fault);
    guard([&] {
      stream.emplace(bytes, name);
      file.emplace(*stream, 0, false);
      for (int part = 0; part < file->parts(); ++part) list_channels(part);
    });
  }

  void list_channels(int part) {
    const Imf::Header& header = file->header(part);
    if (is_deep(header)) {
      text::refuse(name, "is a deep image", "its pixels have several samples each", "save a flat image");
    }
    const std::string prefix = file->parts() > 1 && header.hasName() ? header.name() : std::string();
    for (auto at = header.channels().begin(); at != header.channels().end(); ++at) {
      channels.push_back({full_name(prefix, at.name()), kind_of(at.channel().type), static_cast<std::size_t>(part),
                          at.name(), is_lossy(header)});
    }
  }

  // Each part is decoded once.
  void read(std::span<const Channel> wanted, std::vector<std::vector<float>>& numbers) {
    for (int part = 0; part < file->parts(); ++part) {
      if (std::ranges::any_of(wanted, [&](const Channel& one) { return one.part == static_cast<std::size_t>(part); })) {
        read_part(part, wanted, numbers);
      }
    }
  }

  void read_part(int number, std::span<const Channel> wanted, std::vector<std::vector<float>>& numbers) {
    constexpr int kRowsAtOnce = 64;  // between checks whether the user has cancelled
    const Imf::Header& header = file->header(number);
    const Imath::Box2i box = header.dataWindow();
    const Window window = window_of(box);
    Imf::FrameBuffer frame;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (wanted[i].part != static_cast<std::size_t>(number)) continue;
      const Imf::Channel& kept = header.channels()[wanted[i].name_in_part];
      if (kept.xSampling != 1 || kept.ySampling != 1) {
        refuse("channel '" + wanted[i].name + "' does not have a number for each pixel", "it is subsampled");
      }
      frame.insert(wanted[i].name_in_part,
                   Imf::Slice::Make(Imf::FLOAT, numbers[i].data(), box.min, window.width, window.height));
    }
    Imf::InputPart part(*file, number);
    part.setFrameBuffer(frame);
    for (int y = box.min.y; y <= box.max.y; y += kRowsAtOnce) {
      kernel::poll();
      part.readPixels(y, std::min(y + kRowsAtOnce - 1, box.max.y));
    }
  }
};

ExrFile::ExrFile(std::string bytes, std::string name) : content_(std::make_unique<Content>()) {
  const kernel::StandardArithmetic arithmetic;
  content_->bytes = std::move(bytes);
  content_->name = std::move(name);
  content_->open();
}

ExrFile::ExrFile(const std::filesystem::path& path)
    : ExrFile(text::read_file(path, "an OpenEXR file"), path.string()) {}

ExrFile::~ExrFile() = default;
ExrFile::ExrFile(ExrFile&&) noexcept = default;

const std::string& ExrFile::file() const { return content_->name; }
const std::vector<Channel>& ExrFile::channels() const { return content_->channels; }

Window ExrFile::data_window(const Channel& channel) const {
  return window_of(content_->file->header(static_cast<int>(channel.part)).dataWindow());
}

Window ExrFile::display_window(const Channel& channel) const {
  return window_of(content_->file->header(static_cast<int>(channel.part)).displayWindow());
}

std::vector<std::vector<float>> ExrFile::read(std::span<const Channel> channels) const {
  const kernel::StandardArithmetic arithmetic;
  std::vector<std::vector<float>> numbers(channels.size());
  if (channels.empty()) return numbers;
  const Window window = data_window(channels.front());
  if (window.pixels() > kMostReceivers) {
    text::refuse(file(), "has " + std::to_string(window.pixels()) + " pixels",
                 "at most " + std::to_string(kMostReceivers) + " are read", "crop it");
  }
  for (const Channel& channel : channels) {
    if (data_window(channel) != window) {
      text::refuse(file(), "the data windows of '" + channels.front().name + "' and '" + channel.name + "' differ",
                   "each pixel needs a number of both", "save all layers with one data window");
    }
  }
  for (std::vector<float>& of_channel : numbers) of_channel.resize(window.pixels());
  const std::lock_guard lock(content_->mutex);
  content_->guard([&] { content_->read(channels, numbers); });
  return numbers;
}

bool is_exr(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return false;
  std::ifstream in(path, std::ios::binary);
  std::string magic(4, '\0');
  in.read(magic.data(), static_cast<std::streamsize>(magic.size()));
  return in.gcount() == 4 && has_magic_number(magic);
}

// --- Writing OpenEXR files ---

namespace {

Imath::Box2i box_of(const Window& window) {
  return {{window.x, window.y}, {window.x + window.width - 1, window.y + window.height - 1}};
}

}  // namespace

std::string exr_of(const Image& image) {
  const kernel::StandardArithmetic arithmetic;
  Imf::Header header(box_of(image.display), box_of(image.data));
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, value] : image.about) header.insert("exactff " + name, Imf::StringAttribute(value));
  Imf::FrameBuffer frame;
  for (const Numbers& channel : image.channels) {
    const Imf::PixelType type = channel.kind == Kind::kWhole ? Imf::UINT : Imf::FLOAT;
    header.channels().insert(channel.name, Imf::Channel(type));
    frame.insert(channel.name, Imf::Slice::Make(type, channel.bits.data(), {image.data.x, image.data.y},
                                                image.data.width, image.data.height));
  }
  Imf::StdOSStream memory;
  {
    Imf::OutputFile file(memory, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(image.data.height);
  }  // the destructor writes the table of offsets
  return memory.str();
}

// --- Other image ---

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColours = 3;

// Of the layer that is named. If none is: the plain channels R, G, B, or those of the only layer that has them.
std::vector<Channel> channels_of(const ExrFile& file, const std::string& layer, const std::string& flag) {
  if (!layer.empty()) return file.find(layer, flag);
  std::vector<std::string> with_colours;
  for (const Layer& one : file.layers()) {
    const std::string prefix = one.name.empty() ? "" : one.name + '.';
    const bool has_all = std::ranges::all_of(std::string("RGB"), [&](char letter) {
      return std::ranges::find(file.channels(), prefix + letter, &Channel::name) != file.channels().end();
    });
    if (has_all) with_colours.push_back(one.name);
  }
  const bool has_plain = std::ranges::find(with_colours, "") != with_colours.end();
  return file.find(has_plain || with_colours.size() != 1 ? "" : with_colours.front(), flag);
}

OtherImage read_exr(const fs::path& path, const std::string& layer, const std::string& flag) {
  const ExrFile file(path);
  const std::vector<Channel> channels = channels_of(file, layer, flag);
  OtherImage image{file.file(), file.data_window(channels.front()), file.display_window(channels.front()), true, {},
                   {}};
  for (const Channel& one : channels) image.channels.push_back(one.name);
  for (const std::vector<float>& numbers : file.read(channels))
    image.values.emplace_back(numbers.begin(), numbers.end());
  return image;
}

std::string words_of(const std::vector<std::size_t>& shape) {
  std::string words;
  for (const std::size_t extent : shape) words += (words.empty() ? "" : ", ") + std::to_string(extent);
  return '(' + words + ')';
}

Window window_of(const fs::path& path, const std::vector<std::size_t>& shape) {
  constexpr std::size_t kLargest = 1 << 24;
  const bool has_pixels = shape.size() == 3 && shape[2] == kColours && shape[0] > 0 && shape[1] > 0;
  if (has_pixels && shape[0] <= kLargest && shape[1] <= kLargest) {
    return {0, 0, static_cast<int>(shape[1]), static_cast<int>(shape[0])};
  }
  const bool has_alpha = shape.size() == 3 && shape[2] == kColours + 1;
  text::refuse(path, "is a NumPy array of the shape " + words_of(shape),
               "an image has the shape (height, width, 3), its rows from the top",
               has_alpha ? "save array[:, :, :3], without the fourth channel" : "save an array of this shape");
}

OtherImage read_array(const fs::path& path, const std::string& layer, const std::string& flag) {
  if (!layer.empty()) {
    text::refuse(path, "is a NumPy array, and " + flag + " names a layer", "an array has no names", "remove it");
  }
  const files::NpyArray array = files::read_npy(path);
  const Window window = window_of(path, array.shape);
  OtherImage image{path.string(), window, window, false, {"R", "G", "B"}, {}};
  image.values.resize(kColours);
  kernel::Steps steps("pixels", window.pixels());
  for (std::size_t i = 0; i < window.pixels(); ++i) {
    steps.take();
    for (std::size_t c = 0; c < kColours; ++c) image.values[c].push_back(array.values[kColours * i + c]);
  }
  return image;
}

}  // namespace

bool is_image(const fs::path& file) { return is_exr(file) || files::is_npy_file(file); }

OtherImage read_image(const fs::path& file, const std::string& layer, const std::string& flag) {
  return files::is_npy_file(file) ? read_array(file, layer, flag) : read_exr(file, layer, flag);
}

void place_like(const OtherImage& other, OtherImage& image) {
  if (image.is_placed) return;
  const bool in_data = image.data.width == other.data.width && image.data.height == other.data.height;
  const Window& place = in_data ? other.data : other.display;
  image.data.x = image.display.x = place.x;
  image.data.y = image.display.y = place.y;
}

}  // namespace exactff::exr
