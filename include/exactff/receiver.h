// Receivers: the points, with normals, for which form factors are computed.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/scene.h"

namespace exactff {

// A set of faces on which one lattice of receivers lies: faces of one patch that share edges, whose fronts agree, and
// that deviate from one plane by at most 1e-6 of the set's diameter. A lone face is a region as well.
struct Region {
  std::vector<FaceId> faces;  // ascending
};

// The regions of faces, by their first face. Every face with area belongs to exactly one.
[[nodiscard]] std::vector<Region> regions(const Scene& scene, std::span<const FaceId> faces);
// The regions of a patch; of a selected face, that face alone.
[[nodiscard]] std::vector<Region> regions(const Scene& scene, const Selection& selection);

// "NAME" for all faces with area of a patch, otherwise "NAME:1+2"; of more than four faces "NAME:1+2+3+...".
[[nodiscard]] std::string name_of(const Scene& scene, const Region& region);

struct GridSize {
  int u = 1;
  int v = 1;
};

// A grid of cells on a region. On a convex quadrilateral its cells are those of the bilinear map; otherwise those of
// the bounding rectangle.
struct Lattice {
  Region region;
  GridSize size;
  double width = 0.0;   // along u, in the scene's unit; of a quadrilateral: the side between its first two corners
  double height = 0.0;  // along v
  // Of the quadrilateral or the bounding rectangle, each rounded once: where u and v are (0, 0), (1, 0), (1, 1), (0,
  // 1).
  std::array<Vec3, 4> corners;
  // The corners of a convex outline that is no quadrilateral, each rounded once; empty for any other one. It cuts
  // cells.
  std::vector<Vec3> convex_outline;
};

// The cell with the receiver at its centre; column and row count from 1.
struct GridCell {
  std::shared_ptr<const Lattice> lattice;
  int column = 1;  // along u
  int row = 1;     // along v
};

// A point with a normal of any non-zero length. `on` holds the receiver's own faces: those of one patch that it lies
// on. The receiver counts as lying in their planes, although its rounded point lies slightly above or below: no face
// that lies exactly in the plane of an own face occludes or illuminates it, of whatever patch and whichever way it
// faces.
//
// An own face that is not planar is its triangles. The receiver lies on the one whose area holds the point's
// perpendicular projection onto its plane; of several on the one with the nearest plane, and of equals on the first. If
// none holds it, the nearest plane decides. The other triangles occlude and illuminate, so values are those of the
// scene with the triangles as faces, to the last bit.
//
// Its reflectance is that of the first own face. A receiver without own faces excludes nothing.
struct Receiver {
  Vec3 point;
  Vec3 normal;
  std::vector<FaceId> on;                       // distinct
  std::string id;                               // from a CSV row, or as described at the generators below; may be empty
  std::optional<GridCell> cell = std::nullopt;  // of a receiver that grid_receivers made
};

// The face of a solid that stands on the receiver's own face (Scene, "Buried"). The receiver must look from the front
// of its own face, and its projection along the face's normal must lie in the open interior of what is buried; and no
// other own face may hold it from the front and not be buried there. Such a receiver sees nothing: all form factors are
// 0. Exact.
[[nodiscard]] std::optional<FaceId> buried_under(const Scene& scene, const Receiver& receiver);
// Whether any part of any face is buried.
[[nodiscard]] bool some_is_buried(const Scene& scene);

// The own faces that a text names: "NAME" (a patch of one face), "NAME:k", or "NAME:1+2" for several faces of a patch.
// A patch whose name is exactly the text has priority. Throws InputError.
[[nodiscard]] std::vector<FaceId> own_faces_named(const Scene& scene, std::string_view name);

// The faces that a receiver given by coordinates was probably meant to lie on. A diagnosis: no value depends on it.
struct NearFaces {
  std::vector<FaceId> faces;  // of one patch, the best one first; empty if there is none
  double distance = 0.0;      // of the point from the plane of the first one, in the scene's unit; an estimate
  int side = 0;               // exact: 1 if the point is in front of the first one, -1 if behind it, 0 if in its plane
  bool turned = false;        // the receiver's normal points away from the front of the first one
};

// Faces that the point lies on or within the tolerance of, and whose normals agree with the receiver's within a degree,
// either way. The first one is chosen by an agreeing normal, then by distance, then by index. Added are the other faces
// of its patch for which the same holds and whose fronts agree with its front. Faces with a side below 2^-300 of the
// scene's largest coordinate may be missed. kAny: whatever the normals are; the one that agrees best comes first, of
// those with fronts on the receiver's side if there are any.
enum class Normals { kAgree, kAny };
[[nodiscard]] NearFaces find_faces(const Scene& scene, const Receiver& receiver, double tolerance,
                                   Normals normals = Normals::kAgree);

// A tolerance for find_faces: the largest of 1e-6 of the scene's diameter, two units in the last place of the largest
// coordinate in single precision, and one unit of the last decimal of the point, but of the last at most 1e-3 of the
// diameter.
[[nodiscard]] double face_tolerance(const Scene& scene, const Vec3& point);

// Gives each receiver without own faces those of find_faces, with face_tolerance if there is no tolerance. Returns the
// indices of the receivers that found none.
std::vector<std::size_t> place_on_faces(const Scene& scene, std::span<Receiver> receivers,
                                        std::optional<double> tolerance = {});

// Receivers that were probably meant to lie on a face, and do not; receivers that look away from the front of the face
// that they lie on; and those that lie behind another face. A diagnosis, by find_faces with face_tolerance.
struct NearMisses {
  std::size_t behind = 0;    // a face that then hides everything
  std::size_t in_front = 0;  // of a face, which is then not their own
  std::size_t turned = 0;    // their normals point away from the front of their own face
  // Behind a face that lies nearly, but not exactly, in the plane of their own face, and then hides everything.
  std::size_t hidden = 0;
  std::string mends_hidden = {};   // "--transparent NAME": the faces that hide them; empty if it would be long
  double furthest = 0.0;           // from the face, of those behind it and in front of it
  std::vector<std::string> first;  // a few of them in words, those behind a face first: "'7', 3.1e-07 behind 'floor:2'"

