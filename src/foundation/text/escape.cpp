#include "text/escape.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "text/encoding.h"
#include "text/phrases.h"

namespace exactff::text {

namespace {

std::string visible_escape(const Character& c) {
  const bool byte = !c.well_formed || c.code < 0x80;
  return byte ? "\\x" + hexadecimal(c.code, 2) : "\\u" + hexadecimal(c.code, 4);  // no control is beyond U+FFFF
}

// Calls put(character, its bytes) for each character in order.
template <class Put>
void for_each_character(std::string_view text, const Put& put) {
  for (std::size_t at = 0; at < text.size();) {
    const Character c = character_at(text, at);
    put(c, text.substr(at, c.bytes));
    at += c.bytes;
  }
}

bool is_stripped(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

bool is_one_word(std::string_view text) {
  return !text.empty() && text.find_first_not_of(
                              "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                              "0123456789_-+=:,./@%") == std::string_view::npos;
}

// $'...', in which invisible characters are written byte by byte.
std::string ansi_c_quoted(std::string_view text) {
  std::string word = "$'";
  for_each_character(text, [&](const Character& c, std::string_view bytes) {
    if (!c.well_formed || is_control(c.code)) {
      for (const char byte : bytes) word += "\\x" + hexadecimal(static_cast<unsigned char>(byte), 2);
    } else {
      if (bytes == "'" || bytes == "\\") word += '\\';
      word += bytes;
    }
  });
  return word + '\'';
}

}  // namespace

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

std::string printable(std::string_view text, std::string_view kept) {
  std::string shown;
  shown.reserve(text.size());
  for_each_character(text, [&](const Character& c, std::string_view bytes) {
    const bool stays = c.well_formed && (!is_control(c.code) || kept.find(bytes) != std::string_view::npos);
    shown += stays ? std::string(bytes) : visible_escape(c);
  });
  return shown;
}

std::string html(std::string_view text) {
  std::string safe = printable(text, "\n\t");
  replace_all(safe, "&", "&amp;");
  replace_all(safe, "<", "&lt;");
  replace_all(safe, ">", "&gt;");
  replace_all(safe, "\"", "&quot;");
  return safe;
}

std::string utf8(std::string_view text) {
  std::string well_formed;
  for_each_character(text, [&](const Character& c, std::string_view bytes) {
    well_formed += c.well_formed ? std::string(bytes) : visible_escape(c);
  });
  return well_formed;
}

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
  for_each_character(document, [&](const Character& c, std::string_view bytes) {
    const bool stays = c.code < 0x7F || !is_control(c.code);
    safe += stays ? std::string(bytes) : "\\u" + hexadecimal(c.code, 4);
  });
  return safe;
}

}  // namespace

std::string json_document(const ordered_json& json) { return with_escaped_controls(well_formed(json).dump(2)); }
std::string json_line(const ordered_json& json) { return with_escaped_controls(well_formed(json).dump()); }

std::string csv_field(std::string_view text) {
  std::string field = in_utf8(text);
  replace_all(field, "\n", "\\x0a");
  replace_all(field, "\r", "\\x0d");
  const bool stripped = !field.empty() && (is_stripped(field.front()) || is_stripped(field.back()));  // by readers
  if (!stripped && field.find_first_of(",\"#") == std::string::npos) return field;
  replace_all(field, "\"", "\"\"");
  return '"' + field + '"';
}

std::string csv_comment(std::string_view text) {
  std::string comment = in_utf8(text);
  std::ranges::replace_if(
      comment, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  return comment;
}

std::string github_message(std::string_view text) {
  std::string safe = printable(text, "\n");
  replace_all(safe, "%", "%25");
  replace_all(safe, "\n", "%0A");
  return safe;
}

// Commas and colons end a property.
std::string github_property(std::string_view text) {
  std::string safe = github_message(text);
  replace_all(safe, ":", "%3A");
  replace_all(safe, ",", "%2C");
  return safe;
}

std::string gnuplot_string(std::string_view text) {
  std::string safe = printable(text, "\n");
  replace_all(safe, "\n", " ");
  replace_all(safe, "'", "''");
  return '\'' + safe + '\'';
}

std::string shell_word(std::string_view text) {
  if (is_one_word(text)) return std::string(text);
  if (printable(text) != text) return ansi_c_quoted(text);
  std::string word(text);
  replace_all(word, "'", "'\\''");
  return '\'' + word + '\'';
}

}  // namespace exactff::text
