#include "experiments/nettle_rule.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "files/parallel.h"
#include "kernel/statistics.h"
#include "kernel/vec.h"
#include "models/random.h"
#include "text/phrases.h"

namespace exactff::experiments {

namespace {

using kernel::dot;
using kernel::scaled;
using models::Random;
using page::Axes;
using page::Series;
using text::rounded;

constexpr std::string_view kNettleRuleStage = "nettle-rule";

// ----------------------------------------------------------------------------------------------------- configurations

// Uniform on the sphere.
Vec3 random_direction(Random& random) {
  while (true) {
    const Vec3 v{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const double squared = kernel::dot(v, v);
    if (squared < 0.01 || squared > 1.0) continue;
    return scaled(v, 1.0 / std::sqrt(squared));
  }
}

// A random direction with a cosine of at least `least` to `other`.
Vec3 random_towards(Random& random, const Vec3& other, double least) {
  while (true) {
    const Vec3 v = random_direction(random);
    if (kernel::dot(v, other) >= least) return v;
  }
}

// The patch has its centre at the origin, its sides along x and y, and its front towards +z, so it is exactly planar.
// The receiver is at distance 1.
struct Configuration {
  Vec3 receiver;
  Vec3 receiver_normal;
  Vec3 along;     // direction of the occluder's edge
  Vec3 across;    // from the edge into the occluder
  double offset;  // distance of the edge from the line of centres, divided by half the patch's side
};

Configuration make_configuration(Random& random, double least_cosine) {
  Configuration c{};
  c.receiver = random_towards(random, {0, 0, 1}, least_cosine);
  c.receiver_normal = random_towards(random, scaled(c.receiver, -1.0), least_cosine);
  const Vec3 any = random_direction(random);
  const double length = std::hypot(any.x, any.y);
  c.along = {any.x / length, any.y / length, 0};
  c.across = {-c.along.y, c.along.x, 0};
  c.offset = random.between(-0.3, 0.3);
  return c;
}

// The configurations of this group. They do not depend on what else is measured.
std::vector<Configuration> configurations(const NettleSize& size, std::size_t group) {
  constexpr double kWellTowards = 0.3;
  Random random(2000 + group);
  std::vector<Configuration> list;
  for (int i = 0; i < size.configurations; ++i) list.push_back(make_configuration(random, kWellTowards));
  return list;
}

std::vector<Vec3> rectangle(const Vec3& centre, const Vec3& a, double a_low, double a_high, const Vec3& b, double b_low,
                            double b_high) {
  const auto corner = [&](double s, double t) {
    return Vec3{centre.x + a.x * s + b.x * t, centre.y + a.y * s + b.y * t, centre.z};
  };
  return {corner(a_low, b_low), corner(a_high, b_low), corner(a_high, b_high), corner(a_low, b_high)};
}

enum class With { kNothing, kOccluder };

// The occluder lies halfway between receiver and patch, parallel to the patch, and extends far beyond it on one side.
// At half the distance the patch appears half as large.
Scene make_scene(const Configuration& c, double side, With with, double scale = 1.0) {
  SmallScene small;
  const double h = scale * side / 2;
  small.add("patch", rectangle({}, {1, 0, 0}, -h, h, {0, 1, 0}, -h, h));
  if (with == With::kOccluder) {
    const Vec3 middle = scaled(c.receiver, scale / 2);
    small.add("occluder", rectangle(middle, c.along, -8 * h, 8 * h, c.across, c.offset * h / 2, 8 * h));
  }
  return small.build();
}

Receiver receiver_of(const Configuration& c, double scale = 1.0) {
  return {.point = scaled(c.receiver, scale), .normal = c.receiver_normal, .on = {}, .id = {}};
}

double nettle(const Scene& scene, const Receiver& receiver, const std::string& settings) {
  const Selection patch = scene.select("patch");
  return values_of("nettle:" + settings, scene, receiver, {&patch, 1}).front();
}

FormFactor exact(const Scene& scene, const Receiver& receiver, bool fraction) {
  return exact_form_factor(scene, receiver, ExactSource(scene, scene.select("patch")), {.visible_fraction = fraction});
}

// ------------------------------------------------------------------------------------------------------- measurements

struct Way {
  NettleCase kind;
  int splits;
};

std::vector<Way> ways(const NettleSize& size) {
  std::vector<Way> all;
  for (const int m : size.splits) all.push_back({NettleCase::kFree, m});
  all.push_back({NettleCase::kExactV, 1});
  for (const int m : size.splits) all.push_back({NettleCase::kRayV, m});
  return all;
}

std::string splits_text(int splits) { return "splits=" + std::to_string(splits); }

// The relative errors of all ways, for one configuration and side.
std::vector<double> errors_of(const Configuration& c, double side, const NettleSize& size) {
  const Scene free = make_scene(c, side, With::kNothing), occluded = make_scene(c, side, With::kOccluder);
  const Receiver receiver = receiver_of(c);
  const double free_truth = exact(free, receiver, false).value;
  const FormFactor truth = exact(occluded, receiver, true);
  std::vector<double> errors;
  for (const Way& way : ways(size)) {
    const std::string splits = splits_text(way.splits);
    if (way.kind == NettleCase::kFree) {
      errors.push_back(nettle(free, receiver, splits + ",rays=1") / free_truth - 1.0);
    } else if (way.kind == NettleCase::kExactV) {
      errors.push_back(nettle(free, receiver, splits + ",rays=1") * *truth.visible_fraction / truth.value - 1.0);
    } else {
      errors.push_back(nettle(occluded, receiver, splits + ",rays=" + std::to_string(size.rays)) / truth.value - 1.0);
    }
  }
  return errors;
}

// Indexed by way, then configuration.
std::vector<std::vector<double>> group_errors(const NettleSize& size, std::size_t group, double side) {
  std::vector<std::vector<double>> by_way(ways(size).size());
  for (const Configuration& c : configurations(size, group)) {
    const std::vector<double> errors = errors_of(c, side, size);
    for (std::size_t w = 0; w < errors.size(); ++w) by_way[w].push_back(errors[w]);
  }
  return by_way;
}

// ---------------------------------------------------------------------------------------------------------- sentences

const NettleCurve& curve_at(const std::vector<NettleCurve>& curves, NettleCase kind, int splits) {
  return *std::ranges::find_if(curves, [&](const NettleCurve& c) { return c.kind == kind && c.splits == splits; });
}

// "d/7.9", "0.8 d"
std::optional<std::string> side_for(const NettleCurve& curve, double error) {
  const std::optional<double> side = reaches(curve.points(), error);
  if (!side) return std::nullopt;
  return *side < 0.5 ? "d/" + rounded(1.0 / *side, 2) : rounded(*side, 2) + " d";
}

std::string rule_sentence(const std::vector<NettleCurve>& curves, const NettleSize& size) {
  const NettleCurve& whole = curve_at(curves, NettleCase::kFree, 1);
  std::string text =
      "Nettle's rule is that the form factor from centre to centre is accurate if the patch is small relative to its "
      "distance d. Without occlusion, over " +
      rounded(static_cast<double>(size.groups) * size.configurations) +
      " pairs in general position, its relative error grows like the patch's side divided by d, to the power " +
      to_text(whole.slope()) + " (theory: 2).";
  if (const auto one = side_for(whole, 0.01)) text += " For an RMS error of 1 %, the side must be smaller than " + *one;
  if (const auto tenth = side_for(whole, 0.001)) text += "; for 0.1 %, smaller than " + *tenth;
  return text + '.';
}

std::string split_sentence() {
  return "If the patch is split into m × m parts, each with its own form factor, it may be about m times as large, at "
         "m² "
         "times the cost.";
}

NumberTable split_table(const std::vector<NettleCurve>& curves, const NettleSize& size) {
  NumberTable table{"The largest side of a patch at distance d, split into m × m parts, without occlusion",
                    {"m", "RMS error below 1 %", "below 0.1 %"},
                    {}};
  for (const int m : size.splits) {
    const NettleCurve& curve = curve_at(curves, NettleCase::kFree, m);
    table.rows.push_back({std::to_string(m), side_for(curve, 0.01).value_or(""), side_for(curve, 0.001).value_or("")});
  }
  return table;
}

std::string occlusion_sentence(const std::vector<NettleCurve>& curves, const NettleSize& size) {
  const NettleCurve& exact_v = curve_at(curves, NettleCase::kExactV, 1);
  const NettleCurve& ray_v = curve_at(curves, NettleCase::kRayV, 1);
  std::string text =
      "With an occluder across the patch, the rule is not sufficient. Even with the exact visible fraction as "
      "visibility factor, the error falls only like the side to the power " +
      to_text(exact_v.slope()) + " (theory: 1, because the centre of the visible part is not the centre of the patch)";
  if (const auto side = side_for(exact_v, 0.01)) text += "; for 1 %, the side must be smaller than " + *side;
  text += ". With " + std::to_string(size.rays) + " jittered rays, the error does not fall at all (power " +
          to_text(ray_v.slope()) + "): it stays at " + percent(ray_v.rms.front()) + " however small the patch";
  const int m = size.splits.back();
  if (m > 1) {
    text += ", and at " + percent(curve_at(curves, NettleCase::kRayV, m).rms.front()) +
            " with m = " + std::to_string(m) + " and " + rounded(size.rays * static_cast<double>(m) * m) + " rays";
  }
  return text + '.';
}

std::string literal_sentence(const std::vector<NettleLiteral>& rows) {
  const NettleLiteral& row =
      *std::ranges::min_element(rows, {}, [](const NettleLiteral& r) { return std::abs(std::log(r.side / 0.1)); });
  return "Taken literally, Nettle's text multiplies by a ratio of the two areas where the sender's area is needed, and "
         "it gives both ratios. For patches of equal size, either ratio makes the result a number per area. With a "
         "side of " +
         rounded(row.side, 2) + " of the distance, the result is " + rounded(row.sender_over_receiver, 3) +
         " (sender over "
         "receiver) and " +
         rounded(row.receiver_over_sender, 3) +
         " (receiver over sender) times the true value. A form factor has no unit. His result changes by a factor of " +
         rounded(row.in_tenths / row.sender_over_receiver, 2) + " if lengths are measured in tenths of the unit.";
}

std::string cosine_sentence(const TurnedAway& t) {
  return "His cosines, which are \"always positive\", also give energy to patches that face away: of " +
         std::to_string(t.pairs) + " pairs with random orientation, " + text::share(t.zero, t.pairs) +
         " exchange no energy, but for " + text::share(t.literal_positive, t.zero) +
         " of those the literal text gives a positive value.";
}

// ------------------------------------------------------------------------------------------------------------ figures

Series series_of(const NettleCurve& curve, std::string title, int style) {
  return {std::move(title), curve.points(), style};
}

Axes axes() {
  return {
      .x = "side of the patch over its distance",
      .y = "relative RMS error",
      .extra = {
          "set xtics ('1/64' 1./64, '1/32' 1./32, '1/16' 1./16, '1/8' 1./8, '1/4' 1./4, '1/2' 1./2, '1' 1, '2' 2)"}};
}

Series theory(const NettleCurve& curve, double power, std::string title) {
  const double x = curve.at.front(), y = curve.rms.front();
  return {std::move(title), {{x, 0.5 * y}, {0.5, 0.5 * y * std::pow(0.5 / x, power)}}, 0};
}

std::vector<page::Figure> figures(const std::vector<NettleCurve>& curves, const NettleSize& size) {
  std::vector<Series> free, occluded;
  int style = 0;
  for (const int m : size.splits) {
    const std::string title = std::to_string(m) + " × " + std::to_string(m);
    free.push_back(series_of(curve_at(curves, NettleCase::kFree, m), title, ++style));
    occluded.push_back(series_of(curve_at(curves, NettleCase::kRayV, m), title + ", V by rays", style));
  }
  free.push_back(theory(curve_at(curves, NettleCase::kFree, 1), 2.0, "slope 2"));
  const NettleCurve& exact_v = curve_at(curves, NettleCase::kExactV, 1);
  occluded.push_back(series_of(exact_v, "1 × 1, exact V", page::kOverlay));
  occluded.push_back(theory(exact_v, 1.0, "slope 1"));
  return {
      {"nettle-rule.free", "Nettle's rule without occlusion",
       "Form factor from centre to centre for each of m × m parts of a square patch.", page::line_plot(axes(), free)},
      {"nettle-rule.occluded", "Nettle's rule with an occluder across the patch",
       std::to_string(size.rays) + " jittered rays for each of m × m parts, or the exact visible fraction.",
       page::line_plot(axes(), occluded)}};
}

// ------------------------------------------------------------------------------------------------------------- tables

std::string_view name_of(NettleCase kind) {
  constexpr std::array<std::string_view, 3> kNames = {"none", "exact fraction", "rays"};
  return kNames[static_cast<std::size_t>(kind)];
}

CsvFile curve_table(const std::vector<NettleCurve>& curves, const NettleSize& size) {
  TableWriter table(
      "relative error of Nettle's factor from centre to centre, over " +
          std::to_string(static_cast<int>(size.groups) * size.configurations) +
          " configurations in general position\nside: of the patch over its distance; splits: m of m x m parts\n"
          "visibility: none (no occluder), exact fraction, or " +
          std::to_string(size.rays) + " jittered rays a part",
      {"visibility", "splits", "side", "rms", "p95"});
  for (const NettleCurve& c : curves) {
    for (std::size_t i = 0; i < c.at.size(); ++i) {
      table.row() << name_of(c.kind) << c.splits << c.at[i] << c.rms[i] << c.p95[i];
    }
  }
  return table.finish("nettle-rule.csv", "error of Nettle's factor against the patch's size");
}

CsvFile literal_table(const std::vector<NettleLiteral>& rows) {
  TableWriter table("Nettle's literal text over the exact value, median, for patches as large as the receiver's",
                    {"side", "sender_over_receiver", "receiver_over_sender", "sender_over_receiver_in_tenths"});
  for (const NettleLiteral& r : rows) {
    table.row() << r.side << r.sender_over_receiver << r.receiver_over_sender << r.in_tenths;
  }
  return table.finish("nettle-literal.csv", "what Nettle's literal area ratios give");
}

double median_literal_ratio(const NettleSize& size, double side, const std::string& area_ratio, double scale = 1.0) {
  std::vector<double> ratios;
  const double own_area = side * side * scale * scale;
  for (const Configuration& c : configurations(size, 0)) {
    const Scene scene = make_scene(c, side, With::kNothing, scale);
    const Receiver receiver = receiver_of(c, scale);
    const double literal =
        nettle(scene, receiver,
               "rays=1,variant=literal,area_ratio=" + area_ratio + ",receiver_area=" + text::shortest(own_area));
    ratios.push_back(literal / exact(scene, receiver, false).value);
  }
  return kernel::median(std::move(ratios));
}

}  // namespace

SlopeFit NettleCurve::slope() const {
  constexpr double kSmall = 0.13;
  return ErrorCurve::slope(kSmall);
}

std::vector<NettleCurve> nettle_curves(const NettleSize& size, int threads, const Hooks& hooks) {
  const std::vector<Way> all = ways(size);
  // Indexed by side, way, then group.
  std::vector found(size.sides.size(), std::vector(all.size(), std::vector<std::vector<double>>(size.groups)));
  files::parallel_for(size.sides.size() * size.groups, threads, kNettleRuleStage, hooks, [&](std::size_t i) {
    const std::size_t side = i / size.groups, group = i % size.groups;
    auto errors = group_errors(size, group, size.sides[side]);
    for (std::size_t way = 0; way < all.size(); ++way) found[side][way][group] = std::move(errors[way]);
  });
  std::vector<NettleCurve> curves;
  for (std::size_t way = 0; way < all.size(); ++way) {
    NettleCurve& curve = curves.emplace_back();
    curve.kind = all[way].kind;
    curve.splits = all[way].splits;
    for (std::size_t side = 0; side < size.sides.size(); ++side) curve.add_place(size.sides[side], found[side][way]);
  }
  return curves;
}

std::vector<NettleLiteral> nettle_literal(const NettleSize& size, int threads, const Hooks& hooks) {
  std::vector<NettleLiteral> rows(size.sides.size());
  files::parallel_for(rows.size(), threads, kNettleRuleStage, hooks, [&](std::size_t i) {
    const double side = size.sides[i];
    rows[i] = {side, median_literal_ratio(size, side, "sender-over-receiver"),
               median_literal_ratio(size, side, "receiver-over-sender"),
               median_literal_ratio(size, side, "sender-over-receiver", 10.0)};
  });
  return rows;
}

TurnedAway nettle_turned_away(const NettleSize& size) {
  constexpr double kSmall = 1.0 / 16.0, kAnyCosine = -1.0;
  Random random(3000);
  TurnedAway count;
  for (int i = 0; i < size.orientations; ++i) {
    const Configuration c = make_configuration(random, kAnyCosine);
    const Scene scene = make_scene(c, kSmall, With::kNothing);
    ++count.pairs;
    const Receiver receiver = receiver_of(c);
    if (exact(scene, receiver, false).value > 0.0) continue;
    ++count.zero;
    count.literal_positive += nettle(scene, receiver, "rays=1,variant=literal") > 0.0 ? 1U : 0U;
  }
  return count;
}

Result nettle_rule(const NettleSize& size, int threads, const Hooks& hooks) {
  const std::vector<NettleCurve> curves = nettle_curves(size, threads, hooks);
  const std::vector<NettleLiteral> literal = nettle_literal(size, threads, hooks);
  Result result{.name = "nettle-rule", .title = "Nettle's rule: how small is relatively small?"};
  result.paragraphs = {rule_sentence(curves, size), split_sentence(), occlusion_sentence(curves, size),
                       literal_sentence(literal), cosine_sentence(nettle_turned_away(size))};
  std::erase(result.paragraphs, "");
  result.tables = {split_table(curves, size)};
  result.figures = figures(curves, size);
  result.values = {curve_table(curves, size), literal_table(literal)};
  return result;
}

Result nettle_rule(const Effort& effort, const Hooks& hooks) {
  NettleSize size;
  if (effort.abridged) {
    size.sides = geometric(1.0 / 64.0, 2.0, 8);
    size.splits = {1, 4};
    size.groups = 4;
    size.configurations = 12;
    size.orientations = 512;
  }
  return nettle_rule(size, effort.threads, hooks);
}

}  // namespace exactff::experiments
