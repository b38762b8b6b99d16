// Steps, each in time proportional to the scene's size except for the sorting of a vertex's edges:
//   1. leave out pieces with a corner that no other piece has, since they have an open edge, and transparent pieces;
//   2. sort the edges of the others by their ends;
//   3. join the pieces at each edge, and mark where an edge does not cancel; on request only after such edges have been
//      cut where ends of others lie on them;
//   4. on request, unmark edges of a set of pieces if all of them lie in one plane, and the set on one side;
//   5. each connected set of pieces without a mark is a closed surface.
#include "scene/closed_surfaces.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <map>
#include <numeric>

#include "kernel/filter.h"
#include "scene/groups.h"
#include "scene/scene.h"
#include "scene/solids.h"

namespace exactff {

namespace {

// A piece's edge, stored at the end with the lower place.
struct DirectedEdge {
  std::uint32_t high;
  std::uint32_t piece;
  bool upwards;  // from the lower place to the higher one
};

class Finder {
 public:
  Finder(const Scene& scene, ClosedSurfaces::Edges edges)
      : scene_(scene),
        places_(places(scene)),
        edges_are_cut_(edges == ClosedSurfaces::Edges::kCutAtJunctions),
        surface_of_(scene.pieces().size()),
        open_(scene.pieces().size(), 0) {}

  bool find() {
    leave_out_pieces();
    if (std::all_of(open_.begin(), open_.end(), [](std::uint8_t open) { return open != 0; })) return false;
    sort_edges();
    join_at_edges();
    if (edges_are_cut_) join_at_junctions();
    for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
      if (open_[piece] != 0) open_[root(piece)] = 1;
    }
    find_rims();
    return true;
  }

  [[nodiscard]] std::uint32_t root(std::uint32_t piece) { return surface_of_.root(piece); }
  [[nodiscard]] bool is_closed(std::uint32_t root) const { return open_[root] == 0; }
  [[nodiscard]] std::optional<ClosedSurface::Rim> rim_of(std::uint32_t root) const {
    const auto rim = rims_.find(root);
    return rim == rims_.end() ? std::nullopt : std::optional(rim->second);
  }

 private:
  template <class Take>
  void for_each_edge(std::uint32_t piece, const Take& take) const {
    const auto corners = scene_.corners(scene_.pieces()[piece]);
    std::uint32_t from = places_[corners.back()];
    for (const std::uint32_t corner : corners) {
      const std::uint32_t to = places_[corner];
      take(std::min(from, to), DirectedEdge{std::max(from, to), piece, from < to});
      from = to;
    }
  }

