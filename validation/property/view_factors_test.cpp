// View factors from patch to patch on random scenes of every family and in closed rooms, judged by means of exact point
// factors at random points, by the other direction, and by row sums.
#include "kernel/numbers.h"
#include "property/closed_rooms.h"
#include "support/test.h"

namespace exactff::validation {
namespace {

Selection patch_of(const Scene& scene, std::size_t index) { return {static_cast<PatchId>(index), {}, scene.id()}; }

constexpr double kRoundings = 1.0 + 0x1p-30;  // of areas, which may be denormal

struct Mean {
  double value = 0.0;
  double standard_error = 0.0;
};

// Of point factors at independent points.
Mean mean_of_points(const Scene& scene, const Selection& from, const Selection& to, std::uint64_t count,
                    std::uint64_t seed) {
  const ExactSource source(scene, to);
  double sum = 0.0, squares = 0.0;
  for (const Receiver& receiver : sample_receivers(scene, scene.faces_of(from), count, seed)) {
    const double value = exact_form_factor(scene, receiver, source).value;
    sum += value;
    squares += value * value;
  }
  const auto n = static_cast<double>(count);
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0))};
}

bool has_area(const Scene& scene, const Selection& patch) { return !scene.faces_of(patch).empty(); }

// Coplanar faces that overlap would weigh twice in the sample.
bool has_one_face(const Scene& scene, const Selection& patch) { return scene.faces_of(patch).size() == 1; }

// Nothing where the area of a patch is no double beside the rest of the scene.
std::optional<ViewFactor> factor_of(const Scene& scene, const Selection& from, const Selection& to,
                                    const ViewFactorOptions& options) {
  try {
    return view_factor(scene, from, to, options);
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("has no area"), std::string::npos) << error.what();
    return std::nullopt;
  }
}

class RandomFamilies : public testing::TestWithParam<std::size_t> {};

// Families on the edge of rounding are judged by the other direction alone: their rounded points see other things.
void expect_both_directions_to_agree(const RandomFamily& family, const ViewFactorOptions& options) {
  for (std::uint64_t s = 0; s < scaled_count(3); ++s) {
    Random random(seed_of(s));
    const Scene scene = generate::build(family.make(random));
    for (int pair = 0; pair < 2; ++pair) {
      const Selection from = patch_of(scene, random.below(scene.patches().size()));
      const Selection to = pair == 0 ? scene.select("source") : patch_of(scene, random.below(scene.patches().size()));
      if (!has_area(scene, from) || !has_area(scene, to)) continue;
      const std::optional<ViewFactor> found = factor_of(scene, from, to, options);
      if (!found) continue;
      const ViewFactor& forth = *found;
      EXPECT_LE(0.0, forth.lower);
      EXPECT_LE(forth.lower, forth.value);
      EXPECT_LE(forth.value, forth.upper);
      EXPECT_LE(forth.upper, 1.0);
      EXPECT_EQ(forth.claim == Claim::kZero, forth.upper == 0.0);
      EXPECT_EQ(forth.claim == Claim::kCertified, options.certify && forth.claim != Claim::kZero);
      const ViewFactor back = view_factor(scene, to, from, options);
      const double ratio = back.area_from / forth.area_from;  // F_ij = F_ji A_j / A_i
      if (!(ratio > 0x1p-300 && ratio < 0x1p300)) continue;
      EXPECT_LE(back.lower * ratio, forth.upper * kRoundings)
          << family.name << ' ' << s << ' ' << scene.name_of(from) << " -> " << scene.name_of(to);
      EXPECT_LE(forth.lower, back.upper * ratio * kRoundings)
          << family.name << ' ' << s << ' ' << scene.name_of(from) << " -> " << scene.name_of(to);
    }
  }
}

TEST_P(RandomFamilies, ViewFactorsAgreeWithTheOtherDirection) {
  expect_both_directions_to_agree(random_families()[GetParam()],
                                  {.accuracy = 1e-2, .budget = 200, .sample_crowds = false, .both_directions = true});
}
TEST_P(RandomFamilies, CertifiedViewFactorsAgreeWithTheOtherDirection) {
  expect_both_directions_to_agree(random_families()[GetParam()],
                                  {.accuracy = 1e-2, .budget = 200, .both_directions = true, .certify = true});
}

