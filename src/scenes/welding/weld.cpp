// Welding: the scene that was meant, where corners that should be one differ by a rounding or by a slip of an export.
//
// A round has four steps. Rounds follow until one changes nothing, so the result is a fixed point of the round.
//
// 1. Join. Corners whose distance is at most LENGTH are linked, by exact comparisons of squares; what links connect
//    becomes one corner. Each of its coordinates is the lower median of theirs, each counted as often as faces use it:
//    a given number, without rounding.
// 2. Straighten. The ends of an edge share a coordinate if theirs are equal, or if they differ by at most 2 LENGTH and
//    the edge is longer than 10 LENGTH. What shares it, along all edges, takes the lower median, unless the coordinates
//    differ by more than 4 LENGTH in all. So walls along axes are exactly planar, and corners on their edges exactly on
//    them. No other bent face can be made planar in doubles in general.
// 3. Junctions. An edge is open if an odd number of faces use it. An end of an open edge that is within LENGTH of the
//    inside of another one becomes a corner of the faces along it.
// 4. Drop corners that repeat their neighbour, spikes, and faces on a line.
//
// All of them depend on positions and on what connects them, not on the order of faces or vertices. How a bent face is
// cut depends on the order of its vertices, as it does in every scene; that order is kept.
//
// Rounds end. Step 1 leaves fewer positions, if it changes anything; step 2 leaves more edges with equal coordinates,
// and none less, since such ends move together; step 3 adds a corner to a face that does not have it; step 4 leaves
// fewer faces, or follows a change of positions. So (faces, positions, corners that faces lack, edges with ends that
// differ in a coordinate) falls lexicographically.
#include <algorithm>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "exactff/scene.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/groups.h"
#include "scene/scene.h"
#include "scene/scene_copy.h"
#include "scene/shaft_tree.h"
#include "scene/solids.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "welding/sheets.h"

