// Long computations ask on the way whether to go on, and Ctrl-C ends the program at once.
#include <atomic>
#include <chrono>
#include <csignal>
#include <thread>

#include "files/parallel.h"
#include "support/test.h"
#include "unit/outside/sanitized.h"

namespace exactff {
namespace {

// Cancels at the n-th question.
struct Patience {
  explicit Patience(std::size_t questions = ~std::size_t{0}) : most(questions) {}
  std::size_t most;
  std::atomic<std::size_t> asked = 0;
  Hooks hooks{{}, [this] { return ++asked > most; }};
};

const Receiver kUp{.point = {0, 0, 0}, .normal = {0, 0, 1}, .on = {}, .id = ""};

class OnePair : public testing::Test {
 protected:
  FormFactor value(Workspace& workspace) const {
    FormFactor result;
    exact_form_factor(scene_, kUp, source_, {}, result, workspace);
    return result;
  }
  const Scene scene_ = models::make_scene("soup:n=3000,floor=0");
  const ExactSource source_{scene_, scene_.select("source")};
};

TEST_F(OnePair, CanBeCancelledAtEveryQuestion) {
  Workspace workspace;
  const FormFactor undisturbed = value(workspace);
  Patience endless;
  {
    const HooksOfThread asked(endless.hooks);
    EXPECT_EQ(value(workspace).value, undisturbed.value);
  }
  ASSERT_GT(endless.asked, 10U) << "a pair of some milliseconds";
  for (std::size_t most = 0; most < endless.asked; most += 3) {
    const Patience short_one(most);
    const HooksOfThread asked(short_one.hooks);
    EXPECT_THROW((void)value(workspace), Cancelled) << most;
  }
  const FormFactor again = value(workspace);  // in the memory that the cancelled calls have left
  EXPECT_EQ(again.value, undisturbed.value);
  EXPECT_EQ(again.enclosure.midpoint(), undisturbed.enclosure.midpoint());
  EXPECT_EQ(again.planes.front().pairs, undisturbed.planes.front().pairs);
}

TEST_F(OnePair, OfEveryMethodCanBeCancelled) {
  const Scene scene = models::make_scene("soup:n=800,floor=0");
  for (const char* text : {"exact", "exact:engine=boolean", "adaptive:eps_B=1e-6", "hemicube:resolution=64",
                           "nettle:splits=16,rays=256", "wallace:splits=64", "area-sampling:samples=4096"}) {
    const methods::Choice choice = methods::parse(text);
    const auto on_scene = choice.method->prepare(scene);
    const auto source = on_scene->prepare_source(scene.select("source"));
    const auto evaluator = on_scene->configure(choice.settings);
    const double undisturbed = evaluator->form_factor(kUp, *source).form_factor;
    Patience patience(1);
    {
      const HooksOfThread asked(patience.hooks);
      EXPECT_THROW((void)evaluator->form_factor(kUp, *source), Cancelled) << text;
    }
    EXPECT_EQ(evaluator->form_factor(kUp, *source).form_factor, undisturbed) << text;
  }
}

TEST_F(OnePair, CanBeCancelledInAWholeView) {
  const Patience patience(1);
  const HooksOfThread asked(patience.hooks);
  EXPECT_THROW((void)view(scene_, kUp), Cancelled);
}

class Interruption : public testing::Test {
 protected:
  // Sends the signal when the program has computed for a while. Returns what it said.
  std::string interrupted(const std::vector<std::string>& arguments, int signal = SIGINT) const {
    const RunningProgram run(EXACTFF_PROGRAM, arguments, directory_.path() / "stderr");
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_FALSE(run.has_ended()) << run.error();
    const auto sent = std::chrono::steady_clock::now();
    run.send(signal);
    EXPECT_EQ(run.wait(), 128 + signal);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - sent;
    EXPECT_LT(took.count(), kSanitized ? 10.0 : 2.0) << "half a second; the machine may be busy";
    return run.error();
  }

  const TemporaryDirectory directory_;
};

std::vector<std::string> long_point(const std::string& scene, const std::vector<std::string>& more = {}) {
  return joined({"point", scene, "--at", "0", "0", "0", "--normal", "0", "0", "1", "--source", "source"}, more);
}

TEST_F(Interruption, EndsOnePairOfThousandsOfDigits) {
  for (const int signal : {SIGINT, SIGTERM}) {
    EXPECT_EQ(interrupted(long_point("@soup:n=30000", {"--digits", "3000"}), signal), "exactff: interrupted\n");
  }
}

TEST_F(Interruption, EndsTheMakingOfReceivers) {
  const std::string file = (directory_.path() / "truth.csv").string();
  EXPECT_EQ(interrupted({"truth", "@soup:n=10", "--on", "floor", "--grid", "2000x2000", "-o", file}),
            "exactff: interrupted; no row was begun\n");
  EXPECT_EQ(interrupted({"compare", "@soup:n=10", "--on", "floor", "--samples", "4000000", "-o",
                         (directory_.path() / "out").string()}),
            "exactff: interrupted\n");
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

}  // namespace
}  // namespace exactff
