// Matrices of view factors: what meets backs and what is open, sums of rows, files for other programs.
#include "matrix/rows.h"
#include "support/test.h"

namespace exactff::matrix {
namespace {

constexpr double kOpposite = 0.199824895698387383041599251193;  // squares of side 1, 1 apart
constexpr double kAdjacent = 0.200043776075403154239600187202;  // with a common edge

// The unit cube without its lid. Fronts look inward.
PlainScene open_box() {
  PlainScene scene;
  for (const auto& [side, corners] : sides_of({0, 0, 0}, {1, 1, 1})) {
    if (side != "ceiling") add(scene, side, corners);
  }
  return scene;
}

std::vector<Vec3> square(double side, double height) {
  const double h = 0.5 * side;
  return {{-h, -h, height}, {h, -h, height}, {h, h, height}, {-h, h, height}};
}

Matrix whole(const Scene& scene, double accuracy = 1e-6) {
  return compute(scene, all_patches(scene), all_patches(scene),
                 {.factors = {.accuracy = accuracy}, .backs = true, .open = true});
}

void expect_holds(const ViewFactor& f, double truth, double accuracy) {
  EXPECT_LE(f.lower, truth);
  EXPECT_GE(f.upper, truth);
  EXPECT_LE(f.upper - f.lower, accuracy);
  EXPECT_TRUE(f.accurate);
}

void expect_rows_hold_one(const Scene& scene, const Matrix& matrix, double width) {
  EXPECT_EQ(reasons_against_one(scene, matrix), Words{});
  for (const Sum& sum : row_sums(matrix)) {
    EXPECT_LE(sum.lower, 1.0);
    EXPECT_GE(sum.upper, 1.0);
    EXPECT_LE(sum.upper - sum.lower, width);
  }
}

TEST(Matrix, OfABoxWithoutALidIsOpenAsMuchAsTheLidWouldGet) {
  const Scene scene = generate::build(open_box());
  const Matrix matrix = whole(scene, 1e-3);
  expect_holds(matrix.open[0], kOpposite, 1.1e-3);
  for (std::size_t wall = 1; wall < 5; ++wall) expect_holds(matrix.open[wall], kAdjacent, 1.1e-3);
  for (const ViewFactor& back : matrix.back) EXPECT_EQ(back.claim, Claim::kZero);
  expect_rows_hold_one(scene, matrix, 1e-2);
}

// A sheet of two faces has no back: whatever its side, a front is seen.
TEST(Matrix, ASheetOfTwoFacesHasNoBacks) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "sheet up", square(0.5, 0.5));
  add(plain, "sheet down", square(0.5, 0.5), true);
  const Scene scene = generate::build(plain);
  const Matrix matrix = whole(scene);
  EXPECT_EQ(matrix.back[0].claim, Claim::kZero);
  EXPECT_EQ(matrix.back[1].claim, Claim::kZero);
  EXPECT_EQ(matrix.back[2].claim, Claim::kZero);  // it looks down on the front of the plate below
  EXPECT_GT(matrix.factors.at(0, 2).lower, 0.1);
  expect_rows_hold_one(scene, matrix, 1e-2);
}

// The backs are what the larger face, turned round, gets, less what the smaller one in its plane gets.
TEST(Matrix, BacksUnderAFrontInTheirPlaneDoNotCount) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "up", square(2.0, 0.5));
  add(plain, "down", square(0.5, 0.5), true);
  const Scene scene = generate::build(plain);
  const Matrix matrix = whole(scene, 1e-6);
  const Scene turned = scene.with_flipped(scene.select("up"));
  const ViewFactor large = view_factor(turned, turned.select("below"), turned.select("up"), {.accuracy = 1e-6});
  const ViewFactor small = view_factor(turned, turned.select("below"), turned.select("down"), {.accuracy = 1e-6});
  EXPECT_NEAR(matrix.back[0].value, large.value - small.value, 2e-6);
  EXPECT_LE(matrix.back[0].upper - matrix.back[0].lower, 1e-6) << "the sum of three factors is accurate, too";
  expect_rows_hold_one(scene, matrix, 1e-2);
}

