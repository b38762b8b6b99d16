// Steps:
//   1. Sort the edges of all pieces by the places of their ends. Where just two pieces share one, are of planar faces
//      of one patch, and lie side by side in one oriented plane, connect them. The edges that then have one piece are
//      cut where corners of others lie on them (T-junctions), and looked at again.
//   2. Of each connected set of several faces, keep the edges that do not cancel: its boundary. Chain them into rings;
//      drop corners in the middle of a straight side.
//   3. Cut what the rings enclose as a face with holes is cut (triangulation.h).
//   4. Keep the parts if they are fewer than the pieces.
//
// Why the parts are the union. Let m(y) be the number of pieces that hold a point y of the plane. The rings are the
// boundary of all pieces together, so m is the sum of their winding numbers, almost everywhere. One ring encloses
// positive area, R say, and winds around every point at most once; the parts are the points of R inside an even number
// of other rings. There m = 1 + an even number, and m >= 0, so m is odd and at least 1. The integral of m is the area
// that the rings enclose by their directions. If the parts have that area, m is 1 in them and 0 elsewhere.
#include "scene/panels.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "kernel/filter.h"
#include "kernel/numbers.h"
#include "kernel/poll.h"
#include "kernel/split_mix.h"
#include "scene/closed_surfaces.h"
#include "scene/edges.h"
#include "scene/face_points.h"
#include "scene/scene.h"
#include "scene/solids.h"

namespace exactff {
namespace {

// Leaves the edges that do not cancel. False if one remains more than once.
bool cancel(std::vector<EdgeOfPiece>& edges) {
  bool overlap = false;
  auto kept = edges.begin();
  for_each_edge(edges, [&](auto first, auto last) {
    const std::ptrdiff_t balance = balance_of(first, last);
    overlap = overlap || balance > 1 || balance < -1;
    if (balance == 0) return;
    EdgeOfPiece edge = *first;
    edge.upwards = balance > 0;
    *kept++ = edge;
  });
  edges.erase(kept, edges.end());
  return !overlap;
}

class Joiner {
 public:
  explicit Joiner(const Scene& scene)
      : scene_(scene), pieces_(scene.pieces()), vertices_(scene.vertices()), places_(places(scene)) {}

