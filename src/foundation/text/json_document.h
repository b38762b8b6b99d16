// The JSON output of the program.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace exactff::text {

// Indented by two. Every string and key may hold any bytes: bytes that are not UTF-8 become visible escapes
// (text/escape.h), since JSON cannot hold them. Control characters stay in the string and are written as \u001b, \u0085
// or \u202e, so that the document can be printed to a terminal.
[[nodiscard]] std::string json_document(const nlohmann::ordered_json& json);
// The same in one line.
[[nodiscard]] std::string json_line(const nlohmann::ordered_json& json);

}  // namespace exactff::text
