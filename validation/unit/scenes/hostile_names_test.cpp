// Names of patches, files and titles that control terminals, change the reading direction or are not valid text. None
// of this may reach a terminal, a log or a page, and machine-readable output must be valid.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/program.h"
#include "text/encoding.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;
using validation::text_of;

// Escape, a C1 control, a right-to-left mark, HTML markup; not UTF-8: Latin-1, an overlong slash, half a surrogate
// pair.
const std::string kLight = "l\u00E4mp\x1B[31m\xC2\x9B\xE2\x80\xAE<&>\"'%";
const std::string kFloor = "fl\x07oor\x7F,::error::\xED\xA0\x80";
const std::string kShownLight = "l\u00E4mp\\x1b[31m\\u009b\\u202e<&>\"'%";
const std::string kRoom =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\nv .2 .2 1\nv .8 .2 1\nv .8 .8 1\n"
    "g " +
    kFloor + "\nf 1 2 3 4\ng " + kLight + "\nf 8 7 6 5\ng b\xFC\x1B\x81\xC0\xAF\nf 9 10 11\n";

struct Ran {
  int exit_code = 0;
  std::string output;
  std::string error;
};

class HostileNames : public testing::Test {
 protected:
  Ran run(const std::vector<std::string>& arguments) const {
    const fs::path out = directory_.path() / "stdout";
    const validation::RunningProgram program(EXACTFF_PROGRAM, arguments, directory_.path() / "stderr", [&out] {
      if (std::freopen(out.c_str(), "w", stdout) == nullptr) std::_Exit(125);
    });
    const int exit_code = program.wait();
    return {exit_code, text_of(out), program.error()};
  }
  Ran expect_harmless(const std::vector<std::string>& arguments, int exit_code = 0) const {
    Ran run = this->run(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.error;
    EXPECT_TRUE(is_harmless(run.output)) << run.output;
    EXPECT_TRUE(is_harmless(run.error)) << run.error;
    return run;
  }
  std::vector<std::string> point(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"point", room_, "--at", ".5",   ".5",   "0",        "--normal",
                                 "0",     "0",   "1",    "--on", kFloor, "--source", kLight};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  fs::path truth() const {
    fs::path file = directory_.path() / "truth.csv";
    const Ran made = run({"truth", room_, "--receivers", receivers_, "--source", kLight, "-o", file.string()});
    EXPECT_EQ(made.exit_code, 0) << made.error;
    return file;
  }

  // Lines of visible characters only. The JSON parser accepts only well-formed UTF-8.
  static bool is_harmless(const std::string& text) {
    std::string letters;
    for (const char c : text) {
      if ((static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7F) return false;
      letters += c == '\n' || c == '"' || c == '\\' ? 'x' : c;
    }
    for (const char* act : {"\u0080", "\u0085", "\u009B", "\u202E", "\uFFFE"}) {
      if (text.find(act) != std::string::npos) return false;
    }
    return nlohmann::json::accept('"' + letters + '"');
  }

  const validation::TemporaryDirectory directory_;
  const std::string room_ = directory_.write("r\x1B\xE4oom.obj", kRoom).string();
  const std::string receivers_ =
      directory_.write("receivers.csv", "id,x,y,z,nx,ny,nz\n\"r\x1B\xE4,::error::\",.5,.5,0,0,0,1\nb,.1,.1,0,0,0,1\n");
};

TEST_F(HostileNames, AreSeenInLists) {
  const Ran list = expect_harmless({"info", room_});
  EXPECT_NE(list.output.find(kShownLight), std::string::npos) << list.output;
  expect_harmless({"info", room_, "--patches", "faces"});
}

TEST_F(HostileNames, AreSeenInComplaints) {
  expect_harmless({"info", "no\x1B[2J\xE4.obj"}, 2);
  expect_harmless(point({"--source", "x\x1B\xC2\x9B"}), 2);
  expect_harmless({"\x1B[2J\xE4"}, 2);                          // reported by the parser of flags
  expect_harmless({"info", room_, "--no\x1B\xE2\x80\xAE"}, 2);  // this too
  expect_harmless(point({"--at", "1", "2", "3\x1B"}), 2);
  const std::string bad = directory_.write("bad.obj", "v 0 0 \x1B[2J\xE4\xC2\x85\nf \xE2\x80\xAE 2 3\n").string();
  EXPECT_NE(expect_harmless({"info", bad}, 2).error.find("\\x1b[2J\\xe4\\u0085"), std::string::npos);
}

TEST_F(HostileNames, ArriveInJson) {
  const auto list = nlohmann::json::parse(expect_harmless({"info", room_, "--json"}).output);
  EXPECT_EQ(list["patches"][1]["name"], kLight);
  EXPECT_EQ(list["patches"][2]["name"], "b\u00FC\x1B\u0081\u00C0\u00AF");
  const auto result = nlohmann::json::parse(expect_harmless(point({"--json", "--explain"})).output);
  EXPECT_EQ(result["sources"][0]["source"], list["patches"][1]["name"]);
}

TEST_F(HostileNames, ArriveInPictures) {
  const fs::path picture = directory_.path() / "view.svg";
  expect_harmless(point({"--svg", picture.string()}));
  const std::string svg = text_of(picture);
  EXPECT_TRUE(is_harmless(svg));
  EXPECT_NE(svg.find("l\u00E4mp\\x1b[31m\\u009b\\u202e&lt;&amp;&gt;&quot;'%"), std::string::npos) << svg;
}

TEST_F(HostileNames, AreReadBackFromTruthFiles) {
  const std::string file = truth().string();
  EXPECT_NE(text_of(file).find("\"r\x1B\u00E4,::error::\""), std::string::npos) << "Latin-1 is converted";
  EXPECT_TRUE(text::is_utf8(text_of(file))) << "and so is the name of the scene's file";
  const fs::path junit = directory_.path() / "j.xml", json = directory_.path() / "j.json";
  expect_harmless({"check", file, file, "--max-abs", "0", "--junit", junit.string(), "--json", json.string()});
  EXPECT_TRUE(is_harmless(text_of(junit)));
  EXPECT_EQ(nlohmann::json::parse(text_of(json))["overall"]["rows"], 2);
}

TEST_F(HostileNames, MakeNoAnnotationsOfTheirOwn) {
  const std::string file = truth().string();
  const std::string mine =
      directory_.write("mine\x1B.csv", "receiver,value\n\"r\x1B\xE4,::error::\",1\nb,1\n").string();
  const Ran failed = expect_harmless({"check", file, mine, "--max-abs", "0", "--github"}, 1);
  std::size_t annotations = 0;
  for (std::size_t at = failed.output.find("\n::"); at != std::string::npos; at = failed.output.find("\n::", at + 1)) {
    ++annotations;
  }
  EXPECT_EQ(annotations, 1U) << failed.output;
  const std::string bad = directory_.write("bad.csv", "receiver,value\n\x1B[2J\xE4,1\n").string();
  expect_harmless({"check", file, bad, "--github"}, 2);
}

TEST_F(HostileNames, AreSeenInReports) {
  const fs::path folder = directory_.path() / "study\xE4";
  expect_harmless({"compare", room_, "--receivers", receivers_, "--source", kLight, "--no-methods", "--eps-b", ".1",
                   "--threads", "1", "-o", folder.string()});
  std::string page = text_of(folder / "report.html");
  EXPECT_NE(page.find("l\u00E4mp\\x1b[31m"), std::string::npos);
  std::replace(page.begin(), page.end(), '\t', ' ');  // of gnuplot
  EXPECT_TRUE(is_harmless(page));
  for (const auto& file : fs::directory_iterator(folder)) EXPECT_TRUE(text::is_utf8(text_of(file))) << file;
}

}  // namespace
}  // namespace exactff
