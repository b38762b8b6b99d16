// What the program says to flags that are misspelt or have the wrong number of numbers.
#include "cli/commands.h"
#include "support/test.h"

namespace exactff {
namespace {

struct MisusedFlags : testing::Test {
  const TemporaryDirectory directory;
  const std::string scene = EXACTFF_DATA_DIR "/scenes/cornell_box.obj";

  static void expect_refused(const Words& words, const std::string& message) {
    const ProgramRun run = run_exactff(words);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.error, "exactff: " + message + '\n');
  }
};

TEST_F(MisusedFlags, NumbersWithCommasAreShownWithSpaces) {
  const std::string what = "--at takes three numbers with spaces between them (it has '1,0,1'); write --at 1 0 1";
  expect_refused({"point", scene, "--at", "1,0,1", "--normal", "0", "1", "0", "--source", "light"}, what);
  expect_refused({"view", scene, "--normal", "0", "1", "0", "--at", "1,0,1"}, what);
  expect_refused({"view", scene, "--at=1,0,1", "--normal", "0", "1", "0"}, what);
  expect_refused(
      {"view", scene, "--at", "(1,", "0,", "1)", "--normal", "0,-1e-3,.5"},
      "--at takes three numbers with spaces between them (it has '(1, 0, 1)'); write --at 1 0 1\n"
      "--normal takes three numbers with spaces between them (it has '0,-1e-3,.5'); write --normal 0 -1e-3 .5");
  expect_refused({"render", scene, "--eye", "1,2,3", "--look", "0", "0", "0", "-o", directory.path() / "a.png"},
                 "--eye takes three numbers with spaces between them (it has '1,2,3'); write --eye 1 2 3");
}

TEST_F(MisusedFlags, AnotherNumberOfNumbersIsToldWithTheForm) {
  const std::string form = "); write --at X Y Z", what = "--at takes three numbers with spaces between them (it has ";
  expect_refused({"view", scene, "--at", "1", "0", "--normal", "0", "1", "0"}, what + "'1 0'" + form);
  expect_refused({"view", scene, "--at", "1", "0", "1", "2", "--normal", "0", "1", "0"}, what + "'1 0 1 2'" + form);
  expect_refused({"view", scene, "--at", "--normal", "0", "1", "0"},
                 "--at takes three numbers with spaces between them (it has none); write --at X Y Z");
}

TEST_F(MisusedFlags, TheNearestFlagIsSuggestedAndWordsKeepTheirOrder) {
  const Words point = {"point", scene, "--at", "200", "0", "400", "--normal", "0", "1", "0"};
  const auto with = [&](const Words& more) {
    Words words = point;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expect_refused(with({"--onn", "floor", "--source", "light"}),
                 "exactff point has no flag --onn (the command line has '--onn floor'); did you mean --on?");
  expect_refused(with({"--sourec", "light", "--plian"}),
                 "exactff point has no flag --sourec (the command line has '--sourec light'); did you mean --source?\n"
                 "exactff point has no flag --plian (the command line has '--plian'); did you mean --plain?");
  expect_refused(with({"--sour", "light"}),
                 "exactff point has no flag --sour (the command line has '--sour light'); did you mean --source?");
  expect_refused(
      with({"--quickly"}),
      "exactff point has no flag --quickly (the command line has '--quickly'); `exactff help point` lists its "
      "flags");
  // Another error of the same line would only hide the cause.
  expect_refused({"point", scene, "--att", "200", "0", "400", "--normal", "0", "1", "0"},
                 "exactff point has no flag --att (the command line has '--att 200 0 400'); did you mean --at?");
}

TEST_F(MisusedFlags, AFlagIsNoNameNorFileOfAnother) {
  expect_refused({"radiosity", scene, "--two-sided", "--accuracy", "1e-2"},
                 "--two-sided needs a name (--accuracy follows, which begins like a flag); write --two-sided NAME...");
  expect_refused({"matrix", scene, "--two-sided", "floor", "-o", "--force"},
                 "-o needs a file (--force follows, which begins like a flag); write -o FILE");
  expect_refused({"compare", scene, "-o"}, "-o needs a folder (nothing follows it); write -o DIR");
  expect_refused({"point", scene, "--source", "--lamp"},
                 "--source needs a name (--lamp follows, which begins like a flag); write --source NAME[:K]..., or "
                 "--source=--lamp if that is meant");
  const auto run = run_exactff(
      {"info", directory.write("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng --lamp\nf 1 2 3\n"), "--flip=--lamp"});
  EXPECT_EQ(run.exit_code, 0);
}

// Every option of every command that takes a value, before a flag of its own command.
TEST_F(MisusedFlags, NoFlagIsTakenForAValue) {
  CLI::App app("", "exactff");
  (void)cli::add_commands(app);
  for (const cli::CommandTable& command : cli::program_table(app).commands) {
    for (const cli::OptionRow& option : command.options) {
      if (option.value.empty() || option.least_values > 1) continue;
      const Words words = {command.name, option.names.back(), "-h"};
      const std::string said = complaint([&] { cli::refuse_flags_without_values(app, words); });
      EXPECT_TRUE(said.starts_with(option.names.back() + " needs a ")) << said;
    }
  }
}

TEST_F(MisusedFlags, NumbersMayBeNegativeOrWithoutADigitBeforeThePoint) {
  const std::string image = directory.path() / "a.png";
  for (const Words& words : {Words{"view", scene, "--at", "-1", "-.5", "-1e-3", "--normal", "-0", "1", "+0", "--plain"},
                             Words{"render", scene, "--eye", "-.5", "-1", "-800", "--look", "0", "-.5", "0", "--size",
                                   "2x2", "-o", image}}) {
    EXPECT_EQ(run_exactff(words).exit_code, 0);
  }
}

}  // namespace
}  // namespace exactff
