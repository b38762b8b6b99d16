// Pieces of HTML that all reports share.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace exactff::study {

// Everything up to the page's first words and after its last ones. `title` is HTML.
[[nodiscard]] std::string page_head(const std::string& title);
[[nodiscard]] std::string page_end();

// Symbols of the running text with their subscripts, and units that stay with their numbers.
[[nodiscard]] std::string prose(std::string text);
[[nodiscard]] std::string paragraph(const std::string& html);
[[nodiscard]] std::string heading(const std::string& html);

// A name and what there is to say of it (HTML).
using Facts = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] std::string facts_table(const Facts& facts);

// Facts on this program and this machine.
[[nodiscard]] std::string program_fact();    // version, compiler, kind of build
[[nodiscard]] std::string processor_fact();  // its name, hardware threads
[[nodiscard]] std::string today();           // date and time, UTC

}  // namespace exactff::study
