#include "methods/ray_sum.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <utility>

#include "kernel/expect.h"
#include "kernel/poll.h"
#include "methods/method_files.h"

namespace exactff::methods {

using namespace adaptive;

namespace {

SourcePlane seen_from_behind(SourcePlane plane) {
  std::swap(plane.frame[1], plane.frame[2]);
  std::swap(plane.exact_frame[1], plane.exact_frame[2]);
  return plane;
}

std::vector<std::uint32_t> close_pieces(const SampledScene& scene, const SourcePlane& plane, const Vec3& unit_normal) {
  const Scene& s = *scene.scene.scene;
  const double blur = scene.unit_box.blur();
  std::vector<std::uint32_t> close;
  for (std::uint32_t k = 0; k < s.pieces().size(); ++k) {
    const auto corners = s.corners(s.pieces()[k]);
    const bool near = std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
      return std::abs(dot(unit_normal, scene.scene.points[v] - plane.frame[0])) <= blur;
    });
    if (near && !std::binary_search(plane.coplanar.begin(), plane.coplanar.end(), k)) close.push_back(k);
  }
  return close;
}

// 0 where rounding leaves no normal. Edges are scaled to a length of about 1 where their product would underflow.
Vec3 unit_normal_of(const SourcePlane& plane) {
  Vec3 normal = plane_normal(plane.frame[0], plane.frame[1], plane.frame[2]).value;
  if (max_norm(normal) < kLeastSquare) {
    const Vec3 p = plane.frame[1] - plane.frame[0], q = plane.frame[2] - plane.frame[0];
    if (p == Vec3{} || q == Vec3{}) return {};
    int exponent = 0;
    normal = cross(normalised(p, exponent), normalised(q, exponent));
    if (normal == Vec3{}) return {};
    normal = normalised(normal, exponent);
  }
  const Vec3 unit = normal * (1.0 / max_norm(normal));  // so that no square underflows
  return unit * (1.0 / length(unit));
}

RayPlane make_plane(const SampledScene& scene, SourcePlane plane) {
  RayPlane result;
  result.unit_normal = unit_normal_of(plane);
  result.close = close_pieces(scene, plane, result.unit_normal);
  result.back = seen_from_behind(plane);
  result.front = std::move(plane);
  return result;
}

double area_of(const SourceRoot& root) {
  return area(make_sub_patch({root.corners.data(), static_cast<std::size_t>(root.corner_count)}));
}

// The longest list worth gathering: a piece in the shaft costs about as much as two rays that Embree traces.
std::size_t longest_list(std::size_t points) {
  return std::clamp(points / 2, kMostPiecesWithoutEmbree, kLongestDirectList);
}

}  // namespace

RaySource::RaySource(const SampledScene& sampled, const Scene& scene, const Selection& chosen)
    : PreparedSource(chosen) {
  SourceRoots source = make_source_roots(scene, sampled.scene.points, chosen);
  for (SourcePlane& plane : source.planes) planes.push_back(make_plane(sampled, std::move(plane)));
  roots = std::move(source.roots);
  area_up_to.push_back(0.0);
  for (const SourceRoot& root : roots) area_up_to.push_back(area_up_to.back() + area_of(root));
}

SceneForRays::SceneForRays(const Scene& given) : SampledScene(given) {
  if (given.pieces().size() > kMostPiecesWithoutEmbree) (void)ray_scene();
}

void RaySum::look_from(const Receiver& receiver) {
  view_ = view_from(receiver, scene_.scene);
  ends_.resize(kBlock);
  ends_.count = 0;
  weights_.resize(kBlock);
  sum_ = 0.0;
  rays_ = 0;
}

bool RaySum::look_at(const RaySource& source, std::size_t index, Reach reach) {
  const SourceRoot& root = source.roots[index];
  const RayPlane& plane = source.planes[root.plane];
  if (view_.is_own(root.piece) || max_norm(view_.point) > kFarthest) return false;
  if (reach == Reach::kVisible && !in_front(view_, plane.front)) return false;
  polygon_.clear();
  for (int i = 0; i < root.corner_count; ++i) {
    polygon_.push_back(root.corners[static_cast<std::size_t>(i)] - view_.point);
  }
  patch_ = make_sub_patch(polygon_);
  height_ = dot(plane.unit_normal, view_.point - plane.front.frame[0]);
  if (reach == Reach::kVisible) height_ = std::max(0.0, height_);  // x is in front: a negative one is rounding
  return clip(reach);
}

bool RaySum::aim(const RaySource& source, std::size_t index, Reach reach, std::size_t points) {
  trace();
  if (!look_at(source, index, reach)) return false;
  gather(source.planes[source.roots[index].plane], reach, points);
  return true;
}

bool RaySum::clip(Reach reach) {
  if (reach == Reach::kEverything) return height_ != 0.0;
  clip_by_horizon(polygon_, view_.normal, clipped_);
  polygon_.swap(clipped_);
  return !polygon_.empty();
}

