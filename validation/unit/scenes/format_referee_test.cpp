// CGAL's readers of PLY, STL and OFF as referees: they share nothing with ours.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>

#include "exactff/scene_files.h"
#include "support/random_scenes.h"
#include "support/shapes.h"
#include "support/test.h"

namespace exactff {
namespace {

using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Points = std::vector<Point>;
using Polygons = std::vector<std::vector<std::size_t>>;

// A mesh of convex polygons in the plane and of triangles in space.
PlainScene mesh(Random& random, bool triangles_only) {
  PlainScene scene;
  for (int i = 0; i < 40; ++i) {
    const double x = random.between(-1, 1), y = random.between(-1, 1);
    scene.vertices.push_back({x, y, triangles_only ? random.between(-1, 1) : 0.0});
  }
  generate::PlainPatch& patch = scene.patch("default");
  for (int i = 0; i < 30; ++i) {
    generate::Ring ring;
    const std::size_t corners = triangles_only ? 3 : 3 + random.below(4);
    const std::uint32_t first = static_cast<std::uint32_t>(scene.vertices.size());
    for (std::size_t k = 0; k < corners; ++k) {
      const double angle = (static_cast<double>(k) + 0.9 * random.unit()) * 6.28 / static_cast<double>(corners);
      scene.vertices.push_back({std::cos(angle), std::sin(angle), 0.0});
      ring.push_back(triangles_only ? static_cast<std::uint32_t>(random.below(40))
                                    : first + static_cast<std::uint32_t>(k));
    }
    patch.faces.push_back({{ring}});
  }
  return scene;
}

using Corners = std::vector<std::array<double, 3>>;

std::vector<Corners> by_cgal(const Points& points, const Polygons& polygons) {
  std::vector<Corners> faces;
  for (const auto& polygon : polygons) {
    faces.emplace_back();
    for (const std::size_t v : polygon) faces.back().push_back({points.at(v).x(), points.at(v).y(), points.at(v).z()});
  }
  return faces;
}

// Vertices that the scene's builder has dropped as repetitions are not compared: the meshes have none.
std::vector<Corners> by_us(const Scene& scene) {
  std::vector<Corners> faces;
  for (const Face& face : scene.faces()) {
    faces.emplace_back();
    for (const std::uint32_t v : face.rings.front()) {
      const Vec3& p = scene.vertices()[v];
      faces.back().push_back({p.x, p.y, p.z});
    }
  }
  return faces;
}

template <class Read>
void compare(const Scene& scene, const char* name, Encoding encoding, const Read& read) {
  const std::string bytes = scene_files(scene, name, encoding).files.back().bytes;
  std::istringstream in(bytes, std::ios::binary);
  Points points;
  Polygons polygons;
  ASSERT_TRUE(read(in, points, polygons)) << name;
  const Scene ours = read_scene(bytes, name);
  EXPECT_EQ(by_us(ours), by_cgal(points, polygons)) << name;
}

bool read_ply(std::istream& in, Points& points, Polygons& polygons) { return CGAL::IO::read_PLY(in, points, polygons); }
bool read_stl(std::istream& in, Points& points, Polygons& polygons) { return CGAL::IO::read_STL(in, points, polygons); }
bool read_off(std::istream& in, Points& points, Polygons& polygons) { return CGAL::IO::read_OFF(in, points, polygons); }

TEST(FormatReferee, CgalReadsTheSamePolygons) {
  for (std::uint64_t i = 0; i < 20; ++i) {
    Random random(validation::seed_of(i));
    const Scene polygons = generate::build(mesh(random, false), {}, {.bad_faces = BadFaces::kSkip});
    compare(polygons, "s.ply", Encoding::kText, read_ply);
    compare(polygons, "s.ply", Encoding::kBinary, read_ply);
    compare(polygons, "s.off", Encoding::kText, read_off);
  }
}

TEST(FormatReferee, CgalReadsTheSameTriangles) {
  for (std::uint64_t i = 0; i < 20; ++i) {
    Random random(validation::seed_of(i));
    PlainScene plain = mesh(random, true);
    for (generate::PlainFace& face : plain.patches[0].faces) {  // CGAL drops triangles that use a vertex twice
      const auto& r = face.rings[0];
      if (r[0] == r[1] || r[1] == r[2] || r[2] == r[0]) face.rings[0] = {0, 1, 2};
    }
    const Scene triangles = generate::build(plain);
    compare(triangles, "s.stl", Encoding::kText, read_stl);
    compare(triangles, "s.stl", Encoding::kBinary, read_stl);
  }
}

}  // namespace
}  // namespace exactff
