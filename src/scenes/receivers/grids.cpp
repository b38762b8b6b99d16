// Grids of receivers on regions.
//
// The centres of u x v cells on an outline, in exact arithmetic, each rounded once at the end. Corners are p_i relative
// to the first one, n is the Newell vector.
//   1. A convex quadrilateral (no holes; convex seen along n): the bilinear map at ((2i+1)/2u, (2j+1)/2v).
//   2. Any other outline: its bounding rectangle along e and f, the frame of region_shape.h.
//   3. Of the centres of step 2, keep those strictly inside.
//   4. On several faces, move each centre along n onto the face under it.
#include <algorithm>
#include <array>

#include "exactff/error.h"
#include "exactff/receiver.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "receivers/own_pieces.h"
#include "receivers/region_shape.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff {
namespace {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;

// The receivers of one region.
class RegionGrid {
 public:
  RegionGrid(const Scene& scene, const Region& region, GridSize size, std::string prefix, kernel::Steps& cells)
      : scene_(scene),
        shape_(scene, region),
        prefix_(std::move(prefix)),
        cells_(cells),
        lattice_(std::make_shared<Lattice>()) {
    lattice_->region = region;
    lattice_->size = size;
  }

  void append_to(std::vector<Receiver>& receivers) {
    plane().is_convex_quadrilateral() ? append_bilinear(receivers) : append_rectangle(receivers);
  }

 private:
  [[nodiscard]] const FacePlane& plane() const { return shape_.outline(); }
  [[nodiscard]] GridSize size() const { return lattice_->size; }

  void append_bilinear(std::vector<Receiver>& receivers) {
    const std::vector<ExactVec3>& p = plane().points().at;
    lattice_->width = in_the_scenes_unit(length(p[1] - p[0]));
    lattice_->height = in_the_scenes_unit(length(p[3] - p[0]));
    for (std::size_t i = 0; i < p.size(); ++i) lattice_->corners[i] = plane().rounded({p[i].x, p[i].y, p[i].z});
    const Integer whole = Integer(4) * size().u * size().v;
    for (int row = 1; row <= size().v; ++row) {
      for (int column = 1; column <= size().u; ++column) {
        cells_.take();
        const Integer s = 2 * column - 1, t = 2 * row - 1;
        const Integer s_rest = 2 * size().u - s, t_rest = 2 * size().v - t;
        const ExactVec3 sum = p[0] * Integer(s_rest * t_rest) + p[1] * Integer(s * t_rest) + p[2] * Integer(s * t) +
                              p[3] * Integer(s_rest * t);
        append(receivers, {quotient(sum.x, whole), quotient(sum.y, whole), quotient(sum.z, whole)},
               {dot(shape_.frame().e(), sum), whole}, {dot(shape_.frame().f(), sum), whole}, {lattice_, column, row});
      }
    }
  }

  void append(std::vector<Receiver>& receivers, const std::array<Rational, 3>& at, const FaceFrame::Coordinate& a,
              const FaceFrame::Coordinate& b, const GridCell& cell) const {
    Receiver receiver;
    if (is_one_planar_face(scene_, lattice_->region)) {
      receiver.point = plane().rounded(at);
      receiver.on = lattice_->region.faces;
      receiver.normal = scene_.face(receiver.on.front()).newell;
    } else if (auto under = shape_.receiver_under(at, a, b)) {
      receiver = std::move(*under);
    } else {
      return;
    }
    receiver.id = prefix_ + 'r' + std::to_string(cell.row) + 'c' + std::to_string(cell.column);
    receiver.cell = cell;
    receivers.push_back(std::move(receiver));
  }

  void append_rectangle(std::vector<Receiver>& receivers) {
    const FaceFrame& frame = shape_.frame();
    const Mean mean = mean_of(frame);
    const auto [a_min, a_max] = std::minmax_element(frame.a().begin(), frame.a().end());
    const auto [b_min, b_max] = std::minmax_element(frame.b().begin(), frame.b().end());
    lattice_->width = in_the_scenes_unit(*a_max - *a_min, length(frame.e()));
    lattice_->height = in_the_scenes_unit(*b_max - *b_min, length(frame.f()));
    std::size_t corner = 0;
    for (const auto& [a, b] : {std::pair{a_min, b_min}, {a_max, b_min}, {a_max, b_max}, {a_min, b_max}}) {
      lattice_->corners[corner++] = plane().rounded(point_at(frame, mean, {*a, 1}, {*b, 1}));
    }
    if (plane().is_convex()) {
      for (const ExactVec3& p : plane().points().at) {
        lattice_->convex_outline.push_back(plane().rounded({p.x, p.y, p.z}));
      }
    }
    const bool lone = lattice_->region.faces.size() == 1;
    for (int row = 1; row <= size().v; ++row) {
      // Multiplies (a, b) by 2u and 2v: the centres are then integers.
      const FaceFrame::Coordinate b{*b_min * (2 * size().v) + (*b_max - *b_min) * (2 * row - 1), 2 * size().v};
      for (int column = 1; column <= size().u; ++column) {
        cells_.take();
        const FaceFrame::Coordinate a{*a_min * (2 * size().u) + (*a_max - *a_min) * (2 * column - 1), 2 * size().u};
        if (lone && !frame.strictly_inside(a, b)) continue;
        append(receivers, point_at(frame, mean, a, b), a, b, {lattice_, column, row});
      }
    }
  }

