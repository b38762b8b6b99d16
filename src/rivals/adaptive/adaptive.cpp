// The ray-sampled adaptive algorithm: F. Tampieri, "Accurate Form-Factor Computation", Graphics Gems III (1992).
//
// Notation: x the receiving point, s a patch of the source, V the visible fraction of s, F its unoccluded form factor.
//   ComputeContribution       1. CanCull: x behind s gives 0            2. eps_F = eps_B / max(rho_r B_s)
//   ComputeFormFactor         3. V by ComputeVisibilityFactor           4. V <= 0: 0
//                             5. V >= 1: F by Eq. (4)                   6. F <= eps_F or A <= eps_A: 7. V F
//                             8. else SplitPatch                        9. and sum the parts
//   ComputeVisibilityFactor   no candidate in the shaft: 1; one candidate cuts it: 0; else the mean of shadow rays.
// Departures, all named in LeafReason, Variant or here: a depth cap; the horizon clips the source before the recursion
// (not in Variant::kLiteral); a source of several faces is the sum of them, each with its own recursion.
#include "exactff/adaptive.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "adaptive/sampled_scene.h"
#include "adaptive/sub_patch.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "scene/scene.h"

namespace exactff {

using namespace adaptive;

struct AdaptiveSource::Data {
  SceneId scene;
  Selection selection;
  SourceRoots source;
};

namespace {

// Memory that one thread reuses for each receiver.
struct Workspace {
  Gathered gathered;
  Blockers blockers;
  SamplePlan plan;
  RayEnds ends;
  std::vector<Vec3> polygon;
  std::vector<Vec3> clipped;
};

struct VisibilityFactor {
  double value = 0.0;
  std::optional<LeafReason> certain;  // set if shaft culling decided
  CandidateRange candidates;
};

// One receiver and one source.
class Recursion {
 public:
  // `visibility`: used instead of rays unless null.
  Recursion(const SampledScene& solver, const ReceiverView& view, const AdaptiveOptions& options, double largest_rho_b,
            PatchVisibility* visibility, Workspace& work, AdaptiveResult& result)
      : solver_(solver),
        view_(view),
        options_(options),
        eps_f_(options.eps_b / largest_rho_b),
        eps_a_(options.eps_a * solver.scene.scale * solver.scene.scale),
        visibility_(visibility),
        work_(work),
        result_(result) {
    work_.plan.prepare(options.pattern, options.rays);
    work_.ends.resize(work_.plan.ray_count());
  }

  double compute_contribution(const SourceRoots& source, std::uint64_t key) {
    double sum = 0.0;
    for (const SourceRoot& root : source.roots) {
      key = kernel::split_mix(key, 0);
      const SourcePlane& plane = source.planes[root.plane];
      if (!view_.is_own(root.piece) && !can_cull(plane)) sum += compute_root(root, plane, key);
    }
    return sum;
  }

 private:
  [[nodiscard]] bool literal() const { return options_.variant == Variant::kLiteral; }

  // The published test also culls a wall at right angles to the receiver's floor.
  [[nodiscard]] bool can_cull(const SourcePlane& plane) const {
    if (literal()) {
      const Vec3 source_normal = plane_normal(plane.frame[0], plane.frame[1], plane.frame[2]).value;
      if (dot(view_.unit_normal, source_normal) >= 0.0) return true;
    }
    return !in_front(view_, plane);
  }

  // The part of a root above the horizon, as one patch or as a fan of triangles.
  double compute_root(const SourceRoot& root, const SourcePlane& plane, std::uint64_t key) {
    work_.polygon.clear();
    for (int i = 0; i < root.corner_count; ++i) work_.polygon.push_back(root.corners[i] - view_.point);
    if (!literal()) {
      clip_by_horizon(work_.polygon, view_.normal, work_.clipped);
      work_.polygon.swap(work_.clipped);
    }
    const std::vector<Vec3>& p = work_.polygon;
    if (p.empty()) return 0.0;
    const Horizon horizon = literal() ? Horizon::kIgnored : Horizon::kClips;
    gather_occluders(solver_.scene, view_, plane, p, horizon, solver_.unit_box.blur(), work_.gathered);
    result_.shaft_tests += work_.gathered.looked_at;
    prepare_rays();
    if (visibility_ != nullptr) visibility_->start(root.piece);
    const CandidateRange all = occluders_.push_all();
    if (p.size() <= 4) return compute_form_factor(make_sub_patch(p), all, key, 0);
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      sum += compute_form_factor(make_sub_patch(std::array{p[0], p[i], p[i + 1]}), all, kernel::split_mix(key, i), 0);
    }
    return sum;
  }