namespace exactff {
namespace {

using Id = std::uint32_t;  // of a corner: an index of a position

constexpr double kStraightBy = 2.0, kLongBy = 10.0, kMostSpread = 4.0, kMostMove = 8.0;  // times LENGTH

using Place = std::tuple<double, double, double>;
Place key_of(const Vec3& v) { return {v.x, v.y, v.z}; }
double& coordinate(Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

namespace bg = boost::geometry;
class PointTree {
 public:
  PointTree(std::span<const Vec3> at, const std::vector<Id>& points) {
    std::vector<Entry> entries;
    for (const Id p : points) entries.push_back({{at[p].x, at[p].y, at[p].z}, p});
    tree_ = bg::index::rtree<Entry, bg::index::linear<16>>(entries);
  }
  template <class Take>
  void visit(const Box& box, const Take& take) const {
    const auto& [low, high] = box;
    const bg::model::box<Corner> within({low.x, low.y, low.z}, {high.x, high.y, high.z});
    for (auto found = tree_.qbegin(bg::index::intersects(within)); found != tree_.qend(); ++found) take(found->second);
  }

 private:
  using Corner = bg::model::point<double, 3, bg::cs::cartesian>;
  using Entry = std::pair<Corner, Id>;
  bg::index::rtree<Entry, bg::index::linear<16>> tree_;
};

// --- Distances ---

kernel::Rational square(double length) { return kernel::to_rational(length) * kernel::to_rational(length); }

kernel::Rational dot(const kernel::ScaledVec3& a, const kernel::ScaledVec3& b) {
  return kernel::times_power_of_two(kernel::Rational(kernel::dot(a.v, b.v)), a.exponent + b.exponent);
}

// In units of LENGTH, the computed square errs by less than 2^-48 of itself, where it is about 1.
bool are_within(const Vec3& p, const Vec3& q, double length) {
  const Vec3 d{(p.x - q.x) / length, (p.y - q.y) / length, (p.z - q.z) / length};
  const double squared = kernel::dot(d, d);
  if (std::abs(squared - 1.0) > 0x1p-40) return squared < 1.0;
  const kernel::ScaledVec3 exact = kernel::exact_difference(p, q);
  return dot(exact, exact) <= square(length);
}

// Whether x is within LENGTH of the segment, and its foot between the ends. Exact.
bool is_beside(const Vec3& x, const Vec3& a, const Vec3& b, double length) {
  const kernel::ScaledVec3 along = kernel::exact_difference(b, a), to = kernel::exact_difference(x, a);
  const kernel::Rational foot = dot(along, to), whole = dot(along, along);
  if (sgn(foot) <= 0 || foot >= whole) return false;
  const kernel::ScaledVec3 off{cross(along.v, to.v), along.exponent + to.exponent};
  return dot(off, off) <= square(length) * whole;
}

// --- Rounds ---

using Rings = std::vector<std::vector<Id>>;

struct Edge {
  Id low = 0, high = 0;
  std::uint32_t face = 0;

  [[nodiscard]] auto ends() const { return std::pair(low, high); }
};

class Welding {
 public:
  // A length of 0: only exact T-junctions.
  Welding(const Scene& scene, double length) : scene_(scene), length_(length), now_(scene.vertices().size()) {
    at_.assign(scene.vertices().begin(), scene.vertices().end());
    const std::span<const Id> place = places(scene);
    rings_.resize(scene.faces().size());
    for (std::size_t f = 0; f < rings_.size(); ++f) {
      if (scene.faces()[f].piece_count == 0) continue;
      rings_[f] = scene.faces()[f].rings;
      for (auto& ring : rings_[f]) std::ranges::transform(ring, ring.begin(), [&](Id v) { return place[v]; });
    }
    count_uses();
    corners_ = live_;
  }

  void run() {
    bool changed = true;
    while (changed) {
      kernel::poll();
      changed = length_ > 0.0 && join();
      changed = (length_ > 0.0 && straighten()) || changed;
      changed = add_junctions() || changed;
      changed = drop() || changed;
    }
    for (const Id corner : corners_) largest_move_ = std::max(largest_move_, move_of(corner));
  }

  [[nodiscard]] const Rings& rings(std::size_t face) const { return rings_[face]; }
  // Texture coordinates of a face with these rings, of each set. A corner that was added to an edge gets them between
  // its neighbours', by the distances from them.
  [[nodiscard]] std::array<std::vector<TexturePoint>, kTextureSets> textures(std::size_t face, const Rings& rings);
  [[nodiscard]] const Vec3& at(Id corner) const { return at_[corner]; }
  [[nodiscard]] std::span<const Id> before() const { return corners_; }
  [[nodiscard]] std::span<const Id> live() const { return live_; }
  [[nodiscard]] double largest_move() const { return largest_move_; }
  [[nodiscard]] std::size_t junctions() const { return junctions_; }
  // Of each face those whose first use it is, and the faces that edges connect.
  struct OpenEdges {
    std::vector<std::size_t> of_face;
    Groups parts;
    std::size_t count = 0;
  };
  [[nodiscard]] OpenEdges open_edges() const {
    OpenEdges open{std::vector<std::size_t>(rings_.size(), 0), Groups(rings_.size())};
    const std::vector<Edge> all = edges();
    for_each_open_edge(all, [&](std::span<const Edge> uses) {
      ++open.of_face[uses[0].face];
      ++open.count;
    });
    for (std::size_t e = 1; e < all.size(); ++e) {
      if (all[e].ends() == all[e - 1].ends()) open.parts.join(all[e].face, all[e - 1].face);
    }
    return open;
  }
  [[nodiscard]] double median_open_edge() const {
    std::vector<double> lengths;
    for_each_open_edge(edges(),
                       [&](auto uses) { lengths.push_back(kernel::distance(at_[uses[0].low], at_[uses[0].high])); });
    if (lengths.empty()) return 0.0;
    std::ranges::nth_element(lengths, lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2));
    return lengths[lengths.size() / 2];
  }
  [[nodiscard]] double move_of(Id corner) {
    return kernel::distance(at_[now_.root(corner)], scene_.vertices()[corner]);
  }

 private:
  // --- 1 ---

  bool join() {
    constexpr std::size_t kMostPairs = std::size_t{1} << 26;
    std::size_t pairs = 0;
    bool changed = false;
    const PointTree tree(at_, live_);
    for (const Id p : live_) {
      tree.visit(around(at_[p], at_[p], length_), [&](Id q) {
        if (q <= p || now_.root(p) == now_.root(q)) return;
        if (++pairs > kMostPairs) refuse_large();
        if (!are_within(at_[p], at_[q], length_)) return;
        now_.join(p, q);
        changed = true;
      });
    }
    if (!changed) return false;
    for (int axis = 0; axis < 3; ++axis) take_medians(axis, now_, HUGE_VAL);
    identify();
    return true;
  }

  // Every corner of a group gets the lower median of the group's coordinates, unless they differ by more than `most`.
  // Whether any changed.
  bool take_medians(int axis, Groups& groups, double most) {
    std::vector<std::tuple<Id, double, Id>> entries;  // group, coordinate, corner
    for (const Id corner : live_) {
      entries.emplace_back(groups.root(corner), kernel::coordinate(at_[corner], axis), corner);
    }
    std::ranges::sort(entries);
    bool changed = false;
    for (auto first = entries.begin(); first != entries.end();) {
      std::size_t uses = 0;
      auto last = first;
      for (; last != entries.end() && std::get<0>(*last) == std::get<0>(*first); ++last)
        uses += uses_[std::get<2>(*last)];
      const double low = std::get<1>(*first), high = std::get<1>(*std::prev(last));
      if (low < high && high - low <= most) {
        auto median = first;
        for (std::size_t below = uses_[std::get<2>(*median)]; 2 * below < uses;) below += uses_[std::get<2>(*++median)];
        const double value = std::get<1>(*median);
        for (; first != last; ++first) coordinate(at_[std::get<2>(*first)], axis) = value;
        changed = true;
      }
      first = last;
    }
    return changed;
  }

  // Corners at one position become one.
  void identify() {
    std::vector<Id> sorted = live_;
    std::ranges::sort(sorted, {}, [&](Id corner) { return std::pair(key_of(at_[corner]), corner); });
    std::vector<Id> one(at_.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      one[sorted[i]] = i > 0 && at_[sorted[i]] == at_[sorted[i - 1]] ? one[sorted[i - 1]] : sorted[i];
      now_.join(sorted[i], one[sorted[i]]);
    }
    for (const Id corner : sorted) at_[now_.root(corner)] = at_[corner];
    for_each_ring([&](std::vector<Id>& ring) {
      for (Id& corner : ring) corner = now_.root(corner);
    });
    count_uses();
  }

  void count_uses() {
    uses_.assign(at_.size(), 0);
    for_each_ring([&](const std::vector<Id>& ring) {
      for (const Id corner : ring) ++uses_[corner];
    });
    live_.clear();
    for (Id corner = 0; corner < uses_.size(); ++corner) {
      if (uses_[corner] > 0) live_.push_back(corner);
    }
  }

  template <class Take>
  void for_each_ring(const Take& take) {
    for (Rings& rings : rings_) {
      for (std::vector<Id>& ring : rings) take(ring);
    }
  }

  // --- 2 ---

  bool straighten() {
    bool changed = false;
    for (int axis = 0; axis < 3; ++axis) {
      Groups sharing(at_.size());
      bool is_any_off = false;
      for_each_ring([&](const std::vector<Id>& ring) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const Vec3 d = kernel::difference(at_[ring[(i + 1) % ring.size()]], at_[ring[i]]);
          const double apart = std::abs(kernel::coordinate(d, axis));
          if (apart == 0.0 || (apart <= kStraightBy * length_ && kernel::max_norm(d) > kLongBy * length_)) {
            sharing.join(ring[i], ring[(i + 1) % ring.size()]);
            is_any_off = is_any_off || apart > 0.0;
          }
        }
      });
      changed = (is_any_off && take_medians(axis, sharing, kMostSpread * length_)) || changed;
    }
    if (changed) identify();
    return changed;
  }

