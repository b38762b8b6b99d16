// Sources that give 0 at every receiver. The proof for a receiver is an exact form factor of 0 without occluders, or
// with those faces alone as occluders that come within the tolerance of the receiver: more of them never raise it.
#include <algorithm>
#include <cmath>
#include <set>

#include "exactff/exact.h"
#include "exactff/slips.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "receivers/own_pieces.h"
#include "scene/closed_surfaces.h"
#include "scene/selections.h"
#include "slips/flip_trial.h"
#include "slips/sight_lines.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::slips {
namespace {

using kernel::difference;
using kernel::dot;

constexpr std::size_t kMostReceivers = 10'000;

// Of the receivers that were looked at.
struct Counts {
  std::size_t on_it = 0;  // they lie on the source
  std::size_t behind = 0;
  std::size_t below = 0;   // the source lies below their horizon
  std::size_t hidden = 0;  // by a face on which they lie
  std::size_t first_hidden = 0;
  FaceId hiding{};  // at that receiver
};

class DarkSource {
 public:
  DarkSource(const Scene& scene, std::span<const Receiver> receivers)
      : scene_(scene), receivers_(receivers), step_((receivers.size() + kMostReceivers - 1) / kMostReceivers) {}

  [[nodiscard]] std::size_t looked_at() const { return (receivers_.size() + step_ - 1) / step_; }

  // Nothing if the source reaches a receiver, or if other faces hide it.
  std::optional<Counts> counts(const ExactSource& source) {
    Counts counts;
    for (std::size_t i = 0; i < receivers_.size(); i += step_) {
      if (!is_dark(i, source, counts)) return std::nullopt;
    }
    return counts;
  }

 private:
  bool is_dark(std::size_t i, const ExactSource& source, Counts& counts) {
    const Receiver& receiver = receivers_[i];
    static const std::vector<FaceId> kNone;
    exact_form_factor(scene_, receiver, source, {.only_occluders = &kNone}, result_);
    if (result_.status == Status::kZero) {
      const auto all = [&](Outcome outcome) {
        return std::ranges::all_of(result_.planes, [&](const PlaneRecord& plane) { return plane.outcome == outcome; });
      };
      const auto any = [&](Outcome outcome) {
        return std::ranges::any_of(result_.planes, [&](const PlaneRecord& plane) { return plane.outcome == outcome; });
      };
      ++(all(Outcome::kReceiverFace) ? counts.on_it : any(Outcome::kBelowHorizon) ? counts.below : counts.behind);
      return true;
    }
    const std::vector<FaceId> near = faces_near(receiver);
    for (const FaceId face : near) {
      const std::vector<FaceId> only{face};
      exact_form_factor(scene_, receiver, source, {.only_occluders = &only}, result_);
      if (result_.status != Status::kZero) continue;
      if (counts.hidden++ == 0) {
        counts.first_hidden = i;
        counts.hiding = face;
      }
      return true;
    }
    return false;
  }

  [[nodiscard]] std::vector<FaceId> faces_near(const Receiver& receiver) const {
    constexpr std::size_t kMost = 8;
    std::set<FaceId> near;
    const OwnPieces own(scene_, receiver);
    const Vec3& x = receiver.point;
    const double tolerance = face_tolerance(scene_, x);
    visit_pieces_near(scene_, {x, x}, tolerance, [&](std::uint32_t piece) {
      const FaceId face = scene_.pieces()[piece].face;
      if (!own.contains(piece) && is_near_plane(scene_.face(face), x, tolerance)) near.insert(face);
      return near.size() < kMost;
    });
    return {near.begin(), near.end()};
  }

  [[nodiscard]] bool is_near_plane(const Face& face, const Vec3& x, double tolerance) const {
    const Vec3 away = kernel::difference(x, scene_.vertices()[face.rings.front().front()]);
    const double length = std::hypot(face.newell.x, face.newell.y, face.newell.z);
    return std::abs(kernel::dot(face.newell, away)) <= tolerance * length;
  }

