// Likely slips of modelling in a scene, and in a question about it. No value depends on anything here, so diagnoses may
// use estimates and tolerances. Each finding comes with numbers and, where there is one, with the flag that mends it.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/error.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff::slips {

enum class Kind {
  kNormals,            // normals in the file (vn) contradict the winding
  kInwardSurface,      // a closed surface looks inward, but encloses nothing, and there are faces outside
  kOutwardRoom,        // faces around a space look out of it, and would see more if they looked into it
  kUnseenFront,        // no other patch can see the front of a patch
  kEmitterLooksAway,   // nothing lies before the front of an emitter
  kDoubledFaces,       // two faces have the same corners and the same front
  kOppositeFaces,      // the same with opposite fronts, and the two are cut into other triangles
  kOverlappingFronts,  // fronts of different patches overlap in one plane, such as a window and its wall
  kNearlyCoplanar,     // likewise, but their planes are a rounding apart
  kOpenFloor,          // a closed solid stands on a face that belongs to no closed surface
  kNoBottom,           // a block stands on a face, and is closed but for its bottom
  kNearContact,        // a closed solid misses the plane of a face that it almost touches
  kOverlappingSolids,  // the insides of two closed solids overlap
  kScale,              // coordinates suggest a wrong unit
};
[[nodiscard]] std::string_view to_string(Kind kind);  // "unseen-front"
// kOpenFloor to kOverlappingSolids: what touches without being buried. That may well be meant.
[[nodiscard]] bool is_about_contacts(Kind kind);

struct Finding {
  Kind kind{};
  std::vector<Selection> objects = {};  // what it is about: patches, or faces of patches of which only some are meant
  std::string flag = {};                // what mends it: "--flip lamp"; empty if no flag does, or if it would be long
  Problem words = {};                   // words.message() is the sentence
};

// At most one finding of each kind, in the order of Kind. Transparent and flipped faces are taken as they are.
//
// kNormals, kDoubledFaces, kOppositeFaces: complete. kInwardSurface: from volumes and solid angles in doubles.
// kOutwardRoom: an estimate, from rays of both sides of all surfaces; nothing is said of more than 5,000 surfaces.
// kUnseenFront, kEmitterLooksAway: an estimate. Rays from a few points of a patch, and lines to the faces before it,
// look for one that another patch can see. A patch that can only be seen through narrow gaps may be reported. Parts of
// closed surfaces are not, unless they emit. The number of rays and lines in a scene is limited, so that 100,000 faces
// take about a second; patches beyond it are not reported.
//
// A flip is advised only after it was tried: by such rays, patches must then see each other that did not, and no fewer
// pairs in all, nor fewer of which one emits; and fronts must not look at more backs. A room is seen from inside: a
// closed surface that looks inward is reported only if a flip helps, and if an emitter, or more area than its own,
// comes into its sight. Where vn contradict the winding, which is evidence of its own, it suffices that no fewer pairs
// see each other; but where they contradict only some faces of a connected surface whose windings agree, no flip is
// advised. Faces are turned to the inside of a room, concave or not, if much less of the view is lost to backs and
// nothing, and if what else sees them does not become less. kUnseenFront and kEmitterLooksAway are told once no
// closed surface or room looks the wrong way.
//
// kOverlappingFronts, kNearlyCoplanar: as overlapping_fronts() says, without pairs of kDoubledFaces and those of
// surfaces that are reported as turned. The largest few are named.
//
// kOpenFloor: exact, but for slivers. kNoBottom, kNearContact, kOverlappingSolids: in doubles. Faces almost touch if
// they are at most a millionth of the scene's diameter apart. Solids that overlap by less are not reported.
[[nodiscard]] std::vector<Finding> diagnose(const Scene& scene);

// The findings about fronts that a --flip mends, in words: what a command says before it computes something else than
// is meant. The first leaves out kUnseenFront and kEmitterLooksAway; it takes less time, at most about a tenth of a
// second.
[[nodiscard]] std::vector<Problem> warnings_of_turned_surfaces(const Scene& scene);
[[nodiscard]] std::vector<Problem> warnings_of_fronts(const Scene& scene);

// What is buried of a patch by the solids that another patch belongs to (receiver.h: buried_under()).
struct Contact {
  Selection patch, under;
  double area = 0.0;   // in the square of the scene's unit of length; an estimate
  double share = 0.0;  // of the patch's area, at most 1
};
// The largest area first; empty if nothing is buried, or if coordinates are beyond 1e90. What two patches bury together
// counts for both.
[[nodiscard]] std::vector<Contact> buried_parts(const Scene& scene);

// Two patches or faces whose fronts lie on each other in one plane. Each has its full form factor there, so what sees
// them counts the common part twice.
struct Overlap {
  Selection smaller, larger;  // by area
  double area = 0.0;          // of the common part, in the square of the scene's unit of length; an estimate
  double apart = 0.0;         // the least distance, at most a millionth of a face's diameter; 0: exactly one plane
  bool doubled = false;       // all faces of the common part have the same corners
};
// Between the selections, the largest area first. Faces that only touch do not overlap, but for slivers of a millionth
// of the smaller face (of a ten-thousandth, if their planes differ). The time is near-linear in the number of faces,
// unless many lie on each other: after two million overlapping pieces no more are looked for.
[[nodiscard]] std::vector<Overlap> overlapping_fronts(const Scene& scene, std::span<const Selection> selections);
// What they are, what follows and what to do. Requires overlaps that are exactly in one plane, at least one.
[[nodiscard]] Problem warning_of_overlaps(const Scene& scene, std::span<const Overlap> overlaps);

// Receivers and a source for a first try: a patch or a face each.
struct FirstTry {
  Selection on;
  Selection source;
};
// The source emits if any patch does. Neither is without area, and they are not the same face. Prefers a pair that
// faces each other. Nothing if the scene has fewer than two faces with area.
[[nodiscard]] std::optional<FirstTry> first_try(const Scene& scene);

// "turn it round with --flip lamp", or, if that has been done, "leave out --flip for lamp". For a shell. Empty if fewer
// pairs of patches would then see each other, by the rays of diagnose().
[[nodiscard]] std::string advice_to_flip(const Scene& scene, std::span<const Selection> selections);

// Sources that are proved to give 0 at every receiver for a reason that suggests a slip: the receivers are behind the
// source, the source is below their horizon, or a face on which they lie hides it. One warning for each source, with
// counts and what to do. `sources` may be empty, for every patch that emits. A source on which all receivers lie is
// left out if there are others. Of more than 10,000 receivers, 10,000 are looked at.
[[nodiscard]] std::vector<Problem> warnings_of_dark_sources(const Scene& scene, std::span<const Receiver> receivers,
                                                            std::span<const Selection> sources);

}  // namespace exactff::slips
