#include "welding/sheets.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "scene/solids.h"

namespace exactff {
namespace {

double distance_from_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const Vec3 along = kernel::difference(b, a), to = kernel::difference(x, a);
  const double share = std::clamp(kernel::dot(along, to) / kernel::dot(along, along), 0.0, 1.0);
  return kernel::distance(to, kernel::scaled(along, share));
}

// Whether x lies off the piece's plane, but not by more than `length`, and its foot in the piece, farther than this
// from the outline of the face. The distance, in doubles.
std::optional<double> distance_before(const Scene& scene, const Piece& piece, const Vec3& x, double length) {
  const std::span<const std::uint32_t> corners = scene.corners(piece);
  const auto at = [&](std::size_t i) -> const Vec3& { return scene.vertices()[corners[i % corners.size()]]; };
  const auto [a, b, c] = piece.frame;
  const Vec3 &p = scene.vertices()[a], &q = scene.vertices()[b], &r = scene.vertices()[c];
  const Face& face = scene.face(piece.face);
  const Vec3 normal = kernel::unit(face.shape == FaceShape::kPlanar
                                       ? face.newell
                                       : kernel::cross(kernel::difference(q, p), kernel::difference(r, p)));
  const double apart = std::abs(kernel::dot(normal, kernel::difference(x, p)));
  if (!(apart <= length)) return std::nullopt;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 along = kernel::unit(kernel::difference(at(i + 1), at(i)));
    if (!(kernel::dot(kernel::cross(normal, along), kernel::difference(x, at(i))) >= -length)) return std::nullopt;
  }
  for (const auto& ring : face.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec3 &from = scene.vertices()[ring[i]], &to = scene.vertices()[ring[(i + 1) % ring.size()]];
      if (!(distance_from_segment(x, from, to) > length)) return std::nullopt;
    }
  }
  return kernel::orientation(p, q, r, x) == 0 ? std::nullopt : std::optional(apart);
}

}  // namespace

void SheetFinder::compare(const std::vector<std::vector<Id>>& before, const std::vector<std::vector<Id>>& now) {
  std::map<std::vector<Id>, std::vector<std::size_t>> faces;
  for (std::size_t f = 0; f < now.size(); ++f) {
    std::vector<std::size_t>& same = faces[now[f]];
    for (const std::size_t other : same) {
      if (before[f] != before[other]) add(other, f, 0.0);
    }
    same.push_back(f);
  }
}

void SheetFinder::look_around() {
  const std::span<const std::uint32_t> place = places(scene_);
  for (std::size_t f = 0; f < scene_.faces().size(); ++f) {
    for (const auto& ring : scene_.faces()[f].rings) {
      for (const std::uint32_t v : ring) look_around(f, scene_.vertices()[place[v]]);
    }
  }
}

std::vector<WeldedScene::Sheets> SheetFinder::take() const {
  std::vector<WeldedScene::Sheets> all;
  for (const auto& [patches, sheets] : found_) all.push_back(sheets);
  const auto name = [&](const Selection& one) { return scene_.name_of(one); };
  std::ranges::sort(all, {}, [&](const auto& one) { return std::tuple(-one.apart, name(one.one), name(one.other)); });
  return all;
}

void SheetFinder::look_around(std::size_t face, const Vec3& x) {
  const Box box = around(x, x, length_);
  shaft_tree(scene_).visit_where([&](const Box& node, std::size_t) { return meet(node, box); },
                                 [&](std::uint32_t piece, std::size_t) {
                                   const std::size_t other = index_of(scene_.pieces()[piece].face);
                                   if (other == face) return;
                                   const auto apart = distance_before(scene_, scene_.pieces()[piece], x, length_);
                                   if (apart) add(face, other, *apart);
                                 });
}

void SheetFinder::add(std::size_t face, std::size_t other, double apart) {
  const auto of = [&](std::size_t f) { return selection_of(scene_, static_cast<FaceId>(f)); };
  const auto [low, high] = std::minmax(face, other);
  const auto patches = std::minmax({of(low).patch, of(high).patch});
  const auto [known, is_new] = found_.try_emplace(patches, WeldedScene::Sheets{of(low), of(high), apart});
  if (!is_new && apart > known->second.apart) known->second = {of(low), of(high), apart};
}

}  // namespace exactff