  // --- 3 ---

  [[nodiscard]] std::vector<Edge> edges() const {
    std::vector<Edge> edges;
    for (std::uint32_t f = 0; f < rings_.size(); ++f) {
      for (const std::vector<Id>& ring : rings_[f]) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
          const auto [low, high] = std::minmax(ring[i], ring[(i + 1) % ring.size()]);
          edges.push_back({low, high, f});
        }
      }
    }
    std::ranges::sort(edges, {}, &Edge::ends);
    return edges;
  }
  // With all uses of the edge.
  template <class Take>
  static void for_each_open_edge(const std::vector<Edge>& edges, const Take& take) {
    for (auto first = edges.begin(); first != edges.end();) {
      const auto last = std::find_if(first, edges.end(), [&](const Edge& e) { return e.ends() != first->ends(); });
      if ((last - first) % 2 == 1) take(std::span(first, last));
      first = last;
    }
  }

  bool add_junctions() {
    const std::vector<Edge> all = edges();
    std::vector<Id> ends;
    for_each_open_edge(all, [&](auto uses) { ends.insert(ends.end(), {uses[0].low, uses[0].high}); });
    std::ranges::sort(ends);
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    const PointTree tree(at_, ends);
    std::map<std::uint32_t, std::map<std::pair<Id, Id>, std::vector<Id>>> beside;  // by face and edge
    for_each_open_edge(all, [&](auto uses) {
      const std::vector<Id> found = beside_edge(tree, uses[0]);
      for (const Edge& use : uses) {
        if (!found.empty()) beside[use.face][use.ends()] = found;
      }
    });
    std::size_t added = 0;
    for (const auto& [face, corners] : beside) {
      for (std::vector<Id>& ring : rings_[face]) added += add_junctions(corners, ring);
    }
    if (added > 0) count_uses();
    junctions_ += added;
    return added > 0;
  }

  // In the order from the end that comes first by its position.
  [[nodiscard]] std::vector<Id> beside_edge(const PointTree& tree, const Edge& edge) const {
    const bool turned = key_of(at_[edge.high]) < key_of(at_[edge.low]);
    const Vec3 &a = at_[turned ? edge.high : edge.low], &b = at_[turned ? edge.low : edge.high];
    const Vec3 along = kernel::difference(b, a);
    std::vector<Id> found;
    tree.visit(around(a, b, length_), [&](Id x) {
      constexpr double kRounding = 0x1p-40;
      if (x == edge.low || x == edge.high) return;
      const Vec3 to = kernel::difference(at_[x], a);
      const double size = kernel::length(along);
      const double off = kernel::length(kernel::cross(along, to)) / size, reach = 2.0 * length_ + kRounding * size;
      if (off > reach || !is_beside(at_[x], a, b, length_)) return;
      found.push_back(x);
    });
    std::ranges::sort(
        found, {}, [&](Id x) { return std::pair(kernel::dot(along, kernel::difference(at_[x], a)), key_of(at_[x])); });
    return found;
  }

  // A corner beside several edges of the ring is added to the nearest one.
  std::size_t add_junctions(const std::map<std::pair<Id, Id>, std::vector<Id>>& beside, std::vector<Id>& ring) const {
    std::map<Id, std::tuple<double, Place, Place>> nearest;
    for_each_edge_of(ring, [&](const std::pair<Id, Id>& ends) {
      const auto found = beside.find(ends);
      if (found == beside.end()) return;
      for (const Id x : found->second) {
        const auto [place, is_new] = nearest.try_emplace(x, nearness(x, ends));
        if (!is_new) place->second = std::min(place->second, nearness(x, ends));
      }
    });
    for (const Id corner : ring) nearest.erase(corner);
    std::vector<Id> longer;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Id from = ring[i], to = ring[(i + 1) % ring.size()];
      const std::pair<Id, Id> ends = std::minmax(from, to);
      longer.push_back(from);
      const auto found = beside.find(ends);
      if (found == beside.end()) continue;
      std::vector<Id> added;
      for (const Id x : found->second) {
        const auto place = nearest.find(x);
        if (place == nearest.end() || place->second != nearness(x, ends)) continue;
        added.push_back(x);
        nearest.erase(place);
      }
      if (key_of(at_[to]) < key_of(at_[from])) std::ranges::reverse(added);
      longer.insert(longer.end(), added.begin(), added.end());
    }
    std::swap(ring, longer);
    return ring.size() - longer.size();
  }

  template <class Take>
  static void for_each_edge_of(const std::vector<Id>& ring, const Take& take) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      take(std::pair<Id, Id>(std::minmax(ring[i], ring[(i + 1) % ring.size()])));
  }
  [[nodiscard]] std::tuple<double, Place, Place> nearness(Id x, const std::pair<Id, Id>& ends) const {
    const Place one = key_of(at_[ends.first]), other = key_of(at_[ends.second]);
    const Vec3 &a = at_[one < other ? ends.first : ends.second], &b = at_[one < other ? ends.second : ends.first];
    const Vec3 along = kernel::unit(kernel::difference(b, a));
    return {kernel::length(kernel::cross(along, kernel::difference(at_[x], a))), std::min(one, other),
            std::max(one, other)};
  }

  // --- 4 ---

  bool drop() {
    bool changed = false;
    for (Rings& rings : rings_) {
      for (std::vector<Id>& ring : rings) changed = without_spikes(ring) || changed;
      if (rings.empty() || !is_on_a_line(rings.front())) continue;
      rings.clear();
      changed = true;
    }
    for (Rings& rings : rings_) std::erase_if(rings, [](const auto& ring) { return ring.size() < 3; });
    if (changed) count_uses();
    return changed;
  }

  // Corners that repeat their neighbour, and those from which the outline returns to where it came from.
  static bool without_spikes(std::vector<Id>& ring) {
    const std::size_t before = ring.size();
    for (std::size_t i = 0; i < ring.size() && ring.size() > 1;) {
      const std::size_t n = ring.size(), next = (i + 1) % n;
      const bool repeats = ring[i] == ring[next], is_spike = ring[(i + n - 1) % n] == ring[next];
      if (!repeats && !is_spike) {
        ++i;
        continue;
      }
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    }
    return ring.size() != before;
  }
  [[nodiscard]] bool is_on_a_line(const std::vector<Id>& ring) const {
    return ring.size() < 3 || std::ranges::all_of(ring, [&](Id v) {
             return v == ring[0] || v == ring[1] || are_straight(at_[ring[0]], at_[ring[1]], at_[v]);
           });
  }

  [[noreturn]] void refuse_large() const {
    text::refuse("--weld " + text::shortest(length_) + " is not smaller than what the scene is made of",
                 "very many corners lie within this length of each other",
                 "give a smaller length; `exactff info` advises one");
  }

  const Scene& scene_;
  double length_;
  Groups now_;            // of the scene's positions: what has become one
  std::vector<Vec3> at_;  // of the root
  std::vector<Rings> rings_;
  std::vector<Id> uses_;
  std::vector<Id> live_, corners_;  // now and at first
  double largest_move_ = 0.0;
  std::size_t junctions_ = 0;
};

