// Finds out by a sweep whether any two edges cross.
//
// A line sweeps over the plane in the order of positions (by x, then y; so it leans a little and no edge is parallel to
// it). `status_` holds the edges that meet it from bottom to top. The two edges of the crossing that the sweep reaches
// first are neighbours in that order before it is reached. So only neighbours are tested: when an edge begins, it and
// its two neighbours; when one ends, the two that become neighbours. At one position edges end before others begin: an
// edge that touches a crossing from the left then no longer separates the crossing edges.
//
// Contacts that are not proper crossings do no harm: one of the two edges begins or ends there, so their order never
// changes. Edges that overlap on a line are ordered by index.
// Source: M. I. Shamos and D. Hoey, "Geometric intersection problems" (1976).
#include "scene/edge_crossing.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

namespace exactff {

namespace {

// Points ranked by position; points at one position have one rank.
std::vector<std::size_t> position_ranks(const PlanePoints& plane) {
  std::vector<std::size_t> order(plane.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return plane.compare(a, b) < 0; });
  std::vector<std::size_t> rank(plane.size());
  for (std::size_t i = 1; i < order.size(); ++i) {
    rank[order[i]] = rank[order[i - 1]] + (plane.compare(order[i - 1], order[i]) != 0 ? 1 : 0);
  }
  return rank;
}

class Sweep {
 public:
  Sweep(const FacePoints& points, const PlanePoints& plane)
      : plane_(plane), rank_(position_ranks(plane)), status_(Below{this}), place_(points.size(), status_.end()) {
    for (EdgeIndex edge = 0; edge < points.size(); ++edge) add_edge(edge, next_in_ring(points, edge));
    std::sort(events_.begin(), events_.end());
  }

  std::optional<std::pair<EdgeIndex, EdgeIndex>> run() {
    for (const Event& event : events_) {
      if (event.kind == EventKind::kEnd ? end(event.edge) : begin(event.edge)) return crossing_;
    }
    return std::nullopt;
  }

 private:
  enum class EventKind { kEnd, kBegin };  // in the order in which they take place at one position
  struct Event {
    std::size_t rank;
    EventKind kind;
    EdgeIndex edge;
    auto operator<=>(const Event&) const = default;
  };
  struct Edge {
    std::size_t left = 0;
    std::size_t right = 0;
  };
  struct Below {
    const Sweep* sweep;
    bool operator()(EdgeIndex a, EdgeIndex b) const { return sweep->is_below(a, b); }
  };
  using Status = std::set<EdgeIndex, Below>;

  void add_edge(EdgeIndex edge, std::size_t end) {
    edges_.push_back(rank_[edge] < rank_[end] ? Edge{edge, end} : Edge{end, edge});
    if (rank_[edge] == rank_[end]) return;
    events_.push_back({rank_[edges_.back().left], EventKind::kBegin, edge});
    events_.push_back({rank_[edges_.back().right], EventKind::kEnd, edge});
  }

  // The side of edge b's line on which edge a lies next to the sweep line, where a begins no earlier than b.
  int side_of_later(const Edge& a, const Edge& b) const {
    const int at_left = plane_.orientation(b.left, b.right, a.left);
    return at_left != 0 ? at_left : plane_.orientation(b.left, b.right, a.right);
  }

  bool is_below(EdgeIndex a, EdgeIndex b) const {
    const bool a_later = rank_[edges_[a].left] >= rank_[edges_[b].left];
    const int side = a_later ? side_of_later(edges_[a], edges_[b]) : -side_of_later(edges_[b], edges_[a]);
    return side != 0 ? side < 0 : a < b;
  }

  bool begin(EdgeIndex edge) {
    const auto place = status_.insert(edge).first;
    place_[edge] = place;
    const auto above = std::next(place);
    return (place != status_.begin() && cross(*std::prev(place), edge)) ||
           (above != status_.end() && cross(edge, *above));
  }

  bool end(EdgeIndex edge) {
    const auto above = status_.erase(place_[edge]);
    return above != status_.begin() && above != status_.end() && cross(*std::prev(above), *above);
  }

  bool cross(EdgeIndex a, EdgeIndex b) {
    const auto parts = [&](const Edge& e, const Edge& f) {
      return plane_.orientation(e.left, e.right, f.left) * plane_.orientation(e.left, e.right, f.right) < 0;
    };
    if (!parts(edges_[a], edges_[b]) || !parts(edges_[b], edges_[a])) return false;
    crossing_ = std::minmax(a, b);
    return true;
  }

  const PlanePoints& plane_;
  std::vector<std::size_t> rank_;
  std::vector<Edge> edges_;
  std::vector<Event> events_;
  Status status_;
  std::vector<Status::iterator> place_;  // of the edges in status_
  std::pair<EdgeIndex, EdgeIndex> crossing_;
};

}  // namespace

std::optional<std::pair<EdgeIndex, EdgeIndex>> find_crossing(const FacePoints& points, const PlanePoints& plane) {
  return Sweep(points, plane).run();
}

}  // namespace exactff
