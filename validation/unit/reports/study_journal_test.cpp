// Finished work in a file: added records are read back, and torn, damaged or foreign files do no harm.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <string>

#include "exactff/study.h"
#include "jobs/kept_work.h"
#include "report/report.h"
#include "support/program.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

namespace fs = std::filesystem;
using jobs::Existing;
using jobs::Journal;
using jobs::journal_of_folder;
using jobs::KeptWork;
using validation::expect_same_values;
using validation::request_with_methods;
using validation::small_request;
using validation::small_room;

// --- the file ------------------------------------------------------------------------------------------------

class StudyJournal : public ::testing::Test {
 protected:
  // Three pieces of work, the second of them with line ends and zeros.
  std::string written() const {
    Journal journal(file_, Existing::kRefuse);
    for (const auto& [name, bytes] : pieces_) journal.add(name, bytes);
    return validation::text_of(file_);
  }
  void put(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }
  // Every block is either right or missing. Returns the number of those that are there.
  std::size_t sound_pieces(const Journal& journal) const {
    std::size_t count = 0;
    for (const auto& [name, bytes] : pieces_) {
      const auto found = journal.find(name);
      if (!found) continue;
      EXPECT_EQ(*found, bytes) << name;
      ++count;
    }
    EXPECT_EQ(journal.size(), count);
    return count;
  }
  std::string refusal(Existing existing) const {
    try {
      const Journal journal(file_, existing);
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }

  const validation::TemporaryDirectory directory_;
  const fs::path file_ = directory_.path() / "out.part";
  const std::vector<std::pair<std::string, std::string>> pieces_ = {
      {"a/0", "first"}, {"b", std::string("x\n\0# work y, 1 bytes, crc 00000000\n", 35)}, {"c-1", std::string()}};
};

TEST_F(StudyJournal, KeepsWhatIsAdded) {
  {
    Journal journal(file_, Existing::kRefuse);
    EXPECT_EQ(journal.find("a/0"), std::nullopt);
    for (const auto& [name, bytes] : pieces_) journal.add(name, bytes);
    EXPECT_EQ(sound_pieces(journal), 3U);
  }
  EXPECT_EQ(sound_pieces(Journal(file_, Existing::kResume)), 3U);
}

TEST_F(StudyJournal, ThatIsAddedToAgainHasTheLastBytes) {
  Journal journal(file_, Existing::kRefuse);
  journal.add("a", "old");
  journal.add("a", "newer");
  EXPECT_EQ(journal.find("a"), "newer");
  EXPECT_EQ(journal.size(), 1U);
}

TEST_F(StudyJournal, OfAnInterruptedRunIsRefusedResumedOrReplaced) {
  const std::string bytes = written();
  const std::string said = refusal(Existing::kRefuse);
  EXPECT_NE(said.find("out.part: contains the finished work of an interrupted run"), std::string::npos) << said;
  EXPECT_NE(said.find("--resume"), std::string::npos);
  EXPECT_NE(said.find("--force"), std::string::npos);
  EXPECT_EQ(validation::text_of(file_), bytes) << "a refusal changes nothing";
  EXPECT_EQ(sound_pieces(Journal(file_, Existing::kResume)), 3U);
  Journal anew(file_, Existing::kReplace);
  EXPECT_EQ(anew.size(), 0U);
  EXPECT_EQ(anew.find("b"), std::nullopt);
}

TEST_F(StudyJournal, CutAnywhereHasItsSoundBeginningAndGoesOn) {
  const std::string whole = written();
  std::set<std::size_t> counts;
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    put(whole.substr(0, cut));
    {
      Journal journal(file_, Existing::kResume);
      const std::size_t count = sound_pieces(journal);
      counts.insert(count);
      for (std::size_t k = count; k < pieces_.size(); ++k) journal.add(pieces_[k].first, pieces_[k].second);
    }
    EXPECT_EQ(validation::text_of(file_), whole) << "cut at " << cut;
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{0, 1, 2}));
}

TEST_F(StudyJournal, DamagedInAnyByteHasNothingThatIsWrong) {
  const std::string whole = written();
  const std::size_t head = whole.find('\n') + 1;
  for (std::size_t at = head; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    put(damaged);
    {
      Journal journal(file_, Existing::kResume);
      EXPECT_EQ(sound_pieces(journal), 2U) << at;
      journal.add("new", "work");
    }
    Journal again(file_, Existing::kResume);
    EXPECT_EQ(again.find("new"), "work") << at;
    EXPECT_EQ(again.size(), 3U) << at;
  }
}

TEST_F(StudyJournal, WithNothingSoundInItIsNoReasonToRefuse) {
  const std::string whole = written();
  put(whole.substr(0, whole.find('\n') + 4));
  EXPECT_EQ(refusal(Existing::kRefuse), "");
}