  // Estimates.
  [[nodiscard]] double in_the_scenes_unit(const Length& length) const {
    return to_double({length.mantissa, length.exponent + plane().points().exponent});
  }
  [[nodiscard]] double in_the_scenes_unit(const Integer& along_axis, const Length& axis) const {
    long exponent = 0;
    const double mantissa = mpz_get_d_2exp(&exponent, along_axis.get_mpz_t());
    return in_the_scenes_unit({mantissa / axis.mantissa, exponent - axis.exponent});
  }

  // Sums over the corners.
  struct Mean {
    Integer count = 0;
    ExactVec3 p;
    Integer a = 0;
    Integer b = 0;
  };

  [[nodiscard]] Mean mean_of(const FaceFrame& frame) const {
    Mean mean;
    mean.count = static_cast<unsigned long>(plane().points().size());
    for (const ExactVec3& p : plane().points().at) mean.p = mean.p + p;
    for (const Integer& a : frame.a()) mean.a += a;
    for (const Integer& b : frame.b()) mean.b += b;
    return mean;
  }

  // mean + (a - a_mean)/(e.e) e + (b - b_mean)/(f.f) f. For a planar face the mean cancels.
  static std::array<Rational, 3> point_at(const FaceFrame& frame, const Mean& mean, const FaceFrame::Coordinate& a,
                                          const FaceFrame::Coordinate& b) {
    const auto along = [&](const ExactVec3& axis, const FaceFrame::Coordinate& c, const Integer& sum) {
      return quotient(c.numerator * mean.count - sum * c.denominator, dot(axis, axis) * mean.count * c.denominator);
    };
    const Rational along_e = along(frame.e(), a, mean.a), along_f = along(frame.f(), b, mean.b);
    std::array<Rational, 3> at;
    for (int axis = 0; axis < 3; ++axis) {
      at[static_cast<std::size_t>(axis)] =
          quotient(mean.p[axis], mean.count) + along_e * frame.e()[axis] + along_f * frame.f()[axis];
    }
    return at;
  }

  const Scene& scene_;
  RegionShape shape_;
  std::string prefix_;
  kernel::Steps& cells_;
  std::shared_ptr<Lattice> lattice_;
};

void check_grid_size(GridSize size, std::size_t regions) {
  const std::string cells = "a grid of " + std::to_string(size.u) + "x" + std::to_string(size.v) + " cells";
  if (size.u < 1 || size.v < 1) {
    text::refuse(cells, "a grid has at least one column and one row", "write, for example, 32x32");
  }
  const std::uint64_t each = static_cast<std::uint64_t>(size.u) * static_cast<std::uint64_t>(size.v);
  if (each * (regions > 0 ? 1 : 0) <= kMostReceivers / std::max<std::uint64_t>(regions, 1)) return;
  text::refuse(cells + " on " + text::counted(regions, "region"),
               "the limit is " + std::to_string(kMostReceivers) + " cells in total",
               "use fewer cells or a smaller patch");
}

}  // namespace

std::vector<Receiver> grid_receivers(const Scene& scene, std::span<const Region> on, GridSize size, GridIds ids) {
  const kernel::StandardArithmetic arithmetic;
  check_grid_size(size, on.size());
  std::vector<Receiver> receivers;
  const auto columns = static_cast<std::size_t>(size.u), rows = static_cast<std::size_t>(size.v);
  kernel::Steps cells("receivers", columns * rows * on.size());
  for (const Region& region : on) {
    const bool needs_face = ids == GridIds::kUnique && on.size() > 1;
    RegionGrid(scene, region, size, needs_face ? numbered_name_of(scene, region.faces.front()) + '/' : "", cells)
        .append_to(receivers);
  }
  return receivers;
}

std::vector<Receiver> grid_receivers(const Scene& scene, const Selection& on, GridSize size) {
  return grid_receivers(scene, regions(scene, on), size);
}

std::vector<Receiver> grid_receivers(const Scene& scene, std::span<const FaceId> on, GridSize size, GridIds ids) {
  return grid_receivers(scene, lone_regions(scene, on), size, ids);
}

}  // namespace exactff
