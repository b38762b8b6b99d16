// The flags that choose receivers and sources, as a user enters them.
#include <iterator>

#include "support/test.h"
#include "table/csv.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

// A floor, a box lid of two faces, a lamp, a patch whose name has a comma, and one without area.
const std::string kRoom =
    "mtllib room.mtl\nusemtl grey\n"
    "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\n"
    "v 1 1 1\nv 2 1 1\nv 2 2 1\nv 1 2 1\n"
    "v 0 0 3\nv 1 0 3\nv 1 1 3\nv 0 1 3\n"
    "g floor\nf 1 2 3 4\ng lid\nf 5 6 7\nf 5 7 8\ng a,b\nf 1 2 3\ng line\nf 1 2 1\n"
    "usemtl bright\ng lamp\nf 12 11 10 9\n";
const std::string kTwoMaterials = "newmtl grey\nKd .5\nnewmtl bright\nKe 17 12 4\n";

class ReceiverFlags : public testing::Test {
 protected:
  ReceiverFlags() { (void)directory_.write("room.mtl", kTwoMaterials); }

  struct Truth {
    int exit_code = -1;
    std::string error;
    std::string text;

    // A value of the head; of a list, with plus signs.
    [[nodiscard]] std::string head(const std::string& key) const {
      const auto parsed = table::parse_csv_head(text);
      if (!parsed) return "no head";
      std::string list = parsed->head.text(key).value_or("");
      for (const std::string& one : parsed->head.list(key)) list += (list.empty() ? "" : " + ") + one;
      return list;
    }
    // The first field of each row, unparsed.
    [[nodiscard]] Words ids() const {
      Words ids;
      std::istringstream lines(text);
      bool below_header = false;
      for (std::string line; std::getline(lines, line);) {
        if (below_header) ids.push_back(line.substr(0, line.find(',', line.starts_with('"') ? line.find('"', 1) : 0)));
        if (line.starts_with("receiver,")) below_header = true;
      }
      return ids;
    }
  };

  [[nodiscard]] Truth truth(Words flags, const std::string& source = "lamp", const std::string& room = {}) const {
    const std::string scene = room.empty() ? room_ : room;
    const fs::path file = directory_.path() / "truth.csv";
    flags.insert(flags.begin(), {"truth", scene, "--force", "--threads", "1", "-o", file.string()});
    if (!source.empty()) flags.insert(flags.end(), {"--source", source});
    const ProgramRun run = run_exactff(flags);
    Truth result;
    result.exit_code = run.exit_code;
    result.error = run.error;
    result.text = text_of(file);
    fs::remove(file);
    return result;
  }

  // What `compare` prints beside its result.
  [[nodiscard]] std::string compare_says(const Words& flags) const {
    const ProgramRun run = run_exactff(joined({"compare", room_, "--no-methods", "--source", "lamp", "--force", "-o",
                                               (directory_.path() / "report").string()},
                                              flags));
    EXPECT_EQ(run.exit_code, 0) << run.error;
    return run.error;
  }

  // The message about wrong flags, after the program's name.
  [[nodiscard]] std::string refusal(const Words& flags, const std::string& source = "lamp") const {
    const Truth run = truth(flags, source);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(run.text.empty());
    const std::string start = "exactff: ";  // after a warning about the face without area
    const std::size_t at = run.error.find(start);
    return at == std::string::npos ? run.error : run.error.substr(at + start.size());
  }

  const TemporaryDirectory directory_;
  const std::string room_ = directory_.write("room.obj", kRoom).string();
};

TEST_F(ReceiverFlags, AGridOnSeveralFacesNamesThem) {
  const Truth run = truth({"--on", "lid", "--grid", "1x2", "--per-face"});
  EXPECT_EQ(run.head("receivers"), "lid, grid 1x2, per face");
  EXPECT_EQ(run.ids(), (Words{"lid:1/r1c1", "lid:2/r1c1", "lid:2/r2c1"}));
  EXPECT_EQ(truth({"--on", "lid,floor", "--grid", "1x1"}).ids(), (Words{"lid:1/r1c1", "floor:1/r1c1"}));
}