  // If a list can be long: pieces too close for single precision are tested directly, the others by Embree.
  void prepare_rays() {
    blurred_ = {};
    if (occluders_.size() <= kLongestDirectList) return;
    blurred_ = occluders_.push(work_.gathered.blurred);
    work_.blockers.assign(solver_.scene.scene->pieces().size(), work_.gathered.sharp_pieces);
  }

  double compute_form_factor(const SubPatch& s, CandidateRange inherited, std::uint64_t key, int depth) {
    const VisibilityFactor v = compute_visibility_factor(s, inherited, key);
    if (v.value <= 0.0) return leaf(s, v, 0.0, depth, LeafReason::kSampledHidden);
    const double f = compute_unoccluded_form_factor(s);
    if (v.value >= 1.0) return leaf(s, v, f, depth, LeafReason::kSampledVisible);
    if (f <= eps_f_) return leaf(s, v, f, depth, LeafReason::kEpsF);
    if (eps_a_ > 0.0 && area(s) <= eps_a_) return leaf(s, v, f, depth, LeafReason::kEpsA);
    if (depth >= options_.depth_cap || has_most_leaves()) return leaf(s, v, f, depth, LeafReason::kDepthCap);
    double sum = 0.0;
    std::uint64_t child = 0;
    for (const SubPatch& part : split_patch(s)) {
      sum += compute_form_factor(part, v.candidates, kernel::split_mix(key, ++child), depth + 1);
    }
    occluders_.drop(v.candidates);
    return sum;
  }

  [[nodiscard]] bool has_most_leaves() const {
    return options_.most_leaves > 0 && result_.leaves >= options_.most_leaves;
  }

  // Pushes the reduced candidate list; the caller must drop it.
  VisibilityFactor compute_visibility_factor(const SubPatch& s, CandidateRange inherited, std::uint64_t key) {
    if (inherited.empty()) return {1.0, LeafReason::kShaftEmpty, inherited};
    result_.shaft_tests += inherited.size();
    const auto list = occluders_.inherit(inherited, s, ShaftSides(s));
    if (!list) return {0.0, LeafReason::kShaftCut, {}};
    if (list->empty()) return {1.0, LeafReason::kShaftEmpty, *list};
    return {visibility_ != nullptr ? visibility_->fraction(s) : trace_shadow_rays(s, *list, key), std::nullopt, *list};
  }

  double trace_shadow_rays(const SubPatch& s, CandidateRange list, std::uint64_t key) {
    work_.plan.place(s, key, work_.ends);
    const int rays = work_.ends.count;
    result_.rays += static_cast<std::uint64_t>(rays);
    const int visible = list.size() <= kLongestDirectList ? occluders_.count_visible(list, work_.ends)
                                                          : count_visible_by_embree(work_.ends);
    return static_cast<double>(visible) / rays;
  }

  int count_visible_by_embree(const RayEnds& ends) {
    int visible = 0;
    for (int first = 0; first < ends.count; first += RayScene::kPacket) {
      unsigned hidden = 0;
      for (int half = 0; half < RayScene::kPacket && !blurred_.empty(); half += RayEnds::kLanes) {
        if (first + half < ends.count) hidden |= occluders_.hidden_lanes(blurred_, ends, first + half) << half;
      }
      hidden = solver_.ray_scene().hidden_lanes(view_.point, ends, first, work_.blockers, hidden);
      const int lanes = std::min(RayScene::kPacket, ends.count - first);
      visible += lanes - std::popcount(hidden & ((1U << lanes) - 1));
    }
    return visible;
  }

