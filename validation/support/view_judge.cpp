#include "support/view_judge.h"

#include <gmpxx.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "kernel/numbers.h"
#include "support/oracle.h"
#include "whole_view/view_edges.h"

namespace exactff::validation {

using kernel::ExactVec3;
using kernel::Integer;
using whole_view::ViewEdges;

const SeenPatch* find_patch(const WholeView& seen, std::size_t patch) {
  const auto at = std::ranges::find(seen.patches, static_cast<PatchId>(patch), &SeenPatch::patch);
  return at == seen.patches.end() ? nullptr : &*at;
}

void expect_patches_as_the_solver(const Scene& scene, const Receiver& receiver) {
  const WholeView seen = view(scene, receiver);
  for (std::size_t p = 0; p < scene.patches().size(); ++p) {
    const Selection whole{.patch = static_cast<PatchId>(p), .face = {}, .scene = scene.id()};
    const FormFactor f = exact_form_factor(scene, receiver, ExactSource(scene, whole));
    const SeenPatch* patch = find_patch(seen, p);
    expect_same_bits(patch ? patch->form_factor : ViewShare{}, f, scene.patches()[p].name);
    if (patch != nullptr && !patch->stacked) expect_same_bits(patch->share, f, scene.patches()[p].name);
  }
}

void expect_shares_to_add_up(const Scene& scene, const Receiver& receiver) {
  const WholeView seen = view(scene, receiver);
  Enclosure sum = seen.back.enclosure;
  sum += seen.open.enclosure;
  double values = seen.back.value + seen.open.value;
  for (const SeenPatch& patch : seen.patches) {
    sum += patch.share.enclosure;
    values += patch.share.value;
  }
  EXPECT_TRUE(sum.contains(1.0)) << sum.midpoint();
  EXPECT_NEAR(values, 1.0, 1e-12);
}

namespace {

// The same faces, the first ones as the only patch "first", the others as "rest"; on request, after all of them, each
// first one turned round, in the patch "first" as well.
Scene joined(const Scene& scene, std::size_t first, bool turned_too = false) {
  SceneBuilder builder;
  for (const Vec3& vertex : scene.vertices()) builder.add_vertex(vertex);
  for (const Material& material : scene.materials()) builder.add_material(material);
  for (std::size_t f = 0; f < scene.faces().size(); ++f) {
    const Face& face = scene.faces()[f];
    builder.add_face(builder.patch(f < first ? "first" : "rest"), face.material, face.rings);
  }
  for (std::size_t f = 0; f < first && turned_too; ++f) {
    auto rings = scene.faces()[f].rings;
    for (auto& ring : rings) std::ranges::reverse(ring);
    builder.add_face(builder.patch("first"), scene.faces()[f].material, std::move(rings));
    builder.mark_as_twin();
  }
  return builder.build();
}

Enclosure factor_of_first(const Scene& scene, const Receiver& receiver) {
  return exact_form_factor(scene, receiver, {scene, scene.select("first")}).enclosure;
}

Enclosure difference(Enclosure a, const Enclosure& b) {
  a -= b;
  return a;
}

void expect_meet(const Enclosure& share, const Enclosure& judged, const std::string& what) {
  EXPECT_TRUE(share.overlaps(judged)) << what << ": " << share.midpoint() << " and " << judged.midpoint();
}

}  // namespace

void expect_shares_of_unions(const Scene& scene, const Receiver& receiver) {
  if (some_is_buried(scene)) return;  // the judge knows no solids
  const std::size_t count = scene.faces().size();
  const WholeView by_face = view(scene, receiver, {.faces = true}), by_patch = view(scene, receiver);
  std::vector<Enclosure> of_patch(scene.patches().size());
  Enclosure before;
  for (std::uint32_t f = 0; f < count; ++f) {
    const Enclosure with = factor_of_first(joined(scene, f + 1), receiver);
    const auto seen = std::ranges::find(by_face.patches, std::optional(FaceId{f}), &SeenPatch::face);
    const Enclosure share = seen == by_face.patches.end() ? Enclosure{} : seen->share.enclosure;
    expect_meet(share, difference(with, before), scene.name_of(FaceId{f}));
    of_patch[index_of(scene.faces()[f].patch)] += share;
    before = with;
  }
  for (std::size_t p = 0; p < of_patch.size(); ++p) {
    const SeenPatch* const patch = find_patch(by_patch, p);
    expect_meet(patch ? patch->share.enclosure : Enclosure{}, of_patch[p], scene.patches()[p].name);
  }
  const Enclosure all = factor_of_first(joined(scene, count, true), receiver);
  for (const WholeView* seen : {&by_face, &by_patch})
    expect_meet(seen->back.enclosure, difference(all, before), "back");
}

namespace {

// The sign of the first number that is not zero.
int first_sign(const Integer& a, const Integer& b) { return sgn(a) != 0 ? sgn(a) : sgn(b); }

// A direction m, moved by an infinitely small part of `aside`.
struct NearDirection {
  ExactVec3 m, aside;
};

struct Plane {
  FaceId face{};
  bool front = false;
  ExactVec3 normal;              // away from x
  mpq_class offset;              // > 0
  std::vector<ExactVec3> sides;  // inward
};

std::vector<Plane> planes_of(const Scene& scene, const Receiver& receiver) {
  std::vector<Plane> result;
  const std::vector<bool> own = own_pieces(scene, receiver);
  for (std::size_t p = 0; p < scene.pieces().size(); ++p) {
    const Piece& piece = scene.pieces()[p];
    if (piece.transparent || own[p]) continue;
    std::vector<ExactVec3> corners;
    long exponent = 10000;
    const auto at = [&](std::uint32_t vertex) {
      return kernel::exact_difference(scene.vertices()[vertex], receiver.point);
    };
    for (const std::uint32_t vertex : scene.corners(piece)) exponent = std::min(exponent, at(vertex).exponent);
    const auto corner = [&](std::uint32_t vertex) {
      kernel::ScaledVec3 t = at(vertex);
      if (!is_zero(t.v)) lower_exponent(t, exponent);
      return t.v;
    };
    const ExactVec3 a = corner(piece.frame[0]), b = corner(piece.frame[1]), c = corner(piece.frame[2]);
    Plane plane{.face = piece.face, .normal = cross(b - a, c - a), .offset = {}, .sides = {}};
    const Integer offset = dot(plane.normal, a);
    if (sgn(offset) == 0) continue;
    plane.front = sgn(offset) < 0;
    plane.offset = kernel::times_power_of_two(mpq_class(abs(offset)), exponent);
    if (sgn(offset) < 0) kernel::negate(plane.normal);
    for (const std::uint32_t vertex : scene.corners(piece)) corners.push_back(corner(vertex));
    for (std::size_t k = 0; k < corners.size(); ++k) {
      ExactVec3 side = cross(corners[k], corners[(k + 1) % corners.size()]);
      if (sgn(offset) < 0) kernel::negate(side);
      plane.sides.push_back(std::move(side));
    }
    result.push_back(std::move(plane));
  }
  return result;
}

bool covers(const Plane& plane, const NearDirection& d) {
  return std::ranges::all_of(plane.sides,
                             [&](const ExactVec3& side) { return first_sign(dot(side, d.m), dot(side, d.aside)) > 0; });
}

std::optional<FaceId> seen_in(const std::vector<Plane>& planes, const NearDirection& d) {
  const Plane* best = nullptr;
  mpq_class best_depth, best_aside;
  for (const Plane& plane : planes) {
    if (!covers(plane, d)) continue;
    const mpq_class depth = dot(plane.normal, d.m) / plane.offset, aside = dot(plane.normal, d.aside) / plane.offset;
    const bool is_same = best != nullptr && depth == best_depth && aside == best_aside;
    const bool is_nearer = best == nullptr || depth > best_depth || (depth == best_depth && aside > best_aside);
    if (!is_nearer && !(is_same && plane.front && !best->front)) continue;  // otherwise of equal ones the first
    best = &plane;
    best_depth = depth;
    best_aside = aside;
  }
  return best == nullptr ? std::nullopt : std::optional(best->face);
}

std::string name_of(const Scene& scene, const std::optional<FaceId>& face) {
  return face ? scene.name_of(*face) : "nothing";
}

}  // namespace

void expect_sides_as_rational_numbers_find(const Scene& scene, const Receiver& receiver) {
  const visibility::View from(scene, receiver);
  ViewEdges edges;
  edges.find(from, ViewEdges::Wholes::kFaces);
  const std::vector<Plane> planes = planes_of(scene, receiver);
  const ExactVec3 up = from.normal().exact;
  for (std::size_t i = 0; i < edges.parts().size(); ++i) {
    const auto piece = edges.exact(edges.parts()[i]);
    const ExactVec3 p = piece.a * piece.begin.l + piece.b * piece.begin.m,
                    q = piece.a * piece.end.l + piece.b * piece.end.m;
    ASSERT_GT(sgn(Integer(piece.begin.l * piece.end.m - piece.begin.m * piece.end.l)), 0);
    const Integer up_p = dot(up, p), up_q = dot(up, q);
    ASSERT_GE(sgn(up_p), 0);
    ASSERT_GE(sgn(up_q), 0);
    // Not the middle, so that no accident of symmetry puts it onto another line.
    const NearDirection left{p * Integer(5) + q * Integer(7), cross(piece.b, piece.a)};
    NearDirection right = left;
    kernel::negate(right.aside);
    const auto face = [&](whole_view::OutlineId o) -> std::optional<FaceId> {
      return o == whole_view::kNothing ? std::nullopt : std::optional(edges.face(o));
    };
    const ViewEdges::Sides& sides = edges.sides()[i];
    EXPECT_EQ(name_of(scene, face(sides.left)), name_of(scene, seen_in(planes, left))) << "left of arc " << i;
    EXPECT_EQ(sides.on_horizon, sgn(up_p) == 0 && sgn(up_q) == 0 && !face(sides.right)) << "arc " << i;
    if (sides.on_horizon) continue;
    EXPECT_EQ(name_of(scene, face(sides.right)), name_of(scene, seen_in(planes, right))) << "right of arc " << i;
  }
}

}  // namespace exactff::validation