INSTANTIATE_TEST_SUITE_P(All, RandomFamilies, testing::Range(std::size_t{0}, random_families().size()),
                         [](const auto& param) { return std::string(random_families()[param.param].name); });

// Calls judge(number, scene, from, to) for a random patch and the source of random scenes, if both have an area.
template <class Judge>
void for_each_random_pair(std::uint64_t count, const Judge& judge) {
  for (std::uint64_t s = 0; s < scaled_count(count); ++s) {
    Random random(seed_of(s));
    const Scene scene = generate::build(s % 2 == 0 ? degenerate_scene(random) : generic_scene(random));
    const Selection to = scene.select("source");
    const Selection from = patch_of(scene, random.below(scene.patches().size()));
    if (has_area(scene, from) && has_area(scene, to)) judge(s, scene, from, to);
  }
}

void expect_means_of_point_factors(const ViewFactorOptions& options) {
  std::size_t judged = 0;
  for_each_random_pair(60, [&](std::uint64_t s, const Scene& scene, const Selection& from, const Selection& to) {
    if (!has_one_face(scene, from)) return;  // else overlapping faces weigh twice
    const ViewFactor f = view_factor(scene, from, to, options);
    const Mean mean = mean_of_points(scene, from, to, 512, s);
    EXPECT_LE(f.lower - 5.0 * mean.standard_error - 1e-9, mean.value) << s << ' ' << scene.name_of(from);
    EXPECT_GE(f.upper + 5.0 * mean.standard_error + 1e-9, mean.value) << s << ' ' << scene.name_of(from);
    judged += f.value > 0.0 ? 1 : 0;
  });
  EXPECT_GE(judged, 5U);
}

TEST(ViewFactors, AgreeWithMeansOfPointFactors) {
  expect_means_of_point_factors({.accuracy = 1e-3, .budget = 2000, .sample_crowds = false});
}
TEST(ViewFactors, CertifiedAgreeWithMeansOfPointFactors) {
  expect_means_of_point_factors({.accuracy = 1e-3, .budget = 2000, .certify = true});
}

// The estimated interval at a far smaller accuracy lies inside the certified one, or meets it where it is wide.
TEST(ViewFactors, CertifiedHoldBetterEstimates) {
  std::size_t judged = 0;
  for_each_random_pair(30, [&](std::uint64_t s, const Scene& scene, const Selection& from, const Selection& to) {
    const ViewFactor close = view_factor(scene, from, to, {.accuracy = 1e-7, .budget = 3000, .sample_crowds = false});
    for (const double accuracy : {1e-2, 1e-4, 1e-6}) {
      const ViewFactor f = view_factor(scene, from, to, {.accuracy = accuracy, .budget = 1000, .certify = true});
      EXPECT_LE(f.lower, close.upper) << s << ' ' << scene.name_of(from) << ' ' << accuracy;
      EXPECT_GE(f.upper, close.lower) << s << ' ' << scene.name_of(from) << ' ' << accuracy;
      EXPECT_EQ(f.claim == Claim::kZero, close.claim == Claim::kZero);
      judged += f.accurate && f.value > 0.0 ? 1 : 0;
    }
  });
  EXPECT_GE(judged, 5U);
}

// At the same limit of cells and points, whether or not they suffice. The largest one allows pauses and several looks.
TEST(ViewFactors, ASmallerAccuracyNeverWidensThem) {
  constexpr std::array<std::size_t, 4> kBudgets{40, 400, 400, 3000};
  std::size_t limited = 0, by_points = 0;
  for_each_random_pair(30, [&](std::uint64_t s, const Scene& scene, const Selection& from, const Selection& to) {
    for (const bool certify : {false, true}) {
      double width = 1.0;
      for (const double accuracy : {0.3, 2e-2, 1.5e-2, 1e-3, 7e-5, 6e-5, 1e-8}) {
        const ViewFactor f =
            view_factor(scene, from, to, {.accuracy = accuracy, .budget = kBudgets[s % 4], .certify = certify});
        EXPECT_LE(f.upper - f.lower, width) << s << ' ' << scene.name_of(from) << ' ' << accuracy;
        width = f.upper - f.lower;
        limited += f.accurate ? 0 : 1;
        by_points += f.way == Way::kPoints ? 1 : 0;
      }
    }
  });
  EXPECT_GE(limited, 5U);
  EXPECT_GE(by_points, 5U);
}

