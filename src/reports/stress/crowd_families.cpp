// Many occluders, many shared edges, or many edges through one point. The stiffness is their number.
#include <cmath>

#include "stress/family.h"

namespace exactff::stress {

namespace {

constexpr Vec3 kOrigin{0, 0, 0};

// The side n of a square of n × n.
int side_of(double count) { return static_cast<int>(std::lround(std::sqrt(count))); }

// Tile k of n across [-1/2, 1/2]. Neighbours abut exactly, since both round the same quotient.
Span tile(int k, int n) { return {static_cast<double>(k) / n - 0.5, static_cast<double>(k + 1) / n - 0.5}; }

template <class Keep>
Stage tile_stage(int n, const Keep& keep) {
  Stage stage(kOrigin, kUp);
  stage.add_level_source(kSide, kSide, 1);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      if (keep(i, j)) stage.add_level_occluder(tile(i, n), tile(j, n), 0.5);
    }
  }
  return stage;
}

Case tiles(double s) {
  return tile_stage(side_of(s), [](int, int) { return true; }).finish(s, ClosedForm(kUp));
}

Case tiles_one_missing(double s) {
  const int n = side_of(s), middle = n / 2;
  ClosedForm truth(kUp);
  truth.add(LevelView(kOrigin, 1).shadow(tile(middle, n), tile(middle, n), 0.5));
  return tile_stage(n, [&](int i, int j) { return i != middle || j != middle; }).finish(s, std::move(truth));
}

Case rings(double s) {
  const Vec3 point{0.0625, 0.03125, 0};
  const int n = static_cast<int>(s);
  const LevelView view(point, 1);
  Stage stage(point, kUp);
  stage.add_level_source(kSide, kSide, 1);
  ClosedForm truth(kUp);
  truth.add(view.shadow(kSide, kSide, 1));
  for (int k = 0; k < n; ++k) {
    const double inner = 0.4 * (2 * k + 1) / (2 * n), outer = 0.4 * (2 * k + 2) / (2 * n);
    const Span in{-inner, inner}, out{-outer, outer};
    stage.add_occluder_with_hole(Stage::level_ring(out, out, 0.5), Stage::level_ring(in, in, 0.5));
    truth.add(view.shadow(out, out, 0.5), -1);
    truth.add(view.shadow(in, in, 0.5));
  }
  return stage.finish(s, std::move(truth));
}

Case blinds(double s) {
  const Vec3 point{0.1, 0.05, 0};
  const int n = static_cast<int>(s);
  const double pitch = 1.2 / n;
  const LevelView view(point, 1);
  Stage stage(point, kUp);
  stage.add_level_source(kSide, kSide, 1);
  std::vector<Interval> shadows;
  for (int k = 0; k < n; ++k) {
    const double x = -0.6 + (k + 0.5) * pitch, half = 0.25 * pitch;
    const ProfilePoint from{x - half, 0.5 + half}, to{x + half, 0.5 - half};
    stage.add_slat(from, to, {-4, 4});
    shadows.push_back(view.shadow(from, to));
  }
  return stage.finish(s, left_by_strips(kUp, view.shadow(kSide, kSide, 1), std::move(shadows)));
}

// Triangles from the point (0, 0, 1/2) outwards, between directions that run counter-clockwise through one quadrant.
// Every other sector is hidden, and a quarter turn exchanges hidden and visible sectors. Requires an even number of
// directions, the last a quarter turn from the first.
struct Direction {
  double x = 1.0;
  double y = 0.0;
};

Case fan_of(double s, std::vector<Direction> quadrant) {
  Stage stage(kOrigin, kUp);
  stage.add_level_source(kSide, kSide, 1);
  for (std::size_t turn = 0; turn < 4; ++turn) {
    for (std::size_t k = turn % 2; k + 1 < quadrant.size(); k += 2) {
      const Direction &a = quadrant[k], &b = quadrant[k + 1];
      stage.add_occluder({{0, 0, 0.5}, {2 * b.x, 2 * b.y, 0.5}, {2 * a.x, 2 * a.y, 0.5}});
    }
    for (Direction& d : quadrant) d = {-d.y, d.x};
  }
  ClosedForm truth(kUp);
  truth.add(LevelView(kOrigin, 1).shadow(kSide, kSide, 1), Rational(1, 2));
  return stage.finish(s, std::move(truth));
}

