#include "visibility/surface_backs.h"

#include <algorithm>

namespace exactff::visibility {

void SurfaceBacks::start() {
  memory_.decided.clear(surfaces_.surfaces().size());
  memory_.left_out.resize(surfaces_.surfaces().size());
}

bool SurfaceBacks::backs_left_out(std::uint32_t surface) {
  if (!memory_.decided.is_set(surface)) {
    memory_.decided.set(surface);
    memory_.left_out[surface] = may_leave_out_backs(surface) ? 1 : 0;
  }
  return memory_.left_out[surface] != 0;
}

bool SurfaceBacks::may_leave_out_backs(std::uint32_t surface) const {
  const View& view = query_.view;
  if (!query_.request.culls() || query_.request.only_occluders != nullptr) return false;
  const auto& [low, high] = surfaces_.surfaces()[surface].box;
  const Vec3& x = view.x;
  const bool outside = x.x < low.x || x.y < low.y || x.z < low.z || x.x > high.x || x.y > high.y || x.z > high.z;
  if (!outside || !ShaftTree::certainly_inside({low, high}, x, shaft_.front())) return false;
  return std::ranges::none_of(view.on, [&](FaceId own) { return has_piece_in(view.scene.face(own), surface); });
}

bool SurfaceBacks::has_piece_in(const Face& face, std::uint32_t surface) const {
  for (std::uint32_t piece = face.first_piece; piece < face.first_piece + face.piece_count; ++piece) {
    if (surfaces_.of_piece(piece) == surface) return true;
  }
  return false;
}

}  // namespace exactff::visibility
