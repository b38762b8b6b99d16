// The whole view by hand: scenes where what is seen is known, each judged in full (support/view_judge.h).
#include "support/test.h"
#include "support/view_judge.h"

namespace exactff {
namespace {

using Ring = std::vector<Vec3>;

// Patches of one face each, in this order. Counter-clockwise as seen from below looks down.
struct Named {
  const char* name;
  Ring ring;
};

PlainScene plain_of(const std::vector<Named>& faces, double scale = 1.0) {
  PlainScene plain;
  for (const Named& face : faces) {
    Ring ring = face.ring;
    for (Vec3& v : ring) v = {v.x * scale, v.y * scale, v.z * scale};
    plain.add_ring(plain.patch(face.name), ring);
  }
  return plain;
}

Ring square(double low_x, double low_y, double high_x, double high_y, double z) {  // looks down
  return {{low_x, low_y, z}, {low_x, high_y, z}, {high_x, high_y, z}, {high_x, low_y, z}};
}

Receiver looking_up(const Vec3& x = {0, 0, 0}) { return {.point = x, .normal = {0, 0, 1}, .on = {}, .id = {}}; }

void judge(const Scene& scene, const Receiver& receiver) {
  validation::expect_patches_as_the_solver(scene, receiver);
  validation::expect_shares_to_add_up(scene, receiver);
  validation::expect_shares_of_unions(scene, receiver);
  validation::expect_sides_as_rational_numbers_find(scene, receiver);
}

TEST(View, OfThreePlanesThroughOneLineHasItOnce) {
  const Scene scene = generate::build(plain_of({{"rising", {{-1, -1, 1}, {-1, 1, 1}, {1, 1, 3}, {1, -1, 3}}},
                                                {"falling", {{-1, -1, 3}, {-1, 1, 3}, {1, 1, 1}, {1, -1, 1}}},
                                                {"level", square(-1, -1, 1, 1, 2)},
                                                {"half", square(0, -1, 1, 1, 2)}}));
  judge(scene, looking_up());
  judge(scene, looking_up({0.25, 0.125, 0}));
}

TEST(View, OfDistancesFarApartIsExact) {
  judge(generate::build(plain_of({{"tiny", square(-0x1p-700, -0x1p-700, 0x1p-700, 0x1p-701, 0x1p-700)},
                                  {"usual", square(-2, -1, 3, 1, 1)},
                                  {"huge", square(-0x1p800, -0x1p800, 0x1p800, 0x1p800, 0x1p800)},
                                  {"wall", {{0.5, -1, -1}, {0.5, -1, 3}, {0.5, 2, 3}, {0.5, 2, -1}}}})),
        looking_up());
}

}  // namespace
}  // namespace exactff
