// The whole view: one sweep over all edges (view_edges.h), then one sum of terms of Eq. (4) for each thing seen.
//
// A term counts + for what is on the left of its arc and - for what is on its right. Let C be the sum over the arcs
// with nothing on their right, the horizon's included: the share of all that is seen together. In the rest, 1 - C,
// nothing is seen.
#include "exactff/view.h"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <compare>
#include <optional>

#include "contour/contour.h"
#include "contour/measures.h"
#include "exact/quick_tier.h"
#include "exact/source_planes.h"
#include "kernel/ball.h"
#include "kernel/float_environment.h"
#include "scene/scene.h"
#include "whole_view/light.h"
#include "whole_view/view_edges.h"

namespace exactff {
namespace {

using exact::QuickTier;
using kernel::double_double::Bounded;
using visibility::BoundaryPiece;
using whole_view::kNothing;
using whole_view::OutlineId;
using whole_view::ViewEdges;

}  // namespace

struct ViewWorkspace::Memory {
  struct Half {
    ViewEdges edges;
    visibility::VisibleArcs arcs;
    std::vector<Bounded> terms;
  };
  std::array<Half, 2> halves;  // of a sphere's view; of any other receiver the first
  QuickTier quick;
  struct Sum {
    Bounded terms;
    bool seen = false, stacked = false;
  };
  std::vector<Sum> sums;  // by patch or face, then of the backs, then of all that is seen
  // The arcs beside each sum, in its order; found when a sum needs more than double-double precision.
  struct Reference {
    std::uint32_t sum = 0, half = 0, arc = 0;
    bool reversed = false;  // on the right of the arc
    friend auto operator<=>(const Reference&, const Reference&) = default;
  };
  std::vector<Reference> references;
  // What all directions are together to QuickTier::kBits: receivers of one normal share it.
  struct Whole {
    Measure measure;
    Vec3 n;
    Ball ball;
  };
  std::optional<Whole> whole;
  std::vector<SeenPatch> spare;  // views differ in their number of patches
  FormFactor form_factor;
};

struct ViewWorkspaceInside {
  using Memory = ViewWorkspace::Memory;
  [[nodiscard]] static Memory& memory(ViewWorkspace& workspace) { return workspace.memory(); }
};

ViewWorkspace::ViewWorkspace() : memory_(std::make_unique<Memory>()) {}
ViewWorkspace::ViewWorkspace(ViewWorkspace&&) noexcept = default;
ViewWorkspace& ViewWorkspace::operator=(ViewWorkspace&&) noexcept = default;
ViewWorkspace::~ViewWorkspace() = default;
ViewWorkspace::Memory& ViewWorkspace::memory() { return owned_by(memory_, "ViewWorkspace"); }

namespace {

using ViewMemory = ViewWorkspaceInside::Memory;

void reset(ViewShare& share) {
  share.value = share.lower = share.upper = 0.0;
  share.status = Status::kZero;
  EnclosureInside::set(share.enclosure, Ball());
  share.precision_bits = 0;
}

Vec3 direction(const kernel::ExactVec3& exact) {
  const kernel::Approx3 t = kernel::approx(exact);
  return {t.x, t.y, t.z};
}

class ViewSolver {
 public:
  ViewSolver(const Scene& scene, const Receiver& receiver, const ViewOptions& options, WholeView& result,
             ViewWorkspace& workspace)
      : scene_(scene),
        receiver_(receiver),
        options_(options),
        measure_(options.measure),
        result_(result),
        workspace_(workspace),
        memory_(ViewWorkspaceInside::memory(workspace)),
        backs_(static_cast<std::uint32_t>(options.faces ? scene.faces().size() : scene.patches().size())),
        all_(backs_ + 1) {
    if (!measure_.sphere) {
      views_.emplace_back(scene, receiver);
      return;
    }
    const Vec3 n = exact::normal_of_sphere(scene, receiver);
    views_.emplace_back(scene, exact::looking_along(receiver, n));
    views_.emplace_back(scene, exact::looking_along(receiver, {-n.x, -n.y, -n.z}));
  }

  void find() {
    result_.record = {};
    for (std::uint32_t h = 0; h < views_.size(); ++h) find_half(views_[h], memory_.halves[h]);
  }

  // Reads what was found.
  void measure() {
    memory_.quick.start(views_.front().n);
    for (std::uint32_t h = 0; h < views_.size(); ++h) {
      memory_.quick.find_terms(memory_.halves[h].arcs[0], measure_, memory_.halves[h].terms);
    }
    memory_.references.clear();
    add_up();
    set_patches();
    set_back();
    set_open();
    set_buried();
    list_arcs();
  }

