#include "page/chapter.h"

#include "work/fields.h"

namespace exactff::page {
namespace {

void put(work::WordWriter& words, const std::vector<TextTable>& tables) {
  words.put(std::uint64_t{tables.size()});
  for (const TextTable& t : tables) {
    for (const std::string* text : {&t.file, &t.holds, &t.csv}) words.put(*text);
  }
}

// If the bytes left cannot hold the stated number of items, the rest counts as torn.
template <class Take>
void take_list(work::WordReader& words, const Take& take) {
  for (std::uint64_t count = words.word(); count > 0 && !words.torn(); --count) take();
}

std::vector<TextTable> tables_of(work::WordReader& words) {
  std::vector<TextTable> tables;
  take_list(words, [&] {
    TextTable t;
    for (std::string* text : {&t.file, &t.holds, &t.csv}) *text = words.text();
    tables.push_back(std::move(t));
  });
  return tables;
}

}  // namespace

std::string to_bytes(const Chapter& chapter) {
  work::WordWriter words;
  words.put(chapter.name);
  words.put(chapter.title);
  words.put(std::uint64_t{chapter.paragraphs.size()});
  for (const std::string& paragraph : chapter.paragraphs) words.put(paragraph);
  words.put(std::uint64_t{chapter.figures.size()});
  for (const Figure& f : chapter.figures) {
    for (const std::string* text : {&f.id, &f.title, &f.caption, &f.script}) words.put(*text);
    words.put(std::uint64_t{f.map});
  }
  put(words, chapter.values);
  put(words, chapter.times);
  words.put(std::uint64_t{chapter.left_out.size()});
  for (const LeftOut& item : chapter.left_out) {
    words.put(item.what);
    words.put(item.why);
  }
  return words.bytes();
}

std::optional<Chapter> chapter_of(std::string_view bytes) {
  work::WordReader words(bytes);
  Chapter chapter;
  chapter.name = words.text();
  chapter.title = words.text();
  take_list(words, [&] { chapter.paragraphs.push_back(words.text()); });
  take_list(words, [&] {
    Figure f;
    for (std::string* text : {&f.id, &f.title, &f.caption, &f.script}) *text = words.text();
    f.map = words.word() != 0;
    chapter.figures.push_back(std::move(f));
  });
  chapter.values = tables_of(words);
  chapter.times = tables_of(words);
  take_list(words, [&] {
    LeftOut item{words.text(), {}};
    item.why = words.text();
    chapter.left_out.push_back(std::move(item));
  });
  if (!words.complete()) return std::nullopt;
  return chapter;
}

}  // namespace exactff::page
