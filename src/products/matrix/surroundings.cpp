#include "matrix/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "exactff/matrix.h"
#include "kernel/filter.h"
#include "kernel/float_environment.h"
#include "kernel/poll.h"
#include "scene/closed_surfaces.h"
#include "scene/contacts.h"
#include "scene/selections.h"
#include "text/refuse.h"
#include "text/text_lines.h"
#include "visibility/source_plane.h"

namespace exactff::matrix {
namespace {

using kernel::above;
using kernel::below;
using view_factors::Columns;

std::vector<Selection> in_copy(const Scene& copy, std::span<const Selection> patches) {
  std::vector<Selection> result(patches.begin(), patches.end());
  for (Selection& patch : result) patch.scene = copy.id();
  return result;
}

std::vector<Selection> in_copy(const Scene& copy, std::span<const PatchId> patches) {
  std::vector<Selection> result;
  for (const PatchId patch : patches) result.push_back({patch, {}, copy.id()});
  return result;
}

ViewFactorOptions as_one_direction(ViewFactorOptions options) {
  options.both_directions = false;
  return options;
}

}  // namespace

Targets::Targets(Added added, std::span<const Selection> from, const ViewFactorOptions& options)
    : scene_(added.copy.take()),
      from_(in_copy(scene_, from)),
      to_(in_copy(scene_, added.patches)),
      pairs_(scene_, from_, to_, as_one_direction(options), added.kinds) {}

ViewFactor Targets::factor(std::size_t row, std::size_t column, double finer) const {
  const std::size_t entry = row * to_.size() + column;
  ViewFactor result;
  const auto take = [&](std::size_t of, const ViewFactor& f) {
    if (of == entry) result = f;
  };
  pairs_.compute(pairs_.pair_of(entry), take, finer);
  return result;
}

// --- Backs ---

namespace {

std::vector<std::uint32_t> corners_of(const Scene& scene, const Piece& piece) {
  const auto corners = scene.corners(piece);
  return {corners.begin(), corners.end()};
}

std::vector<std::uint32_t> reversed_corners_of(const Scene& scene, const Piece& piece) {
  std::vector<std::uint32_t> corners = corners_of(scene, piece);
  std::ranges::reverse(corners);
  return corners;
}

std::vector<FaceId> faces_with_area(const Scene& scene) {
  return faces_where(scene, [](const Face& face) { return face.piece_count > 0; });
}

bool belongs_to(const ClosedSurfaces& surfaces, std::uint32_t piece) {
  return !surfaces.empty() && surfaces.of_piece(piece) != ClosedSurfaces::kNone;
}

constexpr std::size_t kMostOverlaps = 16;  // planes beyond share patches with others

// The pieces of a scene and their backs that lie in one oriented plane, as indices of pieces.
struct SharedPlane {
  std::vector<std::uint32_t> fronts, backs;
};

bool have_same_plane(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const Piece &one = scene.pieces()[a], &other = scene.pieces()[b];
  const auto at = [&](int i) -> const Vec3& { return scene.vertices()[one.frame[i]]; };
  const kernel::PlaneThrough plane(at(0), at(1), at(2));
  return std::ranges::all_of(other.frame, [&](std::uint32_t v) { return plane.side_of(scene.vertices()[v]) == 0; }) &&
         have_same_front(scene, one, other);
}

// Pieces that are not transparent.
std::vector<SharedPlane> planes_of(const Scene& scene) {
  SceneCopy copy(scene);
  const PatchId backs = copy.add_patch("backs");
  for (const Piece& piece : scene.pieces()) copy.add_face(backs, reversed_corners_of(scene, piece));
  const Scene both = copy.take();
  const auto count = static_cast<std::uint32_t>(scene.pieces().size());
  std::vector<SharedPlane> result;
  std::optional<std::uint32_t> last;
  for (const visibility::SourcePlane& plane : visibility::group_by_plane(both, faces_with_area(both))) {
    // Where something is buried, a plane may come in parts, one after the other.
    if (!last || !have_same_plane(both, *last, plane.pieces.front())) result.emplace_back();
    last = plane.pieces.front();
    SharedPlane& shared = result.back();
    for (const std::uint32_t piece : plane.pieces) {
      if (scene.pieces()[piece % count].transparent) continue;
      (piece < count ? shared.fronts : shared.backs).push_back(piece % count);
    }
  }
  return result;
}

// Backs that fronts cover are left out. Returns whether others overlap with a front.
bool sort_out(const Scene& scene, SharedPlane& plane) {
  const auto pieces = scene.pieces();
  bool some_overlap = false;
  std::erase_if(plane.backs, [&](std::uint32_t back) {
    kernel::poll();
    std::vector<std::uint32_t> on_it;
    for (const std::uint32_t front : plane.fronts) {
      if (have_same_corners(scene, pieces[front], pieces[back])) return true;
      if (overlap(scene, pieces[front], pieces[back])) on_it.push_back(front);
    }
    const bool is_hidden = visibility::is_covered(scene, back, on_it);
    some_overlap = some_overlap || (!is_hidden && !on_it.empty());
    return is_hidden;
  });
  return some_overlap;
}

constexpr double kOfRoundings = 1.0 + 0x1p-20;  // of a sum, unless the accuracy is near them

void take_work(ViewFactor& sum, const ViewFactor& f) {
  sum.claim = weaker(sum.claim, f.claim);
  sum.way = std::max(sum.way, f.way);
  if (sum.limit == Limit::kNone) sum.limit = f.limit;
  sum.cells += f.cells;
  sum.event_cells += f.event_cells;
}

// Zero is exact, so that proved zeros stay zeros.
void add(ViewFactor& sum, const ViewFactor& f) {
  take_work(sum, f);
  if (f.upper == 0.0) return;
  const bool first = sum.upper == 0.0;
  sum.value += f.value;
  sum.lower = first ? f.lower : std::max(0.0, below(sum.lower + f.lower));
  sum.upper = first ? f.upper : above(sum.upper + f.upper);
}

// f is a part of the sum.
void subtract(ViewFactor& sum, const ViewFactor& f) {
  take_work(sum, f);
  if (f.upper == 0.0) return;
  sum.value -= f.value;
  sum.lower = below(sum.lower - f.upper);
  sum.upper = above(sum.upper - f.lower);
}

void clamp(ViewFactor& sum) {
  sum.lower = std::clamp(sum.lower, 0.0, 1.0);
  sum.upper = std::clamp(sum.upper, 0.0, 1.0);
  sum.value = std::clamp(sum.value, sum.lower, sum.upper);
}

// All columns are patches of turned copies of faces, and of copies of fronts in the planes of overlaps. The factor to
// the backs is the sum of those to the `whole` first columns, plus, for each overlap, that to `both` minus that to
// `fronts`; the difference is 0 for a patch that sees nothing of `turned`.
Targets::Added with_backs(const Scene& scene, std::size_t& whole) {
  // Planes in which backs and fronts overlap in part: the backs, the union of both, and the fronts.
  struct Overlap {
    PatchId turned, both, fronts;
  };
  const ClosedSurfaces surfaces(scene, ClosedSurfaces::Edges::kCutAtJunctions);
  const auto is_of_closed = [&](std::uint32_t piece) { return belongs_to(surfaces, piece); };
  Targets::Added added{SceneCopy(scene)};
  std::array<std::optional<PatchId>, 2> backs;  // of closed surfaces, which hide them from most, and others
  std::vector<Overlap> overlaps;
  std::size_t planes = 0;  // with an overlap
  const auto turn = [&](PatchId patch, std::uint32_t back) {
    added.copy.add_face(patch, reversed_corners_of(scene, scene.pieces()[back]));
  };
  for (SharedPlane& plane : planes_of(scene)) {
    if (!sort_out(scene, plane)) {
      if (plane.backs.empty()) continue;
      // All of a plane go to one patch, where they count once if they overlap.
      const bool are_of_closed = std::ranges::all_of(plane.backs, is_of_closed);
      std::optional<PatchId>& patch = backs[are_of_closed ? 0 : 1];
      if (!patch) patch = added.copy.add_patch(are_of_closed ? "backs of closed surfaces" : "backs");
      for (const std::uint32_t back : plane.backs) turn(*patch, back);
      continue;
    }
    if (overlaps.size() < kMostOverlaps) {
      const std::string number = std::to_string(overlaps.size());
      overlaps.push_back({added.copy.add_patch("backs on fronts " + number),
                          added.copy.add_patch("backs and fronts " + number),
                          added.copy.add_patch("fronts " + number)});
    }
    const auto& [turned, both, fronts] = overlaps[planes++ % kMostOverlaps];
    for (const std::uint32_t back : plane.backs) {
      turn(turned, back);
      turn(both, back);
    }
    for (const std::uint32_t front : plane.fronts) {
      added.copy.add_face(both, corners_of(scene, scene.pieces()[front]));
      added.copy.add_face(fronts, corners_of(scene, scene.pieces()[front]));
    }
  }
  for (const std::optional<PatchId>& patch : backs) {
    if (patch) added.patches.push_back(*patch);
  }
  whole = added.patches.size();
  for (const auto& [turned, both, fronts] : overlaps) {
    added.patches.insert(added.patches.end(), {turned, both, fronts});
  }
  added.kinds.assign(added.patches.size(), Columns::kBacks);
  return added;
}

struct Sight {
  const Piece* piece;
  kernel::PlaneThrough plane;
};

std::vector<Sight> sights_of(const Scene& scene, const Selection& selection) {
  std::vector<Sight> sights;
  const auto vertex = [&](std::uint32_t v) -> const Vec3& { return scene.vertices()[v]; };
  for (const FaceId face : scene.faces_of(selection)) {
    for (const Piece& piece : scene.pieces_of(face)) {
      sights.push_back({&piece, {vertex(piece.frame[0]), vertex(piece.frame[1]), vertex(piece.frame[2])}});
    }
  }
  return sights;
}

// False if all of `to` lies behind the plane of `from`, or in it.
bool reaches_before(const Scene& scene, const Sight& from, const Sight& to) {
  return std::ranges::any_of(scene.corners(*to.piece),
                             [&](std::uint32_t v) { return from.plane.side_of(scene.vertices()[v]) > 0; });
}

}  // namespace

BackFactors::BackFactors(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options)
    : accuracy_(options.accuracy), targets_(with_backs(scene, whole_), from, options), area_(find_area()) {}

double BackFactors::find_area() const {
  const view_factors::Pairs& pairs = targets_.pairs();
  double area = 0.0;
  std::size_t column = 0;
  for (; column < whole_; ++column) area += pairs.area_to(column);
  for (; column < targets_.to().size(); column += 3) {
    area += std::max(0.0, pairs.area_to(column + 1) - pairs.area_to(column + 2));
  }
  return area;
}

// Of the columns that the row may see, those that its factor is made of.
std::vector<BackFactors::Term> BackFactors::terms_of(std::size_t row) const {
  std::vector<Term> terms;
  std::size_t column = 0;
  for (; column < whole_; ++column) {
    if (targets_.pairs().may_see(row, column)) terms.push_back({column, false});
  }
  for (; column < targets_.to().size(); column += 3) {
    if (targets_.pairs().may_see(row, column)) terms.insert(terms.end(), {{column + 1, false}, {column + 2, true}});
  }
  return terms;
}

// No entry is the transpose of another: the patches of the rows are not among the columns. The terms have equal shares
// of the accuracy, how wide they are or not: if that decided, a smaller accuracy could yield a wider sum.
ViewFactor BackFactors::of_row(std::size_t row) const {
  const std::vector<Term> terms = terms_of(row);
  const double finer = terms.size() > 1 ? kOfRoundings * static_cast<double>(terms.size()) : 1.0;
  ViewFactor sum;
  for (const auto& [column, is_subtracted] : terms) {
    const ViewFactor f = targets_.factor(row, column, finer);
    is_subtracted ? subtract(sum, f) : add(sum, f);
  }
  clamp(sum);
  sum.accurate = sum.upper - sum.lower <= accuracy_;
  sum.area_to = area_;
  return sum;
}

// A point of a piece sees the front of another only if each reaches before the plane of the other. The backs are fronts
// of the copy that is made for them, where closed surfaces may hide them, too.
bool BackFactors::may_see_some(std::size_t row) const {
  const Scene& scene = targets_.scene();
  const std::vector<Sight> own = sights_of(scene, targets_.from()[row]);
  for (std::size_t column = 0; column < targets_.to().size(); column += column < whole_ ? 1 : 3) {
    if (!targets_.pairs().may_see(row, column)) continue;
    for (const Sight& back : sights_of(scene, targets_.to()[column])) {
      const auto may_see = [&](const Sight& one) {
        return reaches_before(scene, one, back) && reaches_before(scene, back, one);
      };
      if (std::ranges::any_of(own, may_see)) return true;
    }
  }
  return false;
}

ProvedZeros proved_zeros(const Scene& scene, std::span<const Selection> from) {
  const BackFactors backs(scene, from, {});
  ProvedZeros zeros;
  for (std::size_t i = 0; i < from.size(); ++i) {
    kernel::poll();
    zeros.back.push_back(!backs.may_see_some(i));
    zeros.open.push_back(backs.is_enclosed(i));
  }
  return zeros;
}

bool have_fronts_in_common(const Scene& scene) {
  const auto patch_of = [&](std::uint32_t piece) { return scene.face(scene.pieces()[piece].face).patch; };
  for (const visibility::SourcePlane& plane : visibility::group_by_plane(scene, faces_with_area(scene))) {
    for (std::size_t i = 0; i < plane.pieces.size(); ++i) {
      kernel::poll();
      for (std::size_t j = 0; j < i; ++j) {
        const std::uint32_t a = plane.pieces[i], b = plane.pieces[j];
        if (patch_of(a) != patch_of(b) && overlap(scene, scene.pieces()[a], scene.pieces()[b])) return true;
      }
    }
  }
  return false;
}

// --- Open ---

namespace {

constexpr std::size_t kMostPieces = 4096;  // of more, the rest is hardly known soon
constexpr double kLittle = 0.45;           // of a view that may be the faces', by a rough bound

// Of a row of which this share of the area is not buried, and sees this of the faces.
ViewFactor rest_of(const ViewFactor& faces, const kernel::Disc& exposed) {
  ViewFactor rest = faces;
  rest.area_to = 0.0;
  const bool whole = is_whole_share(exposed);
  const double most = whole ? 1.0 : std::min(1.0, upper_end(exposed));
  const double least = whole ? 1.0 : std::max(0.0, lower_end(exposed));
  if (faces.claim == Claim::kZero) {
    rest.claim = Claim::kCertified;
    rest.lower = least;
    rest.upper = most;
  } else {
    rest.lower = std::max(0.0, kernel::below(least - faces.upper));
    rest.upper = std::min(1.0, kernel::above(most - faces.lower));
  }
  rest.value = std::clamp(exposed.centre - faces.value, rest.lower, rest.upper);
  return rest;
}

// All that hides anything, from either side, as copies of fronts and turned copies. What overlaps in a plane counts
// once. Columns: all of it; and, if there are closed surfaces, their backs, which they hide from most, and all other
// sides. None if all faces are transparent.
Targets::Added with_sides(const Scene& scene) {
  const ClosedSurfaces surfaces(scene, ClosedSurfaces::Edges::kCutAtJunctions);
  Targets::Added added{SceneCopy(scene)};
  std::optional<PatchId> all, closed_backs, others;
  const auto add = [&](std::optional<PatchId>& patch, const char* name, const std::vector<std::uint32_t>& corners) {
    if (!patch) patch = added.copy.add_patch(name);
    added.copy.add_face(*patch, corners);
  };
  for (std::uint32_t p = 0; p < scene.pieces().size(); ++p) {
    const Piece& piece = scene.pieces()[p];
    if (piece.transparent) continue;
    const std::vector<std::uint32_t> front = corners_of(scene, piece), back = reversed_corners_of(scene, piece);
    add(all, "all sides", front);
    add(all, "all sides", back);
    if (surfaces.empty()) continue;
    add(others, "other sides", front);
    belongs_to(surfaces, p) ? add(closed_backs, "backs of closed surfaces", back) : add(others, "other sides", back);
  }
  if (all) added.patches.push_back(*all);
  if (closed_backs) added.patches.insert(added.patches.end(), {*closed_backs, *others});
  added.kinds.assign(added.patches.size(), Columns::kBacks);
  return added;
}

// Of points on a line: whether the third does not lie beyond the second, as seen from the first.
bool runs_back(const Vec3& first, const Vec3& second, const Vec3& third) {
  const auto along = [&](double Vec3::*c) { return (second.*c < first.*c) != (third.*c < second.*c); };
  return (first.x != second.x && along(&Vec3::x)) || (first.y != second.y && along(&Vec3::y)) ||
         (first.z != second.z && along(&Vec3::z));
}

// Round a hole in a plane: its corners, counter-clockwise as seen from the surface. Empty if the edges are those of
// several holes, or of one that is not convex.
std::vector<std::uint32_t> convex_hole(const Scene& scene, const ClosedSurface::Rim& rim) {
  constexpr std::size_t kMostCorners = 256;
  if (rim.edges.size() > kMostCorners) return {};
  std::map<std::uint32_t, std::uint32_t> next(rim.edges.begin(), rim.edges.end());
  if (next.size() != rim.edges.size()) return {};
  std::vector<std::uint32_t> ring;
  for (std::uint32_t at = rim.edges.front().first; ring.size() < next.size(); at = next[at]) {
    if (!next.contains(at) || std::ranges::find(ring, at) != ring.end()) return {};
    ring.push_back(at);
  }
  // No edge runs back along the one before, and the corners lie on one side of every edge: of the plane through it and
  // a point off the hole's plane.
  const auto at = [&](std::size_t i) -> const Vec3& { return scene.vertices()[ring[i % ring.size()]]; };
  const auto apex = std::ranges::find_if(scene.vertices(), [&](const Vec3& v) {
    return kernel::PlaneThrough(rim.plane[0], rim.plane[1], rim.plane[2]).side_of(v) > 0;
  });
  int turn = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const kernel::PlaneThrough side(at(i), at(i + 1), *apex);
    if (side.side_of(at(i + 2)) == 0 && runs_back(at(i), at(i + 1), at(i + 2))) return {};
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int sign = side.side_of(at(k));
      if (sign * turn < 0) return {};
      if (sign != 0) turn = sign;
    }
  }
  if (turn > 0) std::ranges::reverse(ring);
  return ring;
}

