// Grids of receivers on faces.
//
// The centres of u x v cells on a face, in exact arithmetic, each rounded once at the end. Corners are p_i relative to
// the first one, n is the Newell vector.
//   1. A convex quadrilateral (no holes; convex seen along n): the bilinear map at ((2i+1)/2u, (2j+1)/2v).
//   2. Any other face: its bounding rectangle along e and f, the frame of face_plane.h.
//   3. Of the centres of step 2, keep those strictly inside.
#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "exactff/error.h"
#include "exactff/receiver.h"
#include "kernel/float_environment.h"
#include "receivers/face_plane.h"
#include "text/numbered_name.h"
#include "text/phrases.h"

namespace exactff {
namespace {

using kernel::ExactVec3;
using kernel::Integer;
using kernel::Rational;

// The receivers of one face.
class FaceGrid {
 public:
  FaceGrid(const Scene& scene, FaceId id, GridSize size, std::string prefix)
      : face_(scene.face(id)), id_(id), size_(size), prefix_(std::move(prefix)), plane_(scene, id) {}

  void append_to(std::vector<Receiver>& receivers) const {
    plane_.is_convex_quadrilateral() ? append_bilinear(receivers) : append_rectangle(receivers);
  }

 private:
  void append_bilinear(std::vector<Receiver>& receivers) const {
    const std::vector<ExactVec3>& p = plane_.points().at;
    const Integer whole = Integer(4) * size_.u * size_.v;
    for (int row = 1; row <= size_.v; ++row) {
      for (int column = 1; column <= size_.u; ++column) {
        const Integer s = 2 * column - 1, t = 2 * row - 1;
        const Integer s_rest = 2 * size_.u - s, t_rest = 2 * size_.v - t;
        const ExactVec3 sum = p[0] * Integer(s_rest * t_rest) + p[1] * Integer(s * t_rest) + p[2] * Integer(s * t) +
                              p[3] * Integer(s_rest * t);
        append(receivers, {quotient(sum.x, whole), quotient(sum.y, whole), quotient(sum.z, whole)}, column, row);
      }
    }
  }

  void append(std::vector<Receiver>& receivers, const std::array<Rational, 3>& at, int column, int row) const {
    Receiver receiver;
    receiver.point = plane_.rounded(at);
    receiver.normal = face_.newell;
    receiver.on = {id_};
    receiver.id = prefix_ + std::to_string(column) + ',' + std::to_string(row);
    receivers.push_back(std::move(receiver));
  }

  void append_rectangle(std::vector<Receiver>& receivers) const {
    const FaceFrame frame(plane_);
    const Mean mean = mean_of(frame);
    const auto [a_min, a_max] = std::minmax_element(frame.a().begin(), frame.a().end());
    const auto [b_min, b_max] = std::minmax_element(frame.b().begin(), frame.b().end());
    for (int row = 1; row <= size_.v; ++row) {
      // Multiplies (a, b) by 2u and 2v: the centres are then integers.
      const FaceFrame::Coordinate b{*b_min * (2 * size_.v) + (*b_max - *b_min) * (2 * row - 1), 2 * size_.v};
      for (int column = 1; column <= size_.u; ++column) {
        const FaceFrame::Coordinate a{*a_min * (2 * size_.u) + (*a_max - *a_min) * (2 * column - 1), 2 * size_.u};
        if (frame.strictly_inside(a, b)) append(receivers, point_at(frame, mean, a, b), column, row);
      }
    }
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
    mean.count = static_cast<unsigned long>(plane_.points().size());
    for (const ExactVec3& p : plane_.points().at) mean.p = mean.p + p;
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

  const Face& face_;
  FaceId id_;
  GridSize size_;
  std::string prefix_;
  FacePlane plane_;
};

bool parse_count(std::string_view text, int& value) {
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc{} && end.ptr == text.data() + text.size();
}

void check_grid_size(GridSize size, std::size_t faces) {
  const std::string cells = "a grid of " + std::to_string(size.u) + "x" + std::to_string(size.v) + " cells";
  if (size.u < 1 || size.v < 1) {
    throw InputError({.what = cells,
                      .why = "a grid has at least one column and one row",
                      .suggestion = "write, for example, 32x32"});
  }
  const std::uint64_t per_face = static_cast<std::uint64_t>(size.u) * static_cast<std::uint64_t>(size.v);
  if (per_face * (faces > 0 ? 1 : 0) <= kMostReceivers / std::max<std::uint64_t>(faces, 1)) return;
  throw InputError({.what = cells + " on " + text::counted(faces, "face"),
                    .why = "the limit is " + std::to_string(kMostReceivers) + " cells in total",
                    .suggestion = "use fewer cells or a smaller patch"});
}

// The text after "NAME:k/", or the whole id if it has no such prefix.
std::string_view without_face(std::string_view id) {
  const std::size_t slash = id.rfind('/');
  if (slash == std::string_view::npos || !text::numbered_name(id.substr(0, slash))) return id;
  return id.substr(slash + 1);
}

}  // namespace

std::vector<Receiver> grid_receivers(const Scene& scene, std::span<const FaceId> on, GridSize size, GridIds ids) {
  const kernel::StandardArithmetic arithmetic;
  const auto faces = static_cast<std::size_t>(
      std::count_if(on.begin(), on.end(), [&](FaceId face) { return scene.face(face).piece_count > 0; }));
  check_grid_size(size, faces);
  std::vector<Receiver> receivers;
  for (const FaceId face : on) {
    if (scene.face(face).piece_count == 0) continue;
    const bool needs_face = ids == GridIds::kUnique && faces > 1;
    const std::string prefix = needs_face ? scene.name_of(Selection{scene.face(face).patch, face}) + '/' : "";
    FaceGrid(scene, face, size, prefix).append_to(receivers);
  }
  return receivers;
}

std::vector<Receiver> grid_receivers(const Scene& scene, const Selection& on, GridSize size) {
  return grid_receivers(scene, scene.faces_of(on), size);
}

std::optional<GridCell> grid_cell(const Receiver& receiver) {
  const std::string_view id = without_face(receiver.id);
  const std::size_t comma = id.find(',');
  GridCell cell;
  if (receiver.on.empty() || comma == std::string_view::npos) return std::nullopt;
  if (!parse_count(id.substr(0, comma), cell.column) || !parse_count(id.substr(comma + 1), cell.row)) {
    return std::nullopt;
  }
  cell.face = receiver.on.front();
  return cell.column >= 1 && cell.row >= 1 ? std::optional(cell) : std::nullopt;
}

}  // namespace exactff
