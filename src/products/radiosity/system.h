// One channel of B = E + rho F B, where of the matrix F bounds L <= F <= U are known. All are nonnegative; order and
// comparisons are meant entry by entry, and rho is a diagonal matrix.
//
// Method
// 1. Leave out the patches that no light reaches through positive entries of U: their B is 0.
// 2. Find z > 0 with (I - rho U) z > 0, by the solver for (I - rho U) z = 1.
// 3. Find w >= 0 with (I - rho U) w >= E, by the solver, then w + c z with the smallest c that is seen to suffice.
// 4. Find v >= 0 with (I - rho L) v <= E likewise, by v - c z, and E where that is less.
// 5. Take E + rho U w, rounded up, for w, and E + rho L v, rounded down, for v: one more bounce.
// Each inequality is checked with all roundings against it. The solver is believed in nothing. Then v <= B <= w for
// every F within the bounds.
//
// Proof (monotonicity: I - rho U is an M-matrix). Let L <= F <= U and T = rho F, so 0 <= T <= rho U.
// - By z: T z <= rho U z < z, so T z <= q z with some q < 1. For any x, |x| <= a z gives |T x| <= T |x| <= a q z.
//   So the sum S = I + T + T^2 + ... converges, S >= 0, S = (I - T)^-1, and B = S E is the only solution.
// - Upper: since w >= 0, T w <= rho U w, so (I - T) w >= (I - rho U) w >= E. Then w - B = S ((I - T) w - E) >= 0.
// - Lower: since v >= 0, T v >= rho L v, so (I - T) v <= (I - rho L) v <= E. Then B - v = S (E - (I - T) v) >= 0.
// - Step 4: if (I - rho L) y <= E, the same holds for v = max(y, E), since L v >= L y and L v >= 0: where y_i > E_i,
//   v_i - rho_i (L v)_i <= y_i - rho_i (L y)_i <= E_i; elsewhere, v_i = E_i.
// - Step 5: B = E + T B <= E + rho U w, and B >= E + rho L v.
// - Step 1: let R be the patches that are reached: those with E_i > 0, and each i with rho_i U_ij > 0 for some j of R.
//   Outside of R, all terms of E + T E + T^2 E + ... are 0. Those within R are the terms of the system of R alone.
// Since F = U gives B close to w, and F = L gives B close to v, the bounds are the best up to roundings.
//
// Source: A. Berman, R. J. Plemmons, "Nonnegative Matrices in the Mathematical Sciences", SIAM (1994), chapter 6.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "exactff/error.h"
#include "exactff/matrix.h"
#include "exactff/radiosity.h"
#include "exactff/scene.h"

namespace exactff::radiosity {

// Of a view factor: 0 <= lower <= value <= upper.
struct Entry {
  std::uint32_t column = 0;
  double lower = 0.0;
  double value = 0.0;
  double upper = 0.0;
};

// A square matrix, row by row, without the entries whose upper bound is 0.
class Factors {
 public:
  void add(const Entry& entry) { entries_.push_back(entry); }  // to the row that is not ended
  void end_row() { ends_.push_back(entries_.size()); }

  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  [[nodiscard]] std::span<const Entry> row(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : ends_[i - 1];
    return std::span(entries_).subspan(begin, ends_[i] - begin);
  }

 private:
  std::vector<Entry> entries_;
  std::vector<std::size_t> ends_;
};

using Numbers = std::vector<double>;

struct System {
  Factors factors;
  Numbers reflectances;  // rho
  Numbers emissions;     // E
};

// The inequalities of the proof. True only if they hold exactly.
[[nodiscard]] bool is_supersolution(const System& system, const Numbers& w);  // w >= 0, (I - rho U) w >= E
[[nodiscard]] bool is_subsolution(const System& system, const Numbers& v);    // v >= 0, (I - rho L) v <= E
[[nodiscard]] bool is_contracting(const System& system, const Numbers& z);    // z > 0, (I - rho U) z > 0

// Over a row, of the estimates, in plain doubles.
[[nodiscard]] double sum_of_values(std::span<const Entry> row, const Numbers& x);

// The matrix of what is exposed: means over the parts of patches that are not buried, and their areas. A patch that is
// buried as a whole sees nothing, and has no area. Refers to the given matrix if nothing is buried.
class Exposed {
 public:
  explicit Exposed(const matrix::Matrix& given);
  [[nodiscard]] const matrix::Matrix& matrix() const { return made_ ? *made_ : given_; }

 private:
  const matrix::Matrix& given_;
  std::optional<matrix::Matrix> made_;
};

// Why there is no bound, and what would give one.
[[nodiscard]] Problem problem_of_unbounded(const Scene& scene, const std::vector<Selection>& patches,
                                           const System& system);

// Of a channel (kChannelNames).
[[nodiscard]] System system_of(const Scene& scene, const matrix::Factors& factors, std::size_t channel);

// (I - rho F) x = b, approximately, where F takes one of the three numbers of each entry. Empty if no x of finite
// numbers with a small residual is found. Nothing that is proved depends on the result.
[[nodiscard]] Numbers approximate_solution(const System& system, double Entry::*number, const Numbers& b);

struct SolutionBounds {
  Numbers value;         // of the system with the entries' values, an estimate; empty: the solver found none
  Numbers lower, upper;  // of B; empty: z, or a double that is large enough, was not found
};
[[nodiscard]] SolutionBounds bounds_of(const System& system);
// The same where each emission, which is not negative, lies within bounds: B grows with it.
[[nodiscard]] SolutionBounds bounds_of(System system, std::span<const BoundedValue> emissions);
// F B of these; without estimates, their values are NaN.
[[nodiscard]] std::vector<BoundedValue> irradiances(const Factors& factors, const SolutionBounds& radiosities);
// Some reflectance is 1 or more. In a closed room of reflectance 1 there is no B that an estimate could be near; where
// there is no upper bound, this may be such a room.
[[nodiscard]] bool may_have_no_solution(const System& system);

}  // namespace exactff::radiosity
