#include "visibility/edge_parameters.h"

namespace exactff::visibility {

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
  const int order = cmp(product_p_, product_q_);
  return order < 0 ? -1 : order > 0 ? 1 : 0;
}

}  // namespace exactff::visibility
