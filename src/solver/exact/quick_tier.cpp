#include "exact/quick_tier.h"

#include <limits>

namespace exactff::exact {

using contour::QuickContour;
using contour::QuickCorner;
using contour::QuickPiece;
using visibility::Arc;
using visibility::ArcCorner;
using visibility::ArcLine;

namespace {

QuickCorner quick_corner(const ArcSection& seen, const ArcCorner& corner) {
  if (corner.is_vertex()) return contour::quick_corner(seen.vertices[corner.p], seen.x, seen.scale_exponent);
  return corner.is_fine ? seen.fine[corner.constructed] : contour::quick_corner(seen.exactly[corner.constructed]);
}

}  // namespace

void QuickTier::start(const Vec3& normal) {
  contour_ = QuickContour(normal);
  declined_ = some_count_ = some_are_unsure_ = false;
  uses_measure_ = false;
  sum_ = {};
}

void QuickTier::add(const ArcSection& seen, const Measure& measure) {
  if (seen.empty()) return;
  if (!seen.is_by_edges()) {
    declined_ = some_are_unsure_ = true;
    return;
  }
  if (measure.is_form_factor()) return for_each_batch(seen, [&] { contour_.add(pieces_, lines_); });
  find_terms(seen, measure, terms_);
  std::array<Bounded, 4> sums{};  // four, so that an addition need not wait for the one before
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const Bounded& term = terms_[i];
    sums[i % 4] = sums[i % 4] + term;
    some_count_ = some_count_ || (term.error > 0.0 && std::isfinite(term.error));
    some_are_unsure_ = some_are_unsure_ || !std::isfinite(term.error);
  }
  sum_ = sum_ + ((sums[0] + sums[1]) + (sums[2] + sums[3]));
}

// Neighbouring arcs share lines, so recent lines are worth keeping; all lines together would not fit into the cache.
// Calls take() after each batch.
template <class Take>
void QuickTier::for_each_batch(const ArcSection& seen, const Take& take) {
  static_assert(Arc::kAtA == QuickPiece::kAtA && Arc::kAtB == QuickPiece::kAtB);
  constexpr std::size_t kBatch = 64, kMostLines = 8192;
  corners_.clear();
  forget_lines();
  if (seen.arcs.size() <= kBatch) {  // one batch, with the numbers that its lines have already
    pieces_.clear();
    for (const Arc& arc : seen.arcs) pieces_.push_back({arc.line, arc.begin, arc.end});
    for (const ArcLine& line : seen.lines) edges_.push_back({line.a, line.b});
    for (const ArcCorner& corner : seen.corners) corners_.push_back(quick_corner(seen, corner));
    make_lines();
    return take();
  }
  line_index_.clear(seen.lines.size());
  const auto end = [&](std::uint32_t line) { return line < Arc::kAtA ? number_of_line(seen, line) : line; };
  for (std::span<const Arc> arcs = seen.arcs; !arcs.empty();) {
    if (edges_.size() >= kMostLines) forget_lines();
    // a. Number the lines of a batch.
    const std::size_t count = std::min(kBatch, arcs.size());
    pieces_.clear();
    for (const Arc& arc : arcs.first(count)) {
      pieces_.push_back({number_of_line(seen, arc.line), end(arc.begin), end(arc.end)});
    }
    // b. Make the lines that are new.
    make_lines();
    // c. Add the arcs.
    take();
    arcs = arcs.subspan(count);
  }
}

void QuickTier::find_terms(const ArcSection& seen, const Measure& measure, std::vector<Bounded>& terms) {
  uses_measure_ = !measure.is_form_factor();
  if (uses_measure_) {
    contour_ = QuickContour(seen.n);
    if (!measure_.is_of(measure, seen.n)) measure_ = contour::QuickMeasure(measure, seen.n);
  }
  terms.resize(seen.arcs.size());
  std::size_t done = 0;
  for_each_batch(seen, [&] {
    const auto part = std::span(terms).subspan(done, pieces_.size());
    if (uses_measure_) {
      measure_.find_terms(pieces_, lines_, part);
    } else {
      contour_.find_terms(pieces_, lines_, part);
    }
    done += pieces_.size();
  });
}

// Corners are numbered in the order in which lines are first requested.
std::uint32_t QuickTier::number_of_line(const ArcSection& seen, std::uint32_t line) {
  const auto [number, is_new] = line_index_.find(line);
  if (is_new) {
    const auto& [a, b, outline, whole] = seen.lines[line];
    edges_.push_back({a, b});
    while (corners_.size() <= std::max(a, b)) corners_.push_back(quick_corner(seen, seen.corners[corners_.size()]));
  }
  return number;
}

void QuickTier::make_lines() {
  if (lines_.size() < edges_.size()) lines_.resize(edges_.size());
  contour_.make_lines(corners_, std::span(edges_).subspan(made_), std::span(lines_).subspan(made_));
  made_ = edges_.size();
}

void QuickTier::forget_lines() {
  edges_.clear();
  made_ = 0;
  line_index_.restart();
}

Ball QuickTier::ball(const Bounded& sum) const {
  const QuickContour::Value value = uses_measure_ ? measure_.value(sum) : contour_.value(sum);
  return kernel::ball_around(value.hi, value.lo, value.error);
}

Ball QuickTier::ball() const {
  const QuickContour::Value value = uses_measure_ ? measure_.value(sum_) : contour_.value();
  return kernel::ball_around(value.hi, value.lo, declined_ ? std::numeric_limits<double>::infinity() : value.error);
}

}  // namespace exactff::exact