// Nine slats on a large floor: the rest is known long before the sky is.
TEST(Matrix, OfAFloorWithLittleOnItIsOpenAsMuchAsIsLeft) {
  const Scene scene = read_scene(EXACTFF_DATA_DIR "/scenes/slats.obj");
  const Matrix matrix = whole(scene, 1e-3);
  expect_holds(matrix.open[0], 0.996696, 1e-3);
  EXPECT_LE(matrix.open[0].cells, 1000U) << "the sky takes 2,000";
  expect_rows_hold_one(scene, matrix, 1e-2);
}

TEST(Matrix, SaysWhyRowsNeedNotAddUpToOne) {
  const Scene scene = generate::build(open_box());
  const std::vector<Selection> all = all_patches(scene);
  const auto count = [&](const Options& options, const std::vector<Selection>& to, const Scene& in) {
    return reasons_against_one(in, compute(in, std::vector{all[0]}, to, options)).size();
  };
  const Options coarse{.factors = {.accuracy = 0.1}}, full{.factors = {.accuracy = 0.1}, .backs = true, .open = true};
  EXPECT_EQ(count(full, all, scene), 0U);
  EXPECT_EQ(count(coarse, all, scene), 2U);
  EXPECT_EQ(count(full, {all[0], all[1]}, scene), 1U);
  EXPECT_EQ(count(full, {all[0], all[1], all[2], all[3], all[4], all[4]}, scene), 1U);
  PlainScene twice = open_box();
  add(twice, "carpet", {{0.5, 0.5, 0}, {2, 0.5, 0}, {2, 2, 0}, {0.5, 2, 0}});
  add(twice, "tile", {{1, 0, 0}, {2, 0, 0}, {2, 0.5, 0}, {1, 0.5, 0}});  // touches the carpet and the floor only
  const Scene in_common = generate::build(twice);
  const auto reasons = reasons_against_one(in_common, whole(in_common, 0.1));
  EXPECT_EQ(reasons, Words{"fronts of different patches overlap in one plane"});
  PlainScene apart = open_box();
  add(apart, "tile", {{1, 0, 0}, {2, 0, 0}, {2, 0.5, 0}, {1, 0.5, 0}});
  const Scene beside = generate::build(apart);
  EXPECT_EQ(reasons_against_one(beside, whole(beside, 0.1)), Words{});
}

// From a large patch the factor is small: what is compared is the same on both sides.
TEST(Matrix, ReciprocityIsThatOfTheExchange) {
  PlainScene plain;
  add(plain, "large", square(8.0, 0.0));
  add(plain, "small", square(0.5, 1.0), true);
  const Scene scene = generate::build(plain);
  const std::vector<Selection> rows{scene.select("small")}, columns{scene.select("large")};
  EXPECT_EQ(reciprocity(compute(scene, rows, columns)).pairs, 0U);
  const std::vector<Selection> all = all_patches(scene);
  const Reciprocity found =
      reciprocity(compute(scene, all, all, {.factors = {.accuracy = 1e-6, .both_directions = true}}));
  EXPECT_EQ(found.pairs, 1U);
  EXPECT_TRUE(found.apart.empty());
  EXPECT_LE(found.worst->radius, 2e-6);
}

TEST(Matrix, TheBackOfATwoSidedPatchGetsWhatMetBacks) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  add(plain, "screen", square(0.75, 0.5));
  add(plain, "above", square(1.0, 1.0), true);
  const Scene scene = generate::build(plain);
  const Matrix before = whole(scene, 1e-4);
  const Scene doubled = with_two_sided(scene, std::vector{scene.select("screen")});
  ASSERT_EQ(doubled.patches().size(), 4U);
  EXPECT_EQ(doubled.patches()[3].name, "screen (back)");
  const Matrix after = whole(doubled, 1e-4);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(after.factors.at(i, j).value, before.factors.at(i, j).value, 1e-6);
    }
    EXPECT_EQ(after.back[i].claim, Claim::kZero);
    EXPECT_NEAR(after.factors.at(i, 3).value, before.back[i].value, 1e-4);
  }
  EXPECT_GT(before.back[0].lower, 0.2);
  EXPECT_NEAR(after.factors.at(3, 0).value, after.factors.at(1, 2).value, 1e-4);  // by symmetry
  expect_rows_hold_one(doubled, after, 1e-2);
}

