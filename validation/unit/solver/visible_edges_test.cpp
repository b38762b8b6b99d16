// The rules of visible_edges.h one by one, on scenes so small that the visible part is known by hand.
#include "visibility/visible_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>

#include "exactff/exact.h"
#include "generate/plain_scene.h"
#include "generate/vectors.h"
#include "support/solve.h"
#include "visibility/visible_boundary.h"

namespace exactff::visibility {
namespace {

using generate::PlainScene;
using generate::operator*;
using Corners = std::vector<Vec3>;

constexpr std::size_t kAnyNumber = 0;

// The receiver at the origin, sources in the plane z = 1 facing down, occluders by what they hide there.
struct Case {
  std::string name;
  std::string fraction;            // visible share of the source, exact
  std::size_t parts = kAnyNumber;  // of edges
  std::vector<Corners> occluders = {};
  std::vector<Corners> sources = {{{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}}};
  Vec3 normal{0, 0, 1};
};

Corners at_depth(Corners corners, double depth) {
  for (Vec3& c : corners) c = c * depth;
  return corners;
}
Corners box(double x0, double x1, double y0, double y1, double depth = 0.5) {
  return at_depth({{x0, y0, 1}, {x1, y0, 1}, {x1, y1, 1}, {x0, y1, 1}}, depth);
}
Corners source_box(double x0, double x1) { return {{x0, 1, 1}, {x1, 1, 1}, {x1, -1, 1}, {x0, -1, 1}}; }
Corners triangle(Vec3 a, Vec3 b, Vec3 c) { return at_depth({a, b, c}, 0.5); }

const Vec3 kLow{0, -0.5, 1}, kHigh{0, 0.5, 1}, kLeft{-0.5, 0, 1}, kRight{0.5, 0, 1}, kFin{0.5, 0.25, 1};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"NothingInTheWay", "1", 4},
      {"AHole", "3/4", 8, {box(-0.5, 0.5, -0.5, 0.5)}},
      {"CoincidentOnTheSameSide", "7/8", kAnyNumber, {box(0, 0.5, -0.5, 0.5), box(0, 0.25, -0.25, 0.25, 0.25)}},
      {"CoincidentOnTheSameSideOverlapping",
       "13/16",
       kAnyNumber,
       {box(0, 0.5, -0.5, 0.5), box(0, 0.5, -0.25, 1, 0.25)}},
      {"CoincidentOnOppositeSides", "3/4", 10, {box(-0.5, 0, -0.5, 0.5), box(0, 0.5, -0.5, 0.5, 0.25)}},
      {"CoincidentOnOppositeSidesInPart",
       "13/16",
       kAnyNumber,
       {box(-0.5, 0, -0.5, 0.5), box(0, 0.5, -0.25, 0.25, 0.25)}},
      {"OnTheSourcesBoundary", "1/2", 4, {box(0, 1, -1, 1)}},
      {"OnTheSourcesBoundaryInPart", "7/8", 8, {box(0.5, 1, -0.5, 0.5)}},
      {"OutsideTheSourcesBoundary", "1", 4, {box(1, 2, -1, 1)}},
      {"TheSourcesOutline", "0", kAnyNumber, {box(-1, 1, -1, 1)}},
      {"HiddenByTwoHalves", "0", kAnyNumber, {box(-1, 0, -1, 1), box(0, 1, -1, 1, 0.25)}},
      {"TwoTrianglesOfASquare",
       "3/4",
       8,
       {triangle({-0.5, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}),
        triangle({-0.5, -0.5, 1}, {0.5, 0.5, 1}, {-0.5, 0.5, 1})}},
      {"ThreeTimesTheSame",
       "3/4",
       8,
       {box(-0.5, 0.5, -0.5, 0.5), box(-0.5, 0.5, -0.5, 0.5), box(-0.5, 0.5, -0.5, 0.5)}},
      {"TwoOnOneSideOfAnEdge", "37/40", kAnyNumber, {triangle(kLow, kHigh, kRight), triangle(kLow, kHigh, kFin)}},
      {"ThreeFacesOnAnEdge",
       "69/80",
       kAnyNumber,
       {triangle(kLow, kHigh, kLeft), triangle(kLow, kHigh, kRight), triangle(kLow, kHigh, kFin)}},
      {"TouchingAtACorner", "7/8", 12, {box(-0.5, 0, -0.5, 0), box(0, 0.5, 0, 0.5)}},
      {"ACornerOnASide",
       "13/16",
       kAnyNumber,
       {box(-0.5, 0.5, -0.5, 0), triangle({0, 0, 1}, {0.5, 0.5, 1}, {-0.5, 0.5, 1})}},
      {"ACornerInsideAStraightSide",
       "11/16",
       kAnyNumber,
       {at_depth({{-0.5, -0.5, 1}, {0.5, -0.5, 1}, {0.5, 0.5, 1}, {0, 0.5, 1}, {-0.5, 0.5, 1}}, 0.5),
        box(0, 0.5, 0.5, 1)}},
      {"AcrossTheSourcesPlane", "3/4", kAnyNumber, {{{-1, 0, 0.5}, {1, 0, 0.5}, {2, 1, 1.5}, {-2, 1, 1.5}}}},
      {"BehindTheSource", "1", 4, {box(-0.5, 0.5, -0.5, 0.5, 2)}},
      {"InTheSourcesPlane", "1", 4, {box(-0.5, 0.5, -0.5, 0.5, 1)}},
      {"EdgeOn", "1", 4, {{{0, -0.25, 0.25}, {0, 0.25, 0.25}, {0, 0.25, 0.5}, {0, -0.25, 0.5}}}},
      {"AbuttingSources", "1", 6, {}, {source_box(-1, 0), source_box(0, 1)}},
      {"OverlappingSources", "1", 6, {}, {source_box(-1, 0.5), source_box(-0.5, 1)}},
      {"TwiceTheSource", "1", 4, {}, {source_box(-1, 1), source_box(-1, 1)}},
      {"SourcesApart", "1", 8, {}, {source_box(-1, -0.5), source_box(0.5, 1)}},
      {"AnEdgeAlongTheSeam", "7/8", 10, {box(0, 0.5, -0.5, 0.5)}, {source_box(-1, 0), source_box(0, 1)}},
      {"EdgesAlongTheSeamOnBothSides",
       "3/4",
       kAnyNumber,
       {box(0, 0.5, -0.5, 0.5), box(-0.5, 0, -0.5, 0.5, 0.25)},
       {source_box(-1, 0), source_box(0, 1)}},
      {"OneSourceHidden", "1/2", 4, {box(0, 1, -1, 1)}, {source_box(-1, 0), source_box(0, 1)}},
      {"AcrossASeam", "3/4", kAnyNumber, {box(-0.5, 0.5, -0.5, 0.5)}, {source_box(-1, 0.25), source_box(-0.25, 1)}},
      {"BetweenSourcesApart", "1", 8, {box(-0.5, 0.5, -1, 1)}, {source_box(-1, -0.5), source_box(0.5, 1)}},
      {"HorizonAcrossTheSource", "1/2", 4, {}, {source_box(-1, 1)}, {1, 0, 0}},
      {"HorizonAlongASide", "1", 4, {}, {source_box(-1, 1)}, {1, 0, 1}},
      {"HorizonAlongAnEdge", "3/8", kAnyNumber, {box(0, 0.5, -0.5, 0.5)}, {source_box(-1, 1)}, {1, 0, 0}},
      {"HorizonAlongTheSeam", "1/2", 4, {}, {source_box(-1, 0), source_box(0, 1)}, {1, 0, 0}},
  };
  return all;
}

