// The faces that a result lists as cutting the source are exactly those that, each alone, reduce its visible part. This
// is checked with exact fractions, on scenes of every random family. EXACTFF_TEST_SCALE multiplies their
// number.
#include <gmpxx.h>

#include "support/oracle_check.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

class Cutters : public testing::TestWithParam<RandomFamily> {
 protected:
  // By plane.
  static std::vector<mpq_class> fractions(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                                          const std::vector<FaceId>& only) {
    const FormFactor f = exact_form_factor(scene, receiver, source, {.exact_fraction = true, .only_occluders = &only});
    std::vector<mpq_class> result;
    for (const PlaneRecord& plane : f.planes) result.emplace_back(plane.exact_fraction.value());
    return result;
  }

  static void expect_listed_as_found(const Scene& scene, const Receiver& receiver, const ExactSource& source) {
    const FormFactor f = exact_form_factor(scene, receiver, source, {.list_cutters = true});
    const bool one_hides =
        std::ranges::any_of(f.planes, [](const PlaneRecord& plane) { return plane.outcome == Outcome::kHiddenByOne; });
    const std::vector<mpq_class> whole = fractions(scene, receiver, source, {});
    EXPECT_TRUE(std::ranges::is_sorted(f.cutters));
    for (std::uint32_t k = 0; k < scene.faces().size(); ++k) {
      const FaceId face{k};
      const bool listed = std::ranges::binary_search(f.cutters, face);
      const bool cuts = fractions(scene, receiver, source, {face}) != whole;
      EXPECT_TRUE(cuts || !listed) << scene.name_of(face) << " is listed and cuts nothing";
      EXPECT_TRUE(listed || !cuts || one_hides) << scene.name_of(face) << " cuts and is not listed";
    }
    for (const PlaneRecord& plane : f.planes) {
      EXPECT_TRUE(plane.outcome != Outcome::kUnoccluded || plane.candidates == 0);
      EXPECT_LE(plane.candidates, plane.tree_candidates);
      EXPECT_LE(plane.undecided_pairs, plane.pairs);
    }
  }
};

TEST_P(Cutters, AreTheFacesThatAloneHideSomething) {
  for (std::uint64_t i = 0; i < scaled_count(1 + GetParam().count / 10); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    const generate::PlainScene plain = GetParam().make(random);
    const Scene scene = generate::build(plain);
    if (some_is_buried(scene)) continue;  // what hides only buried parts is listed
    const ExactSource source(scene, scene.select(plain.source));
    expect_listed_as_found(scene, receiver_in(scene, plain), source);
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, Cutters, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });

}  // namespace
}  // namespace exactff::validation
