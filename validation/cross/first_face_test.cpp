// The first face that a ray meets, compared with a search over all faces in rational numbers. It shares only the
// vertices and rings of the scene with the library: no pieces, no tree, no filter, another test for inside.
#include "support/oracle_faces.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

using render::Hit;
using render::Ray;

struct Met {
  FaceId face{};
  bool back = false;
  Rational t;
  Vector point;
};

class BruteForce {
 public:
  explicit BruteForce(const Scene& scene) {
    const Vector origin{0, 0, 0};
    for (std::size_t f = 0; f < scene.faces().size(); ++f) {
      const auto id = static_cast<FaceId>(f);
      if (scene.face(id).transparent) continue;
      for (Polygon& polygon : polygons_of(scene, id, origin)) polygons_.push_back(std::move(polygon));
    }
  }

  [[nodiscard]] std::optional<Met> first(const Ray& ray) const {
    const Vector o = exact(ray.origin), d = exact(ray.direction);
    std::optional<Met> best;
    for (const Polygon& polygon : polygons_) {
      const Rational facing = dot(polygon.normal, d);
      if (sgn(facing) == 0) continue;
      const Rational t = (polygon.offset - dot(polygon.normal, o)) / facing;
      const bool back = sgn(facing) > 0;
      if (sgn(t) <= 0 || (best && !is_better(t, polygon.face, back, *best))) continue;
      const Vector point{o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]};
      if (contains(polygon, point)) best = Met{polygon.face, back, t, point};
    }
    return best;
  }

 private:
  // Nearer; then the front; then the lower index.
  static bool is_better(const Rational& t, FaceId face, bool back, const Met& best) {
    if (t != best.t) return t < best.t;
    return back != best.back ? best.back : face < best.face;
  }

  // Requires a point in the plane. The boundary belongs to the face.
  static bool contains(const Polygon& polygon, const Vector& point) {
    int drop = 0;
    while (sgn(polygon.normal[drop]) == 0) ++drop;
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    bool inside = false;
    for (const Corners& ring : polygon.rings) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vector &a = ring[i], &b = ring[(i + 1) % ring.size()];
        const Rational ax = a[u] - point[u], ay = a[v] - point[v], bx = b[u] - point[u], by = b[v] - point[v];
        const Rational side = ax * by - bx * ay;
        if (sgn(side) == 0 && ax * bx + ay * by <= 0) return true;
        if ((sgn(ay) > 0) != (sgn(by) > 0) && (sgn(side) > 0) == (sgn(by) > 0)) inside = !inside;
      }
    }
    return inside;
  }

  std::vector<Polygon> polygons_;
};

// True if no double is nearer to the number; of two that are equally near, the even one is not required.
bool is_nearest(double value, const Rational& number) {
  const Rational off = abs(number - Rational(value));
  for (const double toward : {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}) {
    const double neighbour = std::nextafter(value, toward);
    if (std::isfinite(neighbour) && abs(number - Rational(neighbour)) < off) return false;
  }
  return true;
}

Vec3 difference(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 middle(const Vec3& a, const Vec3& b) {
  return {0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y, 0.5 * a.z + 0.5 * b.z};
}

// Rays that begin at and lead to special places: vertices, edges, faces, the receiver; along axes, in planes of faces.
Ray special_ray(const Scene& scene, const Vec3& receiver, Random& random) {
  const auto vertices = scene.vertices();
  const auto vertex = [&]() -> const Vec3& { return vertices[random.below(vertices.size())]; };
  const auto place = [&] {
    const std::size_t kind = random.below(5);
    return kind == 0   ? receiver
           : kind == 1 ? vertex()
           : kind == 2 ? middle(vertex(), vertex())
                       : middle(middle(vertex(), vertex()), vertex());
  };
  const Vec3 origin = random.one_in(2) ? receiver : place();
  if (random.one_in(8)) {
    const double sign = random.one_in(2) ? 1.0 : -1.0;
    const std::size_t axis = random.below(3);
    return {origin, {axis == 0 ? sign : 0.0, axis == 1 ? sign : 0.0, axis == 2 ? sign : 0.0}};
  }
  return {origin, difference(place(), origin)};
}

bool is_usable(const Ray& ray) {
  const Vec3& d = ray.direction;
  return std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z) && !(d == Vec3{});
}

std::string words(const Ray& ray) {
  const auto of = [](const Vec3& v) {
    return generate::to_text(v.x) + ' ' + generate::to_text(v.y) + ' ' + generate::to_text(v.z);
  };
  return "from " + of(ray.origin) + " along " + of(ray.direction);
}

struct Count {
  int rays = 0, hits = 0, backs = 0;
};

