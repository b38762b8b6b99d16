// A draft of a matrix: each row from whole views of points in strata of its patch.
//
// In each stratum there are two draws of points, as for single entries (view_factors/sampled_factor.h). A view gives
// the point's form factors to all patches at once, so a row costs the same whatever the number of columns. strata.h has
// the points and the interval of an entry. Rigorous facts narrow it. With d the distance between the boxes of two
// patches, F(x -> j) = integral of cos cos / (pi r^2) over j is at most A_j / (pi d^2). And an entry is 0 if of every
// two pieces, one lies behind the plane of the other, or if walls hide all of j from all of i.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>

#include "exactff/matrix.h"
#include "exactff/view.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "scene/scene_copy.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "view_factors/near_planes.h"
#include "view_factors/patch_parts.h"
#include "view_factors/sampled_factor.h"
#include "view_factors/strata.h"
#include "visibility/seen_pieces.h"
#include "whole_view/view_among.h"

namespace exactff::matrix {
namespace {

using view_factors::Box;
using view_factors::ExactPiece;
using view_factors::ExactScene;
using view_factors::Part;
using view_factors::Point;
using view_factors::StratifiedMean;
using visibility::Wall;

constexpr double kRoundings = 0x1p-40;  // relative: more than those of areas, distances and sums

struct DraftPatch {
  Selection patch;
  std::vector<const ExactPiece*> pieces;
  Box box;
  double unit_area = 0.0;  // in squares of the unit of Point::at
  double area = 0.0;       // in the scene's unit of length, squared
};

DraftPatch prepared(const ExactScene& scene, const Selection& patch) {
  DraftPatch result{patch, {}, {}, 0.0, 0.0};
  std::tie(result.unit_area, result.area) = areas_of(scene, patch, parts_of(scene, patch));
  for (const FaceId face : scene.scene.faces_of(patch)) {
    const Face& of = scene.scene.face(face);
    for (std::uint32_t p = of.first_piece; p < of.first_piece + of.piece_count; ++p) {
      const ExactPiece& piece = scene.pieces[p];
      result.pieces.push_back(&piece);
      result.box.include(piece.box.low);
      result.box.include(piece.box.high);
    }
  }
  return result;
}

bool lies_behind(const ExactScene& scene, const ExactPiece& piece, const ExactPiece& plane) {
  return std::ranges::all_of(piece.corners,
                             [&](std::uint32_t corner) { return side_of(plane.plane, scene.vertices[corner]) <= 0; });
}

bool is_zero(const ExactScene& scene, const DraftPatch& from, const DraftPatch& to) {
  return std::ranges::all_of(from.pieces, [&](const ExactPiece* p) {
    return std::ranges::all_of(
        to.pieces, [&](const ExactPiece* q) { return lies_behind(scene, *p, *q) || lies_behind(scene, *q, *p); });
  });
}

// At least the largest F from a point of one patch to the other.
double largest_factor(const DraftPatch& from, const DraftPatch& to) {
  constexpr double kRounding = 0x1p-50;  // no coordinate exceeds 1
  const auto gap = [](double low_a, double high_a, double low_b, double high_b) {
    return std::max({0.0, low_a - high_b - kRounding, low_b - high_a - kRounding});
  };
  const double x = gap(from.box.low.x, from.box.high.x, to.box.low.x, to.box.high.x);
  const double y = gap(from.box.low.y, from.box.high.y, to.box.low.y, to.box.high.y);
  const double z = gap(from.box.low.z, from.box.high.z, to.box.low.z, to.box.high.z);
  const double square = x * x + y * y + z * z;
  return to.unit_area < std::numbers::pi * square ? to.unit_area / (std::numbers::pi * square) * (1.0 + kRoundings)
                                                  : 1.0;
}

// Rounding moves no point of a part out of its box, whose sides are coordinates of corners.
std::vector<std::uint32_t> pieces_seen_from(const ExactScene& scene, std::span<const Wall> walls, const Part& part) {
  const Box box = box_of(part.corners);
  const int exponent = static_cast<int>(scene.units.exponent + scene.units.shift);
  const auto in_scene = [&](const Vec3& v) {
    return Vec3{std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)};
  };
  return visibility::pieces_seen_from(scene.scene, walls, {in_scene(box.low), in_scene(box.high)});
}

// What the points of one row have seen, by patch, then the backs and what is open.
class RowOfMeans {
 public:
  explicit RowOfMeans(const Scene& scene)
      : scene_(scene), means_(scene.patches().size() + 2), may_see_(scene.patches().size()) {
    for (std::vector<double>& numbers : numbers_) numbers.assign(means_.size(), 0.0);
  }

