#include "methods/ray_sum.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "adaptive/sub_patch.h"
#include "kernel/expect.h"
#include "kernel/poll.h"

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

}  // namespace exactff::methods
