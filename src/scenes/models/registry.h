// The models by name. Declares the functions that the files of the models define.
#pragma once

#include "exactff/models.h"
#include "models/plain_scene.h"

namespace exactff::models {

// A model and how its scene is made.
struct Recipe {
  Model model;
  PlainScene (*make)(const Settings&) = nullptr;
};

Recipe blinds_model();
Recipe closed_room_model();
Recipe emitters_model();
Recipe forest_model();
Recipe karkanis_model();
Recipe lattice_model();
Recipe mesh_model();
Recipe room_model();
Recipe soup_model();
Recipe teapot_model();
Recipe tiles_model();

// The scene for a text such as "teapot:segments=4", with a comment that says how to generate it again. Throws
// InputError.
[[nodiscard]] PlainScene make_plain(std::string_view text);

}  // namespace exactff::models
