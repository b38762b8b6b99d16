// The file that describes a study.
#include "flags/comparison.h"
#include "report/plan.h"
#include "support/test.h"

namespace exactff::cli {
namespace {

class StudyFileReader : public ::testing::Test {
 protected:
  flags::StudyFile read(const std::string& text) const {
    return flags::parse_study_file(directory_.write("a.study", text));
  }
  // The problems of a file, without the name of its folder.
  std::string complaint(const std::string& text) const {
    std::string said = validation::complaint([&] { (void)read(text); });
    const std::string folder = directory_.path().string() + '/';
    for (std::size_t at; (at = said.find(folder)) != std::string::npos;) said.erase(at, folder.size());
    return said;
  }

  const TemporaryDirectory directory_;
};

TEST_F(StudyFileReader, TakesTitleAndScenes) {
  const flags::StudyFile study = read(
      "# what this is\n"
      "title  Form factors of \"rooms\"  \n"
      "\n"
      "scene room.obj --on floor --title \"A room\"   # the small one\n"
      "\tscene\t@teapot\t--grid 2x2\r\n");
  EXPECT_EQ(study.title, "Form factors of \"rooms\"");
  ASSERT_EQ(study.scenes.size(), 2U);
  EXPECT_EQ(study.scenes[0].number, 4U);
  EXPECT_EQ(study.scenes[0].words, (Words{"room.obj", "--on", "floor", "--title", "A room"}));
  EXPECT_EQ(study.scenes[1].words, (Words{"@teapot", "--grid", "2x2"}));
}

TEST_F(StudyFileReader, TellsEverythingThatIsWrongWithItsLine) {
  const std::string said = complaint(
      "Scene a.obj\n"
      "title\n"
      "scene 'a b.obj --on floor\n"
      "scene\n"
      "scene a.obj\n"
      "field cycles.csv\n");
  EXPECT_HOLDS(said, "a.study:1: a line begins with 'Scene'");
  EXPECT_HOLDS(said, "a.study:2: nothing follows 'title'");
  EXPECT_HOLDS(said, "a.study:3: a quote is not closed (the end of the word is unknown); close it with '");
  EXPECT_HOLDS(said, "a.study:4: nothing follows 'scene'");
  EXPECT_HOLDS(said, "a.study:6: a line begins with 'field'");
  EXPECT_EQ(said.find("a.study:5"), std::string::npos) << said;
}

}  // namespace
}  // namespace exactff::cli