TEST(Matrix, TwoSidedFacesKeepHolesMaterialsAndGlass) {
  PlainScene plain;
  add(plain, "below", square(1.0, 0.0));
  generate::PlainPatch& frame = plain.patch("frame");
  plain.add_rings(frame, {square(1.0, 0.5), square(0.5, 0.5)});
  plain.materials.push_back({.name = "gold", .reflectance = {0.75, 0.5, 0.25}});
  frame.material = "gold";
  const Scene scene = generate::build(plain);
  const Selection selection = scene.select("frame");
  const Scene doubled = with_two_sided(scene, std::vector{selection, selection});
  EXPECT_EQ(doubled.faces().size(), 3U);
  EXPECT_EQ(doubled.face(FaceId{2}).area, scene.face(FaceId{1}).area);
  EXPECT_EQ(doubled.material(doubled.face(FaceId{2}).material).name, "gold");
  EXPECT_LT(doubled.face(FaceId{2}).newell.z, 0.0);
  EXPECT_FALSE(doubled.face(FaceId{2}).transparent);
  const Scene clear = scene.with_transparent({&selection, 1});
  const Scene glass = with_two_sided(clear, std::vector{clear.select("frame")});
  EXPECT_TRUE(glass.face(FaceId{1}).transparent);
  EXPECT_TRUE(glass.face(FaceId{2}).transparent);
}

// The twin of a bent face must be cut as the face is: else points between the two surfaces see one through the other.
TEST(Matrix, TheTwinOfABentFaceIsItsTrianglesTurnedRound) {
  std::mt19937_64 random(57);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  const auto bent = [&](std::size_t corners, double height) {
    std::vector<Vec3> ring;
    for (std::size_t i = 0; i < corners; ++i) {
      const double angle = 6.0 * static_cast<double>(i) / static_cast<double>(corners);
      ring.push_back({std::cos(angle), std::sin(angle), height * anywhere(random)});
    }
    std::rotate(ring.begin(), ring.begin() + static_cast<std::ptrdiff_t>(random() % corners), ring.end());
    return ring;
  };
  for (int i = 0; i < 8; ++i) {
    PlainScene plain;
    add(plain, "sail", bent(4 + random() % 5, i % 2 == 0 ? 0.5 : 1e-9), random() % 2 == 0);
    add(plain, "lamp", square(1.0, 2.0), true);
    const Scene scene = generate::build(plain), triangles = triangulated(scene);
    const auto sail = [](const Scene& in) { return std::vector{in.select("sail")}; };
    const Scene doubled = with_two_sided(scene, sail(scene)), cut = with_two_sided(triangles, sail(triangles));
    const Scene turned = scene.with_flipped(sail(scene));
    const auto value = [](const Scene& in, const Receiver& at, const char* name) {
      return exact_form_factor(in, at, ExactSource(in, in.select(name))).value;
    };
    for (int k = 0; k < 6; ++k) {
      const double side = k % 2 == 0 ? 1.0 : -1.0;
      const Receiver at{{anywhere(random), anywhere(random), side * (0.6 + anywhere(random))},
                        {anywhere(random), anywhere(random), -side},
                        {},
                        {}};
      EXPECT_EQ(value(doubled, at, "sail"), value(scene, at, "sail"));
      EXPECT_EQ(value(doubled, at, "sail (back)"), value(turned, at, "sail"));
      EXPECT_EQ(value(doubled, at, "lamp"), value(scene, at, "lamp"));
      for (const char* name : {"sail", "sail (back)", "lamp"}) {
        EXPECT_EQ(value(doubled, at, name), value(cut, at, name)) << name;
      }
    }
  }
}

