// Patches from geometry: the pieces of a group that are connected, in one plane, smoothly, or at all.
#include "scene/geometry_patches.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "kernel/ball.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/groups.h"
#include "scene/panels.h"
#include "scene/scene.h"
#include "scene/scene_copy.h"
#include "text/number_text.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff {

int compare_angle(double degrees, const kernel::ExactVec3& n, const kernel::ExactVec3& m) {
  const kernel::Integer product = dot(n, m);
  const int sign = sgn(product), of_cosine = degrees < 90.0 ? 1 : degrees > 90.0 ? -1 : 0;
  if (sign != of_cosine || sign == 0) return sign - of_cosine;
  return sign * kernel::compare_with_squared_cosine(product * product, dot(n, n) * dot(m, m), degrees);
}

kernel::ExactVec3 exact_normal(const Scene& scene, const Piece& piece) {
  const auto at = [&](int k) -> const Vec3& { return scene.vertices()[piece.frame[k]]; };
  return cross(kernel::exact_difference(at(1), at(0)).v, kernel::exact_difference(at(2), at(0)).v);
}

namespace {

struct PieceEdge {
  std::uint32_t low = 0, high = 0, piece = 0;  // places

  [[nodiscard]] auto ends() const { return std::pair(low, high); }
};

class PatchMaker {
 public:
  PatchMaker(const Scene& scene, const SceneOptions& options)
      : scene_(scene), mode_(options.patches), groups_(scene.pieces().size()), degrees_(options.smooth_degrees) {
    if (mode_ == PatchMode::kSmooth) {
      for (const Piece& piece : scene.pieces()) normals_.push_back(exact_normal(scene, piece));
    }
    join();
  }

  [[nodiscard]] Scene make() {
    std::vector<std::string> names;
    std::vector<std::size_t> patch_of_face(scene_.faces().size(), 0);
    for (const Patch& patch : scene_.patches()) {
      const std::vector<Component> all = components_of(patch);
      const std::size_t first = names.size();
      for (std::size_t k = 0; k < all.size(); ++k) {
        names.push_back(patch.name + '/' + std::to_string(k + 1));
        for (const FaceId face : all[k].faces) patch_of_face[index_of(face)] = first + k;
      }
      if (all.empty()) names.push_back(patch.name);
      for (const FaceId face : patch.faces) {
        if (scene_.face(face).piece_count == 0) patch_of_face[index_of(face)] = first;
      }
    }
    return regrouped(scene_, names, patch_of_face);
  }

 private:
  using Place = std::tuple<double, double, double>;

  struct Component {
    std::vector<FaceId> faces;
    float area = 0.0F;
    std::vector<Place> corners;  // ascending
  };

  void join() {
    const std::span<const std::uint32_t> place = places(scene_);
    std::vector<PieceEdge> edges;
    for (std::uint32_t p = 0; p < scene_.pieces().size(); ++p) {
      const Piece& piece = scene_.pieces()[p];
      groups_.join(p, scene_.face(piece.face).first_piece);
      const std::span<const std::uint32_t> corners = scene_.corners(piece);
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto [low, high] = std::minmax(place[corners[i]], place[corners[(i + 1) % corners.size()]]);
        edges.push_back({low, high, p});
      }
    }
    std::ranges::sort(edges, {}, &PieceEdge::ends);
    for (auto first = edges.begin(); first != edges.end();) {
      const auto last = std::find_if(first, edges.end(), [&](const PieceEdge& e) { return e.ends() != first->ends(); });
      for (auto one = first; one != last; ++one) {
        for (auto other = std::next(one); other != last; ++other) join(one->piece, other->piece);
      }
      first = last;
    }
  }
  void join(std::uint32_t p, std::uint32_t q) {
    if (face(p).patch == face(q).patch && groups_.root(p) != groups_.root(q) && belong_together(p, q))
      groups_.join(p, q);
  }
  [[nodiscard]] bool belong_together(std::uint32_t p, std::uint32_t q) const {
    if (mode_ == PatchMode::kParts) return true;
    if (mode_ == PatchMode::kSmooth) return compare_angle(degrees_, normals_[p], normals_[q]) > 0;
    return face(p).shape == FaceShape::kPlanar && face(q).shape == FaceShape::kPlanar &&
           planes(scene_).of_piece(p) == planes(scene_).of_piece(q) &&
           kernel::dot(kernel::unit(face(p).newell), kernel::unit(face(q).newell)) > 0.0;
  }
  [[nodiscard]] const Face& face(std::uint32_t piece) const { return scene_.face(scene_.pieces()[piece].face); }

