#include "gradient/gradient.h"

#include "kernel/expect.h"
#include "kernel/poll.h"
#include "kernel/vec.h"

namespace exactff::gradient {

using contour::QuickCorner;
using contour::QuickPiece;
using visibility::Silhouettes;

// --- Kinks: the proof that there is none ---

namespace {

bool is_on_horizon(const View& view, Outlines& outlines, EdgeId id) {
  const Outlines::Edge edge = outlines.edge(id);
  const ExactVec3 n = view.normal().exact;
  return sign(dot(n, outlines.exact(edge.a))) == 0 && sign(dot(n, outlines.exact(edge.b))) == 0;
}

}  // namespace

bool KinkProof::excludes_kinks(const PlaneQuery& query) {
  if (query.request.engine == Engine::kBoolean || !searches_silhouettes(query)) return false;
  const std::size_t sources = PieceClip(query, outlines_, memory_.clip).add_source().count;
  if (sources == 0) return true;
  Silhouettes silhouettes(query, outlines_, memory_);
  PlaneRecord uncounted;
  silhouettes.gather(sources, uncounted);
  if (silhouettes.some_edge_on()) return false;
  groups_.clear();
  for (EdgeId id = 0; id < outlines_.edges().size(); ++id) groups_.add(outlines_, id);
  return groups_.for_each(outlines_, [&](std::span<const EdgeId> group) {
    return are_on_one_line(outlines_, group) || is_on_horizon(query.view, outlines_, group.front());
  });
}

// --- Kinks ---

void KinkSearch::note(KinkReason reason, const Scene& scene, std::span<const std::uint32_t> pieces) {
  if (kink_) return;
  kink_.emplace(Kink{reason, {}});
  for (const std::uint32_t piece : pieces) kink_->faces.push_back(scene.pieces()[piece].face);
  std::ranges::sort(kink_->faces);
  kink_->faces.erase(std::unique(kink_->faces.begin(), kink_->faces.end()), kink_->faces.end());
}

void KinkSearch::find(const PlaneQuery& query, bool is_visible, Extent extent) {
  kink_.reset();
  planes_.clear();
  judged_.clear();
  const View& view = query.view;
  const visibility::SourcePlane& plane = query.plane;
  if (view.is_own(plane.pieces.front())) return;
  const int side = side_of(plane, view.x);
  if (side > 0) find_around_source(query, is_visible, extent);
  if (side == 0) find_edge_on(query);
}

// --- The source edge-on ---

namespace {

// Two vertices of a piece whose plane holds x, which x does not see in line.
std::pair<std::uint32_t, std::uint32_t> apart(const View& view, const Piece& piece) {
  const auto arrow = [&](std::uint32_t v) { return kernel::exact_difference(view.scene.vertices()[v], view.x).v; };
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t p = piece.frame[i], q = piece.frame[(i + 1) % 3];
    if (!is_zero(cross(arrow(p), arrow(q)))) return {p, q};
  }
  EXACTFF_EXPECT(false);  // the three would lie on a line
  return {};
}

}  // namespace

void KinkSearch::find_edge_on(const PlaneQuery& query) {
  const View& view = query.view;
  const visibility::SourcePlane& plane = query.plane;
  const auto holds = [&](std::uint32_t piece) { return holds_x(view, view.scene.pieces()[piece]); };
  const bool on_source = std::ranges::any_of(plane.pieces, holds);
  const ExactVec3 n = view.normal().exact;
  if (is_zero(cross(plane.normal.exact, n))) {  // it is the horizon
    if (on_source && sign(dot(plane.normal.exact, n)) < 0) note(KinkReason::kOnFace, view.scene, plane.pieces);
    return;
  }
  if (on_source) return note(KinkReason::kOnFace, view.scene, plane.pieces);
  profile_.gather_around_plane(query);
  const Piece& piece = view.scene.pieces()[plane.pieces.front()];
  const auto [p, q] = apart(view, piece);
  Outlines& outlines = profile_.outlines();
  const CornerId a = outlines.corner_at(p), b = outlines.corner_at(q);
  const bool reversed = sign(dot(cross(outlines.exact(b), outlines.exact(a)), plane.normal.exact)) < 0;
  SightPlane sight(query, profile_, reversed ? outlines.line_through(b, a) : outlines.line_through(a, b));
  std::vector<SightArc> arcs = sight.arcs_of_source_edge_on();
  if (arcs.empty()) return;
  note(profile_.touching() ? KinkReason::kOnFace : KinkReason::kSourceEdgeOn, view.scene, plane.pieces);
  planes_.push_back({sight.normal(), std::move(arcs)});
}

// --- The source before x ---

