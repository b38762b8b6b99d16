// View factors of random scenes with one to four faces between the patches, judged by form factors at random points of
// the patch, whose mean must lie within five standard errors of the interval: few points of the second opinion, and
// 2^14 points in plain doubles, some of which the second opinion judges.
//
// EXACTFF_TEST_SCALE multiplies the number of scenes; EXACTFF_TEST_POINTS is the number of points of the second
// opinion, 256 if unset.
#include <cstdlib>

#include "kernel/numbers.h"
#include "studies/honesty.h"
#include "support/oracle.h"
#include "support/plain_factor.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

bool lie_in_one_plane(const Scene& scene, FaceId a, FaceId b) {
  const auto& v = scene.vertices();
  const Piece& piece = scene.pieces_of(a).front();
  return std::ranges::all_of(scene.face(b).rings.front(), [&](std::uint32_t corner) {
    return kernel::orientation(v[piece.frame[0]], v[piece.frame[1]], v[piece.frame[2]], v[corner]) == 0;
  });
}

// Overlapping faces of one plane would weigh twice in a sample.
bool has_coplanar_faces(const Scene& scene, const Selection& patch) {
  const auto& faces = scene.faces_of(patch);
  for (std::size_t a = 0; a < faces.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (lie_in_one_plane(scene, faces[a], faces[b])) return true;
    }
  }
  return false;
}

struct Mean {
  double value = 0.0, tolerance = 0.0;
  bool is_normal = false;
};

// The tolerance is five standard errors, as long as the mean of the points is about normal: no point makes up more than
// a twentieth of the variance, and 30 points or more see something, and have something hidden. Elsewhere what matters
// may be so rare that no point meets it: at 14 points on average, that happens with a probability of e^-14.
Mean mean_of(const std::vector<double>& values, std::uint64_t seeing, std::uint64_t shadowed) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0, largest = 0.0;
  for (const double value : values) {
    const double square = (value - mean) * (value - mean);
    squares += square;
    largest = std::max(largest, square);
  }
  const bool is_normal = seeing >= 30 && shadowed >= 30 && largest <= squares / 20.0;
  return {mean, 5.0 * std::sqrt(squares / n / (n - 1.0)) + (is_normal ? 0.0 : 14.0 / n) + 1e-9, is_normal};
}

Mean mean_of_second_opinion(const Scene& scene, const Selection& from, const Selection& to, std::uint64_t count,
                            std::uint64_t seed) {
  std::vector<double> values;
  std::uint64_t seeing = 0, shadowed = 0;
  for (const Receiver& receiver : sample_receivers(scene, scene.faces_of(from), count, seed)) {
    const OracleResult f = oracle(scene, receiver, to);
    values.push_back(f.value);
    seeing += f.zero ? 0U : 1U;
    shadowed += f.visible_fraction < 1.0 ? 1U : 0U;
  }
  return mean_of(values, seeing, shadowed);
}

// The second opinion judges every 4,096th value.
Mean mean_of_plain_points(const Scene& scene, FaceId from, const Selection& to, std::uint64_t count,
                          std::uint64_t seed) {
  constexpr std::size_t kJudged = 4096;
  const PlainFactor plain(scene, from, to), open(scene, from, to, PlainFactor::Occluders::kNone);
  std::vector<double> values;
  std::uint64_t seeing = 0, shadowed = 0;
  for (const Receiver& receiver : sample_receivers(scene, {&from, 1}, count, seed)) {
    const double value = plain.at(receiver.point);
    if (values.size() % kJudged == 0) {
      EXPECT_NEAR(value, oracle(scene, receiver, to).value, 1e-7) << seed;
    }
    values.push_back(value);
    seeing += value > 0.0 ? 1U : 0U;
    shadowed += value < open.at(receiver.point) - 1e-12 ? 1U : 0U;
  }
  return mean_of(values, seeing, shadowed);
}

std::uint64_t points_of_a_scene() {
  const char* points = std::getenv("EXACTFF_TEST_POINTS");
  return points == nullptr ? 256 : std::strtoull(points, nullptr, 10);
}

struct RandomPair {
  std::string model;
  Scene scene;
  Selection from, to;
};

RandomPair random_pair(std::uint64_t number) {
  // Of the models of the library: means of points do not judge slivers.
  const experiments::HonestyScene named = experiments::honesty_scene(2 * number - 1);
  Scene scene = experiments::scene_of(named);
  const Selection from = scene.select(named.is_turned ? named.to : named.from);
  const Selection to = scene.select(named.is_turned ? named.from : named.to);
  return {named.model, std::move(scene), from, to};
}

struct Deviations {
  std::size_t judged = 0;  // sharply
  double largest = 0.0;    // over what is allowed
};

void judge(const Scene& scene, const std::string& model, const Selection& from, const Selection& to, const Mean& mean,
           Deviations& deviations) {
  for (const bool certify : {false, true}) {
    const ViewFactor f =
        view_factor(scene, from, to, {.accuracy = 1e-4, .budget = 1000, .sample_crowds = false, .certify = certify});
    const double beyond = std::max({0.0, f.lower - mean.value, mean.value - f.upper}) / mean.tolerance;
    EXPECT_LE(beyond, 1.0) << '@' << model << ' ' << scene.name_of(from) << (certify ? " certified" : "");
    deviations.largest = std::max(deviations.largest, beyond);
    deviations.judged += mean.is_normal && f.accurate ? 1U : 0U;
  }
}

void record(const Deviations& deviations) {
  testing::Test::RecordProperty("factors", static_cast<int>(deviations.judged));
  testing::Test::RecordProperty("largest_deviation_over_tolerance", std::to_string(deviations.largest));
}

TEST(ViewFactors, HoldMeansOfTheSecondOpinion) {
  constexpr std::uint64_t kScenes = 6;
  Deviations deviations;
  for (std::uint64_t s = 1; s <= scaled_count(kScenes); ++s) {
    const auto& [model, scene, from, to] = random_pair(s);
    if (has_coplanar_faces(scene, from)) continue;
    judge(scene, model, from, to, mean_of_second_opinion(scene, from, to, points_of_a_scene(), s), deviations);
  }
  EXPECT_GE(deviations.judged, kScenes / 6);
  record(deviations);
}

TEST(ViewFactors, HoldMeansOfManyPlainPoints) {
  constexpr std::uint64_t kScenes = 12, kPoints = 1 << 14;
  Deviations deviations;
  for (std::uint64_t s = 1; s <= scaled_count(kScenes); ++s) {
    const auto& [model, scene, from, to] = random_pair(s);
    const std::vector<FaceId> faces = scene.faces_of(from);
    if (faces.size() != 1 || has_coplanar_faces(scene, to)) continue;
    judge(scene, model, from, to, mean_of_plain_points(scene, faces.front(), to, kPoints, s), deviations);
  }
  EXPECT_GE(deviations.judged, kScenes / 6);
  record(deviations);
}

}  // namespace
}  // namespace exactff::validation
