// Files for ParaView of every family of random scenes, parsed by Python's XML parser. validation/vtk/vtk_test.py reads
// files with VTK.
#include "vtk/vtk.h"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <set>

#include "files/numpy.h"
#include "generate/plain_scene.h"
#include "support/program.h"
#include "support/random_scenes.h"

namespace exactff::vtk {
namespace {

namespace fs = std::filesystem;
using generate::Random;
using validation::RandomFamily;

std::vector<FaceId> faces_with_area(const Scene& scene) {
  std::vector<FaceId> faces;
  for (const Piece& piece : scene.pieces()) {
    if (faces.empty() || faces.back() != piece.face) faces.push_back(piece.face);
  }
  return faces;
}

// Cells of grids, points on faces, and the scene's own receiver.
std::vector<Receiver> receivers_of(const Scene& scene, const generate::PlainScene& plain) {
  const std::vector<FaceId> faces = faces_with_area(scene);
  std::vector<Receiver> receivers = grid_receivers(scene, faces, {3, 2});
  const std::vector<Receiver> centres = centre_receivers(scene, faces);
  receivers.insert(receivers.begin() + static_cast<std::ptrdiff_t>(receivers.size() / 2), centres.begin(),
                   centres.end());
  receivers.push_back(generate::receiver_of(plain));
  return receivers;
}

// Every bit pattern, NaN and infinity included.
std::vector<double> any_doubles(std::size_t count, Random& random) {
  std::vector<double> values(count);
  for (double& value : values) value = std::bit_cast<double>(random.bits());
  return values;
}

std::string parsed(const fs::path& folder) {
  return validation::run_program("/usr/bin/env", {"python3", "-B", EXACTFF_PARSE_VTK, folder.string()}).output;
}

void write_with_values(const fs::path& file, const generate::PlainScene& plain, Random& random) {
  const Scene scene = generate::build(plain);
  const std::vector<Receiver> receivers = receivers_of(scene, plain);
  const std::vector<double> values = any_doubles(receivers.size(), random);
  const Content content{&scene, receivers, {{"exact", 1, values}}, {plain.source}};
  for (const char* extension : {".vtp", ".vtu"}) write(content, fs::path(file) += extension);
  std::ofstream(fs::path(file) += ".f8", std::ios::binary) << files::little_endian(std::span(values));
}

// One run of the parser for all families: its start takes longer than the files of one.
TEST(VtkFiles, OfRandomScenesAreSoundXml) {
  const validation::TemporaryDirectory directory(validation::memory_folder());
  for (const RandomFamily& family : validation::random_families()) {
    for (std::uint64_t i = 0; i < validation::scaled_count(2); ++i) {
      Random random(validation::seed_of(i));
      const std::string name = std::string(family.name) + '_' + std::to_string(validation::seed_of(i));
      write_with_values(directory.path() / name, family.make(random), random);
    }
  }
  EXPECT_EQ(parsed(directory.path()), "");
}

class VtkWriter : public testing::Test {
 protected:
  static Scene square(double size) {
    SceneBuilder builder;
    const auto vertex = [&](double x, double y) { return builder.add_vertex({x, y, 0.0}); };
    const std::vector<std::uint32_t> ring = {vertex(0, 0), vertex(size, 0), vertex(size, size), vertex(0, size)};
    builder.add_face(builder.patch("floor"), builder.add_material({}), {ring});
    return builder.build();
  }
  [[nodiscard]] std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(directory_.path())) found.push_back(entry.path().filename());
    return found;
  }
  const validation::TemporaryDirectory directory_{validation::memory_folder()};
};

TEST_F(VtkWriter, LeavesNothingWhenItIsCancelledOrCannotWrite) {
  const Scene scene = square(1.0);
  const std::vector<Receiver> receivers = grid_receivers(scene, faces_with_area(scene), {2, 2});
  const Content content{&scene, receivers, {{"exact", 1, std::vector<double>(4)}}, {}};
  int polls = 0;
  EXPECT_THROW(write(content, directory_.path() / "map.vtp", {{}, [&] { return ++polls > 5; }}), Cancelled);
  fs::create_directory(directory_.path() / "map_scene.vtu.whole");  // the scene's file cannot be opened
  EXPECT_THROW(write(content, directory_.path() / "map.vtu"), InputError);
  EXPECT_EQ(files(), std::vector<fs::path>{"map_scene.vtu.whole"});
}

TEST_F(VtkWriter, AConvexOutlineCutsCells) {
  SceneBuilder builder;
  const std::vector<std::uint32_t> ring = {builder.add_vertex({0, 0, 0}), builder.add_vertex({1, 0, 0}),
                                           builder.add_vertex({0.25, 1, 0})};
  builder.add_face(builder.patch("floor"), builder.add_material({}), {ring});
  const Scene scene = builder.build();
  const std::vector<Receiver> receivers = grid_receivers(scene, faces_with_area(scene), {5, 5});
  const DataSet data = cells_of(scene, receivers, cell_order(receivers));
  ASSERT_EQ(data.ends.size(), receivers.size());
  double area = 0.0;
  std::int64_t begin = 0;
  std::set<std::int64_t> sizes;
  for (const std::int64_t end : data.ends) {
    const Vec3& first = data.points[static_cast<std::size_t>(data.corners[static_cast<std::size_t>(begin)])];
    for (std::int64_t k = begin + 1; k + 1 < end; ++k) {
      const Vec3& p = data.points[static_cast<std::size_t>(data.corners[static_cast<std::size_t>(k)])];
      const Vec3& q = data.points[static_cast<std::size_t>(data.corners[static_cast<std::size_t>(k) + 1])];
      const double twice = (p.x - first.x) * (q.y - first.y) - (p.y - first.y) * (q.x - first.x);
      EXPECT_GE(twice, 0.0);
      area += 0.5 * twice;
    }
    sizes.insert(end - begin);
    begin = end;
  }
  for (const Vec3& p : data.points) {
    EXPECT_LE(p.y, 4.0 * p.x + 1e-12);
    EXPECT_LE(p.y, (1.0 - p.x) / 0.75 + 1e-12);
  }
  EXPECT_GT(sizes.size(), 1U);
  EXPECT_LT(area, 0.5);  // cells whose centres lie outside are missing
  EXPECT_GT(area, 0.45);
}

TEST_F(VtkWriter, NamesFieldsAfterTheSourceOnlyIfThereAreSeveral) {
  const SourceValues one{"lamp", {0.5}, {0.5}, {0.5}, {0}, {}, {{1, 2, 3}}};
  std::vector<std::string> names;
  for (const Field& field : fields_of({one})) names.push_back(field.name);
  EXPECT_EQ(names, (std::vector<std::string>{"exact", "lower", "upper", "status", "radiosity"}));
  const std::vector<Field> two = fields_of({one, one});
  EXPECT_EQ(two.front().name, "exact (lamp)");
  EXPECT_EQ(two.back().name, "radiosity");
  EXPECT_EQ(std::get<std::vector<double>>(two.back().values), (std::vector<double>{2, 4, 6}));
}

}  // namespace
}  // namespace exactff::vtk
