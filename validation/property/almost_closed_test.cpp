// Rooms from CAD: faces that share no corners, each corner moved by 1e-15 to 3e-2. Their view factors are judged by
// those of the room that was meant, as far as moved corners can change them, and by means of point factors.
#include "property/closed_rooms.h"
#include "support/test.h"
#include "view_factors/pairs.h"

namespace exactff::validation {
namespace {

double perimeter_of_all(const PlainScene& scene) {
  double sum = 0.0;
  for (const generate::PlainPatch& patch : scene.patches) {
    for (const generate::PlainFace& face : patch.faces) {
      const auto& ring = face.rings.front();
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec3 &a = scene.vertices[ring[i]], &b = scene.vertices[ring[(i + 1) % ring.size()]];
        sum += std::hypot(b.x - a.x, b.y - a.y, b.z - a.z);
      }
    }
  }
  return sum;
}

std::string any_patch(const PlainScene& scene, Random& random) {
  return scene.patches[random.below(scene.patches.size())].name;
}

// A line that meets a face, but not the moved one, passes between their edges or ends between the two. The area between
// edges is at most their length times how far corners move.
TEST(AlmostClosedRooms, HaveTheFactorsOfTheRoomThatWasMeant) {
  std::size_t cells = 0, meant_cells = 0, judged = 0, slow = 0;
  for (std::uint64_t s = 0; s < scaled_count(20); ++s) {
    Random random(seed_of(s));
    const PlainScene room = random_plain_room(random);
    const double moved = std::pow(10.0, -15.0 + 10.0 * random.unit());
    const Scene meant = generate::build(room);
    const Scene scene = generate::build(with_moved_corners(room, moved, seed_of(s)));
    const std::string from = any_patch(room, random), to = any_patch(room, random);
    SCOPED_TRACE("seed " + std::to_string(seed_of(s)) + ", " + from + " to " + to + ", " + std::to_string(moved));
    const double accuracy = std::max(1e-6, 1e4 * moved);
    const ViewFactorOptions options{.accuracy = accuracy, .budget = 5000, .certify = random.one_in(2)};
    const ViewFactor g = view_factor(meant, meant.select(from), meant.select(to), options);
    const ViewFactor f = view_factor(scene, scene.select(from), scene.select(to), options);
    const double most = 8.0 * moved * perimeter_of_all(room) / std::min(f.area_from, f.area_to) + 1e-12;
    EXPECT_LE(f.lower, g.upper + most);
    EXPECT_GE(f.upper, g.lower - most);
    slow += f.accurate ? 0U : 1U;
    cells += f.cells;
    meant_cells += g.cells;
    ++judged;
  }
  EXPECT_LE(slow, judged / 10);
  EXPECT_LE(cells, 12 * meant_cells + 100 * judged) << meant_cells;
}

// A strip of the floor under a plate a hair above it, so narrow that the plate may be left out: the rest of the floor
// sees what it saw, and the strip next to nothing.
TEST(AlmostClosedRooms, CountWhatIsLeftOut) {
  constexpr double kStrip = 0x1p-12, kHigh = 0x1p-24;
  const auto room = [](double from_x, bool plate) {
    PlainScene scene;
    scene.add_ring(scene.patch("floor"), {{from_x, 0, 0}, {1, 0, 0}, {1, 1, 0}, {from_x, 1, 0}});
    scene.add_ring(scene.patch("ceiling"), {{0, 0, 4}, {0, 1, 4}, {1, 1, 4}, {1, 0, 4}});
    if (plate)
      scene.add_ring(scene.patch("plate"), {{0, 0, kHigh}, {kStrip, 0, kHigh}, {kStrip, 1, kHigh}, {0, 1, kHigh}});
    return generate::build(scene);
  };
  const Scene open = room(kStrip, false), covered = room(0.0, true);
  const ViewFactor rest = view_factor(open, open.select("floor"), open.select("ceiling"), {.accuracy = 1e-9});
  for (const bool certify : {false, true}) {
    const ViewFactor f = view_factor(covered, covered.select("floor"), covered.select("ceiling"),
                                     {.accuracy = 1e-3, .both_directions = true, .certify = certify});
    EXPECT_TRUE(f.accurate);
    EXPECT_LE(f.lower, (1.0 - kStrip) * rest.lower + 2.0 * kHigh);
    EXPECT_GE(f.upper, (1.0 - kStrip) * rest.lower);
  }
}

// The integral of log(r) over the pairs of places on two parallel segments of one length, beside each other.
double integral_of_log(double length, double squared_distance) {
  const double a = length, q = squared_distance, d = std::sqrt(q);
  return 2.0 * a * d * std::atan2(a, d) - 1.5 * a * a + 0.5 * q * std::log(q) + 0.5 * (a * a - q) * std::log(a * a + q);
}

// A wall that begins a hair above the floor and a hair beside it: one side of each is almost in the other's plane. By
// Stokes' theorem, only the sides along the gap count, as only these are parallel.
TEST(AlmostClosedRooms, HoldTheFactorOfAWallBesideAGap) {
  std::size_t narrow = 0;
  for (std::uint64_t s = 0; s < scaled_count(60); ++s) {
    Random random(seed_of(s));
    const auto hair = [&] { return std::pow(10.0, -14.0 + 11.0 * random.unit()); };
    const double a = 1.0 + 4.0 * random.unit(), b = 1.0 + 4.0 * random.unit(), top = 1.0 + 2.0 * random.unit();
    const double y = b + hair(), low = hair();
    PlainScene plain;
    plain.add_ring(plain.patch("floor"), {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}});
    plain.add_ring(plain.patch("wall"), {{0, y, low}, {a, y, low}, {a, y, top}, {0, y, top}});
    const Scene scene = generate::build(plain);
    const auto between = [&](double of_floor, double z) {
      return integral_of_log(a, (y - of_floor) * (y - of_floor) + z * z);
    };
    const double product =
        (between(0.0, low) - between(0.0, top) - between(b, low) + between(b, top)) / (2.0 * std::numbers::pi);
    for (const bool is_turned : {false, true}) {
      const double truth = product / (a * (is_turned ? top - low : b));
      const ViewFactor f =
          view_factor(scene, scene.select(is_turned ? "wall" : "floor"), scene.select(is_turned ? "floor" : "wall"),
                      {.accuracy = std::pow(10.0, -random.integer(4, 8)),
                       .budget = 300,
                       .sample_crowds = false,
                       .both_directions = true});
      EXPECT_LE(f.lower - 1e-13, truth) << "seed " << seed_of(s) << ", gap " << y - b << ", low " << low;
      EXPECT_GE(f.upper + 1e-13, truth) << "seed " << seed_of(s) << ", gap " << y - b << ", low " << low;
      narrow += f.upper - f.lower < 1e-5 ? 1U : 0U;
    }
  }
  EXPECT_GE(narrow, scaled_count(60) / 2);
}