std::array<std::vector<TexturePoint>, kTextureSets> Welding::textures(std::size_t face, const Rings& rings) {
  std::array<std::vector<TexturePoint>, kTextureSets> result;
  for (std::size_t set = 0; set < result.size(); ++set) {
    const std::span<const TexturePoint> before = scene_.texture(static_cast<FaceId>(face), static_cast<int>(set));
    if (before.empty()) continue;
    std::map<Id, TexturePoint> known;
    std::size_t k = 0;
    for (const auto& ring : scene_.faces()[face].rings) {
      for (const Id corner : ring) known.try_emplace(now_.root(places(scene_)[corner]), before[k++]);
    }
    for (const auto& ring : rings) {
      const auto corner = [&](std::size_t i) { return ring[i % ring.size()]; };
      const auto length = [&](std::size_t from, std::size_t to) {
        double sum = 0.0;
        for (; from < to; ++from) sum += kernel::distance(at_[corner(from)], at_[corner(from + 1)]);
        return sum;
      };
      for (std::size_t i = ring.size(); i < 2 * ring.size(); ++i) {
        std::size_t low = i, high = i;
        while (low > 0 && !known.contains(corner(low))) --low;
        while (high < 3 * ring.size() && !known.contains(corner(high))) ++high;
        const auto from = known.find(corner(low)), to = known.find(corner(high));
        if (from == known.end() || to == known.end()) return {};  // nothing is left of the face's own corners
        const double share = low < high ? length(low, i) / length(low, high) : 0.0;
        result[set].push_back(between(from->second, to->second, share));
      }
    }
  }
  return result;
}

