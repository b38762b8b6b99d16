// Finished work in a file: added records are read back, and torn, damaged or foreign files do no harm.
#include "jobs/kept_work.h"
#include "report/report.h"
#include "support/test.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

namespace fs = std::filesystem;
using jobs::Existing;
using jobs::Journal;

class StudyJournal : public ::testing::Test {
 protected:
  // Three pieces of work, the second of them with line ends and zeros.
  std::string written() const {
    Journal journal(file_, Existing::kRefuse);
    for (const auto& [name, bytes] : pieces_) journal.add(name, bytes);
    return text_of(file_);
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

  const TemporaryDirectory directory_;
  const fs::path file_ = directory_.path() / "out.part";
  const std::vector<std::pair<std::string, std::string>> pieces_ = {
      {"a/0", "first"}, {"b", std::string("x\n\0# work y, 1 bytes, crc 00000000\n", 35)}, {"c-1", std::string()}};
};

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
    EXPECT_EQ(text_of(file_), whole) << "cut at " << cut;
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

TEST(ResumedStudy, HasTheSameValuesWhereverTheJournalWasCut) {
  const TemporaryDirectory directory;
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
  const std::string bytes = text_of(file);
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
  const TemporaryDirectory directory;
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
  const std::string before = text_of(file);
  const Study resumed = run(request, {}, &journal);
  expect_same_values(run(request), resumed, "");
  EXPECT_EQ(journal.size(), 40U + resumed.methods.cells.size());
  EXPECT_TRUE(text_of(file).starts_with(before)) << "what was there is not computed again";
}

TEST(ResumedStudy, OfAnotherRequestTakesNothing) {
  const TemporaryDirectory directory;
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
