// Checks of a file's bytes before the library reads them: it trusts many of the sizes in a header.
#pragma once

#include <string>
#include <string_view>

namespace exactff::exr {

// Why the headers of an OpenEXR file cannot be read safely; empty if they can: every attribute lies within the file and
// has the size that its type demands, and the pixels and the tables of offsets are not larger than the file can fill.
[[nodiscard]] std::string fault_of_headers(std::string_view bytes);

[[nodiscard]] bool has_magic_number(std::string_view bytes);

}  // namespace exactff::exr
