// Grids of receivers and receiver files.
#include "kernel/numbers.h"
#include "support/test.h"

namespace exactff {
namespace {

using Ring = std::vector<std::uint32_t>;

struct Polygon {
  std::vector<Vec3> vertices;
  std::vector<Ring> rings;
  std::string patch = "face";
};

Scene scene_of(const std::vector<Polygon>& polygons) {
  SceneBuilder builder("test");
  const MaterialId material = builder.add_material({});
  for (const Polygon& polygon : polygons) {
    const auto first = static_cast<std::uint32_t>(builder.vertex_count());
    for (const Vec3& v : polygon.vertices) builder.add_vertex(v);
    std::vector<Ring> rings = polygon.rings;
    for (Ring& ring : rings) {
      for (std::uint32_t& v : ring) v += first;
    }
    builder.add_face(builder.patch(polygon.patch), material, std::move(rings));
  }
  return builder.build();
}

// One ring through all of the points.
Polygon polygon(std::vector<Vec3> vertices, std::string patch = "face") {
  Ring ring(vertices.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = static_cast<std::uint32_t>(i);
  return {std::move(vertices), {std::move(ring)}, std::move(patch)};
}

std::vector<FaceId> every_face(const Scene& scene) {
  std::vector<FaceId> faces;
  for (std::size_t i = 0; i < scene.faces().size(); ++i) faces.push_back(FaceId(static_cast<std::uint32_t>(i)));
  return faces;
}

std::vector<Receiver> samples_of(const Scene& scene, std::uint64_t count, std::uint64_t seed = 1) {
  return sample_receivers(scene, every_face(scene), count, seed);
}

std::vector<std::string> ids_of(const std::vector<Receiver>& receivers) {
  std::vector<std::string> ids;
  for (const Receiver& receiver : receivers) ids.push_back(receiver.id);
  return ids;
}

// Three unit squares.
Polygon letter_l() { return polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}); }

std::vector<Receiver> grid(const Scene& scene, int u, int v) {
  return grid_receivers(scene, scene.select("face"), {u, v});
}

TEST(GridReceivers, CentresOfARectangleAreExactAndURunsFastest) {
  const Scene scene = scene_of({polygon({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}})});
  const auto receivers = grid(scene, 2, 2);
  ASSERT_EQ(receivers.size(), 4U);
  EXPECT_EQ(receivers[0].point, (Vec3{1, 0.5, 0}));
  EXPECT_EQ(receivers[1].point, (Vec3{3, 0.5, 0}));
  EXPECT_EQ(receivers[2].point, (Vec3{1, 1.5, 0}));
  EXPECT_EQ(receivers[1].id, "r1c2");
  EXPECT_EQ(receivers[3].id, "r2c2");
}

TEST(GridReceivers, AnotherFaceKeepsTheCentresInsideItsBoundingRectangle) {
  // An L: the quarter with large x and y is missing.
  const Scene scene = scene_of({letter_l()});
  const auto receivers = grid(scene, 2, 2);
  ASSERT_EQ(receivers.size(), 3U);
  EXPECT_EQ(receivers[0].point, (Vec3{0.5, 0.5, 0}));
  EXPECT_EQ(receivers[1].point, (Vec3{1.5, 0.5, 0}));
  EXPECT_EQ(receivers[2].point, (Vec3{0.5, 1.5, 0}));
  EXPECT_EQ(receivers[2].id, "r2c1");
}

TEST(GridReceivers, ACentreOnAnEdgeOrACornerIsNotInside) {
  // Grid 4x4 of the same L has centres at odd quarters; 3x3 has (1, 1), the inner corner, and points on x = 1.
  const Scene scene = scene_of({letter_l()});
  EXPECT_EQ(grid(scene, 4, 4).size(), 12U);
  EXPECT_EQ(grid(scene, 1, 1).size(), 0U);
  EXPECT_EQ(grid(scene, 3, 3).size(), 5U);
}

TEST(GridReceivers, HolesAreLeftOut) {
  const Polygon frame{{{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}},
                      {{0, 1, 2, 3}, {4, 5, 6, 7}}};
  const Scene scene = scene_of({frame});
  const auto receivers = grid(scene, 3, 3);
  EXPECT_EQ(receivers.size(), 8U);
  for (const Receiver& receiver : receivers) EXPECT_NE(receiver.point, (Vec3{1.5, 1.5, 0}));
}