 private:
  void find_half(const visibility::View& view, ViewMemory::Half& half) {
    half.edges.find(view, options_.arcs    ? ViewEdges::Wholes::kFaces
                          : options_.faces ? ViewEdges::Wholes::kFronts
                                           : ViewEdges::Wholes::kPatches);
    half.arcs.clear();
    half.arcs.add(view, half.edges);
    const ViewEdges::Work& work = half.edges.work();
    ViewRecord& record = result_.record;
    record.outlines += work.outlines;
    record.windows += work.windows;
    record.pairs += work.pairs;
    record.undecided += work.undecided;
    record.pierced += work.pierced;
    record.arcs += half.edges.parts().size();
  }

  // The index of the sum that an outline belongs to.
  [[nodiscard]] std::uint32_t sum_of(const ViewEdges& edges, OutlineId outline) const {
    if (outline == kNothing) return all_;
    if (!edges.shows_front(outline)) return backs_;
    const FaceId face = edges.face(outline);
    return static_cast<std::uint32_t>(options_.faces ? index_of(face) : index_of(scene_.face(face).patch));
  }

  void add_up() {
    memory_.sums.assign(all_ + 1, {});
    for (std::uint32_t h = 0; h < views_.size(); ++h) add_up(memory_.halves[h]);
  }

  void add_up(const ViewMemory::Half& half) {
    const ViewEdges& edges = half.edges;
    for (std::size_t i = 0; i < edges.parts().size(); ++i) {
      const ViewEdges::Sides& sides = edges.sides()[i];
      const std::uint32_t left = sum_of(edges, sides.left), right = sum_of(edges, sides.right);
      if (left == right) continue;
      const Bounded& term = half.terms[i];
      if (term.error == 0.0) continue;  // it does not count (contour/quick_measures.h); a term of F has an error
      add(memory_.sums[left], term);
      // All that is seen lies on the left of an arc with nothing on its right.
      add(memory_.sums[right], right == all_ ? term : -term);
    }
    for (const auto& [first, other] : edges.stacks()) {
      const std::uint32_t of_other = sum_of(edges, other);
      if (sum_of(edges, first) != of_other) memory_.sums[of_other].stacked = true;
    }
  }

  static void add(ViewMemory::Sum& sum, const Bounded& term) {
    sum.terms = sum.terms + term;
    sum.seen = true;
  }

  void find_references() {
    for (std::uint32_t number = 0; number < views_.size(); ++number) {
      const ViewMemory::Half& half = memory_.halves[number];
      for (std::uint32_t i = 0; i < half.edges.parts().size(); ++i) {
        const ViewEdges::Sides& sides = half.edges.sides()[i];
        const std::uint32_t left = sum_of(half.edges, sides.left), right = sum_of(half.edges, sides.right);
        if (left == right) continue;
        memory_.references.push_back({left, number, i, false});
        memory_.references.push_back({right, number, i, right != all_});
      }
    }
    std::ranges::sort(memory_.references);
  }

  // The arcs of the sum again, for balls of any precision: calls add(piece, number of the half).
  template <class Add>
  void for_each_piece(std::uint32_t of, const Add& add) {
    if (memory_.references.empty()) find_references();
    const auto& all = memory_.references;
    for (auto at = std::lower_bound(all.begin(), all.end(), ViewMemory::Reference{of, 0, 0, false});
         at != all.end() && at->sum == of; ++at) {
      ViewEdges& edges = memory_.halves[at->half].edges;
      BoundaryPiece piece = edges.exact(edges.parts()[at->arc]);
      if (at->reversed) std::swap(piece.begin, piece.end);
      add(piece, at->half);
    }
  }

  template <class Evaluate>
  void certify(const Evaluate& evaluate, ViewShare& share) const {
    exact::certify(evaluate, options_.digits, options_.precision_cap, share, contour::most_of(measure_));
  }

  // What all directions are together: in the halves that are not buried, or in those that are.
  [[nodiscard]] Ball whole(bool buried, long bits) const {
    const auto count = std::ranges::count(views_, buried, &visibility::View::is_buried);
    if (count == 0) return Ball(bits);
    const Vec3& n = views_.front().n;
    if (bits == QuickTier::kBits && (!memory_.whole || memory_.whole->measure != measure_ || memory_.whole->n != n)) {
      memory_.whole = {measure_, n, contour::whole_measure(measure_, n, bits)};
    }
    const Ball all = bits == QuickTier::kBits ? memory_.whole->ball : contour::whole_measure(measure_, n, bits);
    return static_cast<std::size_t>(count) == views_.size() ? all : all / kernel::to_ball(2.0, bits);
  }

