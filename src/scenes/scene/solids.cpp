// Round an edge from a to b, the uses of the edge are sorted by angle, counter-clockwise as seen from b. A piece that
// runs upwards, from a to b, has its front on the side that follows, so one leaves a solid there; at one that runs
// downwards, one enters. Entries and exits are matched as brackets are, around the circle. What lies on each other is
// not joined if it can be avoided: at one angle exits come first, and those that lie on an entry are matched first.
// So are a box and what it stands on told apart, and two rooms with a common wall.
#include "scene/solids.h"

#include <boost/container/small_vector.hpp>
#include <cmath>
#include <optional>
#include <utility>

#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "scene/edges.h"
#include "scene/groups.h"
#include "scene/scene.h"

namespace exactff {
namespace {

// Where the pieces of an edge lie round it.
class Dial {
 public:
  Dial(const Scene& scene, std::uint32_t low, std::uint32_t high, std::uint32_t first)
      : scene_(scene), a_(scene.vertices()[low]), b_(scene.vertices()[high]), zero_(beside(first)) {}

  // Of two pieces, counted from the first one.
  [[nodiscard]] int compare(std::uint32_t p, std::uint32_t q) const {
    const Vec3 &to_p = beside(p), &to_q = beside(q);
    const int at_p = quadrant(to_p), at_q = quadrant(to_q);
    return at_p != at_q ? at_p - at_q : -kernel::orientation(a_, b_, to_p, to_q);
  }
  // Whether the piece lies on the same side of the edge as the first one, in its plane.
  [[nodiscard]] bool is_at_zero(std::uint32_t piece) const { return quadrant(beside(piece)) == 0; }

 private:
  // A corner of the piece off the edge's line.
  [[nodiscard]] const Vec3& beside(std::uint32_t piece) const {
    const auto& frame = scene_.pieces()[piece].frame;
    const auto at = [&](int i) -> const Vec3& { return scene_.vertices()[frame[i]]; };
    return are_straight(a_, at(0), b_) ? at(are_straight(a_, at(1), b_) ? 2 : 1) : at(0);
  }
  // 0: the angle is 0; 1: below a half turn; 2: a half turn; 3: above.
  [[nodiscard]] int quadrant(const Vec3& v) const {
    if (const int side = kernel::orientation(a_, b_, zero_, v); side != 0) return side > 0 ? 1 : 3;
    const kernel::ExactVec3 along = kernel::exact_difference(b_, a_).v;
    const kernel::Integer cosine =
        dot(cross(along, kernel::exact_difference(zero_, a_).v), cross(along, kernel::exact_difference(v, a_).v));
    return sgn(cosine) > 0 ? 0 : 2;
  }

  const Scene& scene_;
  const Vec3 &a_, &b_;
  const Vec3& zero_;
};

class SolidFinder {
 public:
  explicit SolidFinder(const Scene& scene)
      : scene_(scene),
        groups_(scene.pieces().size()),
        open_(scene.pieces().size(), 0),
        contested_(scene_edges(scene).size(), 0) {}

  void find() {
    const SceneEdges& edges = scene_edges(scene_);
    leave_out_pieces();
    if (std::ranges::all_of(open_, [](std::uint8_t open) { return open != 0; })) return;
    find_contested();
    std::vector<EdgeOfPiece> contested, rest, unmatched;
    for (std::uint32_t id = 0; id < edges.size(); ++id) {
      const Uses uses = uses_of(id);
      if (contested_[id] == 0) {
        if (!uses.empty()) groups_.join(uses[0].piece(), uses[1].piece());
        continue;
      }
      const SceneEdge& edge = edges.edge(id);
      for (const EdgeUse& use : uses) contested.push_back({edge.a, edge.b, use.piece(), use.upwards()});
    }
    cut_at_junctions(contested, scene_.vertices());
    for_each_edge(contested, [&](auto first, auto last) { leave_unmatched({first, last}, rest); });
    for_each_edge(rest, [&](auto first, auto last) { match_across_wedges({first, last}, unmatched); });
    for (const EdgeOfPiece& use : unmatched) open_[use.piece] = 1;
    for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
      if (open_[piece] != 0) open_[groups_.root(piece)] = 1;
    }
  }
  // The number of the closed group that the piece belongs to, or kNone.
  [[nodiscard]] std::uint32_t group(std::uint32_t piece) {
    const std::uint32_t root = groups_.root(piece);
    return open_[root] != 0 ? Solids::kNone : root;
  }