TEST(GridReceivers, TheRectangleFollowsTheFirstEdgeInItsPlane) {
  // A right triangle in the plane x = 7 whose first edge runs along +z; v = Newell x u.
  const Scene scene = scene_of({polygon({{7, 0, 0}, {7, 0, 4}, {7, -4, 0}})});
  const auto receivers = grid(scene, 4, 4);
  EXPECT_EQ(receivers.size(), 6U);  // strictly below the diagonal
  EXPECT_EQ(receivers[0].point, (Vec3{7, -0.5, 0.5}));
  EXPECT_EQ(receivers[1].point, (Vec3{7, -0.5, 1.5}));
  EXPECT_GT(receivers[0].normal.x, 0.0);
}

class ReceiverFile : public ::testing::Test {
 protected:
  static Scene make_scene() {
    SceneBuilder builder("test");
    for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}) builder.add_vertex(v);
    const MaterialId material = builder.add_material({});
    builder.add_face(builder.patch("floor"), material, {{0, 1, 2}});
    builder.add_face(builder.patch("floor"), material, {{0, 2, 3}});
    builder.add_face(builder.patch("lid"), material, {{3, 2, 1, 0}});
    return builder.build();
  }

  std::vector<Receiver> read(const std::string& text) {
    return read_receivers(directory_.write("receivers.csv", text), scene_);
  }

  // The first message, without the file's name.
  std::string fault(const std::string& text) {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      const Problem& p = error.problems().front();
      EXPECT_EQ(p.file, (directory_.path() / "receivers.csv").string());
      return std::to_string(p.line) + ": " + p.what;
    }
    return "no fault";
  }

  const TemporaryDirectory directory_;
  const Scene scene_ = make_scene();
};

TEST_F(ReceiverFile, ReadsQuotesCommentsCrlfAndAnyColumnOrder) {
  const auto receivers = read(
      "\xEF\xBB\xBF# points\r\nnz,x,y,z,nx,ny,id,on\r\n\r\n1, 0.1 ,+2,3e-1,0,0,\"a \"\"b\"\", "
      "c\",floor:2\r\n-1,1,1,1,0,0,,\r\n");
  ASSERT_EQ(receivers.size(), 2U);
  EXPECT_EQ(receivers[0].id, "a \"b\", c");
  EXPECT_EQ(receivers[0].point, (Vec3{0.1, 2, 0.3}));
  EXPECT_EQ(receivers[0].on, std::vector{FaceId{1}});
  EXPECT_EQ(receivers[1].id, "2");
  EXPECT_TRUE(receivers[1].on.empty());
}

TEST_F(ReceiverFile, MayHaveSemicolonsAndDecimalCommas) {
  EXPECT_EQ(read("x;y;z;nx;ny;nz\n1,5;2;3e-1;0;0;1\n")[0].point, (Vec3{1.5, 2, 0.3}));
  EXPECT_EQ(fault("x;y;z;nx;ny;nz\n1,5;2.5;3;0;0;1\n"),
            "2: '2.5' has a decimal point, and a number above it a decimal comma, in column y");
}

TEST_F(ReceiverFile, FaultsNameTheLineAndWhatIsWrong) {
  const std::string head = "id,x,y,z,nx,ny,nz,on\n";
  EXPECT_EQ(fault(""), "0: the file has no header");
  EXPECT_EQ(fault("id,x,y,z,nx,ny\n"), "1: there is no column 'nz'");
  EXPECT_EQ(fault("id,x,y,z,nx,ny,nz,onn\n"), "1: unknown column 'onn'");
  EXPECT_EQ(fault("x,y,z,nx,ny,nz,x\n"), "1: column 'x' occurs twice");
  EXPECT_EQ(fault(head + "a,1,2,3,0,0,1\n"), "2: 7 fields where the header has 8");
  EXPECT_EQ(fault(head + "\n# c\na,1,2,three,0,0,1,\n"), "4: 'three' is not a number in column z");
  EXPECT_EQ(fault(head + "a,1,2,1e999,0,0,1,\n"), "2: '1e999' is too large for a double in column z");
  EXPECT_EQ(fault(head + "a,1,2,3,0,0,-0.0,\n"), "2: the normal is zero");
  EXPECT_EQ(fault(head + "a,1,2,3,0,0,1,floor\n"), "2: 'floor' has 2 faces");
  EXPECT_EQ(fault(head + "\"a,1,2,3,0,0,1,\n"), "2: a quotation mark is not closed, or text follows it");
  EXPECT_EQ(fault(head + "a,1,2,3,0,0,1,\na,1,2,4,0,0,1,\n"), "3: the id 'a' is used twice");
}

