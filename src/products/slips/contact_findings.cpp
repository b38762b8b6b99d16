// What closed solids bury, and where things touch in a way that buries less than one might think. Pieces in nearly one
// plane are clipped in doubles; whether solids overlap is told by points just inside them and by edges that pierce
// faces.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "kernel/filter.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "scene/closed_surfaces.h"
#include "scene/contacts.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "scene/solids.h"
#include "slips/flip_trial.h"
#include "slips/sight_lines.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::slips {

using kernel::cross;
using kernel::difference;
using kernel::dot;

namespace {

using PatchPair = std::pair<PatchId, PatchId>;

PatchPair patches_of(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  return {patch_of(scene, a), patch_of(scene, b)};
}

constexpr double kReach = 1e-6;                         // of the scene's diameter
constexpr double kThick = 1e3;                          // a face is larger than what it misses by this factor
constexpr std::uint64_t kMostSolidAngles = 20'000'000;  // in solid angles: about a second
constexpr std::uint64_t kMostTrials = 2'000'000;        // of pairs of solids, and of an edge and a face

bool meet(const Box& a, const Box& b, double reach) {
  return a.low.x - reach <= b.high.x && b.low.x - reach <= a.high.x && a.low.y - reach <= b.high.y &&
         b.low.y - reach <= a.high.y && a.low.z - reach <= b.high.z && b.low.z - reach <= a.high.z;
}

Box common_of(const Box& a, const Box& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y), std::max(a.low.z, b.low.z)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y), std::min(a.high.z, b.high.z)}};
}

// How a pair of patches touches.
struct Touch {
  double area = 0.0, apart = 0.0;
};

class TouchFinder {
 public:
  explicit TouchFinder(const Scene& scene) : scene_(scene), solids_(scene), sight_(scene) {}

  [[nodiscard]] std::vector<Finding> find() {
    std::vector<Finding> findings;
    if (!sight_.usable()) return findings;
    if (!solids_.all().empty()) look_around_solids();
    const auto add = [&](Finding finding) {
      if (!finding.objects.empty()) findings.push_back(std::move(finding));
    };
    add(of_open_floors());
    add(of_missing_bottoms());
    add(of_near_contacts());
    add(of_overlapping_solids());
    return findings;
  }

 private:
  using Touches = std::map<PatchPair, Touch>;

  [[nodiscard]] Box box(std::uint32_t piece) const { return box_of(scene_, piece); }
  [[nodiscard]] double reach() const { return kReach * sight_.diameter(); }
  [[nodiscard]] const Vec3& vertex(std::uint32_t v) const { return scene_.vertices()[v]; }
  [[nodiscard]] kernel::PlaneThrough plane_of(std::uint32_t piece) const {
    const auto& frame = scene_.pieces()[piece].frame;
    return {vertex(frame[0]), vertex(frame[1]), vertex(frame[2])};
  }
  [[nodiscard]] bool is_in(const kernel::PlaneThrough& plane, std::uint32_t piece) const {
    return std::ranges::all_of(scene_.pieces()[piece].frame,
                               [&](std::uint32_t v) { return plane.side_of(vertex(v)) == 0; });
  }

  template <class Take>
  void for_each_near(const Box& around, double reach, const Take& take) const {
    shaft_tree(scene_).visit_where([&](const Box& node, std::size_t) { return meet(node, around, reach); },
                                   [&](std::uint32_t other, std::size_t) {
                                     if (!scene_.pieces()[other].transparent && meet(box(other), around, reach)) {
                                       take(other);
                                     }
                                   });
  }

  void look_around_solids() {
    for (std::uint32_t s = 0; s < solids_.all().size(); ++s) {
      const Solid& solid = solids_.all()[s];
      if (solid.sign <= 0 || solid.pieces.size() == scene_.pieces().size()) continue;
      for (const std::uint32_t piece : solid.pieces) {
        kernel::poll();
        for_each_near(box(piece), reach(), [&](std::uint32_t other) {
          if (solids_.of_piece(other) != s) compare(piece, other);
        });
      }
    }
  }

