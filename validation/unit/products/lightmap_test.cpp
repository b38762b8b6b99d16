// Lightmaps against a search of all triangles in rationals, and against values at single points.
#include "kernel/numbers.h"
#include "models/random.h"
#include "support/test.h"

namespace exactff::render {
namespace {

using kernel::Rational;
using kernel::to_rational;
using models::Random;

// The triangles of all faces in order, with the faces from which they come.
struct Triangles {
  Scene scene;
  std::vector<FaceId> face;

  explicit Triangles(const Scene& whole) : scene(triangulated(whole)) {
    for (std::size_t f = 0; f < whole.faces().size(); ++f) {
      const auto id = static_cast<FaceId>(f);
      for (const Piece& piece : whole.pieces_of(id)) face.insert(face.end(), whole.corners(piece).size() - 2, id);
    }
  }
};

Rational det(const std::array<Rational, 2>& a, const std::array<Rational, 2>& b, const std::array<Rational, 2>& c) {
  return (a[0] - c[0]) * (b[1] - c[1]) - (b[0] - c[0]) * (a[1] - c[1]);
}

// What a centre lies in: the weights of the corners of a triangle, which may be 0.
struct Found {
  std::size_t triangle = 0;
  bool inside = false;
  std::array<Rational, 3> weight;
};

std::vector<Found> search(const Triangles& all, const Lightmap& map, int column, int row) {
  const std::array<Rational, 2> p{Rational(2 * column + 1, 2 * map.size.width),
                                  1 - Rational(2 * row + 1, 2 * map.size.height)};
  std::vector<Found> found;
  for (std::size_t t = 0; t < all.scene.faces().size(); ++t) {
    const auto texture = all.scene.texture(static_cast<FaceId>(t), map.set);
    if (texture.empty()) continue;
    std::array<std::array<Rational, 2>, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = {to_rational(texture[k].u), to_rational(texture[k].v)};
    const Rational whole = det(at[0], at[1], at[2]);
    if (sgn(whole) == 0) continue;
    Found one{t, true, {det(p, at[1], at[2]) / whole, det(at[0], p, at[2]) / whole, det(at[0], at[1], p) / whole}};
    if (std::ranges::any_of(one.weight, [](const Rational& w) { return sgn(w) < 0; })) continue;
    one.inside = std::ranges::all_of(one.weight, [](const Rational& w) { return sgn(w) > 0; });
    found.push_back(one);
  }
  return found;
}

Vec3 point_of(const Scene& triangles, const Found& found) {
  const auto& ring = triangles.faces()[found.triangle].rings[0];
  const auto axis = [&](double Vec3::*c) {
    Rational sum = 0;
    const Rational moved = found.inside ? 0 : Rational(1, 1 << 30);
    for (std::size_t k = 0; k < 3; ++k)
      sum += ((1 - moved) * found.weight[k] + moved / 3) * to_rational(triangles.vertices()[ring[k]].*c);
    return kernel::nearest_double(sum);
  };
  return {axis(&Vec3::x), axis(&Vec3::y), axis(&Vec3::z)};
}

void expect_as_searched(const Scene& scene, const Lightmap& map) {
  const Atlas atlas(scene, map);
  const Triangles all(scene);
  ASSERT_EQ(all.face.size(), all.scene.faces().size());
  std::uint64_t texels = 0, overlapping = 0;
  std::set<FaceId> shown;
  for (int row = 0; row < map.size.height; ++row) {
    for (int column = 0; column < map.size.width; ++column) {
      const std::vector<Found> wanted = search(all, map, column, row);
      const std::optional<Hit> hit = atlas.hit(column, row);
      ASSERT_EQ(hit.has_value(), !wanted.empty()) << column << ' ' << row;
      if (!hit) continue;
      ++texels;
      shown.insert(hit->face);
      if (std::ranges::count_if(wanted, &Found::inside) > 1) ++overlapping;
      EXPECT_EQ(hit->face, all.face[wanted.front().triangle]);
      EXPECT_EQ(hit->point, point_of(all.scene, wanted.front())) << column << ' ' << row;
    }
  }
  const Charts& charts = atlas.charts();
  EXPECT_EQ(charts.texels, texels);
  EXPECT_EQ(charts.overlapping, overlapping);
  EXPECT_EQ(charts.first_overlap.has_value(), overlapping > 0);
  std::uint64_t with = 0, flat = 0, outside = 0;
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const auto texture = scene.texture(static_cast<FaceId>(f), map.set);
    if (texture.empty()) continue;
    ++with;
    bool has_area = false, beyond = false;
    for (std::size_t t = 0; t < all.face.size(); ++t) {
      if (all.face[t] != static_cast<FaceId>(f)) continue;
      std::array<std::array<Rational, 2>, 3> at;
      const auto part = all.scene.texture(static_cast<FaceId>(t), map.set);
      for (std::size_t k = 0; k < 3; ++k) {
        at[k] = {to_rational(part[k].u), to_rational(part[k].v)};
        beyond = beyond || part[k].u < 0.0 || part[k].u > 1.0 || part[k].v < 0.0 || part[k].v > 1.0;
      }
      has_area = has_area || sgn(det(at[0], at[1], at[2])) != 0;
    }
    flat += has_area ? 0 : 1;
    outside += beyond ? 1 : 0;
  }
  EXPECT_EQ(charts.faces, with);
  EXPECT_EQ(charts.flat, flat);
  EXPECT_EQ(charts.outside, outside);
}

// Polygons in planes or not, anywhere; coordinates of textures on a lattice of half texels, so that centres lie on
// edges and at corners, or anywhere; overlapping, mirrored, without area, beyond the picture.
Scene random_charts(Random& random, const Size& size) {
  SceneBuilder builder;
  const MaterialId grey = builder.add_material({.name = "grey"});
  const auto faces = static_cast<std::size_t>(random.integer(1, 9));
  for (std::size_t f = 0; f < faces; ++f) {
    const auto corners = static_cast<std::uint32_t>(random.integer(3, 7));
    const auto first = static_cast<std::uint32_t>(builder.vertex_count());
    const bool planar = random.one_in(2);
    std::vector<std::uint32_t> ring;
    std::vector<TexturePoint> texture;
    const double x = random.between(-2, 2), size_of_face = std::exp2(random.integer(-2, 2));
    const bool lattice = !random.one_in(3), flat = random.one_in(8), mirrored = random.one_in(2);
    const double u0 = random.between(-0.2, 1.0), v0 = random.between(-0.2, 1.0), r = random.between(0.0, 0.6);
    for (std::uint32_t k = 0; k < corners; ++k) {
      const double angle = 2.0 * std::numbers::pi * (k + random.between(0.0, 0.4)) / corners;
      const double radius = random.one_in(3) ? 0.3 : 1.0;  // concave at times
      builder.add_vertex({x + size_of_face * radius * std::cos(angle), size_of_face * radius * std::sin(angle),
                          3.0 * static_cast<double>(f) + (planar ? 0.0 : random.between(0.0, 0.1))});
      ring.push_back(first + k);
      TexturePoint p{u0 + r * std::cos(mirrored ? -angle : angle), v0 + r * std::sin(mirrored ? -angle : angle)};
      if (flat) p.v = v0;
      if (lattice) {
        p = {std::round(2.0 * size.width * p.u) / (2.0 * size.width),
             std::round(2.0 * size.height * p.v) / (2.0 * size.height)};
      }
      texture.push_back(p);
    }
    builder.add_face(builder.patch("p" + std::to_string(f)), grey, {ring});
    if (random.one_in(6)) continue;
    builder.state_texture(0, texture);
  }
  return builder.build();
}

TEST(Lightmap, TexelsShowThePointsThatASearchInRationalsFinds) {
  int searched = 0;
  for (std::uint64_t seed = 1; seed <= 80; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const Size size{random.one_in(4) ? 49 : random.integer(1, 24), random.one_in(2) ? 16 : random.integer(1, 24)};
    const Scene scene = random_charts(random, size);
    if (!scene.has_texture()) continue;
    expect_as_searched(scene, {.size = size});
    ++searched;
  }
  EXPECT_GT(searched, 60);
}

// Two faces in the form of a roof share an edge that a row of centres lies on: each texel sees the lamp above as the
// points beside it do, wherever the ridge lies in doubles.
TEST(Lightmap, NoFaceHidesTheEdgesOfItsNeighbours) {
  for (const double sign : {1.0, -1.0}) {  // a ridge, a valley
    SceneBuilder builder;
    for (const auto& [x, y, z] : std::vector<std::array<double, 3>>{
             {0.1, 0.7, 0.3}, {1.3, 0.9, 0.3}, {1.2, 0.1, 0.3 - 0.2 * sign}, {0.3, 2.1, 0.3 - 0.3 * sign}})
      builder.add_vertex({x, y, z});
    for (const auto& [x, y] : std::vector<std::array<double, 2>>{{0, 0}, {0, 2}, {2, 2}, {2, 0}})
      builder.add_vertex({x, y, 3.0});
    const MaterialId grey = builder.add_material({.name = "grey"});
    builder.add_face(builder.patch("roof"), grey, {{0, 2, 1}});
    builder.state_texture(0, {{0, 0.5}, {0.5, 0}, {1, 0.5}});
    builder.add_face(builder.patch("roof"), grey, {{0, 1, 3}});
    builder.state_texture(0, {{0, 0.5}, {1, 0.5}, {0.5, 1}});
    builder.add_face(builder.patch("lamp"), grey, {{4, 5, 6, 7}});
    const Scene scene = builder.build();
    Request request{.scene = &scene, .sources = {scene.select("lamp")}, .quantity = Quantity::kFormFactor};
    request.lightmap = Lightmap{.size = {65, 65}};
    const Picture picture = render(request);
    const auto at = [&](int column, int row) {
      return picture.values[3 * static_cast<std::size_t>(65 * row + column)];
    };
    for (int column = 3; column < 62; ++column) {
      ASSERT_GT(at(column, 33), 0.05);  // one texel below, on the same face
      EXPECT_NEAR(at(column, 32), at(column, 33), 0.1 * at(column, 33)) << column << ' ' << sign;
    }
  }
}

// The Cornell box with a square of the texture for each face.
Scene box_with_charts() {
  const Scene box = read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  SceneBuilder builder;
  for (const Vec3& v : box.vertices()) builder.add_vertex(v);
  for (const Material& material : box.materials()) builder.add_material(material);
  for (std::size_t f = 0; f < box.faces().size(); ++f) {
    const Face& face = box.faces()[f];
    builder.add_face(builder.patch(box.patch(face.patch).name), face.material, face.rings);
    const double u = static_cast<double>(f % 5) / 5, v = static_cast<double>(f / 5) / 5;
    const std::array<TexturePoint, 4> square{{{u, v}, {u + 0.19, v}, {u + 0.19, v + 0.19}, {u, v + 0.19}}};
    builder.state_texture(1, {square.begin(), square.begin() + static_cast<std::ptrdiff_t>(face.rings[0].size())});
  }
  return builder.build();
}

Request request_of(const Scene& scene, int side = 40) {
  Request request{.scene = &scene, .scene_name = "box", .quantity = Quantity::kFormFactor};
  request.lightmap = Lightmap{.size = {side, side}, .set = 1};
  return request;
}

// As of a receiver of truth on the face.
TEST(Lightmap, TexelsHaveTheValuesOfTheirPoints) {
  const Scene scene = box_with_charts();
  Request request = request_of(scene);
  const Picture picture = render(request);
  request.quantity = Quantity::kIrradiance;
  const Picture irradiance = render(request);
  const Atlas atlas(scene, *request.lightmap);
  const ExactSource light(scene, scene.select("light"));
  int lit = 0;
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) {
      const auto texel = static_cast<std::size_t>(40 * row + column);
      const auto hit = atlas.hit(column, row);
      EXPECT_EQ(picture.shows[texel] == Shows::kNothing, !hit);
      EXPECT_EQ(picture.layers.back().values[texel], hit ? 1.0 : 0.0);  // A
      if (!hit) {
        EXPECT_TRUE(std::isnan(picture.values[3 * texel]));
        continue;
      }
      const Receiver receiver = receiver_at(scene, *hit);  // with the neighbour's face on the fold of the left wall
      EXPECT_EQ(receiver.point, hit->point);
      EXPECT_EQ(receiver.normal, scene.face(hit->face).newell);
      EXPECT_EQ(receiver.on.front(), hit->face);
      const double f = exact_form_factor(scene, receiver, light).value;
      EXPECT_EQ(picture.values[3 * texel], f);
      EXPECT_NEAR(irradiance.values[3 * texel], 17.0 * f, 1e-15 * 17);
      lit += f > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(lit, 300);
  EXPECT_EQ(picture.layers.back().name, "A");
  ASSERT_TRUE(picture.charts);
  EXPECT_EQ(picture.charts->texels, static_cast<std::uint64_t>(std::ranges::count_if(
                                        picture.shows, [](Shows s) { return s != Shows::kNothing; })));
}

// Each copy is of a texel of a face, as far away as it says, and there is none nearer.
TEST(Lightmap, MarginsAreCopiesOfTheNearestTexels) {
  const Scene scene = box_with_charts();
  Request request = request_of(scene);
  request.lightmap->on = {scene.select("floor"), scene.select("light")};
  const Picture plain = render(request);
  request.lightmap->margin = 3;
  const Picture wide = render(request);
  EXPECT_EQ(wide.charts->faces, 2U);
  ASSERT_EQ(wide.layers.back().name, "margin");
  const std::vector<double>& margin = wide.layers.back().values;
  const auto at = [](int column, int row) { return static_cast<std::size_t>(40 * row + column); };
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 40; ++column) {
      int nearest = 4;
      bool is_copy = false;
      for (int y = std::max(0, row - 3); y <= std::min(39, row + 3); ++y) {
        for (int x = std::max(0, column - 3); x <= std::min(39, column + 3); ++x) {
          if (plain.shows[at(x, y)] == Shows::kNothing) continue;
          const int distance = std::max(std::abs(x - column), std::abs(y - row));
          nearest = std::min(nearest, distance);
          if (margin[at(column, row)] == distance)
            is_copy = is_copy || wide.values[3 * at(x, y)] == wide.values[3 * at(column, row)];
        }
      }
      EXPECT_EQ(margin[at(column, row)], nearest == 4 ? 0 : nearest);
      EXPECT_EQ(is_copy, nearest < 4);
      EXPECT_EQ(wide.shows[at(column, row)], plain.shows[at(column, row)]);
      EXPECT_EQ(std::isnan(wide.values[3 * at(column, row)]), nearest == 4);
    }
  }
  EXPECT_EQ(errors_of(wide, plain).pixels, plain.charts->texels);
}

TEST(Lightmap, RefusesWhatHasNone) {
  const Scene scene = box_with_charts();
  Request request = request_of(scene);
  request.lightmap->set = 0;
  EXPECT_HOLDS(complaint([&] { (void)render(request); }), "no face has texture coordinates of set 0");
  request.lightmap->set = 1;
  for (const Size size : {Size{0, 5}, Size{5, kLongestSide + 1}, Size{kLongestSide, kLongestSide}}) {
    request.lightmap->size = size;
    EXPECT_THROW((void)render(request), InputError);
  }
  request.lightmap->size = {4, 4};
  request.spp = 2;
  EXPECT_THROW((void)render(request), InputError);
}

}  // namespace
}  // namespace exactff::render