// Gaps so large that what passes them counts.
TEST(AlmostClosedRooms, HoldMeansOfPoints) {
  constexpr std::size_t kPoints = 1 << 11;
  double largest = 0.0;
  for (std::uint64_t s = 0; s < scaled_count(6); ++s) {
    Random random(seed_of(s));
    PlainScene room = random_plain_room(random);
    if (random.one_in(3)) add_thing(room, box({0.25, 0.25, 0.0}, {0.75, 0.5, 0.5}));
    const double moved = std::pow(10.0, -4.0 + 2.5 * random.unit());
    const Scene scene = generate::build(with_moved_corners(room, moved, seed_of(s)));
    const Selection from = scene.select(any_patch(room, random)), to = scene.select(any_patch(room, random));
    const std::vector<FaceId> faces = scene.faces_of(from);
    const ExactSource source(scene, to);
    std::vector<double> values;
    for (const Receiver& receiver : sample_receivers(scene, faces, kPoints, seed_of(s))) {
      values.push_back(exact_form_factor(scene, receiver, source).value);
    }
    const double n = static_cast<double>(kPoints), mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    const double tolerance = 5.0 * std::sqrt(squares / n / (n - 1.0)) + 14.0 / n * moved + 1e-9;
    const ViewFactor fine = view_factor(scene, from, to, {.accuracy = 1e-5, .budget = 3000, .sample_crowds = false});
    for (const double accuracy : {1e-2, 1e-3}) {
      const ViewFactor f = view_factor(scene, from, to, {.accuracy = accuracy, .budget = 2000, .certify = s % 2 == 0});
      const double beyond = std::max({0.0, f.lower - mean, mean - f.upper}) / tolerance;
      const std::string where = "seed " + std::to_string(seed_of(s)) + ' ' + scene.name_of(from) + " to " +
                                scene.name_of(to) + ", moved by " + std::to_string(moved);
      EXPECT_LE(beyond, 1.0) << where << ": [" << f.lower << ", " << f.upper << "], " << mean;
      EXPECT_LE(f.lower, fine.upper) << where;
      EXPECT_GE(f.upper, fine.lower) << where;
      largest = std::max(largest, beyond);
    }
  }
  RecordProperty("largest_deviation_over_tolerance", std::to_string(largest));
}