void RaySum::gather(const RayPlane& plane, Reach reach, std::size_t points) {
  const bool behind = reach == Reach::kEverything && height_ < 0.0;
  if (behind) std::reverse(polygon_.begin(), polygon_.end());
  const SourcePlane& seen = behind ? plane.back : plane.front;
  const Horizon horizon = reach == Reach::kVisible ? Horizon::kClips : Horizon::kIgnored;
  asks_embree_ = !gather_occluders(scene_.scene, view_, seen, polygon_, horizon, scene_.unit_box.blur(), gathered_,
                                   longest_list(points));
  if (asks_embree_) gather_from_all(plane, seen, horizon);
  list_ = gathered_.occluders.push_all();
}

// Rays pass through the source's plane and the receiver's face. Pieces too near either for single precision are tested
// directly.
void RaySum::gather_from_all(const RayPlane& plane, const SourcePlane& seen, Horizon horizon) {
  const Scene& scene = *scene_.scene.scene;
  pieces_ = plane.close;
  visit_pieces_near(scene_.scene, view_.point, scene_.unit_box.blur(),
                    [this](std::uint32_t piece) { pieces_.push_back(piece); });
  std::sort(pieces_.begin(), pieces_.end());
  pieces_.erase(std::unique(pieces_.begin(), pieces_.end()), pieces_.end());
  gather_blurred(scene_.scene, view_, seen, polygon_, horizon, pieces_, gathered_);
  pieces_.insert(pieces_.end(), seen.coplanar.begin(), seen.coplanar.end());
  for (const PlaneId of_own : view_.own.planes()) {
    const auto own = view_.own.pieces_in(of_own);
    pieces_.insert(pieces_.end(), own.begin(), own.end());
  }
  blockers_.assign_all_but(scene.pieces().size(), pieces_);
}

double RaySum::kernel(const Vec3& point) const {
  EXACTFF_EXPECT(height_ >= 0.0);
  const double squared_distance = dot(point, point);
  if (squared_distance < kLeastSquare || height_ * height_ > 2.0 * squared_distance) return kernel_near_x(point);
  const double above = std::max(0.0, dot(view_.unit_normal, point));
  return std::numbers::inv_pi * (above / squared_distance) * (height_ / squared_distance);
}

// For cases where squares underflow, or where x is so near that, by rounding, its height above the plane exceeds its
// distance from a point of the plane.
double RaySum::kernel_near_x(const Vec3& point) const {
  const double distance = length(point);
  if (distance == 0.0) return 0.0;
  int exponent = 0;
  const Vec3 direction = normalised(point, exponent);
  const double receiver_cosine = std::max(0.0, dot(view_.unit_normal, direction)) / length(direction);
  const double source_cosine = std::min(1.0, height_ / distance);
  const double kernel = std::numbers::inv_pi * receiver_cosine * source_cosine / distance / distance;
  return std::min(kernel, kLargestKernel);
}

double RaySum::cosine_kernel(const Vec3& point) const {
  const double distance = length(point);
  return distance > 0.0 ? std::numbers::inv_pi * std::max(0.0, dot(view_.unit_normal, point)) / distance : 0.0;
}

void RaySum::add(const Vec3& point, double weight) {
  if (weight == 0.0) return;
  if (list_.empty() && !asks_embree_) {
    sum_ += weight;
    return;
  }
  const auto k = static_cast<std::size_t>(ends_.count++);
  ends_.set(k, point);
  weights_[k] = weight;
  if (ends_.count == kBlock) trace();
}

// Old ends serve as padding: their lanes are ignored.
void RaySum::trace() {
  kernel::poll();
  rays_ += static_cast<std::uint64_t>(ends_.count);
  for (int first = 0; first < ends_.count; first += RayScene::kPacket) {
    const unsigned hidden = hidden_lanes(first);
    const int lanes = std::min(RayScene::kPacket, ends_.count - first);
    for (int lane = 0; lane < lanes; ++lane) {
      if ((hidden >> lane & 1U) == 0) sum_ += weights_[static_cast<std::size_t>(first + lane)];
    }
  }
  ends_.count = 0;
}

unsigned RaySum::hidden_lanes(int first) const {
  unsigned hidden = 0;
  for (int half = 0; half < RayScene::kPacket && !list_.empty(); half += RayEnds::kLanes) {
    if (first + half < ends_.count) hidden |= gathered_.occluders.hidden_lanes(list_, ends_, first + half) << half;
  }
  if (!asks_embree_) return hidden;
  return scene_.ray_scene().hidden_lanes(view_.point, ends_, first, blockers_, hidden);
}

double RaySum::take() {
  trace();
  return std::exchange(sum_, 0.0);
}

std::uint64_t RaySum::take_rays() { return std::exchange(rays_, 0); }

// --- Nettle ---

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
    plan_.prepare(*pattern_named(settings.word("pattern")), static_cast<int>(settings.whole("rays")));
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

// --- Wallace ---

// Wallace's ray-traced form factor: J. R. Wallace, K. A. Elmquist and E. A. Haines, "A Ray Tracing Algorithm for
// Progressive Radiosity" (1989). The source is cut into sub-patches of area dA, each is approximated by a disc
// perpendicular to the line to its sample point at distance r, and one ray decides whether x sees it:
//
//   F ~ sum V dA cos th_r cos th_s / (pi r^2 + dA).
//
// The disc keeps the value finite where dA is large compared with r^2.

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
