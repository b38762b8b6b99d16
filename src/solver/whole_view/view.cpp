// The whole view: one sweep over all edges (view_edges.h), then one sum of terms of Eq. (4) for each thing seen.
//
// A term counts + for what is on the left of its arc and - for what is on its right. Let C be the sum over the arcs
// with nothing on their right, the horizon's included: the share of all that is seen together. In the rest, 1 - C,
// nothing is seen.
#include "exactff/view.h"

#include <algorithm>
#include <compare>

#include "contour/contour.h"
#include "exact/quick_tier.h"
#include "exact/source_planes.h"
#include "exact/workspace.h"
#include "kernel/ball.h"
#include "kernel/float_environment.h"
#include "scene/scene.h"
#include "whole_view/view_edges.h"

namespace exactff {
namespace {

using exact::QuickTier;
using kernel::double_double::Bounded;
using visibility::BoundaryPiece;
using whole_view::kNothing;
using whole_view::OutlineId;
using whole_view::ViewEdges;

struct ViewMemory : WorkspaceInside::Memory::Guest {
  ViewEdges edges;
  QuickTier quick;
  std::vector<Bounded> terms;
  struct Sum {
    Bounded terms;
    bool seen = false, stacked = false;
  };
  std::vector<Sum> sums;  // by patch or face, then of the backs, then of all that is seen
  // The arcs beside each sum, in its order; found when a sum needs more than double-double precision.
  struct Reference {
    std::uint32_t sum = 0, arc = 0;
    bool reversed = false;  // on the right of the arc
    friend auto operator<=>(const Reference&, const Reference&) = default;
  };
  std::vector<Reference> references;
  std::vector<SeenPatch> spare;  // views differ in their number of patches
  FormFactor form_factor;
};

ViewMemory& memory_of(Workspace& workspace) {
  auto& guest = WorkspaceInside::memory(workspace).view;
  if (!guest) guest = std::make_unique<ViewMemory>();
  return static_cast<ViewMemory&>(*guest);
}

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
             Workspace& workspace)
      : scene_(scene),
        receiver_(receiver),
        options_(options),
        view_(scene, receiver),
        result_(result),
        workspace_(workspace),
        memory_(memory_of(workspace)),
        edges_(memory_.edges),
        backs_(static_cast<std::uint32_t>(options.faces ? scene.faces().size() : scene.patches().size())),
        all_(backs_ + 1) {}

  void run() {
    edges_.find(view_, options_.arcs    ? ViewEdges::Wholes::kFaces
                       : options_.faces ? ViewEdges::Wholes::kFronts
                                        : ViewEdges::Wholes::kPatches);
    memory_.quick.start(view_.n);
    memory_.quick.find_terms(edges_, edges_.parts(), memory_.terms);
    memory_.references.clear();
    add_up();
    set_patches();
    set_back();
    set_open();
    set_buried();
    list_arcs();
    const ViewEdges::Work& work = edges_.work();
    result_.record = {work.outlines, work.windows, work.pairs, work.undecided, work.pierced, edges_.parts().size()};
  }

 private:
  // The index of the sum that an outline belongs to.
  [[nodiscard]] std::uint32_t sum_of(OutlineId outline) const {
    if (outline == kNothing) return all_;
    if (!edges_.shows_front(outline)) return backs_;
    const FaceId face = edges_.face(outline);
    return static_cast<std::uint32_t>(options_.faces ? index_of(face) : index_of(scene_.face(face).patch));
  }

  void add_up() {
    memory_.sums.assign(all_ + 1, {});
    for (std::size_t i = 0; i < edges_.parts().size(); ++i) {
      const ViewEdges::Sides& sides = edges_.sides()[i];
      const std::uint32_t left = sum_of(sides.left), right = sum_of(sides.right);
      if (left == right) continue;
      const Bounded& term = memory_.terms[i];
      add(memory_.sums[left], term);
      // All that is seen lies on the left of an arc with nothing on its right.
      add(memory_.sums[right], right == all_ ? term : -term);
    }
    for (const auto& [first, other] : edges_.stacks()) {
      if (sum_of(first) != sum_of(other)) memory_.sums[sum_of(other)].stacked = true;
    }
  }

  static void add(ViewMemory::Sum& sum, const Bounded& term) {
    sum.terms = sum.terms + term;
    sum.seen = true;
  }

  void find_references() {
    for (std::uint32_t i = 0; i < edges_.parts().size(); ++i) {
      const ViewEdges::Sides& sides = edges_.sides()[i];
      const std::uint32_t left = sum_of(sides.left), right = sum_of(sides.right);
      if (left == right) continue;
      memory_.references.push_back({left, i, false});
      memory_.references.push_back({right, i, right != all_});
    }
    std::ranges::sort(memory_.references);
  }

