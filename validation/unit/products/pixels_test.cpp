// Images of other programs: files, whole and damaged; visible points; the values of their pixels; comparisons.
#include "check/report.h"
#include "files/numpy.h"
#include "support/test.h"

namespace exactff {
namespace {

using exr::ExrFile;
using exr::Image;
using exr::Kind;
using exr::Mark;
using exr::Numbers;
using exr::Window;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void add_channel(Image& image, const std::string& name, const std::vector<float>& values) {
  Numbers& channel = image.channels.emplace_back(Numbers{name, Kind::kFloat, {}});
  for (const float value : values) channel.bits.push_back(std::bit_cast<std::uint32_t>(value));
}

void add_layer(Image& image, const std::string& name, const std::vector<Vec3>& values) {
  for (const auto& [letter, part] : {std::pair{"X", &Vec3::x}, {"Y", &Vec3::y}, {"Z", &Vec3::z}}) {
    std::vector<float> numbers;
    for (const Vec3& value : values) numbers.push_back(static_cast<float>(value.*part));
    add_channel(image, name + '.' + letter, numbers);
  }
}

Image gbuffer_image(const Window& window, const std::vector<Vec3>& points, const std::vector<Vec3>& normals) {
  Image image{window, {0, 0, 8, 8}, {}, {}};
  add_layer(image, "position", points);
  add_layer(image, "normal", normals);
  return image;
}

// What reading the bytes says if they are refused.
std::string refusal(const std::string& bytes, const std::function<void(const ExrFile&)>& use = {}) {
  return complaint([&] {
    const ExrFile file(bytes, "a.exr");
    if (use) use(file);
  });
}

std::string refusal_of_points(const std::string& bytes, const exr::GBufferLayers& layers = {}) {
  return refusal(bytes, [&](const ExrFile& file) { (void)exr::read_gbuffer(file, layers); });
}

// Little-endian bytes of the value of an attribute are replaced.
std::string with_value(std::string bytes, const std::string& attribute, std::size_t skipped,
                       const std::vector<std::int32_t>& numbers) {
  const std::size_t at = bytes.find(attribute) + attribute.size() + skipped;
  std::memcpy(bytes.data() + at, numbers.data(), 4 * numbers.size());
  return bytes;
}

TEST(ExrFile, GivesBackEveryBit) {
  Image image{{-3, 5, 2, 3}, {0, 0, 9, 9}, {}, {{"key", "value"}}};
  const std::vector<float> numbers = {0.1F, -0.0F, kNan, 1e-45F, std::numeric_limits<float>::infinity(), 7.0F};
  add_channel(image, "view.depth.Z", numbers);
  image.channels.push_back({"id", Kind::kWhole, {1, 2, 3, 4, 5, 70000}});
  const ExrFile file(exr::exr_of(image), "a.exr");
  ASSERT_EQ(file.channels().size(), 2U);
  EXPECT_EQ(file.channels()[0].name, "id");
  EXPECT_EQ(file.channels()[0].kind, Kind::kWhole);
  EXPECT_EQ(file.data_window(file.channels()[0]), image.data);
  EXPECT_EQ(file.display_window(file.channels()[0]), image.display);
  const auto read = file.read(file.channels());
  EXPECT_EQ(read[0][5], 70000.0F);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(read[1][i]), std::bit_cast<std::uint32_t>(numbers[i])) << i;
  }
  EXPECT_EQ(exr::name_of_pixel(image.data, 3), "x-2y6");
}

