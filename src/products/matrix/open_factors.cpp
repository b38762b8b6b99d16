#include "matrix/open_factors.h"

#include <algorithm>
#include <cstddef>

#include "kernel/float_environment.h"
#include "matrix/back_factors.h"

namespace exactff::matrix {
namespace {

constexpr std::size_t kMostPieces = 4096;  // of more, the rest is hardly known soon
constexpr double kLittle = 0.45;           // of a view that may be the faces', by a rough bound

// Of a row of which this share of the area is not buried, and sees this of the faces.
ViewFactor rest_of(const ViewFactor& faces, const kernel::Disc& exposed) {
  ViewFactor rest = faces;
  rest.area_to = 0.0;
  const bool is_whole = exposed.centre == 1.0 && exposed.radius == 0.0;
  const double most = is_whole ? 1.0 : std::min(1.0, upper_end(exposed));
  const double least = is_whole ? 1.0 : std::max(0.0, lower_end(exposed));
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

}  // namespace

// What rows see of faces, from either side.
class OpenFactors::Sides {
 public:
  Sides(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options)
      : made_(with_sides(scene)),
        columns_(columns_of(made_)),
        pairs_(made_.scene, of_any_scene(from), columns_, options, view_factors::Columns::kBacks) {}

  // About what the row would see if nothing were hidden; at most 1.
  [[nodiscard]] double unhidden(std::size_t row) const {
    return columns_.empty() ? 0.0 : pairs_.unhidden(row, column_of(row));
  }
  [[nodiscard]] ViewFactor of_row(std::size_t row) const {
    return columns_.empty() ? ViewFactor{} : factor_of(pairs_, row * columns_.size() + column_of(row));
  }

 private:
  enum Column : std::size_t { kAll, kClosedBacks, kOthers };
  [[nodiscard]] static std::vector<Selection> columns_of(const SceneWithSides& made) {
    if (!made.all) return {};
    if (!made.closed_backs) return {*made.all};
    return {*made.all, *made.closed_backs, *made.others};
  }
  // The fewest sides that are all that the row sees.
  [[nodiscard]] std::size_t column_of(std::size_t row) const {
    return columns_.size() > 1 && !pairs_.may_see(row, kClosedBacks) ? kOthers : kAll;
  }

  SceneWithSides made_;
  std::vector<Selection> columns_;
  view_factors::Pairs pairs_;
};

OpenFactors::OpenFactors(const Scene& scene, std::span<const Selection> from, const ViewFactorOptions& options,
                         const view_factors::Pairs& pairs)
    : scene_(scene),
      from_(from.begin(), from.end()),
      options_(as_one_direction(options)),
      pairs_(pairs),
      made_(with_sky(scene)),
      to_sky_(made_.scene, of_any_scene(from), std::span(&made_.sky, 1), options_,
              view_factors::Columns::kSurroundings) {
  std::vector<Selection> windows;
  for (const SceneWithSky::Window& window : made_.windows) windows.push_back(window.patch);
  if (windows.empty()) return;
  to_windows_.emplace(made_.scene, of_any_scene(from), windows, options_, view_factors::Columns::kWindows);
}

OpenFactors::~OpenFactors() = default;

const OpenFactors::Sides& OpenFactors::sides() const {
  std::call_once(sides_once_, [&] { sides_ = std::make_unique<const Sides>(scene_, from_, options_); });
  return *sides_;
}

ViewFactor OpenFactors::of_row(std::size_t row) const {
  if (pairs_.is_enclosed(row)) return {};
  for (std::size_t w = 0; w < made_.windows.size(); ++w) {
    if (pairs_.is_within(row, made_.windows[w].surface)) {
      return factor_of(*to_windows_, row * made_.windows.size() + w);
    }
  }
  const double most = pairs_.open_at_most(row);
  if (most <= options_.accuracy) return {.upper = most, .claim = Claim::kCertified};
  ViewFactor open = computed(row);
  for (double* bound : {&open.upper, &open.lower, &open.value}) *bound = std::min(*bound, most);
  return open;
}

ViewFactor OpenFactors::computed(std::size_t row) const {
  if (scene_.pieces().size() <= kMostPieces && sides().unhidden(row) < kLittle) {
    const ViewFactor rest = rest_of(sides().of_row(row), pairs_.exposed_share(row));
    if (rest.accurate) return rest;
    const ViewFactor to_sky = factor_of(to_sky_, row);
    return to_sky.upper - to_sky.lower < rest.upper - rest.lower ? to_sky : rest;
  }
  return factor_of(to_sky_, row);
}

}  // namespace exactff::matrix