// A square with slivers close above it, one of which may be turned round, and perhaps a wall.
generate::PlainScene slivers(Random& random) {
  generate::PlainScene plain;
  const auto add = [&](const std::string& name, const std::vector<Vec3>& corners) {
    generate::Ring ring;
    for (const Vec3& corner : corners) {
      ring.push_back(static_cast<std::uint32_t>(plain.vertices.size()));
      plain.vertices.push_back(corner);
    }
    plain.patch(name).faces.push_back({{ring}});
  };
  const auto small = [&](int most) { return std::pow(10.0, -most * random.unit()); };
  add("source", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  for (std::uint64_t k = 0, count = 1 + random.below(3); k < count; ++k) {
    const double x = random.unit(), y = 0.5 * random.unit(), z = small(8), width = small(8), length = 0.5 * small(3);
    std::vector<Vec3> corners{{x, y, z}, {x, y + length, z}, {x + width, y, z + (random.one_in(2) ? width : 0.0)}};
    if (random.one_in(4)) std::ranges::reverse(corners);
    add("sliver" + std::to_string(k), corners);
  }
  if (random.one_in(3)) add("wall", {{1.5, 0, 0}, {1.5, 1, 0}, {1.5, 1, 1}, {1.5, 0, 1}});
  return plain;
}

// Of each matrix: what a row is to two patches, to backs and to what is open.
std::vector<ViewFactor> entries_of(const matrix::Matrix& matrix) {
  std::vector<ViewFactor> all = matrix.factors.entries;
  all.insert(all.end(), matrix.back.begin(), matrix.back.end());
  all.insert(all.end(), matrix.open.begin(), matrix.open.end());
  return all;
}

// Whatever the budget, the claim and the ways are. Sums and rests may be rounded.
TEST(ViewFactors, ASmallerAccuracyWidensNoEntryOfAMatrix) {
  constexpr std::array<std::size_t, 6> kBudgets{3, 10, 40, 100, 400, 3000};  // the largest only in long runs
  constexpr double kRounded = 0x1p-50;
  std::size_t limited = 0, narrowed = 0;
  for (std::uint64_t s = 0; s < scaled_count(14); ++s) {
    Random random(seed_of(s));
    const Scene scene = generate::build(s % 3 == 0 ? random_scene(random) : slivers(random));
    const Selection source = scene.select("source"), other = patch_of(scene, random.below(scene.patches().size()));
    if (!has_area(scene, source) || !has_area(scene, other)) continue;
    const std::array<Selection, 2> rows{source, other};
    matrix::Options options{.backs = true, .open = true, .threads = 1};
    options.factors.budget = kBudgets[random.below(s < 14 ? 3 : 6)];
    options.factors.both_directions = random.one_in(2);
    options.factors.certify = random.one_in(4);
    std::vector<ViewFactor> before;
    for (const double accuracy : {2e-2, 1e-4, 6e-5, 1e-7, 1e-9}) {
      options.factors.accuracy = accuracy;
      const std::vector<ViewFactor> now = entries_of(matrix::compute(scene, rows, rows, options));
      for (std::size_t e = 0; e < now.size(); ++e) {
        const double width = now[e].upper - now[e].lower;
        limited += now[e].accurate ? 0 : 1;
        if (before.empty()) continue;
        const double width_before = before[e].upper - before[e].lower;
        EXPECT_LE(width, width_before + (e < 4 ? 0.0 : kRounded)) << s << ", entry " << e << ", " << accuracy;
        narrowed += width < width_before ? 1 : 0;
      }
      before = now;
    }
  }
  EXPECT_GE(limited, 40U);
  EXPECT_GE(narrowed, 10U);
}

// F_ij is at most A_j / A_i, since F_ji is at most 1; and what is open has one direction.
TEST(ViewFactors, AreBoundedByAreasInEitherDirection) {
  std::size_t small = 0;
  for (std::uint64_t s = 0; s < scaled_count(30); ++s) {
    Random random(seed_of(s));
    const Scene scene = generate::build(slivers(random));
    const std::array<Selection, 2> rows{scene.select("source"), scene.select("sliver0")};
    matrix::Options options{.backs = true, .open = true, .threads = 1};
    options.factors = {.accuracy = 1e-4, .budget = 1 + random.below(60)};
    const matrix::Matrix one = matrix::compute(scene, rows, rows, options);
    options.factors.both_directions = true;
    const matrix::Matrix both = matrix::compute(scene, rows, rows, options);
    for (const matrix::Matrix* found : {&one, &both}) {
      const ViewFactor& f = found->factors.at(0, 1);
      EXPECT_LE(f.upper, f.area_to / f.area_from * kRoundings) << s;
      small += f.upper > 0.0 && f.area_to < 1e-6 * f.area_from ? 1 : 0;
    }
    for (std::size_t row = 0; row < rows.size(); ++row) {
      EXPECT_EQ(both.open[row].lower, one.open[row].lower) << s;
      EXPECT_EQ(both.open[row].upper, one.open[row].upper) << s;
      EXPECT_EQ(both.back[row].upper, one.back[row].upper) << s;
    }
  }
  EXPECT_GE(small, 5U);
}

void expect_equal_factors(const ViewFactor& a, const ViewFactor& b, const std::string& where) {
  const auto numbers = [](const ViewFactor& f) {
    return std::tuple(f.value, f.lower, f.upper, f.area_from, f.area_to, f.claim, f.way, f.accurate, f.cells,
                      f.event_cells);
  };
  EXPECT_EQ(numbers(a), numbers(b)) << where;
}

// Neither on what else is computed, nor on the order or the number of threads.
TEST(ViewFactors, DependOnTheirPairAlone) {
  std::size_t positive = 0;
  for (std::uint64_t s = 0; s < scaled_count(12); ++s) {
    Random random(seed_of(s));
    const Scene scene = generate::build(s % 3 == 0   ? degenerate_scene(random)
                                        : s % 3 == 1 ? generic_scene(random)
                                                     : random_building(random).scene);
    std::vector<Selection> all;
    for (std::size_t i = 0; i < scene.patches().size() && all.size() < 6; ++i) {
      if (has_area(scene, patch_of(scene, i))) all.push_back(patch_of(scene, i));
    }
    const std::vector<Selection> turned(all.rbegin(), all.rend());
    const matrix::Options options{.factors = {.accuracy = 1e-3, .budget = 60}, .threads = 2};
    const matrix::Factors whole = matrix::compute(scene, all, all, options).factors,
                          other = matrix::compute(scene, turned, turned, options).factors;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const matrix::Factors row = matrix::compute(scene, {&all[i], 1}, turned, options).factors;
      for (std::size_t j = 0; j < all.size(); ++j) {
        const std::string where = std::to_string(s) + ": " + scene.name_of(all[i]) + " -> " + scene.name_of(all[j]);
        const std::size_t last = all.size() - 1;
        expect_equal_factors(whole.at(i, j), other.at(last - i, last - j), where);
        expect_equal_factors(whole.at(i, j), row.at(0, last - j), where);
        expect_equal_factors(whole.at(i, j), view_factor(scene, all[i], all[j], options.factors), where);
        positive += whole.at(i, j).value > 0.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(positive, 20U);
}

// With a single cell every pair is a crowd, and there is one look; with more, there are several. The interval is judged
// by the cells of a larger budget.
TEST(ViewFactors, OfCrowdsHoldTheFactor) {
  std::size_t judged = 0;
  for_each_random_pair(60, [&](std::uint64_t s, const Scene& scene, const Selection& from, const Selection& to) {
    const ViewFactor truth = view_factor(scene, from, to, {.accuracy = 1e-4, .budget = 1000, .sample_crowds = false});
    const ViewFactor f = view_factor(scene, from, to, {.accuracy = 1e-9, .budget = s % 3 == 0 ? 2000U : 1U});
    if (f.way != Way::kPoints) return;
    EXPECT_LE(f.lower, truth.upper) << s << ' ' << scene.name_of(from);
    EXPECT_GE(f.upper, truth.lower) << s << ' ' << scene.name_of(from);
    ++judged;
  });
  EXPECT_GE(judged, 5U);
}

// Every wall sees walls and things, and where a thing stands on it, the backs of that thing.
TEST(ViewFactors, OfClosedRoomsAddUpToOne) {
  const matrix::Options options{
      .factors = {.accuracy = 1e-3, .budget = 3000, .sample_crowds = false}, .backs = true, .threads = 2};
  for (std::uint64_t s = 0; s < scaled_count(6); ++s) {
    Random random(seed_of(s));
    const Scene scene = generate::build(random_building(random).scene);
    std::vector<Selection> all;
    for (std::size_t i = 0; i < scene.patches().size(); ++i) {
      if (has_area(scene, patch_of(scene, i))) all.push_back(patch_of(scene, i));
    }
    const matrix::Sum sum = row_sums(matrix::compute(scene, {all.data(), 1}, all, options)).front();
    EXPECT_LE(sum.lower, 1.0) << s;
    EXPECT_GE(sum.upper, 1.0 - 1e-12) << s;
  }
}

// The same scene with other axes, and scaled by a power of two, which rounds nothing.
TEST(ViewFactors, DependOnNeitherTheAxesNorTheUnitOfLength) {
  std::size_t judged = 0;
  for (std::uint64_t s = 0; s < scaled_count(100); ++s) {
    Random random(seed_of(s));
    generate::PlainScene plain = s % 2 == 0 ? degenerate_scene(random) : generic_scene(random);
    const Scene scene = generate::build(plain);
    const Selection to = scene.select("source");
    const Selection from = patch_of(scene, random.below(scene.patches().size()));
    if (!has_area(scene, from) || !has_area(scene, to)) continue;
    const ViewFactorOptions options{.accuracy = 1e-4, .budget = 500, .sample_crowds = false};
    const ViewFactor f = view_factor(scene, from, to, options);
    const auto again = [&] {
      const Scene changed = generate::build(plain);
      return view_factor(changed, changed.select(scene.name_of(from)), changed.select("source"), options);
    };
    generate::scale(plain, 0x1p10);
    const ViewFactor scaled = again();
    EXPECT_EQ(scaled.lower, f.lower) << s;
    EXPECT_EQ(scaled.upper, f.upper) << s;
    for (Vec3& v : plain.vertices) v = {v.y, v.z, v.x};
    const ViewFactor turned = again();
    EXPECT_LE(turned.lower, f.upper) << s;
    EXPECT_GE(turned.upper, f.lower) << s;
    judged += f.accurate && f.value > 0.0 ? 1 : 0;
  }
  EXPECT_GE(judged, 10U);
}

// The patches with one planar quadrilateral.
std::vector<std::string> quadrilaterals(const Scene& scene, const generate::PlainScene& plain) {
  std::vector<std::string> names;
  for (const generate::PlainPatch& patch : plain.patches) {
    if (patch.faces.size() != 1 || patch.faces[0].rings.size() != 1 || patch.faces[0].rings[0].size() != 4) continue;
    const std::vector<FaceId> faces = scene.faces_of(scene.select(patch.name));
    if (faces.size() == 1 && scene.face(faces[0]).shape == FaceShape::kPlanar &&
        scene.pieces_of(faces[0]).size() == 1) {
      names.push_back(patch.name);
    }
  }
  return names;
}

// Along a diagonal, which makes no new corner.
void cut_in_two(generate::PlainScene& plain, const std::string& name) {
  const generate::Ring ring = plain.patch(name).faces[0].rings[0];
  plain.patch(name).faces[0].rings[0] = {ring[0], ring[1], ring[2]};
  plain.patch(name + "_half").faces.push_back({{{ring[0], ring[2], ring[3]}}});
}

// Of a receiver that is cut in two, the factors add up by area; of a source, as they are.
TEST(ViewFactors, OfTwoHalvesAddUp) {
  std::size_t judged = 0;
  for (std::uint64_t s = 0; s < scaled_count(300); ++s) {
    Random random(seed_of(s));
    generate::PlainScene plain = s % 2 == 0 ? degenerate_scene(random) : generic_scene(random);
    const Scene whole = generate::build(plain);
    const std::vector<std::string> names = quadrilaterals(whole, plain);
    if (names.empty()) continue;
    const std::string name = names[random.below(names.size())];
    const Selection other = patch_of(whole, random.below(whole.patches().size()));
    if (!has_area(whole, other) || whole.name_of(other) == name) continue;
    const std::string to = whole.name_of(other);
    cut_in_two(plain, name);
    const Scene cut = generate::build(plain);
    const auto factor = [](const Scene& scene, const std::string& from, const std::string& towards) {
      const ViewFactorOptions options{.accuracy = 1e-4, .budget = 500, .sample_crowds = false, .certify = true};
      return view_factor(scene, scene.select(from), scene.select(towards), options);
    };
    const ViewFactor f = factor(whole, name, to), a = factor(cut, name, to), b = factor(cut, name + "_half", to);
    const double share = a.area_from / (a.area_from + b.area_from), slack = 1e-12;
    EXPECT_LE(share * a.lower + (1.0 - share) * b.lower, f.upper + slack) << s << ' ' << name << " -> " << to;
    EXPECT_GE(share * a.upper + (1.0 - share) * b.upper, f.lower - slack) << s << ' ' << name << " -> " << to;
    const ViewFactor back = factor(whole, to, name), c = factor(cut, to, name), d = factor(cut, to, name + "_half");
    EXPECT_LE(c.lower + d.lower, back.upper + slack) << s << ' ' << to << " -> " << name;
    EXPECT_GE(c.upper + d.upper, back.lower - slack) << s << ' ' << to << " -> " << name;
    judged += f.accurate && back.accurate && f.value > 0.0 ? 1 : 0;
  }
  EXPECT_GE(judged, 5U);
}

// Two rectangles with boxes between them, whose far sides their near sides hide.
generate::PlainScene boxes_between(Random& random) {
  constexpr int kRange = 8;
  const auto two = [&](int most) {
    const int a = random.integer(0, most - 1);
    return std::array{static_cast<double>(a), static_cast<double>(random.integer(a + 1, most))};
  };
  generate::PlainScene scene;
  const auto x = two(kRange), y = two(kRange), u = two(kRange), v = two(kRange);
  scene.add_ring(scene.patch("below"), {{x[0], y[0], 0}, {x[1], y[0], 0}, {x[1], y[1], 0}, {x[0], y[1], 0}});
  scene.add_ring(scene.patch("above"), {{u[0], v[0], 8}, {u[0], v[1], 8}, {u[1], v[1], 8}, {u[1], v[0], 8}});
  for (int i = random.integer(1, 3); i > 0; --i) {
    const auto a = two(kRange), b = two(kRange), c = two(kRange - 2);
    add_thing(scene, box({a[0], b[0], 1 + c[0]}, {a[1], b[1], 1 + c[1]}));
  }
  return scene;
}

// By default either rectangle may be cut.
TEST(ViewFactors, BehindBoxesAreThoseOfBothDirections) {
  std::size_t judged = 0;
  for (std::uint64_t s = 0; s < scaled_count(150); ++s) {
    Random random(seed_of(s));
    const Scene scene = generate::build(boxes_between(random));
    const Selection below = scene.select("below"), above = scene.select("above");
    ViewFactorOptions options{.accuracy = 1e-4, .budget = 300, .sample_crowds = false};
    const ViewFactor either = view_factor(scene, below, above, options);
    options.both_directions = true;
    const ViewFactor forth = view_factor(scene, below, above, options),
                     back = view_factor(scene, above, below, options);
    const double ratio = back.area_from / forth.area_from;
    for (const auto& [lower, upper] : {std::pair(forth.lower, forth.upper),
                                       std::pair(back.lower * ratio / kRoundings, back.upper * ratio * kRoundings)}) {
      EXPECT_LE(either.lower, upper) << s;
      EXPECT_GE(either.upper, lower) << s;
    }
    judged += either.accurate && either.value > 0.0 ? 1 : 0;
  }
  EXPECT_GE(judged, 20U);
}

// By default each pair of their parts is there once. All faces are one patch, of a building or of boxes, and some of
// what it sees of itself is found by points.
TEST(ViewFactors, OfPatchesToThemselvesAreThoseOfBothDirections) {
  std::size_t judged = 0, by_points = 0;
  for (std::uint64_t s = 0; s < scaled_count(12); ++s) {
    Random random(seed_of(s));
    generate::PlainScene plain = s % 2 == 0 ? random_building(random).scene : boxes_between(random);
    for (std::size_t p = 1; p < plain.patches.size(); ++p) {
      for (const generate::PlainFace& face : plain.patches[p].faces) plain.patches[0].faces.push_back(face);
    }
    plain.patches.resize(1);
    const Scene scene = generate::build(plain);
    const Selection all = patch_of(scene, 0);
    const ViewFactor both = view_factor(
        scene, all, all, {.accuracy = 1e-4, .budget = 4000, .sample_crowds = false, .both_directions = true});
    for (const bool points_too : {false, true}) {
      const ViewFactor once = view_factor(
          scene, all, all, {.accuracy = 1e-4, .budget = points_too ? 1500U : 2000U, .sample_crowds = points_too});
      EXPECT_LE(once.lower, both.upper) << s;
      EXPECT_GE(once.upper, both.lower) << s;
      judged += once.upper - once.lower < 0.05 && both.upper - both.lower < 0.05 ? 1 : 0;
      by_points += once.way == Way::kPoints ? 1 : 0;
    }
  }
  EXPECT_GE(judged, 10U);
  EXPECT_GE(by_points, 2U);
}

// Inner edges of a mesh are not looked at, its ridges are: whether faces share vertices must not matter.
TEST(ViewFactors, BehindAMeshAreThoseBehindItsFaces) {
  enum class Vertices { kShared, kOfEachFace };
  using Rings = std::vector<std::vector<Vec3>>;
  const auto scene_of = [](const Rings& things, Vertices vertices) {
    SceneBuilder builder;
    const MaterialId grey = builder.add_material({});
    std::map<std::tuple<double, double, double>, std::uint32_t> known;
    const auto add = [&](const char* name, const std::vector<Vec3>& ring) {
      std::vector<std::uint32_t> corners;
      for (const Vec3& at : ring) {
        const auto [place, is_new] = known.try_emplace({at.x, at.y, at.z}, 0);
        if (is_new || vertices == Vertices::kOfEachFace) place->second = builder.add_vertex(at);
        corners.push_back(place->second);
      }
      builder.add_face(builder.patch(name), grey, {corners});
    };
    add("floor", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
    add("ceiling", {{0, 0, 4}, {0, 4, 4}, {4, 4, 4}, {4, 0, 4}});
    std::size_t number = 0;
    for (const std::vector<Vec3>& ring : things) add(("thing" + std::to_string(++number)).c_str(), ring);
    return builder.build();
  };
  // Two leaves that meet in the line x = 1, z = 2: both go on to larger x. Then a wavy sheet of 4 x 4 cells.
  const Rings leaves = {{{1, 1, 2}, {3, 1, 2.5}, {3, 3, 2.5}, {1, 3, 2}},
                        {{1, 1, 2}, {3, 1, 1.5}, {3, 3, 1.5}, {1, 3, 2}}};
  Rings sheet;
  const auto at = [](int i, int j) { return Vec3{0.75 + 0.5 * i, 0.75 + 0.5 * j, i % 2 == 0 ? 2.0 : 1.75}; };
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) sheet.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  }
  for (const Rings& things : {leaves, sheet}) {
    const Scene mesh = scene_of(things, Vertices::kShared), faces = scene_of(things, Vertices::kOfEachFace);
    const auto factor = [](const Scene& scene) {
      return view_factor(scene, scene.select("floor"), scene.select("ceiling"), {.accuracy = 1e-4});
    };
    const ViewFactor one = factor(mesh), other = factor(faces);
    EXPECT_LT(one.upper - one.lower, 1e-3) << things.size();
    EXPECT_LE(one.lower, other.upper) << things.size();
    EXPECT_LE(other.lower, one.upper) << things.size();
    EXPECT_NEAR(one.value, other.value, 1e-4) << things.size();
  }
}

}  // namespace
}  // namespace exactff::validation
