// Receivers on faces, where other faces lie exactly or nearly in their planes, and on faces that are not planar.
//
// The scenes have a tilted sheet with twins, neighbours and faces that overlap it, in its plane and a rounding beside
// it, fronts on either side; or a bent polygon beside the scene with its triangles written out. Judges are the oracle,
// the same scene without the faces in the plane, and the scene with triangles. EXACTFF_TEST_SCALE multiplies the number
// of scenes, EXACTFF_TEST_SEED selects other scenes.
#include "support/oracle.h"
#include "support/oracle_check.h"
#include "support/solve.h"
#include "support/test.h"
#include "whole_view/light.h"

namespace exactff::validation {
namespace {

using Corners = std::vector<Vec3>;

// A plane with integer points o + i u + j v + k n, which are exact in doubles.
class Lattice {
 public:
  explicit Lattice(Random& random) : random_(random) {
    // Where all coordinates are multiples of 2^31 - 1, normals vanish modulo this prime (scene/panels.cpp).
    scale_ = random.one_in(4) ? 2147483647.0 : 1.0;
    const auto small = [&] { return static_cast<double>(random.integer(-3, 3)); };
    do {
      u_ = {small(), small(), small()};
      v_ = {small(), small(), small()};
      n_ = {u_.y * v_.z - u_.z * v_.y, u_.z * v_.x - u_.x * v_.z, u_.x * v_.y - u_.y * v_.x};
    } while (n_ == Vec3{});
    o_ = {small(), small(), small()};
  }

  [[nodiscard]] Vec3 at(double i, double j, double k = 0.0) const {
    const auto sum = [&](double o, double u, double v, double n) { return scale_ * (o + i * u + j * v + k * n); };
    return {sum(o_.x, u_.x, v_.x, n_.x), sum(o_.y, u_.y, v_.y, n_.y), sum(o_.z, u_.z, v_.z, n_.z)};
  }
  [[nodiscard]] Corners rectangle(double i, double j, double width, double height, double k = 0.0) const {
    return {at(i, j, k), at(i + width, j, k), at(i + width, j + height, k), at(i, j + height, k)};
  }
  [[nodiscard]] const Vec3& normal() const { return n_; }
  [[nodiscard]] double scale() const { return scale_; }

 private:
  Random& random_;
  double scale_;
  Vec3 o_, u_, v_, n_;
};

Corners turned(Corners corners, Random& random) {
  if (random.one_in(2)) std::ranges::reverse(corners);
  return corners;
}

std::string any_name(Random& random) { return random.one_in(3) ? "sheet" : "p" + std::to_string(random.below(3)); }

// What lies in the plane of the sheet [0, 6] x [0, 6], about it.
void add_faces_in_plane(PlainScene& scene, const Lattice& in, Random& random) {
  const auto add = [&](const Corners& corners) {
    scene.add_ring(scene.patch(any_name(random)), turned(corners, random));
  };
  for (std::size_t k = 1 + random.below(4); k > 0; --k) {
    const auto whole = [&](int low, int high) { return static_cast<double>(random.integer(low, high)); };
    switch (random.below(5)) {
      case 0:  // a twin
        add(in.rectangle(0, 0, 6, 6));
        break;
      case 1:  // a twin of two triangles
        add({in.at(0, 0), in.at(6, 0), in.at(6, 6)});
        add({in.at(0, 0), in.at(6, 6), in.at(0, 6)});
        break;
      case 2:  // a neighbour
        add(in.rectangle(6, 0, 3, 6));
        break;
      case 3:  // of any size
        add(in.rectangle(whole(-4, 6), whole(-4, 6), whole(1, 8), whole(1, 8)));
        break;
      default:  // an L
        add({in.at(-1, -1), in.at(5, -1), in.at(5, 2), in.at(2, 2), in.at(2, 5), in.at(-1, 5)});
    }
  }
}

// Occluders, some of which stand on the sheet or touch its plane.
void add_things(PlainScene& scene, const Lattice& in, Random& random) {
  for (std::size_t k = random.below(4); k > 0; --k) {
    const double i = random.integer(-2, 7), j = random.integer(-2, 7), low = random.integer(0, 1);
    scene.add_ring(scene.patch("things"),
                   turned(random.one_in(2) ? Corners{in.at(i, j, low), in.at(i + 2, j, low), in.at(i + 2, j, low + 1.0)}
                                           : in.rectangle(i, j, 2, 3, 0.5 + low),
                          random));
  }
}

PlainScene scene_of_source(const Lattice& in, Random& random) {
  PlainScene scene;
  const double i = random.integer(-4, 6), j = random.integer(-4, 6);
  Corners source = in.rectangle(i, j, 5, 4, 2.0);
  if (random.one_in(2)) source[2] = in.at(i + 5, j + 4, 3.0);  // tilted or bent
  std::ranges::reverse(source);
  scene.add_ring(scene.patch("source"), source);
  return scene;
}

std::vector<Receiver> receivers_on(const Scene& scene, FaceId face, Random& random) {
  const auto n = [&] { return random.integer(1, 3); };
  switch (random.below(3)) {
    case 0:
      return grid_receivers(scene, std::vector{face}, {n(), n()});
    case 1:
      return centre_receivers(scene, std::vector{face});
    default:
      return sample_receivers(scene, std::vector{face}, 2, random.bits());
  }
}

void expect_same(const FormFactor& a, const FormFactor& b, const std::string& where) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a.value), std::bit_cast<std::uint64_t>(b.value)) << where;
  EXPECT_EQ(a.status, b.status) << where;
  EXPECT_EQ(a.visible_fraction, b.visible_fraction) << where;
}

