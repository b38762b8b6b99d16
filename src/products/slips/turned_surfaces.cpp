// Closed surfaces that are turned the wrong way. One whose fronts look inward may be a room or the wall of a hollow in
// a solid; a box that stands among other things is neither. A room that stands beside a few other faces is told from a
// box by what a flip would change.
#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "kernel/vec.h"
#include "scene/closed_surfaces.h"
#include "scene/panels.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "slips/flip_trial.h"
#include "slips/sight_lines.h"
#include "text/hashes.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::slips {
namespace {

constexpr std::size_t kMostPoints = 32;               // to be looked for inside a surface
constexpr std::uint64_t kMostTriangles = 20'000'000;  // in all solid angles: about a second

class TurnedSurfaces {
 public:
  explicit TurnedSurfaces(const Scene& scene)
      : scene_(scene), found_(closed_surfaces(scene)), pieces_(found_.surfaces().size()) {
    if (found_.empty()) return;
    for (std::uint32_t piece = 0; piece < scene.pieces().size(); ++piece) {
      const std::uint32_t surface = found_.of_piece(piece);
      if (surface != ClosedSurfaces::kNone) pieces_[surface].push_back(piece);
    }
  }

  // That look inward and are no room, as far as can be told without trying.
  std::vector<std::uint32_t> boxes() {
    std::vector<std::uint32_t> found;
    for (std::uint32_t s = 0; s < pieces_.size(); ++s) {
      if (!found_.surfaces()[s].turned_inside_out) continue;
      const bool alone = pieces_[s].size() == scene_.pieces().size();
      if (!alone && !encloses_anything(s) && !is_hollow(s) && triangles_ < kMostTriangles) found.push_back(s);
    }
    return found;
  }

  [[nodiscard]] std::vector<Selection> selections(std::span<const std::uint32_t> surfaces) const {
    std::vector<FaceId> faces;
    for (const std::uint32_t s : surfaces) {
      for (const std::uint32_t piece : pieces_[s]) faces.push_back(scene_.pieces()[piece].face);
    }
    return selections_of(scene_, std::move(faces));
  }

  // A flip brings patches into sight of each other, and is no mistake about a room beside a stray face: an emitter, or
  // more area than its own, comes into its sight.
  [[nodiscard]] bool are_better_turned(std::span<const std::uint32_t> boxes, const FlipEffect& effect) const {
    return effect.helps() && (effect.lit_after > effect.lit_before || gains_area(boxes, effect));
  }

 private:
  [[nodiscard]] bool gains_area(std::span<const std::uint32_t> surfaces, const FlipEffect& effect) const {
    std::set<FaceId> own;
    std::set<std::size_t> patches;
    for (const std::uint32_t s : surfaces) {
      for (const std::uint32_t piece : pieces_[s]) own.insert(scene_.pieces()[piece].face);
    }
    for (const auto& [first, second] : effect.gained()) patches.insert({first, second});
    double inside = 0.0, gained = 0.0;
    for (std::size_t f = 0; f < scene_.faces().size(); ++f) {
      const Face& face = scene_.faces()[f];
      if (own.contains(static_cast<FaceId>(f))) {
        inside += face.area;
      } else if (patches.contains(index_of(face.patch))) {
        gained += face.area;
      }
    }
    return gained > inside;
  }

  bool encloses_anything(std::uint32_t surface) {
    const Box& box = found_.surfaces()[surface].box;
    std::vector<Vec3> points;
    visit_pieces_near(scene_, box, 0.0, [&](std::uint32_t piece) {
      if (found_.of_piece(piece) == surface) return true;
      const Vec3 centre = centre_of(piece);
      if (holds(box, {centre, centre})) points.push_back(centre);
      return points.size() < kMostPoints;
    });
    return std::ranges::any_of(points, [&](const Vec3& point) { return is_inside(surface, point); });
  }

  // Inside another closed surface that looks outward.
  bool is_hollow(std::uint32_t surface) {
    const Box& box = found_.surfaces()[surface].box;
    const Vec3 point = centre_of(pieces_[surface].front());
    for (std::uint32_t s = 0; s < pieces_.size(); ++s) {
      const ClosedSurface& other = found_.surfaces()[s];
      if (s != surface && !other.turned_inside_out && holds(other.box, box) && is_inside(s, point)) return true;
    }
    return false;
  }

  bool is_inside(std::uint32_t surface, const Vec3& point) {
    return triangles_ < kMostTriangles && is_within(scene_, pieces_[surface], point, triangles_);
  }

