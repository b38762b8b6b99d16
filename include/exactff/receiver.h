// Receivers: where and with which normal a form factor is asked for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// A point with a normal of any non-zero length. A receiver made on a face remembers it: that face, every
// piece of it, neither occludes nor illuminates the point, since the rounded point lies a hair above or
// below it. A receiver without `on` excludes nothing.
struct Receiver {
  Vec3 point;
  Vec3 normal;
  std::optional<FaceId> on;
  std::string id;  // of a CSV row, or as the generator below tells; may be empty
};

// Generators make at most so many receivers: more is hardly what anybody meant. InputError beyond.
inline constexpr std::uint64_t kMostReceivers = std::uint64_t{1} << 22;

// The grid cell that a receiver is the centre of; column and row count from 1.
struct GridCell {
  FaceId face{};
  int column = 1;  // along u
  int row = 1;     // along v
};

struct GridSize {
  int u = 1;
  int v = 1;
};

// A cell's id is "column,row", counted from 1. On several faces these repeat; kUnique then writes the face before them:
// "NAME:k/column,row".
enum class GridIds { kCells, kUnique };

// Cell centres of a u x v grid on each of the faces: of the bilinear map of a convex
// quadrilateral; else of its bounding rectangle in its plane (u along the first edge, v = Newell x u),
// keeping the centres inside the face. Computed rationally and rounded once; the normal is the face's
// Newell vector. u runs fastest.
// A face that is not planar: the quadrilateral's map is then a curved patch through all four corners; the
// rectangle lies in the plane through the mean of the vertices with the Newell vector as its normal. Either
// way the point may lie off the face's triangles, which it remembers nevertheless. Throws InputError where a
// count is below 1, or there are too many cells.
[[nodiscard]] std::vector<Receiver> grid_receivers(const Scene& scene, std::span<const FaceId> on, GridSize size,
                                                   GridIds ids = GridIds::kCells);
[[nodiscard]] std::vector<Receiver> grid_receivers(const Scene& scene, const Selection& on, GridSize size);

// The cell of a receiver that lies on a face and has an id as grid_receivers gives it; else nothing.
[[nodiscard]] std::optional<GridCell> grid_cell(const Receiver& receiver);

// The following make receivers on faces that differ from one another; faces without area get none. Each receiver
// remembers its face and carries its Newell vector, and no two have the same id. The same call gives the same bits on
// every machine.

// One receiver at each corner of each face, exactly there, so that a vertex where faces meet has one receiver with each
// of their normals. The id is "NAME:k/v": corner v of face NAME:k, counted from 1 through its rings one after the other
// (Face::rings). A position that a face visits again, as where a keyhole leads to a hole, counts and has no second
// receiver.
[[nodiscard]] std::vector<Receiver> vertex_receivers(const Scene& scene, std::span<const FaceId> on);

// One receiver in the middle of each face, with the id "NAME:k": at the mean of its corners if the face is convex; else
// at the centroid of its area; and where that is not strictly inside the face, at the mean of the corners of its
// largest convex piece. Decided exactly, computed rationally and rounded once. A face that is not planar is judged and
// weighed as seen along its Newell vector; the point may lie off its triangles, which it remembers nevertheless.
[[nodiscard]] std::vector<Receiver> centre_receivers(const Scene& scene, std::span<const FaceId> on);

// So many receivers drawn independently, each strictly inside a triangle of a convex piece with a probability as its
// area, over all the faces together; computed exactly and rounded once. The ids are "1", "2", ...; the first ones do
// not depend on how many follow. Shares and places are uniform to within 2^-62 of the whole. Which points a seed gives
// on a face that is not convex depends on how it was cut into pieces. Throws InputError where no face has area, or the
// count is below 1 or above kMostReceivers.
[[nodiscard]] std::vector<Receiver> sample_receivers(const Scene& scene, std::span<const FaceId> on,
                                                     std::uint64_t count, std::uint64_t seed);

// A CSV with the header id,x,y,z,nx,ny,nz,on (`on` empty or NAME:K; the columns id and on may be absent, and
// any order will do). Fields may be quoted; lines that are empty or begin with # are passed over. Numbers are
// read with correct rounding. Throws one InputError with file:line for everything wrong.
[[nodiscard]] std::vector<Receiver> read_receivers(const std::filesystem::path& path, const Scene& scene);

}  // namespace exactff
