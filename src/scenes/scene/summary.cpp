#include <algorithm>
#include <limits>
#include <set>

#include "exactff/scene.h"
#include "kernel/vec.h"

namespace exactff {
namespace {

std::vector<MaterialId> materials_of(const Scene& scene, const Patch& patch) {
  std::vector<MaterialId> used;
  std::set<MaterialId> seen;
  for (const FaceId face : patch.faces) {
    const MaterialId material = scene.face(face).material;
    if (seen.insert(material).second) used.push_back(material);
  }
  return used;
}

std::optional<Vec3> common_front(const Scene& scene, const std::vector<FaceId>& faces) {
  constexpr double kSameWay = 0.999;  // the cosine of about 2.6 degrees
  Vec3 mean;
  for (const FaceId face : faces) mean = kernel::sum(mean, kernel::unit_by_inverse(scene.face(face).newell));
  mean = kernel::unit_by_inverse(mean);
  for (const FaceId face : faces) {
    const Vec3 n = kernel::unit_by_inverse(scene.face(face).newell);
    if (kernel::dot(n, mean) < kSameWay) return std::nullopt;
  }
  return faces.empty() ? std::nullopt : std::optional(mean);
}

// An estimate. Clamped to finite numbers, as the areas of faces are.
double sum_of_areas(double a, double b) { return std::min(a + b, std::numeric_limits<double>::max()); }

}  // namespace

PatchSummary summarise(const Scene& scene, PatchId id) {
  const Patch& patch = scene.patch(id);
  const std::vector<FaceId> faces = scene.faces_of({id, {}});
  PatchSummary summary{patch.name, patch.faces.size(), 0.0, common_front(scene, faces), materials_of(scene, patch)};
  for (const FaceId face : faces) {
    summary.area = sum_of_areas(summary.area, scene.face(face).area);
    summary.emits = summary.emits || scene.material(scene.face(face).material).emits();
  }
  return summary;
}

std::vector<PatchSummary> summarise(const Scene& scene) {
  std::vector<PatchSummary> rows;
  for (std::size_t i = 0; i < scene.patches().size(); ++i) rows.push_back(summarise(scene, static_cast<PatchId>(i)));
  return rows;
}

double total_area(const std::vector<PatchSummary>& rows) {
  double area = 0.0;
  for (const PatchSummary& row : rows) area = sum_of_areas(area, row.area);
  return area;
}

}  // namespace exactff
