// The advice of `info` to turn faces round, in concave rooms with T-junctions, lamps and boxes that stand on the floor,
// on each other and in corners, of which some or all faces look the wrong way. It is obeyed, and exact views from
// points of all faces tell how much their fronts lose: the share of the view that shows backs or nothing.
#include "property/flip_judge.h"
#include "support/test.h"

namespace exactff::slips {
namespace {

using validation::advised_flips;
using validation::LostViews;
using validation::scaled_count;
using validation::seed_of;
using Corners = std::vector<Vec3>;
using Rectangle = std::array<double, 4>;  // x, y, x, y
using Outline = std::vector<std::array<double, 2>>;

struct Plan {
  Outline outline;  // counter-clockwise
  std::vector<Rectangle> parts;
};

const std::vector<Plan> kPlans = {
    {{{0, 0}, {4, 0}, {4, 3}, {0, 3}}, {{0, 0, 4, 3}}},
    {{{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 2}, {0, 2}}, {{0, 0, 4, 2}, {2, 2, 4, 4}}},
    {{{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {1, 1}, {1, 3}, {0, 3}}, {{0, 0, 5, 1}, {0, 1, 1, 3}, {4, 1, 5, 3}}},
    {{{0, 0}, {3, 0}, {3, 2}, {5, 2}, {5, 4}, {2, 4}, {2, 2}, {0, 2}}, {{0, 0, 3, 2}, {2, 2, 5, 4}}}};

// All fronts look to the air.
class WallMaker {
 public:
  explicit WallMaker(Random& random) : random_(random), plan_(kPlans[random.below(kPlans.size())]) {}

  PlainScene make() {
    scene_.materials.push_back({.name = "bright", .radiosity = {5, 5, 5}});
    add_levels();
    add_walls();
    for (std::size_t p = 0; p < plan_.parts.size(); ++p) {
      if (random_.one_in(2)) add_box_in(plan_.parts[p], p);
    }
    if (random_.one_in(2)) add_lamp(plan_.parts.front());
    if (random_.one_in(6)) add_box("neighbour", {9, 0, 0}, {11, 2, 2}, true);
    return std::move(scene_);
  }

 private:
  void add(const std::string& name, Corners corners, bool turned = false) {
    if (turned) std::ranges::reverse(corners);
    scene_.add_ring(scene_.patch(name), corners);
  }

  // The parts meet in T-junctions, with each other, with the walls and with the whole.
  void add_levels() {
    for (const auto& [name, z] : {std::pair("floor", 0.0), std::pair("ceiling", height_)}) {
      const bool ceiling = z > 0.0;
      if (ceiling && random_.one_in(6)) return;
      if (random_.one_in(2)) {
        Corners corners;
        for (const auto& [x, y] : plan_.outline) corners.push_back({x, y, z});
        add(name, corners, ceiling);
        continue;
      }
      for (std::size_t p = 0; p < plan_.parts.size(); ++p) {
        const auto& [x0, y0, x1, y1] = plan_.parts[p];
        add(name + std::to_string(p), {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, ceiling);
      }
    }
  }

  // Some in two parts, one above the other or beside it.
  void add_walls() {
    for (std::size_t i = 0; i < plan_.outline.size(); ++i) {
      const auto &a = plan_.outline[i], &b = plan_.outline[(i + 1) % plan_.outline.size()];
      const std::string name = "wall" + std::to_string(i);
      const double middle = random_.one_in(3) ? height_ / 2 : height_;
      add_wall(name, a, b, 0, middle);
      if (middle < height_) add_wall(name + "above", a, b, middle, height_);
    }
  }
  void add_wall(const std::string& name, const std::array<double, 2>& a, const std::array<double, 2>& b, double low,
                double high) {
    add(name, {{a[0], a[1], low}, {a[0], a[1], high}, {b[0], b[1], high}, {b[0], b[1], low}});
  }

  void add_box_in(const Rectangle& part, std::size_t number) {
    const std::string name = "box" + std::to_string(number);
    const double x = part[0] + 0.25 * random_.integer(0, 2), y = part[1] + 0.25 * random_.integer(0, 2),
                 z = random_.one_in(3) ? 0.25 : 0.0;
    const Vec3 high{x + 0.25, y + 0.25, z + 0.5};
    add_box(name, {x, y, z}, high, false);
    if (random_.one_in(2)) add_box(name + "top", {x, y, high.z}, {x + 0.5, y + 0.25, high.z + 0.25}, false);
  }
  void add_box(const std::string& name, const Vec3& a, const Vec3& b, bool inward) {
    const std::array<Corners, 6> faces = {Corners{{a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}},
                                          Corners{{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}},
                                          Corners{{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}},
                                          Corners{{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}},
                                          Corners{{b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}},
                                          Corners{{a.x, b.y, a.z}, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}}};
    const bool apart = random_.one_in(2);
    for (std::size_t i = 0; i < 6; ++i) add(apart ? name + '_' + std::to_string(i) : name, faces[i], inward);
  }

  void add_lamp(const Rectangle& part) {
    const double x = part[0] + 0.25, y = part[1] + 0.25, z = height_ - 0.25;
    add("lamp", {{x, y, z}, {x, y + 0.5, z}, {x + 0.5, y + 0.5, z}, {x + 0.5, y, z}});
    scene_.patch("lamp").material = "bright";
  }

  Random& random_;
  const Plan& plan_;
  const double height_ = 2;
  PlainScene scene_;
};

void turn_round(generate::PlainPatch& patch) {
  for (generate::PlainFace& face : patch.faces) std::ranges::reverse(face.rings.front());
}

// As someone would who follows all advice, to write the file again and to look at it again.
Scene obeyed(const PlainScene& plain, const std::vector<std::vector<Selection>>& advice, PlainScene& result) {
  result = plain;
  const Scene scene = generate::build(plain);
  for (const std::vector<Selection>& flips : advice) {
    for (const Selection& flip : flips) {
      generate::PlainPatch& patch = result.patches[index_of(flip.patch)];
      if (!flip.face) turn_round(patch);
      if (flip.face) std::ranges::reverse(patch.faces[scene.face(*flip.face).number - 1].rings.front());
    }
  }
  return generate::build(result);
}

TEST(RoomAdvice, IsNotGivenForRoomsThatAreRight) {
  for (std::uint64_t s = 0; s < scaled_count(60); ++s) {
    Random random(seed_of(s));
    const PlainScene plain = WallMaker(random).make();
    EXPECT_TRUE(advised_flips(generate::build(plain)).empty()) << s << '\n' << generate::to_obj(plain);
  }
}

TEST(RoomAdvice, ObeyedLosesNothingAndEndsInSilence) {
  constexpr double kBackOfLamp = 0.3;  // either side of a lamp may be meant
  std::size_t advised = 0, right = 0;
  for (std::uint64_t s = 0; s < scaled_count(24); ++s) {
    Random random(seed_of(s));
    PlainScene plain = WallMaker(random).make();
    const Scene truth = generate::build(plain);
    const LostViews judge(truth);
    const double area = 100.0, least = judge.lost(truth);
    const std::size_t mode = random.below(3), one_in = 2 + random.below(6);
    for (generate::PlainPatch& patch : plain.patches) {
      const bool is_of_room = !patch.name.starts_with("box") && patch.name != "lamp" && patch.name != "neighbour";
      if (mode == 0 ? is_of_room : mode == 1 ? true : random.one_in(one_in)) turn_round(patch);
    }
    SCOPED_TRACE(std::to_string(s) + " mode " + std::to_string(mode) + '\n' + generate::to_obj(plain));
    double lost = judge.lost(generate::build(plain));
    std::size_t rounds = 0;
    for (; rounds < 5; ++rounds) {
      const Scene scene = generate::build(plain);
      const std::vector<std::vector<Selection>> advice = advised_flips(scene);
      if (advice.empty()) break;
      for (const std::vector<Selection>& flips : advice) {
        EXPECT_LE(judge.lost(scene.with_flipped(flips)), lost + 1e-9 * area) << scene.name_of(flips.front());
        ++advised;
      }
      PlainScene next;
      const double then = judge.lost(obeyed(plain, advice, next));
      EXPECT_LE(then, lost + 1e-9 * area);
      plain = std::move(next);
      lost = then;
    }
    EXPECT_LT(rounds, 5U);
    right += lost <= least + kBackOfLamp ? 1 : 0;
  }
  EXPECT_GT(advised, scaled_count(12));
  EXPECT_GE(right, scaled_count(18));
}

}  // namespace
}  // namespace exactff::slips
