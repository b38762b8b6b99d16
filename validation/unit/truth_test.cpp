// Truth files: rows, journals torn and tampered with, shards, several processes.
#include "exactff/truth.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <limits>
#include <mutex>
#include <set>
#include <sstream>
#include <thread>

#include "exactff/obj.h"
#include "exactff/team.h"
#include "exactff/version.h"
#include "exactff/view.h"
#include "jobs/blocks.h"
#include "jobs/journal.h"
#include "jobs/workers.h"
#include "support/program.h"
#include "support/thread_team.h"
#include "truth/rows.h"

namespace exactff::truth {
namespace {

namespace fs = std::filesystem;
using namespace jobs;
using validation::Mailbox;
using validation::text_of;
using validation::ThreadTeam;

// A floor, two lights above it, and a board that hides the first from part of the floor.
Scene room() {
  std::istringstream obj(
      "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 3\nv 1 0 3\nv 1 1 3\nv 0 1 3\nv 3 3 3\nv 4 3 3\nv 4 4 3\nv 3 4 3\n"
      "v 0 0 1\nv 1 0 1\nv 1 2 1\nv 0 2 1\n"
      "g floor\nf 1 2 3 4\ng light\nf 8 7 6 5\ng lamp\nf 12 11 10 9\ng board\nf 13 14 15 16\n");
  return read_obj(obj, "room.obj");
}

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted) {
      fields.emplace_back();
    } else if (c != '"') {
      fields.back() += c;
    }
  }
  return fields;
}

class Truth : public testing::Test {
 protected:
  // 2 x n x n rows.
  Request request(int n) const {
    Request all;
    all.scene = &scene_;
    all.scene_name = "room.obj";
    all.receivers = grid_receivers(scene_, scene_.select("floor"), {n, n});
    all.receivers_name = "floor, grid";
    all.sources = {scene_.select("light"), scene_.select("lamp")};
    all.threads = 1;
    return all;
  }
  Request shard(int n, std::uint64_t number, std::uint64_t count) const {
    Request part = request(n);
    part.shard = {number, count};
    return part;
  }

  // A row asks `cancelled` about this often: before it, and in the loops of its value.
  static constexpr int kQuestions = 4;

  // Ends the run after about `rows` rows.
  void interrupt(Request asked, int rows) const {
    std::atomic<int> left = rows * kQuestions;
    Hooks hooks;
    hooks.cancelled = [&left] { return left-- <= 0; };
    EXPECT_THROW(write(std::move(asked), file_, Existing::kResume, hooks), Cancelled);
  }

  // The error message as the user reads it; empty if there is none.
  static std::string message_of(const std::function<void()>& act) {
    try {
      act();
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  }
  std::string refusal(Request asked, Existing existing) const {
    return message_of([&] { write(std::move(asked), file_, existing); });
  }

  std::uint64_t rows_in_journal(Request asked) const {
    const Rows rows(std::move(asked));
    const RowJournal journal(file_, rows, Existing::kResume, {});
    return rows.shard_rows() - Schedule(rows, journal.blocks()).rows();
  }
  void expect_only(std::set<std::string> names) const {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(directory_.path())) found.insert(entry.path().filename());
    EXPECT_EQ(found, names);
  }

  const Scene scene_ = room();
  const validation::TemporaryDirectory directory_{validation::memory_folder()};
  const fs::path file_ = directory_.path() / "truth.csv";
  const fs::path journal_ = journal_of(file_);
};

// --- rows ------------------------------------------------------------------------------------------------------------

