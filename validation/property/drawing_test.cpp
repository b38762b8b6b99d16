// A drawing shows the exact geometry, rounded to doubles. Checked on scenes of every random family.
// EXACTFF_TEST_SCALE multiplies the number of views.
#include <gmpxx.h>

#include "report/report.h"
#include "support/oracle_check.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

// Loops, projected along the axis of the normal's largest component, in rational numbers.
class Projection {
 public:
  explicit Projection(const Vec3& normal) {
    const double components[] = {normal.x, normal.y, normal.z};
    for (int axis = 1; axis < 3; ++axis) {
      if (std::abs(components[axis]) > std::abs(components[axis_])) axis_ = axis;
    }
    sign_ = components[axis_] < 0.0 ? -1 : 1;
  }

  // Twice the area; positive if the loop runs counter-clockwise as seen from x.
  [[nodiscard]] mpq_class doubled_area(const Loop& loop) const {
    mpq_class sum = 0;
    for (std::size_t i = 0; i < loop.corners.size(); ++i) {
      const Vec3 &a = loop.corners[i], &b = loop.corners[(i + 1) % loop.corners.size()];
      sum += u(a) * v(b) - v(a) * u(b);
    }
    return sum * sign_;
  }

  // By how much rounding its corners, and those of its neighbours, can have changed that.
  [[nodiscard]] mpq_class blur(const Loop& loop) const {
    mpq_class low_u, high_u, low_v, high_v, most;
    for (std::size_t i = 0; i < loop.corners.size(); ++i) {
      const mpq_class p = u(loop.corners[i]), q = v(loop.corners[i]);
      low_u = i == 0 ? p : std::min(low_u, p);
      high_u = i == 0 ? p : std::max(high_u, p);
      low_v = i == 0 ? q : std::min(low_v, q);
      high_v = i == 0 ? q : std::max(high_v, q);
      most = std::max({most, mpq_class(abs(p)), mpq_class(abs(q))});
    }
    const mpq_class error = most * 0x1p-53 + std::numeric_limits<double>::denorm_min();
    return 2 * static_cast<double>(loop.corners.size()) * error * ((high_u - low_u) + (high_v - low_v) + 2 * error);
  }

 private:
  [[nodiscard]] double component(const Vec3& p, int axis) const { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }
  [[nodiscard]] mpq_class u(const Vec3& p) const { return component(p, (axis_ + 1) % 3); }
  [[nodiscard]] mpq_class v(const Vec3& p) const { return component(p, (axis_ + 2) % 3); }

  int axis_ = 0;
  int sign_ = 1;
};

// Twice an area, known up to an error.
struct Area {
  mpq_class doubled = 0;
  mpq_class blur = 0;

  [[nodiscard]] bool may_be(const Area& other) const { return abs(doubled - other.doubled) <= blur + other.blur; }
  [[nodiscard]] bool may_be_at_most(const Area& other) const { return doubled - other.doubled <= blur + other.blur; }
};

Area area_of(const Projection& projection, const std::vector<Loop>& loops) {
  Area sum;
  for (const Loop& loop : loops) {
    sum.doubled += projection.doubled_area(loop);
    sum.blur += projection.blur(loop);
  }
  return sum;
}

