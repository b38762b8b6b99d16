// The program with little memory or a small stack: it says so or needs no more, and never ends by a signal.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "unit/outside/hostile_program.h"
#include "unit/outside/sanitized.h"

namespace exactff {
namespace {

namespace fs = std::filesystem;

TEST_F(HostileProgram, TheEndOfMemoryIsTold) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  std::string text;
  for (int i = 0; i < 4'000'000; ++i) text += "v 0 0 0\n";
  const std::string many = directory_.write("many.obj", text + kRoom).string();
  const Running run = start({"info", many}, [] { limit(RLIMIT_AS, 200 << 20); });
  EXPECT_EQ(run.wait(), 4);
  EXPECT_TRUE(run.error().starts_with("exactff: out of memory (")) << run.error();
}

// What a pair of patches remembers is limited, however many edges lie between them.
TEST_F(HostileProgram, AMatrixNeedsLittleMemoryWhateverLiesBetween) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  for (const char* scene : {"@soup:n=3000,cover=3", "@tiles:n=40"}) {
    const Running run =
        start({"matrix", scene, "--from", "floor", "--to", "source", "--budget", "30", "--threads", "1", "--plain"},
              [] { limit(RLIMIT_AS, 400 << 20); });
    const int code = run.wait();
    EXPECT_TRUE(code == 0 || code == 3) << scene << '\n' << run.error();  // 3: wider than asked
  }
}

// With coordinates so far apart, only the exact numbers need much memory; GMP itself would abort.
TEST_F(HostileProgram, TheEndOfMemoryIsToldByExactNumbersToo) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  constexpr int kCorners = 2000;
  std::ostringstream text;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    text << "v " << 1e300 * std::cos(angle) << ' ' << 1e300 * std::sin(angle) << ' ' << 1e-300 * (1 + i % 7) << '\n';
  }
  text << 'f';
  for (int i = 1; i <= kCorners; ++i) text << ' ' << i;
  const std::string wide = directory_.write("wide.obj", text.str() + '\n').string();
  int told = 0;
  for (rlim_t megabytes = 60; megabytes <= 110; megabytes += 2) {
    const auto little_memory = [megabytes] { limit(RLIMIT_AS, megabytes << 20); };
    if (start({"--version"}, little_memory).wait() != 0) continue;  // not even the libraries can be loaded
    const int code = start({"info", wide}, little_memory).wait();
    EXPECT_TRUE(code == 0 || code == 4) << megabytes << " MB: " << code;
    if (code == 4) ++told;
  }
  EXPECT_GT(told, 0);
}

// Memory runs out at some point before main(), in it or in a thread. The program ends with one of its exit codes, or
// the loader's if it cannot map the libraries, but never by a signal.
class LittleMemory : public HostileProgram, public testing::WithParamInterface<const char*> {
 protected:
  std::vector<std::string> arguments() const {
    const std::string command = GetParam();
    if (command == "info") return {"info", room_};
    if (command == "point") return point({});
    if (command == "compare") return comparison(place_ / "result");
    std::vector<std::string> truth = truth_file(place_ / "truth.csv");
    *(std::ranges::find(truth, "--threads") + 1) = "2";
    return truth;
  }

  bool works_with(rlim_t kilobytes) const {
    const Running run = start(arguments(), [kilobytes] {
      limit(RLIMIT_AS, kilobytes << 10);
      ::setenv("PATH", "/nonexistent", 1);  // without gnuplot, which has its own limits
    });
    const int code = run.wait();
    const bool loaded = code != 127;
    EXPECT_TRUE(code == 0 || code == 4 || !loaded) << kilobytes << " kB: " << code << '\n' << run.error();
    EXPECT_EQ(code == 0 || !run.error().empty(), true) << kilobytes << " kB";
    EXPECT_TRUE(code != 4 || run.error().find("exactff: ") != std::string::npos) << run.error();
    fs::remove_all(place_);
    fs::create_directory(place_);
    return code == 0;
  }
};

TEST_P(LittleMemory, EndsItByNoSignal) {
  if (kSanitized) GTEST_SKIP() << "address space cannot be limited here";
  constexpr rlim_t kFine = 512;
  rlim_t fails = 20'000, works = 600'000;
  EXPECT_FALSE(works_with(fails));
  EXPECT_TRUE(works_with(works));
  while (works - fails > kFine) {
    const rlim_t middle = (fails + works) / 2;
    (works_with(middle) ? works : fails) = middle;
  }
  for (rlim_t less = kFine; less <= 24 * kFine; less += kFine) (void)works_with(works - less);
  for (rlim_t more = 1; more <= 4; ++more) (void)works_with(works + more * 10 * kFine);
}
INSTANTIATE_TEST_SUITE_P(All, LittleMemory, testing::Values("info", "point", "truth", "compare"),
                         [](const auto& test) { return std::string(test.param); });

TEST_F(HostileProgram, ASmallStackIsEnough) {
  if (kSanitized) GTEST_SKIP() << "sanitized code needs a large stack";
  constexpr int kTeeth = 10'000;
  std::string text = "v 0 -1 0\nv " + std::to_string(kTeeth) + " -1 0\n", face = "g comb\nf 1 2";
  for (int i = kTeeth; i-- > 0;) {
    const std::string x = std::to_string(i);
    text += "v " + x + ".5 1000 " + (i % 2 == 0 ? "0" : ".1") + "\nv " + x + " 0 0\n";
    const int next = 2 * (kTeeth - i) + 1;
    face += ' ' + std::to_string(next) + ' ' + std::to_string(next + 1);
  }
  const std::string comb =
      directory_.write("comb.obj", text + face + "\ng light\nv 0 0 9\nv 1 0 9\nv 0 1 9\nf -1 -2 -3\n").string();
  const Running run =
      start({"point", comb, "--at", "0", "0", "5", "--normal", "0", "0", "1", "--source", "light", "--plain"},
            [] { limit(RLIMIT_STACK, 256 << 10); });
  EXPECT_EQ(run.wait(), 0) << run.error();
}

}  // namespace
}  // namespace exactff