// Face to face: the set of corners of a face.
std::vector<Id> corner_set(const Rings& rings) {
  std::vector<Id> all;
  for (const auto& ring : rings) all.insert(all.end(), ring.begin(), ring.end());
  std::ranges::sort(all);
  return all;
}

// --- The scene ---

void require_possible(const Scene& scene, double length) {
  if (!(length > 0.0) || !std::isfinite(length)) {
    text::refuse("corners cannot be welded within " + text::shortest(length),
                 "it is a positive length in the scene's unit",
                 "give the largest distance of corners that should be one");
  }
  if (length / extent(scene).largest < 0x1p-100 || length < 0x1p100 * std::numeric_limits<double>::denorm_min()) {
    text::refuse("the length " + text::shortest(length) + " is too small for the scene's coordinates",
                 "doubles are too far apart there", "give a larger length");
  }
}

void require_small_moves(Welding& welding, const Scene& scene, double length) {
  if (welding.largest_move() <= kMostMove * length) return;
  const auto before = welding.before();
  const Id corner = *std::ranges::max_element(
      before, {}, [&](Id c) { return std::pair(welding.move_of(c), key_of(scene.vertices()[c])); });
  const auto& [x, y, z] = scene.vertices()[corner];
  text::refuse("welded within " + text::shortest(length) + ", the corner at (" + text::short_number(x) + ", " +
                   text::short_number(y) + ", " + text::short_number(z) + ") would move by " +
                   text::short_number(welding.move_of(corner)),
               "a chain of corners within this length is much longer than it",
               "give a smaller length; `exactff info` advises one");
}

