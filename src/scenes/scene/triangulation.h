// Exact classification of one face: is it planar, is it convex, and what are its convex pieces?
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exactff/scene.h"

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
// constrained triangulation gives. A face that is not planar is cut into triangles by the rule of `ear_clipping.h`.
// Requires valid indices and finite coordinates; the rings are otherwise arbitrary.
CutFace cut_face(std::span<const Vec3> vertices, const std::vector<Ring>& rings);

}  // namespace exactff
