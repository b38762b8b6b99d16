// The format of the bytes that mean a scene (scene_bytes.h): the numbers of instructions, flags and choices, and how
// coordinates, planes and rectangles are read. The corpus data/fuzz/solver/ depends on it.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "exactff/geometry.h"
#include "fuzz/bytes.h"

namespace exactff::validation::scene_bytes {

using Corners = std::vector<Vec3>;

inline constexpr std::size_t kMaxRings = 4;         // of one face
inline constexpr std::size_t kMaxRingCorners = 24;  // of one ring

inline double& component(Vec3& v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// --- Numbers of instructions, flags and choices ---

enum class Op : std::uint8_t {
  kTriangle,
  kParallelogram,
  kRectangle,
  kStar,
  kRing,
  kFrame,
  kCopy,
  kCover,
  kThroughReceiver,
  kNeighbour,
  kTiles,
  kRaw,
  kSpike,
  kIdleCorner,
  kNudge,
  kSlide,
};
inline constexpr std::size_t kOpCount = 16;

// Flags in the same byte as the instruction.
enum Flag : std::uint8_t { kSamePatch = 1, kReversed = 2, kKeyhole = 4, kOther = 8 };

enum class Place : std::uint8_t { kOrigin, kLattice, kCorner, kMiddle, kInPlane, kRaw };
inline constexpr std::size_t kPlaceCount = 6;

enum class NormalKind : std::uint8_t { kUp, kLattice, kRaw };
inline constexpr std::size_t kNormalCount = 3;

// A plane w = height + slope_u u + slope_v v over two of the axes.
struct Plane {
  std::size_t axis = 2;
  double height = 0.0;
  double slope_u = 0.0;
  double slope_v = 0.0;

  [[nodiscard]] Vec3 at(double u, double v) const {
    Vec3 out;
    component(out, (axis + 1) % 3) = u;
    component(out, (axis + 2) % 3) = v;
    component(out, axis) = height + slope_u * u + slope_v * v;
    return out;
  }
};

struct Rectangle {
  double u = 0.0;
  double v = 0.0;
  double width = 1.0;
  double height = 1.0;

  [[nodiscard]] Corners corners(const Plane& plane) const {
    return {plane.at(u, v + height), plane.at(u + width, v + height), plane.at(u + width, v), plane.at(u, v)};
  }
  // The part between two pairs of sixteenths.
  [[nodiscard]] Rectangle part(std::size_t left, std::size_t low, std::size_t right, std::size_t high) const {
    const auto sixteenth = [](std::size_t k) { return static_cast<double>(k) / 16.0; };
    return {u + sixteenth(left) * width, v + sixteenth(low) * height, sixteenth(right - left) * width,
            sixteenth(high - low) * height};
  }
};

// Reads coordinates and what is made of them.
class Numbers : public Bytes {
 public:
  using Bytes::Bytes;

  double coordinate() {
    const std::uint8_t byte = next();
    const double plain = ((byte & 15) - 8) / 4.0;
    switch (byte >> 4) {
      case 11:
        return std::nextafter(plain, 1e300);
      case 12:
        return std::nextafter(plain, -1e300);
      case 13:
        return 0x1p-40 * plain;
      case 14:
        return 0x1p40 * plain;
      case 15:
        return plain / 3.0;
      default:
        return plain;
    }
  }

  Vec3 lattice_point() {
    const double x = coordinate();
    const double y = coordinate();
    return {x, y, coordinate()};
  }

  Vec3 raw_point() {
    const double x = raw_double();
    const double y = raw_double();
    return {x, y, raw_double()};
  }

  Plane plane() {
    const std::uint8_t kind = next();
    Plane out;
    out.axis = (kind + 2u) % 3;  // horizontal first
    out.height = coordinate();
    if (kind < 160) return out;
    out.slope_u = slope();
    out.slope_v = slope();
    return out;
  }

  Rectangle rectangle() {
    Rectangle out;
    out.u = coordinate();
    out.v = coordinate();
    const std::uint8_t size = next();
    out.width = (1 + (size & 15)) / 4.0;
    out.height = (1 + (size >> 4)) / 4.0;
    return out;
  }

 private:
  double slope() {
    constexpr std::array kSlopes{0.0, 0.5, -0.5, 1.0, -1.0, 0.25, 2.0, 1.0 / 3.0};
    return kSlopes[below(kSlopes.size())];
  }
};

}  // namespace exactff::validation::scene_bytes