// Of the source, by both engines, and by methods that are sampled in the same way.
void expect_same_values(const Scene& one, const Receiver& of_one, const Scene& other, const Receiver& of_other,
                        const std::string& where) {
  const Selection a = one.select("source"), b = other.select("source");
  for (const Engine engine : kEngines) {
    const ExactOptions options{.engine = engine, .visible_fraction = true};
    expect_same(exact_form_factor(one, of_one, {one, a}, options),
                exact_form_factor(other, of_other, {other, b}, options), where + ", " + std::string(to_string(engine)));
  }
  for (const std::string text : {"adaptive:eps_B=0.05,rays=4,depth_cap=4", "hemicube:resolution=20",
                                 "area-sampling:samples=16,pattern=stratified", "wallace:splits=3"}) {
    const methods::Choice choice = methods::parse(text);
    const auto value = [&](const Scene& scene, const Receiver& receiver, const Selection& source) {
      const auto on_scene = choice.method->prepare(scene);
      const auto prepared = on_scene->prepare_source(source);
      const auto evaluator = on_scene->configure(choice.settings);
      evaluator->look_from(receiver);
      return evaluator->form_factor(*prepared).form_factor;
    };
    EXPECT_EQ(value(one, of_one, a), value(other, of_other, b)) << where << ", " << text;
  }
}

TEST(OwnPlanes, HoldNothingThatHidesOrLights) {
  for (std::uint64_t k = 0; k < scaled_count(40); ++k) {
    Random random(seed_of(k));
    const Lattice in(random);
    PlainScene plain = scene_of_source(in, random);
    plain.add_ring(plain.patch("own"), in.rectangle(0, 0, 6, 6));
    add_things(plain, in, random);
    const Scene alone = generate::build(plain);
    add_faces_in_plane(plain, in, random);
    const Scene scene = generate::build(plain);
    const FaceId own = scene.faces_of(scene.select("own")).front();
    for (const Receiver& receiver : receivers_on(scene, own, random)) {
      const std::string where = "seed " + std::to_string(seed_of(k)) + "\n" + generate::to_obj(plain);
      ASSERT_EQ(disagreement(scene, receiver, scene.select("source")), "") << where;
      expect_same_values(scene, receiver, alone, receiver, where);
      const WholeView seen = view(scene, receiver);
      EXPECT_NO_THROW(whole_view::require_agreement(scene, receiver, {}, seen)) << where;
      EXPECT_EQ(seen.open.value, view(alone, receiver).open.value) << where;
      if (testing::Test::HasFailure()) return;
    }
  }
}

// What is only nearly in the plane hides, as the oracle says.
TEST(OwnPlanes, AreExact) {
  for (std::uint64_t k = 0; k < scaled_count(40); ++k) {
    Random random(seed_of(k));
    const Lattice in(random);
    PlainScene plain = scene_of_source(in, random);
    plain.add_ring(plain.patch("own"), in.rectangle(0, 0, 6, 6));
    const std::size_t first = plain.vertices.size();
    add_faces_in_plane(plain, in, random);
    for (std::size_t v = first; v < plain.vertices.size(); ++v) {
      if (random.one_in(3))
        plain.vertices[v].x = std::nextafter(plain.vertices[v].x, random.one_in(2) ? 1e300 : -1e300);
    }
    const Scene scene = generate::build(plain, {}, {.bad_faces = BadFaces::kSkip});
    const FaceId own = scene.faces_of(scene.select("own")).front();
    for (const Receiver& receiver : receivers_on(scene, own, random)) {
      ASSERT_EQ(disagreement(scene, receiver, scene.select("source")), "") << "seed " << seed_of(k) << '\n'
                                                                           << generate::to_obj(plain);
    }
  }
}

// --- Faces that are not planar ---

// A convex polygon as seen along the lattice's normal.
Corners bent_polygon(const Lattice& in, Random& random) {
  const auto height = [&] { return random.one_in(3) ? random.integer(-1, 1) * 0x1p-40 : 0.5 * random.integer(-2, 2); };
  Corners corners{in.at(0, 0, height()), in.at(6, 0, height()), in.at(6, 6, height())};
  if (random.one_in(2)) corners.push_back(in.at(2, 7, height()));
  corners.push_back(in.at(0, 6, height()));
  return corners;
}