  [[nodiscard]] Vec3 centre_of(std::uint32_t piece) const {
    const auto corners = scene_.corners(scene_.pieces()[piece]);
    const double share = 1.0 / static_cast<double>(corners.size());
    Vec3 centre;
    for (const std::uint32_t corner : corners) {
      centre = kernel::along(centre, scene_.vertices()[corner], share);
    }
    return centre;
  }

  const Scene& scene_;
  const ClosedSurfaces& found_;
  std::vector<std::vector<std::uint32_t>> pieces_;  // by surface
  std::uint64_t triangles_ = 0;
};

// Where boxes touch, such as a table and its leg, a front of one that is turned alone would lie on a front of the
// other: those are tried together.
std::vector<std::uint32_t> boxes_to_turn(TurnedSurfaces& surfaces, FlipTrials& trials) {
  std::vector<std::uint32_t> better, together;
  for (const std::uint32_t box : surfaces.boxes()) {
    const std::span<const std::uint32_t> one(&box, 1);
    const FlipEffect effect = trials.try_flip(surfaces.selections(one));
    const bool alone = surfaces.are_better_turned(one, effect);
    if (alone) better.push_back(box);
    if (alone || effect.stacks) together.push_back(box);
  }
  if (together.size() < 2) return better;
  const FlipEffect effect = trials.try_flip(surfaces.selections(together));
  if (surfaces.are_better_turned(together, effect)) return together;
  return better.size() < 2 || trials.try_flip(surfaces.selections(better)).helps() ? better
                                                                                   : std::vector<std::uint32_t>();
}

Finding finding_of(const Scene& scene, const TurnedSurfaces& surfaces, const std::vector<std::uint32_t>& boxes) {
  Finding finding{.kind = Kind::kInwardSurface, .objects = surfaces.selections(boxes)};
  finding.flag = flag_to_flip(scene, finding.objects);
  finding.words = {.what = text::counted(boxes.size(), "closed surface") +
                           (boxes.size() == 1 ? " looks inward and encloses" : " look inward and enclose") +
                           " no other face: " + listed(scene, finding.objects),
                   .why = "its outer side is its back, which emits nothing and receives nothing",
                   .suggestion = words_to_flip(scene, finding.objects)};
  return finding;
}

// All faces of `some`, and others. In a room of which walls look out, too, boxes are to be turned together with these.
bool holds_more(const Scene& scene, std::span<const Selection> all, std::span<const Selection> some) {
  const std::set<FaceId> more = faces_of(scene, all), fewer = faces_of(scene, some);
  return more.size() > fewer.size() && std::ranges::includes(more, fewer);
}

}  // namespace

std::vector<Finding> turned_surfaces(const Scene& scene, FlipTrials& trials) {
  TurnedSurfaces surfaces(scene);
  std::vector<Finding> findings;
  const std::vector<std::uint32_t> boxes = boxes_to_turn(surfaces, trials);
  std::optional<Finding> rooms = outward_rooms(scene, {});
  if (!boxes.empty()) {
    Finding finding = finding_of(scene, surfaces, boxes);
    if (!rooms || !holds_more(scene, rooms->objects, finding.objects)) {
      rooms = outward_rooms(scene, finding.objects);
      findings.push_back(std::move(finding));
    }
  }
  if (rooms) findings.push_back(std::move(*rooms));
  return findings;
}

// --- Faces with the same corners ---

namespace {

using Ring = std::vector<std::uint32_t>;

// From the lowest place on. A place that a ring visits twice may leave equal rings different: one pair less is
// reported.
Ring begin_at_lowest(Ring ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  return ring;
}

// The twin that comes later in the scene, and the one that comes first.
struct Twins {
  FaceId later{};
  FaceId first{};
};

class TwinFinder {
 public:
  explicit TwinFinder(const Scene& scene) : scene_(scene), places_(places(scene)) {
    for (std::size_t i = 0; i < scene.faces().size(); ++i) {
      const Face& face = scene.faces()[i];
      if (face.piece_count > 0 && !face.transparent) hashes_.emplace_back(hash_of(face), static_cast<FaceId>(i));
    }
    std::ranges::sort(hashes_);
    for (auto first = hashes_.begin(); first != hashes_.end();) {
      const auto last = std::find_if(first, hashes_.end(), [&](const auto& h) { return h.first != first->first; });
      if (last - first > 1) compare({first, last});
      first = last;
    }
    const auto by_face = [](const Twins& twins) { return twins.later; };
    std::ranges::sort(doubled, {}, by_face);
    std::ranges::sort(opposite, {}, by_face);
  }

