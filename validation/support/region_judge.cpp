#include "support/region_judge.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exactff/render.h"
#include "exactff/view.h"
#include "kernel/numbers.h"
#include "scene/contacts.h"
#include "support/oracle.h"
#include "support/picture_areas.h"

namespace exactff::validation {

namespace {

// Coordinates are rounded to 2^-53 and to 1e-5 / 320 of the radius, and so flat are the arcs that are drawn as lines. A
// side is at most a quarter of the rim; the fisheye is up to twice as large as Nusselt's projection.
double blur(const PictureArea& area, bool fisheye) {
  return 1e-12 + (fisheye ? 2.0 : 1.0) * 6e-8 * static_cast<double>(area.sides);
}

void expect_areas_of_shares(const Scene& scene, const Receiver& receiver, ViewProjection projection) {
  const bool fisheye = projection == ViewProjection::kFisheye;
  const PictureAreas areas = picture_areas(view_svg(scene, receiver, {.projection = projection}), fisheye);
  const WholeView seen = view(scene, receiver);
  std::size_t fronts = 0;
  const auto area_of = [&](const char* kind, const std::string& name) {
    const auto at = areas.find({kind, name});
    return at == areas.end() ? PictureArea{} : at->second;
  };
  for (const SeenPatch& patch : seen.patches) {
    const std::string& name = scene.patch(patch.patch).name;
    const PictureArea area = area_of("front", name);
    EXPECT_NEAR(area.share, patch.share.value, blur(area, fisheye)) << name;
    EXPECT_EQ(area.sides > 0, patch.share.status != Status::kZero) << name;
    fronts += area.sides > 0 ? 1U : 0U;
  }
  PictureArea back;
  for (const auto& [name, area] : areas) {
    if (name.first == "front") --fronts;
    if (name.first != "back") continue;
    back.share += area.share;
    back.sides += area.sides;
  }
  EXPECT_EQ(fronts, 0U) << "something is drawn that is not seen";
  EXPECT_NEAR(back.share, seen.back.value, blur(back, fisheye));
  const PictureArea open = area_of("open", "(open)");
  EXPECT_NEAR(open.share, seen.open.value, blur(open, fisheye));
}

}  // namespace

void expect_picture_of_shares(const Scene& scene, const Receiver& receiver) {
  for (const ViewProjection projection : {ViewProjection::kNusselt, ViewProjection::kFisheye}) {
    SCOPED_TRACE(projection == ViewProjection::kNusselt ? "Nusselt" : "fisheye");
    expect_areas_of_shares(scene, receiver, projection);
  }
}

namespace {

struct Name {
  std::string text;
  double x = 0.0, y = 0.0;  // of its middle; y of the base line
};

std::vector<Name> names_in(const std::string& svg) {
  std::vector<Name> names;
  const std::size_t end = svg.find("</g>", svg.find("<g id=\"names\""));
  for (std::size_t at = svg.find("<text", svg.find("<g id=\"names\"")); at < end; at = svg.find("<text", at + 1)) {
    Name name;
    std::array<char, 200> text{};
    EXPECT_EQ(std::sscanf(svg.c_str() + at, "<text x=\"%lf\" y=\"%lf\">%199[^<]", &name.x, &name.y, text.data()), 3);
    name.text = text.data();
    names.push_back(name);
  }
  return names;
}

// From pixels to directions, with the disk as view.h has it.
class Directions {
 public:
  Directions(const Vec3& normal, const Vec3& up, bool fisheye) : n_(unit(normal)), fisheye_(fisheye) {
    a_ = unit(cross(n_, up));
    b_ = cross(a_, n_);
  }
  [[nodiscard]] Vec3 at(double x, double y) const {
    const double u = (x - 344.0) / 320.0, v = (392.0 - y) / 320.0, r = u * u + v * v;
    const double w = fisheye_ ? (1.0 - r) / 2.0 : std::sqrt(1.0 - r);  // the fisheye: times (1 + r) / 2
    return {u * a_.x + v * b_.x + w * n_.x, u * a_.y + v * b_.y + w * n_.y, u * a_.z + v * b_.z + w * n_.z};
  }

