// OpenEXR files. Only this source knows the library.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cmath>
#include <cstring>

#include "exactff/render.h"
#include "kernel/float_environment.h"

namespace exactff::render {
namespace {

// Collects the bytes in memory: the library seeks back to write its table of offsets.
class Memory : public Imf::OStream {
 public:
  Memory() : Imf::OStream("memory") {}

  void write(const char* bytes, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (bytes_.size() < at_ + size) bytes_.resize(at_ + size);
    std::memcpy(bytes_.data() + at_, bytes, size);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t position) override { at_ = position; }

  [[nodiscard]] std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

// The values of one channel in the type of the file.
struct Channel {
  std::string name;
  bool whole = false;
  std::vector<std::uint32_t> bits;
};

std::uint32_t bits_of(double value, bool whole) {
  if (whole) return static_cast<std::uint32_t>(value);
  return std::bit_cast<std::uint32_t>(std::isnan(value) ? 0.0F : static_cast<float>(value));
}

std::vector<Channel> channels_of(const Picture& picture) {
  std::vector<Channel> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    Channel& channel = channels.emplace_back(Channel{std::string(1, "RGB"[c]), false, {}});
    channel.bits.reserve(picture.pixels());
    for (std::size_t i = 0; i < picture.pixels(); ++i)
      channel.bits.push_back(bits_of(picture.values[3 * i + c], false));
  }
  for (const Layer& layer : picture.layers) {
    Channel& channel = channels.emplace_back(Channel{layer.name, layer.whole, {}});
    channel.bits.reserve(picture.pixels());
    for (const double value : layer.values) channel.bits.push_back(bits_of(value, layer.whole));
  }
  return channels;
}

}  // namespace

std::string exr_of(const Picture& picture) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Channel> channels = channels_of(picture);
  Imf::Header header(picture.size.width, picture.size.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const auto& [name, value] : picture.metadata) header.insert("exactff " + name, Imf::StringAttribute(value));
  Imf::FrameBuffer frame;
  const std::size_t row_bytes = sizeof(std::uint32_t) * static_cast<std::size_t>(picture.size.width);
  for (Channel& channel : channels) {
    const Imf::PixelType type = channel.whole ? Imf::UINT : Imf::FLOAT;
    header.channels().insert(channel.name, Imf::Channel(type));
    frame.insert(channel.name,
                 Imf::Slice(type, reinterpret_cast<char*>(channel.bits.data()), sizeof(std::uint32_t), row_bytes));
  }
  Memory memory;
  {
    Imf::OutputFile file(memory, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(picture.size.height);
  }  // the destructor writes the table of offsets
  return memory.take();
}

}  // namespace exactff::render
