// Finds closed surfaces; removing their back faces changes no result.
#include "scene/closed_surfaces.h"

#include "scene/panels.h"
#include "support/solve.h"
#include "support/test.h"

namespace exactff {
namespace {

using RingOfFace = std::vector<std::uint32_t>;
using Corners = std::vector<Vec3>;

// Source [-1,1]^2 at z = 1 facing down, receiver at the origin facing up.
PlainScene scene_with_source() {
  PlainScene scene;
  scene.add_ring(scene.patch("source"), {{-1, 1, 1}, {1, 1, 1}, {1, -1, 1}, {-1, -1, 1}});
  return scene;
}

// Adds vertices, and faces whose indices count from the first of these vertices.
void add_solid(PlainScene& scene, const std::vector<Vec3>& vertices, std::vector<RingOfFace> faces) {
  const auto first = static_cast<std::uint32_t>(scene.vertices.size());
  scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
  for (RingOfFace& ring : faces) {
    for (std::uint32_t& corner : ring) corner += first;
    scene.patch("o" + std::to_string(scene.patches.size())).faces.push_back({{ring}});
  }
}

const std::vector<RingOfFace> kTetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
const std::vector<RingOfFace> kOctahedron{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                          {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
const std::vector<Vec3> kCorners{{0, 0, 0.5}, {0.25, 0, 0.5}, {0, 0.25, 0.5}, {0, 0, 0.75}};

std::vector<RingOfFace> reversed(std::vector<RingOfFace> faces) {
  for (RingOfFace& ring : faces) std::reverse(ring.begin(), ring.end());
  return faces;
}

std::size_t count_of(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  return closed_surfaces(scene).surfaces().size();
}

TEST(ClosedSurfaces, WithAFinAreOpen) {
  PlainScene scene = scene_with_source();
  add_solid(scene, kCorners, kTetrahedron);
  add_solid(scene, {{0, 0, 0.5}, {0.25, 0, 0.5}, {0, 0.25, 0.5}}, {{0, 1, 2}});  // the first face, reversed
  EXPECT_EQ(count_of(scene), 0U);
  PlainScene loose = scene_with_source();
  add_solid(loose, kCorners, kTetrahedron);
  add_solid(loose, {{0, 0, 0.5}, {0.25, 0, 0.5}, {0, 0, 0}}, {{0, 1, 2}});  // an unshared corner: certainly open
  EXPECT_EQ(count_of(loose), 1U);
}

void expect_agreement(const PlainScene& plain, const Receiver& receiver, const ExactOptions& options = {}) {
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select("source"));
  ExactOptions both = options;
  both.engine = Engine::kBoth;
  both.visible_fraction = true;
  EXPECT_NO_THROW((void)exact_form_factor(scene, receiver, source, both));
}

TEST(ClosedSurfaces, HideByTheirBacksWhoeverIsInside) {
  PlainScene scene = scene_with_source();
  add_solid(scene, {{-4, -4, -1}, {4, -4, -1}, {0, 4, -1}, {0, 0, 0.5}}, kTetrahedron);
  EXPECT_EQ(validation::solve(scene).status, Status::kZero);
  expect_agreement(scene, generate::receiver_of(scene));
}

TEST(ClosedSurfaces, HideByBacksWhereFrontsAreLeftOut) {
  PlainScene plain = scene_with_source();
  add_solid(plain, kCorners, kTetrahedron);
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select("source"));
  const Receiver receiver = generate::receiver_of(plain);
  const double whole = exact_form_factor(scene, receiver, source).value;
  for (std::uint32_t face = 1; face < 5; ++face) {
    const std::vector<FaceId> only{FaceId{face}};
    expect_agreement(plain, receiver, {.only_occluders = &only});
    Receiver on_face = receiver;
    on_face.on = {FaceId{face}};
    expect_agreement(plain, on_face);
    EXPECT_GE(exact_form_factor(scene, on_face, source).value, whole);
  }
}

Vec3 random_point(Random& random, double reach, double z) {
  return {random.between(-reach, reach), random.between(-reach, reach), z + random.between(-reach, reach)};
}

// Solids that intersect each other and themselves, around x and near the source's plane, some inside out, some on a
// lattice.
TEST(ClosedSurfaces, HideWhatTheBooleansFind) {
  Random random(4);
  for (int round = 0; round < 60; ++round) {
    PlainScene scene = scene_with_source();
    const double lattice = random.one_in(2) ? 8.0 : 0x1p40;
    for (int solid = random.integer(1, 4); solid > 0; --solid) {
      const bool is_tetrahedron = random.one_in(2);
      std::vector<Vec3> vertices;
      const double reach = random.between(0.1, 0.6), z = random.between(0.1, 1.2);
      for (int i = 0; i < (is_tetrahedron ? 4 : 6); ++i) {  // an octahedron of random corners crosses itself
        const Vec3 p = random_point(random, reach, z);
        vertices.push_back({std::round(lattice * p.x) / lattice, std::round(lattice * p.y) / lattice,
                            std::round(lattice * p.z) / lattice});
      }
      const std::vector<RingOfFace>& faces = is_tetrahedron ? kTetrahedron : kOctahedron;
      add_solid(scene, vertices, random.one_in(2) ? reversed(faces) : faces);
    }
    Receiver receiver = generate::receiver_of(scene);
    if (random.one_in(4)) receiver.on = {FaceId{1}};
    SCOPED_TRACE(round);
    expect_agreement(scene, receiver);
  }
}

// --- Neighbouring faces of one plane become few convex panels; what does not lie side by side does not ---

PlainScene patch_of(const std::vector<Corners>& faces) {
  PlainScene plain;
  for (const Corners& face : faces) plain.add_ring(plain.patch("source"), face);
  return plain;
}

// The squares with these lower corners, each cut in two, in the plane z = x + y / 2.
std::vector<Corners> split_squares(const std::vector<std::pair<int, int>>& at) {
  std::vector<Corners> faces;
  const auto corner = [](int x, int y) { return Vec3{1.0 * x, 1.0 * y, x + 0.5 * y}; };
  for (const auto& [x, y] : at) {
    faces.push_back({corner(x, y), corner(x + 1, y), corner(x + 1, y + 1)});
    faces.push_back({corner(x, y), corner(x + 1, y + 1), corner(x, y + 1)});
  }
  return faces;
}

std::vector<std::pair<int, int>> block_of(int n) {
  std::vector<std::pair<int, int>> at;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) at.emplace_back(x, y);
  }
  return at;
}

