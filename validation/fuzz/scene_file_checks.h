// What the fuzz targets of PLY, STL, OFF and View3D files check.
#pragma once

#include <string_view>

namespace exactff::validation {

// Reads the bytes as a file of this name, in both modes of the readers. The result is either an InputError with a
// message, or a scene that keeps its promises. Every writer writes such a scene to a file that reads back to a scene;
// that scene is then written and read without any change. Ends the process if this is not so.
void check_scene_file(std::string_view bytes, const char* name);

}  // namespace exactff::validation