 private:
  // Those that are transparent, twins (Face::is_twin), and those with a corner that no other piece has, but in the
  // middle of a straight side: along the edges to it, nothing ends.
  void leave_out_pieces() {
    const auto at = places(scene_);
    std::vector<std::uint32_t> uses(at.size(), 0);
    const auto corners = [&](std::uint32_t piece) { return scene_.corners(scene_.pieces()[piece]); };
    for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
      const Piece& own = scene_.pieces()[piece];
      open_[piece] = own.transparent || scene_.face(own.face).is_twin ? 1 : 0;
      if (open_[piece] != 0) continue;
      for (const std::uint32_t corner : corners(piece)) ++uses[at[corner]];
    }
    for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
      const auto ring = corners(piece);
      for (std::size_t i = 0; i < ring.size() && open_[piece] == 0; ++i) {
        const auto vertex = [&](std::size_t k) -> const Vec3& { return place(ring[k % ring.size()]); };
        const bool is_alone =
            uses[at[ring[i]]] < 2 && !are_straight(vertex(i + ring.size() - 1), vertex(i), vertex(i + 1));
        if (is_alone) open_[piece] = 1;
      }
    }
  }

  // By pieces that are not left out.
  using Uses = boost::container::small_vector<EdgeUse, 4>;
  [[nodiscard]] Uses uses_of(std::uint32_t id) const {
    Uses uses;
    for (const EdgeUse& use : scene_edges(scene_).uses(id)) {
      if (open_[use.piece()] == 0) uses.push_back(use);
    }
    return uses;
  }

  // No piece has the edge, or two have it, one in each direction, and do not lie on each other.
  [[nodiscard]] bool is_plain(std::uint32_t id) const {
    const SceneEdge& edge = scene_edges(scene_).edge(id);
    const Uses uses = uses_of(id);
    if (uses.empty()) return true;
    if (uses.size() != 2 || uses[0].upwards() == uses[1].upwards()) return false;
    return are_clearly_opposite(edge, uses[0].piece(), uses[1].piece()) ||
           !Dial(scene_, edge.a, edge.b, uses[0].piece()).is_at_zero(uses[1].piece());
  }

  // A filter for meshes. A computed vector from the edge's line to a corner errs by less than 2^-50 of the product of
  // the lengths that it is made from. Where the sine is above 1e-6, its direction is off by less than 1e-8, so the
  // cosine of two of them, below -0.01 as computed, is negative. What overflows is left to exact numbers.
  [[nodiscard]] bool are_clearly_opposite(const SceneEdge& edge, std::uint32_t p, std::uint32_t q) const {
    constexpr double kLeastSine = 1e-6, kMostCosine = -0.01, kLeastLength = 0x1p-200;
    const Vec3 &a = place(edge.a), along = kernel::difference(place(edge.b), a);
    const auto off_line = [&](std::uint32_t piece) {
      for (const std::uint32_t v : scene_.pieces()[piece].frame) {
        const Vec3 arm = kernel::difference(place(v), a), off = kernel::cross(along, arm);
        const double product = kernel::length(along) * kernel::length(arm);
        if (product >= kLeastLength && kernel::length(off) > kLeastSine * product) return off;
      }
      return Vec3{};
    };
    const Vec3 off_p = off_line(p), off_q = off_line(q);
    const double size = kernel::length(off_p) * kernel::length(off_q);
    return size >= kLeastLength && kernel::dot(off_p, off_q) < kMostCosine * size;
  }

  // Edges that are not plain, and those that have a part in common with one that is contested. If a solid has an edge
  // as a whole, and what touches it there in parts, then neither may be paired before both are cut. Of very many, none
  // is cut (solids.h).
  void find_contested() {
    std::vector<std::uint32_t> waiting;
    const auto contest = [&](std::uint32_t id) {
      if (contested_[id] == 0) waiting.push_back(id);
      contested_[id] = 1;
    };
    for (std::uint32_t id = 0; id < contested_.size(); ++id) {
      if (!is_plain(id)) contest(id);
    }
    if (waiting.size() > kMostCut) return;
    while (!waiting.empty()) {
      const std::uint32_t id = waiting.back();
      waiting.pop_back();
      for_each_on_line(id, contest);
    }
  }
  template <class Take>
  void for_each_on_line(std::uint32_t id, const Take& take) const {
    const SceneEdges& edges = scene_edges(scene_);
    const Vec3 &a = place(edges.edge(id).a), &b = place(edges.edge(id).b);
    Box box{a, a};
    box.include(b);
    shaft_tree(scene_).visit_where([&](const Box& node, std::size_t) { return meet(node, box); },
                                   [&](std::uint32_t piece, std::size_t) {
                                     if (open_[piece] != 0) return;
                                     for (const std::uint32_t other : edges.of_piece(scene_.pieces()[piece])) {
                                       const SceneEdge& edge = edges.edge(other);
                                       if (other != id && have_common_part(a, b, place(edge.a), place(edge.b)))
                                         take(other);
                                     }
                                   });
  }
  [[nodiscard]] const Vec3& place(std::uint32_t v) const { return scene_.vertices()[v]; }
  [[nodiscard]] static bool have_common_part(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto is_on_line = [&](const Vec3& v) { return v == a || v == b || are_straight(a, v, b); };
    if (!is_on_line(c) || !is_on_line(d)) return false;
    double Vec3::*axis = a.x != b.x ? &Vec3::x : a.y != b.y ? &Vec3::y : &Vec3::z;
    return std::max(std::min(a.*axis, b.*axis), std::min(c.*axis, d.*axis)) <
           std::min(std::max(a.*axis, b.*axis), std::max(c.*axis, d.*axis));
  }

  // Matches pieces that plain edges connect, whatever lies between them: behind the walls of two rooms that touch,
  // wedges overlap.
  void leave_unmatched(std::span<const EdgeOfPiece> uses, std::vector<EdgeOfPiece>& rest) {
    std::vector<EdgeOfPiece> left;
    for (const EdgeOfPiece& use : uses) {
      const auto partner = std::ranges::find_if(left, [&](const EdgeOfPiece& other) {
        return other.upwards != use.upwards && groups_.root(other.piece) == groups_.root(use.piece);
      });
      if (partner == left.end()) {
        left.push_back(use);
      } else {
        left.erase(partner);
      }
    }
    rest.insert(rest.end(), left.begin(), left.end());
  }
  void match_across_wedges(std::span<const EdgeOfPiece> all, std::vector<EdgeOfPiece>& rest) {
    std::vector<EdgeOfPiece> uses;
    leave_unmatched(all, uses);
    if (uses.empty()) return;
    const Dial dial(scene_, uses[0].low, uses[0].high, uses[0].piece);
    sort_by_angle(dial, uses);
    std::vector<std::uint8_t> is_matched(uses.size(), 0);
    const auto is_free = [&](std::size_t i, bool exit) { return uses[i].upwards == exit && is_matched[i] == 0; };
    const auto coincide = [&](std::size_t i, std::size_t j) { return dial.compare(uses[i].piece, uses[j].piece) == 0; };
    const auto lies_on_an_entry = [&](std::size_t exit) {
      for (std::size_t i = 0; i < uses.size(); ++i) {
        if (is_free(i, false) && coincide(i, exit)) return true;
      }
      return false;
    };
    enum class Exits { kOnEntries, kAll, kWithSheets };
    for (const Exits exits : {Exits::kOnEntries, Exits::kAll, Exits::kWithSheets}) {
      for (std::size_t steps = 1; steps < uses.size(); ++steps) {
        for (std::size_t exit = 0; exit < uses.size(); ++exit) {
          const std::size_t entry = (exit + uses.size() - steps) % uses.size();
          if (!is_free(exit, true) || !is_free(entry, false)) continue;
          if (exits != Exits::kWithSheets && coincide(exit, entry)) continue;
          if (exits == Exits::kOnEntries && !lies_on_an_entry(exit)) continue;
          groups_.join(uses[entry].piece, uses[exit].piece);
          is_matched[entry] = is_matched[exit] = 1;
        }
      }
    }
    for (std::size_t i = 0; i < uses.size(); ++i) {
      if (is_matched[i] == 0) rest.push_back(uses[i]);
    }
  }
  static void sort_by_angle(const Dial& dial, std::vector<EdgeOfPiece>& uses) {
    std::ranges::sort(uses, [&](const EdgeOfPiece& p, const EdgeOfPiece& q) {
      const int order = dial.compare(p.piece, q.piece);
      if (order != 0) return order < 0;
      return p.upwards != q.upwards ? p.upwards : p.piece < q.piece;
    });
  }

  const Scene& scene_;
  Groups groups_;
  std::vector<std::uint8_t> open_;       // by piece
  std::vector<std::uint8_t> contested_;  // by edge
};

