// Receivers: the points, with normals, for which form factors are computed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// A point with a normal of any non-zero length. `on` holds the receiver's own faces: those of one patch that it lies
// on. They (all their pieces) neither occlude nor illuminate the point, because the rounded point lies slightly above
// or below them. Its reflectance is that of the first. A receiver without own faces excludes nothing.
struct Receiver {
  Vec3 point;
  Vec3 normal;
  std::vector<FaceId> on;  // distinct
  std::string id;          // from a CSV row, or as described at the generators below; may be empty
};

// The own faces that a text names: "NAME" (a patch of one face), "NAME:k", or "NAME:1+2" for several faces of a patch.
// A patch whose name is exactly the text has priority. Throws InputError.
[[nodiscard]] std::vector<FaceId> own_faces_named(const Scene& scene, std::string_view name);

// The largest number of receivers that a generator makes; a larger one is most likely a mistake. Beyond it they throw
// InputError.
inline constexpr std::uint64_t kMostReceivers = std::uint64_t{1} << 22;

// The grid cell with the receiver at its centre; column and row count from 1.
struct GridCell {
  FaceId face{};
  int column = 1;  // along u
  int row = 1;     // along v
};

struct GridSize {
  int u = 1;
  int v = 1;
};

// The id of a cell is "column,row", counted from 1. On several faces these ids repeat; kUnique then puts the face
// before them: "NAME:k/column,row".
enum class GridIds { kCells, kUnique };

// Receivers at the cell centres of a u x v grid on each of the faces. On a convex quadrilateral the grid is that of its
// bilinear map. On any other face it is the grid of the bounding rectangle in the face's plane (u along the first edge,
// v = Newell x u), and only centres inside the face are kept. Computed rationally and rounded once; the normal is the
// face's Newell vector. u runs fastest.
// If a face is not planar: the quadrilateral's map is then a curved patch through all four corners, and the rectangle
// lies in the plane through the mean of the vertices with the Newell vector as its normal. In both cases the point may
// lie off the face's triangles; the receiver stores the face all the same. Throws InputError if a count is below 1 or
// there are too many cells.
[[nodiscard]] std::vector<Receiver> grid_receivers(const Scene& scene, std::span<const FaceId> on, GridSize size,
                                                   GridIds ids = GridIds::kCells);
[[nodiscard]] std::vector<Receiver> grid_receivers(const Scene& scene, const Selection& on, GridSize size);

// The cell of a receiver that lies on a face and has an id in the format of grid_receivers; otherwise empty.
[[nodiscard]] std::optional<GridCell> grid_cell(const Receiver& receiver);

// The following functions make receivers on distinct faces; faces without area get none. Each receiver stores its face
// and has the face's Newell vector as its normal, and no two have the same id. The same call gives the same bits on
// every machine.

// One receiver exactly at each corner of each face, so that a vertex where faces meet has one receiver with each of
// their normals. The id is "NAME:k/v": corner v of face NAME:k, counted from 1 through all rings in order
// (Face::rings). If a face visits a position again, as where a keyhole leads to a hole, the repeated corner is counted
// but gets no second receiver.
[[nodiscard]] std::vector<Receiver> vertex_receivers(const Scene& scene, std::span<const FaceId> on);

// One receiver in the middle of each face, with the id "NAME:k". It lies at the mean of the corners if the face is
// convex; otherwise at the centroid of the area; and if that is not strictly inside the face, at the mean of the
// corners of the largest convex piece. Decided exactly, computed rationally and rounded once. A face that is not planar
// is treated as seen along its Newell vector; the point may lie off its triangles, and the receiver stores the face all
// the same.
[[nodiscard]] std::vector<Receiver> centre_receivers(const Scene& scene, std::span<const FaceId> on);

// `count` receivers drawn independently. Each lies strictly inside a triangle of a convex piece; the probability of a
// triangle is proportional to its area, over all the faces together. Computed exactly and rounded once. The ids are
// "1", "2", ...; the first receivers do not depend on how many follow. Shares and positions are uniform to within 2^-62
// of the whole. On a face that is not convex, the points that a seed gives depend on how the face was cut into pieces.
// Throws InputError if no face has area, or if the count is below 1 or above kMostReceivers.
[[nodiscard]] std::vector<Receiver> sample_receivers(const Scene& scene, std::span<const FaceId> on,
                                                     std::uint64_t count, std::uint64_t seed);

// Reads a CSV with the header id,x,y,z,nx,ny,nz,on (`on` empty or NAME:K; the columns id and on may be absent; any
// order). Fields may be quoted. Empty lines and lines that begin with # are ignored. Numbers are read with correct
// rounding. A truth file (truth.h) is such a file, too: rows for several sources give one receiver. Throws one
// InputError with file:line for every problem.
[[nodiscard]] std::vector<Receiver> read_receivers(const std::filesystem::path& path, const Scene& scene);
// As above, from an open stream, called `name` in messages.
[[nodiscard]] std::vector<Receiver> read_receivers(std::istream& in, const std::string& name, const Scene& scene);

// The distance of a point from a face's bounding box or from its plane, whichever is larger, over the box's diagonal:
// an estimate, to find mistyped coordinates. For a face that is not planar, its own deviation is subtracted.
[[nodiscard]] double relative_distance_from_face(const Scene& scene, FaceId face, const Vec3& point);

}  // namespace exactff