// One receiver per receiver of the truth file, however its rows are sorted.
TEST_F(ReceiverFile, MayBeATruthFile) {
  const std::string head =
      "# exactff 0.1.0 truth\nreceiver,on,x,y,z,nx,ny,nz,ux,uy,uz,source,exact,lower,upper,unoccluded,visible_fraction,"
      "radiosity_r,radiosity_g,overcast,largest_rho_b,status\n";
  const std::string rest = ",0.5,0.4,0.6,0.5,1,1,1,1,1,certified\n";
  const std::string a = "\"1,1\",floor:2,1,2,3,0,0,2,0,0,1,", b = "r2c1,,4,5,6,1,0,0,1,0,0,";
  for (const std::string& rows : {a + "lamp" + rest + a + "sky" + rest + b + "lamp" + rest + b + "sky" + rest,
                                  a + "lamp" + rest + b + "lamp" + rest + a + "sky" + rest + b + "sky" + rest}) {
    const auto receivers = read(head + rows);
    ASSERT_EQ(receivers.size(), 2U);
    EXPECT_EQ(receivers[0].id, "1,1");
    EXPECT_EQ(receivers[0].on, std::vector{FaceId{1}});
    EXPECT_EQ(receivers[0].normal, (Vec3{0, 0, 2})) << "the values belong to this normal, not to the unit normal";
    EXPECT_EQ(receivers[1].id, "r2c1");
    EXPECT_EQ(receivers[1].point, (Vec3{4, 5, 6}));
  }
  const std::string moved = "\"1,1\",floor:2,1,2,4,0,0,2,0,0,1,";
  EXPECT_EQ(fault(head + a + "lamp" + rest + moved + "sky" + rest), "4: the id '1,1' is used twice");
  EXPECT_EQ(fault("id,x,y,z,nx,ny,nz,exact\n"), "1: unknown column 'exact'") << "not a truth file";
}

// --- Receivers at vertices, at centres and at random points of faces ---

std::vector<Receiver> vertices_of(const Scene& scene) { return vertex_receivers(scene, every_face(scene)); }
std::vector<Receiver> centres_of(const Scene& scene) { return centre_receivers(scene, every_face(scene)); }
Vec3 centre_of(const Polygon& face) { return centres_of(scene_of({face})).at(0).point; }

TEST(VertexReceivers, LieExactlyOnTheCornersWithTheNormalOfTheFace) {
  const Scene scene = scene_of({polygon({{0.1, 0.2, 0}, {0.7, 0.2, 0}, {0.7, 0.9, 0}}, "floor")});
  const auto receivers = vertices_of(scene);
  ASSERT_EQ(receivers.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(receivers[i].point, scene.vertices()[i]);
    EXPECT_EQ(receivers[i].normal, scene.faces()[0].newell);
    EXPECT_EQ(receivers[i].on, std::vector{FaceId{0}});
  }
  EXPECT_EQ(ids_of(receivers), (std::vector<std::string>{"floor:1/1", "floor:1/2", "floor:1/3"}));
}

TEST(CentreReceivers, RememberTheFaceAndCarryItsNewellVector) {
  const auto receivers = centres_of(scene_of({polygon({{0, 0, 0}, {0, 2, 0}, {0, 2, 3}, {0, 0, 3}}, "wall")}));
  ASSERT_EQ(receivers.size(), 1U);
  EXPECT_EQ(receivers[0].point, (Vec3{0, 1, 1.5}));
  EXPECT_EQ(receivers[0].normal, (Vec3{6, 0, 0}));
  EXPECT_EQ(receivers[0].on, std::vector{FaceId{0}});
  EXPECT_EQ(receivers[0].id, "wall:1");
}