class MatrixFilesOfTheCommand : public testing::Test {
 protected:
  static ProgramRun run(const Words& arguments) { return run_exactff(joined({"matrix"}, arguments)); }
  [[nodiscard]] std::string file(const char* name) const { return (folder_.path() / name).string(); }

  const TemporaryDirectory folder_;
  const std::string scene_ = EXACTFF_DATA_DIR "/scenes/formats/test4.vs3";
};

// Without patches as columns: what is open alone, or beside what meets backs.
TEST_F(MatrixFilesOfTheCommand, HoldTheSkyAlone) {
  const std::string scene =
      folder_.write("plate.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng plate\nf 1 2 3 4\n").string();
  for (const Words& more : {Words{}, {"--backs"}}) {
    Words command =
        joined({scene, "--to", "sky", "--plain", "-o", file("m.csv"), "--npz", file("m.npz"), "--force"}, more);
    const ProgramRun made = run(command);
    ASSERT_EQ(made.exit_code, 0);
    EXPECT_EQ(std::ranges::count(made.output, '\n'), 1 + static_cast<int>(more.size()));
    EXPECT_HOLDS(made.output, "plate\t(open)\t1\t1\tcertified");
    const NamedMatrix read = read_named(file("m.csv"));
    EXPECT_EQ(read.to.size(), 0U);
    EXPECT_EQ(read.open.size(), 1U);
    EXPECT_EQ(read.back.size(), more.size());
    std::ranges::replace(command, "--force", "--resume");
    EXPECT_EQ(run(command).output, made.output);
  }
  EXPECT_EQ(run({scene, "--to", "sky", "--vtk", file("row.vtp")}).exit_code, 2);
}

TEST_F(MatrixFilesOfTheCommand, AreWrittenWholeOrNotAtAll) {
  const Words outputs = {"--npz",        file("m.npz"), "--view3d", file("m.txt"),
                         "--energyplus", file("m.idf"), "--zone",   "Hall"};
  Words command = joined({scene_, "--accuracy", "1e-3"}, outputs);
  EXPECT_EQ(run(command).exit_code, 0);
  const std::string npz = text_of(file("m.npz"));
  EXPECT_EQ(npz.substr(0, 4), "PK\3\4");
  EXPECT_HOLDS(text_of(file("m.idf")), "\n  Hall,\n  srf-1, srf-1, 0,");
  EXPECT_EQ(run(command).exit_code, 2);  // the files exist
  command.emplace_back("--force");
  EXPECT_EQ(run(command).exit_code, 0);
  EXPECT_EQ(text_of(file("m.npz")), npz);
  for (const char* flag : {"--npz", "--view3d", "--energyplus", "--vtk"}) {
    const std::string other = file(flag + 2);
    EXPECT_EQ(run({scene_, "--from", "srf-1", "--view3d", other + "/not/there", flag, other}).exit_code, 2);
    EXPECT_EQ(run({scene_, flag, file("."), "--force"}).exit_code, 2);
    EXPECT_EQ(size_of(other), 0U);
  }
  EXPECT_EQ(run({scene_, "--npz", file("x"), "-o", file("x")}).exit_code, 2);
  EXPECT_EQ(run({scene_, "--zone", "Hall"}).exit_code, 2);
}

// A window on a wall counts besides it.
TEST_F(MatrixFilesOfTheCommand, OfOverlappingFrontsAreWrittenOnlyByForce) {
  const TemporaryDirectory aside;
  std::string told;
  const auto command = [&](const Words& flags) {
    const RunningProgram program(
        EXACTFF_PROGRAM,
        joined({"matrix", EXACTFF_DATA_DIR "/regression/window_on_a_wall.obj", "--accuracy", "0.1"}, flags),
        aside.path() / "told");
    const int exit_code = program.wait();
    told = program.error();
    return exit_code;
  };
  const std::string names = "'window' lies in the plane of 'east' and overlaps it by 1 (area)";
  for (const char* flag : {"--energyplus", "--view3d"}) {
    EXPECT_EQ(command({flag, file("factors.txt"), "-o", file("m.csv")}), 2);
    EXPECT_HOLDS(told, names);
    EXPECT_HOLDS(told, "; --force writes it all the same\n");
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
    EXPECT_EQ(command({flag, file("factors.txt"), "--force"}), 0);
    EXPECT_TRUE(std::filesystem::remove(file("factors.txt")));
    EXPECT_EQ(command({flag, file("factors.txt"), "--from", "floor,east", "--to", "floor,east"}), 0) << told;
    EXPECT_TRUE(std::filesystem::remove(file("factors.txt"))) << "the window is no column";
  }
  EXPECT_EQ(command({"-o", file("m.csv")}), 0);
  EXPECT_EQ(told.find("warning: " + names), 0U) << told;
  EXPECT_EQ(command({"--from", "floor", "--to", "east", "--plain"}), 0);
  EXPECT_EQ(told, "");
}

