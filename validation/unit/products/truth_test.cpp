// The rows of a truth file, their head, their statuses, and what a run tells about them.
#include "support/test.h"
#include "truth/rows.h"
#include "unit/products/truth_support.h"

namespace exactff::truth {
namespace {

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

TEST_F(Truth, TheHeadTellsWhatTheBytesDependOn) {
  Request asked = request(2);
  asked.unoccluded = asked.visible_fraction = true;
  asked.receivers_name = "a\nb";
  const std::string head = Rows(asked).head();
  const auto parsed = table::parse_csv_head(head);
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->kind, "truth");
  EXPECT_EQ(parsed->head.text("scene"), "room.obj");
  EXPECT_EQ(parsed->head.text("scene_hash"), scene_.hash());
  EXPECT_EQ(parsed->head.text("receivers"), "a\nb");
  EXPECT_EQ(parsed->head.list("sources"), (std::vector<std::string>{"light", "lamp"}));
  EXPECT_EQ(parsed->head.find("shard"), nullptr);
  EXPECT_TRUE(
      head.ends_with("\nreceiver,on,x,y,z,nx,ny,nz,source,exact,lower,upper,unoccluded,unoccluded_status,"
                     "visible_fraction,radiosity_r,radiosity_g,radiosity_b,largest_rho_b,status\n"));
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
    append(rows, row, line, results);
    ASSERT_EQ(line.back(), '\n');
    line.pop_back();
    const std::vector<std::string> fields = fields_of(line);
    ASSERT_EQ(fields.size(), 20U) << line;
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
    EXPECT_EQ(fields[13], to_string(free.status));
    EXPECT_EQ(std::stod(fields[14]), f.visible_fraction);
    EXPECT_EQ(std::stod(fields[15]), f.value);  // rho and B are 1
    EXPECT_EQ(std::stod(fields[18]), 1.0);
    EXPECT_EQ(fields[19], to_string(f.status));
  }
  EXPECT_GT(hidden, 0);
}

TEST_F(Truth, SenselessRequestsAreRefused) {
  Request none = request(1);
  none.receivers.clear();
  EXPECT_HOLDS(refusal(none, Existing::kRefuse), "there are no receivers in floor, grid");
  Request dark = request(1);
  dark.sources.clear();  // no source emits here
  EXPECT_HOLDS(refusal(dark, Existing::kRefuse), "no patch emits");
  EXPECT_HOLDS(refusal(shard(1, 5, 4), Existing::kRefuse), "there is no shard 5 of 4");
  EXPECT_HOLDS(refusal(shard(1, 0, 4), Existing::kRefuse), "there is no shard 0 of 4");
  expect_only({});
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
  asked.visible_fraction = false;
  asked.gradient = true;
  EXPECT_THROW((void)write(asked, out), InputError);
}

TEST_F(Truth, SlowRowsAreTold) {
  std::vector<std::string> told;
  RowHooks hooks;
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
  RowHooks hooks;
  hooks.progress = [&](const Progress& progress) { told.push_back(progress); };
  const Summary summary = write(request(10), file_, Existing::kResume, hooks);
  EXPECT_EQ(told.front().done, summary.resumed);
  EXPECT_EQ(told.back().done, 200U);
  EXPECT_EQ(told.back().total, 200U);
}

}  // namespace
}  // namespace exactff::truth
