// Tests whether view factors keep their word, writes a report, and prints in Markdown what it found. Exit code 1 if one
// is not honest: an error is proved to exceed the reported one, two enclosures are disjoint, or a cell fails its own
// check.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>

#include "files/parallel.h"
#include "page/output_folder.h"
#include "report/report.h"
#include "studies/honesty.h"
#include "text/escape.h"

namespace exactff::experiments {
namespace {

struct Arguments {
  HonestySize size;
  int threads = files::usable_threads();
  std::string folder;
};

void declare(CLI::App& app, Arguments& args) {
  app.add_option("--scenes", args.size.scenes, "Number of random scenes")->capture_default_str();
  app.add_flag_callback(
      "--almost-closed", [&] { args.size.families = HonestyFamilies::kAlmostClosed; },
      "Only rooms, dishes and streets whose corners or walls are off by 1e-15 to 1e-3");
  app.add_option("--first", args.size.first, "Number of the first scene")->capture_default_str();
  app.add_option("--threads", args.threads, "Number of threads (default: all)")->check(CLI::Range(1, 4096));
  app.add_option("-o", args.folder, "Folder for the report and the tables")->required();
}

void print_row(const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) std::cout << "| " << cell << ' ';
  std::cout << "|\n";
}

void print(const Result& chapter) {
  for (const std::string& paragraph : chapter.paragraphs) std::cout << paragraph << "\n\n";
  for (const NumberTable& table : chapter.tables) {
    print_row(table.columns);
    print_row(std::vector<std::string>(table.columns.size(), "---"));
    for (const std::vector<std::string>& row : table.rows) print_row(row);
    std::cout << '\n';
  }
}

void say_progress(const Progress& progress) {
  if (progress.done % 50 == 0) std::cerr << progress.stage << ": " << progress.done << " of " << progress.total << '\n';
}

bool is_honest(const HonestyStudy& study) {
  for (const HonestyScene& scene : study.scenes) {
    if (!scene.failure.empty()) std::cout << '@' << scene.model << ": " << scene.failure << '\n';
  }
  return study.contradictions + study.failures == 0 &&
         std::ranges::all_of(study.rows, [](const HonestyRow& row) { return row.broken == 0; });
}

int run(const Arguments& args, std::string command_line) {
  page::check_output_folder(args.folder);
  report::StudyReport report;
  report.title = "Tests of our own claims";
  report.command_line = std::move(command_line);
  const HonestyStudy study = honesty_study(args.size, args.threads, {say_progress, {}});
  report.chapters.push_back(honesty_chapter(study));
  print(report.chapters.front());
  for (const std::string& note : report::write(report, args.folder)) std::cerr << "note: " << note << '\n';
  return is_honest(study) ? 0 : 1;
}

std::string joined(int count, char** words) {
  std::string line = "exactff_honesty";
  for (int i = 1; i < count; ++i) line += ' ' + text::shell_word(words[i]);
  return line;
}

}  // namespace
}  // namespace exactff::experiments

int main(int count, char** words) try {
  CLI::App app{"Tests whether view factors keep their word, and writes a report."};
  exactff::experiments::Arguments args;
  exactff::experiments::declare(app, args);
  CLI11_PARSE(app, count, words);
  return exactff::experiments::run(args, exactff::experiments::joined(count, words));
} catch (const std::exception& error) {
  std::cerr << "exactff_honesty: " << error.what() << '\n';
  return 2;
}
