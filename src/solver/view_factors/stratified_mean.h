// The mean over strata of a function of which nothing is known but how far it is, at most, from guesses.
//
// In each stratum, a few independent places are drawn. The function's mean is the sum of the means of independent terms
// X_i, each the function at a place times the share of the area that the place stands for. Each term has a guess p_i,
// a function of the place of which the mean is known, chosen before the place is drawn: it may depend on all that was
// drawn before. Let no |X_i - p_i| exceed r, wherever the place is, and let Q be the sum of
// (X_i - p_i)^2. For any L and any c in (0, 1), chosen like r before the places, each of
//
//   mean >= V - e   and   mean <= V + e,   V = sum (X_i - p_i + mean of p_i),   e = (r L + psi Q / r) / c,
//
// with psi = -log(1 - c) - c, holds but with a probability of at most exp(-L). No stratum is believed for agreeing with
// itself: even with Q = 0, e is more than r L. No interval that holds for all such functions can be narrower by much.
// Let two places be drawn in each stratum, of a function in [0, R]. Without any number that meets it, it may have a
// mean of r L: a share p_s of each stratum goes unmet with a probability of exp(-2 sum p_s).
//
// Proof (Fan, Grama, Liu, "Exponential inequalities for martingales with applications", Electron. J. Probab. 20, 2015;
// Howard, Ramdas, McAuliffe, Sekhon, "Time-uniform, nonparametric, nonasymptotic confidence sequences", Ann. Stat. 49,
// 2021). (log(1 + y) - y) / y^2 increases with y > -1. So for x >= -1, y = c x is at least -c, and
// exp(c x - psi x^2) <= 1 + c x. With x = (X_i - p_i) / r, and d_i its mean given what came before, times r,
//
//   E exp(c (X_i - p_i) / r - psi (X_i - p_i)^2 / r^2) <= 1 + c d_i / r <= exp(c d_i / r),
//
// so E exp(c (X_i - p_i - d_i) / r - psi (X_i - p_i)^2 / r^2) <= 1, whatever came before. The product over all terms
// has a mean of at most 1, too, and exceeds exp(L) with a probability of at most exp(-L) (Markov's inequality). The sum
// of X_i - p_i - d_i is V less the mean. The same holds for x = (p_i - X_i) / r. Where the draws of a stratum lie in
// different halves of it, the means of their X_i differ, but add up to what they should.
#pragma once

namespace exactff::view_factors {

struct StratifiedMean {
  // Of the square, from before the look. It chooses c; the worse it is, the larger is the error.
  double expected = 0.0;
  double value = 0.0;
  double square = 0.0;  // Q

  // A number, what was guessed at its place, and the mean of that guess; `share`: of the area, that it stands for.
  void add(double number, double guess, double mean_of_guess, double share);
  // e. The mean of the function lies within it of the value, but with a probability of at most `risk`.
  [[nodiscard]] double error(double r, double risk) const;
};

}  // namespace exactff::view_factors