TEST_F(StudyJournal, OfAnotherVersionIsOnlyReplaced) {
  const std::string theirs = "exactff journal 1, version 0.0.0\na 1 00000000\nx\n";
  for (const Existing existing : {Existing::kRefuse, Existing::kResume}) {
    put(theirs);
    EXPECT_NE(refusal(existing).find("another version"), std::string::npos);
    EXPECT_EQ(validation::text_of(file_), theirs);
  }
  EXPECT_EQ(refusal(Existing::kReplace), "");
}

TEST_F(StudyJournal, IsNotMadeOfAFileThatIsNone) {
  for (const Existing existing : {Existing::kRefuse, Existing::kResume, Existing::kReplace}) {
    put("Dear reader,\n");
    EXPECT_NE(refusal(existing).find("exactff did not write it"), std::string::npos);
    EXPECT_EQ(validation::text_of(file_), "Dear reader,\n");
  }
}

TEST_F(StudyJournal, InUseIsRefusedToOthers) {
  Journal journal(file_, Existing::kRefuse);
  journal.add("a", "1");
  for (const Existing existing : {Existing::kRefuse, Existing::kResume, Existing::kReplace}) {
    EXPECT_NE(refusal(existing).find("another process is working on it"), std::string::npos);
  }
  journal.add("b", "2");
  EXPECT_EQ(journal.find("a"), "1") << "the others spoilt nothing";
}

TEST_F(StudyJournal, IsRemovedWhenEmptyOrDone) {
  { const Journal journal(file_, Existing::kRefuse); }
  EXPECT_FALSE(fs::exists(file_));
  {
    Journal journal(file_, Existing::kRefuse);
    journal.add("a", "1");
    journal.remove();
  }
  EXPECT_FALSE(fs::exists(file_));
}

TEST_F(StudyJournal, MakesTheFoldersOnTheWayAndTakesEmptyOnesWithIt) {
  const fs::path deep = directory_.path() / "x" / "y" / "out.part";
  { const Journal journal(deep, Existing::kRefuse); }
  EXPECT_FALSE(fs::exists(directory_.path() / "x"));
  {
    Journal journal(deep, Existing::kRefuse);
    journal.add("a", "1");
  }
  EXPECT_TRUE(fs::exists(deep));
  {
    Journal journal(directory_.path() / "z" / "out.part", Existing::kRefuse);
    std::ofstream(directory_.path() / "z" / "result") << "x";
  }
  EXPECT_TRUE(fs::exists(directory_.path() / "z" / "result"));
}

TEST_F(StudyJournal, IsBesideTheFolderOfResults) {
  EXPECT_EQ(journal_of_folder("out"), "out.part");
  EXPECT_EQ(journal_of_folder("a/./out/"), "a/out.part");
  EXPECT_EQ(journal_of_folder("/a/b/../out//"), "/a/out.part");
}

TEST_F(StudyJournal, GivesKeptWorkBackInsteadOfComputing) {
  int computed = 0;
  double result = 0.0;
  const auto work = [&](Journal* journal, const std::string& prefix) {
    result = 0.0;
    KeptWork(journal, prefix)
        .get(
            "piece",
            [&] {
              ++computed;
              result = 1.5;
            },
            [&](auto& words) { words(result); });
    EXPECT_EQ(result, 1.5);
  };
  Journal journal(file_, Existing::kRefuse);
  work(nullptr, "a");
  work(&journal, "a");
  EXPECT_EQ(computed, 2);
  work(&journal, "a");
  EXPECT_EQ(computed, 2);
  work(&journal, "b");
  EXPECT_EQ(computed, 3) << "another study's";
  journal.add("a/piece", "of another shape");
  work(&journal, "a");
  EXPECT_EQ(computed, 4);
}

// --- words ---------------------------------------------------------------------------------------------------

enum class Shape { kRound, kSquare, kFlat };

struct Fields {
  double number = 0.0;
  std::uint64_t count = 0;
  bool flag = false;
  Shape shape = Shape::kRound;
  std::vector<std::string> texts;
  std::vector<double> numbers;
  std::vector<double> none;
  friend bool operator==(const Fields&, const Fields&) = default;
};

template <class Words>
void fields(Words& words, Fields& f) {
  words(f.number, f.count, f.flag);
  words.choice(f.shape, 3);
  words(f.texts, f.numbers, f.none);
}

std::string a_record() {
  Fields all{0.1, std::uint64_t{1} << 63, true, Shape::kFlat, {"", "seven77", "eight888", "nine99999"}, {1, 2, 3}, {}};
  jobs::WordWriter writer;
  fields(writer, all);
  return writer.bytes();
}