void compare(const Scene& scene, const BruteForce& all, const Ray& ray, Count& count) {
  const std::optional<Met> truth = all.first(ray);
  const std::optional<Hit> found = render::first_hit(scene, ray);
  ++count.rays;
  ASSERT_EQ(found.has_value(), truth.has_value()) << words(ray);
  if (!truth) return;
  ++count.hits;
  if (truth->back) ++count.backs;
  if (!some_is_buried(scene)) {  // where solids touch, other rules tell which face is first in a plane
    EXPECT_EQ(found->face, truth->face) << words(ray);
    EXPECT_EQ(found->back, truth->back) << words(ray);
  }
  EXPECT_TRUE(is_nearest(found->point.x, truth->point[0]) && is_nearest(found->point.y, truth->point[1]) &&
              is_nearest(found->point.z, truth->point[2]))
      << words(ray) << ": " << words({found->point, found->point});
}

TEST(FirstFace, AgreesWithASearchInRationalsOnEveryRandomFamily) {
  constexpr int kRays = 24;
  for (const RandomFamily& family : random_families()) {
    Count count;
    for (std::uint64_t i = 0; i < scaled_count(std::max<std::uint64_t>(family.count / 4, 8)); ++i) {
      Random random(seed_of(i));
      const generate::PlainScene plain = family.make(random);
      const Scene scene = generate::build(plain);
      const BruteForce all(scene);
      for (int k = 0; k < kRays; ++k) {
        const Ray ray = special_ray(scene, plain.point, random);
        if (is_usable(ray)) compare(scene, all, ray, count);
      }
      ASSERT_FALSE(testing::Test::HasFailure()) << family.name << " scene " << i << ", seed " << seed_of(i) << '\n'
                                                << generate::to_obj(plain);
    }
    EXPECT_GT(count.hits, count.rays / 20) << family.name;  // the rays find something to decide
  }
}

void compare_pictures(const Scene& scene, const Vec3& inside, std::uint64_t rays) {
  const BruteForce all(scene);
  Random random(seed_of(1));
  Count count;
  for (std::uint64_t k = 0; k < scaled_count(rays); ++k) {
    const Ray ray = special_ray(scene, inside, random);
    if (is_usable(ray)) compare(scene, all, ray, count);
  }
  EXPECT_GT(count.hits, count.rays / 4);
}

TEST(FirstFace, AgreesWithASearchInRationalsOnRooms) {
  compare_pictures(read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj"), {278, 273, -800}, 400);
  compare_pictures(read_obj(EXACTFF_DATA_DIR "/scenes/blinds_room.obj"), {2, 1.5, 2.5}, 400);
  compare_pictures(models::make_scene("closed-room:lamp=hanging"), {3, 2, 1.5}, 200);
}

TEST(FirstFace, AgreesWithASearchInRationalsOnModels) {
  compare_pictures(models::make_scene("teapot:segments=3"), {6, -9, 5}, 100);
  compare_pictures(models::make_scene("forest:n=300,trees=4"), {20, 20, 1.5}, 100);
  compare_pictures(models::make_scene("lattice:n=60"), {0, 0, 0}, 300);
}

// A thin lamp: each side shows the face that looks to it, whichever comes first.
TEST(FirstFace, OfCoincidentFacesIsAFront) {
  const std::vector<Vec3> up = {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}}, down(up.rbegin(), up.rend());
  for (const bool up_first : {true, false}) {
    generate::PlainScene plain;
    plain.add_ring(plain.patch("first"), up_first ? up : down);
    plain.add_ring(plain.patch("second"), up_first ? down : up);
    const Scene scene = generate::build(plain);
    const Hit below = *render::first_hit(scene, {{0, 0, 0}, {0.25, 0, 1}}),
              above = *render::first_hit(scene, {{0, 0, 4}, {0.25, 0, -1}});
    EXPECT_EQ(below, (Hit{FaceId{up_first ? 1U : 0U}, false, {0.5, 0, 2}}));
    EXPECT_EQ(above, (Hit{FaceId{up_first ? 0U : 1U}, false, {0.5, 0, 2}}));
  }
}

TEST(FirstFace, TransparentFacesArePassed) {
  generate::PlainScene plain;
  plain.add_ring(plain.patch("pane"), {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});
  plain.add_ring(plain.patch("wall"), {{-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}});
  const Scene scene = generate::build(plain);
  const Scene clear = scene.with_transparent(std::vector{scene.select("pane")});
  EXPECT_EQ(render::first_hit(scene, {{0, 0, 0}, {0, 0, 1}})->face, FaceId{0});
  EXPECT_EQ(render::first_hit(clear, {{0, 0, 0}, {0, 0, 1}})->face, FaceId{1});
}

}  // namespace
}  // namespace exactff::validation
