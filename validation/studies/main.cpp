// Tests whether view factors keep their word, and prints in Markdown what it found. Exit code 1 if one is not honest:
// an error is proved to exceed the reported one, two enclosures are disjoint, or a cell fails its own check.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "files/parallel.h"
#include "studies/honesty.h"
#include "text/phrases.h"

namespace exactff::experiments {
namespace {

struct Arguments {
  HonestySize size;
  int threads = files::usable_threads();
  std::filesystem::path folder;
};

void declare(CLI::App& app, Arguments& args) {
  app.add_option("--scenes", args.size.scenes, "Number of random scenes")->capture_default_str();
  app.add_flag_callback(
      "--almost-closed", [&] { args.size.families = HonestyFamilies::kAlmostClosed; },
      "Only rooms, dishes and streets whose corners or walls are off by 1e-15 to 1e-3");
  app.add_option("--first", args.size.first, "Number of the first scene")->capture_default_str();
  app.add_option("--threads", args.threads, "Number of threads (default: all)")->check(CLI::Range(1, 4096));
  app.add_option("-o", args.folder, "Folder for honesty.csv, with all entries and their truth")->required();
}

void print(const HonestyStudy& study) {
  std::cout << "| claim | accuracy | entries | within | open | exceeded | worst true / reported | wider than asked |\n"
               "|---|---|---|---|---|---|---|---|\n";
  for (const HonestyRow& row : study.rows) {
    std::cout << "| " << to_string(row.claim);
    if (row.claim == Claim::kEstimated) std::cout << " by " << to_string(row.way);
    std::cout << " | " << (row.accuracy > 0.0 ? text::shortest(row.accuracy) : "") << " | " << row.entries << " | "
              << row.holds << " | " << row.open << " | " << row.broken << " | "
              << (row.claim == Claim::kZero ? "" : text::rounded(row.worst.at_least, 2)) << " | " << row.wide << " |\n";
  }
  std::cout << "\nScenes: " << study.scenes.size()
            << ". Enclosures of both directions that are disjoint: " << study.contradictions << '\n';
  for (const HonestyScene& scene : study.scenes) {
    if (!scene.failure.empty()) std::cout << '@' << scene.model << ": " << scene.failure << '\n';
  }
}

void say_progress(const Progress& progress) {
  if (progress.done % 50 == 0) std::cerr << progress.stage << ": " << progress.done << " of " << progress.total << '\n';
}

int run(const Arguments& args) {
  std::filesystem::create_directories(args.folder);
  std::ofstream file(args.folder / "honesty.csv", std::ios::binary);
  const HonestyStudy study = honesty_study(args.size, args.threads, {say_progress, {}});
  print(study);
  if (!(file << honesty_csv(study) << std::flush)) throw std::runtime_error("cannot write " + args.folder.string());
  const bool is_honest = study.contradictions + study.failures == 0 &&
                         std::ranges::all_of(study.rows, [](const HonestyRow& row) { return row.broken == 0; });
  return is_honest ? 0 : 1;
}

}  // namespace
}  // namespace exactff::experiments

int main(int count, char** words) try {
  CLI::App app{"Tests whether view factors keep their word."};
  exactff::experiments::Arguments args;
  exactff::experiments::declare(app, args);
  CLI11_PARSE(app, count, words);
  return exactff::experiments::run(args);
} catch (const std::exception& error) {
  std::cerr << "exactff_honesty: " << error.what() << '\n';
  return 2;
}
