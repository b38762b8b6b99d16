#include "studies/whole_view_times.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "exactff/models.h"
#include "exactff/view.h"
#include "files/parallel.h"
#include "models/random.h"
#include "studies/small_scene.h"
#include "text/phrases.h"

namespace exactff::experiments {

namespace {

using text::counted;
using text::duration;
using text::rounded;

constexpr std::string_view kWholeViewStage = "whole-view";

Vec3 direction_at_random(models::Random& random) {
  for (;;) {
    const Vec3 v{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    const double squared = v.x * v.x + v.y * v.y + v.z * v.z;
    if (squared > 1.0 || squared < 0.01) continue;
    const double length = std::sqrt(squared);
    return {v.x / length, v.y / length, v.z / length};
  }
}

// n triangles at distances between 1 and 2 whose shadows together have about the area of the sphere around the origin.
Scene spread_around(int n, std::uint64_t seed) {
  models::Random random(seed);
  SmallScene scene;
  const double size = std::sqrt(8.0 * std::numbers::pi / n);
  for (int i = 0; i < n; ++i) {
    const Vec3 centre = direction_at_random(random);
    const double distance = random.between(1.0, 2.0);
    std::vector<Vec3> ring;
    for (int k = 0; k < 3; ++k) {
      const Vec3 aside = direction_at_random(random);
      ring.push_back({distance * (centre.x + size * aside.x), distance * (centre.y + size * aside.y),
                      distance * (centre.z + size * aside.z)});
    }
    scene.add("around", ring);
  }
  return scene.build();
}

WholeViewRow row_of(std::string name, const Scene& scene, std::span<const Receiver> receivers, const Hooks& hooks) {
  WholeViewRow row{.scene = std::move(name), .faces = scene.faces().size()};
  const HooksOfThread during(hooks);
  Workspace workspace;
  WholeView seen;
  for (const Receiver& receiver : receivers) {
    view(scene, receiver, {.faces = true}, seen, workspace);
    row.seen += seen.patches.size();
    row.arcs += seen.record.arcs;
    row.open += seen.open.value / static_cast<double>(receivers.size());
    Enclosure sum = seen.back.enclosure;
    sum += seen.open.enclosure;
    for (const SeenPatch& face : seen.patches) sum += face.share.enclosure;
    row.holds_one = row.holds_one && sum.contains(1.0);
    row.seconds += median_seconds([&] { view(scene, receiver, {.faces = true}, seen, workspace); }, 3) /
                   static_cast<double>(receivers.size());
  }
  return row;
}

std::string number_text(int n) { return std::to_string(n) + (n == 1 ? " triangle" : " triangles"); }

// The exponent of the times over the last two decades or less.
std::string growth(std::span<const int> triangles, std::span<const WholeViewRow> rows) {
  if (rows.size() < 2) return "?";
  std::size_t first = 0;
  while (first + 2 < rows.size() && triangles[first] * 100 < triangles[rows.size() - 1]) ++first;
  return slope_text(
             local_exponent(triangles[first], rows[first].seconds, triangles[rows.size() - 1], rows.back().seconds)) +
         " (from " + std::to_string(triangles[first]) + " to " + number_text(triangles[rows.size() - 1]) + ")";
}

std::string times_of(std::span<const int> triangles, std::span<const WholeViewRow> rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += (i == 0 ? "" : "; ") + std::to_string(triangles[i]) + ": " + duration(rows[i].seconds);
  }
  return text;
}

std::string karkanis_sentence(const WholeViewSize& size, std::span<const WholeViewRow> rows) {
  return "All that one point sees of Karkanis' triangles, region by region, with certified form factors, on one "
         "thread: " +
         times_of(size.triangles, rows) + ". The time grows like n to the power " + growth(size.triangles, rows) +
         ". Karkanis' local exponents were 3.8, 6.7 and 5, and he needed 8 hours for 500 triangles.";
}

std::string around_sentence(const WholeViewSize& size, std::span<const WholeViewRow> rows) {
  return "Spread around the point: " + times_of(size.triangles, rows) + ". The exponent is " +
         growth(size.triangles, rows) + '.';
}

std::string models_sentence(const WholeViewSize& size, std::span<const WholeViewRow> rows) {
  std::string text = "One view on average over " + counted(size.points, "point") + ":";
  for (const WholeViewRow& row : rows) {
    text += (&row == rows.data() ? " " : "; ") + row.scene + " (" + counted(row.faces, "face") + ") " +
            duration(row.seconds);
  }
  return text + '.';
}

CsvFile work_table(const std::vector<WholeViewRow>& rows) {
  TableWriter table(
      "whole views: `before` are the models karkanis:n=TRIANGLES,floor=0,seed=1, `around` random triangles around the "
      "point\nseen: faces, summed over the points; arcs: parts of edges between two things seen; open: the share that "
      "meets nothing; holds_one: the balls of all shares contain 1",
      {"scene", "faces", "seen", "arcs", "open", "holds_one"});
  for (const WholeViewRow& row : rows) {
    table.row() << row.scene << static_cast<std::uint64_t>(row.faces) << static_cast<std::uint64_t>(row.seen)
                << row.arcs << row.open << (row.holds_one ? "yes" : "no");
  }
  return table.finish("whole-view.csv", "what one point sees, for growing numbers of triangles");
}

CsvFile time_table(const std::vector<WholeViewRow>& rows) {
  TableWriter table("seconds for one whole view, on one thread, after a first call unless that took more than a second",
                    {"scene", "faces", "seconds"});
  for (const WholeViewRow& row : rows) table.row() << row.scene << static_cast<std::uint64_t>(row.faces) << row.seconds;
  return table.finish("whole-view-times.csv", "time of one whole view");
}

}  // namespace

// First his triangles, then those around the point, then the models.
std::vector<WholeViewRow> whole_view_rows(const WholeViewSize& size, const Hooks& hooks) {
  std::vector<WholeViewRow> rows;
  const std::size_t total = 2 * size.triangles.size() + size.models.size();
  const auto add = [&](std::string name, const Scene& scene, std::span<const Receiver> receivers) {
    files::require_not_cancelled(hooks);
    rows.push_back(row_of(std::move(name), scene, receivers, hooks));
    if (hooks.progress) hooks.progress({kWholeViewStage, rows.size(), total});
  };
  for (const int n : size.triangles) {
    const KarkanisScene karkanis = karkanis_scene(n, 1);
    add("before:" + std::to_string(n), karkanis.scene, std::span(&karkanis.receiver, 1));
  }
  const Receiver up{.point = {0, 0, 0}, .normal = {0, 0, 1}, .on = {}, .id = {}};
  for (const int n : size.triangles) add("around:" + std::to_string(n), spread_around(n, 1), std::span(&up, 1));
  for (const WholeViewSize::Model& model : size.models) {
    const Scene scene = models::make_scene(model.name);
    add(model.name, scene, sample_receivers(scene, scene.faces_of(scene.select(model.on)), size.points, 1));
  }
  return rows;
}

Result whole_view_times(const WholeViewSize& size, const Hooks& hooks) {
  const std::vector<WholeViewRow> rows = whole_view_rows(size, hooks);
  const std::span all(rows);
  const std::size_t n = size.triangles.size();
  Result result{.name = "whole-view", .title = "The whole view from one point"};
  result.paragraphs = {karkanis_sentence(size, all.first(n)), around_sentence(size, all.subspan(n, n)),
                       models_sentence(size, all.subspan(2 * n))};
  result.values = {work_table(rows)};
  result.times = {time_table(rows)};
  return result;
}

Result whole_view_times(const Effort& effort, const Hooks& hooks) {
  WholeViewSize size;
  if (effort.abridged) {
    size.triangles = {50, 100, 200, 500, 1000, 5000};
    size.points = 2;
  }
  return whole_view_times(size, hooks);
}

}  // namespace exactff::experiments