  // A piece of a solid, and one that is not of this solid.
  void compare(std::uint32_t piece, std::uint32_t other) {
    if (dot(sight_.normal(piece), sight_.normal(other)) > 0.0) return;
    const bool is_of_none = solids_.of_piece(other) == Solids::kNone;
    const bool is_known = std::ranges::binary_search(contacts(scene_).covers(piece), other);
    if (is_known) return;
    const std::optional<PieceOverlap> common = overlap_of(scene_, sight_, piece, other, reach());
    if (!common) return;
    if (common->apart > 0.0) {
      if (!is_of_none && other < piece && solids_.all()[solids_.of_piece(other)].sign > 0) return;  // once
      if (common->apart * kThick < std::sqrt(common->area)) add(near_, piece, other, *common);
    } else if (is_of_none && contacts(scene_).covers(piece).empty()) {
      add(open_floors_, piece, other, *common);
    }
  }
  void add(Touches& touches, std::uint32_t piece, std::uint32_t other, const PieceOverlap& common) {
    Touch& touch = touches[patches_of(scene_, piece, other)];
    touch.area += common.area;
    touch.apart = std::max(touch.apart, common.apart);
  }

  [[nodiscard]] std::string quoted(PatchId patch) const { return exactff::quoted(scene_, {patch, {}, scene_.id()}); }
  // "WORDS, WORDS and 3 more pairs"; `words(a, b, touch)`. The largest areas first.
  template <class Words>
  [[nodiscard]] Finding finding_of(Kind kind, const Touches& touches, std::string why, std::string suggestion,
                                   const Words& words) const {
    constexpr std::size_t kShown = 4;
    std::vector<std::pair<PatchPair, Touch>> largest(touches.begin(), touches.end());
    std::ranges::stable_sort(largest, std::greater{}, [](const auto& one) { return one.second.area; });
    Finding finding{.kind = kind, .words = {.why = std::move(why), .suggestion = std::move(suggestion)}};
    for (std::size_t i = 0; i < largest.size(); ++i) {
      const PatchPair& pair = largest[i].first;
      const Selection patch{pair.first, {}, scene_.id()};
      if (std::ranges::find(finding.objects, patch) == finding.objects.end()) finding.objects.push_back(patch);
      if (i < kShown) {
        finding.words.what += (i == 0 ? "" : ", ") + words(quoted(pair.first), quoted(pair.second), largest[i].second);
      }
    }
    if (largest.size() > kShown) {
      finding.words.what += " and " + text::counted(largest.size() - kShown, "more pair");
    }
    return finding;
  }

  [[nodiscard]] Finding of_open_floors() const {
    Finding finding =
        finding_of(Kind::kOpenFloor, open_floors_, "a front that lies on it is not buried, and sees what is behind it",
                   "to have it buried, close the room, or give what lies under it a back and sides, all fronts outside",
                   [](const auto& solid, const auto& floor, const Touch& touch) {
                     return solid + " stands on " + floor + " (area " + text::short_number(touch.area) + ")";
                   });
    finding.words.what += ", which belongs to no closed surface";
    return finding;
  }
  [[nodiscard]] Finding of_near_contacts() const {
    return finding_of(Kind::kNearContact, near_,
                      "they almost touch, so nothing is buried there, and their fronts see each other or pass through",
                      "to have it buried, give the two faces corners in exactly one plane",
                      [](const auto& solid, const auto& other, const Touch& touch) {
                        return solid + " misses the plane of " + other + " by up to " +
                               text::short_number(touch.apart, 1) + " (area " + text::short_number(touch.area) + ")";
                      });
  }

  Finding of_missing_bottoms() {
    const ClosedSurfaces surfaces(scene_, ClosedSurfaces::Edges::kCutAtJunctions);
    Touches touches;
    std::set<std::uint32_t> known;
    for (std::uint32_t piece = 0; !surfaces.empty() && piece < scene_.pieces().size(); ++piece) {
      const std::uint32_t of = surfaces.of_piece(piece);
      if (of == ClosedSurfaces::kNone || !known.insert(of).second) continue;
      const ClosedSurface& surface = surfaces.surfaces()[of];
      if (surface.rim && !surface.turned_inside_out) find_floors(surface, patch_of(scene_, piece), touches);
    }
    return finding_of(
        Kind::kNoBottom, touches,
        "what is under it is not buried: it counts in the area of the floor, and sees the backs of the block",
        "to have it buried, give the block a bottom whose front looks down",
        [](const auto& block, const auto& floor, const Touch&) {
          return block + " stands on " + floor + " without a bottom";
        });
  }