 private:
  static Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  static Vec3 unit(const Vec3& a) {
    const double most = std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});  // a denormal length has few digits
    const Vec3 b{a.x / most, a.y / most, a.z / most};
    const double length = std::hypot(b.x, b.y, b.z);
    return {b.x / length, b.y / length, b.z / length};
  }

  Vec3 n_, a_, b_;
  bool fisheye_;
};

std::string name_of_first(const Scene& scene, const render::Ray& ray) {
  const std::optional<render::Hit> hit = render::first_hit(scene, ray);
  return !hit ? "(open)" : scene.patch(scene.face(hit->face).patch).name + (hit->back ? " (back)" : "");
}

}  // namespace

std::set<std::string> expect_names_on_what_they_name(const Scene& scene, const Receiver& receiver, const Vec3& up) {
  const std::vector<bool> is_own = own_pieces(scene, receiver);
  std::vector<Selection> own;
  for (std::size_t p = 0; p < is_own.size(); ++p) {
    const FaceId face = scene.pieces()[p].face;
    if (is_own[p]) own.push_back({.patch = scene.face(face).patch, .face = face, .scene = scene.id()});
  }
  // Faces that are not planar, of which some pieces are own, cannot be made transparent in part.
  for (std::size_t p = 0; p < is_own.size(); ++p) {
    const FaceId face = scene.pieces()[p].face;
    const auto is_of_own = [&](const Selection& one) { return one.face == face; };
    if (!is_own[p] && std::ranges::any_of(own, is_of_own)) return {};
  }
  const Scene others = scene.with_transparent(own);
  std::set<std::string> found;
  for (const ViewProjection projection : {ViewProjection::kNusselt, ViewProjection::kFisheye}) {
    const Directions directions(receiver.normal, up, projection == ViewProjection::kFisheye);
    const auto shows = [&](const Name& name, double x, double y) {
      return name_of_first(others, {receiver.point, directions.at(x, y)}) == name.text;
    };
    for (const Name& name : names_in(view_svg(scene, receiver, {.projection = projection, .up = up}))) {
      found.insert(name.text);
      const double middle = name.y - 4.0, reach = 3.5 * static_cast<double>(name.text.size());
      for (double y = 4.0 * std::ceil((middle - 8.0) / 4.0) + 2.0; y < middle + 8.0; y += 4.0) {
        for (double x = 4.0 * std::ceil((name.x - reach) / 4.0) + 2.0; x < name.x + reach; x += 4.0) {
          constexpr double kBlur = 0.1;  // curves are off by less
          EXPECT_TRUE(shows(name, x, y) || shows(name, x - kBlur, y) || shows(name, x + kBlur, y) ||
                      shows(name, x, y - kBlur) || shows(name, x, y + kBlur))
              << name.text << " at " << x << ", " << y << " is "
              << name_of_first(others, {receiver.point, directions.at(x, y)});
        }
      }
    }
  }
  return found;
}