// Every piece that hides anything reaches before the plane, and none behind it.
bool lies_before(const Scene& scene, const ClosedSurface::Rim& rim) {
  const kernel::PlaneThrough plane(rim.plane[0], rim.plane[1], rim.plane[2]);
  return std::ranges::all_of(scene.pieces(), [&](const Piece& piece) {
    if (piece.transparent) return true;
    bool is_before = false;
    for (const std::uint32_t corner : scene.corners(piece)) {
      const int side = plane.side_of(scene.vertices()[corner]);
      if (side < 0) return false;
      is_before = is_before || side > 0;
    }
    return is_before;
  });
}

// Within a surface with a convex hole in a plane, with nothing of the scene beyond the plane, what is open is what is
// seen of a face that fills the hole and looks at the surface.
void add_windows(const Scene& scene, Targets::Added& added, std::vector<std::size_t>& surfaces) {
  const ClosedSurfaces closed(scene, ClosedSurfaces::Edges::kCutAtJunctions);
  for (std::size_t s = 0; s < closed.surfaces().size(); ++s) {
    const std::optional<ClosedSurface::Rim>& rim = closed.surfaces()[s].rim;
    if (!rim || !lies_before(scene, *rim)) continue;
    const std::vector<std::uint32_t> ring = convex_hole(scene, *rim);
    if (ring.empty()) continue;
    surfaces.push_back(s);
    added.patches.push_back(added.copy.add_patch("window " + std::to_string(s)));
    added.kinds.push_back(Columns::kWindows);
    added.copy.add_face(added.patches.back(), ring);
  }
}

