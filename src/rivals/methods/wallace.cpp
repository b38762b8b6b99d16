// Wallace's ray-traced form factor: J. R. Wallace, K. A. Elmquist and E. A. Haines, "A Ray Tracing Algorithm for
// Progressive Radiosity" (1989). The source is cut into sub-patches of area dA, each is approximated by a disc
// perpendicular to the line to its sample point at distance r, and one ray decides whether x sees it:
//
//   F ~ sum V dA cos th_r cos th_s / (pi r^2 + dA).
//
// The disc keeps the value finite where dA is large compared with r^2.
#include <numbers>

#include "adaptive/sampled_scene.h"
#include "methods/method_files.h"
#include "methods/ray_sum.h"

namespace exactff::methods {

using namespace adaptive;

namespace {

class Wallace : public Evaluator {
 public:
  Wallace(const SampledScene& sampled, const Scene& /*scene*/, const Settings& settings)
      : rays_(sampled),
        splits_(static_cast<int>(settings.whole("splits"))),
        seed_(static_cast<std::uint64_t>(settings.whole("seed"))) {
    const bool jittered = settings.word("pattern") == "jittered";
    plan_.prepare(jittered ? SamplePattern::kJittered : SamplePattern::kCentre, 1);
    end_.resize(1);
  }

  void look_from(const Receiver& receiver) override {
    const kernel::StandardArithmetic arithmetic;
    rays_.look_from(receiver);
  }

  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& prepared) override {
    const kernel::StandardArithmetic arithmetic;
    const auto& source = own<RaySource>(prepared);
    const std::uint64_t key = stream_key(rays_.view(), source.selection(), seed_);
    const std::uint64_t samples =
        rays_.for_each_part(source, Reach::kVisible, splits_, key, 1,
                            [this](const SubPatch& part, std::uint64_t part_key) { add_part(part, part_key); });
    Estimate result;
    result.form_factor = move_into_range(rays_.take(), Formula::kNotNegative);
    result.counters.add("samples", samples);
    result.counters.add("rays", rays_.take_rays());
    return result;
  }

 private:
  void add_part(const SubPatch& part, std::uint64_t key) {
    plan_.place(part, key, end_);
    const Vec3 point = end_[0];
    const double size = area(part);
    const double disc = std::numbers::pi * dot(point, point);
    if (!(disc + size > 0.0)) return;
    rays_.add(point, rays_.kernel(point) * size * (disc / (disc + size)));
  }

  RaySum rays_;
  int splits_;
  std::uint64_t seed_;
  SamplePlan plan_;
  RayEnds end_;
};

bool wallace_uses(const Settings& settings, std::string_view setting) {
  return setting != "seed" || settings.word("pattern") == "jittered";
}

}  // namespace

Method wallace_method() {
  return {.name = "wallace",
          .summary = "for each of m x m sub-patches: form factor of a disc, and one ray",
          .source =
              "J. R. Wallace, K. A. Elmquist and E. A. Haines, A Ray Tracing Algorithm for Progressive Radiosity "
              "(1989)",
          .settings = {whole_setting("splits", 4, 1, kMostSplits, "m, for m x m sub-patches of each face"),
                       word_setting("pattern", {"centre", "jittered"},
                                    "where the sample lies in its sub-patch: at the centre or at random"),
                       seed_setting()},
          .prepare = prepare_as<OnScene<SceneForRays, RaySource, Wallace>>,
          .uses = wallace_uses,
          .can_leave_unit = [](const Settings&) { return true; }};
}

}  // namespace exactff::methods
