#include "gradient/gradient.h"

#include "kernel/poll.h"
#include "kernel/vec.h"

namespace exactff::gradient {

using contour::ArcSum;
using contour::MovingArc;
using contour::QuickCorner;
using contour::QuickPiece;
using kernel::ExactVec3;
using kernel::Rational;
using kernel::RationalVec3;
using kernel::to_rational;
using visibility::BoundaryPiece;
using visibility::CornerId;
using visibility::EdgeCovers;
using visibility::EdgeId;
using visibility::Outlines;
using visibility::Parameter;
using visibility::PlaneQuery;
using visibility::VisibleBoundary;

// --- Moving arcs ---

namespace {

bool is_in_one_of(std::span<const SightResult> planes, const ExactVec3& normal) {
  return std::ranges::any_of(planes, [&](const SightResult& plane) { return is_zero(cross(plane.normal, normal)); });
}

class EdgeArcs {
 public:
  EdgeArcs(const PlaneQuery& query, EdgeCovers& found) : x_(to_rational(query.view.x)), found_(found) {
    const visibility::SourcePlane& plane = query.plane;
    normal_ = to_rational(plane.normal.exact);
    offset_ = dot(normal_, to_rational(plane.point) - x_);
  }

  void add(std::span<const SightResult> except, std::vector<MovingArc>& arcs) {
    for (const EdgeCovers::Part& part : found_.parts()) {
      kernel::poll();
      const BoundaryPiece piece = found_.exact(part);
      MovingArc arc{
          piece.a * piece.begin.l + piece.b * piece.begin.m, piece.a * piece.end.l + piece.b * piece.end.m, {}};
      const ExactVec3 pole = cross(arc.begin, arc.end);
      if (is_zero(pole) || is_in_one_of(except, pole)) continue;
      const Outlines::Edge& edge = found_.outlines().edge(part.edge);
      const RationalVec3 a = point_at(edge.a), along = point_at(edge.b) - a, moment = cross(a, along);
      arc.nearness = cross(along, moment) * Rational(1 / dot(moment, moment));
      arcs.push_back(std::move(arc));
    }
  }

 private:
  // Relative to x. A corner that is not a vertex lies in the source's plane.
  [[nodiscard]] RationalVec3 point_at(CornerId corner) {
    Outlines& outlines = found_.outlines();
    if (const auto vertex = outlines.vertex(corner)) return to_rational(outlines.position(*vertex)) - x_;
    const RationalVec3 direction = to_rational(outlines.exact(corner));
    return direction * Rational(offset_ / dot(normal_, direction));
  }