  // Sets of at least two faces, each ascending, by their first pieces.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> connected_sets() {
    parent_.resize(pieces_.size());
    std::iota(parent_.begin(), parent_.end(), 0U);
    std::vector<EdgeOfPiece> single;
    if (scene_.transparent().empty()) {
      single = connect_sorted(scene_edges(scene_));
    } else {
      for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece) add_edges(piece, single);
      connect(single);
    }
    connect_at_junctions(single);
    std::vector<std::vector<std::uint32_t>> sets;
    if (!several_faces_) return sets;
    std::map<std::uint32_t, std::size_t> set_of_root;
    for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece) {
      const std::uint32_t first = root(piece);
      if (first == piece) continue;
      const auto [at, is_new] = set_of_root.try_emplace(first, sets.size());
      if (is_new) sets.push_back({first});
      sets[at->second].push_back(piece);
    }
    std::erase_if(sets, [&](const std::vector<std::uint32_t>& set) {
      return pieces_[set.front()].face == pieces_[set.back()].face;
    });
    return sets;
  }

  // The convex parts of a set's union, if they are fewer than its pieces.
  [[nodiscard]] std::optional<std::vector<ConvexPart>> parts_of(std::span<const std::uint32_t> set) const {
    std::optional<std::vector<Ring>> rings = boundary_of(set);
    if (!rings) return std::nullopt;
    // The outer ring first: the one that runs as the pieces do.
    const kernel::ExactVec3 front = normal(pieces_[set.front()]);
    const FacePoints points = face_points(vertices_, *rings);
    std::size_t outer = 0, outer_count = 0;
    for (std::size_t r = 0; r < rings->size(); ++r) {
      const int sense = kernel::sign(dot(front, newell(points, points.ring_start[r], points.ring_start[r + 1])));
      if (sense > 0) ++outer_count, outer = r;
    }
    if (outer_count != 1) return std::nullopt;
    std::swap(rings->front(), (*rings)[outer]);
    CutFace cut = cut_face(vertices_, *rings);
    if (cut.fault || cut.shape != FaceShape::kPlanar || cut.parts.size() >= set.size()) return std::nullopt;
    if (!have_one_area(*rings, cut.parts)) return std::nullopt;
    return std::move(cut.parts);
  }

 private:
  void add_edges(std::uint32_t piece, std::vector<EdgeOfPiece>& edges) const {
    const auto corners = scene_.corners(pieces_[piece]);
    std::uint32_t from = places_[corners.back()];
    for (const std::uint32_t corner : corners) {
      const std::uint32_t to = places_[corner];
      edges.push_back({std::min(from, to), std::max(from, to), piece, from < to});
      from = to;
    }
  }

  // All uses of an edge.
  template <class Iterator>
  void connect_along(Iterator first, Iterator last) {
    if (last - first != 2 || !lie_side_by_side(*first, *(first + 1))) return;
    const std::uint32_t a = root(first->piece), b = root((first + 1)->piece);
    parent_[std::max(a, b)] = std::min(a, b);
    several_faces_ = several_faces_ || pieces_[first->piece].face != pieces_[(first + 1)->piece].face;
  }

  // Leaves the edges that only one piece has.
  void connect(std::vector<EdgeOfPiece>& edges) {
    auto single = edges.begin();
    for_each_edge(edges, [&](auto first, auto last) {
      if (last - first == 1) *single++ = *first;
      connect_along(first, last);
    });
    edges.erase(single, edges.end());
  }

  // The same for all edges of the scene, which have been sorted for silhouettes, too. Transparent pieces have none
  // there.
  std::vector<EdgeOfPiece> connect_sorted(const SceneEdges& edges) {
    std::vector<EdgeOfPiece> single, uses;
    for (std::uint32_t id = 0; id < edges.size(); ++id) {
      uses.clear();
      for (const EdgeUse& use : edges.uses(id)) {
        uses.push_back({edges.edge(id).a, edges.edge(id).b, use.piece(), use.upwards()});
      }
      if (uses.size() == 1) single.push_back(uses.front());
      connect_along(uses.begin(), uses.end());
    }
    return single;
  }

  void connect_at_junctions(std::vector<EdgeOfPiece>& single) {
    std::ranges::stable_sort(single, {}, [&](const EdgeOfPiece& edge) { return patch_of(edge); });
    std::vector<EdgeOfPiece> of_patch;
    for (auto first = single.begin(); first != single.end();) {
      const auto last =
          std::find_if(first, single.end(), [&](const auto& e) { return patch_of(e) != patch_of(*first); });
      of_patch.assign(first, last);
      first = last;
      const std::size_t count = of_patch.size();
      cut_at_junctions(of_patch, vertices_);
      if (of_patch.size() > count) connect(of_patch);
    }
  }

  [[nodiscard]] PatchId patch_of(const EdgeOfPiece& edge) const { return scene_.face(pieces_[edge.piece].face).patch; }

  // The pieces lie on different sides of the edge, in one plane, with their fronts on one side of it.
  [[nodiscard]] bool lie_side_by_side(const EdgeOfPiece& a, const EdgeOfPiece& b) const {
    const Piece &p = pieces_[a.piece], &q = pieces_[b.piece];
    if (a.upwards == b.upwards || p.transparent != q.transparent) return false;
    const Face &f = scene_.face(p.face), &g = scene_.face(q.face);
    if (f.patch != g.patch || f.shape != FaceShape::kPlanar || g.shape != FaceShape::kPlanar) return false;
    for (const std::uint32_t vertex : q.frame) {
      if (!is_in_plane(p, vertex)) return false;
    }
    return kernel::sign(dot(normal(p), normal(q))) > 0;
  }

  [[nodiscard]] bool is_in_plane(const Piece& piece, std::uint32_t vertex) const {
    const Vec3 &x = vertices_[vertex], &a = vertices_[piece.frame[0]], &b = vertices_[piece.frame[1]],
               &c = vertices_[piece.frame[2]];
    if (x == a || x == b || x == c) return true;
    using kernel::approx_difference;
    const int filtered = kernel::sign_of_det(approx_difference(a, x), approx_difference(b, x), approx_difference(c, x));
    return (filtered != kernel::kUncertain ? filtered : kernel::orientation(x, a, b, c)) == 0;
  }

  [[nodiscard]] kernel::ExactVec3 normal(const Piece& piece) const {
    const Vec3& a = vertices_[piece.frame[0]];
    return cross(kernel::exact_difference(vertices_[piece.frame[1]], a).v,
                 kernel::exact_difference(vertices_[piece.frame[2]], a).v);
  }

  [[nodiscard]] std::uint32_t root(std::uint32_t piece) {
    while (parent_[piece] != piece) piece = parent_[piece] = parent_[parent_[piece]];
    return piece;
  }

  // Nullopt where pieces overlap for certain.
  [[nodiscard]] std::optional<std::vector<Ring>> boundary_of(std::span<const std::uint32_t> set) const {
    std::vector<EdgeOfPiece> edges;
    for (const std::uint32_t piece : set) add_edges(piece, edges);
    if (!cancel(edges)) return std::nullopt;
    cut_at_junctions(edges, vertices_);
    if (!cancel(edges)) return std::nullopt;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> left;  // from, to
    for (const EdgeOfPiece& edge : edges) {
      left.emplace_back(edge.upwards ? edge.low : edge.high, edge.upwards ? edge.high : edge.low);
    }
    // As many edges end at a place as begin there, so every chain ends where it began.
    std::ranges::sort(left);
    std::vector<bool> used(left.size());
    std::vector<Ring> rings;
    for (std::size_t start = 0; start < left.size(); ++start) {
      if (used[start]) continue;
      Ring ring;
      for (std::size_t at = start;;) {
        used[at] = true;
        ring.push_back(left[at].first);
        if (left[at].second == left[start].first) break;
        at = static_cast<std::size_t>(std::ranges::lower_bound(left, std::pair(left[at].second, 0U)) - left.begin());
        while (used[at]) ++at;
      }
      ring = without_straight_corners(std::move(ring));
      if (!ring.empty()) rings.push_back(std::move(ring));
    }
    return rings;
  }

  // Without corners on a line with their neighbours. Winding numbers do not change, almost everywhere.
  [[nodiscard]] Ring without_straight_corners(Ring ring) const {
    Ring kept;
    const auto drop_straight = [&](std::uint32_t next) {
      while (kept.size() > 1 && are_straight(kept[kept.size() - 2], kept.back(), next)) kept.pop_back();
    };
    for (const std::uint32_t corner : ring) {
      drop_straight(corner);
      kept.push_back(corner);
    }
    while (kept.size() > 2 && are_straight(kept[kept.size() - 2], kept.back(), kept.front())) kept.pop_back();
    while (kept.size() > 2 && are_straight(kept.back(), kept.front(), kept[1])) kept.erase(kept.begin());
    return kept.size() > 2 ? kept : Ring{};
  }

  [[nodiscard]] bool are_straight(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return exactff::are_straight(vertices_[a], vertices_[b], vertices_[c]);
  }

  [[nodiscard]] bool have_one_area(const std::vector<Ring>& rings, const std::vector<ConvexPart>& parts) const {
    std::vector<Ring> all = rings;
    for (const ConvexPart& part : parts) all.push_back(part.corners);
    const FacePoints points = face_points(vertices_, all);
    kernel::ExactVec3 difference;
    for (std::size_t r = 0; r < all.size(); ++r) {
      const kernel::ExactVec3 area = newell(points, points.ring_start[r], points.ring_start[r + 1]);
      difference = r < rings.size() ? difference + area : difference - area;
    }
    return is_zero(difference);
  }

  const Scene& scene_;
  const std::span<const Piece> pieces_;
  const std::span<const Vec3> vertices_;
  const std::span<const std::uint32_t> places_;
  std::vector<std::uint32_t> parent_;  // by piece
  bool several_faces_ = false;         // in a set
};

