#include <chrono>
#include <csignal>
#include <thread>

#include "files/numpy.h"
#include "support/test.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

class RenderCommand : public testing::Test {
 protected:
  [[nodiscard]] Words words(const Words& more) const {
    Words all = {"render", room_};
    all.insert(all.end(), more.begin(), more.end());
    if (std::ranges::find(more, "--size") == more.end()) all.insert(all.end(), {"--size", "9x7"});
    return all;
  }
  [[nodiscard]] ProgramRun render(const Words& more) const { return run_exactff(words(more)); }
  [[nodiscard]] std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(directory_.path()), fs::directory_iterator()));
  }

  const TemporaryDirectory directory_;
  const std::string room_ = EXACTFF_DATA_DIR "/scenes/cornell_box.obj";
};

TEST_F(RenderCommand, WritesEveryFile) {
  EXPECT_EQ(render({"-o", path("a.png"), "--double", path("a.npy"), "--bounds", path("b.npy")}).exit_code, 0);
  EXPECT_TRUE(text_of(path("a.png")).starts_with("\x89PNG"));
  EXPECT_HOLDS(text_of(path("a.png")), "cornell_box.obj");
  EXPECT_HOLDS(text_of(path("a.npy")), "(7, 9, 3)");
  EXPECT_HOLDS(text_of(path("b.npy")), "(2, 7, 9, 3)");
  EXPECT_EQ(render({"-o", path("a.exr"), "--layers"}).exit_code, 0);
  EXPECT_TRUE(text_of(path("a.exr")).starts_with("\x76\x2f\x31\x01"));
  EXPECT_HOLDS(text_of(path("a.exr")), "id.face");
  EXPECT_EQ(files(), 4U);  // nothing else is left
}

TEST_F(RenderCommand, TheGradientHasItsComponentsInChannels) {
  EXPECT_EQ(render({"-o", path("a.exr"), "--quantity", "gradient", "--spp", "2"}).exit_code, 0);
  for (const char* channel : {"gradient.X", "gradient.Y", "gradient.Z", "kink"}) {
    EXPECT_HOLDS(text_of(path("a.exr")), channel) << channel;
  }
  EXPECT_EQ(render({"-o", path("b.exr"), "--quantity", "gradient", "--bounds", path("b.npy")}).exit_code, 2);
  EXPECT_EQ(render({"-o", path("b.exr"), "--quantity", "gradient", "--method", "nettle"}).exit_code, 2);
}

TEST_F(RenderCommand, ComparesMethods) {
  const auto run = run_exactff(words({"-o", path("d.png"), "--against", "hemicube:resolution=8", "--strip"}));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_HOLDS(run.output, "errors: RMS ");
  EXPECT_HOLDS(run.output, "wrong by over 10 %");
  EXPECT_EQ(render({"-o", path("again.png"), "--against", "hemicube:resolution=8", "--strip"}).exit_code, 0);
  EXPECT_EQ(text_of(path("again.png")), text_of(path("d.png")));  // no times
  EXPECT_EQ(render({"-o", path("e.exr"), "--against", "exact"}).exit_code, 0);
  EXPECT_HOLDS(text_of(path("e.exr")), "minus exact");
}

// The exact picture itself as that of another program; with one wrong pixel.
TEST_F(RenderCommand, JudgesThePictureOfAnotherProgram) {
  ASSERT_EQ(render({"-o", path("a.exr"), "--double", path("a.npy"), "--size", "9x7"}).exit_code, 0);
  std::vector<double> numbers = files::read_npy(path("a.npy")).values;
  const auto judged = [&](const std::string& file, const std::string& result) {
    const auto run = run_exactff(words({"-o", path(result), "--against", path(file)}));
    EXPECT_EQ(run.exit_code, 0);
    return run.output;
  };
  const std::string same = judged("a.npy", "e.exr");
  EXPECT_HOLDS(same, "errors: RMS 0, 99th percentile 0, worst 0;");
  EXPECT_EQ(same.find("a.npy in "), std::string::npos) << same;  // nothing was computed
  EXPECT_HOLDS(text_of(path("e.exr")), "a.npy");
  EXPECT_HOLDS(judged("a.exr", "e.png"), "0 % of pixels wrong");
  const std::size_t lit = static_cast<std::size_t>(
      std::ranges::find_if(numbers, [](double number) { return number > 0.0; }) - numbers.begin());
  numbers[lit] += 1.0;
  const std::vector<std::size_t> shape{7, 9, 3};
  files::write_npy<double>(path("b.npy"), shape, numbers);
  EXPECT_HOLDS(judged("b.npy", "e.png"), "worst 1;");
  EXPECT_EQ(render({"-o", path("s.png"), "--against", path("b.npy"), "--strip"}).exit_code, 0);
}

