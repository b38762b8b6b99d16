#include "exact/quick_tier.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace exactff::exact {

using contour::QuickContour;
using contour::QuickCorner;
using contour::QuickEdge;
using contour::QuickLine;
using contour::QuickPiece;
using visibility::CornerId;
using visibility::EdgeId;
using visibility::Outlines;
using visibility::VisibleEdges;

namespace {

// Numbers items in the order in which they are first requested. forget() starts a new numbering from 0 without clearing
// the table.
class Numbers {
 public:
  void clear(std::size_t count) {
    first_ = next_ = 0;
    number_.assign(count, kNone);
  }
  // The number of item i, counted from the last forget(), and whether it is new.
  struct Found {
    std::uint32_t number;
    bool is_new;
  };
  Found find(std::uint32_t i) {
    const bool is_new = number_[i] == kNone || number_[i] < first_;
    if (is_new) number_[i] = next_++;
    return {number_[i] - first_, is_new};
  }
  void forget() { first_ = next_; }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::uint32_t first_ = 0, next_ = 0;
  std::vector<std::uint32_t> number_;
};

QuickCorner quick_corner(Outlines& outlines, CornerId id) {
  if (const auto vertex = outlines.vertex(id)) {
    return contour::quick_corner(outlines.position(*vertex), outlines.x(), outlines.scale_exponent());
  }
  if (const QuickCorner* fine = outlines.fine(id)) return *fine;
  return contour::quick_corner(outlines.exact(id));
}

// The corners and lines of one plane's parts.
class Lines {
 public:
  void clear(const Outlines& outlines) {
    forget();
    corners_.clear();
    corner_numbers_.clear(outlines.corner_count());
    line_numbers_.clear(outlines.edges().size());
  }
  // The number of an edge's line. The line itself is made later, by lines().
  std::uint32_t find(Outlines& outlines, EdgeId id) {
    const auto [number, is_new] = line_numbers_.find(id);
    if (is_new) {
      const Outlines::Edge& edge = outlines.edge(id);
      edges_.push_back({corner(outlines, edge.a), corner(outlines, edge.b)});
    }
    return number;
  }
  // All lines found so far; makes those that are missing.
  [[nodiscard]] std::span<const QuickLine> lines(const QuickContour& contour) {
    if (lines_.size() < edges_.size()) lines_.resize(edges_.size());
    contour.make_lines(corners_, std::span(edges_).subspan(made_), std::span(lines_).subspan(made_));
    made_ = edges_.size();
    return lines_;
  }
  // Neighbouring parts share lines, so recent lines are worth keeping; all lines together would not fit into the cache.
  void forget_if_many() {
    if (edges_.size() >= kMostLines) forget();
  }

 private:
  static constexpr std::size_t kMostLines = 8192;

  void forget() {
    edges_.clear();
    made_ = 0;
    line_numbers_.forget();
  }
  std::uint32_t corner(Outlines& outlines, CornerId id) {
    const auto [number, is_new] = corner_numbers_.find(id);
    if (is_new) corners_.push_back(quick_corner(outlines, id));
    return number;
  }

  Numbers corner_numbers_, line_numbers_;
  std::vector<QuickCorner> corners_;
  std::vector<QuickEdge> edges_;
  std::vector<QuickLine> lines_;  // valid for the first `made_` edges; the rest is only memory
  std::size_t made_ = 0;
};

}  // namespace

// Works in batches, so that lines are made four at a time.
void QuickTier::add(VisibleEdges& edges) {
  using Parameter = VisibleEdges::Parameter;
  static_assert(Parameter::kAtBegin == QuickPiece::kAtA && Parameter::kAtEnd == QuickPiece::kAtB);
  constexpr std::size_t kBatch = 64;
  thread_local Lines lines;  // static so that its memory is reused
  thread_local std::vector<QuickPiece> pieces;
  Outlines& outlines = edges.outlines();
  lines.clear(outlines);
  const auto end = [&](EdgeId line) { return line < Parameter::kAtBegin ? lines.find(outlines, line) : line; };
  for (std::span<const VisibleEdges::Part> parts = edges.parts(); !parts.empty();) {
    lines.forget_if_many();
    pieces.clear();
    const std::size_t count = std::min(kBatch, parts.size());
    for (const VisibleEdges::Part& part : parts.first(count)) {
      pieces.push_back({lines.find(outlines, part.edge), end(part.begin.line), end(part.end.line)});
    }
    contour_.add(pieces, lines.lines(contour_));
    parts = parts.subspan(count);
  }
}

Ball QuickTier::ball() const {
  const QuickContour::Value value = contour_.value();
  return kernel::ball_around(value.hi, value.lo, value.error);
}

}  // namespace exactff::exact