std::uint32_t common_surface(const Scene& scene, std::span<const std::uint32_t> pieces) {
  const ClosedSurfaces& surfaces = closed_surfaces(scene);
  if (surfaces.empty()) return ClosedSurfaces::kNone;
  const std::uint32_t first = surfaces.of_piece(pieces.front());
  const bool all = std::ranges::all_of(pieces, [&](std::uint32_t p) { return surfaces.of_piece(p) == first; });
  return all ? first : ClosedSurfaces::kNone;
}

}  // namespace

Panels::Panels(const Scene& scene) : pieces_(scene.pieces()), corners_(SceneInside::data(scene).corners) {
  Joiner joiner(scene);
  for (std::vector<std::uint32_t>& set : joiner.connected_sets()) {
    kernel::poll();
    if (const auto parts = joiner.parts_of(set)) add(scene, std::move(set), *parts);
  }
}

void Panels::add(const Scene& scene, std::vector<std::uint32_t> pieces, const std::vector<ConvexPart>& parts) {
  if (empty()) sheet_of_piece_.assign(pieces_.size(), kNoSheet);
  const auto sheet = static_cast<std::uint32_t>(sheets_.size());
  for (const std::uint32_t piece : pieces) sheet_of_piece_[piece] = sheet;
  const Piece& first = pieces_[pieces.front()];
  const auto first_panel = static_cast<PanelId>(end());
  for (const ConvexPart& part : parts) {
    const auto [a, b, c] = part.frame;
    joined_.push_back({.face = first.face,
                       .first_corner = static_cast<std::uint32_t>(joined_corners_.size()),
                       .corner_count = static_cast<std::uint32_t>(part.corners.size()),
                       .frame = {a, b, c},
                       .transparent = first.transparent});
    joined_corners_.insert(joined_corners_.end(), part.corners.begin(), part.corners.end());
    sheet_of_joined_.push_back(sheet);
  }
  const std::uint32_t surface = common_surface(scene, pieces);
  sheets_.push_back({std::move(pieces), first_panel, static_cast<std::uint32_t>(parts.size()), surface});
}

