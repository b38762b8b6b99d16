#include "exact/quick_tier.h"

#include <limits>

namespace exactff::exact {

using contour::QuickContour;
using contour::QuickCorner;
using contour::QuickPiece;
using kernel::double_double::Bounded;
using visibility::CornerId;
using visibility::EdgeCovers;
using visibility::EdgeId;
using visibility::Outlines;
using visibility::Parameter;

namespace {

QuickCorner quick_corner(Outlines& outlines, CornerId id) {
  if (const auto vertex = outlines.vertex(id)) {
    return contour::quick_corner(outlines.position(*vertex), outlines.x(), outlines.scale_exponent());
  }
  if (const QuickCorner* fine = outlines.fine(id)) return *fine;
  return contour::quick_corner(outlines.exact(id));
}

}  // namespace

void QuickTier::start(const Vec3& normal) {
  contour_ = QuickContour(normal);
  declined_ = some_count_ = some_are_unsure_ = false;
  uses_measure_ = false;
  sum_ = {};
}

void QuickTier::add(const visibility::VisibleBoundary& boundary) {
  if (boundary.empty()) return;
  if (boundary.edges() == nullptr) {
    declined_ = true;
  } else {
    EdgeCovers& found = *boundary.edges();
    for_each_batch(found, found.parts(), [&] { contour_.add(pieces_, lines_); });
  }
}

void QuickTier::add(const visibility::VisibleBoundary& boundary, const Measure& measure, const Vec3& normal) {
  if (boundary.empty()) return;
  if (boundary.edges() == nullptr) {
    declined_ = some_are_unsure_ = true;
    return;
  }
  find_terms(*boundary.edges(), boundary.edges()->parts(), measure, normal, terms_);
  std::array<Bounded, 4> sums{};  // four, so that an addition need not wait for the one before
  for (std::size_t i = 0; i < terms_.size(); ++i) {
    const Bounded& term = terms_[i];
    sums[i % 4] = sums[i % 4] + term;
    some_count_ = some_count_ || (term.error > 0.0 && std::isfinite(term.error));
    some_are_unsure_ = some_are_unsure_ || !std::isfinite(term.error);
  }
  sum_ = sum_ + ((sums[0] + sums[1]) + (sums[2] + sums[3]));
}

// Neighbouring parts share lines, so recent lines are worth keeping; all lines together would not fit into the cache.
// Calls take() after each batch.
template <class Take>
void QuickTier::for_each_batch(EdgeCovers& found, std::span<const EdgeCovers::Part> parts, const Take& take) {
  static_assert(Parameter::kAtBegin == QuickPiece::kAtA && Parameter::kAtEnd == QuickPiece::kAtB);
  constexpr std::size_t kBatch = 64, kMostLines = 8192;
  Outlines& outlines = found.outlines();
  corners_.clear();
  corner_index_.clear(outlines.corner_count());
  line_index_.clear(outlines.edges().size());
  forget_lines();
  const auto end = [&](EdgeId line) { return line < Parameter::kAtBegin ? number_of_line(outlines, line) : line; };
  while (!parts.empty()) {
    if (edges_.size() >= kMostLines) forget_lines();
    // a. Number the lines and corners of a batch.
    const std::size_t count = std::min(kBatch, parts.size());
    pieces_.clear();
    for (const EdgeCovers::Part& part : parts.first(count)) {
      pieces_.push_back({number_of_line(outlines, part.edge), end(part.begin.line), end(part.end.line)});
    }
    // b. Make the lines that are new.
    make_lines();
    // c. Add the parts.
    take();
    parts = parts.subspan(count);
  }
}

void QuickTier::find_terms(EdgeCovers& found, std::span<const EdgeCovers::Part> parts, std::vector<Bounded>& terms) {
  terms.resize(parts.size());
  std::size_t done = 0;
  for_each_batch(found, parts, [&] {
    contour_.find_terms(pieces_, lines_, std::span(terms).subspan(done, pieces_.size()));
    done += pieces_.size();
  });
}

void QuickTier::find_terms(EdgeCovers& found, std::span<const EdgeCovers::Part> parts, const Measure& measure,
                           const Vec3& normal, std::vector<Bounded>& terms) {
  contour_ = QuickContour(normal);
  if (!measure_.is_of(measure, normal)) measure_ = contour::QuickMeasure(measure, normal);
  uses_measure_ = true;
  terms.resize(parts.size());
  std::size_t done = 0;
  for_each_batch(found, parts, [&] {
    measure_.find_terms(pieces_, lines_, std::span(terms).subspan(done, pieces_.size()));
    done += pieces_.size();
  });
}

std::uint32_t QuickTier::number_of_line(Outlines& outlines, EdgeId id) {
  const auto [number, is_new] = line_index_.find(id);
  if (is_new) {
    const Outlines::Edge& edge = outlines.edge(id);
    edges_.push_back({number_of_corner(outlines, edge.a), number_of_corner(outlines, edge.b)});
  }
  return number;
}

std::uint32_t QuickTier::number_of_corner(Outlines& outlines, CornerId id) {
  const auto [number, is_new] = corner_index_.find(id);
  if (is_new) corners_.push_back(quick_corner(outlines, id));
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
