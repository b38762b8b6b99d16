// Many receivers over threads: the values of single calls, whatever the threads; progress, cancellation, exceptions.
#include <atomic>
#include <stdexcept>
#include <thread>

#include "support/test.h"

namespace exactff {
namespace {

class Batch : public ::testing::Test {
 protected:
  Batch() : scene_(models::make_scene("soup:n=40,seed=3")), source_(scene_, scene_.select("source")) {
    receivers_ = grid_receivers(scene_, scene_.select("floor"), {12, 12});
  }

  [[nodiscard]] std::vector<double> values(const batch::Run& run) const {
    std::vector<double> found(receivers_.size(), -1.0);
    const ExactSource* const list[] = {&source_};
    batch::exact_form_factors(scene_, batch::receivers_in(receivers_), list, {}, run,
                              [&](std::size_t i, std::size_t, const FormFactor& f) { found[i] = f.value; });
    return found;
  }

  const std::thread::id caller_ = std::this_thread::get_id();
  Scene scene_;
  ExactSource source_;
  std::vector<Receiver> receivers_;
};

TEST_F(Batch, ValuesAreThoseOfSingleCalls) {
  std::vector<double> expected;
  for (const Receiver& receiver : receivers_) expected.push_back(exact_form_factor(scene_, receiver, source_).value);
  for (const int threads : {0, 1, 2, 7}) EXPECT_EQ(values({threads, {}}), expected) << threads;
}

TEST_F(Batch, EstimatesAreThoseOfSingleCalls) {
  const methods::Choice choice = methods::parse("wallace:splits=4");
  const auto on_scene = choice.method->prepare(scene_);
  const auto light = on_scene->prepare_source(scene_.select("source"));
  const auto evaluator = on_scene->configure(choice.settings);
  std::vector<double> expected, found(receivers_.size());
  for (const Receiver& receiver : receivers_) expected.push_back(evaluator->form_factor(receiver, *light).form_factor);
  const methods::PreparedSource* const list[] = {light.get()};
  for (const int threads : {1, 3}) {
    batch::form_factors(
        *on_scene, choice.settings, batch::receivers_in(receivers_), list, {threads, {}},
        [&](std::size_t i, std::span<const methods::Estimate> estimates) { found[i] = estimates[0].form_factor; });
    EXPECT_EQ(found, expected) << threads;
  }
}

TEST_F(Batch, ProgressEndsAtTheTotalAndComesFromTheCallingThread) {
  for (const int threads : {1, 2}) {
    std::size_t last = 0;
    const Hooks hooks{[&](const Progress& at) {
                        EXPECT_EQ(std::this_thread::get_id(), caller_);
                        EXPECT_GE(at.done, last);
                        last = at.done;
                        EXPECT_EQ(at.total, receivers_.size());
                      },
                      {}};
    (void)values({threads, hooks});
    EXPECT_EQ(last, receivers_.size());
  }
}

// As a signal would be: only the calling thread can know.
TEST_F(Batch, TheCallingThreadCancels) {
  for (const int threads : {1, 3}) {
    std::atomic<bool> stop = false;
    const Hooks hooks{{}, [&] { return stop || (std::this_thread::get_id() == caller_ && (stop = true)); }};
    EXPECT_THROW((void)values({threads, hooks}), Cancelled) << threads;
  }
}

TEST_F(Batch, HooksOfTheCallingThreadCancelToo) {
  const Hooks hooks{{}, [] { return true; }};
  const HooksOfThread during(hooks);
  for (const int threads : {1, 3}) EXPECT_THROW((void)values({threads, {}}), Cancelled) << threads;
}

TEST_F(Batch, WhatAReceiverThrowsIsThrown) {
  receivers_[77].normal = {};
  for (const int threads : {1, 3}) EXPECT_THROW((void)values({threads, {}}), InputError) << threads;
}

TEST_F(Batch, FacesAreThoseOfSingleCalls) {
  std::vector<std::vector<FaceId>> found(receivers_.size());
  batch::find_faces(scene_, batch::receivers_in(receivers_), {}, {3, {}},
                    [&](std::size_t i, const NearFaces& near) { found[i] = near.faces; });
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], receivers_[i].on) << i;
}

}  // namespace
}  // namespace exactff
