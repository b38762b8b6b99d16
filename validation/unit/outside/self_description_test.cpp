// Completion and help are written from the same option tables; the help serves as the reference.
#include <regex>

#include "stress/stress.h"
#include "support/test.h"

namespace exactff {
namespace {

std::string output_of(const Words& arguments) {
  const auto run = run_exactff(arguments);
  EXPECT_EQ(run.exit_code, 0);
  return run.output;
}

Words lines_of(const std::string& text) {
  std::istringstream in(text);
  Words lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// "  info      List what ..." after "Subcommands:".
Words commands() {
  const std::string help = output_of({"--help"});
  Words names;
  for (const std::string& line : lines_of(help.substr(help.find("Subcommands:")))) {
    if (line.starts_with("  ")) names.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  EXPECT_GE(names.size(), 4U);
  return names;
}

// "  -o,--output DIR   Folder ...": the names of every option.
std::set<std::string> options_in_help(const std::string& command) {
  static const std::regex kTitle(R"(^  (-[-a-z0-9]+)(?:,(--[-a-z0-9]+))?)", std::regex::ECMAScript);
  std::set<std::string> names;
  for (const std::string& line : lines_of(output_of({command, "--help"}))) {
    std::smatch title;
    if (!std::regex_search(line, title, kTitle)) continue;
    names.insert(title[1]);
    if (title[2].matched) names.insert(title[2]);
  }
  return names;
}

// What bash offers at the last of `words`; for files and folders, the way in which it is told to offer them.
Words offered_by_bash(const Words& words) {
  static const std::string kCompletion = output_of({"completion", "bash"});
  std::string script = "compopt() { COMPREPLY=(\"compopt $*\"); }\n" + kCompletion + "COMP_WORDS=(";
  for (const std::string& word : words) script += "'" + word + "' ";
  script += ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_exactff\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  const auto run = run_program("/bin/bash", {"-c", script});
  Words offers = lines_of(run.output);
  if (offers == Words{""}) offers.clear();
  return offers;
}

using Offers = Words;

TEST(Completion, BashOffersEveryOptionThatHelpLists) {
  for (const std::string& command : commands()) {
    const Offers offers = offered_by_bash({"exactff", command, "-"});
    EXPECT_EQ(std::set<std::string>(offers.begin(), offers.end()), options_in_help(command)) << command;
  }
}

TEST(Completion, BashOffersCommandsFirst) {
  EXPECT_EQ(offered_by_bash({"exactff", ""}), commands());
  EXPECT_EQ(offered_by_bash({"exactff", "po"}), Offers{"point"});
  EXPECT_EQ(offered_by_bash({"exactff", "--v"}), Offers{"--version"});
}

TEST(Completion, BashOffersTheChoicesOfAnOption) {
  EXPECT_EQ(offered_by_bash({"exactff", "point", "room.obj", "--engine", ""}), (Offers{"edges", "boolean", "both"}));
  EXPECT_EQ(offered_by_bash({"exactff", "point", "--engine", "b"}), (Offers{"boolean", "both"}));
  EXPECT_EQ(offered_by_bash({"exactff", "info", "--patches", "=", "f"}), Offers{"faces"});
  EXPECT_EQ(offered_by_bash({"exactff", "info", "--patches", "="}),
            (Offers{"groups", "faces", "planes", "smooth", "parts"}));
}

TEST(Completion, BashOffersFilesForScenes) {
  const Offers files = {"compopt -o default"};
  EXPECT_EQ(offered_by_bash({"exactff", "point", "ro"}), files);
  EXPECT_EQ(offered_by_bash({"exactff", "point", "--json", ""}), files);
  EXPECT_EQ(offered_by_bash({"exactff", "point", "--at", "-1", "0", ".5", ""}), files);
  EXPECT_EQ(offered_by_bash({"exactff", "point", "room.obj", "--svg", ""}), files);
}

TEST(Completion, BashOffersNamesThatTheProgramKnows) {
  EXPECT_EQ(offered_by_bash({"exactff", "help", "s"}), Offers{"stress"});
  EXPECT_EQ(offered_by_bash({"exactff", "compare", "room.obj", "--method", "hemi"}), Offers{"hemicube"});
  EXPECT_EQ(offered_by_bash({"exactff", "stress", "--family", "crack-"}), Offers{"crack-ulp"});
  EXPECT_EQ(offered_by_bash({"exactff", "stress", "--family", "shrink,crack-"}), Offers{"shrink,crack-ulp"});
  EXPECT_EQ(offered_by_bash({"exactff", "stress", "--family", ""}).size(), stress::all_families().size());
}

// Bash splits the word at the @, and yet replaces all of it.
TEST(Completion, BashOffersModelsAfterAnAtSign) {
  EXPECT_EQ(offered_by_bash({"exactff", "info", "@", "tea"}), Offers{"@teapot"});
  EXPECT_EQ(offered_by_bash({"exactff", "truth", "--on", "floor", "@", "ka"}), Offers{"@karkanis"});
  EXPECT_EQ(offered_by_bash({"exactff", "point", "@"}).size(), models::all_models().size());
}

TEST(Help, TellsChoicesDefaultsAndWhatIsRequired) {
  const std::string help = output_of({"point", "--help"});
  for (const char* part : {"--engine edges|boolean|both ", "(default: edges)", "--at X Y Z ", "(required)",
                           "--source NAME[:K]...", "(1 to 10000)", "(not with --json)"}) {
    EXPECT_HOLDS(help, part) << part << "\nin\n" << help;
  }
  for (const char* part : {"TEXT:{", "INT in [", "REQUIRED"}) EXPECT_EQ(help.find(part), std::string::npos) << part;
}

TEST(Help, IsACommandToo) {
  EXPECT_EQ(output_of({"help"}), output_of({"--help"}));
  for (const std::string& command : commands()) EXPECT_EQ(output_of({"help", command}), output_of({command, "--help"}));
}

std::string refusal_of(const Words& arguments) {
  const TemporaryDirectory directory;
  const RunningProgram run(EXACTFF_PROGRAM, arguments, directory.path() / "stderr");
  EXPECT_EQ(run.wait(), 2);
  return run.error();
}

const std::string kCommands =
    " (the commands are info, point, view, matrix, radiosity, render, compare, truth, merge, check, stress, convert "
    "and help); ";

TEST(Commands, MisspeltGetASuggestion) {
  EXPECT_EQ(refusal_of({"poitn", "room.obj", "--at", "0", "0", "0"}),
            "exactff: there is no command 'poitn'" + kCommands + "did you mean point?\n");
  EXPECT_EQ(refusal_of({"Compare"}), "exactff: there is no command 'Compare'" + kCommands + "did you mean compare?\n");
  EXPECT_EQ(refusal_of({"help", "streess"}),
            "exactff: there is no command 'streess'" + kCommands + "did you mean stress?\n");
  EXPECT_EQ(refusal_of({"help", "-5"}),
            "exactff: there is no command '-5'" + kCommands + "`exactff help` explains them\n");
  EXPECT_EQ(refusal_of({"luminance"}),
            "exactff: there is no command 'luminance'" + kCommands + "`exactff help` explains them\n");
}

}  // namespace
}  // namespace exactff
