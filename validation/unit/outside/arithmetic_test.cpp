// Results that are promised to depend only on the arguments do not depend on the floating-point settings of the calling
// thread, and do not change them. The test calls every public function that computes, in every rounding mode, with
// denormal numbers flushed to zero or read as zero, and with floating-point traps. EXACTFF_TEST_SCALE multiplies the
// number of scenes.
#include <cfenv>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include "support/test.h"
#include "unit/reports/study_support.h"

namespace exactff {
namespace {

struct Setting {
  const char* name;
  std::function<void()> set;
};

// Everything at once, in each rounding mode.
std::vector<Setting> all_settings() {
  std::vector<Setting> settings;
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    settings.push_back({"all at once", [rounding] {
#ifdef __SSE2__
                          _mm_setcsr(_mm_getcsr() | 0x8040U);
#endif
                          std::fesetround(rounding);
#ifdef __GLIBC__
                          feenableexcept(FE_ALL_EXCEPT);
#endif
                        }});
  }
  return settings;
}

// The rounding mode, the traps, and whether denormal numbers are flushed to zero or read as zero.
std::tuple<int, int, unsigned> arithmetic_of_thread() {
  int traps = 0;
  unsigned flushes = 0;
#ifdef __GLIBC__
  traps = fegetexcept();
#endif
#ifdef __SSE2__
  flushes = _mm_getcsr() & 0x8040U;
#endif
  return {std::fegetround(), traps, flushes};
}

// Numbers by their bits: printing them as decimals rounds.
class Record {
 public:
  void add(double number) { text_ << std::hex << std::bit_cast<std::uint64_t>(number) << ' '; }
  void add(const Vec3& v) {
    for (const double number : {v.x, v.y, v.z}) add(number);
  }
  void add(const std::string& text) { text_ << text << ' '; }
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
  void add(const ViewFactor& f) {
    for (const double number : {f.value, f.lower, f.upper, f.area_from, f.area_to}) add(number);
  }
  void add(const std::vector<PlaneDrawing>& drawings) {
    for (const PlaneDrawing& drawing : drawings) {
      for (const Loop& loop : drawing.visible) {
        for (const Vec3& corner : loop.corners) add(corner);
      }
    }
  }
  void add(const WholeView& seen) {
    const auto share = [&](const ViewShare& of) {
      for (const double number : {of.value, of.lower, of.upper}) add(number);
      text_ << to_string(of.status) << ' ' << of.enclosure.midpoint() << ' ' << of.enclosure.radius() << ' ';
    };
    for (const SeenPatch& patch : seen.patches) {
      share(patch.share);
      share(patch.form_factor);
    }
    share(seen.back);
    share(seen.open);
    for (const ViewArc& arc : seen.arcs) {
      add(arc.from);
      add(arc.to);
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

// Or the words of the refusal: in very small scenes, no double holds the areas.
void add_view_factor(const Scene& scene, const Selection& from, const Selection& to, Record& record) {
  try {
    record.add(view_factor(scene, from, to, {0.1, 20}));
  } catch (const InputError& error) {
    record.add(std::string(error.what()));
  }
}

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
  record.add(view(scene, receiver, {.arcs = true}));
  if (has_area) add_view_factor(scene, scene.select(scene.patches().back().name), selection, record);
}

std::string all_of(const Task& task) {
  Record record;
  std::istringstream text(task.obj);
  add_scene(read_obj(text, "scene.obj"), task, record);
  add_scene(generate::build(task.plain), task, record);
  record.add(models::make_scene("karkanis:n=5,seed=3"));
  return record.text();
}

using Call = std::function<std::string()>;

// Under each setting, the call must give the same text as under the default setting. Files are read afterwards, and
// their names are made before, because the standard library also computes under the traps.
void expect_the_same(
    const Call& call, const Call& read = [] { return std::string(); }) {
  std::string expected = call();
  expected += read();
  EXPECT_NE(expected, "");
  for (const Setting& setting : all_settings()) {
    std::fenv_t standard;
    std::fegetenv(&standard);
    const auto usual = arithmetic_of_thread();
    std::feclearexcept(FE_ALL_EXCEPT);  // a flag that is already raised would trap at once
    setting.set();
    const auto before = arithmetic_of_thread();
    std::string found = call();
    const auto after = arithmetic_of_thread();
    std::fesetenv(&standard);
    found += read();
    EXPECT_EQ(found, expected) << setting.name;
    EXPECT_NE(before, usual) << setting.name;
    EXPECT_EQ(before, after) << setting.name;
  }
}

TEST(ThreadsArithmetic, ChangesNoSceneAndNoExactValue) {
  const TemporaryDirectory directory;
  const auto receivers =
      directory.write("receivers.csv", "id,x,y,z,nx,ny,nz\na,0.7,0.3,1e-310,0.1,0.2,0.3\nb,-0,0.1,2,0,0,1\n");
  for (std::uint64_t i = 0; i < validation::scaled_count(50); ++i) {
    SCOPED_TRACE("seed " + std::to_string(validation::seed_of(i)));
    Random random(validation::seed_of(i));
    Task task{i % 2 == 0 ? validation::nudged_scene(random) : validation::generic_scene(random), {}, receivers};
    generate::scale(task.plain, std::ldexp(1.0, -1050 + 4 * static_cast<int>(i)));
    task.obj = generate::to_obj(task.plain, {}, generate::Digits::kSeventeen);
    expect_the_same([&] { return all_of(task); });
  }
}

// A lamp that emits the smallest double, which reads as zero under some settings.
TEST(ThreadsArithmetic, ChangesNothingThatASceneSaysOfItself) {
  expect_the_same([] {
    SceneBuilder builder;
    const MaterialId faint = builder.add_material({"faint", {0.5, 0.5, 0.5}, {0x1p-1074, 0.0, 0.0}});
    for (const Vec3& corner : {Vec3{0, 0, 0x1p-1074}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 0}}) {
      builder.add_vertex(corner);
    }
    builder.add_face(builder.patch("lamp"), faint, {{0, 1, 2}});
    builder.add_face(builder.patch("other"), faint, {{1, 3, 2}});
    const Scene scene = builder.build();
    Record record;
    record.add(scene);
    record.add(scene.with_flipped(scene.select("lamp")));
    record.add(scene.source_radiosity(scene.select("lamp")).r);
    record.add(total_area(summarise(scene)));
    return record.text() + std::to_string(scene.emitters().size()) + ' ' + std::to_string(scene.open_edge_count());
  });
}

TEST(ThreadsArithmetic, ChangesNoViewFactor) {
  const Scene room = small_room(true);
  expect_the_same([&] {
    Record record;
    for (const Patch& from : room.patches()) add_view_factor(room, room.select(from.name), room.select("lamp"), record);
    return record.text();
  });
}

TEST(ThreadsArithmetic, ChangesNoEnclosure) {
  const Scene scene = small_room(true);
  const ExactSource lamp(scene, scene.select("lamp"));
  const Receiver receiver{.point = {0.25, 0.1, 0.0}, .normal = {0, 0, 0x1p-1060}, .on = {}, .id = {}};
  const FormFactor f = exact_form_factor(scene, receiver, lamp);
  const FormFactor tiny =
      exact_form_factor(scene, {.point = {0x1p+343, 0, 1.5}, .normal = {-1, 0, 0}, .on = {}, .id = {}}, lamp);
  ASSERT_GT(tiny.value, 0.0);
  ASSERT_LT(tiny.value, 0x1p-1022);
  expect_the_same([&] {
    Record record;
    for (const FormFactor* one : {&f, &tiny}) {
      const Enclosure& e = one->enclosure;
      for (const double number : {e.lower(), e.upper(), e.nearest().value_or(-1.0)}) record.add(number);
      record.add(e.contains(one->value) ? 1.0 : 0.0);
      record.add(e.contains(one->upper) ? 1.0 : 0.0);
      Enclosure sum = e;
      sum += e;
      record.add(sum.lower());
      record.add(e.decimals(12).value_or("none") + ' ' + sum.midpoint() + ' ' + sum.radius() + ' ');
    }
    return record.text();
  });
}

// Every method, prepared and configured again each time.
TEST(ThreadsArithmetic, ChangesNoMethodsValue) {
  Random random(1);
  PlainScene plain = validation::generic_scene(random);
  const Scene scene = generate::build(plain);
  const Receiver receiver = generate::receiver_of(plain);
  Words texts = {"adaptive:variant=literal", "hemicube:rotation=30,resolution=20", "nettle:variant=literal",
                 "area-sampling:pattern=sobol", "wallace:pattern=jittered,splits=3"};
  for (const methods::Method* method : methods::all_methods()) texts.push_back(method->name);
  for (const std::string& text : texts) {
    SCOPED_TRACE(text);
    expect_the_same([&] {
      const methods::Choice choice = methods::parse(text);
      const auto prepared = choice.method->prepare(scene);
      const auto source = prepared->prepare_source(scene.select(plain.source));
      const auto evaluator = prepared->configure(choice.settings);
      Record record;
      record.add(evaluator->form_factor(receiver, *source).form_factor);
      return record.text() + choice.text() + methods::description(*choice.method);
    });
  }
  expect_the_same([&] {
    const AdaptiveSolver solver(scene);
    Record record;
    record.add(solver.form_factor(receiver, scene.select(plain.source), 1.0, {.eps_b = 1e-3}).form_factor);
    record.add(study::parse_ladder("hemicube:rotation=0.1,resolution=10|20").name);
    return record.text();
  });
}

TEST(ThreadsArithmetic, ChangesNoTruthFile) {
  const TemporaryDirectory directory;
  const Scene scene = small_room(true);
  const auto file = [&](const char* name) { return directory.path() / name; };
  const std::filesystem::path whole = file("truth.csv"), merged = file("merged.csv");
  const std::vector<std::filesystem::path> parts = {file("1.csv"), file("2.csv")};
  truth::Request request;
  request.scene = &scene;
  request.scene_name = "room";
  request.receivers = grid_receivers(scene, scene.select("floor"), {9, 9});
  request.unoccluded = request.visible_fraction = true;
  request.total = Quantity::kRadiance;
  request.threads = 2;
  const auto write = [&] {
    truth::write(request, whole, jobs::Existing::kReplace);
    for (std::size_t part = 0; part < 2; ++part) {
      truth::Request shard = request;
      shard.shard = {part + 1, 2};
      truth::write(shard, parts[part], jobs::Existing::kReplace);
    }
    truth::merge(parts, merged, jobs::Existing::kReplace);
    return std::string();
  };
  expect_the_same(write, [&] { return text_of(whole) + text_of(merged); });
}

// Points are read from an image, placed on their faces, valued, and the values are written and compared.
TEST(ThreadsArithmetic, ChangesNoImage) {
  const TemporaryDirectory directory;
  const Scene scene = small_room(true);
  exr::Image image{{0, 0, 2, 1}, {0, 0, 2, 1}, {}, {}};
  for (const auto& [name, value] :
       {std::pair{"P.X", 0.3F}, {"P.Y", 0.1F}, {"P.Z", 1e-40F}, {"N.X", 1e-42F}, {"N.Y", 0.0F}, {"N.Z", 0.7F}}) {
    image.channels.push_back({name, exr::Kind::kFloat, std::vector(2, std::bit_cast<std::uint32_t>(value))});
  }
  const std::filesystem::path points = directory.write("points.exr", exr::exr_of(image)),
                              table = directory.path() / "truth.csv", values = directory.path() / "truth.exr";
  truth::Request request;
  request.scene = &scene;
  request.scene_name = "room";
  request.total = Quantity::kRadiance;
  request.threads = 1;
  const auto write = [&] {
    exr::GBuffer gbuffer = exr::read_gbuffer(exr::ExrFile(points));
    exr::place_on_faces(scene, gbuffer);
    request.receivers = std::move(gbuffer.receivers);
    truth::write(request, table, jobs::Existing::kReplace);
    truth::write_exr(gbuffer.frame, table, values);
    const check::Report report = check::compare(values, values, {.criteria = {.relative_mse = 1.0}});
    return exr::exr_of(image) + check::failure_message(report);
  };
  expect_the_same(write, [&] { return text_of(table) + text_of(values); });
}

TEST(ThreadsArithmetic, ChangesNoCheck) {
  const TemporaryDirectory directory;
  const auto truth_file = directory.write(
      "truth.csv",
      "receiver,x,y,z,nx,ny,nz,exact,largest_rho_b\na,0.1,1e-310,0,0,0,1,0.3,2\nb,0.7,0,0,0,0,1,1e-320,1\n");
  const auto mine = directory.write("mine.csv", "x,y,z,value\n0.1,0,0,0.31\n0.7,1e-9,0,3e-320\n");
  const auto judged = [&] {
    const check::Truth truth = check::read_truth(truth_file);
    const check::Candidate candidate = check::read_candidate(mine, truth, {}, check::MatchBy::kPosition);
    const auto matched = check::match(truth, candidate, {.by = check::MatchBy::kPosition, .tolerance = 1e-8});
    return check::judge(truth, matched, {.max_abs = 1e-3, .rms = 1e-3, .eps_b = 1e-3});
  };
  expect_the_same([&] {
    std::string text = check::failure_message(judged());
    Record record;
    record.add(check::difference(0.1, 0.3).relative);
    record.add(check::digits_of(0.3));
    text += check::is_near(0.3, 0.1, check::relative(2.0)) ? "near" : "far";
    return text + check::describe_difference(0.1, 0.3, {1e-3, 1e-3}) + record.text();
  });
}

TEST(ThreadsArithmetic, ChangesNoStudy) {
  const TemporaryDirectory directory;
  const EnvironmentVariable nowhere("PATH", "");
  const Scene scene = small_room(true);
  const study::Request request = request_with_methods(scene, 2);
  const std::filesystem::path study_folder = directory.path() / "study";
  const auto write = [&] {
    const study::Study study = study::run(request);
    study::write_report(study, study_folder);
    return std::string();
  };
  expect_the_same(write, [&] {
    std::string text;
    for (const char* file : {"values.csv", "methods.csv", "exact.csv", "summary.csv", "profile.csv"}) {
      text += text_of(study_folder / file);
    }
    return text;
  });
}

}  // namespace
}  // namespace exactff
