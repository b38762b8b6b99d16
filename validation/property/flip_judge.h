// What `info` says to turn round, and what fronts lose.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "exactff/slips.h"
#include "exactff/view.h"

namespace exactff::validation {

// By each finding with a --flip. Requires names without commas.
inline std::vector<std::vector<Selection>> advised_flips(const Scene& scene) {
  const std::string flag = "--flip ";
  std::vector<std::vector<Selection>> result;
  for (const slips::Finding& finding : slips::diagnose(scene)) {
    if (!finding.flag.starts_with(flag)) continue;
    std::vector<Selection>& flips = result.emplace_back();
    std::string names = finding.flag.substr(flag.size()) + ',';
    for (std::size_t end = 0; (end = names.find(',')) != std::string::npos; names.erase(0, end + 1)) {
      const std::string name = names.substr(0, end);
      for (const Patch& patch : scene.patches()) {
        if (name == "all") flips.push_back(scene.select(patch.name));
      }
      if (name != "all") flips.push_back(scene.select(name));
    }
  }
  return result;
}

// Points of the faces of one scene, for all scenes that differ in fronts alone. Points where faces lie on each other
// are left out: both are hidden there, whichever way they look.
class LostViews {
 public:
  explicit LostViews(const Scene& scene) {
    for (std::size_t f = 0; f < scene.faces().size(); ++f) {
      const Face& face = scene.faces()[f];
      const std::vector<Receiver> points =
          grid_receivers(scene, Selection{face.patch, static_cast<FaceId>(f), scene.id()}, {3, 3});
      for (const Receiver& point : points) {
        if (find_faces(scene, point, 1e-9, Normals::kAny).faces.size() != 1 || is_covered(scene, point)) continue;
        points_.push_back(point);
        areas_.push_back(face.area / static_cast<double>(points.size()));
      }
    }
  }

  [[nodiscard]] double lost(const Scene& scene) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Receiver receiver = points_[i];
      const Vec3& front = scene.face(receiver.on.front()).newell;
      const Vec3& n = receiver.normal;
      if (front.x * n.x + front.y * n.y + front.z * n.z < 0.0) receiver.normal = {-n.x, -n.y, -n.z};
      const WholeView seen = view(scene, receiver);
      sum += areas_[i] * (seen.back.value + seen.open.value);
    }
    return sum;
  }

 private:
  // By a face of another patch.
  static bool is_covered(const Scene& scene, const Receiver& point) {
    const PatchId own = scene.face(point.on.front()).patch;
    return std::ranges::any_of(std::array{1.0, -1.0}, [&](double sign) {
      const Receiver other{point.point, {sign * point.normal.x, sign * point.normal.y, sign * point.normal.z}, {}, ""};
      const std::vector<FaceId> faces = find_faces(scene, other, 1e-9, Normals::kAny).faces;
      return std::ranges::any_of(faces, [&](FaceId face) { return scene.face(face).patch != own; });
    });
  }

  std::vector<Receiver> points_;
  std::vector<double> areas_;
};

}  // namespace exactff::validation
