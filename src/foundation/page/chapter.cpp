#include "page/chapter.h"

#include "jobs/kept_work.h"

namespace exactff::page {
namespace {

template <class Words>
void fields(Words& words, Chapter& chapter) {
  words(chapter.name, chapter.title, chapter.paragraphs);
  words.list(chapter.tables, [&](NumberTable& table) {
    words(table.title, table.columns);
    words.list(table.rows, [&](std::vector<std::string>& row) { words(row); });
  });
  words.list(chapter.figures, [&](Figure& f) { words(f.id, f.title, f.caption, f.script, f.map); });
  for (auto* tables : {&chapter.values, &chapter.times}) {
    words.list(*tables, [&](CsvFile& table) { words(table.file, table.holds, table.csv); });
  }
  words.list(chapter.left_out, [&](LeftOut& item) { words(item.what, item.why); });
}

}  // namespace

std::string to_bytes(Chapter chapter) {
  jobs::WordWriter words;
  fields(words, chapter);
  return words.bytes();
}

std::optional<Chapter> chapter_of(std::string_view bytes) {
  jobs::WordReader words(bytes);
  Chapter chapter;
  fields(words, chapter);
  if (!words.complete()) return std::nullopt;
  return chapter;
}

}  // namespace exactff::page
