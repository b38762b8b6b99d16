// Interim analyses of a function of which only bounds are known: means over convex parts, from random points.
//
// The parts are cut into strata. In each, two independent points are drawn. strata.h has the points and the interval,
// which assumes nothing of the function but its range, which is proved. The stratum where this, times its area, is the
// largest is split. Control variates are planes through what all points before have shown nearby: where the function is
// smooth, little is left for chance.
//
// Each analysis has points of its own, for an interval of a tenth of the width of the last one or, where the points
// were not enough, of the same width again; how many are needed is predicted from the ranges and from the last
// analysis. Analysis k has a share of 1 / (k (k + 1)) of the risk, so that all of them are right with a probability of
// 1 - risk: any of them is a result, or what they have in common, and it does no harm that the next analysis and the
// end depend on what was seen.
//
// Rounding. The shares of the strata are as wrong as their areas, whose roundings are enclosed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/vec.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/strata.h"

namespace exactff::view_factors {

// --- Local planes ---

// Planes through what a function has shown near a place: control variates of what it is there, and nothing more.

class LocalPlanes {
 public:
  // Of a function on convex parts, on each by itself. Keeps a reference.
  explicit LocalPlanes(const std::vector<Part>& parts) : parts_(parts), shown_(parts.size()) {}

  // What the function is at a point of the part.
  void add(std::size_t part, const Vec3& at, double value);

  struct Plane {
    double value = 0.0;  // at the place
    Vec3 gradient;       // along the part
  };
  // Of least squares through the nearest values. Nothing if there is none.
  [[nodiscard]] std::optional<Plane> about(std::size_t part, const Vec3& at) const;

 private:
  struct Value {
    double u, v;  // along the part's axes
    double value;
    std::uint32_t next;  // in the same box of the grid
  };
  struct Shown {
    Vec3 origin, along_u, along_v;
    double low_u, low_v, width, height;  // of the part
    double size = 0.0;                   // of a box
    std::uint32_t columns = 0, rows = 0;
    std::size_t next_grid = 0;         // is made when there are so many values
    std::vector<std::uint32_t> first;  // by box: the newest of its values
    std::vector<Value> values;
  };
  struct Near {
    double u, v;  // from the place
    double value, square;
  };

  static void prepare(const Part& part, Shown& shown);
  static void make_grid(Shown& shown);
  static std::uint32_t& box_of(Shown& shown, const Value& value);
  static void find_near(const Shown& shown, double u, double v, std::vector<Near>& near);

  const std::vector<Part>& parts_;
  std::vector<Shown> shown_;  // by part
  mutable std::vector<Near> near_;
};

// --- Interim analyses ---

inline constexpr std::size_t kPointsOfFirstAnalysis = 216;

class SampledFunction {
 public:
  explicit SampledFunction(std::vector<Part> parts) : parts_(std::move(parts)) {}
  virtual ~SampledFunction() = default;
  SampledFunction(const SampledFunction&) = delete;
  SampledFunction& operator=(const SampledFunction&) = delete;

  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  // On the tile, it is proved to lie between 0 and this, which is at most 1.
  [[nodiscard]] virtual double range(const Tile& tile) = 0;
  // At a point of a part. Nothing where it is not known.
  [[nodiscard]] virtual std::optional<double> at(const Point& point, std::size_t part) = 0;
  // Of all points so far, as of Pair::effort.
  [[nodiscard]] virtual std::uint64_t effort() const = 0;

 private:
  std::vector<Part> parts_;
};

// Of means of functions whose ranges have this mean: what the interval of a first analysis is hardly ever narrower
// than, and the fewest points for one of this width.
[[nodiscard]] double least_width(double range, std::size_t strata, double risk);
[[nodiscard]] double points_for(double range, double width, double risk);
// The largest power of ten below this width: analyses are for such widths.
[[nodiscard]] double next_width(double width);

class InterimAnalyses {
 public:
  // Keeps a reference to the function. `before`: analyses that were taken before, at the cost of the same risk.
  // `first`: points of the first analysis, about; more if the parts are many.
  InterimAnalyses(SampledFunction& function, const Units& units, double risk, std::size_t before,
                  std::size_t first = kPointsOfFirstAnalysis);
  InterimAnalyses(const InterimAnalyses&) = delete;
  InterimAnalyses& operator=(const InterimAnalyses&) = delete;

  // Splits strata until the next analysis is expected to have this width. False if it would take more effort, or more
  // points, than these, of all analyses together.
  [[nodiscard]] bool prepare(double width, std::uint64_t effort, std::size_t points);
  // Splits strata as long as there are points for them. False if there are not even so many as for the strata.
  [[nodiscard]] bool prepare_for_all(std::size_t points);
  [[nodiscard]] double expected_width() const;
  struct Mean {
    double value = 0.5, error = 0.5;
  };
  Mean analyse();

  [[nodiscard]] std::size_t count() const { return number_; }  // with those before
  [[nodiscard]] std::size_t points() const { return points_; }
  [[nodiscard]] std::size_t strata() const { return last_.strata; }                 // of the last analysis
  [[nodiscard]] std::uint64_t effort_of_point() const { return effort_of_point_; }  // on average in the first analysis
  [[nodiscard]] double area() const { return strata_.strata().area; }

 private:
  // Of means over the parts.
  struct Last {
    StratifiedMean least, most;  // what the function is, or may be where it is not known
    std::size_t strata = 0;
  };

  [[nodiscard]] std::size_t points_of_next() const;
  [[nodiscard]] std::size_t points_after_next() const { return points_ + points_of_next(); }
  [[nodiscard]] std::uint64_t effort_after_next() const { return effort_of_point_ * points_after_next(); }
  bool split_within(std::size_t points);
  [[nodiscard]] double risk_of(std::size_t analysis) const;
  struct ControlVariate;
  [[nodiscard]] ControlVariate control_on(const Tile& tile) const;
  void add(std::size_t stratum, Last& analysis);
  [[nodiscard]] std::optional<double> number_at(const Tile& tile, const Place& place);

  SampledFunction& function_;
  const Units& units_;
  double risk_;
  double of_shares_;
  SplitStrata strata_;
  LocalPlanes planes_;
  std::size_t number_, points_ = 0;  // so far
  Last last_;
  double last_number_ = 0.0;
  std::uint64_t effort_of_point_ = 0;
};

}  // namespace exactff::view_factors
