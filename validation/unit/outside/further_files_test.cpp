// --npy and --vtk of truth, merge and compare: what is written, resumed, interrupted and refused.
#include <thread>

#include "support/test.h"
#include "table/csv.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

class FurtherFiles : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (directory_.path() / name).string(); }
  [[nodiscard]] Words truth(const Words& more, const std::string& grid = "6x6") const {
    return joined({"truth", kScene, "--on", "floor", "--grid", grid}, more);
  }
  // Returns the exit code; standard error is in error().
  int run(const Words& words) {
    const RunningProgram running(EXACTFF_PROGRAM, words, path("stderr"));
    const int code = running.wait();
    error_ = running.error();
    fs::remove(path("stderr"));
    return code;
  }
  void expect_refused(const Words& words, const std::string& what) {
    EXPECT_EQ(run(words), 2) << what;
    EXPECT_HOLDS(error_, what);
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_.path()), {}), before_) << error_;
  }
  [[nodiscard]] std::vector<double> doubles(const std::string& name) const {
    const std::string bytes = text_of(path(name));
    std::vector<double> values((bytes.size() - 128) / sizeof(double));
    std::memcpy(values.data(), &bytes[128], values.size() * sizeof(double));
    return values;
  }

  static constexpr const char* kScene = EXACTFF_DATA_DIR "/scenes/cornell_box.obj";
  const TemporaryDirectory directory_{memory_folder()};
  std::string error_;
  long before_ = 0;
};

TEST_F(FurtherFiles, AreNotWrittenWhereTheyCannotBe) {
  const std::string csv = path("t.csv");
  expect_refused(truth({"-o", csv, "--npy", path("none/t.npy")}), "No such file or directory");
  expect_refused(truth({"-o", csv, "--npy", directory_.path()}), "is a folder (--npy)");
  expect_refused(truth({"-o", csv, "--npy", "/dev/null"}), "is a device (--npy)");
  expect_refused(truth({"-o", csv, "--npy", "-"}), "is not the name of a file (--npy)");
  expect_refused(truth({"-o", csv, "--vtk", path("t.vtk")}), "does not end in .vtp or .vtu");
  expect_refused(truth({"-o", csv, "--npy", csv}), "is given for two outputs (-o and --npy)");
  expect_refused(truth({"-o", csv, "--npy", path("./t_scene.vtp"), "--vtk", path("t.vtp")}),
                 "is given for two outputs (--npy and the scene of --vtk)");
  expect_refused(truth({"-o", csv, "--npy", csv + ".part"}), "is given for two outputs (the journal of -o and --npy)");
  expect_refused(truth({"-o", "-", "--npy", path("t.npy")}), "--npy is given with -o -");
  expect_refused(truth({"-o", "-", "--npy", path("t.npy"), "--vtk", path("t.vtp")}), "--npy and --vtk are given");
  expect_refused(truth({"-o", csv, "--npy", path("t.npy"), "--shard", "1/2"}), "give --npy to exactff merge");
  expect_refused(truth({"-o", csv, "--npz", path("t.npz"), "--shard", "1/2"}), "give --npz to exactff merge");
  expect_refused(truth({"-o", csv, "--npz", path("t.npz"), "--npy", path("t.npz")}),
                 "is given for two outputs (--npy and --npz)");
  expect_refused(truth({"-o", csv, "--vtk", path("t.vtp"), "--shard", "1/2"}), "with --resume and -o FILE");
  expect_refused({"compare", "some.study", "-o", path("report"), "--vtk", path("t.vtp")},
                 "--vtk is given with a study");
  expect_refused(
      {"compare", kScene, "--on", "floor", "--grid", "2x2", "-o", path("report"), "--vtk", path("report/t.vtp")},
      "lies in the folder of the result");
}

