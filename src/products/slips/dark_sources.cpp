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
#include "scene/selections.h"
#include "slips/findings.h"
#include "slips/sight_lines.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::slips {

namespace {

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

class Wording {
 public:
  Wording(const Scene& scene, std::span<const Receiver> receivers, std::size_t looked_at)
      : scene_(scene), receivers_(receivers), looked_at_(looked_at) {}

  [[nodiscard]] Problem problem(const Selection& source, const Counts& counts) const {
    const std::string name = listed(scene_, std::span(&source, 1));
    std::vector<std::string> reasons, laws, advice;
    const auto add = [&](std::size_t count, const char* one, const char* many, const std::string& rest,
                         const std::string& law, const std::string& what_to_do) {
      if (count == 0) return;
      const std::string who = count < looked_at_ ? std::to_string(count) : count == 1 ? "it" : "they";
      reasons.push_back(who + ' ' + (count == 1 ? one : many) + ' ' + rest);
      if (!law.empty()) laws.push_back(law);
      if (std::ranges::find(advice, what_to_do) == advice.end()) advice.push_back(what_to_do);
    };
    add(counts.on_it, "lies", "lie", "on the source", "", "choose other receivers or another source");
    add(counts.behind, "is", "are", "behind the source", "a source emits only from its front",
        advice_to_turn(name, std::span(&source, 1)));
    add(counts.below, "looks", "look", "away from the source", "a receiver sees only what lies before it",
        advice_to_turn_receivers());
    add(counts.hidden, "lies", "lie", "just behind a face that hides the source, such as " + hiding_face(counts), "",
        "let --on auto find the face of each receiver");
    return {.what = "source " + name + " gives 0 at " + at_whom() + ": " + text::joined(reasons),
            .why = text::joined(laws, "; "),
            .suggestion = text::joined(advice, "; ")};
  }

 private:
  [[nodiscard]] std::string at_whom() const {
    if (looked_at_ < receivers_.size())
      return "each of " + std::to_string(looked_at_) + " receivers looked at, of " + std::to_string(receivers_.size());
    return receivers_.size() == 1 ? "the only receiver" : "all " + text::counted(receivers_.size(), "receiver");
  }

  [[nodiscard]] std::string advice_to_turn_receivers() const {
    const std::vector<Selection> patches = receiver_patches(scene_, receivers_);
    if (patches.empty()) return "if the other side is meant, turn the normals of the receivers round";
    return advice_to_turn(listed(scene_, patches), patches);
  }

  [[nodiscard]] std::string advice_to_turn(const std::string& names, std::span<const Selection> selections) const {
    const std::string advice = advice_to_flip(scene_, selections);
    return advice.empty() ? "choose other receivers or another source"
                          : "if the other side of " + names + " is meant, " + advice;
  }

  [[nodiscard]] std::string hiding_face(const Counts& counts) const {
    if (counts.hidden == 0) return {};
    const std::string& id = receivers_[counts.first_hidden].id;
    return text::in_quotes(scene_.name_of(counts.hiding), text::kShownName) + " at receiver " +
           text::in_quotes(id.empty() ? std::to_string(counts.first_hidden + 1) : id);
  }

  const Scene& scene_;
  const std::span<const Receiver> receivers_;
  const std::size_t looked_at_;
};

}  // namespace

std::vector<Problem> warnings_of_dark_sources(const Scene& scene, std::span<const Receiver> receivers,
                                              std::span<const Selection> sources) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Problem> warnings;
  if (receivers.empty()) return warnings;
  const std::vector<Selection> emitters = scene.emitters();
  if (sources.empty()) sources = emitters;
  DarkSource finder(scene, receivers);
  const Wording wording(scene, receivers, finder.looked_at());
  const std::vector<Selection> own = receiver_patches(scene, receivers);
  const auto is_own = [&](const Selection& source) { return own.size() == 1 && own.front().patch == source.patch; };
  for (const Selection& source : sources) {
    if (sources.size() > 1 && is_own(source)) continue;
    const std::optional<Counts> counts = finder.counts(ExactSource(scene, source));
    if (counts) warnings.push_back(wording.problem(source, *counts));
  }
  return warnings;
}

}  // namespace exactff::slips
