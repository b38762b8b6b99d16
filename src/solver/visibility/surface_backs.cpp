#include "visibility/surface_backs.h"

#include <algorithm>

namespace exactff::visibility {

void SurfaceBacks::start() {
  const std::size_t count = surfaces_.surfaces().size();
  memory_.decided.clear(count);
  memory_.left_out.resize(count);
  if (count == 0) return;
  memory_.has_own_piece.clear(count);
  const View& view = query_.view;
  for (const PlaneId plane : view.own.planes()) {
    const auto own = view.own.pieces_in(plane);
    if (facing_of(view, view.scene.pieces()[own.front()]) == 0) continue;  // x sees them edge-on
    for (const std::uint32_t piece : own) {
      const std::uint32_t surface = surfaces_.of_piece(piece);
      if (surface != ClosedSurfaces::kNone) memory_.has_own_piece.set(surface);
    }
  }
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
  return !memory_.has_own_piece.is_set(surface);
}

}  // namespace exactff::visibility