Case fan(double s) {
  const int n = static_cast<int>(s);
  std::vector<Direction> quadrant;
  for (int k = 0; k < n; ++k) quadrant.push_back({1, static_cast<double>(k) / n});
  for (int k = n; k >= 0; --k) quadrant.push_back({static_cast<double>(k) / n, 1});
  quadrant.insert(quadrant.begin() + 1, {1, 0.5 / n});
  return fan_of(s, std::move(quadrant));
}

Case thin_fan(double s) { return fan_of(s, {{1, 0}, {1, 1 / s}, {0.5, 1}, {0, 1}}); }

// Plates that leave a polygon about as wide as 1/s between them: the lines of their edges almost meet in one point.
Case concurrent(double s) {
  constexpr int kSteps = 8;  // directions per half quadrant
  Stage stage({0.0625, 0.03125, 0}, kUp);
  stage.add_level_source(kSide, kSide, 1);
  for (int k = 0; k < kSteps; ++k) {
    Direction d{1, static_cast<double>(k) / kSteps};
    for (int turn = 0; turn < 4; ++turn) {
      const Direction n{d.y / s, -d.x / s};
      stage.add_occluder({{n.x + 4 * d.x, n.y + 4 * d.y, 0.5},
                          {n.x - 4 * d.x, n.y - 4 * d.y, 0.5},
                          {n.x + 4 * d.y, n.y - 4 * d.x, 0.5}});
      d = {-d.y, d.x};
    }
  }
  return stage.finish(s, std::nullopt);
}

std::vector<double> squares(std::vector<double> sides) {
  for (double& side : sides) side *= side;
  return sides;
}

}  // namespace

std::vector<Family> crowd_families() {
  return {
      {{"tiles", "Tiles that cover the source exactly", "number of tiles",
        "n × n abutting squares; the outermost edges fall exactly on the source's. F is exactly 0; errors are relative "
        "to the unoccluded form factor."},
       squares({1, 2, 4, 8, 16, 32, 64}),
       tiles},
      {{"tiles-one-missing", "Tiles at rounded corners, one missing", "number of tiles",
        "n × n squares with the middle one missing. Their corners are multiples of 1 / odd number, rounded to doubles. "
        "Only the gap is visible."},
       squares({1, 3, 5, 9, 17, 33, 65}),
       tiles_one_missing},
      {{"rings", "Nested rings", "number of rings",
        "Nested square rings (faces with holes). The gaps between them are as wide as the rings."},
       {1, 3, 10, 30, 100, 300, 1000},
       rings},
      {{"blinds", "Venetian blind", "number of slats",
        "Tilted slats. From ten slats on, about half of the source is visible."},
       {1, 10, 30, 100, 300, 1000, 3000, 10000},
       blinds},
      {{"fan", "Edges meeting at a point", "(edges - 4) / 8",
        "Triangles with one common corner hide every second sector around it. A quarter turn exchanges hidden and "
        "visible sectors, so F is half of the unoccluded form factor.",
        Evidence::kSymmetry},
       {1, 3, 10, 30, 100, 300},
       fan},
      {{"thin-fan", "Edges that meet at a vanishing angle", "1 / angle",
        "The same with four sectors that become thinner and thinner.", Evidence::kSymmetry},
       decades(300),
       thin_fan},
      {{"concurrent", "Edges that almost meet", "1 / distance from the common point",
        "32 plates whose edges pass a point at a vanishing distance leave a polygon of that size.",
        Evidence::kCertified},
       octaves(48, 2),
       concurrent},
  };
}

}  // namespace exactff::stress
