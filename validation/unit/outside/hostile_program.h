// Runs the program in trouble: command lines, limits of its resources, a fake gnuplot, and what may remain afterwards.
#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "support/folder.h"
#include "support/program.h"

namespace exactff {

class HostileProgram : public testing::Test {
 protected:
  using Running = validation::RunningProgram;

  static inline const std::string kRoom =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\n"
      "g floor\nf 1 2 3 4\ng light\nf 8 7 6 5\n";

  HostileProgram() { std::filesystem::create_directory(place_); }

  static void limit(int resource, rlim_t value) {
    const rlimit both{value, value};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
  }

  Running start(
      const std::vector<std::string>& arguments, const std::function<void()>& prepare = [] {}) const {
    return {EXACTFF_PROGRAM, arguments, directory_.path() / "stderr", prepare};
  }

  std::vector<std::string> comparison(const std::filesystem::path& folder) const {
    return {"compare",   room_, "--on",         "floor",   "--source", "light", "--grid", "2x2",
            "--threads", "1",   "--no-methods", "--eps-b", ".1",       "-o",    folder};
  }
  std::vector<std::string> resumed(const std::filesystem::path& folder) const {
    std::vector<std::string> all = comparison(folder);
    all.emplace_back("--resume");
    return all;
  }
  std::vector<std::string> point(std::vector<std::string> more) const {
    std::vector<std::string> all{"point",    room_, "--at", ".5", ".5",       "0",
                                 "--normal", "0",   "0",    "1",  "--source", "light"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::vector<std::string> truth_file(const std::filesystem::path& file) const {
    return {"truth", room_, "--on", "floor", "--source", "light", "--grid", "2x2", "--threads", "1", "-o", file};
  }
  // Every command that prints.
  std::vector<std::vector<std::string>> printing() const {
    const std::string truth = (directory_.path() / "truth.csv").string();
    EXPECT_EQ(start(truth_file(truth)).wait(), 0);
    return {{"--help"},
            {"--version"},
            {"info", "--help"},
            {"compare", "--help"},
            {"info", "@"},
            {"info", "@", "--json"},
            {"info", room_},
            {"info", room_, "--json"},
            {"completion", "bash"},
            {"stress", "--list"},
            {"check", truth, truth},
            {"check", truth, truth, "--github"},
            truth_file(truth + ".2"),
            point({}),
            point({"--plain"}),
            point({"--json"})};
  }

  // A fake gnuplot that is found before any other.
  std::function<void()> with_gnuplot(const std::string& script) const {
    const std::filesystem::path folder = directory_.path() / "bin";
    std::filesystem::create_directory(folder);
    std::ofstream(folder / "gnuplot") << "#!/bin/sh\n" << script << '\n';
    std::filesystem::permissions(folder / "gnuplot", std::filesystem::perms::owner_all);
    return [path = folder.string() + ":/usr/bin:/bin"] { ::setenv("PATH", path.c_str(), 1); };
  }

  void expect_nothing_in_place() const { EXPECT_TRUE(std::filesystem::is_empty(place_)); }
  // Only the journal remains, and it is usable: with it, the comparison gives the bytes of an undisturbed one.
  void expect_only_a_journal(const std::filesystem::path& folder) const {
    EXPECT_EQ(validation::names_in(folder.parent_path()), std::set<std::string>{folder.filename().string() + ".part"});
    const auto without_gnuplot = [] { ::setenv("PATH", "/nonexistent", 1); };
    const Running refused = start(comparison(folder), without_gnuplot);
    EXPECT_EQ(refused.wait(), 2);
    EXPECT_NE(refused.error().find(".part: contains the finished work of an interrupted run"), std::string::npos)
        << refused.error();
    const Running going_on = start(resumed(folder), without_gnuplot);
    EXPECT_EQ(going_on.wait(), 0) << going_on.error();
    EXPECT_NE(going_on.error().find("were reused from the interrupted run"), std::string::npos) << going_on.error();
    EXPECT_EQ(validation::names_in(folder.parent_path()), std::set<std::string>{folder.filename().string()});
    std::filesystem::remove_all(directory_.path() / "undisturbed");
    EXPECT_EQ(start(comparison(directory_.path() / "undisturbed"), without_gnuplot).wait(), 0);
    for (const char* file : {"values.csv", "exact.csv", "summary.csv"}) {
      EXPECT_EQ(validation::text_of(folder / file), validation::text_of(directory_.path() / "undisturbed" / file));
    }
    std::filesystem::remove_all(folder);
  }

  const validation::TemporaryDirectory directory_;
  const std::string room_ = directory_.write("room.obj", kRoom).string();
  const std::filesystem::path place_ = directory_.path() / "place";  // the place of the results
};

}  // namespace exactff