const Panels& panels(const Scene& scene) {
  return SceneInside::data(scene).panels.made_by([&] { return Panels(scene); });
}

const ShaftTree& panel_tree(const Scene& scene) {
  const Panels& all = panels(scene);
  if (all.empty()) return shaft_tree(scene);
  return SceneInside::data(scene).panel_tree.made_by([&] {
    std::vector<PanelId> ids;
    for (PanelId id = 0; id < all.end(); ++id) {
      if (all.is_joined(id) || all.sheet_of_piece(id) == Panels::kNoSheet) ids.push_back(id);
    }
    std::vector<Box> boxes;
    boxes.reserve(ids.size());
    for (const PanelId id : ids) boxes.push_back(box_of(scene, all.corners(id)));
    return ShaftTree(boxes, ids);
  });
}

// --- Planes ---

// Pieces are first sorted by a hash that is the same for all pieces of one plane. Pieces of one hash are then compared
// exactly.
//
// The hash. A plane n . y = d has homogeneous coordinates (n, d), rational numbers that are known up to a factor. They
// are computed modulo the prime p = 2^31 - 1, which divides no power of 2, and divided by the first one that is not 0.
// That is the same for all pieces of one plane, unless the factor between the n of two pieces is divisible by p. Then
// one n is 0 modulo p. Such an n is replaced by the primitive integers along it, and these are not all divisible by p.