TEST_F(Truth, TheHeadTellsWhatTheBytesDependOn) {
  Request asked = request(2);
  asked.unoccluded = asked.visible_fraction = true;
  asked.receivers_name = "a\nb";
  const std::string head = Rows(asked).head();
  EXPECT_TRUE(head.starts_with(std::string("# exactff ") + kVersion + " truth: "));
  EXPECT_NE(head.find("\n# scene: room.obj, hash " + scene_.hash() + "\n# receivers: a b, hash "), std::string::npos);
  EXPECT_NE(head.find("\n# sources: light + lamp\n# rows: 8\n# units: "), std::string::npos);
  EXPECT_TRUE(
      head.ends_with("\nreceiver,on,x,y,z,nx,ny,nz,source,exact,lower,upper,unoccluded,visible_fraction,"
                     "radiosity_r,radiosity_g,radiosity_b,largest_rho_b,status\n"));
  EXPECT_EQ(head.find("shard"), std::string::npos);
}

TEST_F(Truth, TheHeadKnowsOneSetOfReceiversFromAnother) {
  const std::string head = Rows(request(2)).head();
  const std::function<void(Receiver&)> changes[] = {
      [](Receiver& r) { r.point.x = std::nextafter(r.point.x, 9.0); },
      [](Receiver& r) { r.normal.z = -r.normal.z; },
      [](Receiver& r) { r.on.clear(); },
      [](Receiver& r) { r.id += 'a'; },
  };
  for (const auto& change : changes) {
    Request other = request(2);
    change(other.receivers[1]);
    EXPECT_NE(Rows(other).head(), head);
  }
}

TEST_F(Truth, EveryRowIsTheExactValueOfItsReceiverAndSource) {
  Request asked = request(3);
  asked.unoccluded = asked.visible_fraction = true;
  asked.receivers[4].id.clear();
  asked.receivers[5].on.clear();
  const Rows rows(asked);
  const std::vector<FaceId> none;
  int hidden = 0;
  Rows::Results results;
  for (std::uint64_t row = 0; row < rows.count(); ++row) {
    std::string line;
    rows.append(row, line, results);
    ASSERT_EQ(line.back(), '\n');
    line.pop_back();
    const std::vector<std::string> fields = fields_of(line);
    ASSERT_EQ(fields.size(), 19U) << line;
    const Receiver& receiver = asked.receivers[row / 2];
    const ExactSource source(scene_, asked.sources[row % 2]);
    const FormFactor f = exact_form_factor(scene_, receiver, source, {.visible_fraction = true});
    const FormFactor free = exact_form_factor(scene_, receiver, source, {.only_occluders = &none});
    if (f.value < free.value) ++hidden;
    EXPECT_EQ(fields[0], row / 2 == 4 ? "5" : receiver.id);
    EXPECT_EQ(fields[1], row / 2 == 5 ? "" : "floor");
    EXPECT_EQ(std::stod(fields[2]), receiver.point.x);
    EXPECT_EQ(std::stod(fields[7]), receiver.normal.z);
    EXPECT_EQ(fields[8], row % 2 == 0 ? "light" : "lamp");
    EXPECT_EQ(std::stod(fields[9]), f.value);
    EXPECT_EQ(std::stod(fields[10]), f.lower);
    EXPECT_EQ(std::stod(fields[11]), f.upper);
    EXPECT_EQ(std::stod(fields[12]), free.value);
    EXPECT_EQ(std::stod(fields[13]), f.visible_fraction);
    EXPECT_EQ(std::stod(fields[14]), f.value);  // rho and B are 1
    EXPECT_EQ(std::stod(fields[17]), 1.0);
    EXPECT_EQ(fields[18], to_string(f.status));
  }
  EXPECT_GT(hidden, 0);
}

TEST_F(Truth, TheTallyReadsTheLastFieldOfEveryRow) {
  const std::string text = "\"a\n,zero\n\"\"\",1,certified\nb,2,zero\n\"c,\",3,not certified\nd,4,underflow\n";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Tally tally;
    tally.add(text.substr(0, cut));
    tally.add(text.substr(cut));
    EXPECT_TRUE(tally.whole());
    EXPECT_EQ(tally.by_status(), (std::array<std::uint64_t, 4>{1, 1, 1, 1}));
  }
  for (const char* broken : {"a,certified", "a,certifie\n", "\"a,certified\n", "certified\na,1,"}) {
    Tally tally;
    tally.add(broken);
    EXPECT_FALSE(tally.whole()) << broken;
  }
}

