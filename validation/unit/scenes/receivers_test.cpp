// Grids of receivers and receiver files.
#include <gtest/gtest.h>

#include <string>

#include "exactff/receiver.h"
#include "exactff/scene_files.h"
#include "support/program.h"

namespace exactff {
namespace {

using Ring = std::vector<std::uint32_t>;

Scene one_face(const std::vector<Vec3>& vertices, std::vector<Ring> rings, BadFaces bad = BadFaces::kReject) {
  SceneBuilder builder("test", {bad, PatchMode::kGroups});
  for (const Vec3& v : vertices) builder.add_vertex(v);
  const MaterialId material = builder.add_material({});
  builder.add_face(builder.patch("face"), material, std::move(rings));
  return builder.build();
}

std::vector<Receiver> grid(const Scene& scene, int u, int v) {
  return grid_receivers(scene, scene.select("face"), {u, v});
}

TEST(GridReceivers, CentresOfARectangleAreExactAndURunsFastest) {
  const Scene scene = one_face({{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}}, {{0, 1, 2, 3}});
  const auto receivers = grid(scene, 2, 2);
  ASSERT_EQ(receivers.size(), 4U);
  EXPECT_EQ(receivers[0].point, (Vec3{1, 0.5, 0}));
  EXPECT_EQ(receivers[1].point, (Vec3{3, 0.5, 0}));
  EXPECT_EQ(receivers[2].point, (Vec3{1, 1.5, 0}));
  EXPECT_EQ(receivers[1].id, "r1c2");
  EXPECT_EQ(receivers[3].id, "r2c2");
}

TEST(GridReceivers, ATrapezoidIsMappedBilinearly) {
  // Centre of the single cell: the mean of the corners.
  const Scene scene = one_face({{0, 0, 0}, {8, 0, 0}, {5, 4, 0}, {3, 4, 0}}, {{0, 1, 2, 3}});
  EXPECT_EQ(grid(scene, 1, 1)[0].point, (Vec3{4, 2, 0}));
  // s = 1/4, t = 3/4: 3/16 p0 + 1/16 p1 + 3/16 p2 + 9/16 p3.
  EXPECT_EQ(grid(scene, 2, 2)[2].point, (Vec3{3.125, 3, 0}));
}

TEST(GridReceivers, ANonPlanarQuadrilateralHasItsCentreOnATriangle) {
  const Scene scene = one_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}}, {{0, 1, 2, 3}});
  const auto receivers = grid(scene, 1, 1);
  ASSERT_EQ(receivers.size(), 1U);
  const Vec3& point = receivers[0].point;  // (1/2, 1/2, 1/4), put on the fold between the triangles
  for (const double c : {point.x, point.y, point.z}) EXPECT_NEAR(c, 5.0 / 12.0, 0x1p-48);
  EXPECT_EQ(receivers[0].on, std::vector{FaceId{0}});
}

