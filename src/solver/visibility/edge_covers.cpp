#include "visibility/edge_covers.h"

namespace exactff::visibility {

using Edge = Outlines::Edge;
using Outline = Outlines::Outline;

// --- Edge parameters ---

const EdgeParameter& ExactParameters::of(Outlines& outlines, EdgeId edge, const Parameter& p) {
  static const EdgeParameter begin{1, 0}, end{0, 1};
  return p.line == Parameter::kAtBegin ? begin : p.line == Parameter::kAtEnd ? end : crossing(outlines, edge, p.line);
}

const EdgeParameter& ExactParameters::crossing(Outlines& outlines, EdgeId edge, EdgeId line) {
  std::uint32_t& at = stored_at_[4 * std::size_t{line} + edge % 4];
  if (at < count_ && stored_[at].edge == edge && stored_[at].line == line) return stored_[at].parameter;
  at = static_cast<std::uint32_t>(count_++);
  if (stored_.size() < count_) stored_.emplace_back();
  Stored& stored = stored_[at];
  stored.edge = edge;
  stored.line = line;
  auto& [l, m] = stored.parameter;
  outlines.set_exact_height(l, outlines.edge(line), outlines.edge(edge).b);
  outlines.set_exact_height(m, outlines.edge(line), outlines.edge(edge).a);
  mpz_abs(l.get_mpz_t(), l.get_mpz_t());
  mpz_abs(m.get_mpz_t(), m.get_mpz_t());
  return stored.parameter;
}

int ExactParameters::compare(Outlines& outlines, EdgeId edge, const Parameter& p, const Parameter& q) {
  if (p.line == Parameter::kAtBegin || q.line == Parameter::kAtEnd) return -1;
  if (p.line == Parameter::kAtEnd || q.line == Parameter::kAtBegin) return 1;
  const EdgeParameter &a = crossing(outlines, edge, p.line), &b = crossing(outlines, edge, q.line);
  product_p_ = a.m * b.l;
  product_q_ = b.m * a.l;
  return kernel::compare(product_p_, product_q_);
}

// --- Edge covers ---

// The exact signs of the heights of the edge's ends above the line, and the crossing if the signs differ.
//
// The crossing's error, in the notation of edge_covers.h. With heights in doubles: D >= 4e, so that the quotient
// differs by at most 2e / D; sum and division err by 2u, and 2^-50 is 8u, which leaves a margin for the test of D and
// for differences of parameters. With exact heights: two mantissas truncated to 53 bits and their quotient err by 5u of
// l / m, which moves m / (l + m) by less than 2u; two more roundings make 4u of at most 1, and 2^-49 is 16u. An
// exponent that is clamped moves it by less than 2^-1000.
Parameter EdgeCovers::crossing_of(EdgeId edge_id, EdgeId line) {
  const Edge edge = outlines_.edge(edge_id), f = outlines_.edge(line);
  const Height a = outlines_.height(f, edge.a), b = outlines_.height(f, edge.b);
  const double sum = std::abs(a.value) + std::abs(b.value), error = std::max(a.error, b.error);
  if (std::abs(a.value) > a.error && std::abs(b.value) > b.error && sum > 4.0 * error) {
    return {std::abs(a.value) / sum, rounded_up(2.0 * error / sum + 0x1p-50), line_[line]};
  }
  const EdgeParameter& at = exact_.crossing(outlines_, edge_id, line_[line]);
  long l_exponent = 0, m_exponent = 0;
  const double l_mantissa = mpz_get_d_2exp(&l_exponent, at.l.get_mpz_t());
  const double m_mantissa = mpz_get_d_2exp(&m_exponent, at.m.get_mpz_t());
  // In the scale of the doubles, which is that of the other crossings.
  const long exponent = l_exponent + outlines_.exponent(edge.b) - m_exponent - outlines_.exponent(edge.a);
  const double l_over_m = std::ldexp(l_mantissa / m_mantissa, static_cast<int>(std::clamp(exponent, -2000L, 2000L)));
  return {1.0 / (1.0 + l_over_m), 0x1p-49F, line_[line]};
}

void EdgeCovers::cut_exactly(EdgeId edge_id, EdgeId line, int& sign_a, int& sign_b, Parameter& crossing) {
  const Edge edge = outlines_.edge(edge_id), f = outlines_.edge(line);
  sign_a = outlines_.side(f, edge.a);
  sign_b = outlines_.side(f, edge.b);
  if (sign_a * sign_b < 0) crossing = crossing_of(edge_id, line);
}

bool EdgeCovers::lies_left(const Edge& edge, OutlineId outline) {
  for (const Edge& other : outlines_.edges_of(outlines_.outline(outline))) {
    const int side = outlines_.side(edge, other.a);
    if (side != 0) return side > 0;
  }
  return true;  // an outline without area: impossible
}

bool EdgeCovers::cover_exactly(EdgeId edge, OutlineId outline, Cover& result) {
  const Outline& o = outlines_.outline(outline);
  Interval& interval = result.interval;
  interval = {kBegin, kEnd};
  result.coincides = false;
  for (EdgeId line = o.first; line < o.first + o.count; ++line) {
    int sign_a = 0, sign_b = 0;
    Parameter crossing;
    cut_exactly(edge, line, sign_a, sign_b, crossing);
    if (sign_a <= 0 && sign_b <= 0) {
      if (sign_a < 0 || sign_b < 0) return false;
      result.coincides = true;
      continue;
    }
    if (sign_a < 0 && compare(edge, interval.begin, crossing) < 0) interval.begin = crossing;
    if (sign_b < 0 && compare(edge, crossing, interval.end) < 0) interval.end = crossing;
    if (compare(edge, interval.begin, interval.end) >= 0) return false;
  }
  const bool on_left = result.coincides && lies_left(outlines_.edge(edge), outline);
  result.left = !result.coincides || on_left;
  result.right = !result.coincides || !on_left;
  return true;
}

BoundaryPiece EdgeCovers::exact(const Part& part) {
  const Edge& edge = outlines_.edge(part.edge);
  const auto at = [&](const Parameter& p) { return exact_.of(outlines_, part.edge, p); };
  return {outlines_.exact(edge.a), outlines_.exact(edge.b), at(part.begin), at(part.end)};
}

}  // namespace exactff::visibility