TEST(Panels, JoinNothingThatIsOffThePlaneByAnUlp) {
  std::vector<Corners> faces = split_squares({{1, 1}});
  faces[1][2].z = std::nextafter(faces[1][2].z, 10.0);
  EXPECT_TRUE(panels(generate::build(patch_of(faces))).empty());
  // A pyramid that is an ulp high: its rim lies in one plane.
  const Vec3 apex{0.5, 0.5, std::nextafter(0.75, 1.0)}, a{0, 0, 0}, b{1, 0, 1}, c{1, 1, 1.5}, d{0, 1, 0.5};
  EXPECT_TRUE(panels(generate::build(patch_of({{a, b, apex}, {b, c, apex}, {c, d, apex}, {d, a, apex}}))).empty());
}

TEST(Panels, JoinNoFacesWithOppositeFronts) {
  std::vector<Corners> faces = split_squares({{0, 0}});
  std::swap(faces[1][0], faces[1][1]);
  EXPECT_TRUE(panels(generate::build(patch_of(faces))).empty());
  // Folded over: both on one side of the edge that they share.
  const Corners folded{faces[0][2], faces[0][1], {0.5, 0, 0.5}};
  EXPECT_TRUE(panels(generate::build(patch_of({faces[0], folded}))).empty());
}

TEST(Panels, JoinNothingThatOverlaps) {
  std::vector<Corners> faces = split_squares({{0, 0}});
  faces.push_back(faces[0]);
  EXPECT_TRUE(panels(generate::build(patch_of(faces))).empty());
  // A spiral in one plane, once and a half around.
  std::vector<Corners> spiral;
  const auto at = [](int i, double radius) {
    const double turn = 0.5 * i;
    return Vec3{radius * std::cos(turn), radius * std::sin(turn), 0.0};
  };
  for (int i = 0; i < 19; ++i) {
    const double inner = 1.0 + i / 16.0, next = inner + 1.0 / 16;
    spiral.push_back({at(i, inner), at(i, inner + 1.0), at(i + 1, next + 1.0)});
    spiral.push_back({at(i, inner), at(i + 1, next + 1.0), at(i + 1, next)});
  }
  const Scene scene = generate::build(patch_of(spiral));
  EXPECT_TRUE(panels(scene).empty());
}

TEST(Panels, AreOfOnePatchAndTransparentAsAWhole) {
  const std::vector<Corners> faces = split_squares(block_of(2));
  PlainScene plain;
  for (std::size_t f = 0; f < faces.size(); ++f) plain.add_ring(plain.patch(f < 4 ? "a" : "b"), faces[f]);
  const Scene scene = generate::build(plain);
  EXPECT_EQ(panels(scene).sheets().size(), 2U);
  const std::vector<Selection> glass{scene.select("a:1"), scene.select("a:2")};
  const Scene with_glass = scene.with_transparent(glass);
  const Panels& all = panels(with_glass);
  ASSERT_EQ(all.sheets().size(), 3U);
  for (const Sheet& sheet : all.sheets()) {
    for (const std::uint32_t piece : sheet.pieces) {
      EXPECT_EQ(with_glass.pieces()[piece].transparent, all.piece(sheet.first_panel).transparent);
    }
  }
}

}  // namespace
}  // namespace exactff