// With copies nearer to the receiver, which hide the same part without sharing a corner; reversed edge order too.
PlainScene scene_of(const Case& tested, int copies, bool reversed) {
  PlainScene scene;
  scene.normal = tested.normal;
  std::vector<Corners> sources = tested.sources, occluders;
  for (const Corners& o : tested.occluders) {
    // Outside the source's plane, where a copy hides less or more.
    const bool movable = std::all_of(o.begin(), o.end(), [](const Vec3& c) { return c.z < 1.0; });
    for (int k = 0; k <= (movable ? copies : 0); ++k) occluders.push_back(at_depth(o, 1.0 / (1 << k)));
  }
  if (reversed) {
    std::reverse(sources.begin(), sources.end());
    std::reverse(occluders.begin(), occluders.end());
  }
  for (const Corners& s : sources) scene.add_ring(scene.patch("source"), s);
  for (const Corners& o : occluders) scene.add_ring(scene.patch("occluders"), o);
  // A fin behind the source, along the seam: an edge of three faces, so that the source's are not joined (panels.h).
  scene.add_ring(scene.patch("fin"), {{0, -1, 1}, {0, 1, 1}, {0, 0, 2}});
  return scene;
}

// Number of parts that begin minus the number of parts that end, by direction.
std::map<std::string, int> open_ends(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  const View view(scene, generate::receiver_of(plain));
  std::map<std::string, int> ends;
  const auto count = [&](const BoundaryPiece& piece, const EdgeParameter& at, int by) {
    kernel::ExactVec3 t = piece.a * at.l + piece.b * at.m;
    kernel::make_primitive(t);
    ends[t.x.get_str() + ' ' + t.y.get_str() + ' ' + t.z.get_str()] += by;
  };
  EdgeWorkspace workspace;
  for (const SourcePlane& plane : group_by_plane(scene, scene.faces_of(scene.select("source")))) {
    find_visible_boundary(view, plane, {}, workspace).boundary.for_each_piece([&](const BoundaryPiece& piece) {
      count(piece, piece.begin, 1);
      count(piece, piece.end, -1);
    });
  }
  std::erase_if(ends, [](const auto& end) { return end.second == 0; });
  return ends;
}