namespace {

using Residue = std::uint64_t;  // below kPrime
using Residues = std::array<Residue, 3>;

constexpr int kPrimeBits = 31;
constexpr Residue kPrime = (Residue{1} << kPrimeBits) - 1;

// 2^31 is 1 modulo p.
Residue reduced(std::uint64_t a) {
  a = (a & kPrime) + (a >> kPrimeBits);
  a = (a & kPrime) + (a >> kPrimeBits);
  return a >= kPrime ? a - kPrime : a;
}

Residue times_power_of_two(Residue a, long exponent) {
  const long turn = exponent % kPrimeBits;
  return reduced(a << (turn < 0 ? turn + kPrimeBits : turn));
}

Residue negative(Residue a) { return a == 0 ? 0 : kPrime - a; }

Residue residue(double value) {
  const kernel::BinaryDouble parts = kernel::decompose(value);
  const bool is_negative = parts.mantissa < 0;
  const auto magnitude = static_cast<std::uint64_t>(is_negative ? -parts.mantissa : parts.mantissa);
  const Residue result = times_power_of_two(reduced(magnitude), parts.exponent);
  return is_negative ? negative(result) : result;
}

Residues residues_of(const Vec3& v) { return {residue(v.x), residue(v.y), residue(v.z)}; }

Residue residue(const kernel::Integer& value) { return mpz_fdiv_ui(value.get_mpz_t(), kPrime); }

Residues difference(const Residues& a, const Residues& b) {
  return {reduced(a[0] + kPrime - b[0]), reduced(a[1] + kPrime - b[1]), reduced(a[2] + kPrime - b[2])};
}

Residues cross(const Residues& a, const Residues& b) {
  const auto determinant = [&](int i, int j) { return reduced(a[i] * b[j] + (kPrime - a[j]) * b[i]); };
  return {determinant(1, 2), determinant(2, 0), determinant(0, 1)};
}

Residue dot(const Residues& a, const Residues& b) { return reduced(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]); }

// By Fermat: a^(p - 2).
Residue inverse(Residue a) {
  Residue result = 1;
  for (std::uint64_t exponent = kPrime - 2; exponent > 0; exponent >>= 1U) {
    if ((exponent & 1U) != 0) result = reduced(result * a);
    a = reduced(a * a);
  }
  return result;
}

// Of residues that are not 0, by one inverse for all (Montgomery).
std::vector<Residue> inverses(const std::vector<Residue>& values) {
  std::vector<Residue> products{1};
  for (const Residue value : values) products.push_back(reduced(products.back() * value));
  Residue rest = inverse(products.back());
  std::vector<Residue> result(values.size());
  for (std::size_t i = values.size(); i > 0; --i) {
    result[i - 1] = reduced(rest * products[i - 1]);
    rest = reduced(rest * values[i - 1]);
  }
  return result;
}

class PlaneFinder {
 public:
  explicit PlaneFinder(const Scene& scene) : scene_(scene), at_(scene.vertices().size()) {
    std::ranges::transform(scene.vertices(), at_.begin(), [](const Vec3& vertex) { return residues_of(vertex); });
  }

  // For each piece, the first one in its plane.
  [[nodiscard]] std::vector<std::uint32_t> first_pieces() const {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> hashed = hashes();
    std::ranges::sort(hashed);
    std::vector<std::uint32_t> first(hashed.size());
    for (auto run = hashed.begin(); run != hashed.end();) {
      const auto end = std::find_if(run, hashed.end(), [&](const auto& other) { return other.first != run->first; });
      set_first_pieces({run, end}, first);
      run = end;
    }
    return first;
  }