TEST_F(Truth, SenselessRequestsAreRefused) {
  Request none = request(1);
  none.receivers.clear();
  EXPECT_NE(refusal(none, Existing::kRefuse).find("there are no receivers in floor, grid"), std::string::npos);
  Request dark = request(1);
  dark.sources.clear();  // no source emits here
  EXPECT_NE(refusal(dark, Existing::kRefuse).find("no patch emits"), std::string::npos);
  EXPECT_NE(refusal(shard(1, 5, 4), Existing::kRefuse).find("there is no shard 5 of 4"), std::string::npos);
  EXPECT_NE(refusal(shard(1, 0, 4), Existing::kRefuse).find("there is no shard 0 of 4"), std::string::npos);
  expect_only({});
}

// --- schedule --------------------------------------------------------------------------------------------------------

TEST_F(Truth, TheScheduleDealsOutWhatIsNotDone) {
  const Rows rows(request(10));  // 200 rows, the last chunk of 8
  const std::vector<Block> done = {{{0, 3}, 0, 0}, {{10, 54}, 0, 0}, {{130, 62}, 0, 0}, {{192, 8}, 0, 0}};
  Schedule schedule(rows, done);
  EXPECT_EQ(schedule.rows(), 73U);
  EXPECT_EQ(schedule.next(), (Range{3, 7}));
  EXPECT_EQ(schedule.next(), (Range{64, 64}));
  EXPECT_EQ(schedule.next(), (Range{128, 2}));
  EXPECT_EQ(schedule.next(), std::nullopt);
}

TEST_F(Truth, ShardsShareTheRowsAmongThem) {
  for (const std::uint64_t count : {1U, 2U, 3U, 4U, 5U, 9U}) {
    std::set<std::uint64_t> seen;
    for (std::uint64_t number = 1; number <= count; ++number) {
      const Rows rows(shard(10, number, count));
      Schedule schedule(rows, {});
      std::uint64_t dealt = 0;
      while (const std::optional<Range> range = schedule.next()) {
        EXPECT_TRUE(rows.may_be_one_block(*range));
        for (std::uint64_t row = range->first; row < range->end(); ++row) EXPECT_TRUE(seen.insert(row).second);
        dealt += range->rows;
      }
      EXPECT_EQ(dealt, rows.shard_rows());
    }
    EXPECT_EQ(seen.size(), 200U);
  }
}

// --- journals --------------------------------------------------------------------------------------------------------

TEST_F(Truth, BytesDoNotDependOnThreads) {
  const Summary one = write(request(10), file_);
  const std::string whole = text_of(file_);
  Request asked = request(10);
  asked.threads = 3;
  const Summary three = write(asked, file_, Existing::kReplace);
  EXPECT_EQ(text_of(file_), whole);
  EXPECT_EQ(one.rows, 200U);
  EXPECT_EQ(one.rows_by_status, three.rows_by_status);
  EXPECT_EQ(one.with(Status::kCertified) + one.with(Status::kZero), 200U);
  EXPECT_GT(one.with(Status::kZero), 0U);
  expect_only({"truth.csv"});
}

TEST_F(Truth, AnInterruptedRunGoesOn) {
  write(request(10), file_);
  const std::string whole = text_of(file_);
  fs::remove(file_);
  for (const int rows : {1, 2, 40, 100, 1, 30}) interrupt(request(10), rows);
  expect_only({"truth.csv.part"});
  EXPECT_GE(rows_in_journal(request(10)), 120U);
  const Summary summary = write(request(10), file_, Existing::kResume);
  EXPECT_EQ(text_of(file_), whole);
  EXPECT_GT(summary.resumed, 110U);
  EXPECT_LT(summary.resumed, 200U);
  expect_only({"truth.csv"});
}

