// Round an edge from a to b, the uses of the edge are sorted by angle, counter-clockwise as seen from b. A piece that
// runs upwards, from a to b, has its front on the side that follows, so one leaves a solid there; at one that runs
// downwards, one enters. Entries and exits are matched as brackets are, around the circle. At one angle exits come
// first: what touches is not joined.
#include "scene/solids.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/exact_vec.h"
#include "scene/edges.h"
#include "scene/junctions.h"

namespace exactff {
namespace {

// Unions of pieces.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }
  std::uint32_t root(std::uint32_t of) {
    while (parent_[of] != of) of = parent_[of] = parent_[parent_[of]];
    return of;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

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
      : scene_(scene), groups_(scene.pieces().size()), open_(scene.pieces().size(), 0) {}

  void find() {
    const SceneEdges& edges = scene_edges(scene_);
    std::vector<EdgeOfPiece> uses;
    for (std::uint32_t id = 0; id < edges.size(); ++id) {
      uses.clear();
      const SceneEdge& edge = edges.edge(id);
      for (const EdgeUse& use : edges.uses(id)) uses.push_back({edge.a, edge.b, use.piece(), use.upwards()});
      pair_up(uses, unpaired_);
    }
    cut_at_junctions(unpaired_, scene_.vertices());
    std::vector<EdgeOfPiece> rest;
    for_each_edge(unpaired_, [&](auto first, auto last) {
      uses.assign(first, last);
      pair_up(uses, rest);
    });
    for (const EdgeOfPiece& use : rest) open_[use.piece] = 1;
    for (std::uint32_t piece = 0; piece < open_.size(); ++piece) {
      if (open_[piece] != 0 || scene_.pieces()[piece].transparent) open_[groups_.root(piece)] = 1;
    }
  }
  // The number of the closed group that the piece belongs to, or kNone.
  [[nodiscard]] std::uint32_t group(std::uint32_t piece) {
    const std::uint32_t root = groups_.root(piece);
    return open_[root] != 0 ? Solids::kNone : root;
  }

 private:
  void pair_up(std::vector<EdgeOfPiece>& uses, std::vector<EdgeOfPiece>& rest) {
    if (uses.size() == 2 && uses[0].upwards != uses[1].upwards) return groups_.join(uses[0].piece, uses[1].piece);
    if (uses.size() > 2) sort_by_angle(uses);
    std::vector<EdgeOfPiece> entries, exits;  // that wait for a partner
    for (const EdgeOfPiece& use : uses) {
      if (!use.upwards) {
        entries.push_back(use);
      } else if (entries.empty()) {
        exits.push_back(use);
      } else {
        match(entries, use);
      }
    }
    std::size_t matched = 0;
    for (; matched < exits.size() && !entries.empty(); ++matched) match(entries, exits[matched]);
    rest.insert(rest.end(), entries.begin(), entries.end());
    rest.insert(rest.end(), exits.begin() + static_cast<std::ptrdiff_t>(matched), exits.end());
  }
  void match(std::vector<EdgeOfPiece>& entries, const EdgeOfPiece& exit) {
    groups_.join(entries.back().piece, exit.piece);
    entries.pop_back();
  }
  void sort_by_angle(std::vector<EdgeOfPiece>& uses) const {
    const Dial dial(scene_, uses[0].low, uses[0].high, uses[0].piece);
    std::ranges::sort(uses, [&](const EdgeOfPiece& p, const EdgeOfPiece& q) {
      const int order = dial.compare(p.piece, q.piece);
      if (order != 0) return order < 0;
      return p.upwards != q.upwards ? p.upwards : p.piece < q.piece;
    });
  }

  const Scene& scene_;
  Groups groups_;
  std::vector<std::uint8_t> open_;  // by piece
  std::vector<EdgeOfPiece> unpaired_;
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

}  // namespace exactff
