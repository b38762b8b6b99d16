// Hostile files, names and polygons are read, or refused with their place.
#include <sys/stat.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

#include "scene/triangulation.h"
#include "support/test.h"
#include "text/encoding.h"
#include "text/names.h"
#include "unit/outside/sanitized.h"
#include "unit/scenes/format_support.h"

namespace exactff {
namespace {

using Vertices = std::vector<Vec3>;

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

Scene read_text(const std::string& text, const SceneOptions& options = {}) {
  std::istringstream in(text);
  return read_obj(in, "s.obj", options);
}

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

TEST(HostileFiles, WhatIsNoTextIsRefused) {
  const auto message = [](const std::string& text) { return error_of([&] { return read_text(text); }); };
  EXPECT_EQ(message(kCorners + std::string("g a\0b\n", 6)),
            "s.obj: is not a text file (it contains zero bytes); give a Wavefront OBJ file");
  EXPECT_EQ(message(std::string("\xFF\xFEv\0 \0", 6)), "s.obj: is UTF-16 text (only UTF-8 is read); save it as UTF-8");
  EXPECT_EQ(message(std::string("\xFE\xFF\0v\0 ", 6)), "s.obj: is UTF-16 text (only UTF-8 is read); save it as UTF-8");
  EXPECT_EQ(message("\x80\x91\xFF garbage \x01\n"),
            "s.obj: has no faces (there is nothing to compute with); is it a Wavefront OBJ file?");
}

TEST(HostileFiles, ACutOffLastLineIsWarnedAbout) {
  const Scene scene = read_text(kCorners + "f 1 2 3 4\nf 1 2 3");  // it may have been a quadrilateral
  ASSERT_EQ(scene.warnings().size(), 1U);
  EXPECT_EQ(scene.warnings()[0].message(),
            "s.obj:6: the last line does not end with a newline (the file may have been cut off there); add a newline "
            "if the file is complete");
  EXPECT_TRUE(read_text(kCorners + "f 1 2 3\n").warnings().empty());
  EXPECT_TRUE(read_text(kCorners + "f 1 2 3\r").warnings().empty());
}

TEST(HostileFiles, ThousandsOfProblemsGiveTwentyLinesAndACount) {
  const std::string text = kCorners + repeated("f 1 3 2 4\n", 5000);
  try {
    (void)read_text(text);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems().size(), 1001U);
    EXPECT_EQ(error.problems().back().what, "4000 more problems");
    const std::string shown = error.what();
    EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 20);
    EXPECT_TRUE(shown.ends_with("\n... and more than 981 more problems"));
  }
}

TEST(HostileFiles, MaterialFilesThatAreNoneAreNeverWaitedFor) {
  const TemporaryDirectory directory;
  ASSERT_EQ(::mkfifo((directory.path() / "pipe.mtl").c_str(), 0600), 0);
  (void)directory.write("zero.mtl", std::string("newmtl a\0\nKe 5\n", 15));
  for (const char* library : {"pipe.mtl", "/dev/zero", ".", "zero.mtl"}) {
    const auto path =
        directory.write("s.obj", std::string("mtllib ") + library + "\n" + kCorners + "usemtl a\nf 1 2 3\n");
    const Scene scene = read_obj(path);
    ASSERT_EQ(scene.warnings().size(), 1U) << library;
    EXPECT_HOLDS(scene.warnings()[0].what, "cannot be read");
    EXPECT_FALSE(scene.materials()[1].emits());
  }
}

TEST(HostileFiles, AHugeGridIsRefusedBeforeItIsBegun) {
  const Scene scene = read_text(kCorners + repeated("f 1 2 3 4\n", 10));
  const Selection all = scene.select("default");
  EXPECT_EQ(
      error_of([&] {
        return grid_receivers(scene, all, {1'000'000'000, 1'000'000'000});
      }),
      "a grid of 1000000000x1000000000 cells on 10 regions (the limit is 4194304 cells in total); use fewer cells or "
      "a smaller patch");
  EXPECT_NE(error_of([&] { return grid_receivers(scene, all, {1000, 1000}); }), "no error");
  EXPECT_EQ(grid_receivers(scene, all, {3, 2}).size(), 60U);
}

// --- names that control terminals, change the reading direction or are no valid text ---

namespace fs = std::filesystem;