  [[nodiscard]] double compute_unoccluded_form_factor(const SubPatch& s) const {
    return literal() ? literal_unoccluded_form_factor(s, view_.unit_normal)
                     : unoccluded_form_factor(s, view_.unit_normal);
  }

  // Counts a leaf and gives its share V F.
  double leaf(const SubPatch& s, const VisibilityFactor& v, double f, int depth, LeafReason sampled_reason) {
    const LeafReason reason = v.certain.value_or(sampled_reason);
    const auto level = static_cast<std::size_t>(depth);
    ++result_.leaves;
    ++result_.leaves_by_reason[static_cast<std::size_t>(reason)];
    if (result_.leaves_by_depth.size() <= level) result_.leaves_by_depth.resize(level + 1);
    ++result_.leaves_by_depth[level];
    if (options_.record_leaves && depth <= deepest_recorded_) record(s, v.value, f, depth, reason);
    if (v.candidates.size() > 0) occluders_.drop(v.candidates);
    if (result_.leaves + result_.rays >= next_poll_) poll();
    return v.value * f;
  }

  void poll() {
    constexpr std::uint64_t kPerPoll = 4'096;
    next_poll_ = result_.leaves + result_.rays + kPerPoll;
    kernel::poll();
  }

  void record(const SubPatch& s, double v, double f, int depth, LeafReason reason) {
    Leaf entry{{}, s.corner_count(), v, v > 0.0 ? f : compute_unoccluded_form_factor(s), depth, reason};
    for (int i = 0; i < entry.corner_count; ++i) {
      entry.corners[i] = (s.corner(i) + view_.point) * (1.0 / solver_.scene.scale);
    }
    result_.leaf_list.push_back(entry);
    while (options_.most_recorded_leaves != 0 && result_.leaf_list.size() > options_.most_recorded_leaves)
      drop_deepest();
  }

  void drop_deepest() {
    std::vector<Leaf>& leaves = result_.leaf_list;
    const int deepest = std::ranges::max_element(leaves, {}, &Leaf::depth)->depth;
    std::erase_if(leaves, [&](const Leaf& leaf) { return leaf.depth == deepest; });
    deepest_recorded_ = deepest - 1;
  }

  const SampledScene& solver_;
  const ReceiverView& view_;
  const AdaptiveOptions& options_;
  double eps_f_;
  double eps_a_;
  PatchVisibility* visibility_;
  Workspace& work_;
  OccluderSet& occluders_ = work_.gathered.occluders;
  AdaptiveResult& result_;
  std::uint64_t next_poll_ = 0;  // in leaves and rays
  int deepest_recorded_ = std::numeric_limits<int>::max();
  CandidateRange blurred_;
};

void require(bool holds, const char* what, const char* suggestion) {
  if (!holds) throw InputError(Problem{{}, 0, what, "the adaptive algorithm cannot run with it", suggestion});
}

void check(const AdaptiveOptions& options, double largest_rho_b) {
  require(options.eps_b >= 0.0, "eps_B is negative or not a number", "give a radiosity of at least 0");
  require(options.eps_a >= 0.0, "eps_A is negative or not a number", "give an area of at least 0");
  require(options.rays >= 1, "the number of shadow rays is below 1", "give at least 1");
  require(options.depth_cap >= 0, "the depth cap is negative", "give at least 0");
  require(largest_rho_b >= 0.0, "rho B is negative or not a number", "give reflectance and radiosity of at least 0");
}

// In the order of the enumerators.
constexpr std::array<std::string_view, 4> kPatternNames = {"centre", "regular", "jittered", "low-discrepancy"};
constexpr std::array<std::string_view, 2> kVariantNames = {"mended", "literal"};

template <class Enum>
std::optional<Enum> named(std::span<const std::string_view> names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? std::nullopt : std::optional(static_cast<Enum>(found - names.begin()));
}

}  // namespace

std::string_view to_string(SamplePattern pattern) { return kPatternNames[static_cast<std::size_t>(pattern)]; }
std::string_view to_string(Variant variant) { return kVariantNames[static_cast<std::size_t>(variant)]; }
std::optional<SamplePattern> pattern_named(std::string_view name) { return named<SamplePattern>(kPatternNames, name); }
std::optional<Variant> variant_named(std::string_view name) { return named<Variant>(kVariantNames, name); }

