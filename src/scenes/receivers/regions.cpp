// Regions: faces that a modelling program cut a flat surface into.
//
//   1. Faces of one patch are neighbours if exactly two of them share an edge and run along it in opposite directions.
//   2. Neighbours are joined if one of them lies close to the plane of the other, by a share of the diameter of the
//      patch.
//   3. A connected set whose corners all lie within 1e-6 of its diameter of its mean plane is a region.
//   4. Any other set is split by step 2, with an eighth of the share of its own diameter, down to single faces.
// Step 2 measures by the whole set because the plane of a sliver is nearly arbitrary once its corners are rounded, and
// only the surface around it tells that it is a part of a plane. Step 3 is what the result promises; step 2 only
// proposes. Both are estimates by the basic operations of IEEE arithmetic, the same on every machine.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "exactff/receiver.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "scene/shaft_tree.h"

namespace exactff {
namespace {

using kernel::cross;
using kernel::difference;
using kernel::dot;

constexpr double kFlat = 1e-6;  // of the diameter
constexpr int kMostSplits = 12;

// A face in coordinates multiplied by a power of two that brings the scene's largest near 1.
struct FlatFace {
  FaceId id{};
  PatchId patch{};
  std::vector<Vec3> corners;
  Vec3 area;    // Newell vector
  Vec3 normal;  // unit
  Box box;
};

using Set = std::vector<std::uint32_t>;  // of indices into the list of faces, ascending

class Finder {
 public:
  Finder(const Scene& scene, std::span<const FaceId> faces) : scene_(scene), places_(places(scene)) {
    for (const FaceId face : faces) {
      if (scene.face(face).piece_count > 0) add(face);
    }
    neighbours_.resize(faces_.size());
    find_neighbours();
    parent_.resize(faces_.size());
    set_.resize(faces_.size());
  }

  std::vector<Region> find() {
    std::map<PatchId, Set> patches;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) patches[faces_[f].patch].push_back(f);
    for (const auto& [patch, set] : patches) split(set, 1.0, kMostSplits);
    std::ranges::sort(regions_, {}, [](const Region& region) { return region.faces.front(); });
    return std::move(regions_);
  }

 private:
  struct DirectedEdge {
    std::uint32_t low, high;  // places
    std::uint32_t face;
    bool upwards;
  };

  void add(FaceId id) {
    const Face& face = scene_.face(id);
    FlatFace flat{id, face.patch, {}, {}, {}, {}};
    for (const std::uint32_t v : face.rings.front()) {
      flat.corners.push_back(kernel::scaled(scene_.vertices()[v], extent(scene_).scale));
    }
    const Vec3 origin = flat.corners.front();
    flat.box = {origin, origin};
    for (std::size_t i = 0; i < flat.corners.size(); ++i) {
      const Vec3 &p = flat.corners[i], &q = flat.corners[(i + 1) % flat.corners.size()];
      flat.area = kernel::sum(flat.area, cross(difference(p, origin), difference(q, origin)));
      flat.box.include(p);
    }
    flat.normal = kernel::unit_by_inverse(flat.area);
    faces_.push_back(std::move(flat));
  }