  // The sum again, for balls of any precision.
  [[nodiscard]] contour::ContourIntegral integral(std::uint32_t of) {
    if (memory_.references.empty()) find_references();
    contour::ContourIntegral contour(view_.normal().exact);
    const auto& all = memory_.references;
    for (auto at = std::lower_bound(all.begin(), all.end(), ViewMemory::Reference{of, 0, false});
         at != all.end() && at->sum == of; ++at) {
      BoundaryPiece piece = edges_.exact(edges_.parts()[at->arc]);
      if (at->reversed) std::swap(piece.begin, piece.end);
      contour.add(piece);
    }
    return contour;
  }

  void set_share(std::uint32_t of, ViewShare& share) {
    reset(share);
    const ViewMemory::Sum& sum = memory_.sums[of];
    if (!sum.seen) return;
    const auto value = [&](Ball ball, long bits) { return of == all_ ? kernel::to_ball(1.0, bits) - ball : ball; };
    if (options_.precision_cap < QuickTier::kBits ||
        !exact::is_determined(value(memory_.quick.ball(sum.terms), QuickTier::kBits), QuickTier::kBits, options_.digits,
                              share)) {
      const contour::ContourIntegral contour = integral(of);
      exact::certify([&](long bits) { return value(contour.evaluate(bits), bits); }, options_.digits,
                     options_.precision_cap, share);
    }
    exact::set_bounds(share);
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
    exact_form_factor(scene_, receiver_, source, {.digits = options_.digits, .precision_cap = options_.precision_cap},
                      f, workspace_);
    patch.form_factor = {f.value, f.lower, f.upper, f.status, f.enclosure, f.precision_bits};
  }

  void set_back() { set_share(backs_, result_.back); }

  // Where no arc above the horizon has nothing on its right, either all directions meet something or none does.
  void set_open() {
    const bool something = edges_.outline_count() > 0;
    const bool some_open = std::ranges::any_of(
        edges_.sides(), [](const ViewEdges::Sides& sides) { return sides.right == kNothing && !sides.on_horizon; });
    if (something && some_open) return set_share(all_, result_.open);
    reset(result_.open);
    if (!something && !view_.is_buried) set_to_one(result_.open);
  }

  void set_buried() {
    reset(result_.buried);
    result_.buried_under = buried_under(scene_, receiver_);
    if (result_.buried_under) set_to_one(result_.buried);
  }

  static void set_to_one(ViewShare& share) {
    share.enclosure = Enclosure::of(1.0);
    share.value = 1.0;
    share.status = Status::kCertified;
    exact::set_bounds(share);
  }

  void list_arcs() {
    result_.arcs.clear();
    if (!options_.arcs) return;
    const auto face = [&](OutlineId o) { return o == kNothing ? std::nullopt : std::optional(edges_.face(o)); };
    const auto front = [&](OutlineId o) { return o == kNothing || edges_.shows_front(o); };
    for (std::size_t i = 0; i < edges_.parts().size(); ++i) {
      const ViewEdges::Sides& sides = edges_.sides()[i];
      const BoundaryPiece piece = edges_.exact(edges_.parts()[i]);
      result_.arcs.push_back({.left = face(sides.left),
                              .right = face(sides.right),
                              .left_front = front(sides.left),
                              .right_front = front(sides.right),
                              .on_horizon = sides.on_horizon,
                              .from = direction(piece.a * piece.begin.l + piece.b * piece.begin.m),
                              .to = direction(piece.a * piece.end.l + piece.b * piece.end.m)});
    }
  }

  const Scene& scene_;
  const Receiver& receiver_;
  const ViewOptions& options_;
  const visibility::View view_;
  WholeView& result_;
  Workspace& workspace_;
  ViewMemory& memory_;
  ViewEdges& edges_;
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
  thread_local Workspace own;
  WholeView result;
  view(scene, receiver, options, result, own);
  return result;
}

void view(const Scene& scene, const Receiver& receiver, const ViewOptions& options, WholeView& result,
          Workspace& workspace) {
  const kernel::StandardArithmetic arithmetic;
  exact::check_view_arguments(scene, receiver, options.precision_cap);
  ViewSolver(scene, receiver, options, result, workspace).run();
}

// --- Quantity ---

std::string_view to_string(Quantity quantity) {
  switch (quantity) {
    case Quantity::kRadiance:
      return "radiance";
    case Quantity::kRadiosity:
      return "radiosity";
    case Quantity::kIrradiance:
      return "irradiance";
    case Quantity::kFormFactor:
      return "form-factor";
  }
  return {};
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
