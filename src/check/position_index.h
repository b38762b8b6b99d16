// Finds rows of a truth file by their position.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "exactff/check.h"

namespace exactff::check {

class PositionIndex {
 public:
  // With `normals`, the unit normals must be near as well. Keeps a reference to the truth.
  PositionIndex(const Truth& truth, const MatchOptions& options, bool normals);
  ~PositionIndex();
  PositionIndex(const PositionIndex&) = delete;
  PositionIndex& operator=(const PositionIndex&) = delete;

  // All rows of the source that are near enough to the point, the nearest first; equally near rows in the order of the
  // truth.
  [[nodiscard]] std::vector<std::uint32_t> near(const Vec3& point, const Vec3& normal, std::uint32_t source) const;

 private:
  struct Tree;
  const Truth& truth_;
  double tolerance_;
  double normal_tolerance_;
  bool normals_;
  std::unique_ptr<Tree> tree_;
};

[[nodiscard]] double distance(const Vec3& a, const Vec3& b);

}  // namespace exactff::check