bool is_finite(const Vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

void expect_sound(const Projection& projection, const Loop& loop) {
  EXPECT_GE(loop.corners.size(), 3U);
  EXPECT_TRUE(std::ranges::all_of(loop.corners, is_finite));
  const mpq_class turned = loop.hole ? mpq_class(-projection.doubled_area(loop)) : projection.doubled_area(loop);
  EXPECT_GE(turned, -projection.blur(loop)) << (loop.hole ? "hole" : "loop") << " runs the wrong way round";
}

// Faces in one plane may overlap; then the pieces of the source have more area than their union.
void expect_drawn_as_found(const PlaneDrawing& drawing, const PlaneRecord& record) {
  const Projection projection(drawing.normal);
  EXPECT_TRUE(is_finite(drawing.normal));
  for (const std::vector<Loop>* loops : {&drawing.source, &drawing.clipped_source, &drawing.visible}) {
    for (const Loop& loop : *loops) expect_sound(projection, loop);
  }
  const Area clipped = area_of(projection, drawing.clipped_source), visible = area_of(projection, drawing.visible);
  EXPECT_TRUE(visible.may_be_at_most(clipped));
  EXPECT_EQ(drawing.visible.empty(), *record.visible_fraction == 0.0 && mpq_class(*record.exact_fraction) == 0);
  const bool one_hull = drawing.clipped_source.size() == 1;
  for (const PlaneDrawing::Shadow& shadow : drawing.shadows) {
    expect_sound(projection, shadow.outline);
    EXPECT_TRUE(!one_hull || area_of(projection, {shadow.outline}).may_be_at_most(clipped));
  }
  if (record.outcome == Outcome::kHiddenByOne && one_hull) {
    ASSERT_FALSE(drawing.shadows.empty());
    EXPECT_TRUE(area_of(projection, {drawing.shadows.back().outline}).may_be(clipped)) << "the lid is drawn elsewhere";
  }
  if (record.faces.size() > 1 || drawing.source.empty()) return;
  Area wanted = area_of(projection, drawing.source);
  wanted.doubled *= mpq_class(*record.exact_fraction);
  EXPECT_TRUE(visible.may_be(wanted)) << visible.doubled.get_d() << " instead of " << wanted.doubled.get_d();
}

void expect_drawn_as_found(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  const Receiver receiver = receiver_in(scene, plain);
  const ExactSource source(scene, scene.select(plain.source));
  const FormFactor found = exact_form_factor(scene, receiver, source, {.exact_fraction = true});
  const std::vector<PlaneDrawing> drawings = draw_visibility(scene, receiver, source);
  ASSERT_EQ(drawings.size(), found.planes.size());
  for (std::size_t p = 0; p < drawings.size(); ++p) expect_drawn_as_found(drawings[p], found.planes[p]);
  const std::string svg = report::visibility_svg(scene, receiver, source, found);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  AdaptiveResult sampled;
  sampled.leaves = 3;
  EXPECT_NE(report::visibility_svg(scene, receiver, source, found, &sampled).find(">3 leaves not drawn (too small)<"),
            std::string::npos);
}

class Drawing : public testing::TestWithParam<RandomFamily> {};

TEST_P(Drawing, IsWhatWasFound) {
  for (std::uint64_t i = 0; i < scaled_count(GetParam().count / 3 + 1); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    expect_drawn_as_found(GetParam().make(random));
    if (HasFailure()) return;
  }
}

INSTANTIATE_TEST_SUITE_P(RandomScenes, Drawing, testing::ValuesIn(random_families()),
                         [](const auto& family) { return family.param.name; });

// Enlarges one face of the scene about one of its points until it hides everything at a short distance.
TEST(HiddenByOne, IsDrawnAsTheWholeSource) {
  int lids = 0;
  for (std::uint64_t i = 0; i < scaled_count(300); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed_of(i)));
    Random random(seed_of(i));
    PlainScene plain = random.one_in(2) ? degenerate_scene(random) : generic_scene(random);
    const Vec3 x = plain.point, n = plain.normal;
    const double a = random.between(-1.0, 1.0), b = random.between(-1.0, 1.0), size = 64.0;
    const auto lid_corner = [&](double p, double q) {
      const double tilt = a * p + b * q;  // corners may lie behind x, in its horizon, or far in front
      return Vec3{x.x + p + 0.125 * n.x * (1.0 + tilt), x.y + q + 0.125 * n.y * (1.0 + tilt),
                  x.z + 0.125 * n.z * (1.0 + tilt)};
    };
    plain.add_ring(plain.patch("lid"), {lid_corner(-size, -size), lid_corner(size, -size), lid_corner(size, size)});
    plain.add_ring(plain.patch("lid"), {lid_corner(-size, -size), lid_corner(size, size), lid_corner(-size, size)});
    const Scene scene = generate::build(plain);
    const ExactSource source(scene, scene.select(plain.source));
    for (const PlaneRecord& record : exact_form_factor(scene, generate::receiver_of(plain), source).planes) {
      lids += record.outcome == Outcome::kHiddenByOne ? 1 : 0;
    }
    expect_drawn_as_found(plain);
    if (HasFailure()) return;
  }
  EXPECT_GT(lids, 20);
}

// A sheet of 4 x 4 squares in triangles: its border is drawn as silhouettes, its inner edges are not.
TEST(DrawingOfAMesh, ShowsItsSilhouettes) {
  constexpr int kSide = 4;
  PlainScene plain;
  plain.normal = {0, 0, 1};
  plain.source = "light";
  plain.add_ring(plain.patch("light"), {{-4, 4, 2}, {4, 4, 2}, {4, -4, 2}, {-4, -4, 2}});
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Vec3 a{i - 2.0, j - 2.0, 1}, b{i - 1.0, j - 2.0, 1}, c{i - 1.0, j - 1.0, 1}, d{i - 2.0, j - 1.0, 1};
      plain.add_ring(plain.patch("sheet"), {a, b, c});
      plain.add_ring(plain.patch("sheet"), {a, c, d});
    }
  }
  const Scene scene = generate::build(plain);
  const Receiver receiver = generate::receiver_of(plain);
  const ExactSource source(scene, scene.select("light"));
  const std::string svg = report::visibility_svg(scene, receiver, source, exact_form_factor(scene, receiver, source));
  const std::size_t path = svg.find("stroke-linecap=\"round\"");  // the first is that of the panel
  ASSERT_NE(path, std::string::npos);
  const std::size_t begin = svg.rfind("<path", path);
  EXPECT_EQ(std::count(svg.begin() + static_cast<std::ptrdiff_t>(begin),
                       svg.begin() + static_cast<std::ptrdiff_t>(path), 'M'),
            4 * kSide);
  EXPECT_NE(svg.find("silhouette, where faces do not continue one another"), std::string::npos);
}

}  // namespace
}  // namespace exactff::validation
