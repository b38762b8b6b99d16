// Pieces of HTML that all reports use.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace exactff::page {

// The page up to its first words, and what follows its last words. `title` is HTML.
[[nodiscard]] std::string page_head(const std::string& title);
[[nodiscard]] std::string page_end();

// Typesets running text: symbols get their subscripts, and units stay on the line of their numbers.
[[nodiscard]] std::string prose(std::string text);
[[nodiscard]] std::string paragraph(const std::string& html);
[[nodiscard]] std::string heading(const std::string& html);

// Pairs of a name and its description (HTML).
using Facts = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] std::string facts_table(const Facts& facts);

// Facts about this program and this machine.
[[nodiscard]] std::string program_fact();    // version, compiler, kind of build
[[nodiscard]] std::string processor_fact();  // its name, hardware threads
[[nodiscard]] std::string today();           // date and time, UTC

}  // namespace exactff::page
