// Exact classification of one face: is it planar, is it convex, and what are its convex pieces? Also triangles of faces
// that are not planar, and of pieces.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exactff/scene.h"
#include "scene/face_points.h"

namespace exactff {

using Ring = std::vector<std::uint32_t>;

// The reason why a face cannot be used; completes a sentence that begins with the face's name.
struct FaceFault {
  std::string what;
  std::string why;
  std::string suggestion;
};

struct ConvexPart {
  std::vector<std::uint32_t> corners;  // vertex indices, counter-clockwise seen from the front
  std::array<std::uint32_t, 3> frame;  // three of them, in order, not on a line
};

struct CutFace {
  FaceShape shape = FaceShape::kPlanar;
  std::vector<Ring> rings;        // consecutive vertices at one position dropped
  std::vector<ConvexPart> parts;  // empty unless planar or triangulated
  Vec3 newell;                    // see Face
  double area = 0.0;
  double out_of_plane = 0.0;
  std::optional<FaceFault> fault;  // then shape is kSkipped
};

// Exact in every decision. An exactly planar face keeps its shape and is cut into convex parts, as few as merging a
// constrained triangulation gives. A face that is not planar is cut into triangles by the rule of clip_ears.
// Requires valid indices and finite coordinates; the rings are otherwise arbitrary.
CutFace cut_face(std::span<const Vec3> vertices, const std::vector<Ring>& rings);

// --- Ear clipping ---

// Triangles for a polygon that is not exactly planar, by a rule that depends only on the polygon.

using TriangleIndices = std::array<std::size_t, 3>;

// A quadrilateral takes the valid diagonal that holds the vertex of lowest index; a larger polygon is clipped ear
// by ear, each time the valid ear whose tip has the lowest index. Valid: seen along the Newell vector, both
// triangles (the ear) run counter-clockwise, and no vertex that could hide behind the ear's base lies in the
// closed ear, unless at the position of one of its corners. `index` gives each point's index in the file.
// Start and direction of the ring do not matter. Empty if no valid diagonal or ear is left.
std::optional<std::vector<TriangleIndices>> clip_ears(const PlanePoints& plane, std::span<const std::uint32_t> index);

// --- Triangles ---

// The triangles of a piece of a face.

// Vertex indices, at the corners of the piece and counter-clockwise from the front. They cover the piece exactly.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> triangles_of(const Scene& scene, const Piece& piece);

}  // namespace exactff
