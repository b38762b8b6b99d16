// The Utah teapot between a square light and a floor, from its published Bezier control points.
//
// Source: M. Newell, "The Utilization of Procedure Models in Digital Image Synthesis" (1975); F. Crow, "The Origins of
// the Teapot" (IEEE Computer Graphics and Applications, January 1987). Crow's table has 306 points: the pot is a
// quarter lower than Newell's, and has a bottom. z is up.
//
// All 32 bicubic patches follow from 10 by mirroring. A part is a row of sections. A section is half a loop or a
// quarter of a circle in four control points. Every fourth section ends a patch and begins the next one.
// 1. Body and lid are nearly solids of revolution: a section is a quarter circle of some radius at some height. The
//    other quarters are its mirror images in x and y.
// 2. Handle and spout are symmetric about y = 0: a section is a half loop from its inner to its outer end.
// 3. A patch is evaluated at segments + 1 values of each parameter. On its border, all control points except those of
//    the border have weight zero, so patches that share border control points share the points exactly, bit for bit.
// 4. Quadrilaterals are cut in two. Where one side is a point, as at the lid's pole, one triangle is left. With one
//    segment the spout's lip would have no area: at least two segments are required.
#include <array>
#include <map>
#include <span>
#include <tuple>

#include "models/registry.h"

namespace exactff::models {

namespace {

using Section = std::array<Vec3, 4>;

struct Circle {
  double radius;
  double bend;  // distance of the inner control points from the axes: 0.56 of the radius, except for the knob
  double height;
};

struct HalfLoop {
  double inner_x, inner_z;
  double outer_x, outer_z;
  double half_width;
};

// From the rim down to the centre of the bottom.
constexpr std::array<Circle, 13> kBody{{{1.4, 0.784, 2.4},
                                        {1.3375, 0.749, 2.53125},
                                        {1.4375, 0.805, 2.53125},
                                        {1.5, 0.84, 2.4},
                                        {1.75, 0.98, 1.875},
                                        {2.0, 1.12, 1.35},
                                        {2.0, 1.12, 0.9},
                                        {2.0, 1.12, 0.45},
                                        {1.5, 0.84, 0.225},
                                        {1.5, 0.84, 0.15},
                                        {1.5, 0.84, 0.075},
                                        {1.425, 0.798, 0.0},
                                        {0.0, 0.0, 0.0}}};
// From the top of the knob to the brim.
constexpr std::array<Circle, 7> kLid{{{0.0, 0.0, 3.15},
                                      {0.8, 0.45, 3.15},
                                      {0.0, 0.0, 2.85},
                                      {0.2, 0.112, 2.7},
                                      {0.4, 0.224, 2.55},
                                      {1.3, 0.728, 2.55},
                                      {1.3, 0.728, 2.4}}};
// From the top to where it rejoins the body.
constexpr std::array<HalfLoop, 7> kHandle{{{-1.6, 2.025, -1.5, 2.25, 0.3},
                                           {-2.3, 2.025, -2.5, 2.25, 0.3},
                                           {-2.7, 2.025, -3.0, 2.25, 0.3},
                                           {-2.7, 1.8, -3.0, 1.8, 0.3},
                                           {-2.7, 1.575, -3.0, 1.35, 0.3},
                                           {-2.5, 1.125, -2.65, 0.9375, 0.3},
                                           {-2.0, 0.9, -1.9, 0.6, 0.3}}};
// From the body to the tip and a little back inside.
constexpr std::array<HalfLoop, 7> kSpout{{{1.7, 1.425, 1.7, 0.6, 0.66},
                                          {2.6, 1.425, 3.1, 0.825, 0.66},
                                          {2.3, 2.1, 2.4, 2.025, 0.25},
                                          {2.7, 2.4, 3.3, 2.4, 0.25},
                                          {2.8, 2.475, 3.525, 2.49375, 0.25},
                                          {2.9, 2.475, 3.45, 2.5125, 0.15},
                                          {2.8, 2.4, 3.2, 2.4, 0.15}}};

Section section(const Circle& c) {
  return {{{c.radius, 0.0, c.height},
           {c.radius, c.bend, c.height},
           {c.bend, c.radius, c.height},
           {0.0, c.radius, c.height}}};
}

Section section(const HalfLoop& h) {
  return {{{h.inner_x, 0.0, h.inner_z},
           {h.inner_x, h.half_width, h.inner_z},
           {h.outer_x, h.half_width, h.outer_z},
           {h.outer_x, 0.0, h.outer_z}}};
}

using Weights = std::array<double, 4>;

// Bernstein's polynomials at step / steps.
Weights weights(int step, int steps) {
  const double t = static_cast<double>(step) / steps;
  const double q = static_cast<double>(steps - step) / steps;
  return {q * q * q, 3.0 * q * q * t, 3.0 * q * t * t, t * t * t};
}

// A coordinate that all four points share is kept exactly, so that circles stay level and poles stay points.
Vec3 weighted_sum(const std::array<Vec3, 4>& p, const Weights& w) {
  const auto sum = [&](double Vec3::*c) {
    if (p[0].*c == p[1].*c && p[1].*c == p[2].*c && p[2].*c == p[3].*c) return p[0].*c;
    return w[0] * p[0].*c + w[1] * p[1].*c + w[2] * p[2].*c + w[3] * p[3].*c;
  };
  return {sum(&Vec3::x), sum(&Vec3::y), sum(&Vec3::z)};
}

Vec3 point(std::span<const Section, 4> patch, const Weights& along, const Weights& across) {
  std::array<Vec3, 4> crossing;
  for (std::size_t i = 0; i < 4; ++i) crossing[i] = weighted_sum(patch[i], across);
  return weighted_sum(crossing, along);
}

// The signs of x and y in a mirror image.
struct Mirror {
  double x = 1.0;
  double y = 1.0;
};

class Tessellation {
 public:
  Tessellation(PlainScene& scene, int segments) : scene_(scene), segments_(segments) {}

