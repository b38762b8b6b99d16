// Writes a page on the results of another renderer, such as those of cycles.sh: a verdict, figures, maps, tables.
// Usage: field_page FILE.csv PAGE.html
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "field/page.h"
#include "support/program.h"

namespace exactff::field {
namespace {

void write_page(const std::filesystem::path& csv, const std::filesystem::path& page) {
  const validation::TemporaryDirectory scratch;
  std::vector<std::string> notes;
  const std::string html = field_page(read_field(csv), scratch.path(), notes);
  std::ofstream out(page, std::ios::binary);
  out << html;
  if (!out.flush()) throw std::runtime_error(page.string() + " cannot be written");
  for (const std::string& note : notes) std::cerr << "note: " << note << '\n';
}

}  // namespace
}  // namespace exactff::field

int main(int count, char** words) try {
  if (count != 3) throw std::runtime_error("usage: field_page FILE.csv PAGE.html");
  exactff::field::write_page(words[1], words[2]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
