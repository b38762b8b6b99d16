#include "exact/quick_tier.h"

#include <cstdint>
#include <vector>

#include "kernel/ball.h"

namespace exactff::exact {

using contour::QuickContour;
using contour::QuickCorner;
using contour::QuickEnd;
using contour::QuickLine;
using visibility::CornerId;
using visibility::EdgeId;
using visibility::Outlines;
using visibility::VisibleEdges;

namespace {

// What is made when first asked for, by an index, and kept until forgotten.
template <class T>
class Memo {
 public:
  void clear(std::size_t count) {
    made_.clear();
    first_ = 0;
    number_.assign(count, kNone);
  }
  // The place of the i-th.
  template <class Make>
  std::uint32_t find(std::uint32_t i, const Make& make) {
    if (number_[i] - first_ >= made_.size()) {
      number_[i] = first_ + static_cast<std::uint32_t>(made_.size());
      made_.push_back(make());
    }
    return number_[i] - first_;
  }
  [[nodiscard]] const T& operator[](std::uint32_t place) const { return made_[place]; }
  [[nodiscard]] std::size_t size() const { return made_.size(); }
  void forget() {
    first_ += static_cast<std::uint32_t>(made_.size());
    made_.clear();
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  std::vector<T> made_;
  std::uint32_t first_ = 0;            // the number of made_.front(): what was made before is forgotten
  std::vector<std::uint32_t> number_;  // by index, in the order of making
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
  // The place of an edge's line.
  std::uint32_t find(const QuickContour& contour, Outlines& outlines, EdgeId id) {
    return lines_.find(id, [&] {
      const Outlines::Edge edge = outlines.edge(id);
      const std::uint32_t a = corner(outlines, edge.a), b = corner(outlines, edge.b);
      return contour.line(corners_[a], corners_[b]);
    });
  }
  void clear(const Outlines& outlines) {
    corners_.clear(outlines.corner_count());
    lines_.clear(outlines.edges().size());
  }
  [[nodiscard]] const QuickLine& operator[](std::uint32_t place) const { return lines_[place]; }
  // Parts that are near one another share lines; all lines together would not fit the cache.
  void forget_if_many() {
    if (lines_.size() >= kMostLines) lines_.forget();
  }

 private:
  static constexpr std::size_t kMostLines = 8192;

  std::uint32_t corner(Outlines& outlines, CornerId id) {
    return corners_.find(id, [&] { return quick_corner(outlines, id); });
  }

  Memo<QuickCorner> corners_;
  Memo<QuickLine> lines_;
};

}  // namespace

void QuickTier::add(VisibleEdges& edges) {
  using Parameter = VisibleEdges::Parameter;
  thread_local Lines lines;  // its memory is used again
  Outlines& outlines = edges.outlines();
  lines.clear(outlines);
  const auto place = [&](EdgeId id) { return id < Parameter::kAtBegin ? lines.find(contour_, outlines, id) : 0; };
  const auto end = [&](EdgeId id, std::uint32_t at) -> QuickEnd {
    if (id == Parameter::kAtBegin) return {QuickEnd::Kind::kA};
    if (id == Parameter::kAtEnd) return {QuickEnd::Kind::kB};
    return {QuickEnd::Kind::kCrossing, &lines[at]};
  };
  for (const VisibleEdges::Part& part : edges.parts()) {
    lines.forget_if_many();
    const std::uint32_t own = place(part.edge), first = place(part.begin.line), last = place(part.end.line);
    contour_.add(lines[own], end(part.begin.line, first), end(part.end.line, last));
  }
}

Enclosure QuickTier::enclosure() const {
  const contour::QuickContour::Value value = contour_.value();
  Ball ball, low;
  arb_set_d(ball.get(), value.hi);
  arb_set_d(low.get(), value.lo);
  arb_add(ball.get(), ball.get(), low.get(), ARF_PREC_EXACT);
  mag_t error;
  mag_init(error);
  mag_set_d(error, value.error);  // rounds up
  arb_add_error_mag(ball.get(), error);
  mag_clear(error);
  return Enclosure(ball);
}

}  // namespace exactff::exact
