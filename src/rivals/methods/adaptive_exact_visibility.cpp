// The control: Tampieri's recursion with exact V instead of shadow rays, for every sub-patch that shaft culling leaves
// in doubt.
//
// The remaining error is that of "constant visibility per leaf", which eps_B and eps_A control: a partly visible leaf
// that is not split further, because of its F or its area, contributes V F, as if its visible part were spread evenly.
// Any further error of the sampled algorithm comes from sampling V. There are no silent errors here: V is 0 or 1 only
// if the sub-patch is wholly hidden or wholly visible, which is decided exactly (exact/visible_share.h).
//
// The recursion, its shaft culling, its arithmetic and its sub-patches are those of the sampled algorithm. A sub-patch
// is represented by the window of the directions from x to its corners, which are doubles. Rounding moves the corners
// off the source's plane, but the directions still meet the plane, so that corners need not be planar and neighbours
// share them.
#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>

#include "adaptive/patch_visibility.h"
#include "exact/source_planes.h"
#include "exact/visible_share.h"
#include "kernel/float_environment.h"
#include "methods/adaptive_settings.h"
#include "methods/method_files.h"

namespace exactff::methods {

namespace {

struct ControlSource : PreparedSource {
  ControlSource(const AdaptiveSolver& solver, const Scene& scene, const Selection& chosen)
      : PreparedSource(chosen),
        adaptive(solver.prepare(chosen)),
        exact(scene, chosen),
        radiosity(scene.source_radiosity(chosen)) {}
  AdaptiveSource adaptive;
  ExactSource exact;
  Rgb radiosity;
};

// Answers the recursion's queries, for one receiver and one source. The visible region of a plane is found when first
// needed.
class ExactVisibility : public adaptive::PatchVisibility {
 public:
  ExactVisibility(const Scene& scene, const Receiver& receiver, const ExactSource& source, Workspace& workspace)
      : scene_(scene),
        receiver_(receiver),
        planes_(ExactSourceInside::planes(source).planes),
        workspace_(workspace),
        shares_(planes_.size()) {}

  void start(std::uint32_t piece) override {
    piece_ = piece;
    started_ = false;
  }

  double fraction(const adaptive::SubPatch& s) override {
    if (!started_) turn_to_piece();
    std::array<Vec3, 4> corners;
    const auto count = static_cast<std::size_t>(s.corner_count());
    for (std::size_t k = 0; k < count; ++k) corners[k] = s.corner(static_cast<int>(k));
    ++asked_;
    return share_->of({corners.data(), count});
  }

  [[nodiscard]] std::uint64_t request_count() const { return asked_; }
  // Decisions that needed rational numbers.
  [[nodiscard]] std::uint64_t undecided() const {
    std::uint64_t sum = 0;
    for (const auto& share : shares_) sum += share ? share->undecided() : 0;
    return sum;
  }

 private:
  void turn_to_piece() {
    const auto holds_piece = [this](const visibility::SourcePlane& plane) {
      return std::binary_search(plane.pieces.begin(), plane.pieces.end(), piece_);
    };
    const auto found = std::find_if(planes_.begin(), planes_.end(), holds_piece);
    if (found == planes_.end()) throw std::logic_error("a sub-patch lies in no plane of its source");
    const auto plane = static_cast<std::size_t>(found - planes_.begin());
    if (!shares_[plane]) shares_[plane].emplace(scene_, receiver_, planes_[plane], workspace_);
    share_ = &*shares_[plane];
    share_->start(piece_);
    started_ = true;
  }

  const Scene& scene_;
  const Receiver& receiver_;
  const std::vector<visibility::SourcePlane>& planes_;
  Workspace& workspace_;
  std::vector<std::optional<exact::VisibleShare>> shares_;  // by plane
  exact::VisibleShare* share_ = nullptr;
  std::uint32_t piece_ = 0;
  bool started_ = false;
  std::uint64_t asked_ = 0;
};

AdaptiveOptions control_options(const Settings& settings) {
  AdaptiveOptions options{.rays = 1, .pattern = SamplePattern::kCentre};
  take_tolerances(settings, options);
  return options;
}

class Control : public RecursionEvaluator {
 public:
  Control(const AdaptiveSolver& solver, const Scene& scene, const Settings& settings)
      : RecursionEvaluator(solver, scene, control_options(settings)) {}

  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& prepared) override {
    const auto& source = own<ControlSource>(prepared);
    ExactVisibility visibility(scene(), receiver(), source.exact, workspace_);
    Estimate result = estimate(source.adaptive, source.radiosity, &visibility);
    result.counters.add("exact V", visibility.request_count());
    result.counters.add("rational decisions", visibility.undecided());
    return result;
  }

 private:
  Workspace workspace_;
};

}  // namespace

Method adaptive_exact_visibility_method() {
  return {.name = "adaptive-exact-visibility",
          .summary = "a control: Tampieri's algorithm with the exact visible fraction of every leaf instead of rays",
          .source = "F. Tampieri, Accurate Form-Factor Computation (1992), with V computed exactly",
          .settings = tolerance_settings(),
          .prepare = prepare_as<OnScene<AdaptiveSolver, ControlSource, Control>>,
          .check = check_tolerances,
          .can_leave_unit = [](const Settings&) { return true; }};  // the sum over a source of several faces
}

}  // namespace exactff::methods
