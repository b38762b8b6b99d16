// Sequences: Sobol's first two dimensions (van der Corput's, and the one of the polynomial x + 1: the direction numbers
// follow from v <- v xor v/2, T. Kollig and A. Keller 2002), of which every 2^k points from the start are a (0, k,
// 2)-net; Halton's (1960); R2: multiples of 1/g and 1/g^2 modulo 1, where g^3 = g + 1.
#include "methods/unit_points.h"

#include <array>
#include <cmath>

namespace exactff::methods {

using namespace adaptive;

namespace {

UnitPoint sobol_point(std::uint32_t index) {
  std::uint32_t u = 0, v = 0;
  std::uint32_t direction_u = 0x80000000U, direction_v = 0x80000000U;
  for (; index != 0; index >>= 1) {
    if ((index & 1U) != 0) {
      u ^= direction_u;
      v ^= direction_v;
    }
    direction_u >>= 1;
    direction_v ^= direction_v >> 1;
  }
  return {u * kUnit32, v * kUnit32};
}

double radical_inverse(std::uint32_t index, std::uint32_t base) {
  double value = 0.0;
  double digit = 1.0 / base;
  for (; index != 0; index /= base) {
    value += digit * (index % base);
    digit /= base;
  }
  return value;
}

UnitPoint r2_point(std::uint32_t index) {
  constexpr double kPlastic = 1.32471795724474602596;
  const double u = (index + 0.5) / kPlastic, v = (index + 0.5) / (kPlastic * kPlastic);
  return {u - std::floor(u), v - std::floor(v)};
}

UnitPoint point_of(PointSet set, std::uint32_t index) {
  if (set == PointSet::kSobol) return sobol_point(index);
  if (set == PointSet::kHalton) return {radical_inverse(index, 2), radical_inverse(index, 3)};
  return r2_point(index);
}

}  // namespace

UnitPoints::UnitPoints(PointSet set, int count) : set_(set), count_(count) {
  if (set == PointSet::kStratified) {
    cells_.prepare(SamplePattern::kJittered, count);
    ends_.resize(cells_.ray_count());
  } else if (set != PointSet::kRandom) {
    for (int i = 0; i < count; ++i) sequence_.push_back(point_of(set, static_cast<std::uint32_t>(i)));
  }
}

void UnitPoints::place(std::uint64_t key, std::vector<UnitPoint>& points) {
  points.resize(static_cast<std::size_t>(count_));
  if (set_ == PointSet::kStratified) return place_stratified(key, points);
  if (set_ == PointSet::kRandom) {
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = random_point(key, i);
    return;
  }
  const UnitPoint shift = random_point(key, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {wrapped(sequence_[i].u + shift.u), wrapped(sequence_[i].v + shift.v)};
  }
}

// The plan maps the unit square to itself without changing a bit.
void UnitPoints::place_stratified(std::uint64_t key, std::vector<UnitPoint>& points) {
  static const SubPatch kSquare = make_sub_patch(std::array<Vec3, 4>{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  cells_.place(kSquare, key, ends_);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {ends_.x[i], ends_.y[i]};
}

}  // namespace exactff::methods
