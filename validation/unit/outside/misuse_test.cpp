// What a program that uses the library can get wrong ends in an exception with words: never in a crash, never in a
// silent value.
#include <stdexcept>

#include "kernel/statistics.h"
#include "support/test.h"
#include "unit/reports/study_support.h"

namespace exactff {
namespace {

// Without those that other tests of this process have added.
std::vector<const methods::Method*> library_methods() {
  std::vector<const methods::Method*> methods;
  for (const char* name :
       {"exact", "adaptive", "adaptive-exact-visibility", "hemicube", "nettle", "wallace", "area-sampling"}) {
    methods.push_back(&methods::method_named(name));
  }
  return methods;
}

const Receiver kBelow{.point = {1.0, 0.5, 0.1}, .normal = {0.0, 0.0, 1.0}, .on = {}, .id = {}};

Scene room() { return small_room(true); }

// The message of the exception, or none if another exception or none was thrown.
template <class Exception>
std::string words_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Exception& error) {
    return error.what();
  } catch (...) {
    return "";
  }
  return "";
}

void expect_refused(const std::string& words, const std::function<void()>& call) {
  const std::string found = words_of<std::invalid_argument>(call);
  EXPECT_HOLDS(found, words) << "wanted '" << words << "', found '" << found << "'";
}

void expect_moved_from(const std::string& what, const std::function<void()>& call) {
  EXPECT_EQ(words_of<std::logic_error>(call),
            "this " + what + " was moved from; it can only be assigned to or destroyed");
}

TEST(Misuse, APrecisionCapBelowOneBitIsAnInputError) {
  const Scene scene = room();
  const ExactSource lamp(scene, scene.select("lamp"));
  for (const int cap : {0, -1, -65536}) {
    for (const Engine engine : {Engine::kEdges, Engine::kBoolean, Engine::kBoth}) {
      const std::string words = words_of<InputError>(
          [&] { (void)exact_form_factor(scene, kBelow, lamp, {.engine = engine, .precision_cap = cap}); });
      EXPECT_HOLDS(words, "precision cap is " + std::to_string(cap) + " bits");
    }
  }
  EXPECT_EQ(exact_form_factor(scene, kBelow, lamp, {.precision_cap = 1}).status, Status::kNotCertified);
}

TEST(Misuse, ABuilderRefusesIdsThatItHasNotMade) {
  SceneBuilder builder;
  const std::vector<std::vector<std::uint32_t>> ring = {{0, 1, 2}};
  expect_refused("there is no patch 7", [&] { builder.add_face(PatchId{7}, MaterialId{0}, ring); });
  const PatchId patch = builder.patch("a");
  expect_refused("there is no material 0", [&] { builder.add_face(patch, MaterialId{0}, ring); });
  for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}) builder.add_vertex(corner);
  builder.add_face(patch, builder.add_material({}), ring);  // a refused call leaves the object unchanged
  EXPECT_EQ(builder.build().faces().size(), 1U);
}

TEST(Misuse, ASelectionWithoutSuchIdsIsRefused) {
  const Scene scene = room();
  const auto all_take = [&](const Selection& selection, const std::string& words) {
    expect_refused(words, [&] { (void)ExactSource(scene, selection); });
    expect_refused(words, [&] { (void)scene.faces_of(selection); });
    expect_refused(words, [&] { (void)scene.name_of(selection); });
    expect_refused(words, [&] { (void)scene.source_radiosity(selection); });
    expect_refused(words, [&] { (void)scene.with_flipped(selection); });
    expect_refused(words, [&] { (void)AdaptiveSolver(scene).prepare(selection); });
    expect_refused(words, [&] { (void)grid_receivers(scene, selection, {2, 2}); });
    for (const methods::Method* method : library_methods()) {
      expect_refused(words, [&] { (void)method->prepare(scene)->prepare_source(selection); });
    }
  };
  all_take({PatchId{3}, {}, scene.id()}, "there is no patch 3");
  all_take({PatchId{0}, FaceId{3}, scene.id()}, "there is no face 3");
  all_take({PatchId{0}, FaceId{1}, scene.id()}, "face 1 does not belong to patch 'floor'");
}

TEST(Misuse, WhatAnotherSceneMadeIsRefused) {
  const Scene scene = room(), other = room();
  const Selection lamp = scene.select("lamp");
  for (const Selection& made : {lamp, scene.select("lamp:1"), scene.emitters().front()}) {
    expect_refused("the selection belongs to another scene", [&] { (void)ExactSource(other, made); });
  }
  const ExactSource source(scene, lamp);
  expect_refused("the source belongs to another scene", [&] { (void)exact_form_factor(other, kBelow, source); });
  expect_refused("the source belongs to another scene", [&] { (void)draw_visibility(other, kBelow, source); });
  const AdaptiveSolver solver(scene), other_solver(other);
  const AdaptiveSource prepared = solver.prepare(lamp);
  expect_refused("the source belongs to another scene",
                 [&] { (void)other_solver.form_factor(kBelow, prepared, 1.0, {}); });
  const Scene flipped = scene.with_flipped(lamp);
  expect_refused("the source belongs to another scene", [&] { (void)exact_form_factor(flipped, kBelow, source); });
  EXPECT_NO_THROW((void)ExactSource(other, {lamp.patch, lamp.face, other.id()}));
  expect_refused("the selection belongs to another scene", [&] { (void)ExactSource(other, Selection{}); });
}