TEST_F(Truth, ARunThatFinishedNoRowLeavesNothing) {
  interrupt(request(2), 0);
  expect_only({});
}

// Blocks of few rows, not in order, so that a few bytes can be damaged in many ways.
std::string small_journal(const Rows& rows, const fs::path& file) {
  RowJournal journal(file, rows, Existing::kReplace, {});
  Rows::Results results;
  for (const Range range : {Range{5, 2}, Range{0, 1}, Range{3, 2}, Range{1, 1}}) {
    std::string lines;
    for (std::uint64_t row = range.first; row < range.end(); ++row) rows.append(row, lines, results);
    journal.append(range, lines);
  }
  return text_of(journal.path());
}

TEST_F(Truth, AJournalTornAnywhereGoesOn) {
  write(request(2), file_);
  const std::string whole = text_of(file_);
  const std::string journal = small_journal(Rows(request(2)), file_);
  std::uint64_t most = 0;
  for (std::size_t length = 0; length <= journal.size(); ++length) {
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
    Hooks hooks;
    hooks.note = [&](const std::string& text) { note = text; };
    const Summary summary = write(request(2), file_, Existing::kResume, hooks);
    ASSERT_EQ(text_of(file_), whole) << "damaged at " << at;
    ASSERT_TRUE(summary.resumed == 4 || summary.resumed == 5) << "damaged at " << at << ": " << summary.resumed;
    ASSERT_NE(note.find("incomplete or damaged; their rows are computed again"), std::string::npos) << note;
  }
}

TEST_F(Truth, BlocksThatDoNotBelongAreLeftOut) {
  const Rows rows(shard(10, 2, 3));
  std::string line;
  Rows::Results results;
  rows.append(64, line, results);
  write_text(file_, "");
  {
    RowJournal journal(file_, rows, Existing::kResume, {});
    journal.append({64, 1}, line);
    journal.append({64, 1}, line);          // doubled
    journal.append({0, 1}, line);           // of another shard
    journal.append({127, 2}, line + line);  // of two chunks
    journal.append({66, 2}, line);          // fewer rows than it claims
    journal.append({65, 0}, "");
    journal.append({1000000, 1}, line);
  }
  std::string note;
  Hooks hooks;
  hooks.note = [&](const std::string& text) { note = text; };
  EXPECT_EQ(write(shard(10, 2, 3), file_, Existing::kResume, hooks).resumed, 1U);
  EXPECT_NE(note.find("6 blocks cannot be used here"), std::string::npos) << note;
  const std::string resumed = text_of(file_);
  write(shard(10, 2, 3), file_, Existing::kReplace);
  EXPECT_EQ(text_of(file_), resumed);
}

TEST_F(Truth, NobodysWorkIsDestroyed) {
  write(request(2), file_);
  EXPECT_NE(refusal(request(2), Existing::kRefuse).find("truth.csv: already exists (it may hold hours of work); "),
            std::string::npos);
  EXPECT_EQ(refusal(request(2), Existing::kReplace), "");
  fs::remove(file_);
  interrupt(request(10), 100);
  EXPECT_NE(
      refusal(request(10), Existing::kRefuse).find("truth.csv.part: contains the finished rows of an interrupted run"),
      std::string::npos);
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
  EXPECT_NE(refusal(request(4), Existing::kResume).find("truth.csv:3: belongs to a different request"),
            std::string::npos);
  write_text(file_, text_of(file_).substr(0, fs::file_size(file_) - 5));
  EXPECT_NE(refusal(request(3), Existing::kResume).find("truth.csv: is damaged: 17 of 18 rows can be read"),
            std::string::npos)
      << refusal(request(3), Existing::kResume);
}

