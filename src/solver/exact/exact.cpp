// The exact method (steps 1 to 7 of src/README.md): finds the visible boundary for each plane of the source, adds up
// one contour integral over all planes, and raises the precision until the whole ball rounds to one double.
//
// Why this ends: an irrational F > 0 is never the midpoint of two doubles. By Baker's theorem a rational F comes from
// rational relations among the angles and pi, and the factors n . (a x b) / (|n| |a x b|), if rational, have 2-adic
// valuation >= -1 (primitive integer vectors have squared lengths not divisible by 4). We believe, but have not proved,
// that no such combination has the 54 or more binary places of a midpoint. If one had, the cap on the precision would
// end the loop.
#include "exactff/exact.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "contour/contour.h"
#include "contour/measures.h"
#include "exact/quick_tier.h"
#include "exact/source_planes.h"
#include "exact/workspace.h"
#include "exactff/enclosure.h"
#include "kernel/ball.h"
#include "kernel/expect.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "scene/scene.h"
#include "visibility/boolean_walk.h"
#include "visibility/visible_boundary.h"

namespace exactff {

using kernel::Integer;
using kernel::Rational;
using visibility::PlaneVisibility;
using visibility::SourcePlane;

namespace {

// --- The visible fraction of a source in several planes, correctly rounded ---

// One plane: its area is projected_area * |normal| / |normal[axis]|, irrational in general.
struct PlaneShare {
  kernel::Rational fraction;        // visible over whole, in [0, 1]
  kernel::Rational projected_area;  // > 0
  kernel::ExactVec3 normal;
  int axis = 0;
};

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

}  // namespace

ExactSource::ExactSource(const Scene& scene, const Selection& selection) {
  const kernel::StandardArithmetic arithmetic;
  planes_.reset(new Planes{scene.id(), selection, visibility::group_by_plane(scene, scene.faces_of(selection))});
}
ExactSource::ExactSource(ExactSource&&) noexcept = default;
ExactSource& ExactSource::operator=(ExactSource&&) noexcept = default;
ExactSource::~ExactSource() = default;
const ExactSource::Planes& ExactSource::planes() const { return owned_by(planes_, "ExactSource"); }
const Selection& ExactSource::selection() const { return planes().selection; }

Workspace::Workspace() : memory_(std::make_unique<Memory>()) {}
Workspace::Workspace(Workspace&&) noexcept = default;
Workspace& Workspace::operator=(Workspace&&) noexcept = default;
Workspace::~Workspace() = default;
Workspace::Memory& Workspace::memory() { return owned_by(memory_, "Workspace"); }

namespace {

void check_receiver(const Receiver& receiver, const Measure& measure) {
  const Vec3 normal = measure.sphere ? Vec3{0.0, 0.0, 1.0} : receiver.normal;  // a sphere's does not matter
  for (const Vec3& v : {receiver.point, normal}) {
    if (kernel::is_finite(v)) continue;
    throw InputError({.what = "the receiver's point or normal is not finite",
                      .why = "a form factor needs a point and a direction",
                      .suggestion = "give three finite numbers for each"});
  }
  if (normal == Vec3{}) {
    throw InputError({.what = "the receiver's normal is (0, 0, 0)",
                      .why = "it has no direction, so the horizon is not defined",
                      .suggestion = "give a normal of any length other than zero"});
  }
}

void check_precision_cap(int cap) {
  if (cap >= 1) return;
  throw InputError({.what = "the precision cap is " + std::to_string(cap) + " bits",
                    .why = "a ball (interval) needs at least one bit",
                    .suggestion = "give a cap of at least 1; the default is 65536"});
}

void check_direction(const Vec3& along) {
  if (kernel::is_finite(along) && !(along == Vec3{})) return;
  throw InputError({.what = "the direction of the movement is zero or not finite",
                    .why = "a derivative along it is not defined",
                    .suggestion = "give three finite numbers that are not all 0"});
}

}  // namespace

namespace exact {

void check_measure(const Measure& measure) {
  if (measure.kind != MeasureKind::kOvercast) return;
  if (!kernel::is_finite(measure.up) || measure.up == Vec3{}) {
    throw InputError({.what = "the direction upwards is zero or not finite",
                      .why = "an overcast sky is brightest there",
                      .suggestion = "give three finite numbers that are not all 0"});
  }
  if (!measure.sphere) return;
  throw InputError({.what = "the overcast sky of a sphere is requested",
                    .why = "illuminance needs a surface with a normal",
                    .suggestion = "give a normal, or ask for the solid angle"});
}

Vec3 normal_of_sphere(const Scene& scene, const Receiver& receiver) {
  const auto has_area = [&](FaceId face) { return scene.face(face).piece_count > 0; };
  const auto own = std::ranges::find_if(receiver.on, has_area);
  if (own == receiver.on.end()) return {0.0, 0.0, 1.0};
  return front_of_piece(scene, own_piece(scene, *own, receiver.point));
}

Receiver looking_along(const Receiver& receiver, const Vec3& n) {
  return {.point = receiver.point, .normal = n, .on = receiver.on, .id = {}};
}

void check_arguments(const Scene& scene, const Receiver& receiver, const ExactSource& source, const Measure& measure) {
  require_of_scene(scene, ExactSourceInside::planes(source).scene, "source");
  check_receiver(receiver, measure);
  for (const FaceId face : receiver.on) require_face(scene, face);
}

void check_view_arguments(const Scene& scene, const Receiver& receiver, const Measure& measure, int precision_cap) {
  check_precision_cap(precision_cap);
  check_measure(measure);
  check_receiver(receiver, measure);
  for (const FaceId face : receiver.on) require_face(scene, face);
}

}  // namespace exact

namespace {

void check_options(const Scene& scene, const ExactOptions& options) {
  check_precision_cap(options.precision_cap);
  exact::check_measure(options.measure);
  if (!options.measure.is_form_factor() &&
      (options.gradient || options.vertices || options.list_arcs || options.along)) {
    throw InputError({.what = "a gradient of another measure than the form factor is requested",
                      .why = "only that of the form factor is known",
                      .suggestion = "leave out the gradient, or the measure"});
  }
  if (options.along) check_direction(*options.along);
  const std::vector<FaceId>* only = options.only_occluders;
  if (only == nullptr || only->empty()) return;
  if (!std::is_sorted(only->begin(), only->end())) {
    refuse_argument("only_occluders is not in ascending order", "a search by halves would miss faces");
  }
  require_face(scene, only->back());
}

void set_count(std::vector<PlaneRecord>& records, std::size_t count, std::vector<PlaneRecord>& spare) {
  constexpr std::size_t kMostSpare = 4096;
  for (; records.size() > count; records.pop_back()) {
    if (spare.size() < kMostSpare) spare.push_back(std::move(records.back()));
  }
  for (; records.size() < count && !spare.empty(); spare.pop_back()) records.push_back(std::move(spare.back()));
  records.resize(count);
}

// Resets the result but keeps its memory; the records are still to be set.
void reset(FormFactor& result, std::size_t planes, bool keeps_gradient, std::vector<PlaneRecord>& spare) {
  FormFactor fresh;
  fresh.enclosure = std::move(result.enclosure);
  EnclosureInside::set(fresh.enclosure, Ball());
  fresh.cutters = std::move(result.cutters);
  fresh.cutters.clear();
  fresh.planes = std::move(result.planes);
  set_count(fresh.planes, planes, spare);
  if (keeps_gradient) fresh.gradient = std::move(result.gradient);
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

void sort_unique(std::vector<FaceId>& faces) {
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

// Runs one engine on one receiver and one source.
class Solver {
 public:
  Solver(const Scene& scene, const Receiver& receiver, const ExactSource& source, const ExactOptions& options,
         FormFactor& result, WorkspaceInside::Memory& memory)
      : scene_(scene),
        receiver_(receiver),
        planes_(ExactSourceInside::planes(source).planes),
        options_(options),
        is_form_factor_(options.measure.is_form_factor()),
        wants_fraction_(options.visible_fraction || options.exact_fraction),
        wants_gradient_(options.gradient || options.vertices || options.list_arcs || options.along.has_value()),
        view_(scene, receiver),
        request_{.engine = options.engine,
                 .fraction = wants_fraction_,
                 .list_cutters = options.list_cutters,
                 .only_occluders = options.only_occluders,
                 .culling = options.culling,
                 .remembers_covers = !options.from_scratch},
        result_(result),
        memory_(memory) {}

  void run() {
    reset(result_, planes_.size(), wants_gradient_, memory_.spare_records);
    memory_.quick.start(view_.n);
    if (wants_gradient_) start_gradient();
    for (std::size_t p = 0; p < planes_.size(); ++p) {
      PlaneVisibility seen = is_form_factor_ ? find(planes_[p]) : measured(planes_[p]);
      if (wants_gradient_ && !view_.is_buried) {
        memory_.gradient->add({view_, planes_[p], request_}, seen.boundary);
      } else if (is_form_factor_) {
        memory_.quick.add(seen.boundary);
      }
      note(planes_[p], std::move(seen), result_.planes[p]);
    }
    sort_unique(result_.cutters);
    if (something_visible_ && !sum_is_certain()) integrate_in_balls();
    exact::set_bounds(result_, is_form_factor_ ? 1.0 : contour::most_of(options_.measure));
    if (wants_gradient_) find_gradient();
    if (options_.vertices && !view_.is_buried) find_vertices();
    if (wants_fraction_) set_fraction(shares_, result_);
  }

 private:
  // Steps 1 to 6 for one plane.
  [[nodiscard]] PlaneVisibility find(const SourcePlane& plane) {
    return find_visible_boundary(view_, plane, request_, memory_.edges);
  }

  // The same for another measure, whose terms are added. Those of a sphere are found in two halves of its view.
  [[nodiscard, gnu::noinline]] PlaneVisibility measured(const SourcePlane& plane) {
    PlaneVisibility seen = measured(plane, half_view(plane, 0));
    if (options_.measure.sphere) join(seen, measured(plane, half_view(plane, 1)));
    return seen;
  }

  [[nodiscard]] PlaneVisibility measured(const SourcePlane& plane, const visibility::View& view) {
    PlaneVisibility seen = find_visible_boundary(view, plane, request_, memory_.edges);
    memory_.quick.add(seen.boundary, options_.measure, view.n);
    return seen;
  }

  // The receiver's view, or one of both halves of what a sphere sees. Where these meet does not matter: nearly all
  // planes are in the first.
  [[nodiscard]] visibility::View half_view(const SourcePlane& plane, int half) const {
    if (!options_.measure.sphere) return view_;
    const Vec3 n =
        receiver_.on.empty() ? exact::rounded(plane.normal.exact) : exact::normal_of_sphere(scene_, receiver_);
    const double turn = half == 0 ? -1.0 : 1.0;
    return {scene_, exact::looking_along(receiver_, {turn * n.x, turn * n.y, turn * n.z})};
  }

  // Adds what is seen in the other half. The boundary then only tells whether anything is seen.
  static void join(PlaneVisibility& all, PlaneVisibility&& other) {
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
    std::ranges::sort(all.cutters);
    all.cutters.erase(std::unique(all.cutters.begin(), all.cutters.end()), all.cutters.end());
    if (!other.boundary.empty()) all.boundary = std::move(other.boundary);
  }

  void note(const SourcePlane& plane, PlaneVisibility&& seen, PlaneRecord& record) {
    if (options_.list_cutters) seen.record.cutters = seen.cutters.size();
    something_visible_ = something_visible_ || !seen.boundary.empty();
    if (wants_fraction_) {
      note_fraction(seen, options_);
      shares_.push_back(share_of(scene_, plane, seen));
    }
    result_.cutters.insert(result_.cutters.end(), seen.cutters.begin(), seen.cutters.end());
    set_record(record, std::move(seen.record), plane.faces);
    last_boundary_ = std::move(seen.boundary);
  }

  void start_gradient() {
    if (memory_.gradient == nullptr) memory_.gradient = std::make_unique<gradient::PointGradient>();
    memory_.gradient->start(view_, {options_.along, options_.list_arcs});
  }

  // As for the value, the boundaries are found again where double-double does not suffice.
  void find_gradient() {
    gradient::PointGradient& gradient = *memory_.gradient;
    if (!result_.gradient) result_.gradient.emplace();
    if (gradient.finish(options_.precision_cap, *result_.gradient)) return;
    for (const SourcePlane& plane : planes_) {
      const PlaneVisibility seen = find(plane);
      gradient.add_exactly({view_, plane, request_}, seen.boundary);
    }
    gradient.certify(options_.precision_cap, *result_.gradient);
  }

  // The boundary is found once more, from pieces, since panels may lack vertices that move it; and face by face, since
  // each face of the source moves with its own vertices.
  void find_vertices() {
    Gradient& result = *result_.gradient;
    if (result.kink) return;
    if (memory_.vertices == nullptr) memory_.vertices = std::make_unique<gradient::VertexGradient>();
    gradient::VertexGradient& vertices = *memory_.vertices;
    const visibility::BoundaryRequest request{
        .engine = options_.engine, .only_occluders = options_.only_occluders, .by_pieces = true};
    std::vector<SourcePlane> planes;
    for (const SourcePlane& plane : planes_)
      std::ranges::move(split_by_face(scene_, plane), std::back_inserter(planes));
    const auto for_each_plane = [&](const auto& add) {
      for (const SourcePlane& plane : planes) {
        const PlaneVisibility seen = find_visible_boundary(view_, plane, request, memory_.edges);
        add(visibility::PlaneQuery{view_, plane, request}, seen.boundary);
      }
    };
    vertices.start(view_);
    for_each_plane([&](const auto& query, const auto& boundary) { vertices.add(query, boundary); });
    if (vertices.finish(options_.precision_cap, result)) return;
    for_each_plane([&](const auto& query, const auto& boundary) { vertices.add_exactly(query, boundary); });
    vertices.certify(options_.precision_cap, result);
  }

  // Step 7 in double-double: takes the value from the sum over all planes, or from that of the gradient, which has the
  // same arcs. False if that does not determine it.
  [[nodiscard]] bool sum_is_certain() {
    constexpr int kBits = exact::QuickTier::kBits;
    if (options_.precision_cap < kBits) return false;
    if (!is_form_factor_) {
      const std::optional<bool> counts = memory_.quick.something_counts();
      if (counts != true) return counts.has_value();
    }
    const Ball ball = wants_gradient_ ? memory_.gradient->form_factor() : memory_.quick.ball();
    return exact::is_determined(ball, kBits, options_.digits, result_);
  }

  // Step 7 in balls of rising precision.
  void integrate_in_balls() {
    if (!is_form_factor_) return measure_in_balls();
    const contour::ContourIntegral contour = exact_contour();
    exact::certify([&](long bits) { return contour.evaluate(bits); }, options_.digits, options_.precision_cap, result_);
  }

  // The boundaries of all planes, in exact numbers. They are so seldom needed that none is kept beyond its place in the
  // workspace, which has only the last one: those of several planes are found again.
  [[nodiscard]] contour::ContourIntegral exact_contour() {
    contour::ContourIntegral contour(view_.normal().exact);
    const auto add = [&](const visibility::BoundaryPiece& piece) { contour.add(piece); };
    if (planes_.size() == 1) {
      last_boundary_.for_each_piece(add);
    } else {
      for (const SourcePlane& plane : planes_) find(plane).boundary.for_each_piece(add);
    }
    return contour;
  }

  [[gnu::noinline]] void measure_in_balls() {
    contour::MeasureIntegral integral(options_.measure);
    for (const SourcePlane& plane : planes_) {
      for (int half = 0; half < (options_.measure.sphere ? 2 : 1); ++half) {
        const visibility::View view = half_view(plane, half);
        integral.start(view.n);
        find_visible_boundary(view, plane, request_, memory_.edges)
            .boundary.for_each_piece([&](const visibility::BoundaryPiece& piece) { integral.add(piece); });
      }
    }
    if (integral.empty()) return;
    exact::certify([&](long bits) { return integral.evaluate(bits); }, options_.digits, options_.precision_cap, result_,
                   contour::most_of(options_.measure));
  }

  const Scene& scene_;
  const Receiver& receiver_;
  const std::vector<SourcePlane>& planes_;
  const ExactOptions& options_;
  const bool is_form_factor_, wants_fraction_, wants_gradient_;
  const visibility::View view_;
  const visibility::BoundaryRequest request_;
  FormFactor& result_;
  WorkspaceInside::Memory& memory_;
  std::vector<PlaneShare> shares_;
  visibility::VisibleBoundary last_boundary_;
  bool something_visible_ = false;
};

void solve_by(Engine engine, const Scene& scene, const Receiver& receiver, const ExactSource& source,
              ExactOptions options, FormFactor& result, WorkspaceInside::Memory& memory) {
  options.engine = engine;
  Solver(scene, receiver, source, options, result, memory).run();
}

// Each engine sums its own edges, so with a low precision cap one engine may find a value that the other does not, or
// their estimates may differ.
bool same_value(const FormFactor& a, const FormFactor& b) {
  if (a.status == Status::kNotCertified || b.status == Status::kNotCertified) return true;
  return a.value == b.value && a.status == b.status;
}

bool same(const Derivative& a, const Derivative& b) {
  if (a.status == DerivativeStatus::kNone || b.status == DerivativeStatus::kNone) return a.status == b.status;
  const bool open = a.status == DerivativeStatus::kEnclosed || b.status == DerivativeStatus::kEnclosed;
  return (open || (a.value == b.value && a.status == b.status)) && a.enclosure.overlaps(b.enclosure);
}

// A vertex that is not listed has derivatives of zero.
bool same_vertices(std::span<const VertexDerivative> a, std::span<const VertexDerivative> b) {
  const auto all = [](const auto& p, const auto& q) { return std::equal(p.begin(), p.end(), q.begin(), same); };
  while (!a.empty() || !b.empty()) {
    const bool only_a = b.empty() || (!a.empty() && a.front().vertex < b.front().vertex);
    const bool only_b = a.empty() || (!b.empty() && b.front().vertex < a.front().vertex);
    const VertexDerivative none;
    const VertexDerivative &p = only_b ? none : a.front(), &q = only_a ? none : b.front();
    if (p.is_kink != q.is_kink || !all(p.position, q.position)) return false;
    if (!only_b) a = a.subspan(1);
    if (!only_a) b = b.subspan(1);
  }
  return true;
}

bool same_gradient(const std::optional<Gradient>& a, const std::optional<Gradient>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  const auto all = [](const auto& p, const auto& q) { return std::equal(p.begin(), p.end(), q.begin(), same); };
  return same_vertices(a->vertices, b->vertices) && a->kink.has_value() == b->kink.has_value() &&
         all(a->position, b->position) && all(a->normal, b->normal) && (!a->along || same(*a->along, b->along.value()));
}

void require_agreement(const FormFactor& a, const FormFactor& b) {
  if (!same_gradient(a.gradient, b.gradient)) throw std::logic_error("the two engines disagree about the gradient");
  if (same_value(a, b) && a.enclosure.overlaps(b.enclosure) && a.visible_fraction == b.visible_fraction &&
      a.visible_part == b.visible_part) {
    return;
  }
  throw std::logic_error("the two engines disagree: " + a.enclosure.midpoint() + " by edges, " +
                         b.enclosure.midpoint() + " by Booleans");
}

}  // namespace

FormFactor exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                             const ExactOptions& options) {
  FormFactor result;
  exact_form_factor(scene, receiver, source, options, result);
  return result;
}

void exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                       const ExactOptions& options, FormFactor& result) {
  thread_local Workspace own;
  ExactOptions alone = options;
  alone.from_scratch = true;
  exact_form_factor(scene, receiver, source, alone, result, own);
}

void exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                       const ExactOptions& options, FormFactor& result, Workspace& workspace) {
  const kernel::StandardArithmetic arithmetic;
  check_options(scene, options);
  exact::check_arguments(scene, receiver, source, options.measure);
  const bool both = options.engine == Engine::kBoth;
  WorkspaceInside::Memory& memory = WorkspaceInside::memory(workspace);
  solve_by(both ? Engine::kEdges : options.engine, scene, receiver, source, options, result, memory);
  if (!both) return;
  FormFactor reference;
  solve_by(Engine::kBoolean, scene, receiver, source, options, reference, memory);
  require_agreement(result, reference);
}