TEST_F(FurtherFiles, HaveTheSameBytesForAnyThreadsAndAreMadeAgainByResume) {
  const auto words = [&](const std::string& name, const Words& more) {
    Words all = truth({"--source", "light,back", "-o", path(name + ".csv"), "--npy", path(name + ".npy"), "--vtk",
                       path(name + ".vtu"), "--npz", path(name + ".npz")});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  ASSERT_EQ(run(words("a", {"--threads", "1"})), 0);
  ASSERT_EQ(run(words("b", {"--threads", "3"})), 0);
  fs::remove(path("b.vtu"));
  fs::remove(path("b.npz"));
  std::ofstream(path("b.npy")) << "half";
  ASSERT_EQ(run(words("b", {"--resume"})), 0);
  for (const char* name : {".csv", ".npy", ".npz", ".vtu", "_scene.vtu"}) {
    EXPECT_EQ(text_of(path(std::string("a") + name)), text_of(path(std::string("b") + name))) << name;
  }
  EXPECT_EQ(doubles("a.npy").size(), 72U);
}

TEST_F(FurtherFiles, OfMergedShardsAreThoseOfOneRun) {
  ASSERT_EQ(run(truth({"--source", "light,back", "-o", path("a.csv"), "--npy", path("a.npy"), "--npz", path("a.npz")},
                      "12x12")),
            0);
  for (const char* k : {"1", "2"}) {
    ASSERT_EQ(run(truth({"--source", "light,back", "-o", path(k), "--shard", std::string(k) + "/2"}, "12x12")), 0);
  }
  ASSERT_EQ(run({"merge", path("2"), path("1"), "-o", path("b.csv"), "--npy", path("b.npy"), "--npz", path("b.npz")}),
            0);
  EXPECT_EQ(text_of(path("a.npz")), text_of(path("b.npz")));
  EXPECT_EQ(text_of(path("a.npy")), text_of(path("b.npy")));
  EXPECT_EQ(run({"merge", path("2"), path("1"), "-o", path("c.csv"), "--npy", path("b.npy")}), 2);
  EXPECT_FALSE(fs::exists(path("c.csv")));
}

// Of a small truth file with the sources s and t.
std::string small_head() {
  table::Head head;
  head.set("sources", Words{"s", "t"});
  std::vector<table::Column> columns;
  for (const char* name : {"receiver", "source"}) columns.push_back({.name = name, .type = table::Type::kText});
  for (const char* name : {"exact", "lower", "upper", "radiosity_r", "radiosity_g", "radiosity_b"}) {
    columns.push_back({.name = name});
  }
  columns.push_back({.name = "status", .type = table::Type::kText});
  return table::csv_head("truth", head, columns);
}
const std::string kSmallHead = small_head();

TEST_F(FurtherFiles, HaveNoNumberWhereAValueIsNotCertified) {
  const fs::path file = directory_.write("t.csv", kSmallHead +
                                                      "a,s,0.5,0.25,0.75,0,0,0,not certified\n"
                                                      "a,t,0.25,0.125,0.5,0,0,0,certified\n"
                                                      "b,s,0,0,0,0,0,0,zero\nb,t,0,0,5e-324,0,0,0,underflow\n");
  truth::write_npy(file, path("t.npy"));
  const std::vector<double> values = doubles("t.npy");
  ASSERT_EQ(values.size(), 4U);
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(std::vector(values.begin() + 1, values.end()), (std::vector<double>{0.25, 0.0, 0.0}));
  EXPECT_HOLDS(text_of(path("t.npy")), "'shape': (2, 2), }");
}

TEST_F(FurtherFiles, AreRefusedIfColumnsOfTheHeadAreMissing) {
  std::string text = text_of(directory_.write("t.csv", kSmallHead + "a,s,0,0,0,0,0,0,zero\na,t,0,0,0,0,0,0,zero\n"));
  text.replace(text.rfind("receiver,"), 8, "id");
  (void)directory_.write("t.csv", text);
  EXPECT_THROW(truth::write_npy(path("t.csv"), path("t.npy")), InputError);
}

TEST_F(FurtherFiles, AreRefusedForFilesThatHoldOtherRows) {
  for (const char* rows : {"a,s,0,0,0,0,0,0,zero\na,t,0,0,0,0,0,0,zero\nb,s,0,0,0,0,0,0,zero\n",  // one is missing
                           "a,s,0,0,0,0,0,0,zero\na,t,0,0,0,0,0,0,zero\nb,u,0,0,0,0,0,0,zero\nb,s,0,0,0,0,0,0,zero\n",
                           "a,s,0,0,0,0,0,0\n", "a,s,x,0,0,0,0,0,zero\n", "a,s,0,0,0,0,0,0,zer\n", ""}) {
    const fs::path file = directory_.write("t.csv", kSmallHead + rows);
    EXPECT_THROW(truth::write_npy(file, path("t.npy")), InputError) << rows;
    EXPECT_THROW(truth::write_npz(file, path("t.npy")), InputError) << rows;
    EXPECT_FALSE(fs::exists(path("t.npy"))) << rows;
  }
}

}  // namespace
}  // namespace exactff