void KinkSearch::find_around_source(const PlaneQuery& query, bool is_visible, Extent extent) {
  visibility::BoundaryRequest request = query.request;
  request.culling = ShaftCulling::kTree;
  const PlaneQuery closed{query.view, query.plane, request};
  if (proof_.excludes_kinks(closed)) return;
  profile_.gather(closed);
  if (profile_.source_count() == 0 || profile_.stays_hidden()) return;
  const std::optional<std::uint32_t>& touching = profile_.touching();
  if (!(touching && is_visible)) {
    // 2. Edges without a piece on both sides, in the order of their numbers.
    groups_.add_open(profile_.outlines(), profile_.source_count(), [](EdgeId) { return false; });
    if (judge_sheets(closed, extent)) static_cast<void>(judge_groups(closed, extent));
    if (!(touching && kink_)) return;
  }
  kink_.reset();
  note(KinkReason::kOnFace, query.view.scene, std::span(&*touching, 1));
}

// 3. and 4. False: stopped.
bool KinkSearch::judge_groups(const PlaneQuery& query, Extent extent) {
  Outlines& outlines = profile_.outlines();
  const kernel::Approx3 n{query.view.n.x, query.view.n.y, query.view.n.z};
  return groups_.for_each(outlines, [&](std::span<const EdgeId> group) {
    const Outlines::Edge edge = outlines.edge(group.front());
    const bool is_on_horizon = outlines.side_by_filter(n, edge.a) == 0 && outlines.side_by_filter(n, edge.b) == 0;
    if (!is_on_horizon && !are_on_one_line(outlines, group)) judge(query, edge, extent);
    return !(kink_ && extent == Extent::kFirst);
  });
}

bool KinkSearch::judge_sheets(const PlaneQuery& query, Extent extent) {
  Outlines& outlines = profile_.outlines();
  for (const std::uint32_t sheet : profile_.sheets()) {
    kernel::poll();
    const auto [p, q] = apart(query.view, query.view.scene.pieces()[sheet]);
    judge(query, outlines.line_through(outlines.corner_at(p), outlines.corner_at(q)), extent);
    if (kink_ && extent == Extent::kFirst) return false;
  }
  return true;
}

bool KinkSearch::is_judged(const ExactVec3& normal) const {
  return std::ranges::any_of(judged_, [&](const ExactVec3& other) { return is_zero(cross(normal, other)); });
}

void KinkSearch::judge(const PlaneQuery& query, const Outlines::Edge& edge, Extent extent) {
  SightPlane sight(query, profile_, edge);
  if (is_judged(sight.normal()) || is_zero(cross(sight.normal(), query.view.normal().exact))) return;
  judged_.push_back(sight.normal());
  std::vector<SightArc> arcs =
      sight.arcs(extent == Extent::kFirst ? SightPlane::Extent::kUpToKink : SightPlane::Extent::kAll);
  const auto kink = std::ranges::find_if(arcs, &SightArc::is_kink);
  if (kink == arcs.end()) return;
  note(kink->edge_on ? KinkReason::kEdgeOn : KinkReason::kCoincident, query.view.scene, kink->pieces);
  planes_.push_back({sight.normal(), std::move(arcs)});
}

// --- Moving arcs ---

