#include "view_factors/almost_closed.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/groups.h"
#include "view_factors/cell.h"

namespace exactff::view_factors {
namespace {

using kernel::difference;
using kernel::distance;
using kernel::dot;

constexpr int kFirstLength = -44, kLastLength = -9, kStepOfLength = 5;  // exponents; no coordinate exceeds 1
constexpr double kOfPlaces = 0x1p-46;                                   // more than those of a length or an area
constexpr Vec3 kAlong{0.5698, 0.6178, 0.5421};                          // shorter than 1; few corners lie across it

// What may be done with corners within a length of each other.
class FinderOfAlmostClosed {
 public:
  FinderOfAlmostClosed(const ExactScene& scene, double length)
      : scene_(scene), length_(length), end_of_(scene.vertices.size()), surface_of_(scene.pieces.size()) {
    join_corners();
    add_sides();
    cancel();
  }

  [[nodiscard]] bool is_closed(std::uint32_t piece) { return !open_[surface_of_.root(piece)]; }
  [[nodiscard]] std::vector<AlmostClosedSurface> surfaces();

 private:
  struct Way {                // along a side of a piece, from end to end
    std::uint32_t low, high;  // ends
    std::uint32_t side;
    bool upwards;
  };
  struct SideOfPiece {
    std::uint32_t piece, from, to;
    std::vector<std::uint32_t> between{};  // ends of others, from `from` on
  };

  [[nodiscard]] const Vec3& at(std::uint32_t corner) const { return scene_.vertices[corner].at; }
  [[nodiscard]] static double key(const Vec3& p) { return dot(kAlong, p); }

  void join_corners();
  void add_sides();
  void cancel();
  void cut(const std::vector<Way>& ways);
  void add_way(std::vector<Way>& ways, std::uint32_t side, std::uint32_t from, std::uint32_t to) const {
    if (from != to) ways.push_back({std::min(from, to), std::max(from, to), side, from < to});
  }
  // Joins the pieces of equal ways. Calls `left` with those that do not cancel.
  template <class Left>
  void for_each_group(std::vector<Way>& ways, const Left& left);
  void add_strip(const SideOfPiece& side, AlmostClosedSurface& surface) const;