  void leave_out_pieces() {
    std::vector<std::uint32_t> uses(places_.size(), 0);
    const auto for_each_place = [&](const auto& take) {
      for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
        if (scene_.pieces()[piece].transparent) continue;
        for (const std::uint32_t corner : scene_.corners(scene_.pieces()[piece])) take(piece, places_[corner]);
      }
    };
    for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
      if (scene_.pieces()[piece].transparent) open_[piece] = 1;
    }
    for_each_place([&](std::uint32_t, std::uint32_t place) { ++uses[place]; });
    for_each_place([&](std::uint32_t piece, std::uint32_t place) {
      if (uses[place] < 2) open_[piece] = 1;
    });
  }

  void sort_edges() {
    begin_.assign(places_.size() + 1, 0);
    const auto for_each = [&](const auto& take) {
      for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
        if (open_[piece] == 0) for_each_edge(piece, take);
      }
    };
    for_each([&](std::uint32_t low, const DirectedEdge&) { ++begin_[low + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    edges_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    for_each([&](std::uint32_t low, const DirectedEdge& edge) { edges_[next[low]++] = edge; });
  }

  void join_at_edges() {
    for (std::size_t place = 0; place + 1 < begin_.size(); ++place) {
      const auto first = edges_.begin() + begin_[place], last = edges_.begin() + begin_[place + 1];
      std::sort(first, last, [](const DirectedEdge& a, const DirectedEdge& b) { return a.high < b.high; });
      for (auto at = first; at != last;) {
        const auto end = std::find_if(at, last, [&](const DirectedEdge& e) { return e.high != at->high; });
        join(static_cast<std::uint32_t>(place), {at, end});
        at = end;
      }
    }
  }

  void join(std::uint32_t low, std::span<const DirectedEdge> edge) {
    int balance = 0;
    for (const DirectedEdge& e : edge) {
      balance += e.upwards ? 1 : -1;
      surface_of_.join(e.piece, edge.front().piece);
    }
    if (balance == 0) return;
    if (!edges_are_cut_) {
      open_[edge.front().piece] = 1;
      return;
    }
    for (const DirectedEdge& e : edge) uncancelled_.push_back({low, e.high, e.piece, e.upwards});
  }

  void join_at_junctions() {
    cut_at_junctions(uncancelled_, scene_.vertices());
    exactff::for_each_edge(uncancelled_, [&](auto first, auto last) {
      for (auto use = first; use != last; ++use) surface_of_.join(use->piece, first->piece);
      const std::ptrdiff_t balance = balance_of(first, last);
      for (std::ptrdiff_t i = 0; i < std::abs(balance); ++i) {
        of_holes_.push_back({first->low, first->high, first->piece, balance > 0});
      }
    });
  }

  void find_rims() {
    for (const EdgeOfPiece& edge : of_holes_) {
      const std::uint32_t whole = root(edge.piece);
      if (open_[whole] != 0) continue;
      rims_[whole].edges.emplace_back(edge.upwards ? edge.low : edge.high, edge.upwards ? edge.high : edge.low);
    }
    for (auto rim = rims_.begin(); rim != rims_.end();) {
      const bool has_plane = find_plane(rim->second);
      if (!has_plane) open_[rim->first] = 1;
      rim = has_plane ? std::next(rim) : rims_.erase(rim);
    }
    turn_to_surfaces();
  }

  // False if the edges do not lie in one plane, or on one line.
  [[nodiscard]] bool find_plane(ClosedSurface::Rim& rim) const {
    const auto vertices = scene_.vertices();
    const auto& ends = rim.edges.front();
    const Vec3 &a = vertices[ends.first], &b = vertices[ends.second];
    const auto third = std::ranges::find_if(rim.edges, [&](const auto& edge) {
      return edge.first != ends.first && edge.first != ends.second && !are_straight(a, b, vertices[edge.first]);
    });
    if (third == rim.edges.end()) return false;
    rim.plane = {a, b, vertices[third->first]};
    const kernel::PlaneThrough plane(rim.plane[0], rim.plane[1], rim.plane[2]);
    return std::ranges::all_of(rim.edges, [&](const auto& edge) { return plane.side_of(vertices[edge.first]) == 0; });
  }

  // Of surfaces that lie on both sides of the plane, or in it, the edges stay marked.
  void turn_to_surfaces() {
    struct Side {
      kernel::PlaneThrough plane;
      bool before = false, behind = false;
    };
    std::map<std::uint32_t, Side> sides;
    for (const auto& [whole, rim] : rims_) sides.try_emplace(whole, Side{{rim.plane[0], rim.plane[1], rim.plane[2]}});
    if (sides.empty()) return;
    for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
      const auto found = sides.find(root(piece));
      if (found == sides.end()) continue;
      for (const std::uint32_t corner : scene_.corners(scene_.pieces()[piece])) {
        const int side = found->second.plane.side_of(scene_.vertices()[corner]);
        found->second.before = found->second.before || side > 0;
        found->second.behind = found->second.behind || side < 0;
      }
    }
    for (const auto& [whole, side] : sides) {
      if (side.before == side.behind) {
        open_[whole] = 1;
        rims_.erase(whole);
      } else if (side.behind) {
        std::swap(rims_[whole].plane[0], rims_[whole].plane[1]);
      }
    }
  }

  const Scene& scene_;
  const std::span<const std::uint32_t> places_;
  const bool edges_are_cut_;
  Groups surface_of_;               // by piece
  std::vector<std::uint8_t> open_;  // by piece
  std::vector<DirectedEdge> edges_;
  std::vector<std::uint32_t> begin_;                  // into edges_, by lower place, one more at the end
  std::vector<EdgeOfPiece> uncancelled_;              // edges that are to be cut
  std::vector<EdgeOfPiece> of_holes_;                 // of these, cut, what does not cancel
  std::map<std::uint32_t, ClosedSurface::Rim> rims_;  // by root
};

// Six times the volume between the piece and a point.
double volume(const Scene& scene, const Piece& piece, const Vec3& apex) {
  const auto corners = scene.corners(piece);
  const auto from_apex = [&](std::size_t corner) {
    const Vec3& p = scene.vertices()[corners[corner]];
    return Vec3{p.x - apex.x, p.y - apex.y, p.z - apex.z};
  };
  double sum = 0.0;
  const Vec3 a = from_apex(0);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Vec3 b = from_apex(i - 1), c = from_apex(i);
    sum += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
  }
  return sum;
}

}  // namespace

ClosedSurfaces::ClosedSurfaces(const Scene& scene, Edges edges) {
  Finder finder(scene, edges);
  if (!finder.find()) return;
  of_piece_.assign(scene.pieces().size(), kNone);
  std::vector<double> volumes;
  std::vector<Vec3> apexes;  // any point near the surface
  for (std::uint32_t index = 0; index < of_piece_.size(); ++index) {
    const std::uint32_t root = finder.root(index);
    if (!finder.is_closed(root)) continue;
    const Piece& piece = scene.pieces()[index];
    const Vec3& first = scene.vertices()[scene.corners(piece).front()];
    if (of_piece_[root] == kNone) {
      of_piece_[root] = static_cast<std::uint32_t>(surfaces_.size());
      surfaces_.push_back({.box = {first, first}, .rim = finder.rim_of(root)});
      volumes.push_back(0.0);
      apexes.push_back(first);
    }
    const std::uint32_t surface = of_piece_[index] = of_piece_[root];
    for (const std::uint32_t corner : scene.corners(piece)) surfaces_[surface].box.include(scene.vertices()[corner]);
    volumes[surface] += volume(scene, piece, apexes[surface]);
  }
  for (std::size_t s = 0; s < surfaces_.size(); ++s) surfaces_[s].turned_inside_out = volumes[s] < 0.0;
}

const ClosedSurfaces& closed_surfaces(const Scene& scene) {
  return SceneInside::data(scene).surfaces.made_by([&] { return ClosedSurfaces(scene); });
}

}  // namespace exactff
