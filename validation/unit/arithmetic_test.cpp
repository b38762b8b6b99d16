// What is read, made and computed exactly does not depend on the arithmetic that the calling thread has set, and leaves
// that as it was. EXACTFF_TEST_SCALE multiplies the number of scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <tuple>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "exactff/exact.h"
#include "exactff/methods.h"
#include "exactff/models.h"
#include "exactff/obj.h"
#include "exactff/receiver.h"
#include "generate/plain_scene.h"
#include "generate/random.h"
#include "support/program.h"
#include "support/random_scenes.h"

namespace exactff {
namespace {

using generate::PlainScene;
using generate::Random;

struct Setting {
  const char* name;
  void (*set)();
};
std::vector<Setting> other_settings() {
  std::vector<Setting> settings = {{"upward", [] { std::fesetround(FE_UPWARD); }},
                                   {"downward", [] { std::fesetround(FE_DOWNWARD); }},
                                   {"toward zero", [] { std::fesetround(FE_TOWARDZERO); }}};
#ifdef __SSE2__
  settings.push_back({"flush to zero", [] { _mm_setcsr(_mm_getcsr() | 0x8000U); }});
  settings.push_back({"denormals are zero", [] { _mm_setcsr(_mm_getcsr() | 0x0040U); }});
#endif
  return settings;
}

// How it rounds, and whether it makes small numbers zero or takes them for zero.
std::tuple<int, bool, bool> arithmetic_of_thread() {
  const volatile double least_normal = 0x1p-1022, half = 0.5, denormal = 0x1p-1023, twice = 2.0;
  return {std::fegetround(), least_normal * half == 0.0, denormal * twice == 0.0};
}

// Numbers by their bits: printing them as decimals rounds.
class Record {
 public:
  void add(double number) { text_ << std::hex << std::bit_cast<std::uint64_t>(number) << ' '; }
  void add(const Vec3& v) {
    for (const double number : {v.x, v.y, v.z}) add(number);
  }
  void add(const std::vector<Receiver>& receivers) {
    for (const Receiver& receiver : receivers) add(receiver.point);
  }
  void add(const Scene& scene) {
    for (const Vec3& vertex : scene.vertices()) add(vertex);
    text_ << scene.pieces().size() << ' ';
  }
  void add(const FormFactor& f) {
    for (const double number : {f.value, f.lower, f.upper, f.visible_fraction.value_or(-1.0)}) add(number);
    text_ << to_string(f.status) << ' ' << f.enclosure.midpoint() << ' ' << f.enclosure.radius() << ' ';
    for (const PlaneRecord& plane : f.planes) text_ << to_string(plane.outcome) << ' ' << plane.edges << ' ';
  }
  void add(const std::vector<PlaneDrawing>& drawings) {
    for (const PlaneDrawing& drawing : drawings) {
      for (const Loop& loop : drawing.visible) {
        for (const Vec3& corner : loop.corners) add(corner);
      }
    }
  }
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
};

struct Task {
  PlainScene plain;
  std::string obj;
  std::filesystem::path receivers;  // a table
};

void add_scene(const Scene& scene, const Task& task, Record& record) {
  record.add(scene);
  const Selection selection = scene.select(task.plain.source);
  const std::vector<FaceId> faces = scene.faces_of(selection);
  record.add(grid_receivers(scene, selection, {3, 3}));
  record.add(vertex_receivers(scene, faces));
  record.add(centre_receivers(scene, faces));
  const bool has_area =
      std::any_of(faces.begin(), faces.end(), [&](FaceId face) { return scene.face(face).piece_count > 0; });
  if (has_area) record.add(sample_receivers(scene, faces, 5, 1));
  record.add(read_receivers(task.receivers, scene));
  const ExactSource source(scene, selection);
  const Receiver receiver = generate::receiver_of(task.plain);
  record.add(exact_form_factor(scene, receiver, source, {.visible_fraction = true}));
  record.add(draw_visibility(scene, receiver, source));
}

std::string all_of(const Task& task) {
  Record record;
  std::istringstream text(task.obj);
  add_scene(read_obj(text, "scene.obj"), task, record);
  add_scene(generate::build(task.plain), task, record);
  record.add(models::make_scene("karkanis:n=5,seed=3"));
  return record.text();
}

// Under every other setting as under the usual one.
template <class Call>
void expect_the_same(const Call& call) {
  const std::string expected = call();
  for (const Setting& setting : other_settings()) {
    std::fenv_t standard;
    std::fegetenv(&standard);
    const auto usual = arithmetic_of_thread();
    setting.set();
    const auto before = arithmetic_of_thread();
    const std::string found = call();
    const auto after = arithmetic_of_thread();
    std::fesetenv(&standard);
    EXPECT_EQ(found, expected) << setting.name;
    EXPECT_NE(before, usual) << setting.name;
    EXPECT_EQ(before, after) << setting.name;
  }
}

TEST(ThreadsArithmetic, ChangesNoSceneAndNoExactValue) {
  const validation::TemporaryDirectory directory;
  const auto receivers =
      directory.write("receivers.csv", "id,x,y,z,nx,ny,nz\na,0.7,0.3,1e-310,0.1,0.2,0.3\nb,-0,0.1,2,0,0,1\n");
  for (std::uint64_t i = 0; i < validation::scaled_count(100); ++i) {
    SCOPED_TRACE("seed " + std::to_string(validation::seed_of(i)));
    Random random(validation::seed_of(i));
    Task task{i % 2 == 0 ? validation::nudged_scene(random) : validation::generic_scene(random), {}, receivers};
    generate::scale(task.plain, std::ldexp(1.0, -1050 + 2 * static_cast<int>(i)));
    task.obj = generate::to_obj(task.plain, {}, generate::Digits::kSeventeen);
    expect_the_same([&] { return all_of(task); });
  }
}

// The control asks for exact visibilities in the middle of sampling.
TEST(ThreadsArithmetic, ChangesNoExactVisibility) {
  Random random(1);
  PlainScene plain = validation::generic_scene(random);
  const Scene scene = generate::build(plain);
  const methods::Choice choice = methods::parse("adaptive-exact-visibility");
  const auto prepared = choice.method->prepare(scene);
  const auto source = prepared->prepare_source(scene.select(plain.source));
  const auto evaluator = prepared->configure(choice.settings);
  expect_the_same([&] {
    Record record;
    record.add(evaluator->form_factor(generate::receiver_of(plain), *source).form_factor);
    return record.text();
  });
}

}  // namespace
}  // namespace exactff