TEST(GridReceivers, AnotherFaceKeepsTheCentresInsideItsBoundingRectangle) {
  // An L: the quarter with large x and y is missing.
  const Scene scene =
      one_face({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, {{0, 1, 2, 3, 4, 5}});
  const auto receivers = grid(scene, 2, 2);
  ASSERT_EQ(receivers.size(), 3U);
  EXPECT_EQ(receivers[0].point, (Vec3{0.5, 0.5, 0}));
  EXPECT_EQ(receivers[1].point, (Vec3{1.5, 0.5, 0}));
  EXPECT_EQ(receivers[2].point, (Vec3{0.5, 1.5, 0}));
  EXPECT_EQ(receivers[2].id, "r2c1");
}

TEST(GridReceivers, ACentreOnAnEdgeOrACornerIsNotInside) {
  // Grid 4x4 of the same L has centres at odd quarters; 3x3 has (1, 1), the inner corner, and points on x = 1.
  const Scene scene =
      one_face({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, {{0, 1, 2, 3, 4, 5}});
  EXPECT_EQ(grid(scene, 4, 4).size(), 12U);
  EXPECT_EQ(grid(scene, 1, 1).size(), 0U);
  EXPECT_EQ(grid(scene, 3, 3).size(), 5U);
}

TEST(GridReceivers, HolesAreLeftOut) {
  const Scene scene = one_face({{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {1, 1, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}},
                               {{0, 1, 2, 3}, {4, 5, 6, 7}});
  const auto receivers = grid(scene, 3, 3);
  EXPECT_EQ(receivers.size(), 8U);
  for (const Receiver& receiver : receivers) EXPECT_NE(receiver.point, (Vec3{1.5, 1.5, 0}));
}

TEST(GridReceivers, TheRectangleFollowsTheFirstEdgeInItsPlane) {
  // A right triangle in the plane x = 7 whose first edge runs along +z; v = Newell x u.
  const Scene scene = one_face({{7, 0, 0}, {7, 0, 4}, {7, -4, 0}}, {{0, 1, 2}});
  const auto receivers = grid(scene, 4, 4);
  EXPECT_EQ(receivers.size(), 6U);  // strictly below the diagonal
  EXPECT_EQ(receivers[0].point, (Vec3{7, -0.5, 0.5}));
  EXPECT_EQ(receivers[1].point, (Vec3{7, -0.5, 1.5}));
  EXPECT_GT(receivers[0].normal.x, 0.0);
}

TEST(GridReceivers, ACountBelowOneIsRefused) {
  const Scene scene = one_face({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 1, 2}});
  EXPECT_THROW((void)grid(scene, 0, 4), InputError);
}

TEST(GridReceivers, KnowTheirCell) {
  const Scene scene = one_face({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  const Receiver receiver = grid(scene, 5, 5)[7];
  ASSERT_TRUE(receiver.cell.has_value());
  EXPECT_EQ(receiver.cell->column, 3);
  EXPECT_EQ(receiver.cell->row, 2);
  EXPECT_EQ(receiver.id, "r2c3");
  EXPECT_EQ(receiver.cell->lattice->size.u, 5);
  EXPECT_EQ(receiver.cell->lattice->width, 2.0);
  EXPECT_EQ(receiver.cell->lattice->height, 1.0);
}

TEST(GridReceivers, OnSeveralFacesIdsMayBeMadeUnique) {
  SceneBuilder builder("test");
  for (const Vec3& v : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}) builder.add_vertex(v);
  const MaterialId material = builder.add_material({});
  builder.add_face(builder.patch("slab"), material, {{0, 1, 2, 3}});
  builder.add_face(builder.patch("slab"), material, {{0, 1, 0}});  // a face without area does not count
  builder.add_face(builder.patch("slab"), material, {{3, 2, 1, 0}});
  const Scene scene = builder.build();
  const std::vector<FaceId> both = {FaceId{0}, FaceId{1}, FaceId{2}}, one = {FaceId{0}, FaceId{1}};
  const auto receivers = grid_receivers(scene, both, {2, 1}, GridIds::kUnique);
  ASSERT_EQ(receivers.size(), 4U);
  EXPECT_EQ(receivers[1].id, "slab:1/r1c2");
  EXPECT_EQ(receivers[2].id, "slab:3/r1c1");
  EXPECT_EQ(grid_receivers(scene, both, {2, 1})[2].id, "r1c1");
  EXPECT_EQ(grid_receivers(scene, one, {2, 1}, GridIds::kUnique)[1].id, "r1c2");
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

  const validation::TemporaryDirectory directory_;
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
      "radiosity_r,radiosity_g,radiosity_b,largest_rho_b,status\n";
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
  EXPECT_EQ(fault("receiver,x,y,z,nx,ny,nz,source,exact,exakt\n"), "1: unknown column 'exakt'");
}

}  // namespace
}  // namespace exactff
