// Backs of closed surfaces, which cells leave out of the occluders (sight.h): the same solids with one corner more,
// which opens their surfaces and changes no shape, must have the same view factors.
#include "property/closed_rooms.h"
#include "scene/closed_surfaces.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

using generate::PlainFace;
using generate::Ring;

constexpr int kSide = 4;  // of the cube that holds everything, whose corners are whole numbers

Vec3 lattice_point(Random& random) {
  const auto coordinate = [&] { return static_cast<double>(random.integer(0, kSide)); };
  return {coordinate(), coordinate(), coordinate()};
}

// Boxes, L-shaped prisms and tetrahedra. They may touch, pierce or hold one another, receiver and source.
Solid random_solid(Random& random) {
  for (;;) {
    const Vec3 a = lattice_point(random), b = lattice_point(random);
    const Vec3 low{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    const Vec3 high{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
    const bool is_thick = low.x < high.x && low.y < high.y && low.z < high.z;
    switch (random.below(3)) {
      case 0:
        if (is_thick) return box(low, high);
        break;
      case 1: {
        if (!is_thick) break;
        const double x = 0.5 * (low.x + high.x), y = 0.5 * (low.y + high.y);
        return prism({{{low.x, low.y}, {high.x, low.y}, {high.x, y}, {x, y}, {x, high.y}, {low.x, high.y}}}, low.z,
                     high.z);
      }
      default: {
        const std::vector<Vec3> points{a, b, lattice_point(random), lattice_point(random)};
        if (in_general_position(points)) return hull(points);
      }
    }
  }
}

void turn_inside_out(Solid& solid) {
  for (PlainFace& face : solid.faces) {
    for (Ring& ring : face.rings) std::ranges::reverse(ring);
  }
}

// Puts a corner in the middle of one face's first edge: the face beside it keeps the whole edge.
void open(Solid& solid) {
  Ring& ring = solid.faces.front().rings.front();
  const Vec3 a = solid.corners[ring[0]], b = solid.corners[ring[1]];
  solid.corners.push_back({0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z)});
  ring.insert(ring.begin() + 1, static_cast<std::uint32_t>(solid.corners.size() - 1));
}

// `below` and `above` look at each other, `beside` at both of them.
PlainScene scene_of(const std::vector<Solid>& solids, double floor, double ceiling) {
  PlainScene scene;
  scene.add_ring(scene.patch("below"), {{0, 0, floor}, {4, 0, floor}, {4, 4, floor}, {0, 4, floor}});
  scene.add_ring(scene.patch("above"), {{1, 0, ceiling}, {1, 3, ceiling}, {4, 3, ceiling}, {4, 0, ceiling}});
  scene.add_ring(scene.patch("beside"), {{0, 0, 0}, {0, 4, 0}, {0, 4, 4}, {0, 0, 4}});
  for (const Solid& solid : solids) add_thing(scene, solid);
  return scene;
}

bool meet(const ViewFactor& a, const ViewFactor& b) { return a.lower <= b.upper && b.lower <= a.upper; }

struct Counted {
  std::size_t judged = 0, cells = 0, cells_of_open = 0;
};

void judge(const Scene& closed, const Scene& open, const ViewFactorOptions& options, Counted& counted) {
  for (const char* from : {"below", "above", "beside", "things"}) {
    for (const char* to : {"below", "above", "beside"}) {
      if (std::string(from) == to) continue;
      const ViewFactor f = view_factor(closed, closed.select(from), closed.select(to), options);
      const ViewFactor g = view_factor(open, open.select(from), open.select(to), options);
      EXPECT_TRUE(meet(f, g)) << from << " -> " << to << ": [" << f.lower << ", " << f.upper << "] and [" << g.lower
                              << ", " << g.upper << ']';
      counted.cells += f.cells;
      counted.cells_of_open += g.cells;
      if (f.accurate && g.accurate && f.value > 0.0) ++counted.judged;
    }
  }
}

TEST(SpareBacks, ClosedSolidsHideWhatTheSameOpenOnesHide) {
  Counted counted;
  for (std::uint64_t s = 0; s < scaled_count(12); ++s) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(s)));
    Random random(seed_of(s));
    std::vector<Solid> solids(1 + random.below(2));
    for (Solid& solid : solids) {
      solid = random_solid(random);
      if (random.one_in(3)) turn_inside_out(solid);
    }
    const double floor = random.integer(0, 1), ceiling = random.integer(3, 4);
    const Scene closed = generate::build(scene_of(solids, floor, ceiling));
    for (Solid& solid : solids) open(solid);
    const Scene opened = generate::build(scene_of(solids, floor, ceiling));
    EXPECT_FALSE(closed_surfaces(closed).empty());
    EXPECT_TRUE(closed_surfaces(opened).empty());
    judge(closed, opened, {.accuracy = 1e-3, .budget = 400, .sample_crowds = false}, counted);
    if (s % 12 == 0) judge(closed, opened, {.accuracy = 1e-3, .budget = 400, .certify = true}, counted);
  }
  EXPECT_GE(counted.judged, 30U);
  // What backs hide beside fronts is next to nothing, and left out of open surfaces as well.
  EXPECT_LT(counted.cells, counted.cells_of_open + counted.cells_of_open / 20);
}

// Two boxes that share an edge are one surface. Where the smaller one is turned inside out and stands on the source,
// the winding number is negative, and the faces that show the receiver their backs count.
TEST(SpareBacks, AreNotSpareUnderABoxThatIsTurnedInsideOut) {
  std::vector<Solid> solids{box({1, 1, 0}, {3, 3, 2}), box({3, 3, 0}, {4, 4, 2})};
  turn_inside_out(solids.back());
  const auto scene = [&] { return generate::build(scene_of(solids, 0, 3)); };
  const Scene closed = scene();
  ASSERT_EQ(closed_surfaces(closed).surfaces().size(), 1U);
  for (Solid& solid : solids) open(solid);
  const Scene opened = scene();
  const auto factor = [](const Scene& s) { return view_factor(s, s.select("above"), s.select("below")); };
  EXPECT_NEAR(factor(closed).value, factor(opened).value, 1e-6);
}

}  // namespace
}  // namespace exactff::validation