  [[nodiscard]] std::vector<Component> components_of(const Patch& patch) {
    std::vector<std::pair<std::uint32_t, FaceId>> faces;  // by component
    for (const FaceId id : patch.faces) {
      if (scene_.face(id).piece_count > 0) faces.emplace_back(groups_.root(scene_.face(id).first_piece), id);
    }
    std::ranges::sort(faces);
    std::vector<Component> all;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (f == 0 || faces[f].first != faces[f - 1].first) all.emplace_back();
      all.back().faces.push_back(faces[f].second);
    }
    for (Component& one : all) measure(one);
    std::ranges::stable_sort(all, [](const Component& a, const Component& b) {
      return a.area != b.area ? a.area > b.area : a.corners < b.corners;
    });
    return all;
  }
  // Areas are added in an order that does not depend on the file.
  void measure(Component& one) const {
    std::vector<double> areas;
    for (const FaceId id : one.faces) {
      areas.push_back(scene_.face(id).area);
      for (const auto& ring : scene_.face(id).rings) {
        for (const std::uint32_t v : ring) {
          const Vec3& x = scene_.vertices()[v];
          one.corners.emplace_back(x.x, x.y, x.z);
        }
      }
    }
    std::ranges::sort(areas);
    double sum = 0.0;
    for (const double area : areas) sum += area;
    one.area = static_cast<float>(sum);
    std::ranges::sort(one.corners);
    one.corners.erase(std::unique(one.corners.begin(), one.corners.end()), one.corners.end());
  }

  const Scene& scene_;
  PatchMode mode_;
  Groups groups_;
  double degrees_;
  std::vector<kernel::ExactVec3> normals_;
};

[[noreturn]] void refuse_patches(std::string_view text) {
  text::refuse("--patches " + text::in_quotes(text) + " is not a way to make patches",
               "they are groups, faces, planes, smooth, smooth:DEGREES (from 0 to 180) or parts", "choose one of them");
}

}  // namespace

SceneOptions scene_options(std::string_view patches, BadFaces bad_faces) {
  const kernel::StandardArithmetic arithmetic;
  SceneOptions options{.bad_faces = bad_faces};
  constexpr std::string_view kSmooth = "smooth:";
  if (patches.starts_with(kSmooth)) {
    const text::ParsedNumber degrees = text::parse_number(patches.substr(kSmooth.size()));
    if (degrees.fault != text::NumberFault::kNone || !(degrees.value >= 0.0 && degrees.value <= 180.0)) {
      refuse_patches(patches);
    }
    options.smooth_degrees = degrees.value;
    patches = "smooth";
  }
  constexpr std::pair<std::string_view, PatchMode> kModes[] = {{"groups", PatchMode::kGroups},
                                                               {"faces", PatchMode::kFaces},
                                                               {"planes", PatchMode::kPlanes},
                                                               {"smooth", PatchMode::kSmooth},
                                                               {"parts", PatchMode::kParts}};
  const auto* const found = std::ranges::find(kModes, patches, &std::pair<std::string_view, PatchMode>::first);
  if (found == std::end(kModes)) refuse_patches(patches);
  options.patches = found->second;
  return options;
}

Scene with_patches(const Scene& scene, const SceneOptions& patches) {
  const kernel::StandardArithmetic arithmetic;
  if (patches.patches > PatchMode::kFaces) return PatchMaker(scene, patches).make();
  std::vector<std::string> names;
  std::vector<std::size_t> patch_of_face;
  if (patches.patches == PatchMode::kGroups) {
    for (const Patch& patch : scene.patches()) names.push_back(patch.name);
  }
  for (const Face& face : scene.faces()) {
    if (patches.patches == PatchMode::kFaces) {
      patch_of_face.push_back(names.size());
      names.push_back(scene.patch(face.patch).name + ':' + std::to_string(face.number));
    } else {
      patch_of_face.push_back(index_of(face.patch));
    }
  }
  return regrouped(scene, names, patch_of_face);
}

}  // namespace exactff