TEST_F(ReceiverFlags, TheFacesOfALidAreOneSurface) {
  EXPECT_EQ(truth({"--on", "lid", "--grid", "1x2"}).ids(), (Words{"r1c1", "r2c1"}));
  EXPECT_EQ(refusal({"--on", "lid", "--vertices", "--per-face"}),
            "--per-face is given without --grid or --centres (vertices and samples are always made per face); remove "
            "it\n");
}

TEST_F(ReceiverFlags, UAndVAreThePlaceOnTheGrid) {
  const Truth run = truth({"--on", "floor", "--grid", "2x1", "--uv"});
  EXPECT_HOLDS(run.text, "nx,ny,nz,u,v,source");
  EXPECT_HOLDS(run.text, ",0.25,0.5,lamp,");
  EXPECT_HOLDS(refusal({"--on", "floor", "--vertices", "--uv"}), "the receivers have no u and v");
}

TEST_F(ReceiverFlags, AutoFindsTheFaces) {
  const std::string points =
      directory_.write("points.csv", "id,x,y,z,nx,ny,nz\na,3,3,1e-6,0,0,1\nb,1.5,1.5,1,0,0,1\nc,3,3,0.5,0,0,1\n")
          .string();
  const Truth run = truth({"--receivers", points, "--on", "auto"});
  EXPECT_EQ(run.head("receivers"), "points.csv, on auto, 1 without a face");
  const std::string warning =
      "warning: --on auto found no face for 1 of 3 receivers (they now lie on none); --on auto:DISTANCE looks further "
      "away\n";
  EXPECT_HOLDS(run.error, warning);
  EXPECT_HOLDS(compare_says({"--receivers", points, "--on", "auto"}), warning);
  EXPECT_HOLDS(run.text, "\na,floor,3,");
  EXPECT_HOLDS(run.text, "\nb,lid:1+2,1.5,");
  EXPECT_HOLDS(run.text, "\nc,,3,");
  EXPECT_HOLDS(truth({"--receivers", points, "--on", "auto:0.6"}).text, "\nc,floor,3,");
  EXPECT_HOLDS(refusal({"--receivers", points, "--on", "auto:x"}), "write, for example, --on auto:1e-4");
  const std::string behind = directory_.write("behind.csv", "x,y,z,nx,ny,nz\n3,3,-1e-6,0,0,1\n").string();
  const std::string told = truth({"--receivers", behind}).error;
  EXPECT_HOLDS(told, " are given without a face, within ");
  EXPECT_HOLDS(told, "look through it from behind, so it hides everything; --on auto places them on their faces");
}

TEST_F(ReceiverFlags, SamplesHaveASeedOfTheirOwn) {
  const Truth first = truth({"--on", "floor", "--samples", "3"});
  EXPECT_EQ(first.head("receivers"), "floor, 3 samples, seed 1");
  EXPECT_EQ(first.ids(), (Words{"1", "2", "3"}));
  EXPECT_EQ(first.text, truth({"--on", "floor", "--samples", "3", "--sample-seed", "1"}).text);
  const Truth other = truth({"--on", "floor", "--samples", "3", "--sample-seed", "18446744073709551615"});
  EXPECT_EQ(other.head("receivers"), "floor, 3 samples, seed 18446744073709551615");
  EXPECT_NE(first.text.substr(first.text.find("\n1,")), other.text.substr(other.text.find("\n1,")));
}

TEST_F(ReceiverFlags, AllIsEveryPatchWithArea) {
  EXPECT_EQ(truth({"--on", "all", "--centres"}).ids(), (Words{"floor:1", "lid:1", "\"a,b:1\"", "lamp:1"}));
  EXPECT_EQ(truth({"--on", "floor", "--centres"}, "all").head("sources"), "floor + lid + a,b + lamp");
}

