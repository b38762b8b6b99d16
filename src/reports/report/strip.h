// The pictures at the head of a scene's chapter: the scene under its direct light, exact and by a method, and the
// method's errors.
#pragma once

#include <optional>
#include <string>

#include "exactff/methods.h"
#include "report/studies.h"

namespace exactff::report {

// Three pictures side by side, as PNG files. No byte depends on a clock or the number of threads.
struct Strip {
  std::string exact, method, error;
  std::string method_name;
  bool is_base = false;  // the base setting of the sweeps
  std::string camera;    // as flags of exactff compare
  std::string outlined;  // the patches of the receivers; empty if they are not in the picture
  double scale = 0.0;    // the error of full colour, relative to the brightest pixel
  double rms = 0.0;      // relative to the brightest pixel
  double wrong = 0.0;    // share of the pixels that are wrong by over 10 %
};

// What the maps and the strip of a study show: the base setting of the sweeps, else the middle setting of the first
// method that is not exact. Nothing if the study has neither.
struct Shown {
  std::string title, name;
  methods::Choice choice;
  std::vector<double> errors;  // in radiosity, by receiver
};
[[nodiscard]] std::optional<Shown> shown_method(const Study& study);

// Renders the scene for about a second at most, by fixed prices of counted work: dear scenes get smaller pictures, and
// too dear ones none. Nothing is returned, and the reason added to `left_out`, if there is no picture. Call it after
// all times have been measured. Throws Cancelled.
[[nodiscard]] std::optional<Strip> strip_of(const Study& study, std::vector<LeftOut>& left_out, const Hooks& hooks);

}  // namespace exactff::report
