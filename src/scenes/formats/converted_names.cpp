#include "formats/converted_names.h"

#include "kernel/expect.h"
#include "text/encoding.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff {

void ConvertedNames::add(std::size_t line, std::string_view name) {
  if (names_.empty()) {
    first_ = name;
    first_line_ = line;
  }
  names_.emplace(name);
}

Problem ConvertedNames::warning(const std::string& file) const {
  EXACTFF_EXPECT(!names_.empty());
  const std::size_t others = names_.size() - 1;
  return {file, first_line_,
          "the name " + text::in_quotes(text::in_utf8(first_), text::kShownName) + " is not written in UTF-8" +
              (others > 0 ? ", nor " + std::string(others == 1 ? "is " : "are ") + text::counted(others, "other name")
                          : ""),
          "it is read as Latin-1 (Windows-1252)", "save the file as UTF-8 if the name looks wrong"};
}

}  // namespace exactff