TEST_F(Truth, AFileWithTheOldNamesOfCellsIsRefusedByName) {
  Request old = request(3);
  for (Receiver& receiver : old.receivers) {
    receiver.id = std::to_string(receiver.cell->column) + ',' + std::to_string(receiver.cell->row);
  }
  (void)write(old, file_);
  EXPECT_NE(refusal(request(3), Existing::kResume)
                .find("the file may be of an older version, which named the cell r7c12 of a grid '12,7'; such a file "
                      "cannot be continued or merged"),
            std::string::npos)
      << refusal(request(3), Existing::kResume);
}

TEST_F(Truth, AForeignFileIsNoJournal) {
  for (const char* text : {"dear diary\n", "# exactff 0.0.1 truth\nreceiver\n", "\n", "#"}) {
    write_text(journal_, text);
    if (std::string(text) == "#") continue;  // may be the beginning of our journal
    EXPECT_NE(
        refusal(request(2), Existing::kResume).find("truth.csv.part:1: belongs to a different request: it says '"),
        std::string::npos);
    EXPECT_EQ(text_of(journal_), text);
  }
}

// The request of a journal, changed in every way that affects its rows.
TEST_F(Truth, AJournalOfAnotherRequestIsNamedWithItsDifference) {
  Scene other = scene_.with_flipped(scene_.select("board"));
  const std::pair<std::string, std::function<void(Request&)>> table[] = {
      {"'# scene: room.obj, hash ",
       [&](Request& r) {
         r.scene = &other;
         r.sources = {other.select("light"), other.select("lamp")};
       }},
      {"this request says '# scene: hall.obj, ", [](Request& r) { r.scene_name = "hall.obj"; }},
      {"this request says '# receivers: floor, grid, hash ", [](Request& r) { r.receivers[0].point.x += 0.5; }},
      {"this request says '# receivers: other, hash ", [](Request& r) { r.receivers_name = "other"; }},
      {"this request says '# sources: lamp + light'", [](Request& r) { std::swap(r.sources[0], r.sources[1]); }},
      {"this request says 'receiver,on,x,y,z,nx,ny,nz,source,exact,lower,upper,unoccluded,",
       [](Request& r) { r.unoccluded = true; }},
      {"this request says 'receiver,on,x,y,z,nx,ny,nz,source,exact,lower,upper,visible_fraction,",
       [](Request& r) { r.visible_fraction = true; }},
      {"this request says '# shard: 1/2 in chunks of 64 rows, for exactff merge'",
       [](Request& r) { r.shard.count = 2; }},
  };
  interrupt(request(10), 100);
  const std::string journal = text_of(journal_);
  for (const auto& [message, change] : table) {
    Request changed = request(10);
    change(changed);
    const std::string told = refusal(changed, Existing::kResume);
    EXPECT_NE(told.find(message), std::string::npos) << told;
    EXPECT_NE(told.find("rows of different requests must not be mixed"), std::string::npos) << told;
    EXPECT_EQ(text_of(journal_), journal);
  }
  std::string old_version = journal;
  old_version.replace(old_version.find(kVersion), std::string(kVersion).size(), "0.0.9");
  write_text(journal_, old_version);
  EXPECT_NE(refusal(request(10), Existing::kResume).find("it says '# exactff 0.0.9 truth"), std::string::npos);
}

TEST_F(Truth, TwoProcessesCannotShareAJournal) {
  const RowJournal journal(file_, Rows(request(2)), Existing::kRefuse, {});
  for (const Existing existing : {Existing::kRefuse, Existing::kResume, Existing::kReplace}) {
    EXPECT_NE(refusal(request(2), existing).find("truth.csv.part: another process is working on it"),
              std::string::npos);
  }
}

TEST_F(Truth, WhatCannotBeAFileIsRefused) {
  for (const fs::path& path : {directory_.path(), directory_.path() / "missing" / "a.csv", fs::path("/dev/null"),
                               directory_.path() / "folder/", fs::path()}) {
    EXPECT_NE(message_of([&] { write(request(1), path); }), "") << path;
  }
  expect_only({});
}