namespace {

bool is_in_one_of(std::span<const SightResult> planes, const ExactVec3& normal) {
  return std::ranges::any_of(planes, [&](const SightResult& plane) { return is_zero(cross(plane.normal, normal)); });
}

// The arcs of the boundary in one plane through x, from one of its pieces. The profile is that of the query.
void add_arcs_of_plane(const PlaneQuery& query, Profile& profile, const Outlines::Edge& edge,
                       std::vector<MovingArc>& arcs) {
  for (const SightArc& found : SightPlane(query, profile, edge).arcs()) {
    // If x moves away from N, what is seen grows by the gain: it lies on the other side of the arc.
    if (!is_zero(found.gain_back)) arcs.push_back({found.begin, found.end, found.gain_back});
  }
}

MovingArc without_line(const BoundaryPiece& piece) { return {piece.from(), piece.to(), {}}; }

// Of the Booleans' boundary only the planes through x are used: the lines in each plane are found again from what meets
// it. The edge engine's arcs come with their lines. So the two ways share little.
void add_moving_arcs_by_planes(const PlaneQuery& query, const ArcSection& seen, std::span<const SightResult> except,
                               std::vector<MovingArc>& arcs) {
  visibility::BoundaryRequest request = query.request;
  request.culling = ShaftCulling::kTree;
  const PlaneQuery closed{query.view, query.plane, request};
  Profile profile;
  profile.gather(closed);
  for_each_plane(seen, query.view.normal().exact, [&](const ExactVec3& pole) {
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

Ball over_turn_and_length(const ExactVec3& n, long bits) {
  return kernel::to_ball(1.0, bits) / (twice(kernel::pi(bits)) * sqrt(kernel::to_ball(dot(n, n), bits)));
}

// --- Quick arcs ---

void QuickArcs::add(const ArcSection& seen) {
  if (seen.empty()) return;
  if (!seen.is_by_edges()) return sum_.decline();
  make_lines(seen);
  sum_.add(pieces_, lines_, seen.scale_exponent);
}

// Sets pieces_ and lines_. Corners are relative to x; one that is not a vertex lies in the source's plane.
void QuickArcs::make_lines(const ArcSection& seen) {
  using kernel::double_double::Bounded;
  static_assert(Arc::kAtA == QuickPiece::kAtA && Arc::kAtB == QuickPiece::kAtB);
  const QuickCorner s = contour::quick_corner(seen.plane->point, seen.x, seen.scale_exponent);
  Bounded offset;  // of the source's plane, in the scale of its normal and of the corners
  for (int i = 0; i < 3; ++i) offset = offset + seen.plane->fine_normal[i] * Bounded{s.hi[i], s.lo[i], s.error};
  const auto point_at = [&](const ArcCorner& corner) {
    if (corner.is_vertex()) return contour::quick_corner(seen.vertices[corner.p], seen.x, seen.scale_exponent);
    const QuickCorner direction =
        corner.is_fine ? seen.fine[corner.constructed] : contour::quick_corner(seen.exactly[corner.constructed]);
    return contour::lifted(direction, seen.plane->fine_normal, offset);
  };
  pieces_.clear();
  edges_.clear();
  corners_.clear();
  for (const Arc& arc : seen.arcs) pieces_.push_back({arc.line, arc.begin, arc.end});
  for (const ArcLine& line : seen.lines) edges_.push_back({line.a, line.b});
  for (const ArcCorner& corner : seen.corners) corners_.push_back(point_at(corner));
  if (lines_.size() < edges_.size()) lines_.resize(edges_.size());
  sum_.make_lines(corners_, edges_, std::span(lines_).first(edges_.size()));
}

// --- Gradient ---

void PointGradient::start(const View& view, const Request& request) {
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

void PointGradient::add(const PlaneQuery& query, const ArcSection& seen) {
  something_visible_ = something_visible_ || !seen.empty();
  quick_.add(seen);
  if (kink_ && !along_) return;
  search_.find(query, !seen.empty(), along_ ? KinkSearch::Extent::kAll : KinkSearch::Extent::kFirst);
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
  const auto is_open = [](const Derivative& derivative) { return derivative.status == DerivativeStatus::kEnclosed; };
  opens_normal_ = std::ranges::any_of(result.normal, is_open);
  opens_lines_ = along_ || list_arcs_ || std::ranges::any_of(result.position, is_open);
  return done;
}

void PointGradient::add_exactly(const PlaneQuery& query, const ArcSection& seen) {
  const std::size_t plane = exact_planes_++;
  const std::span<const SightResult> except =
      plane < kinks_.size() ? std::span<const SightResult>(kinks_[plane]) : std::span<const SightResult>();
  const bool moves = opens_lines_ && (!kink_ || along_);
  const visibility::ExactArcs exact(seen);
  const auto add = [&](const BoundaryPiece& piece, const Arc* with_line) {
    kernel::poll();
    MovingArc arc = without_line(piece);
    const ExactVec3 pole = cross(arc.begin, arc.end);
    if (is_zero(pole)) return;
    if (opens_normal_) contour_arcs_.push_back(arc);
    if (with_line == nullptr || !moves || is_in_one_of(except, pole)) return;
    arc.nearness = exact.nearness(*with_line);
    arcs_.push_back(std::move(arc));
  };
  for (const Arc& arc : seen.arcs) add(exact(arc), &arc);
  for (const BoundaryPiece& piece : seen.pieces) add(piece, nullptr);
  if (moves && !seen.is_by_edges()) add_moving_arcs_by_planes(query, seen, except, arcs_);
}

void PointGradient::list_arcs(const ExactVec3& n, Gradient& result) const {
  constexpr long kBits = 128;
  const auto point = [&](const ExactVec3& t, const RationalVec3& nearness) {
    return visibility::point_on_line(to_rational(x_), t, nearness);
  };
  const Ball factor = over_turn_and_length(n, kBits);
  for (const MovingArc& arc : arcs_) {
    const contour::ArcIntegral integral(arc, n);
    double part[3];
    for (int axis = 0; axis < 3; ++axis) {
      ArcSum one;
      one.add_position(integral, axis);
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
  std::vector<contour::ArcIntegral> integrals;
  if (opens_lines_ && !kink_) {
    for (const MovingArc& arc : arcs_) integrals.emplace_back(arc, n);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (result.position[axis].status == DerivativeStatus::kEnclosed) {
      ArcSum sum;
      for (const contour::ArcIntegral& integral : integrals) sum.add_position(integral, axis);
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
      const int way = sign(dot(*along_, sight.normal));
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