// Judged by what points see. Nothing is proved of rooms without a ceiling, nor of the ground around a box.
TEST(AlmostClosedRooms, LetOutNoMoreThanIsProved) {
  constexpr std::size_t kPoints = 64;
  std::size_t proved = 0, open = 0;
  for (std::uint64_t s = 0; s < scaled_count(16); ++s) {
    Random random(seed_of(s));
    PlainScene room = random_plain_room(random);
    const double moved = std::pow(10.0, -12.0 + 10.0 * random.unit());
    const bool is_closed = s % 4 < 2;
    if (s % 4 == 1) add_thing(room, box({0.25, 0.25, 0.0}, {0.75, 0.5, 0.5}));
    if (s % 4 == 2)
      room.patches.erase(room.patches.begin() + static_cast<std::ptrdiff_t>(random.below(room.patches.size())));
    if (s % 4 == 3) {
      room = {};
      room.add_ring(room.patch("ground"), {{-1, -1, 0}, {2, -1, 0}, {2, 2, 0}, {-1, 2, 0}});
      add_thing(room, box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}));
    }
    const Scene scene = generate::build(with_moved_corners(room, moved, seed_of(s)));
    std::vector<Selection> rows;
    for (const generate::PlainPatch& patch : room.patches) rows.push_back(scene.select(patch.name));
    const view_factors::Pairs pairs(scene, rows, rows, {});
    for (std::size_t row = 0; row < rows.size(); ++row) {
      const std::vector<FaceId> faces = scene.faces_of(rows[row]);
      double sum = 0.0, squares = 0.0;
      for (const Receiver& receiver : sample_receivers(scene, faces, kPoints, seed_of(s))) {
        const double share = view(scene, receiver).open.value;
        sum += share;
        squares += share * share;
      }
      const double n = static_cast<double>(kPoints), mean = sum / n;
      const double noise = 5.0 * std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0));
      const double most = pairs.open_at_most(row);
      const std::string where =
          "seed " + std::to_string(seed_of(s)) + ' ' + scene.name_of(rows[row]) + ", moved by " + std::to_string(moved);
      EXPECT_LE(mean, most + (most < 0.1 ? 1e-12 : noise)) << where;
      const bool is_of_room = is_closed && scene.name_of(rows[row]).find("thing") == std::string::npos;
      if (is_of_room) {
        EXPECT_LE(most, 64.0 * moved * perimeter_of_all(room) / pairs.area_from(row) + 1e-9) << where;
      }
      proved += most < 0.1 ? 1U : 0U;
      open += most > 0.9 ? 1U : 0U;
    }
  }
  EXPECT_GE(proved, 20U);
  EXPECT_GE(open, 20U);
}

}  // namespace
}  // namespace exactff::validation