  // Adds a part, which consists of whole patches, and its mirror images. Turning from the direction along the part to
  // the direction across it is counter-clockwise about the outer normal.
  template <class Part>
  void add(const char* name, const Part& part, std::span<const Mirror> mirrors) {
    std::vector<Section> sections;
    for (const auto& row : part) sections.push_back(section(row));
    for (std::size_t first = 0; first + 3 < sections.size(); first += 3) {
      const std::span<const Section, 4> patch(&sections[first], 4);
      for (const Mirror& mirror : mirrors) add_patch(scene_.patch(name), patch, mirror);
    }
  }

 private:
  // Corners at the same place are one vertex. Negative zeros become positive, so that mirror images meet.
  std::uint32_t vertex(const Vec3& p, const Mirror& mirror) {
    const Vec3 image{mirror.x * p.x + 0.0, mirror.y * p.y + 0.0, p.z};
    const auto next = static_cast<std::uint32_t>(scene_.vertices.size());
    const auto [entry, is_new] = places_.try_emplace({image.x, image.y, image.z}, next);
    if (is_new) scene_.vertices.push_back(image);
    return entry->second;
  }

  void add_patch(PlainPatch& out, std::span<const Section, 4> patch, const Mirror& mirror) {
    const auto at = [&](int i, int j) {
      return vertex(point(patch, weights(i, segments_), weights(j, segments_)), mirror);
    };
    const bool turned = mirror.x * mirror.y < 0.0;
    for (int i = 0; i < segments_; ++i) {
      for (int j = 0; j < segments_; ++j) {
        const std::array<std::uint32_t, 4> quad{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
        add_triangle(out, {quad[0], quad[1], quad[2]}, turned);
        add_triangle(out, {quad[0], quad[2], quad[3]}, turned);
      }
    }
  }

  static void add_triangle(PlainPatch& out, Ring corners, bool turned) {
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
    if (turned) std::swap(corners[1], corners[2]);
    out.faces.push_back({{std::move(corners)}});
  }

  PlainScene& scene_;
  int segments_;
  std::map<std::tuple<double, double, double>, std::uint32_t> places_;
};

void add_teapot(PlainScene& scene, int segments) {
  static constexpr std::array<Mirror, 4> kQuarters{{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  static constexpr std::array<Mirror, 2> kHalves{{{1, 1}, {1, -1}}};
  Tessellation tessellation(scene, segments);
  tessellation.add("body", kBody, kQuarters);
  tessellation.add("lid", kLid, kQuarters);
  tessellation.add("handle", kHandle, kHalves);
  tessellation.add("spout", kSpout, kHalves);
}

PlainScene make_teapot(const Settings& settings) {
  constexpr double kFloor = 5.0, kLight = 1.5;  // half their sides
  constexpr double kLightHeight = 6.0;
  PlainScene scene;
  scene.materials = {{"floor", {0.5, 0.5, 0.5}, {}}, {"china", {0.8, 0.8, 0.75}, {}}, {"light", {0, 0, 0}, {1, 1, 1}}};
  scene.patches = {{"floor", "floor", {}},  {"body", "china", {}},  {"lid", "china", {}},
                   {"handle", "china", {}}, {"spout", "china", {}}, {"light", "light", {}}};
  scene.add_ring(scene.patch("floor"),
                 {{-kFloor, -kFloor, 0}, {kFloor, -kFloor, 0}, {kFloor, kFloor, 0}, {-kFloor, kFloor, 0}});
  scene.add_ring(scene.patch("light"), {{-kLight, -kLight, kLightHeight},
                                        {-kLight, kLight, kLightHeight},
                                        {kLight, kLight, kLightHeight},
                                        {kLight, -kLight, kLightHeight}});
  add_teapot(scene, static_cast<int>(settings.whole("segments")));
  scene.source = "light";
  scene.point = {2.5, 1.0, 0.0};
  return scene;
}

}  // namespace

Recipe teapot_model() {
  return {{.name = "teapot",
           .summary = "the Utah teapot between a square light and a floor (floor, body, lid, handle, spout, light)",
           .settings = {whole_setting(
               "segments", 8, 2, 64,
               "s, the number of segments along each side of a Bezier patch; 64 s^2 - 8 s triangles")}},
          &make_teapot};
}

}  // namespace exactff::models
