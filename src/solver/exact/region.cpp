// Why the precision suffices in the end: an irrational F > 0 is never the midpoint of two doubles. By Baker's theorem a
// rational F comes from rational relations among the angles and pi, and the factors n . (a x b) / (|n| |a x b|), if
// rational, have 2-adic valuation >= -1 (primitive integer vectors have squared lengths not divisible by 4). We
// believe, but have not proved, that no such combination has the 54 or more binary places of a midpoint. If one had,
// the cap on the precision would end the loop.
#include "exact/region.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "contour/measures.h"
#include "exact/source_planes.h"
#include "exactff/enclosure.h"
#include "kernel/ball.h"
#include "kernel/expect.h"
#include "scene/scene.h"
#include "visibility/visible_boundary.h"

namespace exactff::exact {

using kernel::Integer;
using kernel::Rational;
using visibility::ArcSection;
using visibility::BoundaryPiece;
using visibility::PlaneVisibility;
using visibility::SourcePlane;
using visibility::View;

namespace {

// --- The visible fraction of a source in several planes, correctly rounded ---

// Each area is r sqrt(q) with r rational and q = |normal|^2. For one plane the ratio is rational. For several planes,
// balls of increasing precision decide unless the ratio is the midpoint of two doubles, which is rational. Square roots
// of integers are linearly independent over the rationals if no product of two of them is a square (Besicovitch 1940).
// So the ratio is rational only if it is the same for every class of commensurable planes. That is tested exactly,
// because balls would never decide a midpoint.

struct Area {
  Rational coefficient;  // r
  Integer radicand;      // q
};

Area area_of(const PlaneShare& plane) {
  return {plane.projected_area / abs(plane.normal[plane.axis]), dot(plane.normal, plane.normal)};
}

Ball ratio_at(std::span<const PlaneShare> planes, long bits) {
  using kernel::to_ball;
  Ball visible(bits), whole(bits);
  for (const PlaneShare& plane : planes) {
    const auto [coefficient, radicand] = area_of(plane);
    const Ball area = sqrt(to_ball(radicand, bits)) * to_ball(coefficient, bits);
    whole = whole + area;
    visible = visible + area * to_ball(plane.fraction, bits);
  }
  return visible / whole;
}

struct CommensurableClass {
  Integer radicand;
  Rational visible;
  Rational whole;
};

void add_to_classes(std::vector<CommensurableClass>& classes, const PlaneShare& plane) {
  const Area area = area_of(plane);
  for (CommensurableClass& one : classes) {
    const Integer product = area.radicand * one.radicand;
    if (!mpz_perfect_square_p(product.get_mpz_t())) continue;
    // sqrt(q) = sqrt(q q') / q' sqrt(q')
    const Rational coefficient = area.coefficient * Rational(sqrt(product)) / one.radicand;
    one.visible += coefficient * plane.fraction;
    one.whole += coefficient;
    return;
  }
  classes.push_back({area.radicand, area.coefficient * plane.fraction, area.coefficient});
}

// The ratio if it is rational, else empty.
std::optional<Rational> rational_ratio(std::span<const PlaneShare> planes) {
  std::vector<CommensurableClass> classes;
  for (const PlaneShare& plane : planes) add_to_classes(classes, plane);
  const Rational ratio = classes.front().visible / classes.front().whole;
  const bool same = std::all_of(classes.begin(), classes.end(),
                                [&](const CommensurableClass& one) { return one.visible == ratio * one.whole; });
  return same ? std::optional(ratio) : std::nullopt;
}

// Sum of fraction * area over the sum of areas, rounded to the nearest double, ties to even. Requires at least one
// plane.
double visible_fraction(std::span<const PlaneShare> planes) {
  EXACTFF_EXPECT(!planes.empty());
  const Rational& first = planes.front().fraction;
  const auto equals_first = [&](const PlaneShare& plane) { return plane.fraction == first; };
  if (std::all_of(planes.begin(), planes.end(), equals_first)) return kernel::nearest_double(first);

  constexpr long kFirstBits = 128;
  constexpr long kBitsBeforeTheExactTest = 512;
  for (long bits = kFirstBits;; bits *= 2) {
    if (const std::optional<double> nearest = EnclosureInside::of(ratio_at(planes, bits)).nearest()) return *nearest;
    if (bits != kBitsBeforeTheExactTest) continue;
    if (const std::optional<Rational> ratio = rational_ratio(planes)) return kernel::nearest_double(*ratio);
  }
}

// --- Records ---

void set_count(std::vector<PlaneRecord>& records, std::size_t count, std::vector<PlaneRecord>& spare) {
  constexpr std::size_t kMostSpare = 4096;
  for (; records.size() > count; records.pop_back()) {
    if (spare.size() < kMostSpare) spare.push_back(std::move(records.back()));
  }
  for (; records.size() < count && !spare.empty(); spare.pop_back()) records.push_back(std::move(spare.back()));
  records.resize(count);
}

// Resets the result but keeps its memory, and its gradient; the records are still to be set.
void reset(FormFactor& result, std::size_t planes, std::vector<PlaneRecord>& spare) {
  FormFactor fresh;
  fresh.enclosure = std::move(result.enclosure);
  EnclosureInside::set(fresh.enclosure, Ball());
  fresh.cutters = std::move(result.cutters);
  fresh.cutters.clear();
  fresh.planes = std::move(result.planes);
  set_count(fresh.planes, planes, spare);
  fresh.gradient = std::move(result.gradient);
  result = std::move(fresh);
}

// Moves everything found for a plane into the record; the faces are copied into the record's existing memory.
void set_record(PlaneRecord& record, PlaneRecord&& found, const std::vector<FaceId>& faces) {
  found.faces = std::move(record.faces);
  found.faces.assign(faces.begin(), faces.end());
  record = std::move(found);
}

void note_fraction(PlaneVisibility& plane, const ExactOptions& options) {
  plane.record.visible_fraction = kernel::nearest_double(*plane.fraction);
  if (*plane.fraction == 1) plane.record.cutters = 0;
  if (options.exact_fraction) plane.record.exact_fraction = kernel::to_string(*plane.fraction);
}

PlaneShare share_of(const Scene& scene, const SourcePlane& plane, const PlaneVisibility& seen) {
  visibility::ProjectedArea area = visibility::union_area(scene, plane);
  return {*seen.fraction, std::move(area.area), plane.normal.exact, area.axis};
}

// A source without area has no shares: nothing of it is visible.
void set_fraction(const std::vector<PlaneShare>& shares, FormFactor& result) {
  const auto all_are = [&](int whole) {
    return std::all_of(shares.begin(), shares.end(), [&](const PlaneShare& share) { return share.fraction == whole; });
  };
  result.visible_part = all_are(0) ? VisiblePart::kNothing : all_are(1) ? VisiblePart::kAll : VisiblePart::kSome;
  result.visible_fraction = shares.empty() ? 0.0 : visible_fraction(shares);
}

template <class Faces>
void sort_unique(Faces& faces) {
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

// Adds what is seen in the other half of a sphere's view.
void join(PlaneVisibility& all, PlaneVisibility&& other) {
  PlaneRecord &record = all.record, &more = other.record;
  if (record.outcome <= Outcome::kBelowHorizon) {
    record = std::move(more);
  } else if (more.outcome > Outcome::kBelowHorizon) {
    if (record.outcome != more.outcome) record.outcome = Outcome::kPartlyHidden;
    for (const auto count : {&PlaneRecord::tree_candidates, &PlaneRecord::candidates, &PlaneRecord::tree_edges,
                             &PlaneRecord::silhouettes, &PlaneRecord::clipped, &PlaneRecord::pairs,
                             &PlaneRecord::undecided_pairs, &PlaneRecord::loops, &PlaneRecord::edges}) {
      record.*count += more.*count;
    }
  }
  if (all.fraction) *all.fraction += *other.fraction;
  for (const FaceId face : other.cutters) all.cutters.push_back(face);
  sort_unique(all.cutters);
}

}  // namespace

// --- Steps 1 to 7 ---

void Region::find(const Scene& scene, const Receiver& receiver, std::span<const SourcePlane> planes,
                  const ExactOptions& options, visibility::EdgeWorkspace& edges, FormFactor& result) {
  view_.emplace(scene, receiver);
  planes_ = planes;
  request_ = {.engine = options.engine,
              .fraction = options.visible_fraction || options.exact_fraction,
              .list_cutters = options.list_cutters,
              .only_occluders = options.only_occluders,
              .culling = options.culling,
              .remembers_covers = !options.from_scratch};
  arcs_.clear();
  shares_.clear();
  is_sphere_ = options.measure.sphere;
  has_gradient_ = false;
  reset(result, planes.size(), spare_records_);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    PlaneVisibility seen =
        options.measure.sphere ? find_around_sphere(receiver, planes[p], edges) : find(*view_, planes[p], edges);
    note(planes[p], std::move(seen), options, result.planes[p], result);
  }
  sort_unique(result.cutters);
  if (request_.fraction) set_fraction(shares_, result);
}

PlaneVisibility Region::find(const View& view, const SourcePlane& plane, visibility::EdgeWorkspace& edges) {
  PlaneVisibility seen = find_visible_boundary(view, plane, request_, edges);
  arcs_.add(view, plane, std::move(seen.boundary));
  return seen;
}

// In two halves of its view. Where these meet does not matter: nearly all planes are in the first.
PlaneVisibility Region::find_around_sphere(const Receiver& receiver, const SourcePlane& plane,
                                           visibility::EdgeWorkspace& edges) {
  const Scene& scene = view_->scene;
  const Vec3 n = receiver.on.empty() ? rounded(plane.normal.exact) : normal_of_sphere(scene, receiver);
  PlaneVisibility seen = find(View(scene, looking_along(receiver, {-n.x, -n.y, -n.z})), plane, edges);
  join(seen, find(View(scene, looking_along(receiver, n)), plane, edges));
  return seen;
}

void Region::note(const SourcePlane& plane, PlaneVisibility&& seen, const ExactOptions& options, PlaneRecord& record,
                  FormFactor& result) {
  if (options.list_cutters) seen.record.cutters = seen.cutters.size();
  if (request_.fraction) {
    note_fraction(seen, options);
    shares_.push_back(share_of(view_->scene, plane, seen));
  }
  result.cutters.insert(result.cutters.end(), seen.cutters.begin(), seen.cutters.end());
  set_record(record, std::move(seen.record), plane.faces);
}

// --- Step 8 ---

void Region::measure(const Measure& measure, int digits, int precision_cap, FormFactor& result) {
  result.value = result.lower = result.upper = 0.0;
  result.status = Status::kZero;
  EnclosureInside::set(result.enclosure, Ball());
  result.precision_bits = 0;
  if (!arcs_.empty() && !sum_is_certain(measure, digits, precision_cap, result)) {
    integrate_in_balls(measure, digits, precision_cap, result);
  }
  set_bounds(result, measure.is_form_factor() ? 1.0 : contour::most_of(measure));
}

// In double-double: takes the value from the sum over all planes, or from that of the gradient, which has the same
// arcs. False if that does not determine it.
bool Region::sum_is_certain(const Measure& measure, int digits, int precision_cap, FormFactor& result) {
  constexpr int kBits = QuickTier::kBits;
  if (precision_cap < kBits) return false;
  const bool is_form_factor = measure.is_form_factor();
  if (is_form_factor && has_gradient_) return is_determined(gradient_.form_factor(), kBits, digits, result);
  quick_.start(view_->n);
  for (std::size_t s = 0; s < arcs_.size(); ++s) quick_.add(arcs_[s], measure);
  if (!is_form_factor) {
    const std::optional<bool> counts = quick_.something_counts();
    if (counts != true) return counts.has_value();
  }
  return is_determined(quick_.ball(), kBits, digits, result);
}

// In balls of rising precision.
void Region::integrate_in_balls(const Measure& measure, int digits, int precision_cap, FormFactor& result) const {
  if (measure.is_form_factor()) {
    contour::ContourIntegral contour(view_->normal().exact);
    for (std::size_t s = 0; s < arcs_.size(); ++s) {
      arcs_[s].for_each_piece([&](const BoundaryPiece& piece) { contour.add(piece); });
    }
    return certify([&](long bits) { return contour.evaluate(bits); }, digits, precision_cap, result);
  }
  contour::MeasureIntegral integral(measure);
  for (std::size_t s = 0; s < arcs_.size(); ++s) {
    const ArcSection seen = arcs_[s];
    integral.start(seen.n);
    seen.for_each_piece([&](const BoundaryPiece& piece) { integral.add(piece); });
  }
  if (integral.empty()) return;
  certify([&](long bits) { return integral.evaluate(bits); }, digits, precision_cap, result, contour::most_of(measure));
}

// --- Derivatives ---

void Region::differentiate(const gradient::PointGradient::Request& request, int precision_cap, Gradient& result) {
  gradient_.start(*view_, request);
  if (!view_->is_buried) {
    for (std::size_t p = 0; p < planes_.size(); ++p) gradient_.add({*view_, planes_[p], request_}, arcs_[p]);
  }
  has_gradient_ = true;
  if (gradient_.finish(precision_cap, result)) return;
  for (std::size_t p = 0; p < planes_.size(); ++p) gradient_.add_exactly({*view_, planes_[p], request_}, arcs_[p]);
  gradient_.certify(precision_cap, result);
}

void Region::find_by_pieces(const visibility::BoundaryRequest& request, visibility::EdgeWorkspace& edges) {
  planes_by_face_.clear();
  for (const SourcePlane& plane : planes_)
    std::ranges::move(split_by_face(view_->scene, plane), std::back_inserter(planes_by_face_));
  arcs_by_face_.clear();
  for (const SourcePlane& plane : planes_by_face_) {
    arcs_by_face_.add(*view_, plane, find_visible_boundary(*view_, plane, request, edges).boundary);
  }
}

void Region::differentiate_by_vertices(int precision_cap, visibility::EdgeWorkspace& edges, Gradient& result) {
  if (result.kink || view_->is_buried) return;
  const visibility::BoundaryRequest request{
      .engine = request_.engine, .only_occluders = request_.only_occluders, .by_pieces = true};
  // Where nothing is joined, the arcs that are there already are those of the faces.
  const bool is_by_face =
      panels(view_->scene).empty() && request_.culls() &&
      std::ranges::all_of(planes_, [](const SourcePlane& plane) { return plane.faces.size() == 1; });
  if (!is_by_face) find_by_pieces(request, edges);
  const std::span planes = is_by_face ? planes_ : std::span<const SourcePlane>(planes_by_face_);
  const visibility::VisibleArcs& arcs = is_by_face ? arcs_ : arcs_by_face_;
  const auto for_each_plane = [&](auto add) {
    for (std::size_t p = 0; p < planes.size(); ++p) (vertices_.*add)({*view_, planes[p], request}, arcs[p]);
  };
  vertices_.start(*view_);
  for_each_plane(&gradient::VertexGradient::add);
  if (vertices_.finish(precision_cap, result)) return;
  for_each_plane(&gradient::VertexGradient::add_exactly);
  vertices_.certify(precision_cap, result);
}

}  // namespace exactff::exact