// A cube around everything, whose fronts look inward, and the windows of these surfaces. Not much larger than the
// scene, so that bounds of roundings, which go by the largest coordinate, stay as small.
Targets::Added with_sky(const Scene& scene, std::vector<std::size_t>& surfaces_of_windows) {
  constexpr double kWider = 1.25;  // roundings do not matter
  std::array<double, 3> centre{};
  double half = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = [&](const Vec3& v) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; };
    const auto [low, high] = std::ranges::minmax(scene.vertices(), {}, at);
    centre[axis] = 0.5 * at(low) + 0.5 * at(high);
    half = std::max(half, 0.5 * at(high) - 0.5 * at(low));
  }
  Targets::Added added{SceneCopy(scene)};
  SceneCopy& copy = added.copy;
  const PatchId sky = copy.add_patch("sky");
  added.patches.push_back(sky);
  added.kinds.push_back(Columns::kSurroundings);
  std::array<std::uint32_t, 8> corners{};  // the bits of their number tell on which sides they lie
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto at = [&](std::size_t axis) {
      return centre[axis] + ((i >> axis & 1) != 0 ? kWider * half : -kWider * half);
    };
    const Vec3 corner{at(0), at(1), at(2)};
    if (!std::isfinite(corner.x) || !std::isfinite(corner.y) || !std::isfinite(corner.z)) {
      text::refuse("the scene is too large for a sky around it", "doubles end near 1.8e308", "scale the scene down");
    }
    corners[i] = copy.add_vertex(corner);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t one = std::size_t{1} << (axis + 1) % 3, two = std::size_t{1} << (axis + 2) % 3,
                      far = std::size_t{1} << axis;
    copy.add_face(sky, {corners[0], corners[one], corners[one + two], corners[two]});
    copy.add_face(sky, {corners[far], corners[far + two], corners[far + one + two], corners[far + one]});
  }
  add_windows(scene, added, surfaces_of_windows);
  return added;
}

}  // namespace

