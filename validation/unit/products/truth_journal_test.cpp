// The journals of truth files: interrupted runs, journals torn, tampered with or of other requests, shards.
#include <atomic>

#include "exactff/version.h"
#include "jobs/compute.h"
#include "jobs/journal.h"
#include "support/test.h"
#include "truth/rows.h"
#include "unit/products/truth_support.h"

namespace exactff::truth {
namespace {

namespace fs = std::filesystem;
using namespace jobs;

// Blocks of few rows, not in order, so that a few bytes can be damaged in many ways.
std::string small_journal(const Rows& rows, const fs::path& file) {
  RowJournal journal(file, rows, Existing::kReplace, {});
  Rows::Results results;
  for (const Range range : {Range{5, 2}, Range{0, 1}, Range{3, 2}, Range{1, 1}}) {
    std::string lines;
    for (std::uint64_t row = range.first; row < range.end(); ++row) append(rows, row, lines, results);
    journal.append(range, lines);
  }
  return text_of(journal.path());
}

TEST_F(Truth, AJournalTornAnywhereGoesOn) {
  write(request(2), file_);
  const std::string whole = text_of(file_);
  const std::string journal = small_journal(Rows(request(2)), file_);
  std::uint64_t most = 0;
  for (std::size_t length = 0; length < journal.size() + 3; length += 3) {
    fs::remove(file_);
    write_text(journal_, journal.substr(0, length));
    const Summary summary = write(request(2), file_, Existing::kResume);
    ASSERT_EQ(text_of(file_), whole) << "torn after " << length << " bytes";
    ASSERT_GE(summary.resumed, most) << "a longer journal gave less";
    most = summary.resumed;
  }
  EXPECT_EQ(most, 6U);
  expect_only({"truth.csv"});
}

TEST_F(Truth, ADamagedBlockIsComputedAgainAndTheOthersAreNot) {
  write(request(2), file_);
  const std::string whole = text_of(file_);
  const std::string journal = small_journal(Rows(request(2)), file_);
  const std::size_t first = journal.find("# rows 5+2, ");
  for (std::size_t at = first; at < journal.size(); at += 3) {
    std::string damaged = journal;
    damaged[at] = damaged[at] == '7' ? '8' : '7';
    fs::remove(file_);
    write_text(journal_, damaged);
    std::string note;
    RowHooks hooks;
    hooks.note = [&](const std::string& text) { note = text; };
    const Summary summary = write(request(2), file_, Existing::kResume, hooks);
    ASSERT_EQ(text_of(file_), whole) << "damaged at " << at;
    ASSERT_TRUE(summary.resumed == 4 || summary.resumed == 5) << "damaged at " << at << ": " << summary.resumed;
    ASSERT_NE(note.find("incomplete or damaged; what they held is computed again"), std::string::npos) << note;
  }
}

TEST_F(Truth, NobodysWorkIsDestroyed) {
  write(request(2), file_);
  EXPECT_HOLDS(refusal(request(2), Existing::kRefuse), "truth.csv: already exists (it may hold hours of work); ");
  EXPECT_EQ(refusal(request(2), Existing::kReplace), "");
  fs::remove(file_);
  interrupt(request(10), 100);
  EXPECT_HOLDS(refusal(request(10), Existing::kRefuse),
               "truth.csv.part: contains the finished work of an interrupted run");
  EXPECT_EQ(refusal(request(10), Existing::kReplace), "");
  expect_only({"truth.csv"});
}

TEST_F(Truth, ACompleteFileIsLeftAsItIs) {
  const Summary first = write(request(3), file_);
  const auto written = fs::last_write_time(file_);
  const Summary again = write(request(3), file_, Existing::kResume);
  EXPECT_EQ(fs::last_write_time(file_), written);
  EXPECT_EQ(again.resumed, first.rows);
  EXPECT_EQ(again.rows_by_status, first.rows_by_status);
  EXPECT_HOLDS(refusal(request(4), Existing::kResume), "truth.csv:1: belongs to a different request");
  write_text(file_, text_of(file_).substr(0, fs::file_size(file_) - 5));
  EXPECT_HOLDS(refusal(request(3), Existing::kResume), "truth.csv: is damaged: 17 of 18 rows can be read");
}

TEST_F(Truth, AForeignFileIsNoJournal) {
  for (const char* text : {"dear diary\n", "\n"}) {
    for (const Existing existing : {Existing::kRefuse, Existing::kResume, Existing::kReplace}) {
      write_text(journal_, text);
      EXPECT_HOLDS(refusal(request(2), existing), "truth.csv.part: already exists, and exactff did not write it");
      EXPECT_EQ(text_of(journal_), text);
    }
  }
  write_text(journal_, "#");  // may be the beginning of our journal
  EXPECT_EQ(refusal(request(2), Existing::kResume), "");
}

// The request of a journal, changed in every way that affects its rows.
TEST_F(Truth, AJournalOfAnotherRequestIsNamedWithItsDifference) {
  Scene other = scene_.with_flipped(scene_.select("board"));
  const std::pair<std::string, std::function<void(Request&)>> table[] = {
      {"it has scene hash ",
       [&](Request& r) {
         r.scene = &other;
         r.sources = {other.select("light"), other.select("lamp")};
       }},
      {"this request has scene hall.obj", [](Request& r) { r.scene_name = "hall.obj"; }},
      {"this request has receivers hash ", [](Request& r) { r.receivers[0].point.x += 0.5; }},
      {"this request has receivers other", [](Request& r) { r.receivers_name = "other"; }},
      {"this request has sources lamp and light", [](Request& r) { std::swap(r.sources[0], r.sources[1]); }},
      {"it has column radiosity_r, and this request has column unoccluded", [](Request& r) { r.unoccluded = true; }},
      {"it has column radiosity_r, and this request has column visible_fraction",
       [](Request& r) { r.visible_fraction = true; }},
      {"it has shards 1, and this request has shards 2", [](Request& r) { r.shard.count = 2; }},
  };
  interrupt(request(10), 100);
  const std::string journal = text_of(journal_);
  for (const auto& [message, change] : table) {
    Request changed = request(10);
    change(changed);
    const std::string told = refusal(changed, Existing::kResume);
    EXPECT_HOLDS(told, message);
    EXPECT_HOLDS(told, "rows of different requests must not be mixed");
    EXPECT_EQ(text_of(journal_), journal);
  }
  std::string old_version = journal;
  old_version.replace(old_version.find(kVersion), std::string(kVersion).size(), "0.0.9");
  write_text(journal_, old_version);
  EXPECT_HOLDS(refusal(request(10), Existing::kResume), "was written by another version");
}

TEST_F(Truth, TwoProcessesCannotShareAJournal) {
  const RowJournal journal(file_, Rows(request(2)), Existing::kRefuse, {});
  for (const Existing existing : {Existing::kRefuse, Existing::kResume, Existing::kReplace}) {
    EXPECT_HOLDS(refusal(request(2), existing), "truth.csv.part: another process is working on it");
  }
}

TEST_F(Truth, WhatCannotBeAFileIsRefused) {
  for (const fs::path& path : {directory_.path(), directory_.path() / "missing" / "a.csv", fs::path("/dev/null"),
                               directory_.path() / "folder/", fs::path()}) {
    EXPECT_NE(complaint([&] { write(request(1), path); }), "") << path;
  }
  expect_only({});
}

TEST_F(Truth, TheFileGoesWhereALinkLeads) {
  fs::create_symlink("target.csv", file_);
  write(request(1), file_, Existing::kRefuse);
  EXPECT_TRUE(fs::is_symlink(file_));
  EXPECT_GT(fs::file_size(directory_.path() / "target.csv"), 100U);
}

TEST_F(Truth, ARunThatFinishedNoRowLeavesNothing) {
  interrupt(request(2), 0);
  expect_only({});
}

// --- The shards of a truth file: which rows belong to each, and merging them ---

class TruthShards : public Truth {
 protected:
  fs::path part(std::uint64_t number) const { return directory_.path() / ("truth." + std::to_string(number) + ".csv"); }
  std::vector<fs::path> write_shards(int n, std::uint64_t count) const {
    std::vector<fs::path> parts;
    for (std::uint64_t number = 1; number <= count; ++number) {
      parts.push_back(part(number));
      write(shard(n, number, count), parts.back(), Existing::kReplace);
    }
    return parts;
  }
  std::string merge_refusal(const std::vector<fs::path>& parts) const {
    return complaint([&] { truth::merge(parts, directory_.path() / "merged.csv"); });
  }
};

TEST_F(TruthShards, MergedAreTheBytesOfOneRun) {
  const Summary one = write(request(10), file_);
  for (const std::uint64_t count : {2U, 3U, 4U, 7U}) {  // of 4 chunks, so that some shards have none
    std::vector<fs::path> parts = write_shards(10, count);
    std::reverse(parts.begin(), parts.end());
    const fs::path merged = directory_.path() / "merged.csv";
    const Summary summary = truth::merge(parts, merged, Existing::kReplace);
    EXPECT_EQ(text_of(merged), text_of(file_));
    EXPECT_EQ(summary.rows_by_status, one.rows_by_status);
  }
}

TEST_F(TruthShards, WhatDoesNotBelongTogetherIsRefused) {
  const std::vector<fs::path> parts = write_shards(10, 3);
  const auto expect = [&](const std::vector<fs::path>& named, const std::string& message) {
    const std::string told = merge_refusal(named);
    EXPECT_HOLDS(told, message);
    EXPECT_FALSE(fs::exists(directory_.path() / "merged.csv"));
  };
  expect({parts[0], parts[2]}, "of 3 shards these are missing: 2 (every row is needed)");
  expect({parts[0]}, "these are missing: 2 and 3");
  expect({}, "no shard is named");
  expect({parts[0], parts[1], parts[2], parts[1]}, "is shard 2, and so is ");
  expect({parts[0], directory_.path() / "nothing"}, "nothing: cannot be read: No such file");
  write(request(10), file_);
  expect({parts[0], parts[1], file_}, "truth.csv: is not a shard of a table");
  write(shard(10, 3, 4), file_, Existing::kReplace);
  expect({parts[0], parts[1], file_}, "is one of 4 shards");
  write(shard(9, 3, 3), file_, Existing::kReplace);
  expect({parts[0], parts[1], file_}, "truth.csv:1: belongs to a different request: it has receivers hash ");
}

TEST_F(TruthShards, DamageIsFoundWhereverItIs) {
  const std::vector<fs::path> parts = write_shards(10, 2);
  const std::string sound = text_of(parts[0]);
  const std::size_t rows = sound.find("\n# rows 0+64") + 1;
  for (std::size_t at = rows; at < sound.size(); at += 97) {
    std::string damaged = sound;
    damaged[at] ^= 1;
    write_text(parts[0], damaged);
    EXPECT_HOLDS(merge_refusal(parts), "truth.1.csv: is damaged: ") << at;
    write_text(parts[0], sound.substr(0, at));
    EXPECT_HOLDS(merge_refusal(parts), "truth.1.csv: is damaged: ") << at;
  }
  write_text(parts[0], sound + "more");
  EXPECT_HOLDS(merge_refusal(parts), "is damaged: ");
}

TEST_F(TruthShards, InterruptionsDoNotShow) {
  const std::vector<fs::path> parts = write_shards(10, 2);
  for (const int rows : {30, 3, 50}) {
    std::atomic<int> left = rows;
    RowHooks hooks;
    hooks.cancelled = [&left] { return left-- <= 0; };
    EXPECT_THROW(write(shard(10, 1, 2), file_, Existing::kResume, hooks), Cancelled);
  }
  EXPECT_HOLDS(merge_refusal({journal_, parts[1]}), "is the journal of an unfinished run");
  write(shard(10, 1, 2), file_, Existing::kResume);
  EXPECT_EQ(text_of(file_), text_of(parts[0]));
  const Summary again = write(shard(10, 1, 2), file_, Existing::kResume);
  EXPECT_EQ(again.resumed, again.rows);
}

TEST_F(Truth, BlocksThatDoNotBelongAreLeftOut) {
  const Rows rows(shard(10, 2, 3));
  std::string line;
  Rows::Results results;
  append(rows, 64, line, results);
  write_text(file_, "");
  {
    RowJournal journal(file_, rows, Existing::kResume, {});
    journal.append({64, 1}, line);
    journal.append({64, 1}, line);          // doubled: counts once
    journal.append({0, 1}, line);           // of another shard
    journal.append({127, 2}, line + line);  // of two chunks
    journal.append({66, 2}, line);          // fewer rows than it claims
    journal.append({65, 0}, "");
    journal.append({1000000, 1}, line);
  }
  std::string note;
  RowHooks hooks;
  hooks.note = [&](const std::string& text) { note = text; };
  EXPECT_EQ(write(shard(10, 2, 3), file_, Existing::kResume, hooks).resumed, 1U);
  EXPECT_HOLDS(note, "5 blocks cannot be used here");
  const std::string resumed = text_of(file_);
  write(shard(10, 2, 3), file_, Existing::kReplace);
  EXPECT_EQ(text_of(file_), resumed);
}

}  // namespace
}  // namespace exactff::truth
