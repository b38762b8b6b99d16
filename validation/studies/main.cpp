// Tests of our own claims: runs the named studies, or all, and writes a report on them. Prints in Markdown what they
// found. Exit code 1 if a view factor is not honest: an error is proved to exceed the reported one, two enclosures are
// disjoint, or a cell fails its own check.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <optional>

#include "files/parallel.h"
#include "page/output_folder.h"
#include "report/report.h"
#include "studies/honesty.h"
#include "studies/view_factors.h"
#include "studies/whole_view_times.h"
#include "text/escape.h"

namespace exactff::experiments {
namespace {

struct Arguments {
  std::vector<std::string> names = {"whole-view", "view-factors", "honesty"};
  Effort effort{.threads = files::usable_threads()};
  std::optional<std::uint64_t> scenes;
  std::uint64_t first = 1;
  std::string folder;

  [[nodiscard]] bool has(std::string_view name) const { return std::ranges::find(names, name) != names.end(); }
  [[nodiscard]] HonestySize honesty() const {
    HonestySize size = honesty_size(effort.abridged);
    size.first = first;
    size.scenes = scenes.value_or(size.scenes);
    return size;
  }
};

void declare(CLI::App& app, Arguments& args) {
  app.add_option("STUDY", args.names,
                 "whole-view: time for all that one point sees, in one sweep\n"
                 "view-factors: widths, claims and rows of view factors from patch to patch\n"
                 "honesty: how often the true error of a view factor exceeds the reported one, in random scenes\n"
                 "(default: all)")
      ->check(CLI::IsMember(args.names));
  app.add_flag("--abridged", args.effort.abridged, "Take a second for each study, not up to half a minute");
  app.add_option("--threads", args.effort.threads, "Number of threads (default: all)")->check(CLI::Range(1, 4096));
  app.add_option("--scenes", args.scenes, "honesty: number of random scenes (default: 100, abridged 24)");
  app.add_option("--first", args.first, "honesty: number of the first scene")->capture_default_str();
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
  const Hooks hooks{say_progress, {}};
  report::StudyReport report;
  report.title = "Tests of our own claims";
  report.command_line = std::move(command_line);
  bool holds = true;
  if (args.has("whole-view")) report.chapters.push_back(whole_view_times(args.effort, hooks));
  if (args.has("view-factors")) report.chapters.push_back(view_factors(args.effort, hooks));
  if (args.has("honesty")) {
    const HonestyStudy study = honesty_study(args.honesty(), args.effort.threads, hooks);
    report.chapters.push_back(honesty_chapter(study, args.honesty()));
    holds = is_honest(study);
  }
  std::ranges::for_each(report.chapters, print);
  for (const std::string& note : report::write(report, args.folder)) std::cerr << "note: " << note << '\n';
  return holds ? 0 : 1;
}

std::string joined(int count, char** words) {
  std::string line = "exactff_studies";
  for (int i = 1; i < count; ++i) line += ' ' + text::shell_word(words[i]);
  return line;
}

}  // namespace
}  // namespace exactff::experiments

int main(int count, char** words) try {
  CLI::App app{"Tests our own claims and writes a report on the results."};
  exactff::experiments::Arguments args;
  exactff::experiments::declare(app, args);
  CLI11_PARSE(app, count, words);
  return exactff::experiments::run(args, exactff::experiments::joined(count, words));
} catch (const std::exception& error) {
  std::cerr << "exactff_studies: " << error.what() << '\n';
  return 2;
}