  // The faces that the surface stands on: they hold points just inside the hole.
  void find_floors(const ClosedSurface& surface, PatchId patch, Touches& touches) const {
    const auto& [a, b, c] = surface.rim->plane;
    const Vec3 up = kernel::unit(cross(difference(b, a), difference(c, a)));
    const kernel::PlaneThrough plane(a, b, c);
    for (const auto& [from, to] : surface.rim->edges) {
      const Vec3 edge = difference(vertex(to), vertex(from)), inward = cross(up, edge);
      const Vec3 point = kernel::along(kernel::along(vertex(from), edge, 0.5), inward, 1e-3);
      for_each_near({point, point}, reach(), [&](std::uint32_t piece) {
        if (!is_in(plane, piece) || dot(sight_.normal(piece), up) <= 0.0) return;
        const Vec3 before = kernel::along(point, up, 1.0);
        const Vec3 down{-2.0 * up.x, -2.0 * up.y, -2.0 * up.z};
        if (sight_.meets(piece, before, down)) touches[{patch, patch_of(scene_, piece)}].area = 1.0;
      });
    }
  }

  Finding of_overlapping_solids() {
    std::vector<Box> boxes;
    std::vector<std::uint32_t> ids;
    for (std::uint32_t s = 0; s < solids_.all().size(); ++s) {
      if (solids_.all()[s].sign <= 0) continue;
      boxes.push_back(solids_.all()[s].box);
      ids.push_back(s);
    }
    Touches touches;
    const ShaftTree tree(boxes, ids);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::uint32_t a = ids[i];
      tree.visit_where([&](const Box& node, std::size_t) { return meet(node, boxes[i], 0.0); },
                       [&](std::uint32_t b, std::size_t) {
                         if (b <= a || visits_ > kMostTrials || !overlap(a, b)) return;
                         const auto first = [&](std::uint32_t s) { return solids_.all()[s].pieces.front(); };
                         const Box common = common_of(boxes[i], solids_.all()[b].box);
                         touches[patches_of(scene_, first(a), first(b))].area =
                             kernel::distance(common.low, common.high);
                       });
    }
    return finding_of(
        Kind::kOverlappingSolids, touches,
        "closed solids share a part of space, and the faces inside it are not buried, but see the backs of the other "
        "solid",
        "move them apart, or cut off what lies inside", [](const auto& one, const auto& other, const Touch&) {
          return one == other ? "two solids of " + one + " overlap" : one + " and " + other + " overlap";
        });
  }

  [[nodiscard]] bool overlap(std::uint32_t a, std::uint32_t b) {
    ++visits_;
    const Box common = common_of(solids_.all()[a].box, solids_.all()[b].box);
    const Vec3 size = difference(common.high, common.low);
    if (!(std::min({size.x, size.y, size.z}) > reach())) return false;
    return has_points_inside(a, b, common) || has_points_inside(b, a, common) || is_pierced(a, b, common) ||
           is_pierced(b, a, common);
  }

  // Points just behind some faces of the first solid.
  [[nodiscard]] bool has_points_inside(std::uint32_t a, std::uint32_t b, const Box& common) {
    constexpr std::size_t kPieces = 16;
    std::vector<std::uint32_t> pieces;
    for (const std::uint32_t piece : solids_.all()[a].pieces) {
      if (meet(box(piece), common, 0.0)) pieces.push_back(piece);
    }
    for (const std::uint32_t piece : spread(pieces, kPieces)) {
      const Box own = box(piece);
      const double depth = -std::max(4.0 * reach(), 1e-4 * kernel::distance(own.low, own.high));
      for (const Vec3& on : sight_.points_of(piece)) {
        const Vec3 point = kernel::along(on, sight_.normal(piece), depth);
        if (holds(common, {point, point}) && is_inside(b, point) && is_inside(a, point)) {
          return !is_in_a_hollow(a, b, point);
        }
      }
    }
    return false;
  }

  // Whether an edge of the first one pierces a face of the other.
  [[nodiscard]] bool is_pierced(std::uint32_t a, std::uint32_t b, const Box& common) {
    for (const std::uint32_t piece : solids_.all()[a].pieces) {
      if (!meet(box(piece), common, 0.0)) continue;
      const auto corners = scene_.corners(scene_.pieces()[piece]);
      for (std::size_t i = 0; i < corners.size() && visits_ < kMostTrials; ++i) {
        const Vec3 &from = vertex(corners[i]), &to = vertex(corners[(i + 1) % corners.size()]);
        Box edge{from, from};
        edge.include(to);
        bool found = false;
        for_each_near(edge, 0.0, [&](std::uint32_t other) {
          ++visits_;
          found = found || (solids_.of_piece(other) == b && pierces(from, to, other));
        });
        if (found) return true;
      }
    }
    return false;
  }

  // By more than what counts as touching.
  [[nodiscard]] bool pierces(const Vec3& from, const Vec3& to, std::uint32_t piece) const {
    const auto corners = scene_.corners(scene_.pieces()[piece]);
    const Vec3& normal = sight_.normal(piece);
    const double before = dot(normal, difference(from, vertex(corners[0])));
    const double after = dot(normal, difference(to, vertex(corners[0])));
    if (std::min(std::abs(before), std::abs(after)) < 4.0 * reach() || (before > 0.0) == (after > 0.0)) return false;
    const Vec3 at = kernel::along(from, difference(to, from), before / (before - after));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3 &p = vertex(corners[i]), &q = vertex(corners[(i + 1) % corners.size()]);
      const Vec3 inward = kernel::unit(cross(normal, difference(q, p)));
      if (dot(inward, difference(at, p)) < 4.0 * reach()) return false;
    }
    return true;
  }

  [[nodiscard]] bool is_inside(std::uint32_t solid, const Vec3& point) {
    const Solid& of = solids_.all()[solid];
    return triangles_ <= kMostSolidAngles && holds(of.box, {point, point}) &&
           is_within(scene_, of.pieces, point, triangles_);
  }

  // Of one of them, with the other one in it.
  [[nodiscard]] bool is_in_a_hollow(std::uint32_t a, std::uint32_t b, const Vec3& point) {
    for (std::uint32_t s = 0; s < solids_.all().size(); ++s) {
      const Solid& hollow = solids_.all()[s];
      if (hollow.sign >= 0 || !is_inside(s, point)) continue;
      for (const auto& [outer, inner] : {std::pair(a, b), {b, a}}) {
        if (holds(solids_.all()[outer].box, hollow.box) && holds(hollow.box, solids_.all()[inner].box)) return true;
      }
    }
    return false;
  }

  const Scene& scene_;
  const Solids solids_;
  const SightLines sight_;
  Touches open_floors_, near_;
  std::uint64_t triangles_ = 0, visits_ = 0;
};

}  // namespace

std::vector<Contact> buried_parts(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  const auto& all = contacts(scene).all();
  if (all.empty()) return {};
  const SightLines sight(scene);
  if (!sight.usable()) return {};
  std::map<PatchPair, double> areas;
  for (const auto& [piece, covers] : all) {
    std::map<PatchPair, double> of_piece;
    for (const std::uint32_t cover : covers) {
      const std::optional<PieceOverlap> common = overlap_of(scene, sight, piece, cover);
      if (common) of_piece[patches_of(scene, piece, cover)] += common->area;
    }
    const double most = piece_area(scene, sight, piece);
    for (const auto& [pair, area] : of_piece) areas[pair] += std::min(area, most);
  }
  std::vector<Contact> result;
  for (const auto& [pair, area] : areas) {
    const Selection patch{pair.first, {}, scene.id()};
    const double whole = area_of(scene, patch);
    result.push_back({patch, {pair.second, {}, scene.id()}, std::min(area, whole), std::min(1.0, area / whole)});
  }
  std::ranges::stable_sort(result, std::greater{}, &Contact::area);
  return result;
}

std::vector<Finding> contact_findings(const Scene& scene) { return TouchFinder(scene).find(); }

}  // namespace exactff::slips