  void look_around(const ExactScene& scene, std::span<const Wall> walls, const Selection& patch, std::size_t views) {
    std::vector<Part> parts;
    for (const Part& part : parts_of(scene, patch)) {
      see_from(scene, walls, part);
      for (Part& fragment : cut_at_contacts(scene, part)) {
        parts.push_back(std::move(fragment));
        seen_from_.push_back(seen_pieces_.size() - 1);
      }
    }
    strata_ = strata_of(
        parts, std::max(view_factors::kFewestStrata, views / (view_factors::kDraws * view_factors::kFewestPoints)));
    const view_factors::Strata& strata = strata_;
    of_ones_ = ranges_of(strata_, 1.0);
    of_shares_ = error_of_shares(parts, scene.units);
    std::vector<std::optional<view_factors::NearPlanes>> near(parts.size());
    for (std::size_t s = 0; s < strata.strata.size(); ++s) {
      const double share = strata.strata[s].area / strata.area;
      std::array<double, view_factors::kDraws> unknown{};
      for (std::size_t d = 0; d < view_factors::kDraws; ++d) {
        const auto [part, points] = view_factors::sample(parts, strata, 0, s, d, scene.units);
        if (!near[part]) near[part].emplace(scene, parts[part]);
        const double weight = 1.0 / static_cast<double>(points.size());
        for (const Point& point : points) {
          ++points_;
          const bool is_known = look_from(point, *near[part], seen_pieces_[seen_from_[part]], weight, numbers_[d]);
          if (!is_known) unknown[d] += weight;
        }
      }
      add(share);
      unknown_.add(unknown[0], unknown[1], share);
    }
  }

  static constexpr std::size_t kBackColumn = 0, kOpenColumn = 1;
  [[nodiscard]] const StratifiedMean& mean(PatchId patch) const { return means_[index_of(patch)]; }
  // False: walls hide it from all of the row's patch.
  [[nodiscard]] bool may_see(PatchId patch) const { return may_see_[index_of(patch)]; }
  [[nodiscard]] const StratifiedMean& beside(std::size_t which) const {
    return means_[scene_.patches().size() + which];
  }
  // `range`: at least the largest factor from any of the points.
  [[nodiscard]] double error(const StratifiedMean& mean, double range) const {
    return mean.error(view_factors::kRisk, of_ones_.scaled(range), unknown_.scaled(range)) + of_shares_ +
           view_factors::kRoundedPoints + kRoundings * mean.value;
  }
  [[nodiscard]] std::size_t points() const { return points_; }

 private:
  void see_from(const ExactScene& scene, std::span<const Wall> walls, const Part& part) {
    seen_pieces_.push_back(pieces_seen_from(scene, walls, part));
    for (const std::uint32_t piece : seen_pieces_.back()) {
      may_see_[index_of(scene_.face(scene_.pieces()[piece].face).patch)] = true;
    }
  }

  // False where rounding the point may change what it sees.
  bool look_from(const Point& point, const view_factors::NearPlanes& near, std::span<const std::uint32_t> pieces,
                 double weight, std::vector<double>& numbers) {
    const std::optional<Vec3> rounded = near.round(point);
    if (!rounded) return false;
    const Receiver receiver{.point = *rounded, .normal = near.normal(), .on = near.own(), .id = {}};
    whole_view::view_among(scene_, pieces, receiver, {}, seen_, workspace_);
    for (const SeenPatch& one : seen_.patches) note(index_of(one.patch), weight * one.form_factor.value, numbers);
    note(scene_.patches().size() + kBackColumn, weight * seen_.back.value, numbers);
    note(scene_.patches().size() + kOpenColumn, weight * seen_.open.value, numbers);
    return true;
  }

  void note(std::size_t column, double value, std::vector<double>& numbers) {
    numbers[column] += value;
    touched_.push_back(column);
  }

  // The two draws of a stratum.
  void add(double share) {
    for (const std::size_t column : touched_) {
      if (numbers_[0][column] == 0.0 && numbers_[1][column] == 0.0) continue;
      means_[column].add(numbers_[0][column], numbers_[1][column], share);
      numbers_[0][column] = numbers_[1][column] = 0.0;
    }
    touched_.clear();
  }