// The sign of the sum of det(a, b, c) over triangles, of points as seen from the apex.
//
// Filter, with u = 2^-53: each of the six products of a determinant carries 5u, and its five sums 5u, of the sum of
// their magnitudes; n further sums carry n u of the sum m of all. m is computed to within (n + 16) u.
int sign_of_volume(const Scene& scene, std::span<const std::uint32_t> pieces) {
  const auto vertex = [&](std::uint32_t v) -> const Vec3& { return scene.vertices()[v]; };
  const Vec3& apex = vertex(scene.corners(scene.pieces()[pieces.front()]).front());
  double sum = 0.0, magnitude = 0.0, count = 0.0;
  const auto for_each_triangle = [&](const auto& take) {
    for (const std::uint32_t piece : pieces) {
      const auto corners = scene.corners(scene.pieces()[piece]);
      for (std::size_t i = 2; i < corners.size(); ++i) {
        take(vertex(corners[0]), vertex(corners[i - 1]), vertex(corners[i]));
      }
    }
  };
  for_each_triangle([&](const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 a{p.x - apex.x, p.y - apex.y, p.z - apex.z}, b{q.x - apex.x, q.y - apex.y, q.z - apex.z},
        c{r.x - apex.x, r.y - apex.y, r.z - apex.z};
    for (const double term : {a.x * (b.y * c.z), -a.x * (b.z * c.y), a.y * (b.z * c.x), -a.y * (b.x * c.z),
                              a.z * (b.x * c.y), -a.z * (b.y * c.x)}) {
      sum += term;
      magnitude += std::abs(term);
      ++count;
    }
  });
  constexpr double kLeast = 0x1p-700, kLargest = 0x1p900;
  if (magnitude >= kLeast && magnitude <= kLargest && std::abs(sum) > (count + 32.0) * 0x1p-51 * magnitude) {
    return sum > 0.0 ? 1 : -1;
  }
  kernel::Rational exact;
  for_each_triangle([&](const Vec3& p, const Vec3& q, const Vec3& r) {
    const kernel::ScaledVec3 a = kernel::exact_difference(p, apex), b = kernel::exact_difference(q, apex),
                             c = kernel::exact_difference(r, apex);
    exact +=
        kernel::times_power_of_two(kernel::Rational(dot(a.v, cross(b.v, c.v))), a.exponent + b.exponent + c.exponent);
  });
  return sgn(exact);
}

}  // namespace