  RationalVec3 x_, normal_;
  Rational offset_;
  EdgeCovers& found_;
};

// The arcs of the boundary in one plane through x, from one of its pieces. The profile is that of the query.
void add_arcs_of_plane(const PlaneQuery& query, Profile& profile, const Outlines::Edge& edge,
                       std::vector<MovingArc>& arcs) {
  for (const SightArc& found : SightPlane(query, profile, edge).arcs()) {
    // If x moves away from N, what is seen grows by the gain: it lies on the other side of the arc.
    if (!is_zero(found.gain_back)) arcs.push_back({found.begin, found.end, found.gain_back});
  }
}

// Adds all arcs of the boundary, without their lines: those of V.
void add_contour_arcs(const visibility::VisibleBoundary& boundary, std::vector<MovingArc>& arcs) {
  boundary.for_each_piece([&](const BoundaryPiece& piece) {
    MovingArc arc{piece.a * piece.begin.l + piece.b * piece.begin.m, piece.a * piece.end.l + piece.b * piece.end.m, {}};
    if (!is_zero(cross(arc.begin, arc.end))) arcs.push_back(std::move(arc));
  });
}

// Adds the arcs of the boundary of one plane of the source, except those in the given planes through x.
//
// The edge engine's arcs come with their edges. Of the Booleans' boundary only the planes through x are used: the lines
// in each plane are found again from what meets it (kinks.h). So the two ways share little.
void add_moving_arcs(const PlaneQuery& query, const visibility::VisibleBoundary& boundary,
                     std::span<const SightResult> except, std::vector<MovingArc>& arcs) {
  if (boundary.empty()) return;
  if (boundary.edges() != nullptr) {
    EdgeArcs(query, *boundary.edges()).add(except, arcs);
    return;
  }
  visibility::BoundaryRequest request = query.request;
  request.culling = ShaftCulling::kTree;
  const PlaneQuery closed{query.view, query.plane, request};
  Profile profile;
  profile.gather(closed);
  for_each_plane(boundary, query.view.normal().exact, [&](const ExactVec3& pole) {
    if (!is_in_one_of(except, pole)) add_arcs_of_plane(closed, profile, profile.edge_in_plane(pole), arcs);
  });
}

}  // namespace

// --- Derivative ---

bool is_determined(const Ball& ball, Derivative& result) {
  EnclosureInside::set(result.enclosure, ball);
  if (result.enclosure.contains(0.0)) return false;
  const std::optional<double> nearest = result.enclosure.nearest();
  if (!nearest || !std::isfinite(*nearest)) return false;
  result.value = *nearest;
  result.status = result.value == 0.0 ? DerivativeStatus::kUnderflow : DerivativeStatus::kCertified;
  return true;
}

bool is_determined(double hi, double lo, double error, Derivative& result) {
  const Ball ball = kernel::ball_around(hi, lo, error);
  const std::optional<double> nearest = kernel::nearest_around(hi, lo, error);
  if (!nearest) return is_determined(ball, result);
  EnclosureInside::set(result.enclosure, ball);
  result.value = *nearest;
  result.status = DerivativeStatus::kCertified;
  return true;
}

void set_zero(Derivative& result) {
  result = {};
  EnclosureInside::set(result.enclosure, Ball());
}

void set_none(Derivative& result) {
  result.value = std::numeric_limits<double>::quiet_NaN();
  result.status = DerivativeStatus::kNone;
  EnclosureInside::set(result.enclosure, Ball());
}

Ball over_turn_and_length(const kernel::ExactVec3& n, long bits) {
  return kernel::to_ball(1.0, bits) / (twice(kernel::pi(bits)) * sqrt(kernel::to_ball(dot(n, n), bits)));
}

// --- Quick arcs ---

namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;

}  // namespace

void QuickArcs::add(const visibility::PlaneQuery& query, const visibility::VisibleBoundary& boundary) {
  if (boundary.empty()) return;
  if (boundary.edges() == nullptr) {
    sum_.decline();
    return;
  }
  translate(query, *boundary.edges());
  const std::span lines = std::span(lines_).first(edges_.size());
  sum_.add(pieces_, lines, boundary.edges()->outlines().scale_exponent());
}

// Sets pieces_ and lines_.
void QuickArcs::translate(const visibility::PlaneQuery& query, EdgeCovers& found) {
  using kernel::double_double::Bounded;
  static_assert(Parameter::kAtBegin == QuickPiece::kAtA && Parameter::kAtEnd == QuickPiece::kAtB);
  Outlines& outlines = found.outlines();
  plane_ = &query.plane;
  const QuickCorner s = contour::quick_corner(plane_->point, outlines.x(), outlines.scale_exponent());
  offset_ = {};
  for (int i = 0; i < 3; ++i) offset_ = offset_ + plane_->fine_normal[i] * Bounded{s.hi[i], s.lo[i], s.error};
  number_.assign(outlines.edges().size(), kNone);
  corner_number_.assign(outlines.corner_count(), kNone);
  edges_.clear();
  corners_.clear();
  pieces_.clear();
  const auto end = [&](EdgeId line) { return line < Parameter::kAtBegin ? number_of_line(outlines, line) : line; };
  for (const EdgeCovers::Part& part : found.parts()) {
    pieces_.push_back({number_of_line(outlines, part.edge), end(part.begin.line), end(part.end.line)});
  }
  if (lines_.size() < edges_.size()) lines_.resize(edges_.size());
  sum_.make_lines(corners_, edges_, std::span(lines_).first(edges_.size()));
}