  const Scene& scene_;
  view_factors::Strata strata_;
  std::vector<StratifiedMean> means_;
  std::vector<bool> may_see_;                            // by patch
  std::vector<std::vector<std::uint32_t>> seen_pieces_;  // from each part before it was cut
  std::vector<std::size_t> seen_from_;                   // by fragment: an index of seen_pieces_
  std::array<std::vector<double>, view_factors::kDraws> numbers_;
  std::vector<std::size_t> touched_;
  WholeView seen_;
  Workspace workspace_;
  view_factors::Ranges of_ones_;
  StratifiedMean unknown_;  // the share of the points that are not known
  double of_shares_ = 0.0;
  std::size_t points_ = 0;
};

ViewFactor entry(const StratifiedMean& mean, const RowOfMeans& row, double largest) {
  ViewFactor f;
  f.claim = Claim::kEstimated;
  f.way = Way::kViews;
  f.value = std::clamp(mean.value, 0.0, 1.0);
  const double error = row.error(mean, largest);
  f.lower = std::max(0.0, f.value - error);
  f.upper = std::max(f.value, std::min({1.0, largest, f.value + error}));
  f.cells = row.points();
  return f;
}

void judge(ViewFactor& f, double area_from, double area_to, double accuracy) {
  f.area_from = area_from;
  f.area_to = area_to;
  const double width = f.upper - f.lower;
  f.accurate = std::max(width, area_to > 0.0 ? width * area_from / area_to : 0.0) <= accuracy;
  f.limit = f.accurate ? Limit::kNone : Limit::kBudget;
}

void require_whole_patches(const Scene& scene, std::span<const Selection> to) {
  for (const Selection& patch : to) {
    const std::vector<FaceId> faces = scene.faces_of(patch);
    const bool see_through = std::ranges::any_of(faces, [&](FaceId f) { return scene.face(f).transparent; });
    if (!patch.face && !see_through) continue;
    text::refuse(
        "a column of the draft is " + std::string(patch.face ? "a face: " : "transparent: ") + scene.name_of(patch),
        "a draft asks whole views, which show the patches that hide something",
        patch.face ? "name patches, or add --patches faces" : "leave the patch out, or compute no draft");
  }
}

}  // namespace

Matrix draft(const Scene& given, std::span<const Selection> from, std::span<const Selection> to,
             const DraftOptions& options, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  require_whole_patches(given, to);
  const std::optional<Scene> moved = near_origin(given);
  const Scene& scene = moved ? *moved : given;
  const ExactScene exact(scene);
  const std::vector<Wall> walls = visibility::walls_of(scene);
  std::vector<DraftPatch> rows, columns;
  for (const Selection& patch : from) {
    (void)given.faces_of(patch);  // throws if it is of another scene
    rows.push_back(prepared(exact, {patch.patch, patch.face}));
  }
  for (const Selection& patch : to) columns.push_back(prepared(exact, {patch.patch, patch.face}));
  Matrix result{{{from.begin(), from.end()}, {to.begin(), to.end()}, {}}, {}, {}};
  result.factors.entries.resize(rows.size() * columns.size());
  if (options.backs) result.back.resize(rows.size());
  if (options.open) result.open.resize(rows.size());
  const int threads = options.threads > 0 ? options.threads : files::usable_threads();
  files::parallel_for(rows.size(), threads, "rows of the draft", hooks, [&](std::size_t i) {
    const kernel::StandardArithmetic of_thread;
    RowOfMeans row(scene);
    row.look_around(exact, walls, rows[i].patch, options.views);
    for (std::size_t j = 0; j < columns.size(); ++j) {
      ViewFactor& f = result.factors.entries[i * columns.size() + j];
      const StratifiedMean& mean = row.mean(columns[j].patch.patch);
      if (mean.value > 0.0 || (row.may_see(columns[j].patch.patch) && !is_zero(exact, rows[i], columns[j])))
        f = entry(mean, row, largest_factor(rows[i], columns[j]));
      judge(f, rows[i].area, columns[j].area, options.accuracy);
    }
    const auto set = [&](std::vector<ViewFactor>& of, std::size_t which) {
      if (of.empty()) return;
      of[i] = entry(row.beside(which), row, 1.0);
      judge(of[i], rows[i].area, 0.0, options.accuracy);
    };
    set(result.back, RowOfMeans::kBackColumn);
    set(result.open, RowOfMeans::kOpenColumn);
  });
  return result;
}

}  // namespace exactff::matrix