struct BentScenes {
  PlainScene plain;
  Scene bent, cut;
};

// The polygon `own` as one face, and as its triangles in the order of its pieces. Other patches are the same.
BentScenes bent_scenes(Random& random) {
  const Lattice in(random);
  PlainScene plain = scene_of_source(in, random);
  add_things(plain, in, random);
  PlainScene cut = plain;
  plain.add_ring(plain.patch("own"), bent_polygon(in, random));
  Scene bent =
      generate::build(plain, {}, {.bad_faces = BadFaces::kSkip});  // seen along its Newell vector, it may cross itself
  PlainScene with_triangles = std::move(cut);
  for (const Piece& piece : bent.pieces()) {
    if (bent.face(piece.face).patch != bent.select("own").patch) continue;
    Corners corners;
    for (const std::uint32_t v : bent.corners(piece)) corners.push_back(bent.vertices()[v]);
    with_triangles.add_ring(with_triangles.patch("own"), corners);
  }
  Scene triangles = generate::build(with_triangles);
  return {std::move(plain), std::move(bent), std::move(triangles)};
}

TEST(OwnPlanes, OfABentFaceAreThoseOfItsTriangle) {
  std::size_t bent = 0;
  for (std::uint64_t k = 0; k < scaled_count(40); ++k) {
    Random random(seed_of(k));
    const BentScenes scenes = bent_scenes(random);
    const FaceId face = scenes.bent.patch(scenes.bent.select("own").patch).faces.front();
    if (scenes.bent.face(face).shape != FaceShape::kTriangulated) continue;
    ++bent;
    const std::vector<FaceId> triangles = scenes.cut.faces_of(scenes.cut.select("own"));
    for (Receiver receiver : receivers_on(scenes.bent, face, random)) {
      const bool is_moved = random.one_in(3);  // as if given by coordinates
      if (is_moved) receiver.point.x += 0x1p-20;
      const std::string where = "seed " + std::to_string(seed_of(k)) + "\n" + generate::to_obj(scenes.plain);
      ASSERT_EQ(disagreement(scenes.bent, receiver, scenes.bent.select("source")), "") << where;
      const std::vector<bool> own = own_pieces(scenes.bent, receiver);
      const std::uint32_t first = scenes.bent.face(face).first_piece;
      const auto lies_on = std::ranges::find(own.begin() + first, own.end(), true) - own.begin() - first;
      Receiver on_triangle = receiver;
      on_triangle.on = {triangles[static_cast<std::size_t>(lies_on)]};
      expect_same_values(scenes.bent, receiver, scenes.cut, on_triangle, where);
      const WholeView a = view(scenes.bent, receiver), b = view(scenes.cut, on_triangle);
      EXPECT_NO_THROW(whole_view::require_agreement(scenes.bent, receiver, {}, a)) << where;
      EXPECT_EQ(a.open.value, b.open.value) << where;
      EXPECT_EQ(a.back.value, b.back.value) << where;
      EXPECT_TRUE(is_moved || receiver.normal == scenes.cut.face(on_triangle.on.front()).newell) << where;
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(bent, scaled_count(40) / 4);
}

// As a source, too: from one half to the other, both ways, and to the rest of the scene.
TEST(OwnPlanes, MatrixOfABentFaceIsThatOfItsTriangles) {
  for (std::uint64_t k = 0; k < scaled_count(8); ++k) {
    Random random(seed_of(k));
    const BentScenes scenes = bent_scenes(random);
    if (scenes.bent.faces_of(scenes.bent.select("own")).empty()) continue;
    const auto compute = [](const Scene& scene) {
      std::vector<Selection> patches;
      for (std::size_t p = 0; p < scene.patches().size(); ++p)
        patches.push_back({static_cast<PatchId>(p), {}, scene.id()});
      return matrix::compute(scene, patches, patches,
                             {.factors = {.accuracy = 1e-3, .both_directions = true}, .backs = true, .open = true});
    };
    const matrix::Matrix bent = compute(scenes.bent), cut = compute(scenes.cut);
    for (std::size_t i = 0; i < bent.factors.entries.size(); ++i) {
      const ViewFactor &a = bent.factors.entries[i], &b = cut.factors.entries[i];
      EXPECT_LE(std::max(a.lower, b.lower), std::min(a.upper, b.upper)) << i << ", seed " << seed_of(k) << '\n'
                                                                        << generate::to_obj(scenes.plain);
    }
    EXPECT_TRUE(reciprocity(bent).apart.empty()) << seed_of(k);
    EXPECT_GT(reciprocity(bent).pairs, 0U);
    if (!reasons_against_one(scenes.bent, bent).empty()) continue;
    for (const matrix::Sum& row : row_sums(bent)) {
      EXPECT_LE(row.lower, 1.0) << seed_of(k);
      EXPECT_GE(row.upper, 1.0) << seed_of(k);
    }
  }
}

}  // namespace
}  // namespace exactff::validation