std::uint32_t QuickArcs::number_of_line(Outlines& outlines, EdgeId id) {
  if (number_[id] != kNone) return number_[id];
  const Outlines::Edge edge = outlines.edge(id);
  number_[id] = static_cast<std::uint32_t>(edges_.size());
  edges_.push_back({number_of_corner(outlines, edge.a), number_of_corner(outlines, edge.b)});
  return number_[id];
}

std::uint32_t QuickArcs::number_of_corner(Outlines& outlines, CornerId id) {
  if (corner_number_[id] == kNone) {
    corner_number_[id] = static_cast<std::uint32_t>(corners_.size());
    corners_.push_back(point_at(outlines, id));
  }
  return corner_number_[id];
}

// Relative to x. A corner that is not a vertex lies in the source's plane.
QuickCorner QuickArcs::point_at(Outlines& outlines, CornerId corner) const {
  if (const auto vertex = outlines.vertex(corner)) {
    return contour::quick_corner(outlines.position(*vertex), outlines.x(), outlines.scale_exponent());
  }
  const QuickCorner* fine = outlines.fine(corner);
  return contour::lifted(fine != nullptr ? *fine : contour::quick_corner(outlines.exact(corner)), plane_->fine_normal,
                         offset_);
}

// --- Gradient ---

void PointGradient::start(const visibility::View& view, const Request& request) {
  x_ = view.x;
  normal_ = view.n;
  list_arcs_ = request.list_arcs;
  along_.reset();
  if (request.along) along_ = kernel::exact_vector(*request.along).v;
  quick_.start(view.n);
  something_visible_ = false;
  kink_.reset();
  kinks_.clear();
  exact_planes_ = 0;
  arcs_.clear();
  contour_arcs_.clear();
}

void PointGradient::add(const PlaneQuery& query, const VisibleBoundary& boundary) {
  something_visible_ = something_visible_ || !boundary.empty();
  quick_.add(query, boundary);
  if (kink_ && !along_) return;
  search_.find(query, !boundary.empty(), along_ ? KinkSearch::Extent::kAll : KinkSearch::Extent::kFirst);
  if (search_.kink() && (!kink_ || search_.kink()->reason == KinkReason::kOnFace)) kink_ = search_.kink();
  if (along_) kinks_.push_back(search_.planes());
}

bool PointGradient::exists_along() const { return !kink_ || kink_->reason != KinkReason::kOnFace; }

Ball PointGradient::form_factor() const {
  const contour::QuickGradient::Value value = quick_.sum().form_factor();
  return kernel::ball_around(value.hi, value.lo, value.error);
}

bool PointGradient::finish(int cap, Gradient& result) {
  result.kink = kink_;
  result.along.reset();
  result.arcs.clear();
  result.vertices.clear();
  result.frames.clear();
  bool done = !(list_arcs_ && something_visible_ && !kink_);
  if (along_) {
    result.along.emplace();
    if (!exists_along()) {
      set_none(*result.along);
    } else if (something_visible_ || kink_) {
      done = false;
    } else {
      set_zero(*result.along);
    }
  }
  const bool quick = cap >= kQuickBits;
  const auto take = [&](const contour::QuickGradient::Value& value, Derivative& derivative) {
    if (!something_visible_) {
      set_zero(derivative);
    } else if (!quick || !is_determined(value.hi, value.lo, value.error, derivative)) {
      derivative.status = DerivativeStatus::kEnclosed;  // so far
      done = false;
    }
  };
  for (int axis = 0; axis < 3; ++axis) {
    take(quick_.sum().normal(axis), result.normal[axis]);
    if (kink_) {
      set_none(result.position[axis]);
    } else {
      take(quick_.sum().position(axis), result.position[axis]);
    }
  }
  return done;
}

