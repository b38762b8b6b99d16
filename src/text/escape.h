// Text from files and command lines on its way out: one function for each language that it is written in.
//
// Names and paths may hold any bytes. Those that are UTF-8 without control characters stay as they are, up to the
// quoting of the language. A control character becomes a visible escape, and so does a byte that is not UTF-8: \x1b
// and \xe9 for a byte, \u202e for a character beyond ASCII. Not a question mark or U+FFFD, so that two names stay two
// names and a person sees what is in them. A name that holds a backslash already is not changed, so the escapes are for
// people, not for reading back. CSV and JSON have to be read back: CSV keeps every byte but line breaks, JSON every
// character.
#pragma once

#include <string>
#include <string_view>

namespace exactff::text {

// For a terminal or a log: a name in a hostile file could otherwise steer the terminal, turn the reading direction of
// what follows, or make two lines of one. Control characters among `kept` (ASCII) stay.
[[nodiscard]] std::string printable(std::string_view text, std::string_view kept = {});

// For HTML, SVG and other XML, as content or within double quotes. Line feeds and tabs stay.
[[nodiscard]] std::string html(std::string_view text);

// Well-formed UTF-8, as JSON requires; characters stay, since JSON can hold them all. See text/json_document.h.
[[nodiscard]] std::string utf8(std::string_view text);

// One field of a CSV row, quoted where it must be (RFC 4180). Reads back as the same bytes, but for line breaks,
// which become visible: a row is one line.
[[nodiscard]] std::string csv_field(std::string_view text);

// In a comment line of a CSV file, which a line break would end: blanks stand for line breaks.
[[nodiscard]] std::string csv_comment(std::string text);

// Message and property of a workflow command of GitHub Actions. Line feeds stay, as the runner wants them written.
[[nodiscard]] std::string github_message(std::string_view text);
[[nodiscard]] std::string github_property(std::string_view text);

// A string of a gnuplot script, quotes included. Line breaks become blanks: they would end the command. The terminal's
// enhanced mode still reads its marks in it.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

// One word of a command line, quoted for the shell where it must be. Control characters and bytes that are not UTF-8
// are written as $'\x1b', which bash, zsh and ksh read back.
[[nodiscard]] std::string shell_word(std::string_view text);

}  // namespace exactff::text