TEST(CentreReceivers, AnLHasTheCentroidOfItsArea) { EXPECT_EQ(centre_of(letter_l()), (Vec3{5.0 / 6.0, 5.0 / 6.0, 0})); }

// A star around the origin with random radii, and a smaller copy of it as a hole.
Polygon random_star(std::mt19937_64& random, bool holed) {
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const std::uint32_t corners = 5 + static_cast<std::uint32_t>(random() % 20);
  Polygon star;
  star.rings.resize(holed ? 2 : 1);
  std::vector<Vec3> outer;
  for (std::uint32_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.9 * uniform()) / corners, radius = 0.05 + uniform();
    outer.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    star.rings[0].push_back(i);
    if (holed) star.rings[1].push_back(corners + i);
  }
  star.vertices = outer;
  for (const Vec3& v : outer) star.vertices.push_back({0.6 * v.x, 0.6 * v.y, 0});
  return star;
}

// Exact test for a point in the plane z = 0: an odd number of edges crosses the line from it towards larger x.
bool within_rings(const Polygon& polygon, const Vec3& p) {
  bool inside = false;
  for (const Ring& ring : polygon.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 &a = polygon.vertices[ring[i]], &b = polygon.vertices[ring[(i + 1) % ring.size()]];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if ((kernel::orientation(a, b, p, {a.x, a.y, 1}) > 0) == (b.y > p.y)) inside = !inside;
    }
  }
  return inside;
}

TEST(CentreReceivers, AndSamplesLieInsideRandomFaces) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 60; ++i) {
    const Polygon star = random_star(random, i % 2 == 0);
    const Scene scene = scene_of({star});
    EXPECT_TRUE(within_rings(star, centres_of(scene).at(0).point)) << i;
    for (const Receiver& r : samples_of(scene, 20)) EXPECT_TRUE(within_rings(star, r.point)) << i;
  }
}

// The centre of its bilinear patch, (1/2, 1/2, 1/4), is put on the fold between its triangles along (-1, -1, 2).
// Rounding leaves it behind neither.
TEST(CentreReceivers, ANonPlanarQuadrilateralHasItsCentreOnATriangle) {
  const Scene scene = scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}})});
  const Receiver centre = centres_of(scene).at(0);
  for (const double c : {centre.point.x, centre.point.y, centre.point.z}) EXPECT_NEAR(c, 5.0 / 12.0, 0x1p-48);
  EXPECT_GE(centre.point.z, std::max(centre.point.x, centre.point.y));
  EXPECT_TRUE(centre.normal == (Vec3{0, -0.5, 0.5}) || centre.normal == (Vec3{-0.5, 0, 0.5}));
}

// --- Receivers at random points of faces ---

TEST(SampleReceivers, AreTheSameOnEveryMachine) {
  // From a separate computation with Python's integers and a separate implementation of Matsumoto and Nishimura's
  // generator.
  const Scene scene =
      scene_of({polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), polygon({{0, 0, 2}, {3, 0, 2.5}, {3, 1, 2.5}, {0, 1, 2}})});
  const auto receivers = samples_of(scene, 6, 42);
  EXPECT_EQ(receivers[0].point, (Vec3{0x1.4babd9a0b0d7cp+1, 0x1.ebc13264515e2p-1, 0x1.37474ef01d795p+1}));
  EXPECT_EQ(receivers[1].point, (Vec3{0x1.187273d8bae7fp-2, 0x1.8fa32b81059dfp-2, 0}));
  EXPECT_EQ(receivers[4].point, (Vec3{0x1.0f714d13ed6aep-1, 0x1.c8e7d9eeb4942p-2, 0}));
  EXPECT_EQ(receivers[5].point, (Vec3{0x1.03ad44e185a1cp+1, 0x1.d9bd4cdf31f72p-1, 0x1.2b478b7aeb9afp+1}));
  EXPECT_EQ(receivers[4].on, std::vector{FaceId{0}});
  EXPECT_EQ(receivers[5].on, std::vector{FaceId{1}});
}

}  // namespace
}  // namespace exactff
