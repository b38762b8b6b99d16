#include "models/rooms.h"
#include "support/test.h"

namespace exactff::render {
namespace {

const Scene& cornell_box() {
  static const Scene scene = read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  return scene;
}

Camera cornell_camera() { return {.eye = {278, 273, -800}, .look = {278, 273, 0}, .fov = 39.3}; }

Request request(int width, int height) {
  return {.scene = &cornell_box(), .scene_name = "box", .view = View(cornell_camera(), {width, height})};
}

double value(const Picture& picture, int column, int row, std::size_t channel = 0) {
  return picture.values.at(3 * static_cast<std::size_t>(row * picture.size.width + column) + channel);
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(a, b, [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

TEST(View, RaysAreTheDocumentedDoubles) {
  const View view({.eye = {1, 2, 3}, .look = {4, 6, 15}, .up = {0, 2, 0}, .fov = 90.0}, {3, 2});
  // w = (3, 4, 12) / 13; the tangent of 45 degrees is 1.
  const double m = 12.0, x = 3 / m, y = 4 / m, z = 1.0, length = std::sqrt((x * x + y * y) + z * z);
  const Vec3 w{x / length, y / length, z / length};
  const Vec3 across{w.y * 0.0 - w.z * 1.0, w.z * 0.0 - w.x * 0.0, w.x * 1.0 - w.y * 0.0};
  const double most = std::abs(across.x);
  const Vec3 safe{across.x / most, across.y / most, across.z / most};
  const double size = std::sqrt((safe.x * safe.x + safe.y * safe.y) + safe.z * safe.z);
  const Vec3 a{safe.x / size, safe.y / size, safe.z / size};
  const Vec3 b{a.y * w.z - a.z * w.y, a.z * w.x - a.x * w.z, a.x * w.y - a.y * w.x};
  const double s = (2.0 * 0.5 - 3.0) / 2.0, r = (2.0 - 2.0 * 1.5) / 2.0;
  const Ray ray = view.ray(0.5, 1.5);
  EXPECT_EQ(ray.origin, (Vec3{1, 2, 3}));
  EXPECT_EQ(ray.direction.x, (w.x + s * a.x) + r * b.x);
  EXPECT_EQ(ray.direction.y, (w.y + s * a.y) + r * b.y);
  EXPECT_EQ(ray.direction.z, (w.z + s * a.z) + r * b.z);
}

TEST(View, ParallelRaysHaveTheHeightOfThePicture) {
  const View view({.eye = {0, 0, 10}, .ortho = 8.0}, {4, 4});
  EXPECT_EQ(view.ray(0.0, 0.0).origin, (Vec3{-4, 4, 10}));
  EXPECT_EQ(view.ray(4.0, 4.0).origin, (Vec3{4, -4, 10}));
  EXPECT_EQ(view.ray(1.0, 3.0).direction, (Vec3{0, 0, -1}));
}

TEST(View, RefusesCamerasWithoutAPicture) {
  const auto expect_refused = [](const Camera& camera, const Size& size, const char* why) {
    EXPECT_HOLDS(complaint([&] { View(camera, size); }), why);
  };
  const Camera good = cornell_camera();
  const auto with = [&](const auto& change) {
    Camera camera = good;
    change(camera);
    return camera;
  };
  expect_refused(good, {0, 5}, "the picture is 0x5 pixels");
  expect_refused(good, {65537, 5}, "between 1 and 65536");
  expect_refused(with([](Camera& c) { c.look = c.eye; }), {4, 4}, "are the same");
  expect_refused(with([](Camera& c) { c.up = {0, 0, -3}; }), {4, 4}, "parallel to the line of sight");
  for (const double fov : {0.0, 180.0, -5.0, std::nan("")}) {
    expect_refused(with([&](Camera& c) { c.fov = fov; }), {4, 4}, "angle of view");
  }
  expect_refused(with([](Camera& c) { c.eye.x = std::nan(""); }), {4, 4}, "not finite");
  expect_refused({.eye = {0, 0, -1.7e308}, .look = {0, 0, 1.7e308}}, {4, 4}, "too far apart");
}

TEST(Picture, HoldsWhatOneReceiverReceives) {
  Request one = request(32, 32);
  one.quantity = Quantity::kRadiosity;
  const Picture picture = render(one);
  const ExactSource light(cornell_box(), cornell_box().select("light"));
  int compared = 0;
  for (int row = 0; row < 32; row += 3) {
    for (int column = 0; column < 32; column += 3) {
      const auto hit = first_hit(cornell_box(), one.view.ray(column + 0.5, row + 0.5));
      if (!hit || cornell_box().face(hit->face).patch == cornell_box().select("light").patch) continue;
      const Receiver receiver = receiver_at(cornell_box(), *hit);
      const double f = exact_form_factor(cornell_box(), receiver, light).value;
      const Rgb rho = cornell_box().receiver_reflectance(receiver.on);
      EXPECT_NEAR(value(picture, column, row, 0), rho.r * 17 * f, 1e-15 * rho.r * 17);
      EXPECT_NEAR(value(picture, column, row, 2), rho.b * 4 * f, 1e-15 * rho.b * 4);
      if (f > 0.0) ++compared;
    }
  }
  EXPECT_GT(compared, 50);
}

TEST(Picture, QuantitiesAgree) {
  Request asked = request(16, 16);
  const Picture radiance = render(asked);
  asked.quantity = Quantity::kRadiosity;
  const Picture radiosity = render(asked);
  asked.quantity = Quantity::kIrradiance;
  const Picture irradiance = render(asked);
  asked.quantity = Quantity::kFormFactor;
  const Picture factor = render(asked);
  asked.quantity = Quantity::kRadiance;
  asked.ke = KeMeans::kRadiance;
  const Picture bright = render(asked);
  for (std::size_t i = 0; i < radiance.values.size(); ++i) {
    if (std::isnan(radiance.values[i])) continue;
    const double b = radiosity.values[i];
    EXPECT_NEAR(radiance.values[i], b / std::numbers::pi, 1e-15 * b);
    EXPECT_EQ(bright.values[i], b);  // pi Ke / pi
    const double ke = i % 3 == 0 ? 17 : i % 3 == 1 ? 12 : 4;
    EXPECT_NEAR(irradiance.values[i], ke * factor.values[i], 1e-15 * ke);
  }
}

TEST(Picture, TheSlopeIsTheGradientAlongTheSurface) {
  Request one = request(24, 24);
  one.shown = Shown::kSlope;
  const Picture picture = render(one);
  ASSERT_EQ(picture.layers.size(), 4U);
  EXPECT_EQ(picture.layers[0].name, "gradient.X");
  const ExactSource light(cornell_box(), cornell_box().select("light"));
  int compared = 0;
  for (int row = 0; row < 24; ++row) {
    for (int column = 0; column < 24; ++column) {
      const auto hit = first_hit(cornell_box(), one.view.ray(column + 0.5, row + 0.5));
      if (!hit || cornell_box().name_of(hit->face) != "floor") continue;  // its normal is y
      const Receiver receiver = receiver_at(cornell_box(), *hit);
      const Gradient gradient = *exact_form_factor(cornell_box(), receiver, light, {.gradient = true}).gradient;
      const auto pixel = static_cast<std::size_t>(row * 24 + column);
      EXPECT_EQ(picture.layers[3].values[pixel], gradient.kink ? 1.0 : 0.0);
      if (gradient.kink) continue;
      const double x = gradient.position[0].value, z = gradient.position[2].value;
      EXPECT_EQ(picture.layers[0].values[pixel], x);
      EXPECT_EQ(picture.layers[1].values[pixel], 0.0);
      EXPECT_NEAR(value(picture, column, row), std::hypot(x, z), 1e-15 * std::hypot(x, z));
      ++compared;
    }
  }
  EXPECT_GT(compared, 20);
  one.bounds = Bounds::kAll;
  EXPECT_THROW((void)render(one), InputError);
}

TEST(Picture, DoesNotDependOnThreadsAndResumes) {
  const TemporaryDirectory directory;
  Request asked = request(40, 33);
  asked.bounds = Bounds::kAll;
  asked.layers = Layers::kAll;
  asked.threads = 1;
  const Picture one = render(asked);
  asked.threads = 3;
  const Picture three = render(asked);
  EXPECT_TRUE(same(one.values, three.values));
  EXPECT_EQ(exr_of(one), exr_of(three));
  // Stops after some tiles, and continues.
  jobs::Journal journal(directory.path() / "tiles", jobs::Existing::kRefuse);
  int asked_for = 0;
  asked.threads = 1;
  const Hooks stop{{}, [&] { return ++asked_for > 2500; }};
  EXPECT_THROW((void)render(asked, stop, &journal), Cancelled);
  const std::size_t kept = journal.size();
  EXPECT_GT(kept, 0U);
  const Picture resumed = render(asked, {}, &journal);
  EXPECT_GT(journal.size(), kept);
  EXPECT_TRUE(same(one.values, resumed.values));
  EXPECT_TRUE(same(one.lower, resumed.lower));
  for (std::size_t k = 0; k < one.layers.size(); ++k) {
    EXPECT_TRUE(same(one.layers[k].values, resumed.layers[k].values)) << one.layers[k].name;
  }
}

TEST(Picture, BoundsAreTheNeighbours) {
  Request asked = request(12, 12);
  asked.bounds = Bounds::kAll;
  const Picture picture = render(asked);
  int positive = 0;
  for (std::size_t i = 0; i < picture.values.size(); ++i) {
    const double v = picture.values[i];
    if (std::isnan(v)) continue;
    EXPECT_EQ(picture.lower[i], v == 0.0 ? 0.0 : std::nextafter(v, 0.0));
    EXPECT_EQ(picture.upper[i], v == 0.0 ? 0.0 : std::nextafter(v, 1e300));
    if (v > 0.0) ++positive;
  }
  EXPECT_GT(positive, 100);
}

TEST(Picture, SeveralPointsAreTheMeanOfAFinerPicture) {
  const Picture fine = render(request(30, 30));
  Request asked = request(10, 10);
  asked.spp = 3;
  asked.bounds = Bounds::kAll;
  const Picture coarse = render(asked);
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 10; ++column) {
      double sum = 0.0;
      bool any = false;
      for (int k = 0; k < 9; ++k) {
        const double part = value(fine, 3 * column + k % 3, 3 * row + k / 3);
        any = any || !std::isnan(part);
        sum += std::isnan(part) ? 0.0 : part;
      }
      const double mean = value(coarse, column, row);
      ASSERT_EQ(std::isnan(mean), !any);
      if (!any) continue;
      EXPECT_NEAR(mean, sum / 9.0, 1e-9 * mean);  // the rays differ by rounding
      const std::size_t at = 3 * static_cast<std::size_t>(10 * row + column);
      EXPECT_LE(coarse.lower[at], mean);
      EXPECT_GE(coarse.upper[at], mean);
    }
  }
}

// A square lamp above a square that looks down, and one that looks up.
Scene two_squares() {
  PlainScene plain;
  plain.materials.push_back({.name = "lamp", .reflectance = {0, 0, 0}, .radiosity = {2, 2, 2}});
  plain.add_ring(plain.patch("up"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  plain.add_ring(plain.patch("down"), {{2, 0, 0}, {2, 1, 0}, {3, 1, 0}, {3, 0, 0}});
  plain.patch("lamp").material = "lamp";
  plain.add_ring(plain.patch("lamp"), {{0, 0, 4}, {0, 1, 4}, {3, 1, 4}, {3, 0, 4}});
  return generate::build(plain);
}

TEST(Picture, BacksAreBlackUnlessFacesHaveTwoSides) {
  const Scene scene = two_squares();
  Request asked{.scene = &scene, .view = View({.eye = {1.5, 0.5, 2}, .look = {1.5, 0.5, 0}, .ortho = 1.0}, {8, 2})};
  const Picture front = render(asked);
  asked.sides = Sides::kBoth;
  const Picture both = render(asked);
  EXPECT_EQ(front.shows[1], Shows::kFace);
  EXPECT_EQ(front.shows[6], Shows::kBack);
  EXPECT_EQ(front.shows[3], Shows::kNothing);
  EXPECT_TRUE(std::isnan(value(front, 3, 0)));
  EXPECT_EQ(value(front, 6, 0), 0.0);
  EXPECT_GT(value(both, 6, 0), 0.0);
  EXPECT_EQ(value(both, 1, 0), value(front, 1, 0));
  // The lamp from its back: it emits from its front only.
  asked.view = View({.eye = {1.5, 0.5, 8}, .look = {1.5, 0.5, 0}, .ortho = 1.0}, {2, 2});
  const Picture above = render(asked);
  EXPECT_EQ(above.shows[0], Shows::kFace);
  EXPECT_EQ(value(above, 0, 0), 0.0);
  asked.view = View({.eye = {1.5, 0.5, 2}, .look = {1.5, 0.5, 9}, .ortho = 1.0}, {2, 2});
  EXPECT_NEAR(value(render(asked), 0, 0), 2.0 / std::numbers::pi, 1e-15);
}

TEST(Picture, OfAMethodIsItsEstimate) {
  Request asked = request(8, 8);
  const Picture exact = render(asked);
  asked.method = methods::parse("exact");
  const Picture control = render(asked);
  const Errors none = errors_of(control, exact);
  EXPECT_LT(none.worst, 1e-15);
  EXPECT_EQ(none.wrong, 0U);
  asked.method = methods::parse("hemicube:resolution=16");
  const Errors some = errors_of(render(asked), exact);
  EXPECT_GT(some.worst, 1e-4);
  EXPECT_GE(some.worst, some.p99);
  EXPECT_GE(some.p99, some.rms);
  EXPECT_GT(some.wrong, 0U);
  EXPECT_LT(some.pixels, exact.pixels() + 1);
  asked.layers = Layers::kAll;
  EXPECT_THROW((void)render(asked), InputError);
}

TEST(Picture, RefusesTooMuch) {
  Request asked = request(8, 8);
  asked.view = View(cornell_camera(), {65536, 65536});
  EXPECT_THROW((void)render(asked), InputError);
  asked = request(8, 8);
  asked.spp = 65;
  EXPECT_THROW((void)render(asked), InputError);
  PlainScene plain;
  plain.add_ring(plain.patch("floor"), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const Scene dark = generate::build(plain);
  const Request unlit{.scene = &dark};
  EXPECT_THROW((void)render(unlit), InputError);
}

// A room of 4 x 5 x 2.8, z upwards, and the same with y upwards.
TEST(DefaultCamera, HasTheAxisUpAlongWhichTheFloorLooks) {
  PlainScene z_up;
  models::add_box(z_up, "room", {{0, 0, 0}, {4, 5, 2.8}});
  for (models::PlainFace& face : z_up.patch("room").faces) std::ranges::reverse(face.rings.front());
  models::add_box(z_up, "table", {{1, 1, 0}, {2, 3, 0.75}});
  PlainScene y_up = z_up;
  for (Vec3& v : y_up.vertices) v = {v.x, v.z, -v.y};
  EXPECT_EQ(upwards(generate::build(z_up)), (Vec3{0, 0, 1}));
  EXPECT_EQ(upwards(generate::build(y_up)), (Vec3{0, 1, 0}));
  EXPECT_EQ(upwards(cornell_box()), (Vec3{0, 1, 0}));
  EXPECT_EQ(upwards(models::make_scene("teapot")), (Vec3{0, 0, 1}));
  const Scene scene = generate::build(z_up);
  EXPECT_EQ(default_camera(scene, {}, {8, 6}).up, (Vec3{0, 0, 1}));
  EXPECT_EQ(default_camera(scene, {.up = {0, 1, 0}}, {8, 6}).up, (Vec3{0, 1, 0}));
}

struct Shown {
  int lamp = 0, back = 0;
  std::set<std::string> furniture;  // the patches that are no wall, floor, ceiling or lamp
};
Shown shown_of(const Scene& scene, const Camera& camera, const Size& size) {
  const View view(camera, size);
  Shown shown;
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const auto hit = first_hit(scene, view.ray(column + 0.5, row + 0.5));
      if (!hit || hit->back) {
        ++shown.back;
        continue;
      }
      const Face& face = scene.face(hit->face);
      const std::string name = scene.patch(face.patch).name;
      if (scene.material(face.material).emits()) ++shown.lamp;
      if (name.starts_with("box") || name.starts_with("table")) shown.furniture.insert(name);
    }
  }
  return shown;
}

TEST(DefaultCamera, InAClosedRoomShowsALampAndTheFurniture) {
  for (const Size size : {Size{80, 80}, Size{80, 60}, Size{96, 54}}) {
    for (int seed = 1; seed <= 3; ++seed) {
      for (const char* lamp : {"flush", "hanging"}) {
        const std::string model = std::string("closed-room:lamp=") + lamp + ",seed=" + std::to_string(seed);
        SCOPED_TRACE(model);
        const Scene room = models::make_scene(model);
        const Camera camera = default_camera(room, {}, size);
        EXPECT_EQ(camera.fov, kWideFov);
        const Shown shown = shown_of(room, camera, size);
        EXPECT_GT(shown.lamp, size.height / 4);
        EXPECT_EQ(shown.back, 0);
        EXPECT_GE(shown.furniture.size(), 5U) << testing::PrintToString(shown.furniture);
      }
    }
  }
  const Scene hall = models::make_scene("emitters:n=9,size=0.1");
  EXPECT_GT(shown_of(hall, default_camera(hall, {}, {320, 240}), {320, 240}).lamp, 10);
}

TEST(Picture, UnderTheSkyShowsWhatIsOpen) {
  Request asked = request(5, 4);
  asked.sky = true;
  asked.quantity = Quantity::kFormFactor;
  const Picture picture = render(asked);
  int open = 0;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 5; ++column) {
      const std::optional<Hit> hit = first_hit(cornell_box(), asked.view.ray(column + 0.5, row + 0.5));
      if (!hit || hit->back) continue;
      const ViewShare sky = exactff::view(cornell_box(), receiver_at(cornell_box(), *hit)).open;
      EXPECT_EQ(value(picture, column, row), sky.value);
      if (sky.value > 0.0) ++open;
    }
  }
  EXPECT_GT(open, 5);
  asked.layers = Layers::kAll;
  EXPECT_THROW((void)render(asked), InputError);
}

// Otherwise the edges of lamps are jagged, whatever the number of points.
TEST(Colours, APixelHalfOnALampIsHalfWhite) {
  Picture picture;
  picture.size = {2, 1};
  picture.values = {500.0, 500.0, 500.0, 0.25, 0.5, 0.75};
  picture.shows = {Shows::kEmitter, Shows::kEmitter};
  EXPECT_EQ(develop(picture, 1.0).bytes, (std::vector<std::uint8_t>{255, 255, 255, 137, 188, 225}));
  picture.lamps = {0.5, 500.0, 499.75, 499.5, 0.5, 0.25, 0.25, 0.5};
  EXPECT_EQ(develop(picture, 1.0).bytes, (std::vector<std::uint8_t>{188, 225, 255, 137, 188, 225}));
}

}  // namespace
}  // namespace exactff::render
