// Nettle's form factor: P. Nettle, "Radiosity In English - Form Factor Calculation" (flipcode, 1999), from centre to
// centre:
//
//   F ~ sum over m x m sub-patches of  H A cos th_r cos th_s / (pi r^2),
//
// with the angles and r at the sub-patch's centre, A its area and H, the visibility scalar, the share of k rays to its
// points that meet nothing. The article has m = 1; its rule that patches be "relatively small, when compared to the
// distance between them" is the reason for m.
//
// The literal variant follows the text where the text is wrong. Cosines are made positive, so that surfaces illuminate
// faces behind them and faces that face away. And A is replaced by the ratio of the two areas, which the text gives
// first as the sender's over the receiver's and finally as the receiver's over the sender's.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>

#include "adaptive/sampled_scene.h"
#include "kernel/poll.h"
#include "methods/method_files.h"
#include "methods/ray_sum.h"

namespace exactff::methods {

using namespace adaptive;

namespace {

enum class AreaFactor { kSender, kSenderOverReceiver, kReceiverOverSender };

AreaFactor area_factor_of(const Settings& settings) {
  if (settings.word("variant") == "mended") return AreaFactor::kSender;
  return settings.word("area_ratio") == "sender-over-receiver" ? AreaFactor::kSenderOverReceiver
                                                               : AreaFactor::kReceiverOverSender;
}

class Nettle : public Evaluator {
 public:
  Nettle(const SampledScene& sampled, const Scene& scene, const Settings& settings)
      : scene_(scene),
        scale_(sampled.scene.scale),
        rays_(sampled),
        splits_(static_cast<int>(settings.whole("splits"))),
        seed_(static_cast<std::uint64_t>(settings.whole("seed"))),
        area_factor_(area_factor_of(settings)),
        given_receiver_area_(settings.number("receiver_area")) {
    plan_.prepare(pattern_named(settings.word("pattern")), static_cast<int>(settings.whole("rays")));
    ends_.resize(plan_.ray_count());
  }

  void look_from(const Receiver& receiver) override {
    const kernel::StandardArithmetic arithmetic;
    rays_.look_from(receiver);
    receiver_area_ = given_receiver_area_ > 0.0 ? given_receiver_area_
                     : !receiver.on.empty()     ? scene_.face(receiver.on.front()).area
                                                : 1.0;
  }

  using Evaluator::form_factor;
  Estimate form_factor(const PreparedSource& prepared) override {
    const kernel::StandardArithmetic arithmetic;
    const auto& source = own<RaySource>(prepared);
    const std::uint64_t key = stream_key(rays_.view(), source.selection(), seed_);
    const Reach reach = literal() ? Reach::kEverything : Reach::kVisible;
    const std::uint64_t sub_patches =
        rays_.for_each_part(source, reach, splits_, key, plan_.ray_count(),
                            [this](const SubPatch& part, std::uint64_t part_key) { add_part(part, part_key); });
    Estimate result;
    result.form_factor = move_into_range(rays_.take(), literal() ? Formula::kAny : Formula::kNotNegative);
    result.counters.add("sub-patches", sub_patches);
    result.counters.add("rays", rays_.take_rays());
    return result;
  }

 private:
  [[nodiscard]] bool literal() const { return area_factor_ != AreaFactor::kSender; }

  void add_part(const SubPatch& part, std::uint64_t key) {
    kernel::poll();
    const double share =
        (literal() ? literal_form_factor(part) : rays_.kernel(centroid(part)) * area(part)) / plan_.ray_count();
    if (share == 0.0) return;
    plan_.place(part, key, ends_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(ends_.count); ++i) {
      const Vec3 end = ends_[i];
      const bool counts = literal() || dot(rays_.view().normal, end) > 0.0;
      rays_.add(end, counts ? share : 0.0);
    }
  }