  const ExactScene& scene_;
  const double length_;
  std::vector<std::uint32_t> end_of_;  // by corner
  Groups surface_of_;                  // by piece
  std::vector<bool> open_;             // by piece that is a root
  std::vector<SideOfPiece> sides_;
};

// The end is the first corner in order of coordinates.
void FinderOfAlmostClosed::join_corners() {
  std::vector<std::uint32_t> corners;
  for (const ExactPiece& piece : scene_.pieces) {
    if (!piece.transparent) corners.insert(corners.end(), piece.corners.begin(), piece.corners.end());
  }
  std::ranges::sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const auto place = [&](std::uint32_t corner) { return std::tuple(at(corner).x, at(corner).y, at(corner).z); };
  std::ranges::sort(corners, {}, [&](std::uint32_t corner) { return std::pair(key(at(corner)), place(corner)); });
  Groups near(scene_.vertices.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    for (std::size_t k = i + 1; k < corners.size() && key(at(corners[k])) - key(at(corners[i])) <= length_; ++k) {
      if (distance(at(corners[i]), at(corners[k])) <= length_) near.join(corners[i], corners[k]);
    }
  }
  std::ranges::sort(corners, std::ranges::greater(), place);
  for (const std::uint32_t corner : corners) end_of_[near.root(corner)] = corner;
  for (const std::uint32_t corner : corners) end_of_[corner] = end_of_[near.root(corner)];
}

void FinderOfAlmostClosed::add_sides() {
  for (std::uint32_t p = 0; p < scene_.pieces.size(); ++p) {
    if (scene_.pieces[p].transparent) continue;
    const std::vector<std::uint32_t>& corners = scene_.pieces[p].corners;
    for (std::size_t i = 0; i < corners.size(); ++i)
      sides_.push_back({p, corners[i], corners[(i + 1) % corners.size()]});
  }
}

template <class Left>
void FinderOfAlmostClosed::for_each_group(std::vector<Way>& ways, const Left& left) {
  std::ranges::sort(ways, {}, [](const Way& w) { return std::tuple(w.low, w.high, w.side, w.upwards); });
  for (auto first = ways.begin(); first != ways.end();) {
    auto last = first;
    std::ptrdiff_t balance = 0;
    for (; last != ways.end() && last->low == first->low && last->high == first->high; ++last) {
      balance += last->upwards ? 1 : -1;
      surface_of_.join(sides_[last->side].piece, sides_[first->side].piece);
    }
    if (balance != 0) left(first, last);
    first = last;
  }
}

void FinderOfAlmostClosed::cancel() {
  std::vector<Way> ways, left;
  for (std::uint32_t s = 0; s < sides_.size(); ++s) add_way(ways, s, end_of_[sides_[s].from], end_of_[sides_[s].to]);
  for_each_group(ways, [&](auto first, auto last) { left.insert(left.end(), first, last); });
  cut(left);
  ways.clear();
  for (const Way& way : left) {
    const SideOfPiece& side = sides_[way.side];
    std::uint32_t from = end_of_[side.from];
    for (const std::uint32_t end : side.between) add_way(ways, way.side, std::exchange(from, end), end);
    add_way(ways, way.side, from, end_of_[side.to]);
  }
  std::vector<std::uint32_t> of_open;
  for_each_group(ways, [&](auto first, auto) { of_open.push_back(sides_[first->side].piece); });
  open_.assign(scene_.pieces.size(), false);
  for (std::uint32_t p = 0; p < scene_.pieces.size(); ++p) {
    if (scene_.pieces[p].transparent) open_[p] = true;
  }
  for (const std::uint32_t piece : of_open) open_[surface_of_.root(piece)] = true;
}

// Where ends of the others are near.
void FinderOfAlmostClosed::cut(const std::vector<Way>& ways) {
  std::vector<std::uint32_t> ends;
  for (const Way& way : ways) ends.insert(ends.end(), {way.low, way.high});
  const auto order = [&](std::uint32_t end) { return std::pair(key(at(end)), end); };
  std::ranges::sort(ends, {}, order);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  for (const Way& way : ways) {
    kernel::poll();
    SideOfPiece& side = sides_[way.side];
    const Vec3 &a = at(side.from), along = difference(at(side.to), a);
    const auto [low, high] = std::minmax({key(a), key(at(side.to))});
    const auto share = [&](std::uint32_t end) { return dot(difference(at(end), a), along) / dot(along, along); };
    auto end = std::ranges::lower_bound(ends, low - length_, {}, [&](std::uint32_t e) { return key(at(e)); });
    for (; end != ends.end() && key(at(*end)) <= high + length_; ++end) {
      const double t = share(*end);
      const bool is_beside = t > 0.0 && t < 1.0 && distance(kernel::along(a, along, t), at(*end)) <= length_;
      if (is_beside && *end != way.low && *end != way.high) side.between.push_back(*end);
    }
    std::ranges::sort(side.between, {}, [&](std::uint32_t e) { return std::pair(share(e), e); });
  }
}

// As seen from the piece's front, it runs on beyond the side.
void FinderOfAlmostClosed::add_strip(const SideOfPiece& side, AlmostClosedSurface& surface) const {
  std::vector<std::uint32_t> ring{side.from, side.to, end_of_[side.to]};
  ring.insert(ring.end(), side.between.rbegin(), side.between.rend());
  ring.push_back(end_of_[side.from]);
  const Vec3 &a = at(side.from), &b = at(side.to);
  for (std::size_t i = 2; i < ring.size(); ++i) {
    surface.moved = std::max(surface.moved, distance_to_segment(at(ring[i]), a, b) + kOfPlaces);
  }
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    ExactPiece strip;
    strip.corners = {ring[0], ring[i + 1], ring[i]};
    const Point &p = scene_.vertices[ring[0]], &q = scene_.vertices[ring[i + 1]], &r = scene_.vertices[ring[i]];
    const Homogeneous plane = join(p, q, r);
    if (is_zero(plane)) continue;
    strip.plane = make_plane(plane, scene_.units);
    for (const std::uint32_t corner : strip.corners) strip.box.include(at(corner));
    surface.area_of_strips += 2.0 * (area({p.at, q.at, r.at}) + kOfPlaces);
    surface.strips.push_back(std::move(strip));
  }
}

std::vector<AlmostClosedSurface> FinderOfAlmostClosed::surfaces() {
  std::map<std::uint32_t, AlmostClosedSurface> found;  // by root
  for (std::uint32_t p = 0; p < scene_.pieces.size(); ++p) {
    if (!is_closed(p)) continue;
    ExactSurface& surface = found[surface_of_.root(p)].surface;
    surface.pieces.push_back(p);
    surface.box.include(scene_.pieces[p].box.low);
    surface.box.include(scene_.pieces[p].box.high);
  }
  for (const SideOfPiece& side : sides_) {
    if (is_closed(side.piece)) add_strip(side, found[surface_of_.root(side.piece)]);
  }
  std::vector<AlmostClosedSurface> result;
  for (auto& [root, surface] : found) result.push_back(std::move(surface));
  return result;
}

}  // namespace

std::vector<AlmostClosedSurface> almost_closed_surfaces(const ExactScene& scene) {
  std::vector<AlmostClosedSurface> result;
  std::vector<bool> known(scene.pieces.size());
  for (int exponent = kFirstLength; exponent <= kLastLength; exponent += kStepOfLength) {
    for (AlmostClosedSurface& found : FinderOfAlmostClosed(scene, std::ldexp(1.0, exponent)).surfaces()) {
      const auto is_known = [&](std::uint32_t piece) { return known[piece]; };
      if (std::ranges::all_of(found.surface.pieces, is_known)) continue;
      for (const std::uint32_t piece : found.surface.pieces) known[piece] = true;
      result.push_back(std::move(found));
    }
    if (std::ranges::all_of(scene.pieces,
                            [&](const ExactPiece& p) { return p.transparent || known[&p - scene.pieces.data()]; }))
      break;
  }
  return result;
}

}  // namespace exactff::view_factors
