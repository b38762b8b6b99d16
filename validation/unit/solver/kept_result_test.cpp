// Results, workspaces and enclosures that are used again: nothing of the last value remains in them.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "exactff/enclosure.h"
#include "exactff/exact.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "kernel/ball.h"
#include "support/random_scenes.h"
#include "unit/solver/square_scenes.h"

namespace exactff {
namespace {

using generate::PlainScene;
using validation::add_square;
using validation::square_source;

// All fields of a record and of a result. If a field is added, this does not compile.
std::string text_of(const PlaneRecord& record) {
  const auto& [faces, engine, outcome, horizon_clipped, source_joined, tree_candidates, candidates, tree_edges,
               silhouettes, clipped, pairs, undecided_pairs, loops, edges, cover, cover_remembered, visible_fraction,
               exact_fraction, cutters] = record;
  std::ostringstream text;
  for (const FaceId face : faces) text << index_of(face) << ' ';
  text << to_string(engine) << ", " << to_string(outcome) << ", " << horizon_clipped << source_joined << ' '
       << tree_candidates << ' ' << candidates << ' ' << tree_edges << ' ' << silhouettes << ' ' << clipped << ' '
       << pairs << ' ' << undecided_pairs << ' ' << loops << ' ' << edges << ' ' << cover << cover_remembered << ' '
       << generate::to_text(visible_fraction.value_or(-1.0)) << ' ' << exact_fraction.value_or("none") << '\n';
  return text.str();
}

std::string text_of(const Derivative& derivative) {
  const auto& [value, status, enclosure] = derivative;
  std::ostringstream text;
  text << (status == DerivativeStatus::kNone ? "none" : generate::to_text(value)) << ' ' << to_string(status) << ", "
       << enclosure.midpoint() << " +- " << enclosure.radius() << '\n';
  return text.str();
}

std::string text_of(const Gradient& gradient) {
  const auto& [kink, position, normal, along, arcs, vertices, frames] = gradient;
  std::string text = kink ? std::string(to_string(kink->reason)) : "no kink";
  for (std::size_t i = 0; kink && i < kink->faces.size(); ++i) text += ' ' + std::to_string(index_of(kink->faces[i]));
  text += '\n';
  for (const Derivative& d : position) text += text_of(d);
  for (const Derivative& d : normal) text += text_of(d);
  if (along) text += "along " + text_of(*along);
  for (const GradientArc& arc : arcs) {
    for (const Vec3& v : {arc.begin, arc.end, arc.part}) {
      text += generate::to_text(v.x) + ' ' + generate::to_text(v.y) + ' ' + generate::to_text(v.z) + ' ';
    }
  }
  for (const VertexDerivative& v : vertices) {
    text += std::to_string(v.vertex) + (v.is_kink ? " kink\n" : "\n");
    for (const Derivative& d : v.position) text += text_of(d);
  }
  for (const auto& frame : frames) {
    for (const std::uint32_t vertex : frame) text += std::to_string(vertex) + ' ';
  }
  return text;
}

std::string text_of(const FormFactor& result) {
  const auto& [value, lower, upper, status, enclosure, visible_fraction, visible_part, cutters, planes, precision_bits,
               gradient] = result;
  std::ostringstream text;
  for (const double number : {value, lower, upper, visible_fraction.value_or(-1.0)}) {
    text << generate::to_text(number) << ' ';
  }
  text << to_string(status) << ", " << enclosure.midpoint() << " +- " << enclosure.radius() << ", "
       << (visible_part ? to_string(*visible_part) : "no part") << ", " << precision_bits << " bits, cut by";
  for (const FaceId face : cutters) text << ' ' << index_of(face);
  text << '\n';
  for (const PlaneRecord& record : planes) text << text_of(record);
  if (gradient) text << text_of(*gradient);
  return text.str();
}

// One result and one workspace are reused for all pairs; nothing of a pair may remain in them for the next.
class KeptResult : public ::testing::Test {
 protected:
  void expect_as_anew(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                      const ExactOptions& options) {
    exact_form_factor(scene, receiver, source, options, kept_, workspace_);
    FormFactor anew;
    Workspace fresh;
    exact_form_factor(scene, receiver, source, options, anew, fresh);
    EXPECT_EQ(text_of(kept_), text_of(anew));
    EXPECT_TRUE(kept_.enclosure.contains(anew.enclosure) && anew.enclosure.contains(kept_.enclosure));
  }
  void expect_as_anew(const PlainScene& plain, const ExactOptions& options) {
    const Scene scene = generate::build(plain);
    const ExactSource source(scene, scene.select(plain.source));
    expect_as_anew(scene, generate::receiver_of(plain), source, options);
  }

