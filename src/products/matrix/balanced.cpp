#include "matrix/balanced.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/double_double.h"
#include "kernel/float_environment.h"
#include "matrix/rows.h"
#include "scene/selections.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::matrix {
namespace {

using Numbers = std::vector<double>;

constexpr double kFirstAdded = 1e-3, kLeastAdded = 1e-8, kMostAdded = 1.0;  // to the diagonal, of all widths in a row
constexpr double kSmallResidual = 1e-9;                                     // of conjugate gradients, relative
constexpr double kBalancedRow = 0x1p-52;                                    // what rounding can still make up for
constexpr double kMendable = 0x1p-42;                                       // what walks can still make up for
constexpr double kFurthestRow = 0x1p-51;                                    // the bound that is promised
constexpr double kProofMargin = 0x1p-40;                                    // of a sum of products with areas, relative
constexpr int kMostSteps = 200, kMostIterations = 400, kMostHalvings = 50, kMostDoublings = 60;
constexpr double kFar = 100.0;  // so many steps at once may lead on for ever
constexpr int kUlpsToChooseFrom = 3, kUlpsToSearch = 1 << 12, kMostMoves = 64;

// A sum with what its roundings lost (Neumaier).
class Total {
 public:
  void add(double x) {
    const double sum = sum_ + x;
    lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  [[nodiscard]] double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0.0, lost_ = 0.0;
};

// A sum without any rounding: doubles of decreasing size whose bits do not overlap (Shewchuk).
class ExactSum {
 public:
  void add(double x) {
    std::size_t kept = 0;
    for (const double part : parts_) {
      const auto sum = kernel::double_double::two_sum(x, part);
      x = sum.hi;
      if (sum.lo != 0.0) parts_[kept++] = sum.lo;
    }
    parts_.resize(kept);
    parts_.push_back(x);
  }
  [[nodiscard]] double value() const { return std::accumulate(parts_.begin(), parts_.end(), 0.0); }
  // At least its absolute value; at most an ulp more.
  [[nodiscard]] double size() const { return parts_.size() > 1 ? kernel::above(std::abs(value())) : std::abs(value()); }

 private:
  std::vector<double> parts_;  // the largest one is the last
};

// Where the entries of one row alone are, and their doubles.
struct Rest {
  std::vector<ViewFactor> Matrix::*given;
  std::vector<double> Balanced::*rounded;
};
constexpr std::array<Rest, 3> kRests{
    {{&Matrix::back, &Balanced::back}, {&Matrix::open, &Balanced::open}, {&Matrix::buried, &Balanced::buried}}};

// An entry, or the two of a pair. Rows are numbered in the order of their names; first == second: of one row alone.
struct Term {
  std::uint32_t first = 0, second = 0;
  const Rest* place = nullptr;                   // null: among the patches
  double lower = 0.0, value = 0.0, upper = 0.0;  // of X

