// Which channels belong together.
#pragma once

#include <string>
#include <vector>

#include "exactff/exr.h"

namespace exactff::exr {

// R, G, B or X, Y, Z of the layer, in any case of letters; empty if it has neither.
[[nodiscard]] std::vector<Channel> three_channels(const ExrFile& file, const Layer& layer);

// The layer of this name; if there is none, those whose name ends in it, without regard to case.
[[nodiscard]] std::vector<Layer> layers_called(const ExrFile& file, const std::string& name);

// Lists the layers that there are.
[[noreturn]] void refuse_layer(const ExrFile& file, const std::string& what, const std::string& wanted,
                               const std::string& flag);

}  // namespace exactff::exr
