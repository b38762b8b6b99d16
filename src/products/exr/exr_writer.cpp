// Writing OpenEXR files.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <cstring>

#include "exactff/exr.h"
#include "kernel/float_environment.h"

namespace exactff::exr {
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
  Memory memory;
  {
    Imf::OutputFile file(memory, header, 0);
    file.setFrameBuffer(frame);
    file.writePixels(image.data.height);
  }  // the destructor writes the table of offsets
  return memory.take();
}

}  // namespace exactff::exr