  [[nodiscard]] bool is_pair() const { return first != second; }
  [[nodiscard]] double width() const { return upper - lower; }
  [[nodiscard]] double unclipped(const Numbers& l) const { return value + width() * (l[first] + l[second]); }
  [[nodiscard]] double at(const Numbers& l) const { return std::clamp(unclipped(l), lower, upper); }
};

double dot(const Numbers& a, const Numbers& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

struct Interval {
  double lower, upper;
};
Interval common(Interval a, Interval b) { return {std::max(a.lower, b.lower), std::min(a.upper, b.upper)}; }
Interval times(double area, const ViewFactor& f, double slack = 0.0) {
  return {area * f.lower * (1.0 - slack), area * f.upper * (1.0 + slack)};
}

class Balancing {
 public:
  Balancing(const Matrix& matrix, std::span<const std::string> names) : matrix_(matrix), given_(names.size()) {
    std::iota(given_.begin(), given_.end(), std::size_t{0});
    std::ranges::stable_sort(given_, {}, [&](std::size_t row) -> const std::string& { return names[row]; });
    double largest = 0.0;
    for (std::size_t i = 0; i < size(); ++i) largest = std::max(largest, matrix.factors.at(i, 0).area_from);
    const double scale = std::scalbn(1.0, -std::ilogb(largest));
    for (const std::size_t row : given_) areas_.push_back(matrix.factors.at(row, 0).area_from * scale);
    for (std::uint32_t i = 0; i < size(); ++i) add_terms_of(i);
    widths_.resize(size());
    for (const Term& term : terms_) {
      widths_[term.first] += 2.0 * term.width();
      if (term.is_pair()) widths_[term.second] += 2.0 * term.width();
    }
  }

  Balanced solve() {
    if (result_.apart.empty()) {
      const Numbers l = multipliers();
      if (!l.empty()) round(l);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::size_t size() const { return given_.size(); }
  [[nodiscard]] const ViewFactor& factor(std::uint32_t i, std::uint32_t j) const {
    return matrix_.factors.at(given_[i], given_[j]);
  }

  void add_terms_of(std::uint32_t i) {
    const auto add_single = [&](const ViewFactor& f, const Rest* place) {
      const auto [lower, upper] = times(areas_[i], f);
      if (upper > 0.0) terms_.push_back({i, i, place, lower, areas_[i] * f.value, upper});
    };
    add_single(factor(i, i), nullptr);
    for (std::uint32_t j = i + 1; j < size(); ++j) add_pair(i, j);
    for (const Rest& rest : kRests) {
      if (const auto& column = matrix_.*rest.given; !column.empty()) add_single(column[given_[i]], &rest);
    }
  }

  // By the areas as doubles if that is possible, else by all areas that round to them.
  void add_pair(std::uint32_t i, std::uint32_t j) {
    const ViewFactor &forth = factor(i, j), &back = factor(j, i);
    if (forth.upper == 0.0 && back.upper == 0.0) return;
    Interval bounds = common(times(areas_[i], forth), times(areas_[j], back));
    if (bounds.lower > bounds.upper) {
      bounds = common(times(areas_[i], forth, 2.0 * kRoundedAreas), times(areas_[j], back, 2.0 * kRoundedAreas));
    }
    if (bounds.lower > bounds.upper) {
      result_.apart.push_back({std::min(given_[i], given_[j]), std::max(given_[i], given_[j])});
      result_.claim = weaker(result_.claim, weaker(forth.claim, back.claim));
      return;
    }
    const double value = 0.5 * (areas_[i] * forth.value + areas_[j] * back.value);
    terms_.push_back({i, j, nullptr, bounds.lower, value, bounds.upper});
  }

  // --- Steps 1 to 3 ---

  // G(l).
  [[nodiscard]] Numbers excess(const Numbers& l) const {
    std::vector<Total> sums(size());
    for (std::size_t i = 0; i < size(); ++i) sums[i].add(-areas_[i]);
    for (const Term& term : terms_) {
      const double x = term.at(l);
      sums[term.first].add(x);
      if (term.is_pair()) sums[term.second].add(x);
    }
    Numbers result;
    for (const Total& sum : sums) result.push_back(sum.value());
    return result;
  }

  // Of all rows, as shares of their areas.
  [[nodiscard]] double furthest(const Numbers& excess) const {
    double most = 0.0;
    for (std::size_t i = 0; i < size(); ++i) most = std::max(most, std::abs(excess[i]) / areas_[i]);
    return most;
  }

  // The multipliers of the solution; empty if there is none, or if none is found.
  Numbers multipliers() {
    Numbers l(size()), g = excess(l), best;
    double least = std::numeric_limits<double>::infinity(), added = kFirstAdded;
    for (int steps = 0; steps < kMostSteps; ++steps) {
      const double now = furthest(g);
      if (now < least) best = l;
      if (now <= kBalancedRow || (now >= 0.5 * least && least < 1e-13)) break;
      least = std::min(least, now);
      const Numbers s = newton_step(l, g, added);
      const double t = advance(l, g, s);

      added = t < 1.0 ? std::min(10.0 * added, kMostAdded) : std::max(0.1 * added, kLeastAdded);
      if ((t == 0.0 || t > kFar) && prove(s)) return {};
      if (t == 0.0) break;
    }
    if (furthest(excess(best)) <= kMendable) return best;
    (void)prove(l);
    return {};
  }

  [[nodiscard]] Numbers newton_step(const Numbers& l, const Numbers& g, double share) const {
    struct Free {
      std::uint32_t first, second;
      double width;
    };
    std::vector<Free> free;
    Numbers diagonal = widths_;
    for (double& entry : diagonal) entry = entry > 0.0 ? share * entry : 1.0;
    const Numbers added = diagonal;
    for (const Term& term : terms_) {
      const double x = term.unclipped(l), width = term.width();
      if (width == 0.0 || x < term.lower || x > term.upper) continue;
      free.push_back({term.first, term.second, width});
      diagonal[term.first] += term.is_pair() ? width : 2.0 * width;
      if (term.is_pair()) diagonal[term.second] += width;
    }
    const auto apply = [&](const Numbers& p, Numbers& result) {
      for (std::size_t i = 0; i < size(); ++i) result[i] = added[i] * p[i];
      for (const Free& one : free) {
        const double x = one.width * (p[one.first] + p[one.second]);
        result[one.first] += x;
        if (one.first != one.second) result[one.second] += x;
      }
    };
    // Conjugate gradients, preconditioned by the diagonal.
    Numbers s(size()), r(size()), z(size()), p(size()), q(size());
    for (std::size_t i = 0; i < size(); ++i) r[i] = -g[i];
    const auto precondition = [&] {
      for (std::size_t i = 0; i < size(); ++i) z[i] = r[i] / diagonal[i];
    };
    precondition();
    p = z;
    double rz = dot(r, z);
    const double small = kSmallResidual * kSmallResidual * rz;
    for (int k = 0; k < kMostIterations && rz > small; ++k) {
      apply(p, q);
      const double a = rz / dot(p, q);
      if (!std::isfinite(a)) break;
      for (std::size_t i = 0; i < size(); ++i) {
        s[i] += a * p[i];
        r[i] -= a * q[i];
      }
      precondition();
      const double before = std::exchange(rz, dot(r, z));
      for (std::size_t i = 0; i < size(); ++i) p[i] = z[i] + (rz / before) * p[i];
    }
    return s;
  }

  // Moves to l + t s, where s . G is at most half of what it is now. Returns t, or 0 if it never is.
  double advance(Numbers& l, Numbers& g, const Numbers& s) const {
    const double slope = dot(s, g);
    if (!(slope < 0.0)) return 0.0;
    Numbers at(size()), there;
    const auto slope_at = [&](double t) {
      for (std::size_t i = 0; i < size(); ++i) at[i] = l[i] + t * s[i];
      there = excess(at);
      return dot(s, there);
    };
    double t = 1.0, low = 0.0, high = 0.0, now = slope_at(t);
    for (int k = 0; now < 0.5 * slope && k < kMostDoublings; ++k) now = slope_at(t = 2.0 * std::exchange(low, t));
    if (now < 0.5 * slope) return 0.0;
    high = t;
    for (int k = 0; (now < 0.5 * slope || now > -0.01 * slope) && k < kMostHalvings; ++k) {
      t = 0.5 * (low + high);
      now = slope_at(t);
      (now < 0.0 ? low : high) = t;
    }
    l = at;
    g = there;
    return t;
  }

  // --- Step 3 ---

  // The sum over rows of y_i A_i, less the most that y can have of any X within the bounds, and the sum of the sizes of
  // all terms of this.
  struct Gap {
    double gap, size;
    [[nodiscard]] bool is_proof() const { return gap > kProofMargin * size; }
  };
  [[nodiscard]] Gap gap(const Numbers& y) const {
    Total gap;
    double size_of_all = 0.0;
    const auto add = [&](double x) {
      gap.add(x);
      size_of_all += std::abs(x);
    };
    for (std::size_t i = 0; i < size(); ++i) add(y[i] * areas_[i]);
    for (const Term& term : terms_) {
      const double both = term.is_pair() ? y[term.first] + y[term.second] : y[term.first];
      if (both != 0.0) add(-both * (both > 0.0 ? term.upper : term.lower));
    }
    return {gap.value(), size_of_all};
  }

  // Looks for few rows that prove it: one, then those of the largest components.
  bool prove(const Numbers& direction) {
    double most = 0.0;
    for (const double one : direction) most = std::max(most, std::abs(one));
    Numbers y(size());
    std::optional<Gap> best;
    const auto consider = [&](const Numbers& candidate) {
      const Gap found = gap(candidate);
      if (!found.is_proof()) return false;
      best = found;
      y = candidate;
      return true;
    };
    const Gap all = gap(direction);
    for (const double threshold : {0.9, 0.5, 0.25, 0.1, 1e-2, 1e-3, 1e-5, 1e-7}) {
      Numbers signs(size());
      for (std::size_t i = 0; i < size(); ++i) {
        if (std::abs(direction[i]) >= threshold * most && most > 0.0) signs[i] = direction[i] < 0.0 ? -1.0 : 1.0;
      }
      if (consider(signs)) break;
    }
    if (!best && all.is_proof()) consider(direction);
    if (!best) return false;
    leave_out_rows(y);
    Total areas;
    for (std::size_t i = 0; i < size(); ++i) {
      if (y[i] == 0.0) continue;
      areas.add(std::abs(y[i]) * areas_[i]);
      (y[i] > 0.0 ? result_.lacking : result_.exceeding).push_back(given_[i]);
      set_claim(i);
    }
    result_.gap = gap(y).gap / areas.value();
    std::ranges::sort(result_.lacking);
    std::ranges::sort(result_.exceeding);
    return true;
  }

  // Of a few rows, those that the proof does not need.
  void leave_out_rows(Numbers& y) const {
    constexpr std::ptrdiff_t kFew = 64;
    if (std::ranges::count_if(y, [](double one) { return one != 0.0; }) > kFew) return;
    for (double& one : y) {
      const double before = std::exchange(one, 0.0);
      if (before != 0.0 && !gap(y).is_proof()) one = before;
    }
  }

  void set_claim(std::size_t i) {
    const auto take = [&](const ViewFactor& f) { result_.claim = weaker(result_.claim, f.claim); };
    for (std::size_t j = 0; j < size(); ++j) take(matrix_.factors.at(given_[i], j));
    for (const auto* column : {&matrix_.back, &matrix_.open}) {
      if (!column->empty()) take((*column)[given_[i]]);
    }
  }

  // --- Step 4 ---

  // Two doubles for a pair, or one and 0.
  struct Choice {
    double forth = 0.0, back = 0.0;
  };

  void round(const Numbers& l) {
    std::vector<std::uint32_t> order(terms_.size());
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    Numbers x;
    for (const Term& term : terms_) x.push_back(term.at(l));
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) { return x[a] != x[b] ? x[a] > x[b] : a < b; });
    lacks_ = excess(l);
    for (std::size_t i = 0; i < size(); ++i) lacks_[i] = -lacks_[i] / areas_[i];
    result_.entries.assign(size() * size(), 0.0);
    for (const Rest& rest : kRests) (result_.*rest.rounded).assign((matrix_.*rest.given).size(), 0.0);
    for (const std::uint32_t k : order) round_term(terms_[k], x[k]);
    for (std::uint32_t i = 0; i < size(); ++i) lacks_[i] = -row_sum(i, -1.0).value();
    for (std::uint32_t i = 0; i < size(); ++i) mend(i);
    for (std::uint32_t i = 0; i < size(); ++i) result_.furthest = std::max(result_.furthest, row_sum(i, -1.0).size());
    if (result_.furthest > kFurthestRow) result_ = {};
  }

  // Where the entries of a term are.
  double& forth(const Term& term) {
    const std::size_t i = given_[term.first];
    return term.place == nullptr ? result_.entries[i * size() + given_[term.second]]
                                 : (result_.*term.place->rounded)[i];
  }
  double& back(const Term& term) { return result_.entries[given_[term.second] * size() + given_[term.first]]; }

  [[nodiscard]] ExactSum row_sum(std::uint32_t i, double first) {
    ExactSum sum;
    sum.add(first);
    for (std::size_t j = 0; j < size(); ++j) sum.add(result_.entries[given_[i] * size() + j]);
    for (const Rest& rest : kRests) {
      if (const Numbers& rounded = result_.*rest.rounded; !rounded.empty()) sum.add(rounded[given_[i]]);
    }
    return sum;
  }

  [[nodiscard]] static bool holds(const ViewFactor& f, double value) { return f.lower <= value && value <= f.upper; }

  // The doubles within a few ulps of x that are products with both areas; the next such ones, if there is none so near.
  template <class Visit>
  void for_each_choice(const Term& term, double x, const Visit& visit) const {
    const double a = areas_[term.first], b = areas_[term.second];
    const ViewFactor &forth = factor(term.first, term.second), &back = factor(term.second, term.first);
    for (const bool inside : {true, false}) {
      bool any = false;
      const auto consider = [&](double product) {
        const Choice c{product / a, product / b};
        if (c.forth * a != product || c.back * b != product) return;
        if (inside && !(holds(forth, c.forth) && holds(back, c.back))) return;
        any = true;
        visit(c);
      };
      consider(x);
      double up = x, down = x;
      for (int k = 0; k < (any ? kUlpsToChooseFrom : kUlpsToSearch); ++k) {
        consider(up = kernel::above(up));
        consider(down = kernel::below(down));
      }
      if (any) return;
    }
  }

  // The choice that leaves the rows least to make up for.
  void round_term(const Term& term, double x) {
    const double a = areas_[term.first], b = areas_[term.second];
    if (!term.is_pair()) {
      const ViewFactor& f = single(term);
      forth(term) = std::clamp(x / a, f.lower, f.upper);
      // What the row lacks, too, as long as it is a rounding.
      const double with_rest = std::clamp((x / a) + lacks_[term.first], f.lower, f.upper);
      if (std::abs(with_rest - forth(term)) <= 8.0 * kBalancedRow * x / a) forth(term) = with_rest;
      lacks_[term.first] -= std::fma(forth(term), a, -x) / a;
      return;
    }
    if (x == 0.0) return;
    double least = std::numeric_limits<double>::infinity();
    std::array<double, 2> lacks{lacks_[term.first], lacks_[term.second]};
    for_each_choice(term, x, [&](const Choice& c) {
      const double of_first = lacks_[term.first] - std::fma(c.forth, a, -x) / a,
                   of_second = lacks_[term.second] - std::fma(c.back, b, -x) / b;
      const double left = of_first * of_first + of_second * of_second;
      if (left >= least) return;
      least = left;
      forth(term) = c.forth, back(term) = c.back;
      lacks = {of_first, of_second};
    });
    lacks_[term.first] = lacks[0], lacks_[term.second] = lacks[1];
  }

  [[nodiscard]] const ViewFactor& single(const Term& term) const {
    return term.place == nullptr ? factor(term.first, term.first) : (matrix_.*term.place->given)[given_[term.first]];
  }

  // --- Step 5 ---

  struct Move {
    const Term* term = nullptr;
    Choice choice = {};
    double here = 0.0, there = 0.0;  // what the two rows then lack
  };

  // Moves one entry of a row by ulps so that it lacks no more than one, then one of the row of its other direction, ...
  void mend(std::uint32_t row) {
    const auto excess = [](double lack) { return std::max(0.0, std::abs(lack) - kBalancedRow); };
    const Term* last = nullptr;
    for (int moves = 0; moves < kMostMoves && excess(lacks_[row]) > 0.0; ++moves) {
      Move best{.here = lacks_[row], .there = std::numeric_limits<double>::infinity()};
      const auto consider = [&](const Move& move) {
        const double here = excess(move.here), before = excess(best.here);
        if (here < before || (here == before && excess(move.there) < excess(best.there))) best = move;
      };
      for (const Term& term : terms_) {
        const bool is_first = term.first == row;
        if ((!is_first && term.second != row) || &term == last) continue;
        const double f = forth(term);
        if (!term.is_pair()) {
          const double moved = std::clamp(f + lacks_[row], single(term).lower, single(term).upper);
          consider({&term, {moved, 0.0}, lacks_[row] - (moved - f), 0.0});
        } else if (f > 0.0) {
          const double g = back(term);
          const double wanted = (f * areas_[term.first]) + (lacks_[row] * areas_[row]);
          for_each_choice(term, std::clamp(wanted, term.lower, term.upper), [&](const Choice& c) {
            const double of_first = lacks_[term.first] - (c.forth - f), of_second = lacks_[term.second] - (c.back - g);
            consider({&term, c, is_first ? of_first : of_second, is_first ? of_second : of_first});
          });
        }
      }
      if (best.term == nullptr) return;
      last = best.term;
      forth(*last) = best.choice.forth;
      lacks_[row] = best.here;
      if (!last->is_pair()) return;
      back(*last) = best.choice.back;
      const std::uint32_t other = last->first == row ? last->second : last->first;
      lacks_[other] = best.there;
      if (excess(best.here) == 0.0) row = other;
    }
  }

  const Matrix& matrix_;
  std::vector<std::size_t> given_;  // of each row here, its row in the matrix
  Numbers areas_;                   // times a power of two
  std::vector<Term> terms_;
  Numbers widths_;  // twice the sums of them, of each row
  Numbers lacks_;   // of each row, in steps 4 and 5: what its sum is short of 1
  Balanced result_;
};

constexpr std::size_t kMostNamed = 6;

// "the rows of a, b and 3 others"
std::string words_of_rows(const Scene& scene, const Matrix& matrix, const std::vector<std::size_t>& rows) {
  std::vector<std::string> names;
  for (std::size_t k = 0; k < std::min(rows.size(), kMostNamed); ++k) {
    names.push_back(text::in_quotes(scene.name_of(matrix.factors.from[rows[k]])));
  }
  if (rows.size() > kMostNamed) names.push_back(text::counted(rows.size() - kMostNamed, "other"));
  return (rows.size() == 1 ? "the row of " : "the rows of ") + text::enumerate(names);
}

std::string words_of_proof(const Scene& scene, const Matrix& matrix, const Balanced& balanced) {
  const bool is_one = balanced.lacking.size() + balanced.exceeding.size() == 1;
  const std::string off = " by " + text::short_number(balanced.gap, 2) + (is_one ? "" : " of their areas");
  const std::string lacking = words_of_rows(scene, matrix, balanced.lacking),
                    exceeding = words_of_rows(scene, matrix, balanced.exceeding);
  const std::string misses = is_one ? " misses 1" : " together miss 1";
  if (balanced.exceeding.empty()) return lacking + misses + off + ", even if all entries are at their upper bounds";
  if (balanced.lacking.empty()) return exceeding + misses + off + ", even if all entries are at their lower bounds";
  return "with reciprocity, " + lacking + " need more light than " + exceeding + " have to give, and together miss 1" +
         off + " by all bounds";
}

}  // namespace

Balanced balanced_of(const Matrix& matrix, std::span<const std::string> names) {
  return Balancing(matrix, names).solve();
}

void require_balanceable(const Scene& scene, const Matrix& matrix) {
  const Factors& all = matrix.factors;
  if (all.from.empty() || all.from != all.to) {
    text::refuse("the matrix has not the same patches as rows and as columns",
                 "a balanced matrix has both of each pair", "give --from and --to the same patches, or neither");
  }
  if (const std::vector<std::string> reasons = reasons_against_one(scene, matrix); !reasons.empty()) {
    text::refuse("rows need not add up to 1: " + text::enumerate(reasons),
                 "a balanced matrix has rows that add up to 1",
                 "compute all patches with backs and the sky, and mend or cut out what overlaps or is transparent");
  }
}

Balanced balanced(const Scene& scene, const Matrix& matrix) {
  const kernel::StandardArithmetic arithmetic;
  require_balanceable(scene, matrix);
  return balanced_of(matrix, names_of(scene, matrix.factors.from));
}

std::vector<Problem> problems_of(const Scene& scene, const Matrix& matrix, const Balanced& balanced) {
  if (balanced.is_found()) return {};
  if (!balanced.is_impossible()) {
    return {{.what = "no balanced matrix was found, nor a proof that there is none",
             .why =
                 "with roundings some row misses 1 by more than 2^-51, as the bounds leave next to nothing to choose "
                 "from, or two groups of patches see only each other",
             .suggestion = "compute the matrix with a larger --accuracy"}};
  }
  const bool is_proved = balanced.claim != Claim::kEstimated;
  const std::string why = is_proved ? "these bounds are proved, so one does not hold, or the file was changed"
                                    : "an estimated entry misses its interval, or a bound does not hold";
  const std::string suggestion = is_proved ? "please report the scene" : "compute the matrix with --certify";
  std::vector<Problem> problems;
  for (const Balanced::Pair& pair : balanced.apart) {
    problems.push_back({.what = "there is no balanced matrix: the two directions between " +
                                text::in_quotes(scene.name_of(matrix.factors.from[pair.row])) + " and " +
                                text::in_quotes(scene.name_of(matrix.factors.to[pair.column])) +
                                " have no number in common",
                        .why = why,
                        .suggestion = suggestion});
  }
  if (problems.empty()) {
    problems.push_back({.what = "there is no balanced matrix: " + words_of_proof(scene, matrix, balanced),
                        .why = why,
                        .suggestion = suggestion});
  }
  return problems;
}

Matrix with_values(Matrix matrix, const Balanced& balanced) {
  const auto take = [](std::vector<ViewFactor>& factors, const Numbers& values) {
    for (std::size_t k = 0; k < factors.size(); ++k) factors[k].value = values[k];
  };
  take(matrix.factors.entries, balanced.entries);
  for (const Rest& rest : kRests) take(matrix.*rest.given, balanced.*rest.rounded);
  return matrix;
}

}  // namespace exactff::matrix