TEST(ExrFile, RefusesWhatItsBytesCannotHold) {
  Image image{{0, 0, 2, 2}, {0, 0, 2, 2}, {}, {}};
  add_channel(image, "R", {1, 2, 3, 4});
  const std::string sound = exr::exr_of(image);
  EXPECT_EQ(refusal(sound), "");
  const std::string window(std::string("dataWindow\0box2i\0", 17));
  EXPECT_HOLDS(refusal(with_value(sound, window, 4, {0, 0, 60000, 60000})), "more pixels than its bytes can hold");
  EXPECT_HOLDS(refusal(with_value(sound, window, 4, {0, 0, 0, 10'000'000})), "more pixels");
  EXPECT_HOLDS(refusal(with_value(sound, window, 4, {5, 0, 1, 1})), "is empty");
  EXPECT_HOLDS(refusal(with_value(sound, window, 4, {-2147483647, 0, 2147483647, 1})), "too far away");
  EXPECT_HOLDS(refusal(with_value(sound, window, 0, {2'000'000'000})), "cut off or damaged");
  EXPECT_HOLDS(refusal(with_value(sound, window, 0, {-1})), "cut off or damaged");
  EXPECT_HOLDS(refusal("GIF89a"), "is no OpenEXR file");
}

// Neither a crash nor a hang: either an InputError, or numbers.
TEST(ExrFile, SurvivesEveryCutAndEveryChangedByte) {
  const Image image = gbuffer_image({0, 0, 2, 1}, {{1, 2, 3}, {4, 5, 6}}, {{0, 0, 1}, {0, 0, 1}});
  const std::string sound = exr::exr_of(image);
  const auto use = [](const ExrFile& file) { (void)file.read(file.channels()); };
  for (std::size_t size = 0; size < sound.size(); ++size) EXPECT_NE(refusal(sound.substr(0, size), use), "") << size;
  for (std::size_t at = 0; at < sound.size(); ++at) {
    for (const int change : {0x01, 0x80, 0xFF}) {
      std::string changed = sound;
      changed[at] = static_cast<char>(changed[at] ^ change);
      (void)refusal(changed, use);
    }
  }
}

TEST(GBuffer, LeavesOutPixelsThatHitNothing) {
  const float infinity = std::numeric_limits<float>::infinity();
  Image image =
      gbuffer_image({4, 2, 3, 2}, {{1, 2, 3}, {1, 2, kNan}, {1, 2, 3}, {1, infinity, 3}, {1, 2, 3}, {0, 0, 0}},
                    {{0, 0, 1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 1}, {0, 0, 1}, {0, -2, 0}});
  add_channel(image, "A", {1, 1, 1, 1, 0, 0.5F});
  const auto gbuffer = exr::read_gbuffer(ExrFile(exr::exr_of(image), "a.exr"));
  EXPECT_EQ(gbuffer.frame.pixels, (std::vector<std::uint32_t>{0, 5}));
  EXPECT_EQ(gbuffer.frame.count(Mark::kNothing), 4U);
  ASSERT_EQ(gbuffer.receivers.size(), 2U);
  EXPECT_EQ(gbuffer.receivers[0].id, "x4y2");
  EXPECT_EQ(gbuffer.receivers[1].id, "x6y3");
  EXPECT_EQ(gbuffer.receivers[1].normal, (Vec3{0, -2, 0}));
}

TEST(GBuffer, RefusesLayersThatAreMissingOrTooCoarse) {
  Image image{{0, 0, 1, 1}, {0, 0, 1, 1}, {}, {}};
  add_layer(image, "v.Positions", {{1, 2, 3}});
  add_layer(image, "v.Normal", {{0, 0, 1}});
  const std::string bytes = exr::exr_of(image);
  EXPECT_HOLDS(refusal_of_points(bytes), "has no layer called position or P");
  EXPECT_HOLDS(refusal_of_points(bytes), "did you mean --position-layer 'v.Positions'?");
  EXPECT_EQ(refusal_of_points(bytes, {.position = "Positions"}), "");
  add_layer(image, "w.Normal", {{0, 0, 1}});
  EXPECT_HOLDS(refusal_of_points(exr::exr_of(image), {.position = "Positions"}),
               "has several layers called normal or N");
  Image dark = gbuffer_image({0, 0, 1, 1}, {{1, 2, 3}}, {{0, 0, 0}});
  EXPECT_HOLDS(refusal_of_points(exr::exr_of(dark)), "no pixel hits anything");
  // The kind of a channel: after its name, in 4 bytes; a half has 2 bytes a pixel, which the pixels then lack.
  const std::string sound = exr::exr_of(gbuffer_image({0, 0, 1, 1}, {{1, 2, 3}}, {{0, 0, 1}}));
  EXPECT_HOLDS(refusal_of_points(with_value(sound, std::string("normal.X\0", 9), 0, {1})), "has half floats");
  EXPECT_HOLDS(refusal_of_points(with_value(sound, std::string("normal.X\0", 9), 0, {1})), "savefp16");
  const std::string compression("compression\0compression\0", 24);
  std::string coarse = sound;
  coarse[coarse.find(compression) + 28] = 5;  // PXR24
  EXPECT_HOLDS(refusal_of_points(coarse), "a compression with loss");
}

// A floor at z = 1/10, which no 32-bit number is, below a lamp at z = 2.
Scene room() {
  std::istringstream obj(
      "v 0 0 .1\nv 4 0 .1\nv 4 4 .1\nv 0 4 .1\nv 1 1 2\nv 3 1 2\nv 3 3 2\nv 1 3 2\n"
      "g floor\nf 1 2 3 4\ng lamp\nf 8 7 6 5\n");
  return read_obj(obj, "room.obj");
}

exr::GBuffer points_of(const std::vector<Vec3>& points, const std::vector<Vec3>& normals) {
  const Window window{0, 0, static_cast<int>(points.size()), 1};
  return exr::read_gbuffer(ExrFile(exr::exr_of(gbuffer_image(window, points, normals)), "a.exr"));
}

TEST(GBuffer, PlacesRoundedPointsOnTheirFaces) {
  const Scene scene = room();
  auto gbuffer = points_of({{1, 1, .1}, {2, 2, .1}, {3, 1, .5}, {3, 1, .1}, {2, 2, 2}},
                           {{0, 0, 1}, {.1, 0, 1}, {0, 0, 1}, {0, 0, -1}, {0, 0, -1}});
  ASSERT_NE(gbuffer.receivers[0].point.z, 0.1);
  exr::place_on_faces(scene, gbuffer);
  const std::vector<Mark> expected = {Mark::kExact, Mark::kShadingNormal, Mark::kNoFace, Mark::kExact, Mark::kExact};
  EXPECT_EQ(gbuffer.frame.marks, expected);
  EXPECT_EQ(gbuffer.frame.pixels, (std::vector<std::uint32_t>{0, 1, 3, 4}));
  std::vector<std::string> on;
  for (const Receiver& receiver : gbuffer.receivers) on.push_back(receiver.id + ' ' + scene.name_of(receiver.on));
  EXPECT_EQ(on, (std::vector<std::string>{"x0y0 floor", "x1y0 floor", "x3y0 floor", "x4y0 lamp"}));
  const auto warnings = exr::warnings_of(gbuffer);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_HOLDS(warnings[0].what, "1 of 5 pixels");
}

TEST(GBuffer, RecognisesAnotherCoordinateSystem) {
  const Scene scene = room();
  auto gbuffer = points_of({{1, 1, 5}, {2, 2, 6}, {3, 1, .1}}, {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}});
  const std::string said = complaint([&] { exr::place_on_faces(scene, gbuffer); });
  EXPECT_HOLDS(said, "the points of 2 of 3 pixels lie on no face");
  EXPECT_HOLDS(said, "every z is positive, as in camera space");
  EXPECT_HOLDS(said, "coordinatesystem");
  EXPECT_NO_THROW(exr::place_on_faces(scene, gbuffer, 10.0));
}

// The totals are the last fields but their status.
std::vector<Rgb> totals_of(const truth::Request& request) {
  std::stringstream table;
  truth::write(request, table);
  std::vector<Rgb> totals;
  for (std::string line; std::getline(table, line);) {
    if (line.starts_with('#') || line.starts_with("receiver,")) continue;
    std::size_t at = line.rfind(',');
    Rgb& total = totals.emplace_back();
    for (double Rgb::*c : {&Rgb::b, &Rgb::g, &Rgb::r}) {
      at = line.rfind(',', at - 1);
      total.*c = std::stod(line.substr(at + 1));
    }
  }
  return totals;
}

truth::Request request_of(const Scene& scene, std::vector<Receiver> receivers, std::vector<Selection> sources) {
  truth::Request request;
  request.scene = &scene;
  request.scene_name = "scene";
  request.receivers = std::move(receivers);
  request.receivers_name = "receivers";
  request.sources = std::move(sources);
  request.total = Quantity::kFormFactor;
  request.threads = 1;
  return request;
}

TEST(TruthTotals, AreThoseOfTheFace) {
  std::istringstream obj(
      "mtllib a.mtl\nv 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 2\nv 3 1 2\nv 3 3 2\nv 1 3 2\n"
      "usemtl floor\ng floor\nf 1 2 3 4\nusemtl lamp\ng lamp\nf 8 7 6 5\n");
  const TemporaryDirectory directory;
  (void)directory.write("a.mtl", "newmtl floor\nKd .5 .25 1\nnewmtl lamp\nKd .5 .5 .5\nKe 8 4 2\n");
  const Scene scene = read_obj(directory.write("a.obj", obj.str()));
  const Receiver floor{{1, 1, 0}, {0, 0, 1}, {scene.faces_of(scene.select("floor")).front()}, "a", {}};
  const FaceId lamp = scene.faces_of(scene.select("lamp")).front();
  const double f = exact_form_factor(scene, floor, ExactSource(scene, scene.select("lamp"))).value;
  ASSERT_GT(f, 0.0);
  truth::Request request = request_of(scene, {floor}, {});
  const auto total = [&](Quantity quantity, KeMeans ke) {
    request.total = quantity;
    request.ke = ke;
    return totals_of(request).front();
  };
  EXPECT_EQ(total(Quantity::kRadiosity, KeMeans::kRadiosity), (Rgb{4 * f, f, 2 * f}));  // powers of two are exact
  EXPECT_EQ(total(Quantity::kRadiance, KeMeans::kRadiance), (Rgb{4 * f, f, 2 * f}));
  EXPECT_EQ(total(Quantity::kIrradiance, KeMeans::kRadiosity), (Rgb{8 * f, 4 * f, 2 * f}));
  EXPECT_NEAR(total(Quantity::kRadiance, KeMeans::kRadiosity).g, f / 3.14159265358979, 1e-14);
  request.receivers = {{{2, 2, 2}, {0, 0, -1}, {lamp}, "front", {}}, {{2, 2, 2}, {0, 0, 1}, {lamp}, "back", {}}};
  request.total = Quantity::kRadiosity;
  request.ke = KeMeans::kRadiosity;
  const std::vector<Rgb> of_lamp = totals_of(request);
  EXPECT_EQ(of_lamp[0], (Rgb{8, 4, 2}));  // it emits to its front
  EXPECT_EQ(of_lamp[1], (Rgb{0, 0, 0}));
}

TEST(TruthTotals, AreInEveryFile) {
  const TemporaryDirectory directory;
  const Scene scene = room();
  const auto path = [&](const std::string& name) { return directory.path() / name; };
  truth::Request request = request_of(scene, grid_receivers(scene, scene.select("floor"), {9, 9}),
                                      {scene.select("lamp"), scene.select("floor")});
  truth::write(request, path("whole.csv"));
  truth::write_npy(path("whole.csv"), path("a.npy"));
  const std::string npy = text_of(path("a.npy"));
  EXPECT_HOLDS(npy, "(81, 5)");
  const std::vector<Rgb> totals = totals_of(request);
  const std::size_t head = npy.size() - 81 * 5 * sizeof(double);
  for (std::size_t i = 0; i < 81; ++i) {
    std::array<double, 5> row{};
    std::memcpy(row.data(), npy.data() + head + i * sizeof row, sizeof row);
    EXPECT_EQ(row[2], totals[2 * i].r);
    EXPECT_EQ(row[2], row[0] + row[1]);  // the floor does not see itself
  }
  truth::write_vtk(request, path("whole.csv"), path("a.vtp"));
  EXPECT_HOLDS(text_of(path("a.vtp")), "Name=\"total\"");
  const auto truth = check::read_truth(path("whole.csv"), "total_g");
  EXPECT_EQ(truth.rows.size(), 81U);
  EXPECT_EQ(truth.rows[80].value, totals[160].g);
}

// Through the whole way: points in an image, faces, a truth file, an image of values.
TEST(TruthTotals, AreInThePixelsOfTheirPoints) {
  std::size_t seen = 0;
  for (const validation::RandomFamily& family : validation::random_families()) {
    SCOPED_TRACE(family.name);
    Random random(validation::seed_of(1));
    const PlainScene plain = family.make(random);
    const Scene scene = generate::build(plain);
    const Receiver& at = generate::receiver_of(plain);
    const std::vector<Vec3> points = {at.point, {0, 0, 0}, {1e30, 2, at.point.z}, at.point};
    Image image = gbuffer_image({-7, 3, 2, 2}, points, {at.normal, at.normal, {0, 0, 0}, at.normal});
    const auto gbuffer = [&] {
      try {
        return std::optional(exr::read_gbuffer(ExrFile(exr::exr_of(image), "a.exr")));
      } catch (const InputError&) {
        return std::optional<exr::GBuffer>();  // the normal or the points are beyond 32 bits
      }
    }();
    if (!gbuffer) continue;
    const TemporaryDirectory directory;
    const auto truth_file = directory.path() / "a.csv", exr = directory.path() / "a.exr";
    const Selection source = scene.select(plain.source);
    truth::write(request_of(scene, gbuffer->receivers, {source}), truth_file);
    truth::write_exr(gbuffer->frame, truth_file, exr);
    const ExrFile file(exr);
    const auto values = file.read(file.find("", ""));
    const auto marks = file.read(file.find("mark", ""));
    EXPECT_EQ(file.data_window(file.channels().front()), image.data);
    std::size_t next = 0;
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
      const bool has_value = next < gbuffer->frame.pixels.size() && gbuffer->frame.pixels[next] == pixel;
      EXPECT_EQ(marks[0][pixel], has_value ? 0.0F : 2.0F);
      EXPECT_EQ(std::isnan(values[0][pixel]), !has_value);
      if (!has_value) continue;
      const FormFactor f = exact_form_factor(scene, gbuffer->receivers[next++], ExactSource(scene, source));
      EXPECT_EQ(values[0][pixel], static_cast<float>(f.value));
      EXPECT_EQ(values[2][pixel], static_cast<float>(f.value));
      ++seen;
    }
  }
  EXPECT_GT(seen, 5U);
}

TEST(CheckImages, MatchesPixelsByTheirCoordinates) {
  const TemporaryDirectory directory;
  const auto write = [&](const std::string& name, const Window& window, const std::vector<float>& values) {
    Image image{window, {0, 0, 9, 9}, {}, {}};
    for (const char* channel : {"R", "G", "B"}) add_channel(image, channel, values);
    std::ofstream(directory.path() / name, std::ios::binary) << exr::exr_of(image);
    return directory.path() / name;
  };
  const auto truth = write("t.exr", {1, 1, 2, 2}, {1, 2, kNan, 4});
  const auto theirs = write("c.exr", {0, -1, 3, 4}, {8, 8, 8, 9, 9, 9, 9, 1, 2.5F, 9, 7, 4});
  const check::Images images = check::read_images(truth, theirs);
  EXPECT_EQ(images.truth.rows.size(), 9U);
  const check::Report report = check::judge(images.truth, images.values, {.relative_mse = 0.01, .per_source = true});
  EXPECT_EQ(report.overall.absolute.max, 0.5);
  EXPECT_EQ(report.sources, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(report.worst.front().receiver, "x2y1");
  EXPECT_DOUBLE_EQ(*report.overall.relative_mse, 0.25 / 4.01 / 3);
  EXPECT_FALSE(report.passed());
  const auto smaller = write("s.exr", {1, 1, 1, 2}, {1, 3});
  EXPECT_THROW((void)check::read_images(truth, smaller), InputError);
  EXPECT_EQ(check::read_images(truth, smaller, {}, true).values.size(), 3U);
  EXPECT_EQ(check::read_images(truth, theirs, {"G", "R"}).truth.sources, std::vector<std::string>{"G"});
  EXPECT_THROW((void)check::read_images(truth, theirs, {"G", ""}), InputError);
  EXPECT_TRUE(std::isnan(images.exact[6]));
  check::Truth table;
  table.sources = table.faces = {""};
  table.rows.emplace_back();
  const std::vector<check::Measured> values = {{0, 0, 0.0}};
  EXPECT_NO_THROW((void)check::judge(table, values, {.rms = 1.0}));
  EXPECT_THROW((void)check::judge(table, values, {.relative_mse = 1.0}), InputError);
}

// An array has no place of its own: it takes that of the other image. Doubles are compared as doubles.
TEST(CheckImages, TakesArraysOfNumPy) {
  const TemporaryDirectory directory;
  const auto array = [&](const std::string& name, const std::vector<std::size_t>& shape,
                         const std::vector<double>& values) {
    files::write_npy<double>(directory.path() / name, shape, values);
    return directory.path() / name;
  };
  Image image{{1, 1, 2, 1}, {0, 0, 3, 3}, {}, {}};
  for (const char* channel : {"R", "G", "B"}) add_channel(image, channel, {1, 2});
  const auto exr = directory.path() / "t.exr";
  std::ofstream(exr, std::ios::binary) << exr::exr_of(image);
  const double above = 1 + 0x1p-40;
  const auto data = array("d.npy", {1, 2, 3}, {1, 1, above, 2, 2, 2});
  const check::Images of_data = check::read_images(exr, data);
  EXPECT_EQ(check::judge(of_data.truth, of_data.values, {}).overall.absolute.max, 0x1p-40);
  std::vector<double> whole(27, 9.0);
  std::fill_n(whole.begin() + 3 * 4, 3, 1.0);  // x1y1
  std::fill_n(whole.begin() + 3 * 5, 3, 2.0);
  const auto display = array("w.npy", {3, 3, 3}, whole);
  for (const check::Images& images : {check::read_images(exr, display), check::read_images(data, exr)}) {
    EXPECT_EQ(images.window, (Window{1, 1, 2, 1}));
    EXPECT_EQ(images.truth.sources, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_LE(check::judge(images.truth, images.values, {}).overall.absolute.max, 0x1p-40);
  }
  EXPECT_EQ(check::read_images(data, data).truth.rows[3].receiver, "x1y0");
  const auto refusal = [&](const std::filesystem::path& candidate, const check::ImageLayers& layers = {}) {
    return complaint([&] { (void)check::read_images(exr, candidate, layers); });
  };
  EXPECT_HOLDS(refusal(array("a.npy", {1, 2, 4}, std::vector<double>(8))), "save array[:, :, :3]");
  EXPECT_HOLDS(refusal(array("f.npy", {6}, std::vector<double>(6))), "of the shape (6) (");
  EXPECT_HOLDS(refusal(data, {"", "R"}), "--value-column names a layer");
}

}  // namespace
}  // namespace exactff