  const Scene& scene_;
  const std::span<const Receiver> receivers_;
  const std::size_t step_;
  FormFactor result_;
};

// The patches on which receivers lie.
std::vector<Selection> receiver_patches(const Scene& scene, std::span<const Receiver> receivers) {
  std::set<PatchId> patches;
  for (const Receiver& receiver : receivers) {
    if (!receiver.on.empty()) patches.insert(scene.face(receiver.on.front()).patch);
  }
  std::vector<Selection> selections;
  for (const PatchId patch : patches) selections.push_back({patch, {}, scene.id()});
  return selections;
}

std::string advice_to_turn(const Scene& scene, const std::string& names, std::span<const Selection> selections) {
  const std::string advice = advice_to_flip(scene, selections);
  return advice.empty() ? "choose other receivers or another source"
                        : "if the other side of " + names + " is meant, " + advice;
}

std::string advice_to_turn(const Scene& scene, std::span<const Receiver> receivers) {
  const std::vector<Selection> patches = receiver_patches(scene, receivers);
  if (patches.empty()) return "if the other side is meant, turn the normals of the receivers round";
  return advice_to_turn(scene, listed(scene, patches), patches);
}

Problem problem(const Scene& scene, std::span<const Receiver> receivers, std::size_t looked_at, const Selection& source,
                const Counts& counts) {
  const std::string name = listed(scene, std::span(&source, 1));
  std::vector<std::string> reasons, laws, advice;
  const auto add = [&](std::size_t count, const char* one, const char* many, const std::string& rest,
                       const std::string& law, const std::string& what_to_do) {
    if (count == 0) return;
    const std::string who = count < looked_at ? std::to_string(count) : count == 1 ? "it" : "they";
    reasons.push_back(who + ' ' + (count == 1 ? one : many) + ' ' + rest);
    if (!law.empty()) laws.push_back(law);
    if (std::ranges::find(advice, what_to_do) == advice.end()) advice.push_back(what_to_do);
  };
  add(counts.on_it, "lies", "lie", "on the source", "", "choose other receivers or another source");
  add(counts.behind, "is", "are", "behind the source", "a source emits only from its front",
      advice_to_turn(scene, name, std::span(&source, 1)));
  add(counts.below, "looks", "look", "away from the source", "a receiver sees only what lies before it",
      advice_to_turn(scene, receivers));
  if (counts.hidden > 0) {
    const std::string& id = receivers[counts.first_hidden].id;
    add(counts.hidden, "lies", "lie",
        "just behind a face that hides the source, such as " +
            text::in_quotes(scene.name_of(counts.hiding), text::kShownName) + " at receiver " +
            text::in_quotes(id.empty() ? std::to_string(counts.first_hidden + 1) : id),
        "", "let --on auto find the face of each receiver");
  }
  const std::string at =
      looked_at < receivers.size()
          ? "each of " + std::to_string(looked_at) + " receivers looked at, of " + std::to_string(receivers.size())
      : receivers.size() == 1 ? "the only receiver"
                              : "all " + text::counted(receivers.size(), "receiver");
  return {.what = "source " + name + " gives 0 at " + at + ": " + text::joined(reasons),
          .why = text::joined(laws, "; "),
          .suggestion = text::joined(advice, "; ")};
}

}  // namespace

std::vector<Problem> warnings_of_dark_sources(const Scene& scene, std::span<const Receiver> receivers,
                                              std::span<const Selection> sources) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Problem> warnings;
  if (receivers.empty()) return warnings;
  const std::vector<Selection> emitters = scene.emitters();
  if (sources.empty()) sources = emitters;
  DarkSource finder(scene, receivers);
  const std::vector<Selection> own = receiver_patches(scene, receivers);
  const auto is_own = [&](const Selection& source) { return own.size() == 1 && own.front().patch == source.patch; };
  for (const Selection& source : sources) {
    if (sources.size() > 1 && is_own(source)) continue;
    const std::optional<Counts> counts = finder.counts(ExactSource(scene, source));
    if (counts) warnings.push_back(problem(scene, receivers, finder.looked_at(), source, *counts));
  }
  return warnings;
}

// --- Unseen fronts ---

// Patches whose front no other patch can see, and emitters that look away from everything.
//
// For each patch, until one other patch is found that sees its front:
//   1. rays from a few of its points into the half-space before them;
//   2. lines from its points to points of the faces before it, which finds small things that the rays miss.
// The first face on a ray or line sees the patch if it shows its front. A patch that looks at the backs of others only
// is reported unless one of these is itself a patch before which nothing lies: then that one is the likely slip.