namespace {

// By face and triangle.
using Fractions = std::map<std::pair<FaceId, std::uint32_t>, std::string>;

Fractions fractions_of(const VisibilityMesh& mesh, bool front) {
  Fractions result;
  for (const SeenRegion& region : mesh.regions) {
    if (region.front != front) continue;
    EXPECT_TRUE(result.try_emplace({region.face, region.triangle}, region.fraction).second) << "one region twice";
  }
  return result;
}

std::string fraction_in(const Fractions& fractions, FaceId face, std::uint32_t triangle) {
  const auto at = fractions.find({face, triangle});
  return at == fractions.end() ? "0" : at->second;
}

bool share_points(const Scene& scene, const Piece& a, const Piece& b) {
  const auto at = [&](std::uint32_t v) { return scene.vertices()[v]; };
  const bool in_one_plane = std::ranges::all_of(b.frame, [&](std::uint32_t v) {
    return kernel::orientation(at(a.frame[0]), at(a.frame[1]), at(a.frame[2]), at(v)) == 0;
  });
  return in_one_plane && overlap(scene, a, b);
}

// In its plane.
bool overlaps_another(const Scene& scene, FaceId id) {
  return std::ranges::any_of(scene.pieces(), [&](const Piece& other) {
    return other.face != id && std::ranges::any_of(scene.pieces_of(id), [&](const Piece& piece) {
             return share_points(scene, piece, other);
           });
  });
}

enum class FrontsAre { kFronts, kBacks };  // of the scene whose fractions were found

// Where faces in one plane overlap, only one is seen, but the Booleans see each. A front is seen unless it is stacked.
void expect_fractions_of_booleans(const Scene& scene, const Receiver& receiver, const Fractions& found,
                                  FrontsAre fronts) {
  const WholeView seen = view(scene, receiver, {.faces = true});
  for (std::uint32_t k = 0; k < scene.faces().size(); ++k) {
    const FaceId id{k};
    const auto patch = std::ranges::find(seen.patches, std::optional(id), &SeenPatch::face);
    if (patch != seen.patches.end() && patch->stacked) continue;
    if (fronts == FrontsAre::kBacks && overlaps_another(scene, id)) continue;
    const Selection face{.patch = scene.face(id).patch, .face = id, .scene = scene.id()};
    const FormFactor f =
        exact_form_factor(scene, receiver, {scene, face}, {.engine = Engine::kBoolean, .exact_fraction = true});
    const bool planar = scene.face(id).shape != FaceShape::kTriangulated;
    if (!planar && f.planes.size() != scene.face(id).piece_count) continue;  // triangles in one plane count as one
    for (std::uint32_t p = 0; p < f.planes.size(); ++p) {
      EXPECT_EQ(fraction_in(found, id, planar ? 0 : p + 1), f.planes[p].exact_fraction.value_or("0"))
          << scene.name_of(id);
    }
  }
}

using Point = std::array<mpq_class, 3>;
Point point_of(const Vec3& v) { return {mpq_class(v.x), mpq_class(v.y), mpq_class(v.z)}; }

// Twice the area, projected along an axis.
mpq_class doubled_area(const std::vector<Vec3>& ring, int axis) {
  mpq_class sum = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Point p = point_of(ring[k]), q = point_of(ring[(k + 1) % ring.size()]);
    const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
    sum += p[u] * q[v] - p[v] * q[u];
  }
  return sum;
}

// Along every axis, as far as rounding of the corners allows.
void expect_areas_of_triangles(const Scene& scene, const VisibilityMesh& mesh) {
  for (std::uint32_t r = 0; r < mesh.regions.size(); ++r) {
    const SeenRegion& region = mesh.regions[r];
    for (int axis = 0; axis < 3; ++axis) {
      mpq_class whole = 0, sum = 0, size = 0;
      const auto pieces = scene.pieces_of(region.face);
      for (std::uint32_t k = 0; k < pieces.size(); ++k) {
        if (region.triangle != 0 && region.triangle != k + 1) continue;
        std::vector<Vec3> ring;
        for (const std::uint32_t corner : scene.corners(pieces[k])) ring.push_back(scene.vertices()[corner]);
        whole += doubled_area(ring, axis);
        for (const Vec3& v : ring) {
          for (const mpq_class& c : point_of(v)) size = std::max(size, mpq_class(abs(c)));
        }
      }
      std::size_t triangles = 0;
      for (const VisibilityMesh::Triangle& triangle : mesh.triangles) {
        if (triangle.region != r) continue;
        std::vector<Vec3> ring;
        for (const std::uint32_t corner : triangle.corners) ring.push_back(mesh.points[corner]);
        sum += doubled_area(ring, axis);
        ++triangles;
      }
      const mpq_class error = (size * size * 0x1p-49 + size * 0x1p-1070) * mpq_class(triangles + mesh.flat + 1);
      EXPECT_LE(abs(sum - whole * mpq_class(region.fraction)), error)
          << scene.name_of(region.face) << ", axis " << axis;
    }
  }
}

}  // namespace

void expect_regions_as_booleans_find(const Scene& scene, const Receiver& receiver) {
  const VisibilityMesh mesh = visibility_mesh(scene, receiver);
  expect_fractions_of_booleans(scene, receiver, fractions_of(mesh, true), FrontsAre::kFronts);
  std::vector<Selection> all;
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    all.push_back({.patch = static_cast<PatchId>(p), .face = {}, .scene = scene.id()});
  }
  expect_fractions_of_booleans(scene.with_flipped(all), receiver, fractions_of(mesh, false), FrontsAre::kBacks);
  expect_areas_of_triangles(scene, mesh);
}

}  // namespace exactff::validation
