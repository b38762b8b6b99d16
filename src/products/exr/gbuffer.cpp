// Visible points in the images of other renderers.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "exactff/error.h"
#include "exactff/exr.h"
#include "exactff/version.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "receivers/own_pieces.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::exr {
namespace {

// --- Layers ---

std::string layer_of(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return dot == std::string::npos ? std::string() : channel.substr(0, dot);
}

std::string letter_of(const std::string& channel) {
  const std::size_t dot = channel.rfind('.');
  return text::in_lower_case(dot == std::string::npos ? channel : channel.substr(dot + 1));
}

std::string list_of_layers(const ExrFile& file) {
  constexpr std::size_t kMostListed = 30;
  const std::vector<Layer> layers = file.layers();
  std::string list;
  for (std::size_t i = 0; i < std::min(layers.size(), kMostListed); ++i) {
    std::string letters;
    for (const std::size_t c : layers[i].channels) {
      const std::string& name = file.channels()[c].name;
      letters += (letters.empty() ? "" : ",") + name.substr(layers[i].name.empty() ? 0 : layers[i].name.size() + 1);
    }
    list += (i > 0 ? "; " : "") + (layers[i].name.empty() ? letters : layers[i].name + " (" + letters + ')');
  }
  if (layers.empty()) return "it has no channels";
  return "its layers are: " + list + (layers.size() > kMostListed ? "; ..." : "");
}

// The layer whose name, or the last part of it, is most like the wanted one.
std::string suggestion_for(const ExrFile& file, const std::string& wanted, const std::string& flag) {
  std::size_t least = std::max<std::size_t>(2, wanted.size() / 3) + 1;
  std::string nearest;
  for (const Layer& layer : file.layers()) {
    for (const std::string& name : {layer.name, layer.name.substr(layer.name.rfind('.') + 1)}) {
      const std::size_t distance = text::edit_distance(text::in_lower_case(name), text::in_lower_case(wanted), least);
      if (name.empty() || distance >= least) continue;
      least = distance;
      nearest = layer.name;
    }
  }
  if (wanted.empty() || nearest.empty()) return "name one of them with " + flag;
  return "did you mean " + flag + " '" + nearest + "'?";
}

// R, G, B or X, Y, Z of the layer, in any case of letters; empty if it has neither.
std::vector<Channel> three_channels(const ExrFile& file, const Layer& layer) {
  static constexpr std::array<std::array<const char*, 3>, 2> kLetters = {{{"r", "g", "b"}, {"x", "y", "z"}}};
  for (const auto& letters : kLetters) {
    std::vector<Channel> three;
    for (const char* letter : letters) {
      for (const std::size_t c : layer.channels) {
        if (letter_of(file.channels()[c].name) != letter) continue;
        three.push_back(file.channels()[c]);
        break;
      }
    }
    if (three.size() == 3) return three;
  }
  return {};
}

// The layer of this name; if there is none, those whose name ends in it, without regard to case.
std::vector<Layer> layers_called(const ExrFile& file, const std::string& name) {
  const std::string wanted = text::in_lower_case(name);
  std::vector<Layer> found;
  for (Layer& layer : file.layers()) {
    if (layer.name == name) return {std::move(layer)};
    const std::string known = text::in_lower_case(layer.name);
    if (known == wanted || known.ends_with('.' + wanted)) found.push_back(std::move(layer));
  }
  return found;
}

// Lists the layers that there are.
[[noreturn]] void refuse_layer(const ExrFile& file, const std::string& what, const std::string& wanted,
                               const std::string& flag) {
  text::refuse(file.file(), what, list_of_layers(file), suggestion_for(file, wanted, flag));
}

// --- Gbuffer ---

// The settings of renderers: pbrt-v4's film "gbuffer", Mitsuba 3's hdrfilm, the output properties of Blender 3.4.
constexpr const char* kSaveFloats =
    "save 32-bit floats: in pbrt the film's \"bool savefp16\" false, in Mitsuba component_format float32, in Blender "
    "Color Depth: Float (Full)";
constexpr const char* kSaveInTheWorld =
    "save positions in world coordinates: in pbrt the film's \"string coordinatesystem\" \"world\"; Blender's Position "
    "pass and Mitsuba's position AOV have them, but Blender turns imported files unless told that Y is forward and Z "
    "up";

// Of the default names.
std::vector<Layer> layers_of_default(const ExrFile& file, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    std::vector<Layer> found = layers_called(file, name);
    std::erase_if(found, [&](const Layer& layer) { return three_channels(file, layer).empty(); });
    if (!found.empty()) return found;
  }
  return {};
}

struct Chosen {
  std::string name;
  std::vector<Channel> channels;
};