namespace {

constexpr std::uint64_t kMostRays = 100'000;  // in the scene, lines included

// What lies before the front of a patch.
struct Front {
  bool seen = false;                 // by the front of another patch
  bool complete = true;              // false if the rays of the scene ran out
  std::set<std::size_t> backs = {};  // patches that show only their backs
};

class FrontFinder {
 public:
  explicit FrontFinder(const Scene& scene) : scene_(scene), sight_(scene), pieces_(pieces_by_patch(scene)) {
    for (std::uint32_t p = 0; p < scene.pieces().size(); ++p) all_.push_back(p);
    all_ = spread(all_, kLinesTo);
  }

  [[nodiscard]] bool usable() const { return sight_.usable(); }
  [[nodiscard]] bool has_area(std::size_t patch) const { return !pieces_[patch].empty(); }

  Front look(std::size_t patch) {
    Front front;
    cast_rays(patch, front);
    if (!front.seen && front.complete) draw_lines(patch, front);
    return front;
  }

 private:
  [[nodiscard]] std::size_t patch_of(std::uint32_t piece) const { return index_of(slips::patch_of(scene_, piece)); }

  // Returns false once nothing more needs to be known.
  bool note(std::size_t patch, const Hit& hit, Front& front) {
    const std::size_t other = patch_of(hit.piece);
    if (other == patch) return true;
    if (!hit.front) front.backs.insert(other);
    front.seen = hit.front;
    return !front.seen;
  }

  bool may_cast(Front& front) {
    if (rays_++ >= kMostRays) front.complete = false;
    return front.complete;
  }

  void cast_rays(std::size_t patch, Front& front) {
    for (const std::uint32_t piece : spread(pieces_[patch], kOrigins)) {
      const Vec3 from = sight_.points_of(piece).front();
      for (int i = 0; i < kRaysOfAnOrigin; ++i) {
        if (!may_cast(front)) return;
        const std::optional<Hit> hit = sight_.first_hit(from, ray_before(sight_.normal(piece), i), HUGE_VAL);
        if (hit && !note(patch, *hit, front)) return;
      }
    }
  }

  // Between centres first, then between all points.
  void draw_lines(std::size_t patch, Front& front) {
    const std::uint64_t last = rays_ + kMostLines;
    for (const std::size_t points : {std::size_t{1}, std::size_t{64}}) {
      for (const std::uint32_t from : spread(pieces_[patch], kLinesFrom)) {
        for (const std::uint32_t to : all_) {
          if (rays_ >= last) return;
          if (patch_of(to) != patch && !draw_lines(patch, from, to, points, front)) return;
        }
      }
    }
  }

  // Returns false once nothing more needs to be known.
  bool draw_lines(std::size_t patch, std::uint32_t from, std::uint32_t to, std::size_t points, Front& front) {
    const std::vector<Vec3> starts = sight_.points_of(from), ends = sight_.points_of(to);
    if (!reaches_before(starts.front(), sight_.normal(from), to)) return true;
    for (std::size_t s = 0; s < std::min(points, starts.size()); ++s) {
      for (std::size_t e = 0; e < std::min(points, ends.size()); ++e) {
        if (!draw_line(patch, starts[s], ends[e], from, to, front)) return false;
      }
    }
    return true;
  }

  [[nodiscard]] bool reaches_before(const Vec3& origin, const Vec3& normal, std::uint32_t piece) const {
    const auto corners = scene_.corners(scene_.pieces()[piece]);
    return std::ranges::any_of(corners, [&](std::uint32_t corner) {
      return dot(normal, difference(scene_.vertices()[corner], origin)) > 1e-9 * sight_.diameter();
    });
  }

  // Returns false once nothing more needs to be known.
  bool draw_line(std::size_t patch, const Vec3& start, const Vec3& end, std::uint32_t from, std::uint32_t to,
                 Front& front) {
    const Vec3 way = difference(end, start);
    if (!(dot(sight_.normal(from), way) > 1e-9 * sight_.diameter())) return true;
    if (!may_cast(front)) return false;
    const std::optional<Hit> hit = sight_.first_hit(start, way, 1.0 + 1e-9);
    if (hit) return note(patch, *hit, front);
    const double across = dot(sight_.normal(to), way);  // seen edge-on, the end itself may be missed
    return across == 0.0 || note(patch, {to, 1.0, across < 0.0}, front);
  }

