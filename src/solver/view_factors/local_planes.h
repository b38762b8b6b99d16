// Planes through what a function has shown near a place: guesses of what it is there, and nothing more.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "kernel/vec.h"
#include "view_factors/sight.h"

namespace exactff::view_factors {

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

}  // namespace exactff::view_factors
