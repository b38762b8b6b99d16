// Faces near a point, and regions of faces, on scenes of every random family. The judge looks at every piece of the
// scene and decides in rational numbers.
#include <gmpxx.h>

#include "support/oracle_check.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

using Rational3 = std::array<mpq_class, 3>;

Rational3 exact(const Vec3& v) { return {mpq_class(v.x), mpq_class(v.y), mpq_class(v.z)}; }
Rational3 minus(const Rational3& a, const Rational3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
mpq_class dot(const Rational3& a, const Rational3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Rational3 cross(const Rational3& a, const Rational3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A piece as it lies about a point.
class JudgedPiece {
 public:
  JudgedPiece(const Scene& scene, const Piece& piece, const Vec3& point) : x_(exact(point)) {
    for (const std::uint32_t v : scene.corners(piece)) corners_.push_back(exact(scene.vertices()[v]));
    for (std::size_t i = 2; i < corners_.size(); ++i) {
      const Rational3 n = cross(minus(corners_[i - 1], corners_[0]), minus(corners_[i], corners_[0]));
      for (std::size_t axis = 0; axis < 3; ++axis) normal_[axis] += n[axis];
    }
    height_ = dot(normal_, minus(x_, corners_[0]));
  }

  [[nodiscard]] const Rational3& normal() const { return normal_; }
  [[nodiscard]] int side() const { return sgn(height_); }
  // The shortest side: an estimate.
  [[nodiscard]] double size() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Rational3 side = minus(next(i), corners_[i]);
      least = std::min(least, std::abs(side[0].get_d()) + std::abs(side[1].get_d()) + std::abs(side[2].get_d()));
    }
    return least;
  }

  // The plane and the outline come within the distance of the point.
  [[nodiscard]] bool within(double distance) const {
    const mpq_class square = mpq_class(distance) * mpq_class(distance);
    const mpq_class height = height_ * height_ / dot(normal_, normal_);
    return height <= square && (is_above() || beside() - height <= square);
  }

 private:
  [[nodiscard]] const Rational3& next(std::size_t i) const { return corners_[(i + 1) % corners_.size()]; }

  [[nodiscard]] bool is_above() const {
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (sgn(dot(normal_, cross(minus(next(i), corners_[i]), minus(x_, corners_[i])))) < 0) return false;
    }
    return true;
  }

  // The square of the distance from the nearest side.
  [[nodiscard]] mpq_class beside() const {
    mpq_class least = -1;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Rational3 side = minus(next(i), corners_[i]), to_x = minus(x_, corners_[i]);
      const mpq_class length = dot(side, side);
      mpq_class share = sgn(length) > 0 ? mpq_class(dot(side, to_x) / length) : mpq_class(0);
      if (share < 0) share = 0;
      if (share > 1) share = 1;
      Rational3 off = to_x;
      for (std::size_t axis = 0; axis < 3; ++axis) off[axis] -= share * side[axis];
      const mpq_class square = dot(off, off);
      if (least < 0 || square < least) least = square;
    }
    return least;
  }

  Rational3 x_;
  std::vector<Rational3> corners_;
  Rational3 normal_;
  mpq_class height_;
};

// The cosine of the angle is at least that of one degree, less the margin.
bool agrees(const Rational3& a, const Rational3& b, double margin) {
  const mpq_class along = dot(a, b), cosine(0.99984769515639124 - margin);
  return along > 0 && along * along >= cosine * cosine * dot(a, a) * dot(b, b);
}