  std::vector<Twins> doubled, opposite;

 private:
  [[nodiscard]] std::uint64_t hash_of(const Face& face) const {
    text::Fnv1a hash;
    for (const std::uint32_t place : sorted_places(scene_, face)) hash.add(std::uint64_t{place});
    return hash.value();
  }

  [[nodiscard]] std::vector<Ring> rings_of(FaceId id, bool reversed) const {
    std::vector<Ring> rings;
    for (const Ring& ring : scene_.face(id).rings) {
      Ring at_places;
      for (const std::uint32_t v : ring) at_places.push_back(places_[v]);
      if (reversed) std::ranges::reverse(at_places);
      rings.push_back(begin_at_lowest(std::move(at_places)));
    }
    return rings;
  }

  // Each face is compared with the first of its kind only, so that the time is linear even if all faces are the same.
  void compare(std::span<const std::pair<std::uint64_t, FaceId>> group) {
    std::vector<std::pair<FaceId, std::vector<Ring>>> kinds;
    for (const auto& [hash, face] : group) {
      const std::vector<Ring> same = rings_of(face, false), other = rings_of(face, true);
      const auto is_same = [&](const auto& kind) { return kind.second == same; };
      const auto is_other = [&](const auto& kind) { return kind.second == other; };
      const auto twin = std::ranges::find_if(kinds, is_same), back = std::ranges::find_if(kinds, is_other);
      if (twin != kinds.end()) {
        doubled.push_back({face, twin->first});
      } else {
        // Two sides of a sheet, unless they are cut into other triangles.
        if (back != kinds.end() && !lie_in_the_same_planes(face, back->first)) opposite.push_back({face, back->first});
        if (kinds.size() < kMostKinds) kinds.emplace_back(face, same);
      }
    }
  }
  static constexpr std::size_t kMostKinds = 16;

  [[nodiscard]] bool lie_in_the_same_planes(FaceId a, FaceId b) const {
    const auto planes_of = [&](FaceId id) {
      std::set<PlaneId> found;
      const Face& face = scene_.face(id);
      for (std::uint32_t k = 0; k < face.piece_count; ++k) found.insert(planes(scene_).of_piece(face.first_piece + k));
      return found;
    };
    return planes_of(a) == planes_of(b);
  }

  const Scene& scene_;
  const std::span<const std::uint32_t> places_;
  std::vector<std::pair<std::uint64_t, FaceId>> hashes_;
};

Finding finding_of(const Scene& scene, Kind kind, const std::vector<Twins>& twins) {
  std::vector<FaceId> later;
  for (const Twins& pair : twins) later.push_back(pair.later);
  Finding finding{.kind = kind, .objects = selections_of(scene, later)};
  finding.flag = flag_words(scene, "--transparent", finding.objects);
  const bool same = kind == Kind::kDoubledFaces;
  const auto quoted = [&](FaceId id) { return text::in_quotes(scene.name_of(id), text::kShownName); };
  finding.words.what = text::counted(twins.size(), "face") + (twins.size() == 1 ? " has" : " have") +
                       " the corners of another face and " + (same ? "the same front" : "the opposite front") +
                       ", such as " + quoted(twins.front().later) + " and " + quoted(twins.front().first);
  finding.words.why = same ? "as sources of two patches both count"
                           : "they are cut into other triangles, so a receiver on one of them may lie behind the "
                             "other, which then hides "
                             "everything";
  const std::string flag = finding.flag.empty() ? "--transparent NAME,NAME,..." : finding.flag;
  finding.words.suggestion =
      same
          ? "remove one of them, or let light pass through it with " + flag
          : "if they are the two sides of a lamp or a sheet, keep both, and for receivers on it let light pass through "
            "one with " +
                flag + "; otherwise remove one";
  return finding;
}

}  // namespace

std::vector<Finding> twin_faces(const Scene& scene) {
  const TwinFinder found(scene);
  std::vector<Finding> findings;
  if (!found.doubled.empty()) findings.push_back(finding_of(scene, Kind::kDoubledFaces, found.doubled));
  if (!found.opposite.empty()) findings.push_back(finding_of(scene, Kind::kOppositeFaces, found.opposite));
  return findings;
}

}  // namespace exactff::slips