TEST(Words, ReadBackAsTheyWereWritten) {
  const std::string bytes = a_record();
  Fields read;
  read.none = {7.0};
  jobs::WordReader reader(bytes);
  fields(reader, read);
  EXPECT_TRUE(reader.complete());
  EXPECT_EQ(
      read,
      (Fields{
          0.1, std::uint64_t{1} << 63, true, Shape::kFlat, {"", "seven77", "eight888", "nine99999"}, {1, 2, 3}, {}}));
}

TEST(Words, KeepEveryBitOfADouble) {
  double zero = -0.0, nan = std::numeric_limits<double>::quiet_NaN();
  jobs::WordWriter writer;
  writer(zero, nan);
  zero = nan = 1.0;
  jobs::WordReader reader(writer.bytes());
  reader(zero);
  EXPECT_FALSE(reader.complete()) << "a word is still there";
  reader(nan);
  EXPECT_TRUE(reader.complete());
  EXPECT_TRUE(zero == 0.0 && std::signbit(zero));
  EXPECT_TRUE(std::isnan(nan));
}

TEST(Words, CutAnywhereAreTornAndDoNoHarm) {
  const std::string whole = a_record();
  for (std::size_t cut = 0; cut <= whole.size(); ++cut) {
    jobs::WordReader reader(std::string_view(whole).substr(0, cut));
    Fields read;
    fields(reader, read);
    EXPECT_EQ(reader.complete(), cut == whole.size()) << cut;
  }
}

TEST(Words, ThatPromiseMoreThanThereIsAreTorn) {
  for (std::uint64_t count : {std::uint64_t{2}, ~std::uint64_t{0}, std::uint64_t{1} << 61}) {
    jobs::WordWriter writer;
    double one = 1.0;
    writer(count, one);
    std::vector<double> list;
    jobs::WordReader numbers(writer.bytes());
    numbers(list);
    EXPECT_TRUE(list.empty());
    EXPECT_TRUE(numbers.torn());
    if (count == 2) continue;
    std::string words = "before";
    jobs::WordReader text(writer.bytes());
    text(words);
    EXPECT_EQ(words, "");
    EXPECT_TRUE(text.torn());
  }
}

TEST(Words, OfAListOfAnotherLengthAreTorn) {
  for (const std::size_t length : {1U, 2U, 3U}) {
    std::vector<double> list(length, 0.5);
    jobs::WordWriter writer;
    writer.list_of(length, list);
    jobs::WordReader reader(writer.bytes());
    reader.list_of(2, list);
    EXPECT_EQ(reader.complete(), length == 2);
  }
}

TEST(Words, ThatAreNoEnumeratorAreTorn) {
  std::uint64_t three = 3;
  jobs::WordWriter writer;
  writer(three);
  Shape shape = Shape::kFlat;
  jobs::WordReader reader(writer.bytes());
  reader.choice(shape, 3);
  EXPECT_TRUE(reader.torn());
  EXPECT_EQ(shape, Shape::kRound);
}

// --- chapters ------------------------------------------------------------------------------------------------

page::Chapter a_chapter() {
  page::Chapter chapter{.name = "name", .title = "A title"};
  chapter.paragraphs = {"One.", "", "Three, with ε."};
  chapter.tables = {{"Numbers", {"of", "a"}, {{"x", "1"}, {"y", ""}}}};
  chapter.figures = {{"f1", "Figure", "caption", "plot 1\n", false}, {"f2", "Map", "<b>", "plot 2\n", true}};
  chapter.values = {{"name.csv", "what it holds", "# exactff\nx\n1\n"}};
  chapter.times = {{"times.csv", "seconds", "s\n"}, {"t2.csv", "", ""}};
  chapter.left_out = {{"the moon", "too far"}};
  return chapter;
}

TEST(ChapterBytes, ReadBackAsTheyWereWritten) {
  const page::Chapter chapter = a_chapter();
  const auto back = page::chapter_of(page::to_bytes(chapter));
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(back->name, "name");
  EXPECT_EQ(back->title, "A title");
  EXPECT_EQ(back->paragraphs, chapter.paragraphs);
  ASSERT_EQ(back->tables.size(), 1U);
  EXPECT_EQ(back->tables[0].title, "Numbers");
  EXPECT_EQ(back->tables[0].columns, chapter.tables[0].columns);
  EXPECT_EQ(back->tables[0].rows, chapter.tables[0].rows);
  ASSERT_EQ(back->figures.size(), 2U);
  EXPECT_EQ(back->figures[0].script, "plot 1\n");
  EXPECT_EQ(back->figures[1].id, "f2");
  EXPECT_EQ(back->figures[1].caption, "<b>");
  EXPECT_TRUE(back->figures[1].map && !back->figures[0].map);
  ASSERT_EQ(back->values.size(), 1U);
  EXPECT_EQ(back->values[0].csv, "# exactff\nx\n1\n");
  ASSERT_EQ(back->times.size(), 2U);
  EXPECT_EQ(back->times[0].holds, "seconds");
  ASSERT_EQ(back->left_out.size(), 1U);
  EXPECT_EQ(back->left_out[0].why, "too far");
  EXPECT_EQ(page::to_bytes(*back), page::to_bytes(chapter));
}