class NearFacesOf : public testing::TestWithParam<RandomFamily> {
 protected:
  // What must be found lies within the tolerance less a rounding error; what may be found, within a little more.
  static void expect_found(const Scene& scene, const Receiver& receiver, double tolerance) {
    const NearFaces found = find_faces(scene, receiver, tolerance);
    const Rational3 normal = exact(receiver.normal);
    const Rational3 against = minus(Rational3{}, normal);
    double largest = 0.0;
    for (const Vec3& v : scene.vertices()) {
      largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    bool must_find = false;
    std::set<FaceId> may;
    for (const Piece& piece : scene.pieces()) {
      const JudgedPiece judged(scene, piece, receiver.point);
      const auto is_so = [&](double margin) {
        return judged.within(tolerance * (1.0 + margin)) &&
               (agrees(judged.normal(), normal, margin) || agrees(judged.normal(), against, margin));
      };
      if (is_so(1e-6)) may.insert(piece.face);
      must_find = must_find || (judged.size() > 0x1p-300 * largest && is_so(-1e-6));
    }
    EXPECT_TRUE(!must_find || !found.faces.empty());
    if (found.faces.empty()) return;
    EXPECT_TRUE(may.contains(found.faces.front())) << scene.name_of(found.faces.front());
    std::set<int> sides;
    for (const Piece& piece : scene.pieces_of(found.faces.front())) {
      sides.insert(JudgedPiece(scene, piece, receiver.point).side());
    }
    EXPECT_TRUE(sides.contains(found.side)) << scene.name_of(found.faces.front());
    EXPECT_LE(found.distance, tolerance * (1.0 + 1e-6));
    for (const FaceId face : found.faces) {
      EXPECT_EQ(index_of(scene.face(face).patch), index_of(scene.face(found.faces.front()).patch));
    }
  }
};

TEST_P(NearFacesOf, AreWhatASearchOfAllPiecesFinds) {
  for (std::uint64_t i = 0; i < scaled_count(1 + GetParam().count / 20); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const Scene scene = generate::build(GetParam().make(random));
    std::vector<FaceId> faces;
    for (std::uint32_t f = 0; f < scene.faces().size(); ++f) faces.push_back(FaceId{f});
    for (Receiver receiver : sample_receivers(scene, faces, 4, seed_of(i))) {
      receiver.on.clear();
      const double tolerance = face_tolerance(scene, receiver.point);
      expect_found(scene, receiver, tolerance);
      const double moved = tolerance * std::ldexp(static_cast<double>(random.below(64)), -5);
      receiver.point.z += random.one_in(2) ? moved : -moved;
      if (std::isfinite(receiver.point.z)) expect_found(scene, receiver, tolerance);
    }
    if (HasFailure()) return;
  }
}

TEST_P(NearFacesOf, RegionsShareOutTheFacesAndCarryTheirReceivers) {
  for (std::uint64_t i = 0; i < scaled_count(1 + GetParam().count / 20); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const Scene scene = generate::build(GetParam().make(random));
    double largest = 0.0;
    for (const Vec3& v : scene.vertices()) {
      largest = std::max({largest, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    }
    for (const Patch& patch : scene.patches()) {
      const Selection whole = scene.select(patch.name);
      const std::vector<Region> found = regions(scene, whole);
      std::vector<FaceId> all;
      for (const Region& region : found) all.insert(all.end(), region.faces.begin(), region.faces.end());
      std::ranges::sort(all);
      EXPECT_EQ(all, scene.faces_of(whole));
      for (const Receiver& receiver : grid_receivers(scene, found, {3, 2})) {
        const bool is_planar = scene.face(receiver.on.front()).shape == FaceShape::kPlanar;
        const double off = is_planar ? 0x1p-51 : 0x1p-47;  // beside a fold, it may be moved by a few roundings
        const auto pieces = scene.pieces_of(receiver.on.front());
        EXPECT_TRUE(std::ranges::any_of(pieces, [&](const Piece& piece) {
          return JudgedPiece(scene, piece, receiver.point)
              .within(off * largest + 4.0 * std::numeric_limits<double>::denorm_min());
        })) << receiver.id;
      }
    }
    if (HasFailure()) return;
  }
}

// A tilted sheet [0, 4] x [0, 4] and faces of other patches that cover it, each nearly in its plane: of one or two
// triangles, with a corner moved by roundings.
generate::PlainScene sheet_and_covers(Random& random) {
  generate::PlainScene plain;
  const double a = random.between(0.2, 1.2), c = std::cos(a), s = std::sin(a);
  const auto at = [&](double u, double v) { return Vec3{u, c * v, 1.0 + s * v}; };
  plain.add_ring(plain.patch("own"), {at(0, 0), at(4, 0), at(4, 4), at(0, 4)});
  for (int k = random.integer(1, 3); k > 0; --k) {
    std::vector<Vec3> corners{at(-1, -1), at(9, -1), at(-1, 9)};
    if (random.one_in(2)) std::ranges::reverse(corners);
    Vec3& moved = corners[random.below(3)];
    moved.z += random.between(-1.0, 1.0) * (random.one_in(2) ? 1e-15 : 1e-12);
    plain.add_ring(plain.patch("cover" + std::to_string(k)), corners);
  }
  plain.add_ring(plain.patch("lamp"), {at(0, 2), at(0, 1), {1, 1, 9}});
  return plain;
}

// Receivers are counted if a cover fills their whole view, and not after the flag that is named has been obeyed.
TEST(NearMisses, AreHiddenWhereACoverFillsTheView) {
  std::size_t hidden = 0;
  for (std::uint64_t i = 0; i < scaled_count(20); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const Scene scene = generate::build(sheet_and_covers(random));
    std::vector<Receiver> receivers = grid_receivers(scene, scene.select("own"), {4, 4});
    if (random.one_in(2)) {
      for (Receiver& receiver : receivers)
        receiver.normal = {-receiver.normal.x, -receiver.normal.y, -receiver.normal.z};
    }
    std::size_t filled = 0;
    for (const Receiver& receiver : receivers) {
      const WholeView seen = view(scene, receiver);
      const auto covers = [&](const SeenPatch& patch) { return scene.patch(patch.patch).name.starts_with("cover"); };
      double share = seen.back.value;  // the lamp's back is small
      for (const SeenPatch& patch : seen.patches) share += covers(patch) ? patch.share.value : 0.0;
      filled += share > 0.9 ? 1 : 0;
    }
    const NearMisses misses = near_misses(scene, receivers);
    EXPECT_EQ(misses.hidden, filled);
    hidden += filled;
    if (filled == 0) continue;
    std::vector<Selection> named;
    for (const Patch& patch : scene.patches()) {
      if (misses.mends_hidden.find(patch.name) != std::string::npos) named.push_back(scene.select(patch.name));
    }
    EXPECT_TRUE(misses.mends_hidden.starts_with("--transparent "));
    EXPECT_EQ(near_misses(scene.with_transparent(named), receivers).hidden, 0U) << misses.mends_hidden;
  }
  EXPECT_GT(hidden, scaled_count(20));
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, NearFacesOf, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });

}  // namespace
}  // namespace exactff::validation
