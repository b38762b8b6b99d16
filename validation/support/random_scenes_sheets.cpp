// Sheets in one plane or two: thin lamps of two faces, stacks, and sheets that overlap in part, each facing either way,
// with other faces before and behind them. The planes are lattices of integer points, so each is one plane exactly.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "generate/vectors.h"
#include "support/random_frames.h"
#include "support/random_scenes.h"

namespace exactff::validation {

using generate::PlainPatch;
using generate::PlainScene;
using generate::Random;
using generate::operator+;
using generate::operator*;

namespace {

using Corners = std::vector<Vec3>;

struct Place {
  int u = 0, v = 0;
};
using Outline = std::vector<Place>;

class Sheets {
 public:
  explicit Sheets(Random& random) : random_(random) {}

  PlainScene make() {
    for (int planes = random_.integer(1, 2); planes > 0; --planes) {
      choose_plane();
      for (int sheets = random_.integer(2, 5); sheets > 0; --sheets) add_sheet();
    }
    for (int others = random_.integer(0, 3); others > 0; --others) add_triangle();
    if (random_.one_in(3)) scene_.normal = {coordinate(-2, 2), coordinate(-2, 2), coordinate(1, 2)};
    if (random_.one_in(4)) scene_.point = {coordinate(-2, 2), coordinate(-2, 2), coordinate(-1, 2)};
    shuffle(random_, scene_.patches);  // which of them come first
    return std::move(scene_);
  }

 private:
  double coordinate(int low, int high) { return random_.integer(low, high); }

  // Not parallel: one leads along x, the other along y.
  void choose_plane() {
    origin_ = {coordinate(-3, 3), coordinate(-3, 3), coordinate(3, 8)};
    along_u_ = {coordinate(1, 2), coordinate(-1, 0), coordinate(-1, 1)};
    along_v_ = {coordinate(0, 1), coordinate(1, 2), coordinate(-1, 1)};
    outlines_.clear();
  }

  Outline outline() {
    if (!outlines_.empty() && random_.one_in(2)) return outlines_[random_.below(outlines_.size())];
    const int u = random_.integer(-3, 1), v = random_.integer(-3, 1);
    const int width = random_.integer(1, 3), height = random_.integer(1, 3);
    const std::vector<Outline> shapes = {
        {{u, v}, {u + width, v}, {u + width, v + height}, {u, v + height}},
        {{u, v}, {u + width, v}, {u, v + height}},
        {{u, v}, {u + 2, v}, {u + 2, v + 1}, {u + 1, v + 1}, {u + 1, v + 2}, {u, v + 2}},
    };
    outlines_.push_back(shapes[random_.below(shapes.size())]);
    return outlines_.back();
  }

  [[nodiscard]] Corners placed(const Outline& outline) const {
    Corners corners;
    for (const auto& [u, v] : outline) corners.push_back(origin_ + 1.0 * u * along_u_ + 1.0 * v * along_v_);
    return corners;
  }

  // Of the source, of a patch that exists, or of a new one.
  PlainPatch& some_patch() {
    if (scene_.patches.empty() || random_.one_in(4)) return scene_.patch("source");
    if (random_.one_in(4)) return scene_.patches[random_.below(scene_.patches.size())];
    return scene_.patch("o" + std::to_string(scene_.patches.size()));
  }

  void add_sheet() {
    Corners corners = placed(outline());
    if (random_.one_in(2)) std::ranges::reverse(corners);
    scene_.add_ring(some_patch(), corners);
    if (!random_.one_in(3)) return;
    std::ranges::reverse(corners);
    scene_.add_ring(some_patch(), corners);
  }

  void add_triangle() {
    const auto corner = [&] { return Vec3{coordinate(-5, 5), coordinate(-5, 5), coordinate(-1, 12)}; };
    const Vec3 a = corner(), b = corner(), c = corner();
    scene_.add_ring(scene_.patch("o" + std::to_string(scene_.patches.size())), {a, b, c});
  }

  Random& random_;
  PlainScene scene_;
  Vec3 origin_, along_u_, along_v_;
  std::vector<Outline> outlines_;  // in the current plane
};

}  // namespace

// Draws until the scene can be built: rounding may have made a face cross itself.
PlainScene sheets_scene(Random& random) {
  for (;;) {
    PlainScene scene = Sheets(random).make();
    move_to_a_random_frame(scene, random);
    try {
      (void)generate::build(scene);
      return scene;
    } catch (const InputError&) {
    }
  }
}

}  // namespace exactff::validation
