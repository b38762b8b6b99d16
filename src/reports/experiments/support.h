// Shared by several experiments: Karkanis' scenes, values of many sources from one point, times, tables, slopes.
#pragma once

#include <functional>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "exactff/methods.h"
#include "experiments/experiment.h"
#include "page/gnuplot.h"
#include "study/prepared_method.h"
#include "text/csv_row.h"

namespace exactff::experiments {

// ------------------------------------------------------------------------------------------------------------ scenes

// Triangles with a common normal that all face the receiver. Each is a source.
struct KarkanisScene {
  Scene scene;
  Receiver receiver;
  std::vector<Selection> triangles;
};
[[nodiscard]] KarkanisScene karkanis_scene(int triangles, std::uint64_t seed);

// A scene of a few polygons, each of which is a patch.
class SmallScene {
 public:
  // The ring is counter-clockwise as seen from the front.
  void add(std::string_view patch, const std::vector<Vec3>& ring);
  [[nodiscard]] Scene build() { return builder_.build(); }

 private:
  SceneBuilder builder_;
  MaterialId material_ = builder_.add_material({});
};

// ------------------------------------------------------------------------------------------------------------ values

// A method prepared for a scene and its sources. For one thread at a time.
class Bench {
 public:
  Bench(const methods::Choice& choice, const Scene& scene, std::span<const Selection> sources);
  // The values of all sources, in their order.
  [[nodiscard]] std::span<const methods::Estimate> look_from(const Receiver& receiver);

 private:
  study::PreparedMethod prepared_;
  std::unique_ptr<methods::Evaluator> evaluator_;
  std::vector<methods::Estimate> estimates_;
};

[[nodiscard]] std::vector<double> values_of(std::string_view choice, const Scene& scene, const Receiver& receiver,
                                            std::span<const Selection> sources);

// The exact values of single faces, from one sweep over all that the receiver sees (exactff/view.h): the same bits as
// one source after another.
[[nodiscard]] std::vector<double> exact_values(const Scene& scene, const Receiver& receiver,
                                               std::span<const Selection> faces);

[[nodiscard]] std::vector<ExactSource> exact_sources(const Scene& scene, std::span<const Selection> sources);

[[nodiscard]] double root_mean_square(std::span<const double> errors);

// ------------------------------------------------------------------------------------------------------------- times

// The time of one call in seconds, on a steady clock: the median of up to `repeats` calls after a warm-up call, as long
// as they take less than a second together. If the first call takes longer than that, its time is the result.
[[nodiscard]] double median_seconds(const std::function<void()>& call, std::size_t repeats = 5);

// ------------------------------------------------------------------------------------------------------------ slopes

using page::NumberTable;
using page::Points;

struct SlopeFit {
  double slope = 0.0;
  double half_width = 0.0;  // of the 95 % confidence interval
  std::size_t count = 0;    // number of independent slopes averaged
};
// The mean of independent slopes, with its confidence interval by Student's t. Requires at least two slopes.
[[nodiscard]] SlopeFit mean_slope(std::span<const double> slopes);
// "-0.81 ± 0.03"
[[nodiscard]] std::string to_text(const SlopeFit& fit);
// A slope with two decimals and a true minus sign.
[[nodiscard]] std::string slope_text(double slope);

// Errors along a curve, measured in independent groups.
struct ErrorCurve {
  std::vector<double> at;
  std::vector<double> rms;                        // over all groups
  std::vector<double> median, p95;                // of the magnitudes, over all groups
  std::vector<std::vector<double>> rms_by_group;  // indexed by group, then place

  // Adds the errors at the next place, indexed by group.
  void add_place(double place, const std::vector<std::vector<double>>& by_group);
  [[nodiscard]] Points points() const;  // at, rms
  // The slope of the log-log line through the places up to `last`.
  [[nodiscard]] SlopeFit slope(double last) const;
};

// The x at which the polyline through the points, sorted by x, first reaches the value y from below; on log-log axes.
// Nothing if it never does.
[[nodiscard]] std::optional<double> reaches(const Points& points, double y);

// "1.5 %"
[[nodiscard]] std::string percent(double share);

// ------------------------------------------------------------------------------------------------------------ tables

// Writes a CSV file: comment lines (#) that describe it, the column names, rows.
class TableWriter {
 public:
  TableWriter(std::string_view about, std::initializer_list<std::string_view> columns);
  [[nodiscard]] text::CsvRow row() { return text::CsvRow(out_); }
  [[nodiscard]] CsvFile finish(std::string file, std::string holds) const;

 private:
  std::ostringstream out_;
};

// `count` values from first to last in geometric progression.
[[nodiscard]] std::vector<double> geometric(double first, double last, int count);

}  // namespace exactff::experiments