  void find_neighbours() {
    std::vector<DirectedEdge> edges;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      const auto& ring = scene_.face(faces_[f].id).rings.front();
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::uint32_t a = places_[ring[i]], b = places_[ring[(i + 1) % ring.size()]];
        if (a != b) edges.push_back({std::min(a, b), std::max(a, b), f, a < b});
      }
    }
    const auto key = [](const DirectedEdge& e) { return std::tuple(e.low, e.high, e.face); };
    std::ranges::sort(edges, {}, key);
    for (auto first = edges.begin(); first != edges.end();) {
      const auto end = std::find_if(
          first, edges.end(), [&](const DirectedEdge& e) { return e.low != first->low || e.high != first->high; });
      if (end - first == 2 && are_neighbours(first[0], first[1])) {
        neighbours_[first[0].face].push_back(first[1].face);
        neighbours_[first[1].face].push_back(first[0].face);
      }
      first = end;
    }
  }

  [[nodiscard]] bool are_neighbours(const DirectedEdge& a, const DirectedEdge& b) const {
    const FlatFace &p = faces_[a.face], &q = faces_[b.face];
    return a.upwards != b.upwards && a.face != b.face && p.patch == q.patch && dot(p.normal, q.normal) > 0.0;
  }

  [[nodiscard]] double diameter(const Set& set) const {
    Box box = faces_[set.front()].box;
    for (const std::uint32_t f : set) {
      box.include(faces_[f].box.low);
      box.include(faces_[f].box.high);
    }
    return kernel::length(difference(box.high, box.low));
  }

  // The distance of the plane of `a` from the corner of `b` that is furthest from it.
  [[nodiscard]] double deviation(std::uint32_t a, std::uint32_t b) const {
    double most = 0.0;
    for (const Vec3& p : faces_[b].corners) {
      most = std::max(most, std::abs(dot(faces_[a].normal, difference(p, faces_[a].corners.front()))));
    }
    return most;
  }

  void split(const Set& set, double share, int splits_left) {
    for (const Set& part : connected_parts(set, splits_left > 0 ? share * kFlat * diameter(set) : -1.0)) {
      if (part.size() == 1 || is_flat(part)) {
        Region region;
        for (const std::uint32_t f : part) region.faces.push_back(faces_[f].id);
        std::ranges::sort(region.faces);
        regions_.push_back(std::move(region));
      } else {
        split(part, share / 8.0, splits_left - 1);
      }
    }
  }

  std::vector<Set> connected_parts(const Set& set, double tolerance) {
    ++sets_;
    for (const std::uint32_t f : set) {
      parent_[f] = f;
      set_[f] = sets_;
    }
    for (const std::uint32_t a : set) {
      for (const std::uint32_t b : neighbours_[a]) {
        if (a > b || set_[b] != sets_) continue;
        if (std::min(deviation(a, b), deviation(b, a)) <= tolerance) parent_[root(b)] = root(a);
      }
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_root;
    for (const std::uint32_t f : set) by_root.emplace_back(root(f), f);
    std::ranges::sort(by_root);
    std::vector<Set> parts;
    for (std::size_t i = 0; i < by_root.size(); ++i) {
      if (i == 0 || by_root[i].first != by_root[i - 1].first) parts.emplace_back();
      parts.back().push_back(by_root[i].second);
    }
    return parts;
  }

  std::uint32_t root(std::uint32_t f) {
    while (parent_[f] != f) f = parent_[f] = parent_[parent_[f]];
    return f;
  }

  // Also requires that no face is turned against the others, so that they do not overlap as seen along the normal.
  [[nodiscard]] bool is_flat(const Set& set) const {
    Vec3 sum, mean;
    double corners = 0.0;
    for (const std::uint32_t f : set) {
      const FlatFace& face = faces_[f];
      sum = kernel::sum(sum, face.area);
      for (const Vec3& p : face.corners) mean = kernel::sum(mean, p);
      corners += static_cast<double>(face.corners.size());
    }
    const Vec3 normal = kernel::unit_by_inverse(sum);
    mean = kernel::scaled(mean, 1.0 / corners);
    const double tolerance = kFlat * diameter(set);
    return std::ranges::all_of(set, [&](std::uint32_t f) {
      const auto is_near = [&](const Vec3& p) { return std::abs(dot(normal, difference(p, mean))) <= tolerance; };
      return dot(normal, faces_[f].normal) > 0.0 && std::ranges::all_of(faces_[f].corners, is_near);
    });
  }

  const Scene& scene_;
  std::span<const std::uint32_t> places_;
  std::vector<FlatFace> faces_;
  std::vector<Set> neighbours_;        // by face
  std::vector<std::uint32_t> parent_;  // by face
  std::vector<std::uint32_t> set_;     // by face: the number of the set that is being split
  std::uint32_t sets_ = 0;
  std::vector<Region> regions_;
};

}  // namespace

std::string numbered_name_of(const Scene& scene, FaceId face) { return scene.name_of(selection_of(scene, face)); }

std::vector<Region> lone_regions(const Scene& scene, std::span<const FaceId> faces) {
  std::vector<Region> lone;
  for (const FaceId face : faces) {
    if (scene.face(face).piece_count > 0) lone.push_back({{face}});
  }
  return lone;
}

std::vector<Region> regions(const Scene& scene, std::span<const FaceId> faces) {
  const kernel::StandardArithmetic arithmetic;
  return Finder(scene, faces).find();
}

std::string name_of(const Scene& scene, const Region& region) {
  constexpr std::size_t kMostNamed = 4;
  const std::vector<FaceId>& faces = region.faces;
  const PatchId patch = scene.face(faces.front()).patch;
  if (faces.size() > 1 && faces.size() == scene.faces_of({patch, {}, scene.id()}).size())
    return scene.patch(patch).name;
  const std::span<const FaceId> all(faces);
  return all.size() <= kMostNamed ? scene.name_of(all) : scene.name_of(all.first(kMostNamed - 1)) + "+...";
}

std::vector<Region> regions(const Scene& scene, const Selection& selection) {
  const std::vector<FaceId> faces = scene.faces_of(selection);
  if (selection.face) return faces.empty() ? std::vector<Region>() : std::vector<Region>{{faces}};
  return regions(scene, faces);
}

}  // namespace exactff
