// Step 1 of view_edges.h.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kernel/poll.h"
#include "scene/shaft_tree.h"
#include "whole_view/view_edges.h"

namespace exactff::whole_view {

using kernel::kUncertain;

namespace {

constexpr std::uint32_t kAllBacks = 0xFFFFFFFEU;

// A length of the order of most distances from x.
double usual_distance(const visibility::View& view) {
  constexpr std::size_t kMost = 33;
  const auto vertices = view.scene.vertices();
  std::array<double, kMost> found{};
  std::size_t count = 0;
  const std::size_t step = vertices.size() / kMost + 1;
  for (std::size_t v = 0; v < vertices.size() && count < kMost; v += step) {
    const kernel::Approx3 d = kernel::approx_difference(vertices[v], view.x);
    const double distance = kernel::max_norm(d);
    if (distance > 0.0 && std::isfinite(distance)) found[count++] = distance;
  }
  if (count == 0) return 1.0;
  std::nth_element(found.begin(), found.begin() + count / 2, found.begin() + count);
  return found[count / 2];
}

std::uint32_t whole_of(const Scene& scene, std::uint32_t piece, ViewEdges::Wholes wholes) {
  const FaceId id = scene.pieces()[piece].face;
  const Face& face = scene.face(id);
  if (wholes == ViewEdges::Wholes::kPatches) return static_cast<std::uint32_t>(index_of(face.patch));
  if (wholes == ViewEdges::Wholes::kPlanes && face.shape == FaceShape::kTriangulated) {
    return static_cast<std::uint32_t>(scene.faces().size()) + piece;
  }
  return static_cast<std::uint32_t>(index_of(id));
}

}  // namespace

void ViewEdges::start(const visibility::View& view) {
  scene_ = &view.scene;
  contacts_ = &contacts(view.scene);
  outlines_.start(view.scene, view.x, usual_distance(view));
  outlines_.set_horizon(view.n);
  depths_.start(view.scene, view.x, outlines_.scale_exponent());
  whole_.clear();
  front_.clear();
  horizon_side_.clear();
  crossings_.clear();
  lines_.clear();
  rivals_.clear();
  stacks_.clear();
  piercings_.clear();
  parts_.clear();
  sides_.clear();
  run_ = 0;
  work_ = {};
}

void ViewEdges::gather(const visibility::View& view, Wholes wholes) {
  seen_in_.clear();
  if (view.is_buried) return;
  const std::span<const Piece> pieces = view.scene.pieces();
  kernel::Steps steps("faces", pieces.size());
  // In the order of the tree, so that neighbours in space are neighbours in memory.
  shaft_tree(view.scene).query(view.x, {}, [&](std::uint32_t index) {
    const Piece& piece = pieces[index];
    steps.take();
    if (piece.transparent || view.is_own(index)) return true;
    const int facing = visibility::facing_of(view, piece);
    if (facing == 0) return true;
    const bool back_apart = wholes == Wholes::kFaces || wholes == Wholes::kPlanes;
    add(view, piece, facing > 0 && !back_apart ? kAllBacks : whole_of(view.scene, index, wholes), facing);
    return true;
  });
  find_partners();
  seen_in_.assign(whole_.size(), 0);
}

void ViewEdges::classify_new_corners(const visibility::View& view) {
  while (horizon_side_.size() < outlines_.corner_count()) {
    const auto corner = static_cast<CornerId>(horizon_side_.size());
    int side = outlines_.side_by_filter({view.n.x, view.n.y, view.n.z}, corner);
    if (side == kUncertain) {
      side = kernel::exact_sign_of_dot(view.n, {view.x, outlines_.position(*outlines_.vertex(corner))});
    }
    horizon_side_.push_back(static_cast<std::int8_t>(side));
  }
}

void ViewEdges::add(const visibility::View& view, const Piece& piece, std::uint32_t whole, int facing) {
  outlines_.corners_of(view.scene.corners(piece), corners_);
  classify_new_corners(view);
  bool above = false, below = false;
  for (const CornerId corner : corners_) {
    above = above || horizon_side_[corner] > 0;
    below = below || horizon_side_[corner] < 0;
  }
  if (!above) return;
  if (below) clip();
  if (facing > 0) std::reverse(corners_.begin(), corners_.end());
  static_cast<void>(outlines_.add(corners_, !below));
  depths_.add(piece);
  whole_.push_back(whole);
  front_.push_back(static_cast<std::uint8_t>(facing < 0));
}

// Leaves the part of the ring above the horizon. Pieces that share an edge share its crossing.
void ViewEdges::clip() {
  ring_.clear();
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    const CornerId a = corners_[c], b = corners_[c + 1 < corners_.size() ? c + 1 : 0];
    if (horizon_side_[a] >= 0) ring_.push_back(a);
    if (horizon_side_[a] * horizon_side_[b] >= 0) continue;
    std::uint32_t& crossing = crossings_(a, b);
    if (crossing == PairTable::kNone) {
      crossing = outlines_.add_crossing(Outlines::Plane::kHorizon, *outlines_.vertex(a), *outlines_.vertex(b));
      horizon_side_.push_back(0);
    }
    ring_.push_back(crossing);
  }
  corners_.swap(ring_);
}

// Edges between the same two corners have one line, that of the first. Partners are two such edges that run opposite
// ways, if there is no third.
void ViewEdges::find_partners() {
  const auto edges = outlines_.edges();
  line_.resize(edges.size());
  std::iota(line_.begin(), line_.end(), EdgeId{0});
  partner_.assign(edges.size(), kNoEdge);
  shared_.assign(edges.size(), 0);
  exact_.clear(edges.size());
  table_.clear(std::max<std::size_t>(edges.size(), 1));
  for (EdgeId id = 0; id < edges.size(); ++id) {
    const EdgeId first = table_.add(id, edges);
    if (first == id) continue;
    line_[id] = first;
    const bool is_second = shared_[first] == 0;
    shared_[first] = 1;
    if (is_second && edges[first].a != edges[id].a) {
      partner_[first] = id;
      partner_[id] = first;
    } else if (partner_[first] != kNoEdge) {
      partner_[partner_[first]] = kNoEdge;
      partner_[first] = kNoEdge;
    }
  }
}

}  // namespace exactff::whole_view
