// Files for ParaView of every family of random scenes, parsed by Python's XML parser. validation/vtk/vtk_test.py reads
// files with VTK.
#include "vtk/vtk.h"

#include "files/numpy.h"
#include "support/random_scenes.h"
#include "support/shapes.h"
#include "support/test.h"

namespace exactff::vtk {
namespace {

namespace fs = std::filesystem;
using validation::RandomFamily;

std::vector<FaceId> faces_with_area(const Scene& scene) {
  std::vector<FaceId> faces;
  for (const Piece& piece : scene.pieces()) {
    if (faces.empty() || faces.back() != piece.face) faces.push_back(piece.face);
  }
  return faces;
}

// Cells of grids, points on faces, and the scene's own receiver.
std::vector<Receiver> receivers_of(const Scene& scene, const PlainScene& plain) {
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
  return run_program("/usr/bin/env", {"python3", "-B", EXACTFF_PARSE_VTK, folder.string()}).output;
}

void write_with_values(const fs::path& file, const PlainScene& plain, Random& random) {
  const Scene scene = generate::build(plain);
  const std::vector<Receiver> receivers = receivers_of(scene, plain);
  const std::vector<double> values = any_doubles(receivers.size(), random);
  const Content content{&scene, receivers, {{"exact", 1, values}}, {plain.source}};
  for (const char* extension : {".vtp", ".vtu"}) write(content, fs::path(file) += extension);
  std::ofstream(fs::path(file) += ".f8", std::ios::binary) << files::little_endian(std::span(values));
}

// One run of the parser for all families: its start takes longer than the files of one.
TEST(VtkFiles, OfRandomScenesAreSoundXml) {
  const TemporaryDirectory directory(memory_folder());
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
  const TemporaryDirectory directory_{memory_folder()};
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

}  // namespace
}  // namespace exactff::vtk