TEST_F(RenderCommand, BadInputIsRefused) {
  const std::vector<std::size_t> shape{4, 5, 3};
  files::write_npy<double>(path("a.npy"), shape, std::vector<double>(60));
  const std::string image = path("x.png"), exr = path("x.exr");
  for (const auto& [more, told] : std::vector<std::pair<Words, std::string>>{
           {{"-o", path("x.jpg")}, "unknown extension .jpg"},
           {{"-o", path("nowhere/x.png")}, "cannot be written"},
           {{"-o", image, "--eye", "1", "2", "3"}, "--eye is given without --look"},
           {{"-o", image, "--size", "12"}, "is not a size"},
           {{"-o", image, "--size", "60000x60000"}, "GB of memory"},
           {{"-o", image, "--double", path("x.txt")}, "does not end in .npy"},
           {{"-o", image, "--strip"}, "--strip is given without --against"},
           {{"-o", image, "--layers"}, "--layers needs an EXR file"},
           {{"-o", exr, "--exposure", "2"}, "not scaled"},
           {{"-o", exr, "--layers", "--spp", "2"}, "several points"},
           {{"-o", image, "--against", path("none.npy")}, "none.npy"},
           {{"-o", image, "--against", path("a.npy")},
            "a.npy: has 5x4 pixels, and the picture 9x7 (each pixel is compared with one of the same place); give "
            "--size 5x4"}}) {
    const ProgramRun run = render(more);
    EXPECT_EQ(run.exit_code, 2) << told;
    EXPECT_HOLDS(run.error, told);
  }
  EXPECT_EQ(files(), 1U) << "the array";
}

// The texels' positions and normals in a file are receivers of truth, as of any renderer.
TEST_F(RenderCommand, ALightmapAgreesWithTruthAtItsPoints) {
  const std::string scene = EXACTFF_DATA_DIR "/scenes/lightmap_room.obj";
  const auto run = [&](const Words& words) {
    const auto ran = run_exactff(words);
    EXPECT_EQ(ran.exit_code, 0) << ran.error;
    return ran.output;
  };
  const Words lightmap = {"render", scene, "--lightmap", "47x47", "-o"};
  const auto with = [&](Words more) {
    more.insert(more.begin(), lightmap.begin(), lightmap.end());
    return run(more);
  };
  const std::string told = with({path("a.exr"), "--layers", "--margin", "1"});
  EXPECT_HOLDS(told, "47 x 47 texels: ");
  EXPECT_HOLDS(told, "charts: 1992 faces; ");
  for (const char* words : {"v = 1 above the first row", "margin", "irradiance", "position.X"})
    EXPECT_HOLDS(text_of(path("a.exr")), words) << words;
  run({"truth", scene, "--receivers", path("a.exr"), "--on", "auto", "--total", "irradiance", "-o", path("t.csv"),
       "--exr", path("t.exr")});
  const std::string errors = with({path("e.png"), "--against", path("t.exr")});
  EXPECT_HOLDS(errors, "; 0 % of pixels wrong by over 10 %");
  const std::string some = with({path("b.png"), "--on", "light_1,floor:1", "--measure", "solid-angle"});
  EXPECT_HOLDS(some, "charts: 3 faces");
  for (const auto& [words, message] : std::vector<std::pair<Words, std::string>>{
           {{"render", scene, "--lightmap", "48", "-o", path("c.png")}, "--lightmap: '48' is not a size"},
           {{"render", scene, "--uv", "1", "-o", path("c.png")}, "--uv requires --lightmap"},
           {{"render", scene, "--lightmap", "4x4", "--two-sided", "-o", path("c.png")}, "leave out --two-sided"},
           {{"render", scene, "--lightmap", "4x4", "--spp", "2", "-o", path("c.png")},
            "--spp cannot be given with --lightmap"},
           {{"render", scene, "--lightmap", "4x4", "--uv", "1", "-o", path("c.png")}, "no face has texture"},
           {{"render", scene, "--lightmap", "4x4", "--against", path("t.exr"), "-o", path("c.png")},
            "give --lightmap 47x47"}}) {
    const ProgramRun refused = run_exactff(words);
    EXPECT_EQ(refused.exit_code, 2) << message;
    EXPECT_HOLDS(refused.error, message);
  }
}

}  // namespace
}  // namespace exactff
