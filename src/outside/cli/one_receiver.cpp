#include "cli/one_receiver.h"

#include <algorithm>
#include <iostream>
#include <span>

#include "cli/output.h"
#include "exactff/render.h"
#include "exactff/slips.h"
#include "flags/receivers.h"
#include "kernel/vec.h"
#include "text/escape.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::cli {

namespace {

std::vector<FaceId> own_faces(const std::string& on, const Scene& scene, const Receiver& receiver) {
  const auto automatic = flags::auto_face(on, scene);
  if (!automatic) return own_faces_named(scene, on);
  const double tolerance = automatic->tolerance.value_or(face_tolerance(scene, receiver.point));
  std::vector<FaceId> faces = find_faces(scene, receiver, tolerance).faces;
  if (!faces.empty()) return faces;
  throw InputError({.what = "--on " + on + ": no face lies within " + text::short_number(tolerance, 2) +
                            " of x with a normal within a degree of --normal",
                    .why = "the receiver would lie on no face",
                    .suggestion = "check --at and --normal, or look further away with --on auto:DISTANCE"});
}

void warn_of_own_face(const Scene& scene, const Receiver& receiver) {
  const NearMisses misses = near_misses(scene, std::span(&receiver, 1));
  const std::string own = '\'' + text::printable(scene.name_of(receiver.on)) + '\'';
  if (misses.turned > 0) {
    std::cerr << "exactff: warning: the normal points away from the front of " << own
              << ", so the receiver looks through its back\n";
  }
  if (misses.hidden > 0) {
    std::cerr << "exactff: warning: x lies on " << own
              << ", but behind another face that is nearly in its plane and hides everything; "
              << text::printable(misses.mends_hidden) << " lets light pass through it\n";
  }
}

// The first face in the direction of the normal, if the receiver looks at its back, squarely.
void warn_of_face_before(const Scene& scene, const Receiver& receiver, const std::function<bool()>& sees_no_front,
                         const std::function<std::string(const Receiver&)>& effect) {
  constexpr double kCosOfOneDegree = 0.99984;
  const auto hit = render::first_hit(scene, {receiver.point, kernel::unit(receiver.normal)});
  if (!hit || !hit->back) return;
  const Vec3 front = kernel::unit(scene.face(hit->face).newell);
  if (kernel::dot(front, kernel::unit(receiver.normal)) < kCosOfOneDegree || !sees_no_front()) return;
  const std::string change = effect({hit->point, receiver.normal, {hit->face}, ""});
  if (change.empty()) return;
  const std::string name = scene.name_of(hit->face);
  std::cerr << "exactff: warning: x lies " << text::short_number(kernel::distance(hit->point, receiver.point), 2)
            << " behind '" << text::printable(name) << "' and sees nothing but backs. On it, with --at";
  for (const double coordinate : {hit->point.x, hit->point.y, hit->point.z})
    std::cerr << ' ' << text::shortest(coordinate);
  std::cerr << " --on " << text::shell_word(name) << ", " << change << '\n';
}

}  // namespace

void OneReceiver::add_to(CLI::App& app) {
  flags::add_vector_option(app, "--at", at, "The receiver's point")->required();
  CLI::Option* direction =
      flags::add_vector_option(app, "--normal", normal, "The receiver's normal, of any length except zero", "NX NY NZ");
  app.add_flag(
         "--sphere", sphere,
         "Instead of --normal: the receiver is a small sphere, which sees all directions. The form factor is then "
         "the solid angle over 4 pi")
      ->excludes(direction);
  app.add_option("--on", on,
                 "The receiver lies on this face, or on several (floor:1+2); faces exactly in their planes then "
                 "neither occlude nor illuminate it; auto or auto:DISTANCE finds them")
      ->type_name("NAME[:K]");
}

Receiver OneReceiver::make(const Scene& scene) const {
  if (!sphere && !flags::is_given(normal)) {
    text::refuse("--normal is required", "only what lies above the receiver's horizon counts",
                 "add --normal NX NY NZ, or --sphere for a receiver that sees all directions");
  }
  Receiver receiver{flags::vector_of(at, "--at"), sphere ? Vec3{} : flags::vector_of(normal, "--normal"), {}, ""};
  if (sphere && flags::auto_face(on, scene)) {
    text::refuse("--on " + on + " is given with --sphere", "it finds a face whose normal is the receiver's",
                 "name the face");
  }
  if (!on.empty()) receiver.on = own_faces(on, scene, receiver);
  return receiver;
}

void warn_of_turned_surfaces(const Scene& scene) {
  constexpr std::size_t kMostFaces = 1'000;
  if (scene.faces().size() <= kMostFaces) print_warnings(slips::warnings_of_turned_surfaces(scene));
}

bool sees_only_backs(const WholeView& seen) {
  const auto is_nothing = [](const SeenPatch& patch) { return patch.share.status == Status::kZero; };
  return std::ranges::all_of(seen.patches, is_nothing) && seen.back.status != Status::kZero;
}

void warn_if_off_its_face(const Scene& scene, const Receiver& receiver) {
  constexpr double kFar = 0.01;
  if (receiver.on.empty()) return;
  const double distance = relative_distance_from_face(scene, receiver.on.front(), receiver.point);
  if (distance <= kFar) return;
  std::cerr << "exactff: warning: --at is " << percent(distance) << " of the size of face '"
            << shown_name(scene, receiver.on.front())
            << "' away from that face (a receiver on a face is neither occluded nor illuminated by it); check --at and "
               "--on\n";
}

void warn_of_near_face(const Scene& scene, const Receiver& receiver, const std::function<bool()>& sees_no_front,
                       const std::function<std::string(const Receiver&)>& effect) {
  if (receiver.normal == Vec3{}) return;  // a sphere, which sees both sides of everything
  if (!receiver.on.empty()) return warn_of_own_face(scene, receiver);
  const NearFaces near = find_faces(scene, receiver, face_tolerance(scene, receiver.point));
  if (near.faces.empty()) return warn_of_face_before(scene, receiver, sees_no_front, effect);
  if (near.side == 0) return;
  const std::string name = scene.name_of(near.faces);
  const bool looks_through = (near.side < 0) != near.turned;
  Receiver there = receiver;
  there.on = near.faces;
  const std::string change = effect(there);
  std::cerr << "exactff: " << (looks_through ? "warning" : "note") << ": x lies "
            << text::short_number(near.distance, 2) << (near.side < 0 ? " behind '" : " in front of '")
            << text::printable(name) << '\'' << (near.turned ? ", turned against its front" : "")
            << (looks_through ? ", which then hides everything beyond it" : "");
  if (!change.empty()) std::cerr << ". With --on " << text::shell_word(name) << ' ' << change;
  std::cerr << '\n';
}

}  // namespace exactff::cli
