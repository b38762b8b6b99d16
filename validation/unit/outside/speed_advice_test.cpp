// What exactff matrix says while it takes long.
#include "cli/view_factor_words.h"
#include "exactff/models.h"
#include "support/test.h"

namespace exactff::cli {
namespace {

TEST(SpeedAdvice, DependsOnWhatWasAsked) {
  const Scene scene = models::make_scene("closed-room");
  matrix::Request request{&scene, {scene.select("floor"), scene.select("lamp")}, {scene.select("floor")}, {}, {}};
  EXPECT_EQ(words_on_speed(request),
            "Faster: --accuracy 0.001 instead of 1e-06; a smaller --budget than 100000, for wider entries; fewer rows "
            "than 2 by --from");
  request.options.factors.certify = true;
  request.options.factors.both_directions = true;
  request.options.factors.accuracy = 0.01;
  request.options.backs = true;
  request.from.pop_back();
  EXPECT_EQ(words_on_speed(request),
            "Faster: no --certify, so that errors are estimated; no --both-directions; a smaller --budget than 100000, "
            "for wider entries; no --backs");
  request.options.factors = {.accuracy = 1e-10, .certify = true};
  EXPECT_EQ(words_on_speed(request).find("certify"), std::string::npos);
  request.options.factors.certify = false;
  EXPECT_TRUE(words_on_speed(request).starts_with("Faster: --certify, ")) << words_on_speed(request);
}

}  // namespace
}  // namespace exactff::cli
