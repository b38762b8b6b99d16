// A second opinion on the exact form factor, slow and simple. It shares nothing with the solver but the scene's
// vertices and rings: no CGAL, no convex pieces, no shaft, no projection, no merging, another closed form.
#pragma once

#include <gmpxx.h>

#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"

namespace exactff::validation {

// One oriented plane of the source.
struct OraclePlane {
  std::vector<FaceId> faces;   // ascending; the face that the receiver lies on too, which shows nothing
  mpq_class visible_fraction;  // visible area over the area of the union of the faces, exactly
};

struct OracleResult {
  double value = 0.0;          // F, correctly rounded
  bool zero = false;           // F is exactly 0
  std::string decimals = "0";  // 30 significant digits of F, correctly rounded; "0" if zero
  mpq_class low = 0;           // low <= F <= high, within 2^-100 F
  mpq_class high = 0;
  double visible_fraction = 0.0;  // visible area over the area of all planes, correctly rounded; 0 if there is none
  std::vector<OraclePlane> planes;
};

// Exact. Time grows with the number of fragments: meant for up to some dozens of occluders.
[[nodiscard]] OracleResult oracle(const Scene& scene, const Receiver& receiver, const Selection& source);

}  // namespace exactff::validation
