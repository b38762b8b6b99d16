// The raster is a grid on the same face, several times finer. Every cell is classified exactly. Where two adjacent
// cells differ, an edge runs between their centres; it is assumed to be half-way. The distance of a receiver is that to
// the nearest such place.
#include "study/shadow_edges.h"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cmath>

#include "files/parallel.h"
#include "kernel/vec.h"
#include "study/sight.h"

namespace exactff::study {
namespace {

namespace bgi = boost::geometry::index;
using Point = boost::geometry::model::point<double, 3, boost::geometry::cs::cartesian>;
using kernel::distance;
using Tree = bgi::rtree<Point, bgi::rstar<16>>;

constexpr int kRasterCells = 16384;
constexpr int kRasterCellsOfLargeScenes = 4096;
constexpr std::size_t kLargeScene = 300;  // faces

class Raster {
 public:
  Raster(const Request& request, const Lattice& grid) : request_(request) {
    const bool large = request.scene->faces().size() > kLargeScene;
    const int cells = grid.size.u * grid.size.v;
    const int finer = static_cast<int>(std::sqrt((large ? kRasterCellsOfLargeScenes : kRasterCells) / cells));
    size_ = {grid.size.u * std::max(finer, 1), grid.size.v * std::max(finer, 1)};
    receivers_ = grid_receivers(*request.scene, std::span(&grid.region, 1), size_);
  }

  // On surfaces that are not quadrilaterals, some cells are missing.
  [[nodiscard]] bool complete() const {
    return receivers_.size() == static_cast<std::size_t>(size_.u) * static_cast<std::size_t>(size_.v);
  }

  void classify(std::span<const ExactSource> sources, const Hooks& hooks) {
    sights_.resize(receivers_.size());
    files::parallel_for(receivers_.size(), request_.threads, "shadow edges", hooks,
                        [&](std::size_t i) { sights_[i] = sights(*request_.scene, receivers_[i], sources); });
  }

  [[nodiscard]] std::vector<Point> edges() const {
    std::vector<Point> found;
    for (int v = 0; v < size_.v; ++v) {
      for (int u = 0; u < size_.u; ++u) {
        if (u + 1 < size_.u) add_edge(found, index(u, v), index(u + 1, v));
        if (v + 1 < size_.v) add_edge(found, index(u, v), index(u, v + 1));
      }
    }
    return found;
  }

  [[nodiscard]] double spacing() const {
    double largest = 0.0;
    if (size_.u > 1) largest = std::max(largest, distance(receivers_[0].point, receivers_[1].point));
    if (size_.v > 1) largest = std::max(largest, distance(receivers_[0].point, receivers_[index(0, 1)].point));
    return largest;
  }

 private:
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(size_.u) + static_cast<std::size_t>(u);
  }

  void add_edge(std::vector<Point>& found, std::size_t a, std::size_t b) const {
    if (sights_[a] == sights_[b]) return;
    const Vec3 p = receivers_[a].point, q = receivers_[b].point;
    found.emplace_back(0.5 * (p.x + q.x), 0.5 * (p.y + q.y), 0.5 * (p.z + q.z));
  }

  const Request& request_;
  GridSize size_;
  std::vector<Receiver> receivers_;
  std::vector<std::vector<Sight>> sights_;
};

double nearest_distance(const Tree& tree, const Vec3& p) {
  const Point from(p.x, p.y, p.z);
  double best = 0.0;
  for (auto found = tree.qbegin(bgi::nearest(from, 1)); found != tree.qend(); ++found) {
    best = boost::geometry::distance(from, *found);
  }
  return best;
}

}  // namespace

const Lattice* lattice_of(const std::vector<Receiver>& receivers) {
  if (receivers.empty() || !receivers.front().cell) return nullptr;
  const Lattice* const lattice = receivers.front().cell->lattice.get();
  const auto on_it = [&](const Receiver& r) { return r.cell && r.cell->lattice.get() == lattice; };
  return std::ranges::all_of(receivers, on_it) ? lattice : nullptr;
}

std::vector<Sight> sights(const Scene& scene, const Receiver& receiver, std::span<const ExactSource> sources) {
  std::vector<Sight> result;
  for (const ExactSource& source : sources) result.push_back(sight_of(exact_form_factor(scene, receiver, source)));
  return result;
}

std::variant<ShadowEdges, LeftOut> find_shadow_edges(const Request& request, std::span<const ExactSource> sources,
                                                     const Hooks& hooks) {
  const auto leave_out = [](const char* why) { return LeftOut{"error by distance to the nearest shadow edge", why}; };
  const Lattice* const lattice = lattice_of(request.receivers);
  if (lattice == nullptr) return leave_out("the receivers are not one grid on one face");
  Raster raster(request, *lattice);
  if (!raster.complete()) return leave_out("the face is no quadrilateral");
  raster.classify(sources, hooks);
  const std::vector<Point> edges = raster.edges();
  if (edges.empty()) return leave_out("what is visible is of one kind all over the face");
  const Tree tree(edges);
  ShadowEdges found{{}, raster.spacing()};
  for (const Receiver& receiver : request.receivers) found.distance.push_back(nearest_distance(tree, receiver.point));
  return found;
}

}  // namespace exactff::study