  FormFactor kept_;
  Workspace workspace_;
};

const std::vector<FaceId> kNobody;
const std::vector<ExactOptions> kOptions = {
    {},
    {.visible_fraction = true, .exact_fraction = true, .list_cutters = true},
    {.digits = 60},
    {.vertices = true},
    {.engine = Engine::kBoolean},
    {.precision_cap = 20},
    {.engine = Engine::kBoth, .visible_fraction = true},
    {.list_cutters = true, .culling = ShaftCulling::kNone},
    {.engine = Engine::kBoolean, .exact_fraction = true, .list_cutters = true},
    {.only_occluders = &kNobody},
    {.gradient = true},
    {.list_arcs = true, .along = Vec3{1.0, 2.0, 0.0}},
    {.engine = Engine::kBoth, .gradient = true},
    {.gradient = true, .precision_cap = 20},
};

TEST_F(KeptResult, IsAsOneMadeAnew) {
  std::vector<PlainScene> scenes(8, square_source());
  add_square(scenes[1], "hides_all", 0.9, 0.5);
  add_square(scenes[2], "hides_some", 0.2, 0.5, 0.1);
  scenes[3].normal = {0.0, 0.0, -1.0};  // below the horizon
  scenes[4].normal = {1.0, 0.0, 0.1};   // crosses the horizon
  scenes[5].point = {0.0, 0.0, 2.0};    // behind
  add_square(scenes[6], "source", 0.3, 0.8, 0.2, 0.1);
  scenes[6].add_ring(scenes[6].patch("source"), {{1, -1, 1}, {2, -1, 0.7}, {2, 1, 0.7}, {1, 1, 1}});
  add_square(scenes[7], "half", 0.5, 0.5, 0.5);
  add_square(scenes[7], "other_half", 0.5, 0.5, -0.5);
  for (std::size_t step : {1U, 5U, 7U}) {  // in several orders
    const std::size_t count = scenes.size() * kOptions.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = i * step % count;
      SCOPED_TRACE(at);
      expect_as_anew(scenes[at / kOptions.size()], kOptions[at % kOptions.size()]);
    }
  }
}

TEST_F(KeptResult, IsAsOneMadeAnewOnRandomScenes) {
  for (std::uint64_t i = 0; i < validation::scaled_count(30); ++i) {
    SCOPED_TRACE(i);
    generate::Random random(validation::seed_of(i));
    const PlainScene plain =
        random.below(2) == 0 ? validation::degenerate_scene(random) : validation::generic_scene(random);
    expect_as_anew(plain, kOptions[random.below(kOptions.size())]);
  }
}

TEST_F(KeptResult, OfSourcesOfManyPlanesAndOfFewIsAsOneMadeAnew) {
  PlainScene plain = square_source();
  generate::Random random(validation::seed_of(0));
  const auto corner = [&] { return Vec3{random.between(-1, 1), random.between(-1, 1), random.between(0.5, 2)}; };
  for (int k = 0; k < 9; ++k) plain.add_ring(plain.patch("many"), {corner(), corner(), corner()});
  const Scene scene = generate::build(plain);
  const ExactSource one(scene, scene.select("source")), many(scene, scene.select("many"));
  for (const ExactSource* source : {&many, &one, &one, &many, &one, &many}) {
    expect_as_anew(scene, generate::receiver_of(plain), *source, {.visible_fraction = true, .list_cutters = true});
  }
}

TEST_F(KeptResult, OutlivesAnException) {
  const PlainScene plain = square_source();
  expect_as_anew(plain, {.visible_fraction = true});
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  EXPECT_THROW(exact_form_factor(scene, Receiver{}, source, {}, kept_), InputError);
  expect_as_anew(plain, {});
}

TEST(Enclosure, IsItsOwnAfterACopy) {
  Ball half;
  arb_set_d(half.get(), 0.5);
  Enclosure a = EnclosureInside::of(half), b;
  b = a;
  a += a;
  EXPECT_EQ(b.lower(), 0.5);
  EXPECT_EQ(a.lower(), 1.0);
  a = Enclosure();
  EXPECT_EQ(a.upper(), 0.0);
  a = b;
  EXPECT_EQ(a.lower(), 0.5);
}

}  // namespace
}  // namespace exactff
