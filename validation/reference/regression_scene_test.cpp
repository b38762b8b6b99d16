// Scenes that once caused a fault other than a wrong value. Each is data/regression/NAME.obj with receivers in
// NAME.csv. Every function for a receiver and a source is called for every receiver and every patch.
#include "report/report.h"
#include "support/test.h"
#include "support/view_judge.h"

namespace exactff::validation {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> scene_paths() {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(EXACTFF_DATA_DIR "/regression")) {
    if (entry.path().extension() == ".obj") paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  return paths;
}

bool is_finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void expect_finite(const std::vector<Loop>& loops) {
  for (const Loop& loop : loops) EXPECT_TRUE(std::ranges::all_of(loop.corners, is_finite));
}

class RegressionScene : public testing::TestWithParam<fs::path> {
 protected:
  // Calls ask(receiver, source) for every receiver and every patch with area.
  void for_each_pair(const auto& ask) const {
    for (std::uint32_t p = 0; p < scene_.patches().size(); ++p) {
      const Selection source{PatchId{p}, {}, scene_.id()};
      if (scene_.faces_of(source).empty()) continue;
      SCOPED_TRACE("patch " + std::to_string(p));
      for (const Receiver& receiver : receivers_) ask(receiver, source);
    }
  }

  const Scene scene_ = read_obj(GetParam());
  const std::vector<Receiver> receivers_ = read_receivers(fs::path(GetParam()).replace_extension(".csv"), scene_);
};

TEST_P(RegressionScene, BothEnginesAgreeOnAllThatCanBeAsked) {
  for_each_pair([&](const Receiver& receiver, const Selection& selection) {
    const ExactSource source(scene_, selection);
    const FormFactor f =
        exact_form_factor(scene_, receiver, source,
                          {.engine = Engine::kBoth, .exact_fraction = true, .list_cutters = true, .digits = 20});
    EXPECT_NE(f.status, Status::kNotCertified);
    EXPECT_TRUE(f.lower <= f.value && f.value <= f.upper);
  });
}

TEST_P(RegressionScene, IsDrawn) {
  for_each_pair([&](const Receiver& receiver, const Selection& selection) {
    const ExactSource source(scene_, selection);
    const FormFactor f = exact_form_factor(scene_, receiver, source);
    for (const PlaneDrawing& drawing : draw_visibility(scene_, receiver, source)) {
      for (const auto* loops : {&drawing.source, &drawing.clipped_source, &drawing.visible}) expect_finite(*loops);
      for (const PlaneDrawing::Shadow& shadow : drawing.shadows) expect_finite({shadow.outline});
    }
    const std::string svg = report::visibility_svg(scene_, receiver, source, f);
    EXPECT_TRUE(svg.ends_with("</svg>\n"));
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
  });
}

// Shares add up to 1, each front counts once, and form factors are those of the pairs.
TEST_P(RegressionScene, IsSeenOnceInEachDirection) {
  for (const Receiver& receiver : receivers_) {
    expect_patches_as_the_solver(scene_, receiver);
    expect_shares_to_add_up(scene_, receiver);
    expect_shares_of_unions(scene_, receiver);
    expect_sides_as_rational_numbers_find(scene_, receiver);
  }
}

// A method may refuse a scene with a message.
TEST_P(RegressionScene, EveryMethodGivesAShareOrRefuses) {
  for (const methods::Method* method : methods::all_methods()) {
    SCOPED_TRACE(method->name);
    try {
      const auto on_scene = method->prepare(scene_);
      const auto evaluator = on_scene->configure(method->defaults());
      for_each_pair([&](const Receiver& receiver, const Selection& selection) {
        const double value = evaluator->form_factor(receiver, *on_scene->prepare_source(selection)).form_factor;
        EXPECT_GE(value, 0.0);
        EXPECT_TRUE(value <= 1.0 || (method->can_leave_unit && method->can_leave_unit(method->defaults()))) << value;
        EXPECT_TRUE(std::isfinite(value));
      });
    } catch (const InputError& refusal) {
      EXPECT_NE(method->name, "exact") << refusal.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Data, RegressionScene, testing::ValuesIn(scene_paths()),
                         [](const auto& path) { return path.param.stem().string(); });

}  // namespace
}  // namespace exactff::validation
