// A second, independent computation of the exact form factor, slow and simple. It shares only the vertices and rings of
// the scene with the solver: no CGAL, no convex pieces, no shaft, no projection, no merging, another closed form.
#pragma once

#include <gmpxx.h>

#include <optional>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff::validation {

// One oriented plane of the source.
struct OraclePlane {
  std::vector<FaceId> faces;   // ascending; includes those in whose plane the receiver lies, which contribute nothing
  mpq_class visible_fraction;  // visible area / area of the union of the faces, exact
};

struct OracleResult {
  double value = 0.0;          // F, correctly rounded
  bool zero = false;           // F is exactly 0
  std::string decimals = "0";  // 30 significant digits of F, correctly rounded; "0" if zero
  mpq_class low = 0;           // low <= F <= high, within 2^-100 F
  mpq_class high = 0;
  double visible_fraction = 0.0;  // visible area / area of all planes, correctly rounded; 0 if there is none
  std::vector<OraclePlane> planes;
};

// For each piece of the scene, whether it lies in the plane of an own face of the receiver (Receiver::on) and so
// neither hides nor illuminates it. Exact.
[[nodiscard]] std::vector<bool> own_pieces(const Scene& scene, const Receiver& receiver);

// Exact. The time grows with the number of fragments: intended for up to some dozens of occluders.
[[nodiscard]] OracleResult oracle(const Scene& scene, const Receiver& receiver, const Selection& source);

// The same for another measure than the form factor, except that fractions are of what counts: what lies above z's
// horizon, too, if the sky is overcast, and on both sides of a sphere.
[[nodiscard]] OracleResult oracle(const Scene& scene, const Receiver& receiver, const Selection& source,
                                  const Measure& measure);

// What moves: the receiver, or the vertices at one place.
struct OracleMovement {
  std::optional<Vec3> place;
  Vec3 along;
};

// The slope of F on the side of the movement, with more than 30 digits, rounded: the difference between F here and
// after a step of 2^-400 along it. Coordinates should be of moderate size.
[[nodiscard]] double oracle_slope(const Scene& scene, const Receiver& receiver, const Selection& source,
                                  const OracleMovement& movement);

}  // namespace exactff::validation