TEST(Misuse, AReceiverOnAFaceThatIsNotThereIsRefused) {
  const Scene scene = room();
  const Selection lamp = scene.select("lamp");
  const ExactSource source(scene, lamp);
  Receiver receiver = kBelow;
  receiver.on = {FaceId{3}};
  expect_refused("there is no face 3", [&] { (void)exact_form_factor(scene, receiver, source); });
  expect_refused("there is no face 3", [&] { (void)draw_visibility(scene, receiver, source); });
  expect_refused("there is no face 3", [&] { (void)scene.receiver_reflectance(receiver.on); });
  for (const methods::Method* method : library_methods()) {
    SCOPED_TRACE(method->name);
    const auto on_scene = method->prepare(scene);
    const auto prepared = on_scene->prepare_source(lamp);
    const auto evaluator = on_scene->configure(method->defaults());
    expect_refused("there is no face 3", [&] { (void)evaluator->form_factor(receiver, *prepared); });
  }
}

TEST(Misuse, OccludersOutOfOrderOrNotThereAreRefused) {
  const Scene scene = room();
  const ExactSource source(scene, scene.select("lamp"));
  const auto solve_with = [&](const std::vector<FaceId>& only) {
    return exact_form_factor(scene, kBelow, source, {.only_occluders = &only}).value;
  };
  expect_refused("only_occluders is not in ascending order", [&] { (void)solve_with({FaceId{2}, FaceId{0}}); });
  expect_refused("there is no face 3", [&] { (void)solve_with({FaceId{0}, FaceId{3}}); });
  EXPECT_EQ(solve_with({FaceId{0}, FaceId{1}, FaceId{2}}), exact_form_factor(scene, kBelow, source).value);
  EXPECT_GT(solve_with({}), solve_with({FaceId{0}, FaceId{1}, FaceId{2}}));
}

TEST(Misuse, MovedFromObjectsSaySo) {
  Scene scene = room();
  const Selection lamp = scene.select("lamp");
  ExactSource source(scene, lamp);
  AdaptiveSolver solver(scene);
  AdaptiveSource prepared = solver.prepare(lamp);
  const ExactSource kept_source = std::move(source);
  expect_moved_from("ExactSource", [&] { (void)exact_form_factor(scene, kBelow, source); });
  expect_moved_from("ExactSource", [&] { (void)source.selection(); });
  FormFactor result;
  Workspace workspace;
  const Workspace kept_workspace = std::move(workspace);
  expect_moved_from("Workspace", [&] { exact_form_factor(scene, kBelow, kept_source, {}, result, workspace); });
  const AdaptiveSource kept_prepared = std::move(prepared);
  expect_moved_from("AdaptiveSource", [&] { (void)solver.form_factor(kBelow, prepared, 1.0, {}); });
  const AdaptiveSolver kept_solver = std::move(solver);
  expect_moved_from("AdaptiveSolver", [&] { (void)solver.form_factor(kBelow, kept_prepared, 1.0, {}); });
  expect_moved_from("AdaptiveSolver", [&] { (void)solver.build_seconds(); });
  SceneBuilder builder;
  SceneBuilder kept_builder = std::move(builder);
  expect_moved_from("SceneBuilder", [&] { builder.add_vertex({}); });
  expect_moved_from("SceneBuilder", [&] { (void)builder.patch("a"); });
  expect_moved_from("SceneBuilder", [&] { (void)builder.build(); });
  const Scene kept_scene = std::move(scene);
  expect_moved_from("Scene", [&] { (void)scene.faces(); });
  expect_moved_from("Scene", [&] { (void)scene.select("lamp"); });
  expect_moved_from("Scene", [&] { (void)scene.hash(); });
  expect_moved_from("Scene", [&] { (void)exact_form_factor(scene, kBelow, kept_source); });
}

TEST(Misuse, RequestsWithoutASceneAndChoicesWithoutAMethodSaySo) {
  EXPECT_NE(words_of<std::invalid_argument>([] { (void)study::run({}); }), "");
  EXPECT_NE(words_of<std::invalid_argument>([] { (void)truth::write({}, "never_written.csv"); }), "");
  EXPECT_NE(words_of<std::logic_error>([] { (void)methods::Choice().text(); }), "");
  EXPECT_NE(words_of<std::logic_error>([] { (void)methods::Choice().short_text(); }), "");
}

}  // namespace
}  // namespace exactff
