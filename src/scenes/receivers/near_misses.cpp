// Receivers that were probably meant to lie on a face.
#include <algorithm>
#include <iterator>

#include "exactff/receiver.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "kernel/vec.h"
#include "receivers/placing.h"
#include "scene/selections.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff {
namespace {

constexpr std::size_t kMostTold = 3;

std::string name_of_receiver(std::span<const Receiver> receivers, std::size_t i) {
  return "'" + (receivers[i].id.empty() ? std::to_string(i + 1) : receivers[i].id) + "'";
}

bool looks_away_from(const Face& face, const Vec3& normal) {
  const double largest = kernel::max_norm(normal), size = kernel::max_norm(face.newell);
  if (!(largest > 0.0) || !(size > 0.0)) return false;
  const auto share = [](const Vec3& v, double by) { return Vec3{v.x / by, v.y / by, v.z / by}; };
  return kernel::dot(share(normal, largest), share(face.newell, size)) < 0.0;
}

}  // namespace

std::vector<std::size_t> place_on_faces(const Scene& scene, std::span<Receiver> receivers,
                                        std::optional<double> tolerance) {
  std::vector<std::size_t> without;
  kernel::Steps steps("faces of receivers", receivers.size());
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    steps.take();
    Receiver& receiver = receivers[i];
    if (!receiver.on.empty()) continue;
    receiver.on = find_faces(scene, receiver, tolerance.value_or(face_tolerance(scene, receiver.point))).faces;
    if (receiver.on.empty()) without.push_back(i);
  }
  return without;
}

NearMisses near_misses(const Scene& scene, std::span<const Receiver> receivers) {
  const kernel::StandardArithmetic arithmetic;
  NearMisses misses;
  std::vector<std::string> worst, others;  // the former see nothing
  const auto tell = [&](std::size_t i, const std::string& what, std::vector<std::string>& list) {
    if (list.size() < kMostTold) list.push_back(name_of_receiver(receivers, i) + ", " + what);
  };
  HidingFaces hiding(scene);
  std::vector<FaceId> hiding_faces;
  kernel::Steps steps("faces of receivers", receivers.size());
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    steps.take();
    const Receiver& receiver = receivers[i];
    if (!receiver.on.empty()) {
      if (const std::vector<FaceId> before = hiding.of(receiver); !before.empty()) {
        ++misses.hidden;
        hiding_faces.insert(hiding_faces.end(), before.begin(), before.end());
        const bool own = std::ranges::find(receiver.on, before.front()) != receiver.on.end();
        tell(i,
             "on '" + scene.name_of(receiver.on) + "', behind " +
                 (own ? "another triangle of it" : "'" + scene.name_of(before.front()) + "'"),
             worst);
      }
      if (!looks_away_from(scene.face(receiver.on.front()), receiver.normal)) continue;
      ++misses.turned;
      tell(i, "turned against '" + scene.name_of(receiver.on) + "'", others);
      continue;
    }
    const NearFaces near = find_faces(scene, receiver, face_tolerance(scene, receiver.point));
    if (near.faces.empty() || near.side == 0) continue;
    // What counts is the side that the receiver looks away from.
    const bool behind = (near.side < 0) != near.turned;
    ++(behind ? misses.behind : misses.in_front);
    misses.furthest = std::max(misses.furthest, near.distance);
    tell(i,
         text::short_number(near.distance, 2) + (near.side < 0 ? " behind '" : " in front of '") +
             scene.name_of(near.faces.front()) + "'",
         behind ? worst : others);
  }
  misses.mends_hidden = flag_words(scene, "--transparent", selections_of(scene, std::move(hiding_faces)));
  misses.first = std::move(worst);
  std::ranges::move(others, std::back_inserter(misses.first));
  if (misses.first.size() > kMostTold) misses.first.resize(kMostTold);
  return misses;
}

std::vector<std::string> sentences(const NearMisses& misses, std::size_t receivers, std::string_view noun) {
  std::vector<std::string> told;
  const std::string of_all = " of " + text::counted(receivers, noun);
  if (misses.behind + misses.in_front > 0) {
    std::string sentence = std::to_string(misses.behind + misses.in_front) + of_all +
                           " are given without a face, within " + text::short_number(misses.furthest, 2) + " of one";
    if (misses.behind > 0) {
      sentence += "; " + std::to_string(misses.behind) + " of them look through it from behind, so it hides everything";
    }
    told.push_back(sentence + "; --on auto places them on their faces");
  }
  if (misses.hidden > 0) {
    told.push_back(std::to_string(misses.hidden) + of_all +
                   " lie on a face, but behind another one that is nearly in its plane and hides everything; " +
                   (misses.mends_hidden.empty() ? "--transparent NAME,NAME,..." : misses.mends_hidden) +
                   " lets light pass through it");
  }
  if (misses.turned > 0) {
    told.push_back(std::to_string(misses.turned) + of_all +
                   " look away from the front of the face that they lie on; --flip turns a patch round");
  }
  if (told.empty()) return told;
  std::string examples = "the first: ";
  for (std::size_t i = 0; i < misses.first.size(); ++i) examples += (i > 0 ? "; " : "") + misses.first[i];
  told.push_back(std::move(examples));
  return told;
}

}  // namespace exactff