OpenFactors::OpenFactors(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options,
                         const view_factors::Pairs& pairs)
    : scene_(scene),
      from_(from.begin(), from.end()),
      options_(options),
      pairs_(pairs),
      targets_(with_sky(scene, surfaces_), from, options) {}

const Targets& OpenFactors::sides() const {
  std::call_once(sides_once_, [&] { sides_ = std::make_unique<const Targets>(with_sides(scene_), from_, options_); });
  return *sides_;
}

ViewFactor OpenFactors::of_row(std::size_t row) const {
  if (pairs_.is_enclosed(row)) return {};
  for (std::size_t w = 0; w < surfaces_.size(); ++w) {
    if (pairs_.is_within(row, surfaces_[w])) return targets_.factor(row, w + 1);
  }
  const double most = pairs_.open_at_most(row);
  if (most <= options_.accuracy) return {.upper = most, .claim = Claim::kCertified};
  ViewFactor open = computed(row);
  for (double* bound : {&open.upper, &open.lower, &open.value}) *bound = std::min(*bound, most);
  return open;
}

ViewFactor OpenFactors::computed(std::size_t row) const {
  enum Column : std::size_t { kAll, kClosedBacks, kOthers };
  if (scene_.pieces().size() > kMostPieces) return targets_.factor(row, 0);
  // The fewest sides that are all that the row sees.
  const bool any = !sides().to().empty();
  const Column column = sides().to().size() > 1 && !sides().pairs().may_see(row, kClosedBacks) ? kOthers : kAll;
  // About what the row would see if nothing were hidden.
  if (any && sides().pairs().unhidden(row, column) >= kLittle) return targets_.factor(row, 0);
  const ViewFactor rest = rest_of(any ? sides().factor(row, column) : ViewFactor{}, pairs_.exposed_share(row));
  if (rest.accurate) return rest;
  const ViewFactor to_sky = targets_.factor(row, 0);
  return to_sky.upper - to_sky.lower < rest.upper - rest.lower ? to_sky : rest;
}

// --- Twins ---

namespace {

std::string name_of_back(const Scene& scene, const Selection& selection) {
  std::string name = scene.name_of(selection) + ' ' + std::string(kBack);
  if (has_patch(scene, name)) {
    text::refuse("the back of " + scene.name_of(selection) + " cannot be a patch of its own",
                 "there is a patch named " + text::in_quotes(name) + " already", "rename that patch");
  }
  return name;
}

}  // namespace

Scene with_two_sided(const Scene& scene, std::span<const Selection> selections) {
  const kernel::StandardArithmetic arithmetic;
  SceneCopy copy(scene);
  std::set<FaceId> doubled;
  for (const Selection& selection : selections) {
    std::vector<FaceId> faces = scene.faces_of(selection);
    std::erase_if(faces, [&](FaceId face) { return !doubled.insert(face).second; });
    if (faces.empty()) continue;
    const PatchId back = copy.add_patch(name_of_back(scene, selection));
    for (const FaceId face : faces) copy.add_twin(back, scene.face(face));
  }
  return copy.take();
}

}  // namespace exactff::matrix
