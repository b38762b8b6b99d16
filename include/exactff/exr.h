// Images of other programs as OpenEXR files: their channels, and the visible points that a renderer has stored in them,
// as receivers. So the exact values of the same pixels can be computed (truth.h) and compared (check.h).
//
//   exr::GBuffer points = exr::read_gbuffer("gbuffer.exr");
//   exr::place_on_faces(scene, points);
//   // points.receivers; points.frame says which pixel each belongs to
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff::exr {

// A rectangle of pixels. Rows run downwards; (x, y) is the pixel in the upper left corner.
struct Window {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  friend bool operator==(const Window&, const Window&) = default;
};

// "x12y-3": the name of a pixel, counted from the start of its window.
[[nodiscard]] std::string name_of_pixel(const Window& window, std::size_t index);

// --- Files ---------------------------------------------------------------------------------------------------------

enum class Kind { kHalf, kFloat, kWhole };

// A channel of a file. In a file of several parts, the name of the part comes before that of the channel, with a dot.
struct Channel {
  std::string name;
  Kind kind = Kind::kFloat;
  std::size_t part = 0;
  std::string name_in_part = {};
  bool lossy = false;  // its compression changes numbers of 32 bits
};

// A named group of channels: "Position" of "Position.X", "Position.Y" and "Position.Z". The letters are those after the
// last dot. The layer of plain channels such as "R" has an empty name.
struct Layer {
  std::string name;
  std::vector<std::size_t> channels;  // indices
};

// An OpenEXR file: scan lines or tiles (the full resolution), one part or several. Deep files are refused. Whatever the
// bytes are, nothing is read beyond them, and memory that they cannot fill is not taken.
class ExrFile {
 public:
  // Both throw InputError if it is no such file.
  explicit ExrFile(const std::filesystem::path& path);
  ExrFile(std::string bytes, std::string name);  // `name` is for messages
  ~ExrFile();
  ExrFile(ExrFile&&) noexcept;

  [[nodiscard]] const std::string& file() const;
  [[nodiscard]] const std::vector<Channel>& channels() const;
  [[nodiscard]] std::vector<Layer> layers() const;
  [[nodiscard]] Window data_window(const Channel& channel) const;
  [[nodiscard]] Window display_window(const Channel& channel) const;

  // The numbers of channels with the same data window, each row by row from its top. Throws InputError if the file is
  // damaged, if a channel does not have a number for each pixel, or if the window has more pixels than kMostReceivers;
  // throws Cancelled.
  [[nodiscard]] std::vector<std::vector<float>> read(std::span<const Channel> channels) const;

  // The three channels of a layer, in the order R, G, B or X, Y, Z; or the one channel of that name. A layer is also
  // found by the last parts of its name: "Position" finds "ViewLayer.Position". Throws InputError that lists the layers
  // if there is none, or several. `flag` is the flag that names it.
  [[nodiscard]] std::vector<Channel> find(const std::string& layer, const std::string& flag) const;

 private:
  struct Content;
  std::unique_ptr<Content> content_;
};

// Whether the file begins as OpenEXR files do. False if it cannot be read.
[[nodiscard]] bool is_exr(const std::filesystem::path& path);

// A channel to be written.
struct Numbers {
  std::string name;
  Kind kind = Kind::kFloat;         // kFloat or kWhole
  std::vector<std::uint32_t> bits;  // of the float, or the number itself
};
struct Image {
  Window data;
  Window display;
  std::vector<Numbers> channels;
  std::vector<std::pair<std::string, std::string>> about;  // kept as "exactff NAME"
};
// The content of an OpenEXR file. The same image gives the same bytes.
[[nodiscard]] std::string exr_of(const Image& image);

// --- Visible points ------------------------------------------------------------------------------------------------

// What is known about a pixel; the channel `mark` of an image of exact values.
enum class Mark : std::uint8_t {
  kExact,          // the value belongs to the stored point and normal
  kShadingNormal,  // the same, and the normal is more than a degree off that of the face
  kNothing,        // nothing is hit: no value
  kNoFace,         // the point lies on no face, as a mean of several points: no value
  kNotCertified,   // no value that is proved
};

// Which receiver belongs to which pixel.
struct Frame {
  Window data;
  Window display;
  std::vector<Mark> marks;            // of each pixel, row by row
  std::vector<std::uint32_t> pixels;  // of each receiver; ascending

  [[nodiscard]] std::size_t count(Mark mark) const;
};

// Names of the layers; an empty one is found: position or P, normal or N, without regard to case.
struct GBufferLayers {
  std::string position = {};
  std::string normal = {};
};

struct GBuffer {
  std::string file;
  std::string layers;  // "layers 'P' and 'N'"
  std::vector<Receiver> receivers;
  Frame frame;
};

// The points and normals of each pixel as receivers, named as name_of_pixel; their coordinates mean exactly the values
// of the 32-bit numbers. A pixel hits nothing, and has no receiver, if its normal is zero, if one of the six numbers is
// not finite, or if the file has one channel for alpha (A) and this is 0. Throws InputError if the layers are half
// floats or compressed with loss, and so too coarse for points on faces, if a layer is missing, or if no pixel hits
// anything.
[[nodiscard]] GBuffer read_gbuffer(const ExrFile& file, const GBufferLayers& layers = {});

// Finds the faces of the receivers: those within the tolerance with an agreeing normal, as find_faces does, or else the
// nearest one (kShadingNormal). The default tolerance is the larger of 1e-6 of the scene's diameter and two units in
// the last place of its largest coordinate in single precision. Receivers on no face are left out (kNoFace). Throws
// InputError if these are more than half of them: the points are then not those of this scene, or not in its
// coordinates.
void place_on_faces(const Scene& scene, GBuffer& gbuffer, std::optional<double> tolerance = {});

// "12 of 400 pixels have a normal more than a degree off their face; ...": what a user should know.
[[nodiscard]] std::vector<Problem> warnings_of(const GBuffer& gbuffer);

// The values of the receivers, as an image.
class FrameValues {
 public:
  explicit FrameValues(const Frame& frame);
  void set(std::size_t receiver, const Rgb& value, bool certified);
  // `about`: lines "key: value".
  [[nodiscard]] std::string exr(const std::vector<std::string>& about) const;

 private:
  const Frame& frame_;
  std::vector<Mark> marks_;
  std::vector<Rgb> values_;  // of each pixel
};

}  // namespace exactff::exr