// Escape, a C1 control, a right-to-left mark, HTML markup; not UTF-8: Latin-1, an overlong slash, half a surrogate
// pair.
const std::string kLight = "l\u00E4mp\x1B[31m\xC2\x9B\xE2\x80\xAE<&>\"'%";
const std::string kFloor = "fl\x07oor\x7F,::error::\xED\xA0\x80";
const std::string kShownLight = "l\u00E4mp\\x1b[31m\\u009b\\u202e<&>\"'%";
const std::string kRoom =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\nv .2 .2 1\nv .8 .2 1\nv .8 .8 1\n"
    "g " +
    kFloor + "\nf 1 2 3 4\ng " + kLight + "\nf 8 7 6 5\ng b\xFC\x1B\x81\xC0\xAF\nf 9 10 11\n";

struct Ran {
  int exit_code = 0;
  std::string output;
  std::string error;
};

class HostileNames : public testing::Test {
 protected:
  Ran run(const std::vector<std::string>& arguments) const {
    const fs::path out = directory_.path() / "stdout";
    const RunningProgram program(EXACTFF_PROGRAM, arguments, directory_.path() / "stderr", [&out] {
      if (std::freopen(out.c_str(), "w", stdout) == nullptr) std::_Exit(125);
    });
    const int exit_code = program.wait();
    return {exit_code, text_of(out), program.error()};
  }
  Ran expect_harmless(const std::vector<std::string>& arguments, int exit_code = 0) const {
    Ran run = this->run(arguments);
    EXPECT_EQ(run.exit_code, exit_code) << run.error;
    EXPECT_TRUE(is_harmless(run.output)) << run.output;
    EXPECT_TRUE(is_harmless(run.error)) << run.error;
    return run;
  }
  std::vector<std::string> point(const std::vector<std::string>& more) const {
    return joined(
        {"point", room_, "--at", ".5", ".5", "0", "--normal", "0", "0", "1", "--on", kFloor, "--source", kLight}, more);
  }
  fs::path truth() const {
    fs::path file = directory_.path() / "truth.csv";
    const Ran made = run({"truth", room_, "--receivers", receivers_, "--source", kLight, "-o", file.string()});
    EXPECT_EQ(made.exit_code, 0) << made.error;
    return file;
  }