WeldedScene built(const Scene& scene, Welding& welding, double length) {
  SceneBuilder builder = begun_as(scene);
  for (const Patch& patch : scene.patches()) (void)builder.patch(patch.name);
  std::vector<std::uint32_t> vertex(scene.vertices().size(), 0);
  for (const Id corner : welding.live()) vertex[corner] = builder.add_vertex(welding.at(corner));
  std::vector<FaceId> vanished;
  std::vector<FaceId> flipped, transparent;
  std::vector<std::vector<Id>> before, now;  // corners of faces
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const Face& face = scene.faces()[f];
    if (face.piece_count == 0) continue;
    Rings rings = welding.rings(f);
    if (rings.empty()) {
      vanished.push_back(static_cast<FaceId>(f));
      continue;
    }
    const auto made = static_cast<FaceId>(now.size());
    now.push_back(corner_set(rings));
    before.push_back(corner_set(face.rings));
    for (Id& corner : before.back()) corner = places(scene)[corner];
    std::ranges::sort(before.back());
    if (face.transparent) transparent.push_back(made);
    if (face.flipped) flipped.push_back(made);
    for (auto& ring : rings) {
      if (face.flipped) std::ranges::reverse(ring);
    }
    const std::array textures = welding.textures(f, rings);
    for (auto& ring : rings) {
      for (Id& corner : ring) corner = vertex[corner];
    }
    builder.add_face(face.patch, face.material, std::move(rings), face.line);
    for (int set = 0; set < kTextureSets; ++set) {
      const std::vector<TexturePoint>& texture = textures[static_cast<std::size_t>(set)];
      if (!texture.empty()) builder.state_texture(set, texture);
    }
    if (face.is_twin) builder.mark_as_twin();
  }
  if (now.empty()) {
    text::refuse("welded within " + text::shortest(length) + ", nothing is left of the scene",
                 "all of its faces are no larger than that", "give a smaller length; `exactff info` advises one");
  }
  WeldedScene result{with_faces(builder.build(), std::move(flipped), std::move(transparent)),
                     welding.before().size(),
                     welding.live().size(),
                     welding.largest_move(),
                     welding.junctions(),
                     std::move(vanished),
                     {}};
  SheetFinder sheets(result.scene, length);
  sheets.compare(before, now);
  sheets.look_around();
  result.sheets = sheets.take();
  return result;
}

}  // namespace

WeldedScene welded(const Scene& scene, double length) {
  const kernel::StandardArithmetic arithmetic;
  require_possible(scene, length);
  Welding welding(scene, length);
  welding.run();
  require_small_moves(welding, scene, length);
  return built(scene, welding, length);
}

// --- The gap ---

