// The grid keeps every pair of an edge and an occluder that matters. EXACTFF_TEST_SCALE multiplies the number of
// scenes.
#include "visibility/outline_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "generate/plain_scene.h"
#include "generate/random.h"
#include "generate/vectors.h"
#include "support/random_scenes.h"

namespace exactff::visibility {
namespace {

using generate::Random;
using generate::operator+;
using generate::operator-;
using generate::operator*;
using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;
using Corners = std::vector<Vec3>;

// Outlines of directions from the origin.
class Seen {
 public:
  // A face without area, as seen from the origin, is not added.
  void add(Corners corners) {
    const int turn = kernel::orientation({}, corners[0], corners[1], corners[2]);
    if (turn == 0) return;
    if (turn > 0) std::reverse(corners.begin(), corners.end());
    rings_.push_back(std::move(corners));
  }
  // Of all outlines that were added before.
  Outlines& outlines() {
    if (scene_) return outlines_;
    scene_ = generate::build(with_all_vertices());
    outlines_.start(*scene_, {}, 1.0);
    std::uint32_t vertex = 0;
    std::vector<std::uint32_t> vertices;
    std::vector<CornerId> corners;
    for (const Corners& ring : rings_) {
      vertices.resize(ring.size());
      std::iota(vertices.begin(), vertices.end(), vertex);
      vertex += static_cast<std::uint32_t>(ring.size());
      outlines_.corners_of(vertices, corners);
      static_cast<void>(outlines_.add(corners, false));
    }
    return outlines_;
  }