  [[nodiscard]] bool none() const { return behind + in_front + turned + hidden == 0; }
};
[[nodiscard]] NearMisses near_misses(const Scene& scene, std::span<const Receiver> receivers);
// What the near misses are, what follows, and what to do; one sentence each. `noun`: what the receivers are called.
[[nodiscard]] std::vector<std::string> sentences(const NearMisses& misses, std::size_t receivers,
                                                 std::string_view noun = "receiver");

// The middle of each piece of the faces, and a point near each of its corners, with the normal of the piece. Computed
// in doubles. No ids.
[[nodiscard]] std::vector<Receiver> probe_receivers(const Scene& scene, std::span<const FaceId> on);

// The largest number of receivers that a generator makes; a larger one is most likely a mistake. Beyond it they throw
// InputError.
inline constexpr std::uint64_t kMostReceivers = std::uint64_t{1} << 22;

// The id of a cell is "r7c12": row 7, column 12, counted from 1. On several regions these ids repeat; kUnique then puts
// the region's first face before them: "NAME:k/r7c12".
enum class GridIds { kCells, kUnique };

// Receivers at the cell centres of a u x v grid on each of the regions. The outline of a region is that of its faces
// together, without corners that lie within 1e-6 of its size of a straight side. It begins at the first corner of the
// face with the lowest index that lies on it, or, if this corner is on a straight side, at the beginning of that side.
// If the outline is a convex quadrilateral, the grid is that of its bilinear map. On any other outline it is the grid
// of the bounding rectangle in the plane of the Newell vector (u along the first edge, v = Newell x u), and only
// centres inside are kept. Computed rationally and rounded once. u runs fastest.
//
// On a region of several faces each centre is put on the face under it along the outline's Newell vector, the first one
// if there are two. The receiver has that face's normal and stores it first, then the faces of find_faces with
// face_tolerance. So one floor gives the same receivers, however it is cut into faces: to the last bit if it is exactly
// planar and begins at the same corner, else to rounding.
//
// On a face that is not planar, too, each centre is put on the triangle under it, whose normal the receiver has. Where
// rounding leaves it behind another triangle of the face, beside a fold, it is moved to the front by a few roundings.
// Throws InputError if a count is below 1 or there are too many cells.
[[nodiscard]] std::vector<Receiver> grid_receivers(const Scene& scene, std::span<const Region> on, GridSize size,
                                                   GridIds ids = GridIds::kCells);
// A grid on each region of a patch, or on the selected face alone.
[[nodiscard]] std::vector<Receiver> grid_receivers(const Scene& scene, const Selection& on, GridSize size);
// A grid on each face, which keeps its own frame.
[[nodiscard]] std::vector<Receiver> grid_receivers(const Scene& scene, std::span<const FaceId> on, GridSize size,
                                                   GridIds ids = GridIds::kCells);

// The following functions make receivers on distinct faces; faces without area get none. Each receiver stores its face
// and has the face's Newell vector as its normal, on a face that is not planar that of its triangle. No two have the
// same id. The same call gives the same bits on
// every machine.

// One receiver exactly at each corner of each face, so that a vertex where faces meet has one receiver with each of
// their normals. The id is "NAME:k/v": corner v of face NAME:k, counted from 1 through all rings in order
// (Face::rings). If a face visits a position again, as where a keyhole leads to a hole, the repeated corner is counted
// but gets no second receiver.
[[nodiscard]] std::vector<Receiver> vertex_receivers(const Scene& scene, std::span<const FaceId> on);

// One receiver in the middle of each region, with the id "NAME:k" of its first face. It lies at the mean of the corners
// of the outline if that is convex; otherwise at the centroid of the area; and if that is not strictly inside the
// outline, at the mean of the corners of the largest convex piece. Decided exactly, computed rationally and rounded
// once. On a region of several faces, and on a face that is not planar, it is put on the face under it, as by
// grid_receivers.
[[nodiscard]] std::vector<Receiver> centre_receivers(const Scene& scene, std::span<const Region> on);
// One receiver in the middle of each face.
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
