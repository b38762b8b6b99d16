#include <algorithm>
#include <iterator>

#include "exactff/slips.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/selections.h"
#include "slips/sight_lines.h"

namespace exactff::slips {

namespace {

using kernel::difference;
using kernel::dot;

// A piece of `a` and a piece of `b` of which each has points before the front of the other. Occluders do not count, and
// of large patches only some pieces are looked at.
bool face_each_other(const Scene& scene, const SightLines& sight, const Selection& a, const Selection& b) {
  constexpr std::size_t kMostPieces = 8;
  const auto pieces_of = [&](const Selection& selection) {
    std::vector<std::uint32_t> pieces;
    for (const FaceId face : scene.faces_of(selection)) {
      if (pieces.size() < kMostPieces) pieces.push_back(scene.face(face).first_piece);
    }
    return pieces;
  };
  const auto has_before = [&](std::uint32_t piece, std::uint32_t other) {
    const Vec3 origin = sight.points_of(piece).front();
    return std::ranges::any_of(sight.points_of(other), [&](const Vec3& point) {
      return dot(sight.normal(piece), difference(point, origin)) > 1e-9 * sight.diameter();
    });
  };
  const std::vector<std::uint32_t> of_b = pieces_of(b);
  return std::ranges::any_of(pieces_of(a), [&](std::uint32_t p) {
    return std::ranges::any_of(of_b, [&](std::uint32_t q) { return has_before(p, q) && has_before(q, p); });
  });
}

double largest_surface(const Scene& scene, const Selection& selection) {
  double largest = 0.0;
  for (const Region& region : regions(scene, selection)) {
    double area = 0.0;
    for (const FaceId face : region.faces) area += scene.face(face).area;
    largest = std::max(largest, area);
  }
  return largest;
}

// A patch is no source if its faces differ in Ke; then its first face that emits is.
Selection usable_source(const Scene& scene, const Selection& patch) {
  const std::vector<FaceId> faces = scene.faces_of(patch);
  const auto radiosity = [&](FaceId id) { return scene.material(scene.face(id).material).radiosity; };
  if (std::ranges::all_of(faces, [&](FaceId id) { return radiosity(id) == radiosity(faces.front()); })) return patch;
  const auto emits = [&](FaceId id) { return scene.material(scene.face(id).material).emits(); };
  return {patch.patch, *std::ranges::find_if(faces, emits), scene.id()};
}

// The patches with area; of a single one its faces.
std::vector<Selection> candidates_of(const Scene& scene) {
  std::vector<Selection> patches = all_patches(scene);
  if (patches.size() != 1) return patches;
  std::vector<Selection> faces;
  for (const FaceId face : scene.faces_of(patches.front())) faces.push_back({patches.front().patch, face, scene.id()});
  return faces;
}

}  // namespace

std::optional<FirstTry> first_try(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  constexpr std::size_t kMostTried = 16;
  std::vector<Selection> all = candidates_of(scene);
  if (all.size() < 2) return std::nullopt;
  std::vector<Selection> sources;
  std::ranges::copy_if(all, std::back_inserter(sources), [&](const Selection& s) { return emits(scene, s); });
  if (sources.empty()) sources = all;
  std::vector<std::pair<std::pair<bool, double>, Selection>> ranked;  // those that do not emit first, then large ones
  for (const Selection& one : all) ranked.push_back({{emits(scene, one), -largest_surface(scene, one)}, one});
  std::ranges::stable_sort(ranked, {}, [](const auto& entry) { return entry.first; });
  if (ranked.size() > kMostTried) ranked.resize(kMostTried);
  if (sources.size() > kMostTried) sources.resize(kMostTried);
  const SightLines sight(scene);
  std::optional<FirstTry> any;
  for (const auto& [rank, on] : ranked) {
    for (const Selection& source : sources) {
      if (source == on) continue;
      const FirstTry one{on, usable_source(scene, source)};
      if (sight.usable() && face_each_other(scene, sight, on, source)) return one;
      if (!any) any = one;
    }
  }
  return any;
}

}  // namespace exactff::slips
