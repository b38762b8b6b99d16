// Faces with the same corners.
#include <algorithm>
#include <set>

#include "scene/panels.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "slips/findings.h"
#include "text/hashes.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::slips {

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
    Ring all;
    for (const Ring& ring : face.rings) {
      for (const std::uint32_t v : ring) all.push_back(places_[v]);
    }
    std::ranges::sort(all);
    text::Fnv1a hash;
    for (const std::uint32_t place : all) hash.add(std::uint64_t{place});
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