  // Not dimensionless: its unit is one over an area, as in the text.
  [[nodiscard]] double literal_form_factor(const SubPatch& part) const {
    const Vec3 centre = centroid(part);
    const double squared_distance = dot(centre, centre);
    const double square_scale = scale_ * scale_;
    if (!is_moderate({squared_distance, square_scale, area(part), receiver_area_})) return literal_by_logarithms(part);
    const double cosines = std::abs(dot(rays_.view().unit_normal, centre) * rays_.height()) / squared_distance;
    const double sender_area = area(part) / square_scale;
    const double ratio =
        area_factor_ == AreaFactor::kSenderOverReceiver ? sender_area / receiver_area_ : receiver_area_ / sender_area;
    return cosines / (std::numbers::pi * squared_distance / square_scale) * ratio;
  }

  // True if products and quotients of four of these values neither overflow nor underflow.
  static bool is_moderate(std::initializer_list<double> values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return v > 0x1p-160 && v < 0x1p160; });
  }

  // The same where a factor or a product of factors is outside the range of doubles; infinite where the result is.
  [[nodiscard]] double literal_by_logarithms(const SubPatch& part) const {
    const Vec3 centre = centroid(part);
    const double distance = length(centre);
    if (distance == 0.0) return 0.0;
    int exponent = 0;
    const Vec3 direction = normalised(centre, exponent);
    const double receiver_cosine = std::abs(dot(rays_.view().unit_normal, direction)) / length(direction);
    const double cosines = receiver_cosine * std::min(1.0, std::abs(rays_.height()) / distance);
    if (cosines == 0.0) return 0.0;
    const double log_scale = std::log2(scale_);
    const double log_distance = std::log2(distance) - log_scale;
    const double log_sender = std::log2(area(part)) - 2.0 * log_scale;
    const double log_receiver = std::log2(receiver_area_);
    const double log_ratio =
        area_factor_ == AreaFactor::kSenderOverReceiver ? log_sender - log_receiver : log_receiver - log_sender;
    const double log_kernel = std::log2(cosines * std::numbers::inv_pi) - 2.0 * log_distance;
    return std::exp2(log_kernel + log_ratio);
  }

  const Scene& scene_;
  double scale_;
  RaySum rays_;
  int splits_;
  std::uint64_t seed_;
  AreaFactor area_factor_;
  double given_receiver_area_;
  double receiver_area_ = 1.0;  // in the scene's unit
  SamplePlan plan_;
  RayEnds ends_;
};

bool nettle_uses(const Settings& settings, std::string_view setting) {
  if (setting == "area_ratio" || setting == "receiver_area") return settings.word("variant") == "literal";
  return pattern_uses(settings, setting);
}

}  // namespace

Method nettle_method() {
  return {
      .name = "nettle",
      .summary =
          "for each of m x m sub-patches: form factor from centre to centre, times a visible share found by k rays",
      .source = "P. Nettle, Radiosity In English - Form Factor Calculation (1999)",
      .settings = {whole_setting("splits", 1, 1, kMostSplits, "m, for m x m sub-patches of each face"),
                   whole_setting("rays", 16, 1, kMostRays, "k, the number of rays to each sub-patch"),
                   pattern_setting(),
                   word_setting("variant", {"mended", "literal"},
                                "literal: cosines always positive, and a ratio of areas instead of the sender's area"),
                   word_setting("area_ratio", {"receiver-over-sender", "sender-over-receiver"},
                                "ratio of areas in the literal variant (the text gives both)"),
                   number_setting("receiver_area", 0.0, 0.0, std::numeric_limits<double>::max(),
                                  "receiver's area in the literal variant; 0: area of its face, or 1 without a face",
                                  "area"),
                   seed_setting()},
      .prepare = prepare_as<OnScene<SceneForRays, RaySource, Nettle>>,
      .uses = nettle_uses,
      .can_leave_unit = [](const Settings&) { return true; }};
}

}  // namespace exactff::methods