TEST_F(Truth, TheFileGoesWhereALinkLeads) {
  fs::create_symlink("target.csv", file_);
  write(request(1), file_, Existing::kRefuse);
  EXPECT_TRUE(fs::is_symlink(file_));
  EXPECT_GT(fs::file_size(directory_.path() / "target.csv"), 100U);
}

// What is open, the two lights and the backs of the board make up all that a point of the floor sees.
TEST_F(Truth, TheSkyIsASourceAfterTheOthers) {
  Request asked = request(2);
  asked.sky = true;
  asked.total = Quantity::kFormFactor;
  std::ostringstream out;
  (void)write(asked, out);
  std::istringstream in(out.str());
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.front() != '#' && !line.starts_with("receiver")) rows.push_back(fields_of(line));
  }
  ASSERT_EQ(rows.size(), 3 * asked.receivers.size());
  for (std::size_t r = 0; r < asked.receivers.size(); ++r) {
    const WholeView seen = view(scene_, asked.receivers[r]);
    EXPECT_EQ(rows[3 * r + 2][8], "sky");
    EXPECT_EQ(std::stod(rows[3 * r + 2][9]), seen.open.value);
    EXPECT_NEAR(std::stod(rows[3 * r][16]), 1.0 - seen.back.value, 1e-15);
  }
}

TEST_F(Truth, TheSkyAloneIsASourceWithoutAFraction) {
  Request asked = request(2);
  asked.sources.clear();
  asked.sky = true;
  std::ostringstream out;
  EXPECT_EQ(write(asked, out).rows, asked.receivers.size());
  asked.visible_fraction = true;
  EXPECT_THROW((void)write(asked, out), InputError);
}

TEST_F(Truth, SlowRowsAreTold) {
  std::vector<std::string> told;
  Hooks hooks;
  hooks.slow_seconds = 0.0;
  hooks.slow_row = [&](const std::string& row, double seconds) {
    EXPECT_GE(seconds, 0.0);
    told.push_back(row);
  };
  EXPECT_EQ(write(request(1), file_, Existing::kRefuse, hooks).slow, 2U);
  EXPECT_EQ(told, (std::vector<std::string>{"receiver 'r1c1' on 'floor', source 'light'",
                                            "receiver 'r1c1' on 'floor', source 'lamp'"}));
}

TEST_F(Truth, ProgressGoesFromWhatWasThereToAll) {
  interrupt(request(10), 100);
  std::vector<Progress> told;
  Hooks hooks;
  hooks.progress = [&](const Progress& progress) { told.push_back(progress); };
  const Summary summary = write(request(10), file_, Existing::kResume, hooks);
  EXPECT_EQ(told.front().done, summary.resumed);
  EXPECT_EQ(told.back().done, 200U);
  EXPECT_EQ(told.back().total, 200U);
}

// --- shards ----------------------------------------------------------------------------------------------------------

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
    return message_of([&] { merge(parts, directory_.path() / "merged.csv"); });
  }
};

TEST_F(TruthShards, MergedAreTheBytesOfOneRun) {
  const Summary one = write(request(10), file_);
  for (const std::uint64_t count : {2U, 3U, 4U, 7U}) {  // of 4 chunks, so that some shards have none
    std::vector<fs::path> parts = write_shards(10, count);
    std::reverse(parts.begin(), parts.end());
    const fs::path merged = directory_.path() / "merged.csv";
    const Summary summary = merge(parts, merged, Existing::kReplace);
    EXPECT_EQ(text_of(merged), text_of(file_));
    EXPECT_EQ(summary.rows_by_status, one.rows_by_status);
  }
}

