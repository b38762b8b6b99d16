// Hidden folders of killed processes, of living ones, of older versions and of other programs.
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "files/file.h"
#include "page/output_folder.h"
#include "support/test.h"

namespace exactff::study {
namespace {

namespace fs = std::filesystem;

class WorkFolders : public testing::Test {
 protected:
  std::set<std::string> names() const { return names_in(directory_.path()); }
  void put(const fs::path& file, const std::string& text = "x") const {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  // A process that creates the folder and is killed immediately afterwards.
  void be_killed_in_the_middle() const {
    const pid_t child = ::fork();
    if (child == 0) {
      const files::WorkFolder folder(target_);
      std::ofstream(folder.path() / "half.csv") << "half";
      ::raise(SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
  }

  const TemporaryDirectory directory_;
  const fs::path target_ = directory_.path() / "result";
};

TEST_F(WorkFolders, OfAKilledProcessAreCleared) {
  be_killed_in_the_middle();
  EXPECT_EQ(names().size(), 1U);
  { const files::WorkFolder folder(target_); }
  EXPECT_TRUE(names().empty());
}

TEST_F(WorkFolders, OfALivingProcessAreNotTouched) {
  const files::WorkFolder living(target_);
  std::ofstream(living.path() / "half.csv") << "half";
  be_killed_in_the_middle();  // this one removes nothing either
  EXPECT_EQ(names().size(), 2U);
  { const files::WorkFolder other(target_); }
  EXPECT_EQ(names(), std::set<std::string>{living.path().filename().string()});
  EXPECT_TRUE(fs::exists(living.path() / "half.csv"));
}

TEST_F(WorkFolders, WhatWasNeverPutThereByUsStays) {
  put(directory_.path() / ".result.partial-1" / "deeper" / "letter.txt");
  put(directory_.path() / ".result.partial-mine" / "letter.txt");
  put(directory_.path() / ".result.partial-2");  // no folder
  { const files::WorkFolder folder(target_); }
  EXPECT_EQ(names(), (std::set<std::string>{".result.partial-1", ".result.partial-2", ".result.partial-mine"}));
  EXPECT_TRUE(fs::exists(directory_.path() / ".result.partial-1" / "deeper" / "letter.txt"));
  EXPECT_TRUE(fs::exists(directory_.path() / ".result.partial-mine" / "letter.txt"));
}

TEST_F(WorkFolders, TakeThePlaceOfTheTarget) {
  put(target_ / "old.csv");
  {
    files::WorkFolder folder(target_);
    std::ofstream(folder.path() / "new.csv") << "new";
    folder.put_in_place();
  }
  EXPECT_EQ(names(), std::set<std::string>{"result"});
  EXPECT_TRUE(fs::exists(target_ / "new.csv"));
  EXPECT_FALSE(fs::exists(target_ / "old.csv"));
  EXPECT_FALSE(fs::exists(target_ / files::kLockFile));
}

// Killed between two renames, where the file system cannot exchange folders.
TEST_F(WorkFolders, AFormerResultComesBack) {
  put(directory_.path() / ".result.old-4711-0" / "values.csv", "# exactff 0.1.0\n");
  { const files::WorkFolder folder(target_); }
  EXPECT_EQ(names(), std::set<std::string>{"result"});
  EXPECT_TRUE(fs::exists(target_ / "values.csv"));
  put(directory_.path() / ".result.old-4711-0" / "values.csv", "# exactff 0.1.0\n");
  { const files::WorkFolder folder(target_); }
  EXPECT_EQ(names(), std::set<std::string>{"result"});
}

TEST_F(WorkFolders, WholeFilesTakeTheirTurns) {
  const fs::path file = directory_.path() / "a.svg";
  put(file.string() + ".whole", "what a killed process left");
  {
    files::WholeFile first(file);
    first.append("first");
    EXPECT_THROW(files::WholeFile second(file), InputError);
    first.commit();
  }
  EXPECT_EQ(text_of(file), "first");
  EXPECT_EQ(names(), std::set<std::string>{"a.svg"});
}

}  // namespace
}  // namespace exactff::study
