// Declares the functions that the files of the models define.
#pragma once

#include "exactff/models.h"
#include "models/plain_scene.h"

namespace exactff::models {

Model blinds_model();
Model closed_room_model();
Model emitters_model();
Model forest_model();
Model karkanis_model();
Model lattice_model();
Model mesh_model();
Model room_model();
Model soup_model();
Model teapot_model();
Model tiles_model();

// The scene for a text such as "teapot:segments=4", with a comment that says how to generate it again. Throws
// InputError.
[[nodiscard]] PlainScene make_plain(std::string_view text);

}  // namespace exactff::models
