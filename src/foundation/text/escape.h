// Escapes text from files and command lines for output: one function for each output language.
//
// Names and paths may hold any bytes. Valid UTF-8 without control characters is not changed, except for the quoting of
// the language. A control character becomes a visible escape, and so does a byte that is not UTF-8: \x1b and \xe9 for a
// byte, \u202e for a character beyond ASCII. It does not become a question mark or U+FFFD, so that different names stay
// different and a reader sees their content. A backslash that is already in a name is not changed, so the escapes are
// for human readers and cannot be reversed. CSV and JSON must be read back: both keep every character, CSV except line
// breaks. CSV output converts text that is not UTF-8 (text/encoding.h), just as scene readers convert names.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace exactff::text {

// For a terminal or a log: a name in a hostile file could otherwise steer the terminal, change the reading direction of
// the following text, or split one line in two. Control characters among `kept` (ASCII) stay.
[[nodiscard]] std::string printable(std::string_view text, std::string_view kept = {});

// For HTML, SVG and other XML, as content or within double quotes. Line feeds and tabs stay.
[[nodiscard]] std::string html(std::string_view text);

// The JSON output of the program, indented by two. Every string and key may hold any bytes: bytes that are not UTF-8
// become visible escapes, since JSON cannot hold them. Control characters stay in the string and are written as \u001b,
// \u0085 or \u202e, so that the document can be printed to a terminal.
[[nodiscard]] std::string json_document(const nlohmann::ordered_json& json);
// The same in one line.
[[nodiscard]] std::string json_line(const nlohmann::ordered_json& json);
// As in such strings: well-formed UTF-8, whose characters are not changed.
[[nodiscard]] std::string utf8(std::string_view text);

// One field of a CSV row, in UTF-8, quoted where it must be (RFC 4180). Reads back as the same text, except for line
// breaks, which become visible escapes: a row is one line.
[[nodiscard]] std::string csv_field(std::string_view text);

// For a comment line of a CSV file, in UTF-8. A line break would end it: line breaks become blanks.
[[nodiscard]] std::string csv_comment(std::string_view text);

// Message and property of a workflow command of GitHub Actions. Line feeds stay, in the form that the runner expects.
[[nodiscard]] std::string github_message(std::string_view text);
[[nodiscard]] std::string github_property(std::string_view text);

// A string of a gnuplot script, quotes included. Line breaks become blanks: they would end the command. The terminal's
// enhanced mode still interprets its markup in the string.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

// One word of a command line, quoted for the shell where it must be. Control characters and bytes that are not UTF-8
// are written as $'\x1b', which bash, zsh and ksh read back.
[[nodiscard]] std::string shell_word(std::string_view text);

void replace_all(std::string& text, std::string_view from, std::string_view to);  // every occurrence

}  // namespace exactff::text
