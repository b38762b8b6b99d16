// View factors from patch to patch: how wide an entry is after which time, what is claimed of the entries of a closed
// room, and how far its rows are from 1.
#pragma once

#include <string>
#include <vector>

#include "exactff/matrix.h"
#include "exactff/view_factors.h"
#include "experiments/experiments.h"

namespace exactff::experiments {

struct ViewFactorSize {
  std::vector<double> accuracies = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10};
  double accuracy = 1e-6;    // of the room's matrix
  std::size_t budget = 200;  // cells of its entries: where they do not suffice, statistics are taken
};

// One entry, asked for at one accuracy.
struct WidthAtAccuracy {
  double accuracy = 0.0;
  double width = 0.0;
  double seconds = 0.0;
  std::size_t cells = 0;
};

struct WidthCurve {
  std::string name;
  Claim claim = Claim::kEstimated;
  std::vector<WidthAtAccuracy> places;
};

struct ViewFactorStudy {
  std::vector<WidthCurve> curves;
  std::vector<std::string> patches;  // of the room
  matrix::Factors matrix;
  std::vector<matrix::Sum> sums;  // of its rows: 1, since the room is closed
};

// Two unit squares, 1 apart, with a square of half the size in the middle between them: `below`, `above`, `plate`.
[[nodiscard]] Scene scene_of_plates();
// A room of 1 x 1 x 1 with a cube, tilted about all axes, in its middle: 12 patches.
[[nodiscard]] Scene scene_of_cube_in_room();

// "10⁻³" of a power of ten; of others, two digits.
[[nodiscard]] std::string accuracy_text(double accuracy);

[[nodiscard]] ViewFactorStudy view_factor_study(const ViewFactorSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result view_factors(const ViewFactorSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result view_factors(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