class VisibleEdgesRule : public testing::TestWithParam<std::size_t> {};

TEST_P(VisibleEdgesRule, LeavesWhatIsVisible) {
  const Case& tested = cases()[GetParam()];
  for (const int copies : {0, 1, 8}) {  // 8: enough occluders for the grid
    for (const bool reversed : {false, true}) {
      SCOPED_TRACE(tested.name + ", copies " + std::to_string(copies) + (reversed ? ", reversed" : ""));
      const PlainScene scene = scene_of(tested, copies, reversed);
      const FormFactor both = validation::solve(scene, {.visible_fraction = true});
      const FormFactor result = validation::solve_by(Engine::kEdges, scene, {.exact_fraction = true});
      EXPECT_EQ(both.value, result.value);
      ASSERT_EQ(result.planes.size(), 1U);
      EXPECT_EQ(result.planes[0].engine, Engine::kEdges);
      EXPECT_EQ(result.planes[0].exact_fraction, tested.fraction);
      EXPECT_EQ(result.planes[0].edges, tested.parts == kAnyNumber ? result.planes[0].edges : tested.parts);
      EXPECT_TRUE(open_ends(scene).empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, VisibleEdgesRule, testing::Range<std::size_t>(0, cases().size()),
                         [](const testing::TestParamInfo<std::size_t>& tested) { return cases()[tested.param].name; });

// One workspace serves scenes of any size, one after the other, also at one address.
TEST(VisibleEdges, RemembersNothingOfTheSceneBefore) {
  std::vector<double> alone;
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < cases().size(); ++i) {
      const int copies = static_cast<int>(i % 5) * 2;
      const double value = validation::solve_by(Engine::kEdges, scene_of(cases()[i], copies, i % 2 == 1)).value;
      if (round == 0) {
        alone.push_back(validation::solve_by(Engine::kBoolean, scene_of(cases()[i], copies, i % 2 == 1)).value);
      }
      EXPECT_EQ(value, alone[i]) << cases()[i].name;
    }
  }
}

// With as many occluders as possible, processed in another order than the input order.
TEST(VisibleEdges, LosesNoneOfManyOccluders) {
  constexpr int kSide = 64;
  Case many{"Many", "3/4", 4 + 4 * kSide * kSide};
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = -1.0 + 2.0 * (i % kSide + 0.25) / kSide, y = -1.0 + 2.0 * (i / kSide + 0.25) / kSide;
    many.occluders.push_back(box(x, x + 1.0 / kSide, y, y + 1.0 / kSide));
  }
  const FormFactor result = validation::solve_by(Engine::kEdges, scene_of(many, 0, false), {.exact_fraction = true});
  EXPECT_EQ(result.planes.at(0).exact_fraction, many.fraction);
  EXPECT_EQ(result.planes.at(0).edges, many.parts);
}

}  // namespace
}  // namespace exactff::visibility