// Of cells, against the factors to the undivided patches; and as their file has them.
TEST(MatrixSums, OfCellsHoldTheFactorsOfTheirPatches) {
  const std::pair<Scene, double> scenes[] = {
      {generate::build(open_box()), 0.6},
      {read_scene(EXACTFF_DATA_DIR "/scenes/formats/test4.vs3"), 2.0},
  };
  for (const auto& [scene, length] : scenes) {
    const Scene cells = divided(scene, length).scene;
    Words names;
    for (std::size_t p = 0; p < 3; ++p) names.push_back(scene.patches()[p].name);
    const std::vector<Selection> whole_from{scene.select(names.front())}, from = cells.select_all(names.front());
    const Options options{.factors = {.accuracy = 1e-4}};
    const Matrix truth = compute(scene, whole_from, all_patches(scene), options);
    Matrix matrix = compute(cells, from, all_patches(cells), options);
    add_sums(cells, names, 1e-3, matrix);
    ASSERT_EQ(matrix.sums.size(), names.size());
    for (std::size_t p = 0; p < names.size(); ++p) {
      const GroupSum& sum = matrix.sums[p];
      EXPECT_EQ(name_of(sum), "(sum " + names[p] + ')');
      EXPECT_EQ(sum.columns.size(), cells.select_all(names[p]).size());
      double lower = 0.0, upper = 0.0, area = 0.0;  // means over the cells of the first patch
      for (std::size_t i = 0; i < from.size(); ++i) {
        const ViewFactor& f = sum.factors[i];
        double value = 0.0;
        for (const std::size_t j : sum.columns) value += matrix.factors.at(i, j).value;
        EXPECT_NEAR(f.value, value, 1e-12);
        EXPECT_LE(f.lower, f.value);
        EXPECT_LE(f.value, f.upper);
        EXPECT_LE(f.upper, 1.0);
        EXPECT_EQ(f.accurate, f.upper - f.lower <= 1e-3);
        lower += f.area_from * f.lower, upper += f.area_from * f.upper, area += f.area_from;
      }
      const ViewFactor& whole_factor = truth.factors.at(0, p);
      EXPECT_LE(lower / area, whole_factor.upper + 1e-12) << names[p];
      EXPECT_GE(upper / area, whole_factor.lower - 1e-12) << names[p];
    }
  }
}

TEST_F(MatrixFilesOfTheCommand, HaveSumsThatAreReadAsNoPatches) {
  const Words command = {scene_,     "--accuracy", "1e-3", "--to",        "srf-1,srf-2,sky", "--sum",
                         "srf-[12]", "--plain",    "-o",   file("m.csv"), "--npz",           file("m.npz")};
  const ProgramRun made = run(command);
  ASSERT_EQ(made.exit_code, 0) << made.output;
  EXPECT_HOLDS(made.output, "\t(sum srf-[12])\t");
  const NamedMatrix read = read_named(file("m.csv"));
  EXPECT_EQ(read.to, (Words{"srf-1", "srf-2"}));
  EXPECT_EQ(read.open.size(), read.from.size());
  EXPECT_EQ(run({scene_, "--to", "srf-1", "--sum", "srf-2"}).exit_code, 2);
}

}  // namespace
}  // namespace exactff::matrix
