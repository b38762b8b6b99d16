#include "exact/quick_tier.h"

#include "kernel/ball.h"

namespace exactff::exact {

using contour::QuickCorner;
using contour::QuickEnd;
using contour::QuickPiece;
using visibility::CornerId;
using visibility::Outlines;
using visibility::VisibleEdges;

namespace {
constexpr std::uint32_t kNone = 0xFFFFFFFFU;
}

void QuickTier::add(VisibleEdges& edges) {
  Outlines& outlines = edges.outlines();
  corners_.clear();
  index_.assign(outlines.corner_count(), kNone);
  for (const VisibleEdges::Part& part : edges.parts()) {
    const Outlines::Edge edge = outlines.edge(part.edge);
    QuickPiece piece;
    piece.a = corner(outlines, edge.a);
    piece.b = corner(outlines, edge.b);
    piece.begin = end(outlines, part.begin);
    piece.end = end(outlines, part.end);
    contour_.add(corners_, piece);
  }
}

namespace {

contour::QuickCorner quick_corner(Outlines& outlines, CornerId id) {
  if (const auto vertex = outlines.vertex(id)) {
    return contour::quick_corner(outlines.position(*vertex), outlines.x(), outlines.scale_exponent());
  }
  if (const contour::QuickCorner* fine = outlines.fine(id)) return *fine;
  return contour::quick_corner(outlines.exact(id));
}

}  // namespace

std::uint32_t QuickTier::corner(Outlines& outlines, CornerId id) {
  std::uint32_t& index = index_[id];
  if (index != kNone) return index;
  index = static_cast<std::uint32_t>(corners_.size());
  corners_.push_back(quick_corner(outlines, id));
  return index;
}

QuickEnd QuickTier::end(Outlines& outlines, const VisibleEdges::Parameter& p) {
  using Parameter = VisibleEdges::Parameter;
  if (p.line == Parameter::kAtBegin) return {QuickEnd::Kind::kA};
  if (p.line == Parameter::kAtEnd) return {QuickEnd::Kind::kB};
  const Outlines::Edge line = outlines.edge(p.line);
  return {QuickEnd::Kind::kCrossing, corner(outlines, line.a), corner(outlines, line.b)};
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
