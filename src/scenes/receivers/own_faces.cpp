// The names of a receiver's own faces.
#include <algorithm>
#include <boost/container/small_vector.hpp>

#include "exactff/error.h"
#include "exactff/receiver.h"
#include "receivers/own_pieces.h"
#include "scene/contacts.h"
#include "scene/scene_data.h"
#include "text/numbered_name.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff {

namespace {

FaceId one_face(const Scene& scene, const std::string& name) {
  const Selection selection = scene.select(name);
  if (selection.face) return *selection.face;
  const std::size_t faces = scene.patch(selection.patch).faces.size();
  if (faces == 1) return scene.patch(selection.patch).faces.front();
  throw InputError({.what = text::in_quotes(name, text::kShownName) + " has " + std::to_string(faces) + " faces",
                    .why = "a patch may be bent, so the name does not say where the receiver lies",
                    .suggestion = "write " + text::in_quotes(name + ":k", text::kShownName) + " for its k-th face"});
}

}  // namespace

std::optional<FaceId> buried_under(const Scene& scene, const Receiver& receiver) {
  if (receiver.on.empty() || contacts(scene).empty()) return std::nullopt;
  std::optional<FaceId> under;
  for (const FaceId id : receiver.on) {
    const Face& face = scene.face(id);
    if (face.piece_count == 0) continue;
    boost::container::small_vector<std::uint32_t, 16> pieces;  // in the plane that the receiver lies in
    for (std::uint32_t p = face.first_piece; p < face.first_piece + face.piece_count; ++p) pieces.push_back(p);
    if (face.shape != FaceShape::kPlanar) pieces = {own_piece(scene, id, receiver.point)};
    const Burial burial = burial_of(scene, {pieces.data(), pieces.size()}, receiver.point, receiver.normal);
    if (burial.is_exposed) return std::nullopt;
    if (!under) under = burial.under;
  }
  return under;
}

bool some_is_buried(const Scene& scene) { return !contacts(scene).empty(); }

std::vector<FaceId> own_faces_named(const Scene& scene, std::string_view name) {
  const std::size_t plus = name.find('+', std::min(name.rfind(':'), name.size()));
  const auto first = text::numbered_name(name.substr(0, plus));
  if (plus == std::string_view::npos || !first || SceneInside::data(scene).patch_by_name.contains(std::string(name))) {
    return {one_face(scene, std::string(name))};
  }
  std::vector<FaceId> faces = {one_face(scene, first->patch + ':' + std::to_string(first->number))};
  for (std::size_t at = plus; at < name.size();) {
    const std::size_t next = std::min(name.find('+', at + 1), name.size());
    const FaceId face = one_face(scene, first->patch + ':' + std::string(name.substr(at + 1, next - at - 1)));
    if (std::ranges::find(faces, face) == faces.end()) faces.push_back(face);
    at = next;
  }
  return faces;
}

}  // namespace exactff