  // Lines of visible characters only. The JSON parser accepts only well-formed UTF-8.
  static bool is_harmless(const std::string& text) {
    std::string letters;
    for (const char c : text) {
      if ((static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7F) return false;
      letters += c == '\n' || c == '"' || c == '\\' ? 'x' : c;
    }
    for (const char* act : {"\u0080", "\u0085", "\u009B", "\u202E", "\uFFFE"}) {
      if (text.find(act) != std::string::npos) return false;
    }
    return nlohmann::json::accept('"' + letters + '"');
  }

  const TemporaryDirectory directory_;
  const std::string room_ = directory_.write("r\x1B\xE4oom.obj", kRoom).string();
  const std::string receivers_ =
      directory_.write("receivers.csv", "id,x,y,z,nx,ny,nz\n\"r\x1B\xE4,::error::\",.5,.5,0,0,0,1\nb,.1,.1,0,0,0,1\n");
};

TEST_F(HostileNames, AreSeenInLists) {
  const Ran list = expect_harmless({"info", room_});
  EXPECT_HOLDS(list.output, kShownLight);
  expect_harmless({"info", room_, "--patches", "faces"});
}

TEST_F(HostileNames, AreSeenInComplaints) {
  expect_harmless({"info", "no\x1B[2J\xE4.obj"}, 2);
  expect_harmless(point({"--source", "x\x1B\xC2\x9B"}), 2);
  expect_harmless({"\x1B[2J\xE4"}, 2);                          // reported by the parser of flags
  expect_harmless({"info", room_, "--no\x1B\xE2\x80\xAE"}, 2);  // this too
  expect_harmless(point({"--at", "1", "2", "3\x1B"}), 2);
  const std::string bad = directory_.write("bad.obj", "v 0 0 \x1B[2J\xE4\xC2\x85\nf \xE2\x80\xAE 2 3\n").string();
  EXPECT_HOLDS(expect_harmless({"info", bad}, 2).error, "\\x1b[2J\\xe4\\u0085");
}

TEST_F(HostileNames, ArriveInJson) {
  const auto list = nlohmann::json::parse(expect_harmless({"info", room_, "--json"}).output);
  EXPECT_EQ(list["patches"][1]["name"], kLight);
  EXPECT_EQ(list["patches"][2]["name"], "b\u00FC\x1B\u0081\u00C0\u00AF");
  const auto result = nlohmann::json::parse(expect_harmless(point({"--json", "--explain"})).output);
  EXPECT_EQ(result["sources"][0]["source"], list["patches"][1]["name"]);
}

TEST_F(HostileNames, ArriveInPictures) {
  const fs::path picture = directory_.path() / "view.svg";
  expect_harmless(point({"--svg", picture.string()}));
  const std::string svg = text_of(picture);
  EXPECT_TRUE(is_harmless(svg));
  EXPECT_HOLDS(svg, "l\u00E4mp\\x1b[31m\\u009b\\u202e&lt;&amp;&gt;&quot;'%");
}

TEST_F(HostileNames, AreReadBackFromTruthFiles) {
  const std::string file = truth().string();
  EXPECT_HOLDS(text_of(file), "\"r\x1B\u00E4,::error::\"") << "Latin-1 is converted";
  EXPECT_TRUE(text::is_utf8(text_of(file))) << "and so is the name of the scene's file";
  const fs::path junit = directory_.path() / "j.xml", json = directory_.path() / "j.json";
  expect_harmless({"check", file, file, "--max-abs", "0", "--junit", junit.string(), "--json", json.string()});
  EXPECT_TRUE(is_harmless(text_of(junit)));
  EXPECT_EQ(nlohmann::json::parse(text_of(json))["overall"]["rows"], 2);
}

TEST_F(HostileNames, AreSeenInReports) {
  const fs::path folder = directory_.path() / "study\xE4";
  expect_harmless({"compare", room_, "--receivers", receivers_, "--source", kLight, "--no-methods", "--eps-b", ".1",
                   "--threads", "1", "-o", folder.string()});
  std::string page = text_of(folder / "report.html");
  EXPECT_HOLDS(page, "l\u00E4mp\\x1b[31m");
  std::replace(page.begin(), page.end(), '\t', ' ');  // of gnuplot
  EXPECT_TRUE(is_harmless(page));
  for (const auto& file : fs::directory_iterator(folder)) EXPECT_TRUE(text::is_utf8(text_of(file))) << file;
}

// --- Faces with tens of thousands of vertices in shapes that make simple algorithms quadratic ---

Ring whole_ring(std::size_t count) {
  Ring ring(count);
  std::iota(ring.begin(), ring.end(), 0U);
  return ring;
}

constexpr std::size_t kLarge = 30'000;

Vertices comb() {
  Vertices vertices{{0, -1, 0}, {kLarge / 2, -1, 0}};
  for (std::size_t i = kLarge / 2 - 1; i-- > 0;) {
    const auto x = static_cast<double>(i);
    vertices.push_back({x + 0.5, 1000, 0});
    vertices.push_back({x, 0, 0});
  }
  return vertices;
}

// Nested V-shaped teeth: the ear of each would contain all inner ones.
Vertices chevrons() {
  Vertices vertices;
  for (std::size_t i = 0; i < kLarge / 6; ++i) {
    const auto y = -static_cast<double>(i);
    for (const Vec3& p : {Vec3{-1000, 1000.3, 0}, Vec3{0, 0.3, 0}, Vec3{1000, 1000.3, 0}, Vec3{1000, 999.7, 0},
                          Vec3{0, -0.3, 0}, Vec3{-1000, 999.7, 0}}) {
      vertices.push_back({p.x, p.y + y, 0});
    }
  }
  vertices.push_back({-1001, 1000 - static_cast<double>(kLarge / 6), 0});
  vertices.push_back({-1001, 1001, 0});
  return vertices;
}

Vertices wavy(Vertices vertices) {
  for (Vec3& v : vertices) v.z = 0.001 * std::sin(12.9898 * v.x + 78.233 * v.y);
  return vertices;
}

// Sufficient for near-linear time, too little for quadratic time.
void expect_cut_quickly(const Vertices& vertices, FaceShape shape) {
  const std::clock_t start = std::clock();
  const CutFace face = cut_face(vertices, {whole_ring(vertices.size())});
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_FALSE(face.fault) << face.fault->what;
  EXPECT_EQ(face.shape, shape);
  std::size_t sides = 0;
  for (const ConvexPart& part : face.parts) sides += part.corners.size() - 2;
  EXPECT_EQ(sides, vertices.size() - 2);
  if (kAtFullSpeed) {
    EXPECT_LT(seconds, 2.5);
  }
}

TEST(LargePolygon, IsCutInNearlyLinearTimePlanarOrNot) {
  for (const Vertices& vertices : {comb(), chevrons()}) {
    expect_cut_quickly(vertices, FaceShape::kPlanar);
    expect_cut_quickly(wavy(vertices), FaceShape::kTriangulated);
  }
}

}  // namespace
}  // namespace exactff
