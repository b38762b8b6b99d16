// The answers of data/suite, as the program wrote them, against computations that share nothing with it: points by the
// second opinion, in every bit; pairs by the mean of plain factors at random points. validation/suite.sh compares the
// bytes of all answers, and unobstructed pairs with closed forms; for it EXACTFF_TEST_SCALE is 4, which takes in scenes
// of more than a hundred faces, and four times as many points.
#include <cstdlib>

#include "support/oracle.h"
#include "support/plain_factor.h"
#include "support/test.h"
#include "table/csv.h"

namespace exactff::validation {
namespace {

const std::filesystem::path kFolder = EXACTFF_DATA_DIR "/suite";
using Question = std::map<std::string, std::string>;  // its fields by name

// Calls `judge` with each question, its scene and its answer; `pairs`, or points.
void for_each_question(bool pairs, const auto& judge) {
  const check::Truth answers = check::read_suite(kFolder);
  table::CsvReader reader(kFolder / "questions.csv", "questions");
  for (std::size_t i = 0; reader.next(); ++i) {
    Question question;
    for (std::size_t c = 0; c < reader.names().size(); ++c) question[reader.names()[c]] = reader.field(c);
    ASSERT_EQ(question["question"], answers.rows.at(i).receiver);
    SCOPED_TRACE(question["question"]);
    if (question["from"].empty() == pairs) continue;
    judge(question, read_obj(kFolder / "scenes" / (question["scene"] + ".obj")), answers.rows[i]);
  }
}

Receiver receiver_of(const Scene& scene, Question& q) {
  const auto number = [&](const char* field) { return q[field].empty() ? 0.0 : std::stod(q[field]); };
  Receiver receiver;
  receiver.point = {number("x"), number("y"), number("z")};
  receiver.normal = {number("nx"), number("ny"), number("nz")};
  if (!q["on"].empty()) receiver.on = own_faces_named(scene, q["on"]);
  return receiver;
}

Measure measure_of(const std::string& quantity) {
  Measure measure;
  measure.sphere = quantity == "sphere";
  if (quantity == "solid angle") measure.kind = MeasureKind::kSolidAngle;
  if (quantity == "overcast sky") measure.kind = MeasureKind::kOvercast;
  return measure;
}

std::uint64_t scale() {
  const char* text = std::getenv("EXACTFF_TEST_SCALE");
  return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

// The second opinion knows neither what is open nor solids that stand on each other.
TEST(Suite, PointsAreThoseOfTheSecondOpinion) {
  int judged = 0;
  for_each_question(false, [&](Question& q, const Scene& scene, const check::TruthRow& answer) {
    if (q["to"] == "sky" || some_is_buried(scene) || scene.faces().size() > 150 * scale()) return;
    const OracleResult second = oracle(scene, receiver_of(scene, q), scene.select(q["to"]), measure_of(q["quantity"]));
    EXPECT_EQ(answer.value, second.value);
    ++judged;
  });
  EXPECT_GE(judged, 60);
}

// Five standard errors; where few points see anything, what matters may be so rare that none of them does.
TEST(Suite, PairsAreMeansOfPoints) {
  const std::uint64_t points = 512 * scale();
  for_each_question(true, [&](Question& q, const Scene& scene, const check::TruthRow& answer) {
    std::map<FaceId, PlainFactor> plain;
    const Selection to = scene.select(q["to"]);
    double sum = 0.0, squares = 0.0, seeing = 0.0;
    for (const Receiver& x : sample_receivers(scene, scene.faces_of(scene.select(q["from"])), points, 1)) {
      const double value = plain.try_emplace(x.on.front(), scene, x.on.front(), to).first->second.at(x.point);
      sum += value, squares += value * value, seeing += value > 0.0 ? 1.0 : 0.0;
    }
    const auto n = static_cast<double>(points);
    const double mean = sum / n, error = std::sqrt(std::max(0.0, squares / n - mean * mean) / n);
    EXPECT_NEAR(mean, std::clamp(mean, answer.lower, answer.upper), 5.0 * error + (seeing < 30.0 ? 14.0 / n : 1e-6));
  });
}

}  // namespace
}  // namespace exactff::validation
