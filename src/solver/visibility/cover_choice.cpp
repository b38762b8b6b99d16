#include "visibility/cover_choice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace exactff::visibility {

using kernel::Approx3;
using kernel::dot;
using Outline = Outlines::Outline;

namespace {

constexpr std::size_t kFewest = 8, kMost = 128;
constexpr std::size_t kLargestPerChosen = 4;  // this many times as many occluders are looked at as may be chosen
constexpr double kInwards = 0x1p-6;           // from a corner or an edge to the middle

constexpr double kLeastCosine = 0x1p-8;  // the cosine, more or less, of the angle to the plane across the view
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Approx3 sum_of(const Approx3& a, const Approx3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }

Approx3 between(const Approx3& a, const Approx3& b, double share_of_b) {
  const double s = 1.0 - share_of_b;
  return {s * a.x + share_of_b * b.x, s * a.y + share_of_b * b.y, s * a.z + share_of_b * b.z};
}

}  // namespace

std::size_t CoverChoice::most_of(std::size_t occluders) {
  return std::clamp(static_cast<std::size_t>(std::sqrt(static_cast<double>(occluders))), kFewest, kMost);
}

bool CoverChoice::start(const Outlines& outlines, std::size_t source_count) {
  chosen_.clear();
  most_ = most_of(outlines.outlines().size() - source_count);
  find_points(outlines, source_count);
  if (!corners_seem_hidden(outlines, source_count) || !find_largest(outlines, source_count)) return false;
  const auto hidden = [&](const Approx3& point) {
    return std::ranges::any_of(chosen_, [&](OutlineId o) { return seems_hidden(outlines, o, point); });
  };
  const auto hidden_by_one_more = [&](const Approx3& point) { return hidden(point) || add_for(outlines, point); };
  return std::ranges::all_of(points_, hidden_by_one_more) && std::ranges::all_of(corners_, hidden_by_one_more);
}

// Of each piece: a point near every corner, one near the middle of every edge, and its middle.
void CoverChoice::find_points(const Outlines& outlines, std::size_t source_count) {
  corners_.clear();
  points_.clear();
  across_view_ = {};
  for (OutlineId s = 0; s < source_count; ++s) {
    const Outline& outline = outlines.outline(s);
    const auto corner = [&](std::uint32_t k) -> const Approx3& {
      return outlines.corner(outlines.edge(outline.first + k % outline.count).a).t;
    };
    Approx3 sum;
    for (std::uint32_t k = 0; k < outline.count; ++k) sum = sum_of(sum, corner(k));
    const Approx3 middle = between({}, sum, 1.0 / outline.count);
    points_.push_back(middle);
    for (std::uint32_t k = 0; k < outline.count; ++k) {
      corners_.push_back(between(corner(k), middle, kInwards));
      points_.push_back(between(between(corner(k), corner(k + 1), 0.5), middle, kInwards));
    }
    across_view_ = sum_of(across_view_, middle);
  }
}

// Occluders inside the source hide none of its corners. Where something is visible, this is mostly the end.
bool CoverChoice::corners_seem_hidden(const Outlines& outlines, std::size_t source_count) {
  across_.clear();
  for (auto o = static_cast<OutlineId>(source_count); o < outlines.outlines().size(); ++o) {
    if (!outlines.outline(o).inside_source) across_.push_back(o);
  }
  return std::ranges::all_of(corners_, [&](const Approx3& corner) {
    return std::ranges::any_of(across_, [&](OutlineId o) { return seems_hidden(outlines, o, corner); });
  });
}

// Corners are shared by neighbours: one division for each.
void CoverChoice::find_depths(const Outlines& outlines) {
  const Vec3 view = kernel::to_vec3(across_view_);
  inverse_depths_.resize(outlines.corner_count());
  for (CornerId corner = 0; corner < inverse_depths_.size(); ++corner) {
    const Outlines::Corner& c = outlines.corner(corner);
    const double along = dot(view, c.t);
    inverse_depths_[corner] = along >= kLeastCosine * c.size ? 1.0 / along : kInfinity;
  }
}

// In the plane with the normal across_view_, where the normal's product with every point is 1. Infinite or NaN where a
// corner is not ahead.
double CoverChoice::size(const Outlines& outlines, OutlineId id) const {
  const Outline& outline = outlines.outline(id);
  const auto edges = outlines.edges().subspan(outline.first, outline.count);
  const Approx3& a = outlines.corner(edges.front().a).t;
  double doubled = 0.0;
  double last = inverse_depths_[edges[1].a];
  for (const Outlines::Edge& edge : edges.subspan(1, edges.size() - 2)) {
    const double next = inverse_depths_[edge.b];
    doubled += dot(edge.normal, a) * last * next;
    last = next;
  }
  return std::abs(doubled) * inverse_depths_[edges.front().a];
}

bool CoverChoice::find_largest(const Outlines& outlines, std::size_t source_count) {
  find_depths(outlines);
  double whole = 0.0;
  for (OutlineId s = 0; s < source_count; ++s) whole += size(outlines, s);
  if (!(whole > 0.0 && whole < kInfinity)) return false;
  largest_.clear();
  float most = 0.0F;
  for (auto o = static_cast<OutlineId>(source_count); o < outlines.outlines().size(); ++o) {
    const double shadow = size(outlines, o);
    largest_.emplace_back(shadow < whole ? static_cast<float>(shadow / whole) : 1.0F, o);
    most = std::max(most, largest_.back().first);
  }
  if (most * static_cast<float>(most_) < 1.0F) return false;
  const auto larger = [](const Shadow& a, const Shadow& b) { return a > b; };
  const std::size_t kept = std::min(kLargestPerChosen * most_, largest_.size());
  std::ranges::nth_element(largest_, largest_.begin() + static_cast<std::ptrdiff_t>(kept), larger);
  largest_.resize(kept);
  std::ranges::sort(largest_, larger);
  float sum = 0.0F;
  for (std::size_t i = 0; i < std::min(most_, kept); ++i) sum += largest_[i].first;
  return sum >= 1.0F;
}

void CoverChoice::take_all(const Outlines& outlines, std::size_t source_count) {
  chosen_.clear();
  largest_.clear();
  for (auto o = static_cast<OutlineId>(source_count); o < outlines.outlines().size(); ++o) chosen_.push_back(o);
  most_ = chosen_.size();
}

bool CoverChoice::add_for(const Outlines& outlines, const Approx3& direction) {
  if (chosen_.size() == most_) return false;
  const auto hides = [&](OutlineId o) { return seems_hidden(outlines, o, direction); };
  if (std::ranges::any_of(chosen_, hides)) return false;
  const auto found = std::ranges::find_if(largest_, hides, &Shadow::second);
  if (found == largest_.end()) return false;
  chosen_.push_back(found->second);
  return true;
}

bool CoverChoice::seems_hidden(const Outlines& outlines, OutlineId by, const Approx3& direction) {
  const Outline& outline = outlines.outline(by);
  for (EdgeId id = outline.first; id < outline.first + outline.count; ++id) {
    if (!(dot(outlines.edge(id).normal, direction) > 0.0)) return false;
  }
  return true;
}

}  // namespace exactff::visibility
