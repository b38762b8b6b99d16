// One receiver and one source: checks the arguments, finds what is seen (region.h), and reads what the options request.
#include "exactff/exact.h"

#include <algorithm>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "exact/region.h"
#include "exact/source_planes.h"
#include "exactff/region.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "scene/scene.h"
#include "text/refuse.h"
#include "visibility/boolean_walk.h"

namespace exactff {

using kernel::Rational;

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
    text::refuse("the receiver's point or normal is not finite", "a form factor needs a point and a direction",
                 "give three finite numbers for each");
  }
  if (normal == Vec3{}) {
    text::refuse("the receiver's normal is (0, 0, 0)", "it has no direction, so the horizon is not defined",
                 "give a normal of any length other than zero");
  }
}

void check_precision_cap(int cap) {
  if (cap >= 1) return;
  text::refuse("the precision cap is " + std::to_string(cap) + " bits", "a ball (interval) needs at least one bit",
               "give a cap of at least 1; the default is 65536");
}

void check_direction(const Vec3& along) {
  if (kernel::is_finite(along) && !(along == Vec3{})) return;
  text::refuse("the direction of the movement is zero or not finite", "a derivative along it is not defined",
               "give three finite numbers that are not all 0");
}

}  // namespace

namespace exact {

void check_measure(const Measure& measure) {
  if (measure.kind != MeasureKind::kOvercast) return;
  if (!kernel::is_finite(measure.up) || measure.up == Vec3{}) {
    text::refuse("the direction upwards is zero or not finite", "an overcast sky is brightest there",
                 "give three finite numbers that are not all 0");
  }
  if (!measure.sphere) return;
  text::refuse("the overcast sky of a sphere is requested", "illuminance needs a surface with a normal",
               "give a normal, or ask for the solid angle");
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
    text::refuse("a gradient of another measure than the form factor is requested",
                 "only that of the form factor is known", "leave out the gradient, or the measure");
  }
  if (options.along) check_direction(*options.along);
  const std::vector<FaceId>* only = options.only_occluders;
  if (only == nullptr || only->empty()) return;
  if (!std::is_sorted(only->begin(), only->end())) {
    refuse_argument("only_occluders is not in ascending order", "a search by halves would miss faces");
  }
  require_face(scene, only->back());
}

void differentiate(exact::Region& region, const ExactOptions& options, visibility::EdgeWorkspace& edges,
                   Gradient& result) {
  region.differentiate({options.along, options.list_arcs}, options.precision_cap, result);
  if (options.vertices) region.differentiate_by_vertices(options.precision_cap, edges, result);
}

void solve_by(Engine engine, const Scene& scene, const Receiver& receiver, const ExactSource& source,
              ExactOptions options, FormFactor& result, WorkspaceInside::Memory& memory) {
  options.engine = engine;
  exact::Region& region = memory.region;
  region.find(scene, receiver, ExactSourceInside::planes(source).planes, options, memory.edges, result);
  if (options.gradient || options.vertices || options.list_arcs || options.along) {
    if (!result.gradient) result.gradient.emplace();
    differentiate(region, options, memory.edges, *result.gradient);
  } else {
    result.gradient.reset();
  }
  region.measure(options.measure, options.digits, options.precision_cap, result);
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

// --- Visible region ---

struct VisibleRegion::Data {
  visibility::EdgeWorkspace edges;
  exact::Region region;
  FormFactor found;  // its records
};

VisibleRegion::VisibleRegion() : data_(std::make_unique<Data>()) {}
VisibleRegion::VisibleRegion(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                             const ExactOptions& options)
    : VisibleRegion() {
  find(scene, receiver, source, options);
}
VisibleRegion::VisibleRegion(VisibleRegion&&) noexcept = default;
VisibleRegion& VisibleRegion::operator=(VisibleRegion&&) noexcept = default;
VisibleRegion::~VisibleRegion() = default;
VisibleRegion::Data& VisibleRegion::data() const { return owned_by(data_, "VisibleRegion"); }

void VisibleRegion::find(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                         const ExactOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  check_options(scene, options);
  exact::check_arguments(scene, receiver, source, options.measure);
  if (options.engine == Engine::kBoth) refuse_argument("a region by both engines", "one of them finds it");
  Data& all = data();
  all.region.find(scene, receiver, ExactSourceInside::planes(source).planes, options, all.edges, all.found);
}

bool VisibleRegion::empty() const { return data().region.arcs().empty(); }

std::vector<RegionArc> VisibleRegion::arcs() const {
  const kernel::StandardArithmetic arithmetic;
  std::vector<RegionArc> result;
  const visibility::VisibleArcs& sections = data().region.arcs();
  for (std::size_t s = 0; s < sections.size(); ++s) {
    const visibility::ArcSection seen = sections[s];
    const auto add = [&](const visibility::BoundaryPiece& piece, const auto& at) {
      result.push_back({at(piece.from()), at(piece.to())});
    };
    const visibility::ExactArcs exact(seen);
    for (const visibility::Arc& arc : seen.arcs) {
      const kernel::RationalVec3 x = kernel::to_rational(seen.x), nearness = exact.nearness(arc);
      add(exact(arc), [&](const kernel::ExactVec3& t) { return visibility::point_on_line(x, t, nearness); });
    }
    if (seen.is_by_edges()) continue;
    const exact::Lift lift(seen.plane->normal.exact, seen.plane->point, seen.x);
    for (const visibility::BoundaryPiece& piece : seen.pieces) add(piece, lift);
  }
  return result;
}

FormFactor VisibleRegion::form_factor(const Measure& measure, int digits, int precision_cap) {
  const kernel::StandardArithmetic arithmetic;
  check_precision_cap(precision_cap);
  exact::check_measure(measure);
  Data& all = data();
  if (measure.sphere != all.region.is_sphere()) {
    refuse_argument("a measure of a sphere, or of a receiver with a normal", "the region is that of the other");
  }
  all.region.measure(measure, digits, precision_cap, all.found);
  return all.found;
}

Gradient VisibleRegion::gradient(const ExactOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  check_precision_cap(options.precision_cap);
  if (options.along) check_direction(*options.along);
  Data& all = data();
  if (all.region.is_sphere()) refuse_argument("the gradient of a sphere's view", "only that of F is known");
  Gradient result;
  differentiate(all.region, options, all.edges, result);
  return result;
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