  void set_share(std::uint32_t of, ViewShare& share) {
    reset(share);
    const ViewMemory::Sum& sum = memory_.sums[of];
    if (!sum.seen) return;
    const auto value = [&](Ball ball, long bits) { return of == all_ ? whole(false, bits) - ball : ball; };
    if (options_.precision_cap < QuickTier::kBits ||
        !exact::is_determined(value(memory_.quick.ball(sum.terms), QuickTier::kBits), QuickTier::kBits, options_.digits,
                              share)) {
      set_in_balls(of, share, value);
    }
    exact::set_bounds(share, contour::most_of(measure_));
  }

  template <class Value>
  void set_in_balls(std::uint32_t of, ViewShare& share, const Value& value) {
    if (measure_.is_form_factor()) {
      contour::ContourIntegral contour(views_.front().normal().exact);
      for_each_piece(of, [&](const BoundaryPiece& piece, std::uint32_t) { contour.add(piece); });
      return certify([&](long bits) { return value(contour.evaluate(bits), bits); }, share);
    }
    contour::MeasureIntegral integral(measure_);
    for_each_piece(of, [&](const BoundaryPiece& piece, std::uint32_t half) {
      integral.start(views_[half].n);
      integral.add(piece);
    });
    if (integral.empty() && of != all_) return reset(share);
    certify([&](long bits) { return value(integral.evaluate(bits), bits); }, share);
  }

  void set_patches() {
    std::size_t count = 0;
    for (std::uint32_t p = 0; p < backs_; ++p) {
      if (!memory_.sums[p].seen && !memory_.sums[p].stacked) continue;
      if (count == result_.patches.size()) add_patch();
      SeenPatch& patch = result_.patches[count];
      set_patch(p, patch);
      if (patch.share.status != Status::kZero || patch.form_factor.status != Status::kZero) ++count;
    }
    for (; result_.patches.size() > count; result_.patches.pop_back()) {
      memory_.spare.push_back(std::move(result_.patches.back()));
    }
  }

  void add_patch() {
    if (memory_.spare.empty()) {
      result_.patches.emplace_back();
    } else {
      result_.patches.push_back(std::move(memory_.spare.back()));
      memory_.spare.pop_back();
    }
  }

  void set_patch(std::uint32_t index, SeenPatch& patch) {
    patch.face = options_.faces ? std::optional(FaceId{index}) : std::nullopt;
    patch.patch = options_.faces ? scene_.face(FaceId{index}).patch : PatchId{index};
    patch.stacked = memory_.sums[index].stacked;
    set_share(index, patch.share);
    if (!patch.stacked) {
      patch.form_factor = patch.share;
      return;
    }
    const ExactSource source(scene_, Selection{.patch = patch.patch, .face = patch.face, .scene = scene_.id()});
    FormFactor& f = memory_.form_factor;
    exact_form_factor(scene_, receiver_, source,
                      {.measure = measure_, .digits = options_.digits, .precision_cap = options_.precision_cap}, f,
                      workspace_);
    patch.form_factor = {f.value, f.lower, f.upper, f.status, f.enclosure, f.precision_bits};
  }

  void set_back() { set_share(backs_, result_.back); }

  // Of the directions of one half that count: which meet nothing.
  enum class Open { kNone, kSome, kAll };

  // Where no arc above the horizon, or above both horizons, has nothing on its right, either all directions meet
  // something or none does. If all do, something meets the horizon.
  [[nodiscard]] Open open_in(const visibility::View& view, ViewMemory::Half& half) const {
    const auto terms = contour::terms_of(measure_, view.n);
    if (view.is_buried || terms == contour::MeasureTerms::kNone) return Open::kNone;
    if (half.edges.outline_count() == 0) return Open::kAll;
    bool covered = terms != contour::MeasureTerms::kTilted;
    for (std::size_t i = 0; i < half.edges.parts().size(); ++i) {
      const ViewEdges::Sides& sides = half.edges.sides()[i];
      if (sides.right != kNothing || (sides.on_horizon && covered) || !counts(view, half, i)) continue;
      if (!sides.on_horizon) return Open::kSome;
      covered = true;
    }
    return covered ? Open::kNone : Open::kAll;
  }

  // Whether a part of the arc is above the horizon of an overcast sky.
  [[nodiscard]] bool counts(const visibility::View& view, ViewMemory::Half& half, std::size_t arc) const {
    const double error = half.terms[arc].error;
    if (measure_.kind != MeasureKind::kOvercast || std::isfinite(error)) return error != 0.0;
    contour::MeasureIntegral alone(measure_);
    alone.start(view.n);
    alone.add(half.edges.exact(half.edges.parts()[arc]));
    return !alone.empty();
  }

  void set_open() {
    std::size_t none = 0, all = 0;
    for (std::uint32_t h = 0; h < views_.size(); ++h) {
      const Open open = open_in(views_[h], memory_.halves[h]);
      none += open == Open::kNone ? 1 : 0;
      all += open == Open::kAll ? 1 : 0;
    }
    reset(result_.open);
    if (none == views_.size()) return;
    if (none + all == views_.size()) return set_to_whole(none == 0 ? 1.0 : 0.5, result_.open);
    set_share(all_, result_.open);
  }

