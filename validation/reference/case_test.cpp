// Every case of data/reference and data/regression, with the library and with the program as a script would call it.
#include <cstdlib>

#include "support/case_file.h"
#include "support/decimal.h"
#include "support/solve.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

std::vector<std::filesystem::path> all_cases() {
  std::vector<std::filesystem::path> paths = case_paths(EXACTFF_DATA_DIR "/reference");
  std::ranges::copy(case_paths(EXACTFF_DATA_DIR "/regression"), std::back_inserter(paths));
  return paths;
}

std::string name_of(const testing::TestParamInfo<std::filesystem::path>& info) {
  return test_name(info.param.parent_path().filename().string() + "_" + info.param.stem().string());
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

void expect_value(const FormFactor& result, const Expected& expected) {
  EXPECT_EQ(bits(result.value), bits(expected.nearest))
      << generate::to_text(result.value) << " instead of " << generate::to_text(expected.nearest);
  EXPECT_EQ(result.status == Status::kZero, expected.exact_zero) << to_string(result.status);
}

class ReferenceCase : public testing::TestWithParam<std::filesystem::path> {
 protected:
  CaseFile file_ = read_case(GetParam());
};
INSTANTIATE_TEST_SUITE_P(Files, ReferenceCase, testing::ValuesIn(all_cases()), name_of);

TEST_P(ReferenceCase, LibraryGivesTheNearestDouble) {
  const Scene scene = generate::build(file_.scene);
  expect_value(solve(scene, file_.scene), file_.expected);
}

TEST_P(ReferenceCase, ObjTextGivesTheNearestDouble) {
  const TemporaryDirectory directory;
  const auto path =
      directory.write(file_.name + ".obj", generate::to_obj(file_.scene, {}, generate::Digits::kSeventeen));
  expect_value(solve(read_obj(path), file_.scene), file_.expected);
}

TEST_P(ReferenceCase, ProgramPrintsTheNearestDouble) {
  const ProgramRun run = run_point_plain(EXACTFF_PROGRAM, file_.name, file_.scene);
  EXPECT_EQ(run.exit_code, 0);
  char* end = nullptr;
  EXPECT_EQ(bits(std::strtod(run.output.c_str(), &end)), bits(file_.expected.nearest)) << run.output;
  EXPECT_STREQ(end, "\n") << "stdout holds the value and nothing else";
  EXPECT_EQ(run.output == "0\n", file_.expected.exact_zero);
}

TEST_P(ReferenceCase, EnclosureIsCertifiedToTheWidthOfADouble) {
  const Scene scene = generate::build(file_.scene);
  const FormFactor result = solve(scene, file_.scene);
  EXPECT_LE(result.enclosure.lower(), result.enclosure.upper());
  if (file_.expected.exact_zero) {
    EXPECT_EQ(result.lower, 0.0);
    EXPECT_EQ(result.upper, 0.0);
    return;
  }
  ASSERT_EQ(result.status, Status::kCertified);
  EXPECT_EQ(bits(result.enclosure.nearest().value()), bits(result.value));
  EXPECT_EQ(result.lower, std::nextafter(result.value, 0.0));
  EXPECT_EQ(result.upper, std::min(1.0, std::nextafter(result.value, 2.0)));
  EXPECT_GE(result.enclosure.lower(), result.lower);
  EXPECT_LE(result.enclosure.upper(), result.upper);
}

TEST_P(ReferenceCase, EnclosureHoldsTheThirtyDigits) {
  const Scene scene = generate::build(file_.scene);
  const FormFactor result = solve(scene, file_.scene);
  const Decimal printed = read_decimal(file_.expected.decimals);
  const mpq_class middle = read_decimal(result.enclosure.midpoint()).value;
  const mpq_class radius = read_decimal(result.enclosure.radius()).value;
  EXPECT_LE(abs(middle - printed.value), radius + printed.half_unit)
      << result.enclosure.midpoint() << " +/- " << result.enclosure.radius() << " against " << file_.expected.decimals;
}

TEST_P(ReferenceCase, ThirtyDigitsAreCertifiedOnRequest) {
  if (file_.expected.exact_zero) return;
  const Scene scene = generate::build(file_.scene);
  ExactOptions options;
  options.digits = 30;
  const std::optional<std::string> digits = solve(scene, file_.scene, options).enclosure.decimals(30);
  ASSERT_TRUE(digits.has_value());
  EXPECT_EQ(read_decimal(*digits).value, read_decimal(file_.expected.decimals).value) << *digits;
}

int ulps_between(double a, double b) {
  int count = 0;
  for (; a != b && count < 100; ++count) a = std::nextafter(a, b);
  return count;
}

TEST_P(ReferenceCase, VisibleFractionIsWithinTwoUlpInEachPlane) {
  const Scene scene = generate::build(file_.scene);
  ExactOptions options;
  options.visible_fraction = true;
  const FormFactor result = solve(scene, file_.scene, options);
  std::vector<double> found;
  for (const PlaneRecord& plane : result.planes) found.push_back(plane.visible_fraction.value());
  std::vector<double> expected = file_.expected.visible_fractions;
  std::ranges::sort(found);
  std::ranges::sort(expected);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LE(ulps_between(found[i], expected[i]), 2) << found[i] << " against " << expected[i];
    EXPECT_EQ(found[i] == 0.0, expected[i] == 0.0);
    EXPECT_EQ(found[i] == 1.0, expected[i] == 1.0);
  }
}

// A unit square so far away that its form factor, about 2^-1202 / pi, is positive but rounds to zero.
TEST(ReferenceCases, ProgramPrintsAnUnderflowAsZeroPointZero) {
  generate::PlainScene scene;
  scene.add_ring(scene.patch("source"), {{0, 0, 0x1p601}, {0, 1, 0x1p601}, {1, 1, 0x1p601}, {1, 0, 0x1p601}});
  EXPECT_EQ(solve(generate::build(scene), scene).status, Status::kUnderflow);
  EXPECT_EQ(run_point_plain(EXACTFF_PROGRAM, "far", scene).output, "0.0\n");
}

TEST(ReferenceCases, ProgramTakesSourcesOfAnyName) {
  for (const char* name : {"2^-300", "a:1", "1e5", "$HOME", "Größe"}) {
    generate::PlainScene scene;
    scene.source = name;
    scene.add_ring(scene.patch(name), {{-0.5, 0.5, 1}, {0.5, 0.5, 1}, {0.5, -0.5, 1}, {-0.5, -0.5, 1}});
    EXPECT_EQ(run_point_plain(EXACTFF_PROGRAM, name, scene).output, "0.23945647046077354\n") << name;
  }
}

TEST(ReferenceCases, AllFortyAreThere) { EXPECT_EQ(case_paths(EXACTFF_DATA_DIR "/reference").size(), 40u); }

}  // namespace
}  // namespace exactff::validation