TEST_F(TruthShards, InterruptionsDoNotShow) {
  const std::vector<fs::path> parts = write_shards(10, 2);
  for (const int rows : {30, 3, 50}) {
    std::atomic<int> left = rows;
    Hooks hooks;
    hooks.cancelled = [&left] { return left-- <= 0; };
    EXPECT_THROW(write(shard(10, 1, 2), file_, Existing::kResume, hooks), Cancelled);
  }
  EXPECT_NE(merge_refusal({journal_, parts[1]}).find("is the journal of an unfinished run"), std::string::npos);
  write(shard(10, 1, 2), file_, Existing::kResume);
  EXPECT_EQ(text_of(file_), text_of(parts[0]));
  const Summary again = write(shard(10, 1, 2), file_, Existing::kResume);
  EXPECT_EQ(again.resumed, again.rows);
}

TEST_F(TruthShards, WhatDoesNotBelongTogetherIsRefused) {
  const std::vector<fs::path> parts = write_shards(10, 3);
  const auto expect = [&](const std::vector<fs::path>& named, const std::string& message) {
    const std::string told = merge_refusal(named);
    EXPECT_NE(told.find(message), std::string::npos) << told;
    EXPECT_FALSE(fs::exists(directory_.path() / "merged.csv"));
  };
  expect({parts[0], parts[2]}, "of 3 shards these are missing: 2 (every row is needed)");
  expect({parts[0]}, "these are missing: 2 and 3");
  expect({}, "no shard is named");
  expect({parts[0], parts[1], parts[2], parts[1]}, "is shard 2, and so is ");
  expect({parts[0], directory_.path() / "nothing"}, "nothing: cannot be read: No such file");
  write(request(10), file_);
  expect({parts[0], parts[1], file_}, "truth.csv: is not a shard of a truth file");
  write(shard(10, 3, 4), file_, Existing::kReplace);
  expect({parts[0], parts[1], file_}, "is one of 4 shards");
  write(shard(9, 3, 3), file_, Existing::kReplace);
  expect({parts[0], parts[1], file_},
         "truth.csv:3: belongs to a different request: it says '# receivers: floor, grid, hash ");
}

TEST_F(TruthShards, DamageIsFoundWhereverItIs) {
  const std::vector<fs::path> parts = write_shards(10, 2);
  const std::string sound = text_of(parts[0]);
  const std::size_t rows = sound.find("\n# rows 0+64") + 1;
  for (std::size_t at = rows; at < sound.size(); at += 97) {
    std::string damaged = sound;
    damaged[at] ^= 1;
    write_text(parts[0], damaged);
    EXPECT_NE(merge_refusal(parts).find("truth.1.csv: is damaged: "), std::string::npos) << at;
    write_text(parts[0], sound.substr(0, at));
    EXPECT_NE(merge_refusal(parts).find("truth.1.csv: is damaged: "), std::string::npos) << at;
  }
  write_text(parts[0], sound + "more");
  EXPECT_NE(merge_refusal(parts).find("is damaged: "), std::string::npos);
}

// --- several processes, here threads ---------------------------------------------------------------------------------

class TruthTeam : public Truth {
 protected:
  using Requests = std::function<Request(int rank)>;

  // Runs every rank in a thread. The exit code of a leader that throws is 2, and all ranks must return the leader's
  // code. Returns what the leader threw.
  std::exception_ptr run(int size, const Requests& request, const Hooks& leaders = {}, const Hooks& followers = {}) {
    std::vector<Mailbox> mail(static_cast<std::size_t>(size));
    std::vector<int> codes(mail.size(), -1);
    std::exception_ptr thrown;
    {
      std::vector<std::jthread> ranks;
      for (int rank = 1; rank < size; ++rank) {
        ranks.emplace_back([&, rank] {
          ThreadTeam team(mail, rank);
          codes[static_cast<std::size_t>(rank)] = follow(
              team, [&, rank] { return request(rank); }, followers);
        });
      }
      ThreadTeam team(mail, 0);
      try {
        write(request(0), file_, Existing::kResume, leaders, &team);
        codes[0] = 0;
      } catch (...) {
        thrown = std::current_exception();
        codes[0] = 2;
      }
      dismiss(team, codes[0]);
    }
    EXPECT_EQ(std::set<int>(codes.begin(), codes.end()).size(), 1U);
    return thrown;
  }