Chosen choose(const ExrFile& file, const std::string& given, const std::string& what, const std::string& letter,
              const std::string& flag) {
  Chosen chosen{given, {}};
  if (!given.empty()) {
    chosen.channels = file.find(given, flag);
    if (chosen.channels.size() != 3) refuse_layer(file, "'" + given + "' is one channel, not three", given, flag);
  } else {
    const std::vector<Layer> found = layers_of_default(file, {what.c_str(), letter.c_str()});
    if (found.size() != 1) {
      refuse_layer(file,
                   found.empty() ? "has no layer called " + what + " or " + letter
                                 : "has several layers called " + what + " or " + letter,
                   found.empty() ? what : "", flag);
    }
    chosen = {found.front().name, three_channels(file, found.front())};
  }
  for (const Channel& channel : chosen.channels) {
    if (channel.kind == Kind::kFloat && !channel.lossy) continue;
    text::refuse(file.file(),
                 "layer '" + chosen.name + "' has " +
                     (channel.kind == Kind::kHalf    ? "half floats"
                      : channel.kind == Kind::kWhole ? "whole numbers"
                                                     : "a compression with loss (PXR24 or DWA)"),
                 "points would lie far off their faces",
                 channel.lossy && channel.kind == Kind::kFloat ? "save it with ZIP compression" : kSaveFloats);
  }
  return chosen;
}

// The channel for alpha, if it is clear which one.
std::vector<Channel> alpha_of(const ExrFile& file) {
  std::vector<Channel> found;
  for (const Channel& channel : file.channels()) {
    if (channel.name == "A") return {channel};
    if (channel.name.ends_with(".A")) found.push_back(channel);
  }
  return found.size() == 1 ? found : std::vector<Channel>{};
}

// In camera space everything lies before the camera, which looks along +z or -z.
std::string words_on_depth(const GBuffer& gbuffer) {
  const auto in_front = [](const Receiver& r) { return r.point.z > 0.0; };
  const auto behind = [](const Receiver& r) { return r.point.z < 0.0; };
  if (std::ranges::all_of(gbuffer.receivers, in_front)) return "; every z is positive, as in camera space";
  if (std::ranges::all_of(gbuffer.receivers, behind)) return "; every z is negative, as in camera space";
  return {};
}

void require_most_on_faces(const GBuffer& gbuffer, std::size_t without, double tolerance) {
  const std::size_t all = gbuffer.receivers.size();
  if (2 * without <= all) return;
  text::refuse(gbuffer.file,
               "the points of " + text::counted_of(without, all, "pixel") + " lie on no face of the scene, within " +
                   text::short_number(tolerance),
               "the points are in another coordinate system or of another scene" + words_on_depth(gbuffer),
               kSaveInTheWorld);
}

}  // namespace

std::vector<Layer> ExrFile::layers() const {
  std::map<std::string, std::vector<std::size_t>> found;
  for (std::size_t i = 0; i < channels().size(); ++i) found[layer_of(channels()[i].name)].push_back(i);
  std::vector<Layer> layers;
  for (auto& [name, indices] : found) layers.push_back({name, std::move(indices)});
  return layers;
}

std::vector<Channel> ExrFile::find(const std::string& layer, const std::string& flag) const {
  const std::vector<Layer> found = layers_called(*this, layer);
  if (found.size() == 1) {
    if (auto three = three_channels(*this, found.front()); !three.empty()) return three;
  }
  const auto one = std::ranges::find(channels(), layer, &Channel::name);
  if (one != channels().end()) return {*one};
  const std::string quoted = '\'' + layer + '\'';
  refuse_layer(*this,
               found.empty()       ? "has no layer " + quoted
               : found.size() == 1 ? "layer " + quoted + " has neither R, G, B nor X, Y, Z"
                                   : "has several layers " + quoted,
               layer, flag);
}

std::string name_of_pixel(const Window& window, std::size_t index) {
  const auto width = static_cast<std::size_t>(window.width);
  return 'x' + std::to_string(window.x + static_cast<int>(index % width)) + 'y' +
         std::to_string(window.y + static_cast<int>(index / width));
}

std::size_t Frame::count(Mark mark) const { return static_cast<std::size_t>(std::ranges::count(marks, mark)); }