namespace {

constexpr std::size_t kNotPossible = std::numeric_limits<std::size_t>::max();

// Of connected faces, those after welding count if it closes what was a surface with open edges, or half of all open
// edges, and the faces are not parallel. Others, such as free sheets that lie near each other, count as before, unless
// the length is a rounding.
std::size_t counted_edges(const Scene& scene, bool is_rounding, Welding::OpenEdges before, Welding::OpenEdges after) {
  constexpr double kParallel = 0.999;  // the cosine
  struct Part {
    std::size_t before = 0, after = 0;
    bool is_bent = false, closes_one = false;
  };
  const auto faces = static_cast<std::uint32_t>(scene.faces().size());
  std::vector<Part> old(faces), now(faces);  // at their first face
  for (std::uint32_t f = 0; f < faces; ++f) {
    for (Part* part : {&old[before.parts.root(f)], &now[after.parts.root(f)]}) {
      part->before += before.of_face[f];
      part->after += after.of_face[f];
    }
  }
  const auto front = [&](std::uint32_t f) { return kernel::unit_by_inverse(scene.faces()[f].newell); };
  for (std::uint32_t f = 0; f < faces; ++f) {
    Part& part = now[after.parts.root(f)];
    part.closes_one = part.closes_one || (old[f].before > 0 && old[f].after == 0);
    part.is_bent = part.is_bent || std::abs(kernel::dot(front(f), front(after.parts.root(f)))) <= kParallel;
  }
  std::size_t count = 0;
  for (const Part& part : now) {
    const bool counts = is_rounding || (part.is_bent && (part.closes_one || 2 * part.after <= part.before));
    count += counts ? part.after : part.before;
  }
  return count;
}

// Not possible where chains are too long, or where a face vanishes that is no sliver, or is the last of its patch.
std::size_t open_edges_after(const Scene& scene, const Welding& exact, double length) {
  constexpr double kSliver = 16.0, kRounding = 0x1p-20;
  Welding welding(scene, length);
  try {
    welding.run();
  } catch (const InputError&) {
    return kNotPossible;
  }
  if (length > 0.0 && welding.largest_move() > kMostMove * length) return kNotPossible;
  std::vector<bool> stays(scene.patches().size());
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    if (!welding.rings(f).empty()) stays[index_of(scene.faces()[f].patch)] = true;
  }
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const Face& face = scene.faces()[f];
    if (face.piece_count == 0 || !welding.rings(f).empty()) continue;
    if (!stays[index_of(face.patch)]) return kNotPossible;
    const auto far = [&](Id v) {
      return kernel::distance(scene.vertices()[v], scene.vertices()[face.rings[0][0]]) > kSliver * length;
    };
    if (std::ranges::none_of(face.rings[0], far)) return kNotPossible;
  }
  return counted_edges(scene, length <= kRounding * extent(scene).diameter, exact.open_edges(), welding.open_edges());
}

// At least the length, with two digits.
double two_digits_above(double length) {
  const double unit = std::pow(10.0, std::floor(std::log10(length)) - 1.0);
  return std::max(length, text::parse_number(text::short_number(std::ceil(length / unit) * unit, 2)).value);
}

}  // namespace

// Tries lengths a hundred times smaller each, then halves the last step seven times.
std::optional<Gap> gap(const Scene& scene) {
  constexpr double kMostShare = 1.0 / 256.0, kMostOfEdge = 1.0 / 16.0, kLeastShare = 1e-17, kStep = 100.0;
  constexpr int kHalvings = 7;
  const kernel::StandardArithmetic arithmetic;
  const double size = extent(scene).diameter;
  const std::size_t open_edges = scene.open_edge_count();
  if (open_edges == 0 || size < 0x1p-900) return std::nullopt;
  Welding exact(scene, 0.0);
  const double median = exact.median_open_edge();
  exact.run();
  const std::size_t before = open_edges_after(scene, exact, 0.0);
  std::size_t fewest = before;
  double length = 0.0;
  const double most = std::min(size * kMostShare, median * kMostOfEdge);
  for (double tried = most; tried >= size * kLeastShare && before > 0; tried /= kStep) {
    const std::size_t open = open_edges_after(scene, exact, tried);
    if (open == kNotPossible || open > fewest) continue;
    fewest = open;
    if (open < before) length = tried;
  }
  if (length == 0.0) return std::nullopt;
  double too_small = length / kStep;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = std::sqrt(too_small) * std::sqrt(length);
    (open_edges_after(scene, exact, middle) <= fewest ? length : too_small) = middle;
  }
  if (const double more = two_digits_above(length); open_edges_after(scene, exact, more) <= fewest) length = more;
  Welding welding(scene, length);
  welding.run();
  return Gap{length, open_edges, welding.open_edges().count};
}

}  // namespace exactff