void PointGradient::add_exactly(const PlaneQuery& query, const VisibleBoundary& boundary) {
  const std::size_t plane = exact_planes_++;
  const std::span<const SightResult> except =
      plane < kinks_.size() ? std::span<const SightResult>(kinks_[plane]) : std::span<const SightResult>();
  add_contour_arcs(boundary, contour_arcs_);
  if (!kink_ || along_) add_moving_arcs(query, boundary, except, arcs_);
}

void PointGradient::list_arcs(const ExactVec3& n, Gradient& result) const {
  constexpr long kBits = 128;
  const auto point = [&](const ExactVec3& t, const RationalVec3& nearness) {
    const RationalVec3 w = kernel::to_rational(t);
    const RationalVec3 at = kernel::to_rational(x_) + w * kernel::Rational(1 / dot(nearness, w));
    return Vec3{kernel::nearest_double(at.x), kernel::nearest_double(at.y), kernel::nearest_double(at.z)};
  };
  const Ball factor =
      kernel::to_ball(1.0, kBits) / (twice(kernel::pi(kBits)) * sqrt(kernel::to_ball(dot(n, n), kBits)));
  for (const MovingArc& arc : arcs_) {
    double part[3];
    for (int axis = 0; axis < 3; ++axis) {
      ArcSum one;
      one.add_position(arc, n, axis);
      part[axis] = kernel::nearest_to_midpoint(one.evaluate(kBits) * factor);
    }
    result.arcs.push_back({point(arc.begin, arc.nearness), point(arc.end, arc.nearness), {part[0], part[1], part[2]}});
  }
  const auto size = [](const GradientArc& arc) { return kernel::max_norm(arc.part); };
  std::ranges::stable_sort(result.arcs, [&](const auto& a, const auto& b) { return size(a) > size(b); });
}

void PointGradient::certify(int cap, Gradient& result) {
  const ExactVec3 n = kernel::make_direction(kernel::exact_vector(normal_).v).exact;
  const auto over_tau = [](long bits) { return kernel::to_ball(1.0, bits) / twice(kernel::pi(bits)); };
  const auto over_length = [&](const ExactVec3& v) {
    return [&](long bits) { return over_tau(bits) / sqrt(kernel::to_ball(dot(v, v), bits)); };
  };
  arcs_ = joined(std::move(arcs_));
  contour_arcs_ = joined(std::move(contour_arcs_));
  for (int axis = 0; axis < 3; ++axis) {
    if (result.position[axis].status == DerivativeStatus::kEnclosed) {
      ArcSum sum;
      for (const MovingArc& arc : arcs_) sum.add_position(arc, n, axis);
      gradient::certify(sum, over_length(n), cap, result.position[axis]);
    }
    if (result.normal[axis].status == DerivativeStatus::kEnclosed) {
      ArcSum sum;
      for (const MovingArc& arc : contour_arcs_) sum.add_normal(arc, axis);
      gradient::certify(sum, over_tau, cap, result.normal[axis]);
    }
  }
  if (list_arcs_ && !kink_) list_arcs(n, result);
  if (!along_ || !exists_along()) return;
  // A single sum with the sign of the movement of each arc.
  ArcSum sum;
  for (const MovingArc& arc : arcs_) sum.add_along(arc, n, *along_);
  for (const std::vector<SightResult>& plane : kinks_) {
    for (const SightResult& sight : plane) {
      const int way = kernel::sign(dot(*along_, sight.normal));
      if (way == 0) continue;
      for (const SightArc& arc : sight.arcs) {
        const RationalVec3& gain = way > 0 ? arc.gain_ahead : arc.gain_back;
        if (!is_zero(gain)) sum.add_gain({arc.begin, arc.end, gain}, n, *along_);
      }
    }
  }
  const ExactVec3& d = *along_;
  gradient::certify(
      sum, [&](long bits) { return over_length(n)(bits) / sqrt(kernel::to_ball(dot(d, d), bits)); }, cap,
      *result.along);
}

}  // namespace exactff::gradient
