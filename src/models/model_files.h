// Declares the functions that the files of the models define.
#pragma once

#include "exactff/models.h"
#include "models/plain_scene.h"

namespace exactff::models {

#define EXACTFF_MODEL(name) Model name##_model();
#include "models/list.h"
#undef EXACTFF_MODEL

// The scene for a text such as "teapot:segments=4", with a comment that says how to generate it again. Throws
// InputError.
[[nodiscard]] PlainScene make_plain(std::string_view text);

}  // namespace exactff::models
