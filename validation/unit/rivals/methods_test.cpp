#include <thread>

#include "support/test.h"
#include "unit/rivals/methods_support.h"

namespace exactff::validation {
namespace {

using methods::Choice;
using methods::Estimate;
using methods::Method;

TEST(MethodSettings, TextReadsBackToTheSameChoice) {
  for (const Method* method : methods::all_methods()) {
    const Choice choice{method, method->defaults()};
    EXPECT_EQ(methods::parse(choice.text()), choice) << choice.text();
    EXPECT_EQ(methods::parse(choice.short_text()), choice);
    EXPECT_EQ(choice.short_text(), method->name);
  }
  const Choice choice = methods::parse(" adaptive : rays = 64 , eps_B=1e-5,pattern=low-discrepancy, variant=literal ");
  EXPECT_EQ(choice.settings.whole("rays"), 64);
  EXPECT_EQ(choice.settings.number("eps_B"), 1e-5);
  EXPECT_EQ(choice.settings.word("pattern"), "low-discrepancy");
  EXPECT_EQ(methods::parse(choice.text()), choice);
  EXPECT_EQ(choice.short_text(), "adaptive:eps_B=1e-05,rays=64,pattern=low-discrepancy,variant=literal");
}

TEST(MethodSettings, EverythingWrongIsSaidAtOnce) {
  const std::string text =
      complaint([] { (void)methods::parse("nettle:split=3,rays=0,rays=2,pattern=cubic,receiver_area=-1,seed"); });
  for (const char* part :
       {"there is no setting 'split' (settings are splits, rays, pattern", "did you mean splits?",
        "'0' is not a valid value of rays", "a whole number from 1 to 65536", "setting 'rays' is given twice",
        "one of jittered, centre, regular, low-discrepancy", "a number of at least 0", "'seed' has no value"}) {
    EXPECT_HOLDS(text, part) << part << "\nis not in\n" << text;
  }
}

TEST(MethodSettings, NumbersThatAreNoneAreRefused) {
  for (const char* text : {"hemicube:resolution=101", "hemicube:resolution=1e2", "hemicube:resolution=",
                           "hemicube:resolution=99999999999999999999", "hemicube:rotation=nan", "adaptive:eps_B=inf",
                           "adaptive:eps_B=0,eps_A=0", "area-sampling:samples=0", "exact:engine=fast", ""}) {
    EXPECT_THROW((void)methods::parse(text), InputError) << text;
  }
  EXPECT_HOLDS(complaint([] { (void)methods::parse("hemicube:resolution=101"); }), "an even whole number from 2");
}

TEST(MethodSettings, OnlyWhatCanChangeAValueTellsChoicesApart) {
  const auto normal = [](const char* text) {
    const Choice choice = methods::parse(text);
    return choice.method->normalised(choice.settings);
  };
  EXPECT_EQ(normal("adaptive:pattern=centre,rays=64,seed=9"), normal("adaptive:pattern=centre"));
  EXPECT_EQ(normal("nettle:receiver_area=3"), normal("nettle"));
  EXPECT_FALSE(normal("nettle:variant=literal,receiver_area=3") == normal("nettle:variant=literal"));
  EXPECT_EQ(normal("exact:engine=boolean"), normal("exact"));
  EXPECT_FALSE(normal("area-sampling:seed=2") == normal("area-sampling"));
}

// `stochastic` is set exactly for the methods whose values depend on the seed.
TEST(Methods, ASeedChangesTheValueOfStochasticMethodsOnly) {
  const Scene room = furnished_room();
  const Receiver receiver = room_receivers(room)[0];  // this receiver sees half of the lamp
  for (const char* text : {"area-sampling", "area-sampling:pattern=sobol", "adaptive:eps_B=1e-4", "nettle:splits=4",
                           "wallace:pattern=jittered"}) {
    const std::string with = std::string(text) + (std::string_view(text).find(':') == std::string::npos ? ":" : ",");
    const double first = estimate(room, receiver, "lamp", with + "seed=1").form_factor;
    EXPECT_EQ(estimate(room, receiver, "lamp", with + "seed=1").form_factor, first) << text;
    EXPECT_NE(estimate(room, receiver, "lamp", with + "seed=2").form_factor, first) << text;
  }
  EXPECT_EQ(estimate(room, receiver, "lamp", "adaptive:pattern=regular,seed=1").form_factor,
            estimate(room, receiver, "lamp", "adaptive:pattern=regular,seed=2").form_factor);
}

// One choice of each kind of work.
constexpr const char* kChoices[] = {"exact",
                                    "exact:engine=boolean",
                                    "adaptive:eps_B=1e-4",
                                    "adaptive-exact-visibility:eps_B=1e-3",
                                    "hemicube:resolution=32,rotation=10",
                                    "nettle:splits=3",
                                    "nettle:variant=literal",
                                    "wallace:splits=6,pattern=jittered",
                                    "area-sampling",
                                    "area-sampling:pattern=stratified",
                                    "area-sampling:pattern=sobol"};

std::vector<double> values_of(const methods::PreparedScene& on_scene, const methods::PreparedSource& source,
                              const Choice& choice, const std::vector<Receiver>& receivers) {
  std::vector<double> values;
  const auto evaluator = on_scene.configure(choice.settings);
  for (const Receiver& receiver : receivers) values.push_back(evaluator->form_factor(receiver, source).form_factor);
  return values;
}

TEST(Methods, SeveralThreadsShareWhatIsPreparedAndGetTheSameBits) {
  const Scene room = furnished_room();
  const std::vector<Receiver> receivers = room_receivers(room);
  for (const char* text : kChoices) {
    const Choice choice = methods::parse(text);
    const auto on_scene = choice.method->prepare(room);
    const auto lamp = on_scene->prepare_source(room.select("lamp"));
    std::vector<std::vector<double>> found(4);
    {
      std::vector<std::jthread> threads;
      for (std::vector<double>& values : found) {
        threads.emplace_back([&] { values = values_of(*on_scene, *lamp, choice, receivers); });
      }
    }
    std::vector<double> one_by_one;
    for (const Receiver& receiver : receivers) one_by_one.push_back(estimate(room, receiver, "lamp", text).form_factor);
    for (const std::vector<double>& values : found) EXPECT_EQ(values, one_by_one) << text;
  }
}

TEST(Methods, AllSourcesAtOnceGetTheValuesThatTheyGetOneByOne) {
  const Scene room = furnished_room();
  for (const char* text : kChoices) {
    const Choice choice = methods::parse(text);
    const auto on_scene = choice.method->prepare(room);
    std::vector<std::unique_ptr<methods::PreparedSource>> sources;
    std::vector<const methods::PreparedSource*> pointers;
    for (const char* name : {"lamp", "wall", "table", "vase", "wall:1"}) {
      sources.push_back(on_scene->prepare_source(room.select(name)));
      pointers.push_back(sources.back().get());
    }
    const auto evaluator = on_scene->configure(choice.settings);
    for (const Receiver& receiver : room_receivers(room)) {
      std::vector<Estimate> together(sources.size());
      evaluator->look_from(receiver);
      evaluator->form_factors(pointers, together);
      for (std::size_t i = 0; i < sources.size(); ++i) {
        const auto fresh = on_scene->configure(choice.settings);
        EXPECT_EQ(fresh->form_factor(receiver, *sources[i]).form_factor, together[i].form_factor) << text << ' ' << i;
      }
    }
  }
}

// The zeros of the definition: behind the source, in its plane, below the horizon, on the source itself.
TEST(Methods, WhatTheDefinitionSaysIsZeroIsZero) {
  PlainScene behind = open_scene();
  behind.point = {0, 0, 2};
  behind.normal = {0, 0, -1};
  PlainScene in_plane = open_scene();
  in_plane.point = {3, 0, 1};
  PlainScene turned_away = open_scene();
  turned_away.normal = {0, 0, -1};
  const Scene room = furnished_room();
  Receiver on_lamp = room_receivers(room)[0];
  on_lamp.on = {room.faces_of(room.select("lamp"))[1]};
  for (const char* text : kChoices) {
    if (std::string_view(text).find("literal") != std::string_view::npos) continue;
    EXPECT_EQ(value(behind, text), 0.0) << text;
    EXPECT_EQ(value(in_plane, text), 0.0) << text;
    EXPECT_EQ(value(turned_away, text), 0.0) << text;
    EXPECT_EQ(estimate(room, on_lamp, "lamp:2", text).form_factor, 0.0) << text;
  }
}

}  // namespace
}  // namespace exactff::validation
