// Two methods: Tampieri's ray-sampled adaptive algorithm (adaptive/adaptive.cpp), and its control with exact
// visibility.
#include "methods/adaptive.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <stdexcept>

#include "exact/source_planes.h"
#include "exact/visible_share.h"
#include "kernel/float_environment.h"
#include "methods/method_files.h"
#include "text/refuse.h"

namespace exactff::methods {

// --- Adaptive settings ---

namespace {

constexpr std::int64_t kDeepest = 1000;

// In the order of LeafReason.
constexpr std::array<std::string_view, kLeafReasonCount> kLeafCounters = {
    "leaves: shaft empty", "leaves: shaft cut", "leaves: V=1",      "leaves: V=0",
    "leaves: eps_F",       "leaves: eps_A",     "leaves: depth cap"};

// eps_B, eps_A and depth_cap.
std::vector<SettingSpec> tolerance_settings() {
  constexpr double kAny = std::numeric_limits<double>::max();
  const AdaptiveOptions defaults;
  return {number_setting("eps_B", defaults.eps_b, 0.0, kAny, "tolerance: no part with F <= eps_B / max(rho B) is split",
                         "radiosity"),
          number_setting("eps_A", defaults.eps_a, 0.0, kAny, "no part of this area or less is split", "area"),
          whole_setting("depth_cap", defaults.depth_cap, 0, kDeepest, "largest number of splits above a leaf")};
}

void take_tolerances(const Settings& settings, AdaptiveOptions& options) {
  options.eps_b = settings.number("eps_B");
  options.eps_a = settings.number("eps_A");
  options.depth_cap = static_cast<int>(settings.whole("depth_cap"));
}

// Throws InputError if only the depth cap would end the recursion.
void check_tolerances(const Settings& settings) {
  constexpr std::int64_t kModestDepth = 12;
  if (settings.number("eps_B") > 0.0 || settings.number("eps_A") > 0.0) return;
  if (settings.whole("depth_cap") <= kModestDepth) return;
  text::refuse("eps_B and eps_A are both 0",
               "nothing but the depth cap would end the recursion, after 2^depth leaves or more",
               "give one of them, or a depth_cap of at most 12");
}

}  // namespace

Estimate RecursionEvaluator::estimate(const AdaptiveSource& source, const Rgb& radiosity,
                                      adaptive::PatchVisibility* visibility) {
  const Rgb rho = scene_.receiver_reflectance(receiver_.on);
  const double rho_b = Rgb{rho.r * radiosity.r, rho.g * radiosity.g, rho.b * radiosity.b}.largest();
  AdaptiveResult found = is_buried_ ? AdaptiveResult{}
                         : visibility == nullptr
                             ? solver_.form_factor(receiver_, source, rho_b, options_)
                             : AdaptiveInside::form_factor(solver_, receiver_, source, rho_b, options_, *visibility);
  Estimate result{found.form_factor, {}};
  result.counters.add("leaves", found.leaves);
  result.counters.add("rays", found.rays);
  result.counters.add("shaft tests", found.shaft_tests);
  for (std::size_t reason = 0; reason < kLeafReasonCount; ++reason) {
    result.counters.add(kLeafCounters[reason], found.leaves_by_reason[reason]);
  }
  if (keeps_results_) results_.push_back(std::move(found));
  return result;
}

// --- Adaptive ---

SettingSpec pattern_setting() {
  return word_setting("pattern", {"jittered", "centre", "regular", "low-discrepancy"},
                      "where the rays to a leaf or sub-patch end; centre sends only one ray");
}

bool pattern_uses(const Settings& settings, std::string_view setting) {
  const SamplePattern pattern = *pattern_named(settings.word("pattern"));
  if (setting == "rays") return pattern != SamplePattern::kCentre;
  if (setting != "seed") return true;
  return pattern == SamplePattern::kJittered || pattern == SamplePattern::kLowDiscrepancy;
}

namespace {

struct AdaptivePrepared : PreparedSource {
  AdaptivePrepared(const AdaptiveSolver& solver, const Scene& scene, const Selection& chosen)
      : PreparedSource(chosen), source(solver.prepare(chosen)), radiosity(scene.source_radiosity(chosen)) {}
  AdaptiveSource source;
  Rgb radiosity;
};

AdaptiveOptions options_of(const Settings& settings) {
  AdaptiveOptions options;
  take_tolerances(settings, options);
  options.rays = static_cast<int>(settings.whole("rays"));
  options.pattern = *pattern_named(settings.word("pattern"));
  options.seed = static_cast<std::uint64_t>(settings.whole("seed"));
  options.variant = *variant_named(settings.word("variant"));
  return options;
}

class Adaptive : public RecursionEvaluator {
 public:
  Adaptive(const AdaptiveSolver& solver, const Scene& scene, const Settings& settings)
      : RecursionEvaluator(solver, scene, options_of(settings)) {}

  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& prepared) override {
    const kernel::StandardArithmetic arithmetic;
    const auto& source = own<AdaptivePrepared>(prepared);
    return estimate(source.source, source.radiosity);
  }
};

}  // namespace

Method adaptive_method() {
  const AdaptiveOptions defaults;
  std::vector<SettingSpec> settings = tolerance_settings();
  settings.push_back(whole_setting("rays", defaults.rays, 1, kMostRays, "shadow rays for each undecided sub-patch"));
  settings.push_back(pattern_setting());
  settings.push_back(word_setting(
      "variant", {"mended", "literal"},
      "literal: as printed in 1992, without clipping at the horizon, in single precision; mended: corrected"));
  settings.push_back(seed_setting());
  return {.name = "adaptive",
          .summary =
              "Tampieri's algorithm: splits the source until visibility is certain or the form factor is small; "
              "visibility V from shadow rays",
          .source = "F. Tampieri, Accurate Form-Factor Computation (1992)",
          .settings = std::move(settings),
          .prepare = prepare_as<OnScene<AdaptiveSolver, AdaptivePrepared, Adaptive>>,
          .uses = pattern_uses,
          .check = check_tolerances,
          .can_leave_unit = [](const Settings&) { return true; }};  // the sum over a source of several faces
}

// --- Adaptive exact visibility ---

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
    const kernel::StandardArithmetic arithmetic;
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
