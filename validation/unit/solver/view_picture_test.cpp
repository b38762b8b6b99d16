// Colours and words in pictures of the whole view.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "exactff/models.h"
#include "exactff/scene_files.h"
#include "exactff/view.h"
#include "generate/plain_scene.h"
#include "whole_view/patch_colours.h"

namespace exactff {
namespace {

// CIE L*a*b* of "#rrggbb" in sRGB, under D65: another measure than the one that chooses colours.
std::array<double, 3> lab(const std::string& text) {
  std::array<double, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = static_cast<double>(std::strtol(text.substr(1 + 2 * i, 2).c_str(), nullptr, 16)) / 255.0;
    linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  const auto [r, g, b] = linear;
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
  const double x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505), y = f(0.2126 * r + 0.7152 * g + 0.0722 * b),
               z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

double difference(const std::string& one, const std::string& other) {
  const auto p = lab(one), q = lab(other);
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

// The colours of each group: "front floor", "back box", "open (open)".
std::map<std::string, std::set<std::string>> colours_in(const std::string& svg) {
  std::map<std::string, std::set<std::string>> colours;
  const std::string begin = "<g class=\"", title = "\"><title>";
  for (std::size_t at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1)) {
    const std::size_t kind = at + begin.size(), name = svg.find(title, kind) + title.size();
    const std::string group =
        svg.substr(kind, name - title.size() - kind) + ' ' + svg.substr(name, svg.find("</title>", name) - name);
    const std::size_t end = svg.find("</g>", at);
    for (std::size_t fill = svg.find("<path fill=\"", at); fill < end; fill = svg.find("<path fill=\"", fill + 1)) {
      colours[group].insert(svg.substr(fill + 12, 7));
    }
  }
  return colours;
}

std::string group_of(const Scene& scene, const std::optional<FaceId>& face, bool front) {
  if (!face) return "open (open)";
  return (front ? "front " : "back ") + scene.patch(scene.face(*face).patch).name;
}

// The pairs of groups that have an arc in common.
std::set<std::pair<std::string, std::string>> touching(const Scene& scene, const Receiver& receiver) {
  std::set<std::pair<std::string, std::string>> pairs;
  for (const ViewArc& arc : view(scene, receiver, {.arcs = true}).arcs) {
    if (arc.on_horizon) continue;
    std::string left = group_of(scene, arc.left, arc.left_front), right = group_of(scene, arc.right, arc.right_front);
    if (left > right) std::swap(left, right);
    if (left != right) pairs.emplace(std::move(left), std::move(right));
  }
  return pairs;
}

void expect_neighbours_to_differ(const Scene& scene, const Receiver& receiver) {
  auto colours = colours_in(view_svg(scene, receiver));
  const auto pairs = touching(scene, receiver);
  EXPECT_GT(pairs.size(), 2U);
  for (const auto& [one, other] : pairs) {
    for (const std::string& a : colours[one]) {
      for (const std::string& b : colours[other]) {
        EXPECT_GT(difference(a, b), 10.0) << one << ' ' << a << ", " << other << ' ' << b;
      }
    }
  }
}

Receiver on_floor(const Scene& scene, const Vec3& point) {
  return {.point = point, .normal = {0, 1, 0}, .on = {scene.faces_of(scene.select("floor")).front()}, .id = {}};
}

TEST(ViewPicture, NeighboursHaveColoursThatDiffer) {
  const Scene box = read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  for (const Vec3& point : {Vec3{240, 0, 300}, Vec3{100, 0, 100}, Vec3{500, 0, 400}}) {
    expect_neighbours_to_differ(box, on_floor(box, point));
  }
  for (const char* model : {"closed-room", "emitters:n=9,size=0.1", "room:n=12"}) {
    SCOPED_TRACE(model);
    const Scene room = models::make_scene(model);
    expect_neighbours_to_differ(room, on_floor(room, {2.1, 0, 1.7}));
  }
}

}  // namespace
}  // namespace exactff
