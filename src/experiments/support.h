// What several experiments share: Karkanis' scenes, values of many sources from one point, times, tables, slopes.
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
#include "study/csv_row.h"
#include "study/plot_script.h"

namespace exactff::experiments {

// ------------------------------------------------------------------------------------------------------------ scenes

// Triangles of one normal that face the receiver, each of them a source.
struct KarkanisScene {
  Scene scene;
  Receiver receiver;
  std::vector<Selection> triangles;
};
[[nodiscard]] KarkanisScene karkanis_scene(int triangles, std::uint64_t seed);

// A scene of a few polygons, each a patch of its own.
class SmallScene {
 public:
  // Counter-clockwise seen from the front.
  void add(std::string_view patch, const std::vector<Vec3>& ring);
  [[nodiscard]] Scene build() { return builder_.build(); }

 private:
  SceneBuilder builder_;
  MaterialId material_ = builder_.add_material({});
};

// ------------------------------------------------------------------------------------------------------------ values

// A method on a scene with its sources, for one thread at a time.
class Bench {
 public:
  Bench(const methods::Choice& choice, const Scene& scene, std::span<const Selection> sources);
  // Of every source, in their order.
  [[nodiscard]] std::span<const methods::Estimate> look_from(const Receiver& receiver);

 private:
  std::unique_ptr<methods::PreparedScene> on_scene_;
  std::unique_ptr<methods::Evaluator> evaluator_;
  std::vector<std::unique_ptr<methods::PreparedSource>> owned_;
  std::vector<const methods::PreparedSource*> sources_;
  std::vector<methods::Estimate> estimates_;
};

[[nodiscard]] std::vector<double> values_of(std::string_view choice, const Scene& scene, const Receiver& receiver,
                                            std::span<const Selection> sources);

[[nodiscard]] std::vector<ExactSource> exact_sources(const Scene& scene, std::span<const Selection> sources);

[[nodiscard]] double root_mean_square(std::span<const double> errors);

// ------------------------------------------------------------------------------------------------------------- times

// Seconds of one call on a steady clock: after a first call that warms up, the median of up to `repeats` more, as long
// as they take less than a second together. A first call longer than that is not repeated.
[[nodiscard]] double seconds_of(const std::function<void()>& call, int repeats = 5);

// ------------------------------------------------------------------------------------------------------------ slopes

using study::Points;

struct SlopeFit {
  double slope = 0.0;
  double half_width = 0.0;  // of the 95 % confidence interval
  std::size_t count = 0;    // of independent slopes that it is the mean of
};
// The mean of independent slopes, by Student's t. Requires two of them or more.
[[nodiscard]] SlopeFit mean_slope(std::span<const double> slopes);
// "-0.81 ± 0.03"
[[nodiscard]] std::string to_text(const SlopeFit& fit);
// A slope with two decimals and a true minus sign.
[[nodiscard]] std::string slope_text(double slope);

// Where the broken line through the points, in order of x, first has the value y from below; log-log. Nothing if it
// never does.
[[nodiscard]] std::optional<double> reaches(const Points& points, double y);

// "1.5 %"
[[nodiscard]] std::string percent(double share);

// ------------------------------------------------------------------------------------------------------------ tables

// A CSV being written: `#` lines that tell what it is, the names of the columns, rows.
class Table {
 public:
  Table(std::string_view about, std::initializer_list<std::string_view> columns);
  [[nodiscard]] study::CsvRow row() { return study::CsvRow(out_); }
  [[nodiscard]] TextTable finish(std::string file, std::string holds) const;

 private:
  std::ostringstream out_;
};

// n values from first to last, each the same multiple of the one before.
[[nodiscard]] std::vector<double> geometric(double first, double last, int count);

}  // namespace exactff::experiments
