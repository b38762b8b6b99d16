// The mean over strata of a function of which nothing is known but its ranges.
//
// The function lies in [0, R_s] on stratum s, which has the share w_s of the area. Two independent numbers a_s and b_s
// are drawn in each. Their mean is a sum of independent terms X_i, which are w_s a_s / 2 and w_s b_s / 2. They lie in
// [0, r] with r = max w_s R_s / 2. Each term has a guess p_i in [0, r] that does not depend on it: for a_s one from
// before the look, for b_s what a_s says. Let Q be the sum of (X_i - p_i)^2. For any L and any c in [0, 1) that do not
// depend on the numbers, each of
//
//   mean >= sum X_i - e   and   mean <= sum X_i + e,   e = (r L + psi Q / r) / c,   psi = -log(1 - c) - c,
//
// holds but with a probability of at most exp(-L). No stratum is believed for agreeing with itself: even with Q = 0, e
// is more than r L. No interval that holds for all such functions can be narrower by much. Without any number that
// meets it, a function may have a mean of r L: a share p_s of each stratum goes unmet with a probability of exp(-2 sum
// p_s).
//
// Proof (Fan, Grama, Liu, "Exponential inequalities for martingales with applications", Electron. J. Probab. 20, 2015;
// Howard, Ramdas, McAuliffe, Sekhon, "Time-uniform, nonparametric, nonasymptotic confidence sequences", Ann. Stat. 49,
// 2021). (log(1 + y) - y) / y^2 increases with y > -1. So for x >= -1, y = c x is at least -c, and
// exp(c x - psi x^2) <= 1 + c x. With x = (X_i - p_i) / r, and m_i the mean of X_i,
//
//   E exp(c (X_i - p_i) / r - psi (X_i - p_i)^2 / r^2) <= 1 + c (m_i - p_i) / r <= exp(c (m_i - p_i) / r),
//
// so E exp(c (X_i - m_i) / r - psi (X_i - p_i)^2 / r^2) <= 1, whatever came before. The product over all terms has a
// mean of at most 1, too, and exceeds exp(L) with a probability of at most exp(-L) (Markov's inequality). The same
// holds for x = (p_i - X_i) / r. Where the draws of a stratum lie in different halves of it, their m_i differ, but add
// up to what they should.
#pragma once

namespace exactff::view_factors {

struct StratifiedMean {
  // Of the square, from before the look. It chooses c; the worse it is, the larger is the error.
  double expected = 0.0;
  double value = 0.0;
  double square = 0.0;  // Q

  // The numbers of a stratum with this share of the area, and the guess of the first one, all within its range.
  void add(double a, double b, double guess, double share);
  // e. The mean of the function lies within it of the value, but with a probability of at most `risk`. `largest`: of
  // all ranges times shares.
  [[nodiscard]] double error(double largest, double risk) const;
};

}  // namespace exactff::view_factors