std::string_view to_string(LeafReason reason) {
  constexpr std::array<std::string_view, kLeafReasonCount> kNames = {"shaft empty", "shaft cut", "V=1",      "V=0",
                                                                     "eps_F",       "eps_A",     "depth cap"};
  return kNames[static_cast<std::size_t>(reason)];
}

AdaptiveSource::AdaptiveSource(std::unique_ptr<Data> data) : data_(std::move(data)) {}
AdaptiveSource::AdaptiveSource(AdaptiveSource&&) noexcept = default;
AdaptiveSource& AdaptiveSource::operator=(AdaptiveSource&&) noexcept = default;
AdaptiveSource::~AdaptiveSource() = default;
const AdaptiveSource::Data& AdaptiveSource::data() const { return owned_by(data_, "AdaptiveSource"); }

struct AdaptiveSolver::Impl : SampledScene {
  using SampledScene::SampledScene;
};

AdaptiveSolver::AdaptiveSolver(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  impl_ = std::make_unique<Impl>(scene);
}
AdaptiveSolver::AdaptiveSolver(AdaptiveSolver&&) noexcept = default;
AdaptiveSolver& AdaptiveSolver::operator=(AdaptiveSolver&&) noexcept = default;
AdaptiveSolver::~AdaptiveSolver() = default;

const AdaptiveSolver::Impl& AdaptiveSolver::impl() const { return owned_by(impl_, "AdaptiveSolver"); }
double AdaptiveSolver::build_seconds() const { return impl().build_seconds; }

AdaptiveSource AdaptiveSolver::prepare(const Selection& source) const {
  const kernel::StandardArithmetic arithmetic;
  const ScaledScene& scene = impl().scene;
  return AdaptiveSource(std::make_unique<AdaptiveSource::Data>(
      AdaptiveSource::Data{scene.scene->id(), source, make_source_roots(*scene.scene, scene.points, source)}));
}

namespace {

AdaptiveResult estimate(const SampledScene& solver, const Receiver& receiver, const AdaptiveInside::SourceData& source,
                        double largest_rho_b, const AdaptiveOptions& options, PatchVisibility* visibility) {
  check(options, largest_rho_b);
  require_of_scene(*solver.scene.scene, source.scene, "source");
  AdaptiveResult result;
  const ReceiverView view = view_from(receiver, solver.scene);
  const bool divides_by_zero = options.variant == Variant::kLiteral && options.eps_b > 0.0;
  if ((largest_rho_b == 0.0 && !divides_by_zero) || max_norm(view.point) > kFarthest) return result;
  thread_local Workspace work;
  Recursion recursion(solver, view, options, largest_rho_b, visibility, work, result);
  const double sum = recursion.compute_contribution(source.source, stream_key(view, source.selection, options.seed));
  result.form_factor =
      move_into_range(sum, options.variant == Variant::kLiteral ? Formula::kAny : Formula::kNotNegative);
  return result;
}

}  // namespace

AdaptiveResult AdaptiveSolver::form_factor(const Receiver& receiver, const AdaptiveSource& source, double largest_rho_b,
                                           const AdaptiveOptions& options) const {
  const kernel::StandardArithmetic arithmetic;
  return estimate(impl(), receiver, source.data(), largest_rho_b, options, nullptr);
}

AdaptiveResult AdaptiveInside::form_factor(const AdaptiveSolver& solver, const Receiver& receiver,
                                           const AdaptiveSource& source, double largest_rho_b,
                                           const AdaptiveOptions& options, PatchVisibility& visibility) {
  return estimate(solver.impl(), receiver, source.data(), largest_rho_b, options, &visibility);
}

AdaptiveResult AdaptiveSolver::form_factor(const Receiver& receiver, const Selection& source, double largest_rho_b,
                                           const AdaptiveOptions& options) const {
  return form_factor(receiver, prepare(source), largest_rho_b, options);
}

}  // namespace exactff