  const Scene& scene_;
  const SightLines sight_;
  std::vector<std::vector<std::uint32_t>> pieces_;  // by patch
  std::vector<std::uint32_t> all_;                  // ends of lines
  std::uint64_t rays_ = 0;
};

struct Unseen {
  std::vector<Selection> patches, emitters;
  std::size_t looked_at = 0;
  std::size_t to_look_at = 0;
};

// By patch: all its faces belong to closed surfaces, and these look the right way or are reported on their own.
std::vector<bool> closed_patches(const Scene& scene) {
  std::vector<bool> closed(scene.patches().size(), true);
  const ClosedSurfaces& surfaces = closed_surfaces(scene);
  for (std::uint32_t p = 0; p < scene.pieces().size(); ++p) {
    const bool open = surfaces.empty() || surfaces.of_piece(p) == ClosedSurfaces::kNone;
    if (open) closed[index_of(patch_of(scene, p))] = false;
  }
  return closed;
}

Unseen find_unseen(const Scene& scene) {
  Unseen unseen;
  FrontFinder finder(scene);
  if (!finder.usable()) return unseen;
  const std::size_t count = scene.patches().size();
  std::vector<bool> emits(count, false), lonely(count, false);
  for (const Selection& emitter : scene.emitters()) emits[index_of(emitter.patch)] = true;
  const std::vector<bool> closed = closed_patches(scene);
  std::vector<std::size_t> order;  // emitters first
  for (const bool emitting : {true, false}) {
    for (std::size_t p = 0; p < count; ++p) {
      if (finder.has_area(p) && emits[p] == emitting && (emitting || !closed[p])) order.push_back(p);
    }
  }
  unseen.to_look_at = order.size();
  std::vector<Front> fronts;
  for (const std::size_t p : order) {
    Front front = finder.look(p);
    if (!front.complete) break;
    lonely[p] = !front.seen && front.backs.empty();
    fronts.push_back(std::move(front));
  }
  unseen.looked_at = fronts.size();
  for (std::size_t i = 0; i < fronts.size(); ++i) {
    const Selection patch{static_cast<PatchId>(order[i]), {}, scene.id()};
    const bool emitter = emits[order[i]];
    const auto to_blame = [&](std::size_t other) { return lonely[other]; };
    if (lonely[order[i]]) {
      (emitter ? unseen.emitters : unseen.patches).push_back(patch);
    } else if (!emitter && !fronts[i].seen && std::ranges::none_of(fronts[i].backs, to_blame)) {
      unseen.patches.push_back(patch);
    }
  }
  const auto by_patch = [](const Selection& selection) { return selection.patch; };
  std::ranges::sort(unseen.patches, {}, by_patch);
  return unseen;
}

// `useful`: those of the objects that a flip brings into sight.
std::string suggestion(const Scene& scene, std::span<const Selection> objects, std::span<const Selection> useful) {
  if (useful.empty()) {
    return std::string("turning ") + (objects.size() == 1 ? "it" : "them") + " round does not help; check the place";
  }
  const std::string whose = useful.size() == objects.size() ? "" : " of " + listed(scene, useful);
  return "if the other side" + whose + " is meant, " + words_to_flip(scene, useful);
}

}  // namespace

std::vector<Finding> unseen_fronts(const Scene& scene, FlipTrials& trials) {
  std::vector<Finding> findings;
  if (scene.patches().size() < 2) return findings;
  const Unseen unseen = find_unseen(scene);
  const std::string limit = unseen.looked_at == unseen.to_look_at
                                ? std::string()
                                : ", among the first " + std::to_string(unseen.looked_at) + " of " +
                                      text::counted(unseen.to_look_at, "patch", "patches");
  const auto add = [&](Kind kind, const std::vector<Selection>& objects, std::string what, std::string why) {
    if (objects.empty()) return;
    const std::vector<Selection> useful = trials.useful_flips(objects);
    findings.push_back(
        {.kind = kind,
         .objects = objects,
         .flag = flag_to_flip(scene, useful),
         .words = {.what = std::move(what), .why = std::move(why), .suggestion = suggestion(scene, objects, useful)}});
  };
  add(Kind::kUnseenFront, unseen.patches,
      "no other patch sees the front of " + listed(scene, unseen.patches) + ", as far as rays can tell" + limit,
      "receivers there see nothing, and it lights nothing");
  add(Kind::kEmitterLooksAway, unseen.emitters,
      (unseen.emitters.size() == 1 ? "emitter " : "emitters ") + listed(scene, unseen.emitters) +
          (unseen.emitters.size() == 1 ? " looks" : " look") + " away from everything",
      "a source emits only from its front, so its form factor is 0 everywhere");
  return findings;
}

}  // namespace exactff::slips