 private:
  void set_first_pieces(std::span<const std::pair<std::uint64_t, std::uint32_t>> run,
                        std::vector<std::uint32_t>& first) const {
    std::vector<std::pair<kernel::PlaneThrough, std::uint32_t>> known;
    for (const auto& hashed : run) {
      const Piece& piece = scene_.pieces()[hashed.second];
      const auto holds = [&](const auto& plane) { return holds_all(plane.first, piece); };
      const auto plane = std::ranges::find_if(known, holds);
      first[hashed.second] = plane == known.end() ? hashed.second : plane->second;
      if (plane == known.end() && run.size() > 1) known.emplace_back(plane_through(piece), hashed.second);
    }
  }

  [[nodiscard]] const Vec3& corner(const Piece& piece, int i) const { return scene_.vertices()[piece.frame[i]]; }
  [[nodiscard]] kernel::PlaneThrough plane_through(const Piece& piece) const {
    return {corner(piece, 0), corner(piece, 1), corner(piece, 2)};
  }
  [[nodiscard]] bool holds_all(const kernel::PlaneThrough& plane, const Piece& piece) const {
    return plane.side_of(corner(piece, 0)) == 0 && plane.side_of(corner(piece, 1)) == 0 &&
           plane.side_of(corner(piece, 2)) == 0;
  }

  [[nodiscard]] std::vector<std::pair<std::uint64_t, std::uint32_t>> hashes() const {
    std::vector<Residues> normals;
    std::vector<Residue> first;  // that is not 0
    for (const Piece& piece : scene_.pieces()) {
      const Residues& n = normals.emplace_back(normal_of(piece));
      first.push_back(n[0] != 0 ? n[0] : n[1] != 0 ? n[1] : n[2]);
    }
    const std::vector<Residue> by = inverses(first);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> result;
    for (std::uint32_t piece = 0; piece < normals.size(); ++piece) {
      const Residues& n = normals[piece];
      std::uint64_t hash = 0;
      for (const Residue component : {n[0], n[1], n[2], dot(n, at_[scene_.pieces()[piece].frame[0]])}) {
        hash = kernel::split_mix(hash, reduced(component * by[piece]));
      }
      result.emplace_back(hash, piece);
    }
    return result;
  }

  [[nodiscard]] Residues normal_of(const Piece& piece) const {
    const Residues& a = at_[piece.frame[0]];
    const Residues n = cross(difference(at_[piece.frame[1]], a), difference(at_[piece.frame[2]], a));
    return n == Residues{} ? primitive_normal(piece) : n;
  }

  [[nodiscard]] Residues primitive_normal(const Piece& piece) const {
    kernel::ExactVec3 n = kernel::cross(kernel::exact_difference(corner(piece, 1), corner(piece, 0)).v,
                                        kernel::exact_difference(corner(piece, 2), corner(piece, 0)).v);
    kernel::make_primitive(n);
    return {residue(n.x), residue(n.y), residue(n.z)};
  }

  const Scene& scene_;
  std::vector<Residues> at_;  // of the vertices
};

}  // namespace

Planes::Planes(const Scene& scene) {
  const std::vector<std::uint32_t> first = PlaneFinder(scene).first_pieces();
  std::uint32_t found = 0;
  for (std::uint32_t piece = 0; piece < first.size(); ++piece) {
    of_piece_.push_back(first[piece] == piece ? PlaneId{found++} : of_piece_[first[piece]]);
  }
  sort_pieces(found);
}

void Planes::sort_pieces(std::size_t found) {
  first_.assign(found + 1, 0);
  for (const PlaneId plane : of_piece_) ++first_[index_of(plane) + 1];
  for (std::size_t i = 0; i < found; ++i) first_[i + 1] += first_[i];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  pieces_.resize(of_piece_.size());
  for (std::uint32_t piece = 0; piece < of_piece_.size(); ++piece) {
    pieces_[next[index_of(of_piece_[piece])]++] = piece;
  }
}

const Planes& planes(const Scene& scene) {
  return SceneInside::data(scene).planes.made_by([&] { return Planes(scene); });
}

}  // namespace exactff