  template <class Error>
  static std::string message_of(std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      return error.what();
    } catch (...) {
      return "another error";
    }
    return "no error";
  }
};

TEST_F(TruthTeam, ManyProcessesWriteTheBytesOfOne) {
  write(request(40), file_);
  const std::string whole = text_of(file_);
  for (const int size : {1, 2, 4}) {
    fs::remove(file_);
    EXPECT_EQ(run(size, [this](int) { return request(40); }), nullptr);
    EXPECT_EQ(text_of(file_), whole);
  }
  expect_only({"truth.csv"});
}

// Interrupted before this number of rows, by whichever thread asked.
Hooks interrupted_after(std::atomic<int>& rows) {
  Hooks hooks;
  hooks.cancelled = [&rows] { return rows-- <= 0; };
  return hooks;
}

// A leader that is so slow that the others do the work.
Hooks slow() {
  Hooks hooks;
  hooks.cancelled = [] {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return false;
  };
  return hooks;
}

TEST_F(TruthTeam, AnInterruptedTeamKeepsWhatItFinished) {
  write(request(40), file_);
  const std::string whole = text_of(file_);
  fs::remove(file_);
  std::atomic<int> followers_rows = 600 * kQuestions, leaders_rows = 300 * kQuestions;
  const auto asked = [this](int) { return request(40); };
  EXPECT_EQ(message_of<Cancelled>(run(4, asked, slow(), interrupted_after(followers_rows))), "cancelled");
  expect_only({"truth.csv.part"});
  EXPECT_GE(rows_in_journal(request(40)), 420U);
  EXPECT_EQ(message_of<Cancelled>(run(4, asked, interrupted_after(leaders_rows), slow())), "cancelled");
  expect_only({"truth.csv.part"});
  const Summary summary = write(request(40), file_, Existing::kResume);
  EXPECT_GT(summary.resumed, 600U);
  EXPECT_EQ(text_of(file_), whole);
}

// At the interruption, no follower has finished a whole chunk; only the followers have their rows.
TEST_F(TruthTeam, ALeaderThatStopsTakesWhatOthersHaveInHand) {
  std::atomic<int> asked = 0;
  Hooks leaders, followers;
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
  followers.cancelled = [&] {
    pause();
    ++asked;
    return false;
  };
  leaders.cancelled = [&] {
    pause();
    return asked > 90 * kQuestions;
  };
  const auto thrown = run(
      4, [this](int) { return request(40); }, leaders, followers);
  EXPECT_EQ(message_of<Cancelled>(thrown), "cancelled");
  EXPECT_GE(rows_in_journal(request(40)), 80U);  // rows of the followers; the leader adds some
}

TEST_F(TruthTeam, AProcessThatSeesOtherFilesIsNamed) {
  const auto thrown = run(3, [this](int rank) {
    Request asked = request(40);
    if (rank == 2) asked.receivers[0].point.x += 0.25;
    return asked;
  });
  const std::string told = message_of<InputError>(thrown);
  EXPECT_NE(told.find("on rank 2 (here): the program, the scene or the receivers differ from those of rank 0"),
            std::string::npos)
      << told;
}

TEST_F(TruthTeam, AProcessThatCannotReadItsInputIsNamed) {
  const auto thrown = run(3, [this](int rank) {
    if (rank == 1) throw InputError(Problem{"room.obj", 0, "cannot be opened", {}, {}});
    return request(100);
  });
  EXPECT_EQ(message_of<InputError>(thrown), "on rank 1 (here): room.obj: cannot be opened");
}

TEST_F(TruthTeam, ALeaderThatCannotBeginEndsAll) {
  const auto thrown = run(4, [this](int) {
    Request asked = request(2);
    asked.receivers.clear();
    return asked;
  });
  EXPECT_NE(message_of<InputError>(thrown).find("there are no receivers"), std::string::npos);
}

}  // namespace
}  // namespace exactff::truth
