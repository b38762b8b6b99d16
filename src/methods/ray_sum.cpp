#include "methods/ray_sum.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace exactff::methods {

using namespace sampled;

namespace {

// The longest list worth gathering: a piece in the shaft costs about as much as two rays that Embree traces.
std::size_t longest_list(std::size_t points) {
  return std::clamp(points / 2, kMostPiecesWithoutEmbree, kLongestDirectList);
}

}  // namespace

void RaySum::look_from(const Receiver& receiver) {
  view_ = view_from(receiver, scene_.scene);
  ends_.resize(kBlock);
  ends_.count = 0;
  weights_.resize(kBlock);
  sum_ = 0.0;
  rays_ = 0;
}

bool RaySum::aim(const RaySource& source, std::size_t index, Reach reach, std::size_t points) {
  trace();
  const SourceRoot& root = source.roots[index];
  const RayPlane& plane = source.planes[root.plane];
  if (view_.is_own(root.face) || max_norm(view_.point) > kFarthest) return false;
  if (reach == Reach::kVisible && !in_front(view_, plane.front)) return false;
  polygon_.clear();
  for (int i = 0; i < root.corner_count; ++i) {
    polygon_.push_back(root.corners[static_cast<std::size_t>(i)] - view_.point);
  }
  patch_ = make_sub_patch(polygon_);
  height_ = dot(plane.unit_normal, view_.point - plane.front.frame[0]);
  if (reach == Reach::kVisible) height_ = std::max(0.0, height_);  // x is in front: a negative one is rounding
  if (!clip(reach)) return false;
  gather(plane, reach, points);
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
  for (const FaceId own : view_.on) {
    const Face& face = scene.face(own);
    for (std::uint32_t k = 0; k < face.piece_count; ++k) pieces_.push_back(face.first_piece + k);
  }
  blockers_.assign_all_but(scene.pieces().size(), pieces_);
}

double RaySum::kernel(const Vec3& point) const {
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

void RaySum::add(const Vec3& point, double weight) {
  if (weight == 0.0) return;
  if (list_.empty() && !asks_embree_) {
    sum_ += weight;
    return;
  }
  const auto k = static_cast<std::size_t>(ends_.count++);
  ends_.x[k] = point.x;
  ends_.y[k] = point.y;
  ends_.z[k] = point.z;
  weights_[k] = weight;
  if (ends_.count == kBlock) trace();
}

// Old ends serve as padding: their lanes are ignored.
void RaySum::trace() {
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