TEST_F(ReceiverFlags, APatchNamedAllWins) {
  const std::string scene = directory_.write("all.obj", kRoom + "g all\nf 1 2 4\n").string();
  EXPECT_EQ(truth({"--on", "all", "--centres"}, "lamp", scene).ids(), (Words{"all:1"}));
  EXPECT_EQ(truth({"--on", "floor", "--centres"}, "all", scene).head("sources"), "all");
}

TEST_F(ReceiverFlags, SourcesAreThoseThatEmitUnlessNamed) {
  EXPECT_EQ(truth({"--on", "floor", "--centres"}, "").head("sources"), "lamp");
  EXPECT_EQ(truth({"--on", "floor", "--centres"}, "lid,a,b").exit_code, 2);
  EXPECT_EQ(truth({"--on", "floor", "--centres", "--source", "lid:2"}).head("sources"), "lid:2 + lamp");
}

// What is missing, contradicts, or is no number or name.
TEST_F(ReceiverFlags, WrongFlagsAreTold) {
  const Words on_floor = {"--on", "floor"};
  const std::string none = directory_.write("none.csv", "x,y,z,nx,ny,nz\n").string();
  const std::string on_alone =
      "--on is given without --grid, --vertices, --centres or --samples (they say where the receivers lie on the "
      "patch); add one of them, for example --grid 32x32\n";
  const std::string together =
      "--grid, --vertices and --centres are given together (each places the receivers in a different way); keep only "
      "one of them\n";
  for (const auto& [flags, told] : std::vector<std::pair<Words, std::string>>{
           {{}, "there are no receivers (values are computed at receivers); give --on NAME with --grid 32x32"},
           {on_floor, on_alone},
           {{"--vertices"}, "--vertices is given without --on (it places receivers on a patch)"},
           {{"--on", "floor", "--centres", "--sample-seed", "2"}, "--sample-seed is given without --samples (only"},
           {{"--on", "floor", "--grid", "2x2", "--vertices", "--centres"}, together},
           {{"--receivers", "p.csv", "--on", "floor", "--grid", "2x2"}, "--receivers is given together with --on and"},
           {{"--on", "floor", "--grid", "2x2x2"}, "--grid: '2x2x2' is not a grid (a grid is two whole numbers); write"},
           {{"--on", "floor", "--grid", "0x2"}, "a grid of 0x2 cells (a grid has at least one column and one row)"},
           {{"--on", "floor", "--samples", "1e3"}, "--samples: '1e3' is not a whole number in range (it is the number"},
           {{"--on", "floor", "--samples", "0"}, "0 samples (the number of receivers must be between 1 and 4194304)"},
           {{"--on", "floor", "--samples", "9", "--sample-seed", "18446744073709551616"}, "--sample-seed: '184467440"},
           {{"--on", "lid,lid:2", "--centres"}, "--on: 'lid:2' is named twice (every receiver on it would occur twi"},
           {{"--on", "line", "--vertices"}, "--on: no face has area in 'line' (receivers lie on faces); choose"},
           {{"--on", "flor", "--vertices"},
            (directory_.path() / "room.obj").string() + ": there is no patch named 'flor' ("},
           {{"--on", "lid:1", "--grid", "1x1"}, "there are no receivers in lid:1, grid 1x1 (no cell of the grid has"},
           {{"--receivers", none}, "there are no receivers in none.csv (every row of the file is a receiver)"}}) {
    EXPECT_TRUE(refusal(flags).starts_with(told)) << refusal(flags);
  }
  for (const char* source : {"lamp,lamp", "all,lamp"}) {
    EXPECT_EQ(refusal({"--on", "floor", "--centres"}, source),
              "--source: 'lamp' is named twice (its light would count twice); give it once\n");
  }
}

}  // namespace
}  // namespace exactff
