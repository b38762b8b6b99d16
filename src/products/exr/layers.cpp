// Names of channels and layers.
#include "exr/layers.h"

#include <algorithm>
#include <array>
#include <map>

#include "exactff/error.h"
#include "exactff/exr.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::exr {
namespace {

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

}  // namespace

std::vector<Layer> ExrFile::layers() const {
  std::map<std::string, std::vector<std::size_t>> found;
  for (std::size_t i = 0; i < channels().size(); ++i) found[layer_of(channels()[i].name)].push_back(i);
  std::vector<Layer> layers;
  for (auto& [name, indices] : found) layers.push_back({name, std::move(indices)});
  return layers;
}

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

void refuse_layer(const ExrFile& file, const std::string& what, const std::string& wanted, const std::string& flag) {
  text::refuse(std::filesystem::path(file.file()), what, list_of_layers(file), suggestion_for(file, wanted, flag));
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

}  // namespace exactff::exr