  void set_buried() {
    reset(result_.buried);
    result_.buried_under.reset();
    std::size_t buried = 0;
    for (const visibility::View& view : views_) {
      if (!view.is_buried) continue;
      ++buried;
      result_.buried_under = buried_under(scene_, exact::looking_along(receiver_, view.n));
    }
    if (buried > 0) set_to_whole(buried == views_.size() ? 1.0 : 0.5, result_.buried);
  }

  // What all directions are together, times `part`.
  void set_to_whole(double part, ViewShare& share) const {
    if (measure_.is_form_factor()) {
      share.enclosure = Enclosure::of(1.0);
      share.value = 1.0;
      share.status = Status::kCertified;
    } else {
      certify(
          [&](long bits) {
            return contour::whole_measure(measure_, views_.front().n, bits) * kernel::to_ball(part, bits);
          },
          share);
    }
    exact::set_bounds(share, contour::most_of(measure_));
  }

  void list_arcs() {
    result_.arcs.clear();
    if (!options_.arcs) return;
    for (std::uint32_t h = 0; h < views_.size(); ++h) list_arcs(memory_.halves[h].edges);
  }

  void list_arcs(ViewEdges& edges) {
    const auto face = [&](OutlineId o) { return o == kNothing ? std::nullopt : std::optional(edges.face(o)); };
    const auto front = [&](OutlineId o) { return o == kNothing || edges.shows_front(o); };
    for (std::size_t i = 0; i < edges.parts().size(); ++i) {
      const ViewEdges::Sides& sides = edges.sides()[i];
      const BoundaryPiece piece = edges.exact(edges.parts()[i]);
      result_.arcs.push_back({.left = face(sides.left),
                              .right = face(sides.right),
                              .left_front = front(sides.left),
                              .right_front = front(sides.right),
                              .on_horizon = sides.on_horizon,
                              .from = direction(piece.from()),
                              .to = direction(piece.to())});
    }
  }

  const Scene& scene_;
  const Receiver& receiver_;
  const ViewOptions& options_;
  const Measure& measure_;
  boost::container::static_vector<visibility::View, 2> views_;  // of a sphere two, in opposite directions
  WholeView& result_;
  Workspace& workspace_;
  ViewMemory& memory_;
  const std::uint32_t backs_, all_;
};

}  // namespace

FormFactor as_form_factor(const ViewShare& share) {
  FormFactor result;
  as_form_factor(share, result);
  return result;
}

void as_form_factor(const ViewShare& share, FormFactor& result) {
  result.value = share.value;
  result.lower = share.lower;
  result.upper = share.upper;
  result.status = share.status;
  result.enclosure = share.enclosure;
  result.precision_bits = share.precision_bits;
  result.visible_fraction.reset();
  result.visible_part.reset();
  result.cutters.clear();
  result.planes.clear();
}

WholeView view(const Scene& scene, const Receiver& receiver, const ViewOptions& options) {
  thread_local ViewWorkspace own;
  WholeView result;
  view(scene, receiver, options, result, own);
  return result;
}

void view(const Scene& scene, const Receiver& receiver, const ViewOptions& options, WholeView& result,
          ViewWorkspace& workspace) {
  const kernel::StandardArithmetic arithmetic;
  exact::check_view_arguments(scene, receiver, options.measure, options.precision_cap);
  ViewSolver solver(scene, receiver, options, result, workspace);
  solver.find();
  solver.measure();
}

void whole_view::measure_again(const Scene& scene, const Receiver& receiver, const ViewOptions& options,
                               WholeView& result, ViewWorkspace& workspace) {
  ViewSolver(scene, receiver, options, result, workspace).measure();
}

// --- Quantity ---

std::string_view to_string(Quantity quantity) {
  constexpr std::string_view kNames[] = {"radiance", "radiosity", "irradiance", "form-factor"};
  return kNames[static_cast<std::size_t>(quantity)];
}

std::optional<Quantity> quantity_named(std::string_view name) {
  for (const Quantity quantity :
       {Quantity::kRadiance, Quantity::kRadiosity, Quantity::kIrradiance, Quantity::kFormFactor}) {
    if (to_string(quantity) == name) return quantity;
  }
  return std::nullopt;
}

std::string unit_of(Quantity quantity, KeMeans ke) {
  if (quantity == Quantity::kFormFactor) return "a pure number";
  const bool radiance = quantity == Quantity::kRadiance, ke_is_radiance = ke == KeMeans::kRadiance;
  return radiance == ke_is_radiance ? "the unit of Ke" : radiance ? "the unit of Ke / pi" : "the unit of Ke * pi";
}

}  // namespace exactff