Solids::Solids(const Scene& scene) : of_piece_(scene.pieces().size(), kNone) {
  SolidFinder finder(scene);
  finder.find();
  std::vector<std::uint32_t> solid_of_group(of_piece_.size(), kNone);
  for (std::uint32_t piece = 0; piece < of_piece_.size(); ++piece) {
    const std::uint32_t group = finder.group(piece);
    if (group == kNone) continue;
    std::uint32_t& solid = solid_of_group[group];
    const Box box = box_of(scene, scene.corners(scene.pieces()[piece]));
    if (solid == kNone) {
      solid = static_cast<std::uint32_t>(solids_.size());
      solids_.emplace_back().box = box;
    }
    of_piece_[piece] = solid;
    solids_[solid].pieces.push_back(piece);
    solids_[solid].box.include(box.low);
    solids_[solid].box.include(box.high);
  }
  for (Solid& solid : solids_) solid.sign = sign_of_volume(scene, solid.pieces);
}

// --- Junctions ---

namespace {

// Between the ends of the edge, on its line.
bool is_inside(std::uint32_t place, const EdgeOfPiece& edge, std::span<const Vec3> vertices) {
  if (place == edge.low || place == edge.high) return false;
  const Vec3 &x = vertices[place], &a = vertices[edge.low], &b = vertices[edge.high];
  const auto within = [](double u, double from, double to) {
    return std::min(from, to) <= u && u <= std::max(from, to);
  };
  return within(x.x, a.x, b.x) && within(x.y, a.y, b.y) && within(x.z, a.z, b.z) && are_straight(a, x, b);
}

}  // namespace

bool are_straight(const Vec3& a, const Vec3& middle, const Vec3& c) {
  return is_zero(cross(kernel::exact_difference(a, middle).v, kernel::exact_difference(c, middle).v));
}

void cut_at_junctions(std::vector<EdgeOfPiece>& edges, std::span<const Vec3> vertices) {
  if (edges.size() > kMostCut) return;
  std::vector<std::uint32_t> ends;
  for (const EdgeOfPiece& edge : edges) ends.insert(ends.end(), {edge.low, edge.high});
  const auto x_of = [&](std::uint32_t place) { return vertices[place].x; };
  std::ranges::sort(ends, {}, [&](std::uint32_t place) { return std::pair(x_of(place), place); });
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  const auto end_inside = [&](const EdgeOfPiece& edge) {
    const auto [least, largest] = std::minmax({x_of(edge.low), x_of(edge.high)});
    const auto first = std::ranges::lower_bound(ends, least, {}, x_of);
    const auto last = std::ranges::upper_bound(ends, largest, {}, x_of);
    const auto found = std::find_if(first, last, [&](std::uint32_t end) { return is_inside(end, edge, vertices); });
    return found == last ? std::nullopt : std::optional(*found);
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const std::optional<std::uint32_t> inside = end_inside(edges[e]);
    if (!inside) continue;
    // Two edges with the direction of the whole. Both are looked at later.
    const auto [low, high, piece, upwards] = edges[e];
    edges.push_back({std::min(low, *inside), std::max(low, *inside), piece, upwards == (low < *inside)});
    edges.push_back({std::min(high, *inside), std::max(high, *inside), piece, upwards == (*inside < high)});
    edges[e] = edges.back();
    edges.pop_back();
    --e;
  }
}

}  // namespace exactff
