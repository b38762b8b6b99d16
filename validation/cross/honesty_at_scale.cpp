// The experiment `honesty` (src/reports/experiments/honesty.h) on any number of random scenes: prints its table in
// Markdown and writes every entry. Fails if an error is proved to exceed the reported one, if two enclosures are
// disjoint, or if a cell fails its own check.
// Usage: honesty_at_scale [SCENES [FILE.csv [FIRST]]]; the scenes are numbered from FIRST, or 1
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "experiments/honesty.h"
#include "files/parallel.h"

namespace {

using namespace exactff;
using namespace exactff::experiments;

void print_row(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) std::cout << "| " << cell << ' ';
  std::cout << "|\n";
}

void print(const page::NumberTable& table) {
  print_row(table.columns);
  print_row(std::vector<std::string>(table.columns.size(), "---"));
  for (const std::vector<std::string>& row : table.rows) print_row(row);
}

void say_progress(const Progress& progress) {
  if (progress.done % 50 == 0) std::cerr << progress.done << " of " << progress.total << " scenes\n";
}

int run(const HonestySize& size, const std::string& file) {
  Hooks hooks;
  hooks.progress = say_progress;
  const HonestyStudy study = honesty_study(size, files::usable_threads(), hooks);
  const Result chapter = honesty_chapter(study, size);
  for (const std::string& paragraph : chapter.paragraphs) std::cout << paragraph << "\n\n";
  for (const page::NumberTable& table : chapter.tables) print(table);
  if (!file.empty()) {
    std::ofstream out(file);
    out << chapter.values.front().csv;
    if (!out.flush()) throw std::runtime_error(file + " cannot be written");
  }
  std::size_t broken = study.contradictions + study.failures;
  for (const HonestyScene& scene : study.scenes) {
    if (!scene.failure.empty()) std::cout << '@' << scene.model << ": " << scene.failure << '\n';
  }
  for (const HonestyRow& row : study.rows) broken += row.broken;
  return broken == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) try {
  HonestySize size;
  size.scenes = count > 1 ? std::strtoull(words[1], nullptr, 10) : 1000;
  if (count > 3) size.first = std::strtoull(words[3], nullptr, 10);
  return run(size, count > 2 ? words[2] : "");
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}
