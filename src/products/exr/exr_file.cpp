// Reading OpenEXR files. Only this source and the writer know the library.
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <mutex>

#include "exactff/error.h"
#include "exactff/exr.h"
#include "exr/exr_guard.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::exr {
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
    text::refuse(std::filesystem::path(name), what, why, "write it again with the program that made it");
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

  void open();
  void list_channels(int part);
  void read(std::span<const Channel> wanted, std::vector<std::vector<float>>& numbers);
  void read_part(int part, std::span<const Channel> wanted, std::vector<std::vector<float>>& numbers);
};

void ExrFile::Content::open() {
  if (!has_magic_number(bytes)) {
    text::refuse(std::filesystem::path(name), "is no OpenEXR file", "its first four bytes are others",
                 "give an .exr file");
  }
  if (const std::string fault = fault_of_headers(bytes); !fault.empty()) refuse("is damaged", fault);
  guard([&] {
    stream.emplace(bytes, name);
    file.emplace(*stream, 0, false);
    for (int part = 0; part < file->parts(); ++part) list_channels(part);
  });
}

void ExrFile::Content::list_channels(int part) {
  const Imf::Header& header = file->header(part);
  if (is_deep(header)) {
    text::refuse(std::filesystem::path(name), "is a deep image", "its pixels have several samples each",
                 "save a flat image");
  }
  const std::string prefix = file->parts() > 1 && header.hasName() ? header.name() : std::string();
  for (auto at = header.channels().begin(); at != header.channels().end(); ++at) {
    channels.push_back({full_name(prefix, at.name()), kind_of(at.channel().type), static_cast<std::size_t>(part),
                        at.name(), is_lossy(header)});
  }
}

// Each part is decoded once.
void ExrFile::Content::read(std::span<const Channel> wanted, std::vector<std::vector<float>>& numbers) {
  for (int part = 0; part < file->parts(); ++part) {
    if (std::ranges::any_of(wanted, [&](const Channel& one) { return one.part == static_cast<std::size_t>(part); })) {
      read_part(part, wanted, numbers);
    }
  }
}

void ExrFile::Content::read_part(int number, std::span<const Channel> wanted,
                                 std::vector<std::vector<float>>& numbers) {
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
    text::refuse(std::filesystem::path(file()), "has " + std::to_string(window.pixels()) + " pixels",
                 "at most " + std::to_string(kMostReceivers) + " are read", "crop it");
  }
  for (const Channel& channel : channels) {
    if (data_window(channel) != window) {
      text::refuse(std::filesystem::path(file()),
                   "the data windows of '" + channels.front().name + "' and '" + channel.name + "' differ",
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

}  // namespace exactff::exr
