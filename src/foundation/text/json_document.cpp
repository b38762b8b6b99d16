#include "text/json_document.h"

#include <nlohmann/json.hpp>

#include "text/encoding.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::text {

namespace {

using nlohmann::ordered_json;

ordered_json well_formed(const ordered_json& json) {
  if (json.is_string()) return utf8(json.get_ref<const std::string&>());
  if (!json.is_structured()) return json;
  ordered_json copy = json.is_array() ? ordered_json::array() : ordered_json::object();
  for (const auto& [key, value] : json.items()) {
    if (json.is_array()) {
      copy.push_back(well_formed(value));
    } else {
      copy[utf8(key)] = well_formed(value);
    }
  }
  return copy;
}

// The characters that JSON must escape are already escaped. Other characters above ASCII can only be within a string.
std::string with_escaped_controls(const std::string& document) {
  std::string safe;
  for (std::size_t at = 0; at < document.size();) {
    const Character c = character_at(document, at);
    if (c.code >= 0x7F && is_control(c.code)) {
      safe += "\\u" + hexadecimal(c.code, 4);
    } else {
      safe.append(document, at, c.bytes);
    }
    at += c.bytes;
  }
  return safe;
}

}  // namespace

std::string json_document(const ordered_json& json) { return with_escaped_controls(well_formed(json).dump(2)); }
std::string json_line(const ordered_json& json) { return with_escaped_controls(well_formed(json).dump()); }

}  // namespace exactff::text