GBuffer read_gbuffer(const ExrFile& file, const GBufferLayers& layers) {
  const kernel::StandardArithmetic arithmetic;
  const Chosen position = choose(file, layers.position, "position", "P", "--position-layer");
  const Chosen normal = choose(file, layers.normal, "normal", "N", "--normal-layer");
  std::vector<Channel> wanted = position.channels;
  wanted.insert(wanted.end(), normal.channels.begin(), normal.channels.end());
  const Window window = file.data_window(wanted.front());
  for (Channel& alpha : alpha_of(file)) {
    if (file.data_window(alpha) == window) wanted.push_back(std::move(alpha));
  }
  const std::vector<std::vector<float>> numbers = file.read(wanted);
  GBuffer result{file.file(), "layers '" + position.name + "' and '" + normal.name + "'", {}, {}};
  result.frame.data = window;
  result.frame.display = file.display_window(wanted.front());
  result.frame.marks.assign(window.pixels(), Mark::kNothing);
  kernel::Steps steps("pixels", window.pixels());
  for (std::size_t i = 0; i < window.pixels(); ++i) {
    steps.take();
    const bool is_finite = std::ranges::all_of(numbers, [&](const auto& channel) { return std::isfinite(channel[i]); });
    const Vec3 n{numbers[3][i], numbers[4][i], numbers[5][i]};
    if (!is_finite || n == Vec3{} || (numbers.size() == 7 && numbers[6][i] == 0.0F)) continue;
    result.receivers.push_back(
        {{numbers[0][i], numbers[1][i], numbers[2][i]}, n, {}, name_of_pixel(window, i), std::nullopt});
    result.frame.marks[i] = Mark::kExact;
    result.frame.pixels.push_back(static_cast<std::uint32_t>(i));
  }
  if (result.receivers.empty()) {
    text::refuse(file.file(), "no pixel hits anything in " + result.layers,
                 "every normal is zero, or numbers are not finite, or alpha is 0", "look at the layers of this file");
  }
  return result;
}

void place_on_faces(const Scene& scene, GBuffer& gbuffer, std::optional<double> tolerance) {
  const kernel::StandardArithmetic arithmetic;
  const double within = tolerance.value_or(tolerance_of_computed_points(scene));
  std::vector<Mark> found(gbuffer.receivers.size(), Mark::kExact);
  kernel::Steps steps("faces of pixels", gbuffer.receivers.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    steps.take();
    Receiver& receiver = gbuffer.receivers[i];
    receiver.on = find_faces(scene, receiver, within).faces;
    if (!receiver.on.empty()) continue;
    receiver.on = find_faces(scene, receiver, within, Normals::kAny).faces;
    found[i] = receiver.on.empty() ? Mark::kNoFace : Mark::kShadingNormal;
  }
  require_most_on_faces(gbuffer, static_cast<std::size_t>(std::ranges::count(found, Mark::kNoFace)), within);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    gbuffer.frame.marks[gbuffer.frame.pixels[i]] = found[i];
    if (found[i] == Mark::kNoFace) continue;
    if (kept < i) gbuffer.receivers[kept] = std::move(gbuffer.receivers[i]);
    gbuffer.frame.pixels[kept++] = gbuffer.frame.pixels[i];
  }
  gbuffer.receivers.resize(kept);
  gbuffer.frame.pixels.resize(kept);
}

std::vector<Problem> warnings_of(const GBuffer& gbuffer) {
  const Frame& frame = gbuffer.frame;
  const std::size_t off = frame.count(Mark::kShadingNormal), without = frame.count(Mark::kNoFace);
  const std::size_t hits = frame.marks.size() - frame.count(Mark::kNothing);
  std::vector<Problem> problems;
  if (off > 0) {
    problems.push_back({gbuffer.file, 0,
                        text::counted_of(off, hits, "pixel") + " have a normal more than a degree off their face",
                        "their values belong to these normals, which may be smoothed, packed or in camera space",
                        "save geometric normals in world coordinates, or leave out pixels of mark 1"});
  }
  if (without > 0) {
    problems.push_back({gbuffer.file, 0,
                        text::counted_of(without, hits, "pixel") + " have a point that lies on no face",
                        "they get no value; a mean of several samples lies between faces",
                        "save one sample a pixel, at its centre; --on auto:DISTANCE looks further away"});
  }
  return problems;
}

FrameValues::FrameValues(const Frame& frame) : frame_(frame), marks_(frame.marks) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  values_.assign(marks_.size(), {kNone, kNone, kNone});
}

void FrameValues::set(std::size_t receiver, const Rgb& value, bool certified) {
  const kernel::StandardArithmetic arithmetic;
  const std::uint32_t pixel = frame_.pixels.at(receiver);
  if (certified) {
    values_[pixel] = value;
  } else {
    marks_[pixel] = Mark::kNotCertified;
  }
}

std::string FrameValues::exr(const std::vector<std::string>& about) const {
  const kernel::StandardArithmetic arithmetic;
  Image image{frame_.data, frame_.display, {}, {}};
  for (const std::string& line : about) {
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) image.about.emplace_back(line.substr(0, colon), line.substr(colon + 2));
  }
  for (const auto& [name, part] : {std::pair{"R", &Rgb::r}, {"G", &Rgb::g}, {"B", &Rgb::b}}) {
    Numbers& channel = image.channels.emplace_back(Numbers{name, Kind::kFloat, {}});
    channel.bits.reserve(values_.size());
    for (const Rgb& value : values_)
      channel.bits.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value.*part)));
  }
  Numbers& marks = image.channels.emplace_back(Numbers{"mark", Kind::kWhole, {}});
  for (const Mark mark : marks_) marks.bits.push_back(static_cast<std::uint32_t>(mark));
  return exr_of(image);
}

}  // namespace exactff::exr