TEST(ChapterBytes, CutAnywhereOrTooLongAreNone) {
  const std::string whole = page::to_bytes(a_chapter());
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    EXPECT_FALSE(page::chapter_of(std::string_view(whole).substr(0, cut)).has_value()) << cut;
  }
  EXPECT_FALSE(page::chapter_of(whole + '\0').has_value());
}

// --- studies -------------------------------------------------------------------------------------------------

TEST(ResumedStudy, HasTheSameValuesWhereverTheJournalWasCut) {
  const validation::TemporaryDirectory directory;
  const fs::path file = directory.path() / "out.part", cut_file = directory.path() / "cut.part";
  const Scene scene = small_room(true);
  Request request = request_with_methods(scene, 2);
  validation::scatter(request);
  request.methods.ladders = {parse_ladder("hemicube:resolution=8|16"), parse_ladder("area-sampling:samples=1|4|16")};
  request.methods.seeds = 2;
  std::size_t pieces = 0;
  const Study whole = [&] {
    Journal journal(file, Existing::kRefuse);
    Study study = run(request, {}, &journal);
    pieces = journal.size();
    return study;
  }();
  EXPECT_EQ(pieces, 20U + 20U + whole.methods.cells.size());  // exact, everywhere, cells
  EXPECT_GT(whole.methods.cells.size(), 5U) << "the settings of the sweeps, too";
  const std::string bytes = validation::text_of(file);
  for (std::size_t part = 0; part <= 12; ++part) {
    const std::size_t cut = bytes.size() * part / 12;
    std::ofstream(cut_file, std::ios::binary) << bytes.substr(0, cut);
    Journal journal(cut_file, Existing::kResume);
    EXPECT_EQ(journal.size() == pieces, part == 12);
    const Study resumed = run(request, {}, &journal);
    EXPECT_EQ(journal.size(), pieces);
    expect_same_values(whole, resumed, " cut at " + std::to_string(cut));
    journal.remove();
  }
}

// Values from a journal can be distinguished from computed ones.
TEST(ResumedStudy, TakesWhatTheJournalHas) {
  const validation::TemporaryDirectory directory;
  const fs::path file = directory.path() / "out.part";
  const Scene scene = small_room(true);
  Request request = small_request(scene, 1);
  validation::scatter(request);
  std::size_t asked = 0, finished = 0;
  const Hooks until_some{{}, [&] { return ++asked > 150; }};
  {
    Journal journal(file, Existing::kRefuse);
    EXPECT_THROW((void)run(request, until_some, &journal), Cancelled);
    finished = journal.size();
    EXPECT_GT(finished, 10U);
    EXPECT_LT(finished, 40U);
  }
  Journal journal(file, Existing::kResume);
  EXPECT_EQ(journal.size(), finished);
  const std::string before = validation::text_of(file);
  const Study resumed = run(request, {}, &journal);
  expect_same_values(run(request), resumed, "");
  EXPECT_EQ(journal.size(), 40U + resumed.methods.cells.size());
  EXPECT_TRUE(validation::text_of(file).starts_with(before)) << "what was there is not computed again";
}

TEST(ResumedStudy, OfAnotherRequestTakesNothing) {
  const validation::TemporaryDirectory directory;
  const Scene room = small_room(true), other = small_room(false);
  Journal journal(directory.path() / "out.part", Existing::kRefuse);
  Request request = small_request(room, 1);
  validation::scatter(request);
  (void)run(request, {}, &journal);
  const std::size_t before = journal.size();
  Request elsewhere = small_request(other, 1);
  validation::scatter(elsewhere);
  const Study other_study = run(elsewhere, {}, &journal);
  expect_same_values(run(elsewhere), other_study, "");
  EXPECT_EQ(journal.size(), before + 20 + 20 + other_study.methods.cells.size());
  const std::size_t both = journal.size();
  Request swept = request;
  swept.sweeps.rays = {2};
  const Study swept_study = run(swept, {}, &journal);
  expect_same_values(run(swept), swept_study, "");
  EXPECT_GT(journal.size(), both + 20) << "exact values are the same, samples and settings are not";
  EXPECT_LT(journal.size(), both + 20 + swept_study.methods.cells.size()) << "the exact method is the same";
}

}  // namespace
}  // namespace exactff::study