 private:
  // A ring of four corners may be non-planar: then the scene has only one triangle of it.
  [[nodiscard]] generate::PlainScene with_all_vertices() const {
    generate::PlainScene plain;
    for (const Corners& ring : rings_) plain.vertices.insert(plain.vertices.end(), ring.begin(), ring.end());
    plain.patch("source").faces.push_back({{{0, 1, 2}}});
    return plain;
  }
  std::vector<Corners> rings_;
  std::optional<Scene> scene_;
  Outlines outlines_;
};

Integer exact_height(Outlines& outlines, EdgeId line, CornerId corner) {
  Integer height;
  outlines.set_exact_height(height, outlines.edge(line), corner);
  return height;
}

struct Interval {
  Rational low = 0, high = 1;  // of m / (l + m)
};

// The part of the edge in the closed outline.
void cut(Outlines& outlines, const Outlines::Edge& edge, OutlineId by, Interval& interval) {
  const Outlines::Outline o = outlines.outline(by);
  for (EdgeId id = o.first; id < o.first + o.count; ++id) {
    const Integer a = exact_height(outlines, id, edge.a), b = exact_height(outlines, id, edge.b);
    if (sgn(a) < 0 && sgn(b) < 0) interval.high = -1;
    if (sgn(a) * sgn(b) >= 0 && !(sgn(a) < 0 || sgn(b) < 0)) continue;
    if (a == b) continue;
    const Rational at = Rational(a) / Rational(a - b);
    if (sgn(a) < 0) interval.low = std::max(interval.low, at);
    if (sgn(b) < 0) interval.high = std::min(interval.high, at);
  }
}

bool holds_inside(Outlines& outlines, OutlineId by, const Outlines::Edge& edge, const Rational& at) {
  const Outlines::Outline o = outlines.outline(by);
  for (EdgeId id = o.first; id < o.first + o.count; ++id) {
    const Rational a = exact_height(outlines, id, edge.a), b = exact_height(outlines, id, edge.b);
    if (a * (1 - at) + b * at <= 0) return false;
  }
  return true;
}

struct Tally {
  std::uint64_t met = 0, left_out = 0, near = 0, pairs = 0;
};

// Every outline that an edge meets within the source is near the edge, or is hidden there by another outline near it.
// Edges marked in `dropped` are not queried.
void expect_nothing_lost(Outlines& outlines, const std::vector<std::uint8_t>& dropped, Tally& tally) {
  OutlineGrid grid;
  grid.build(outlines, 1, dropped);
  const auto count = static_cast<OutlineId>(outlines.outlines().size());
  for (EdgeId id = 0; id < outlines.edges().size(); ++id) {
    if (dropped[id] != 0) continue;
    const Outlines::Edge edge = outlines.edge(id);
    const auto found = grid.find_near(outlines, id, 1);
    std::vector<OutlineId> near(found.begin(), found.end());
    std::sort(near.begin(), near.end());
    EXPECT_EQ(std::adjacent_find(near.begin(), near.end()), near.end()) << "twice";
    tally.near += near.size();
    tally.pairs += count - 1;
    for (OutlineId o = 1; o < count; ++o) {
      Interval common;
      cut(outlines, edge, 0, common);
      cut(outlines, edge, o, common);
      if (common.low > common.high) continue;
      ++tally.met;
      if (std::binary_search(near.begin(), near.end(), o)) continue;
      ++tally.left_out;
      for (const Rational& at : {common.low, common.high, Rational((common.low + common.high) / 2)}) {
        EXPECT_TRUE(
            std::any_of(near.begin(), near.end(), [&](OutlineId c) { return holds_inside(outlines, c, edge, at); }))
            << "edge " << id << " loses outline " << o;
      }
    }
  }
}

// Slats, huge and tiny faces, and faces that reach behind the receiver, in front of a source of some size.
Corners random_corners(Random& random, double size) {
  const auto number = [&](double most) { return random.between(-most, most); };
  const double x = number(1.5 * size), y = number(1.5 * size), z = random.between(0.1, 1.0);
  const auto parallelogram = [&](const Vec3& p, const Vec3& q) {
    const Vec3 c{x, y, 1};
    return Corners{(c - p - q) * z, (c + p - q) * z, (c + p + q) * z, (c - p + q) * z};
  };
  switch (random.below(6)) {
    case 0:
      return parallelogram({2.0 * size, size, 0}, {0, 0.01 * size, 0});
    case 1:
      return parallelogram({number(3.0 * size), number(3.0 * size), 0}, {number(3.0 * size), number(3.0 * size), 0});
    case 2:
      return parallelogram({number(0.01 * size), 0, 0}, {0, number(0.01 * size), 0});
    case 3:
      return {{x, y, 1}, {number(size), number(size), 0.5}, {number(2), number(2), random.between(-1, 0.01)}};
    case 4:  // a lattice: shared lines and corners
      return parallelogram({0.5 * size, 0, 0}, {0, 0.25 * size * random.integer(1, 4), 0});
    default:
      return {{x, y, 1}, {number(size), number(size), 1}, {number(size), number(size), random.between(0.2, 1)}};
  }
}

TEST(OutlineGrid, LosesNothingThatCounts) {
  Tally tally, few;
  for (std::uint64_t i = 0; i < validation::scaled_count(30); ++i) {
    SCOPED_TRACE("seed " + std::to_string(validation::seed_of(i)));
    Random random(validation::seed_of(i));
    // Down to sources that are smaller than the error of the images.
    const double size = random.one_in(2) ? 1.0 : std::ldexp(1.0, -random.integer(1, 45));
    Seen seen;
    seen.add({{-size, -size, 1}, {size, -size, 1}, {size, size, 1}, {-size, size, 1}});
    const int count = random.integer(8, 24);
    for (int k = 0; k < count; ++k) seen.add(random_corners(random, size));
    std::vector<std::uint8_t> dropped(seen.outlines().edges().size(), 0);
    expect_nothing_lost(seen.outlines(), dropped, tally);
    for (std::uint8_t& mark : dropped) mark = random.one_in(8) ? 0 : 1;
    expect_nothing_lost(seen.outlines(), dropped, few);
  }
  EXPECT_GT(few.met, 0U);
  EXPECT_GT(tally.met, 0U);
  EXPECT_GT(tally.left_out, 0U);       // some cells are fully covered
  EXPECT_LT(tally.near, tally.pairs);  // and not everything is near everything else
}

}  // namespace
}  // namespace exactff::visibility