bool behind_every_face(const FormFactor& result) {
  return !result.planes.empty() && std::all_of(result.planes.begin(), result.planes.end(),
                                               [](const PlaneRecord& p) { return p.outcome == Outcome::kBehind; });
}

// --- Drawing ---

// The exact geometry rounded to doubles. No value depends on anything here.

namespace {

Loop lift_ring(const exact::Lift& lift, const kernel::Ring& ring) {
  Loop loop;
  for (const kernel::Direction& corner : ring) loop.corners.push_back(lift(corner.exact));
  return loop;
}

PlaneDrawing draw(const visibility::View& view, const visibility::SourcePlane& plane) {
  const visibility::PlaneGeometry seen = find_geometry(view, plane);
  const exact::Lift lift(plane.normal.exact, plane.point, view.x);
  PlaneDrawing drawing;
  drawing.normal = exact::rounded(plane.normal.exact);
  if (side_of(plane, view.x) <= 0) return drawing;
  for (const kernel::Ring& ring : seen.source) drawing.source.push_back(lift_ring(lift, ring));
  for (const kernel::Ring& ring : seen.clipped) drawing.clipped_source.push_back(lift_ring(lift, ring));
  for (const visibility::Occluder& occluder : seen.occluders) {
    drawing.shadows.push_back({occluder.face, lift_ring(lift, occluder.ring)});
  }
  for (const visibility::RegionLoop& loop : seen.visible) {
    Loop drawn{{}, loop.hole};
    for (const visibility::Point2& corner : loop.corners) {
      drawn.corners.push_back(lift(seen.frame->to_direction(corner)));
    }
    if (!seen.frame->keeps_orientation()) std::reverse(drawn.corners.begin(), drawn.corners.end());
    drawing.visible.push_back(std::move(drawn));
  }
  return drawing;
}

}  // namespace

std::vector<PlaneDrawing> draw_visibility(const Scene& scene, const Receiver& receiver, const ExactSource& source) {
  const kernel::StandardArithmetic arithmetic;
  exact::check_arguments(scene, receiver, source);
  const visibility::View view(scene, receiver);
  std::vector<PlaneDrawing> drawings;
  for (const visibility::SourcePlane& plane : ExactSourceInside::planes(source).planes)
    drawings.push_back(draw(view, plane));
  return drawings;
}

}  // namespace exactff
