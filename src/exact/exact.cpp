// Puts the exact method together: for each plane of the source the visible boundary, over all of them one contour
// integral, and its precision raised until the ball rounds to one double.
//
// A contour F > 0 is never a midpoint of two doubles unless it is rational. By Baker's theorem a rational F comes from
// rational relations among the angles and pi, and the factors n . (a x b) / (|n| |a x b|), where rational, have 2-adic
// valuation >= -1 (primitive integer vectors have squared lengths not divisible by 4). That no such combination has
// the 54 or more binary places of a midpoint is our belief, not a theorem; the cap on the precision makes it harmless.
#include "exactff/exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contour/contour.h"
#include "exact/fraction.h"
#include "exact/source_planes.h"
#include "visibility/visible_boundary.h"

namespace exactff {

using exact::PlaneShare;
using visibility::PlaneVisibility;
using visibility::SourcePlane;

ExactSource::ExactSource(const Scene& scene, const Selection& selection)
    : planes_(new Planes{selection, visibility::group_by_plane(scene, scene.faces_of(selection))}) {}
ExactSource::ExactSource(ExactSource&&) noexcept = default;
ExactSource& ExactSource::operator=(ExactSource&&) noexcept = default;
ExactSource::~ExactSource() = default;
const Selection& ExactSource::selection() const { return planes_->selection; }

namespace exact {

void check_receiver(const Receiver& receiver) {
  for (const Vec3& v : {receiver.point, receiver.normal}) {
    if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
    throw InputError({.what = "the receiver's point or normal is not finite",
                      .why = "a form factor needs a point and a direction",
                      .suggestion = "give three finite numbers for each"});
  }
  if (receiver.normal == Vec3{}) {
    throw InputError({.what = "the receiver's normal is (0, 0, 0)",
                      .why = "it has no direction, so there is no horizon to look above",
                      .suggestion = "give a normal of any length other than zero"});
  }
}

}  // namespace exact

namespace {

constexpr int kFirstBits = 96;  // enough for all but the near-degenerate

bool has_decimals(const Enclosure& enclosure, int digits) {
  return digits <= 0 || enclosure.decimals(digits).has_value();
}

// Raises the precision until the ball determines the double and the decimals asked for, or the cap is met. The status
// speaks of the double: decimals may stay undecided where F is a decimal tie, such as 1/8 to two digits.
void certify(const contour::ContourIntegral& contour, const ExactOptions& options, FormFactor& result) {
  for (int bits = std::min(kFirstBits, options.precision_cap);; bits = std::min(2 * bits, options.precision_cap)) {
    const Ball ball = contour.evaluate(bits);
    result.enclosure = Enclosure(ball);
    result.precision_bits = bits;
    const std::optional<double> nearest = result.enclosure.nearest();
    result.value = nearest ? *nearest : std::clamp(kernel::nearest_to_midpoint(ball), 0.0, 1.0);
    result.status = !nearest ? Status::kNotCertified : result.value == 0.0 ? Status::kUnderflow : Status::kCertified;
    if (nearest && has_decimals(result.enclosure, options.digits)) return;
    if (bits >= options.precision_cap) return;
  }
}

// At very few bits a ball may hold every number; its midpoint and ends then are none.
void set_bounds(FormFactor& result) {
  if (result.status == Status::kZero) return;  // [0, 0]
  const bool certified = result.status != Status::kNotCertified;
  const double below = certified ? std::nextafter(result.value, -1.0) : result.enclosure.lower();
  const double above = certified ? std::nextafter(result.value, 2.0) : result.enclosure.upper();
  result.lower = std::isnan(below) ? 0.0 : std::clamp(below, 0.0, 1.0);
  result.upper = std::isnan(above) ? 1.0 : std::clamp(above, 0.0, 1.0);
  if (std::isnan(result.value)) result.value = 0.5 * (result.lower + result.upper);
}

void note_fraction(PlaneVisibility& plane, const ExactOptions& options) {
  plane.record.visible_fraction = kernel::nearest_double(*plane.fraction);
  if (options.exact_fraction) plane.record.exact_fraction = kernel::to_string(*plane.fraction);
}

PlaneShare share_of(const Scene& scene, const SourcePlane& plane, const PlaneVisibility& seen) {
  visibility::ProjectedArea area = visibility::union_area(scene, plane);
  return {*seen.fraction, std::move(area.area), plane.normal.exact, area.axis};
}

// A source without area shows nothing of it.
void set_fraction(const std::vector<PlaneShare>& shares, FormFactor& result) {
  const auto all_are = [&](int whole) {
    return std::all_of(shares.begin(), shares.end(), [&](const PlaneShare& share) { return share.fraction == whole; });
  };
  result.visible_part = all_are(0) ? VisiblePart::kNothing : all_are(1) ? VisiblePart::kAll : VisiblePart::kSome;
  result.visible_fraction = shares.empty() ? 0.0 : exact::visible_fraction(shares);
}

void sort_unique(std::vector<FaceId>& faces) {
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
}

}  // namespace

FormFactor exact_form_factor(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                             const ExactOptions& options) {
  exact::check_receiver(receiver);
  const visibility::View view(scene, receiver);
  const bool wants_fraction = options.visible_fraction || options.exact_fraction;
  const visibility::Request request{
      .fraction = wants_fraction, .list_cutters = options.list_cutters, .only_occluders = options.only_occluders};
  contour::ContourIntegral contour(view.normal.exact);
  FormFactor result;
  std::vector<PlaneShare> shares;
  bool something_visible = false;
  for (const SourcePlane& plane : source.planes().planes) {
    PlaneVisibility seen = find_visible_boundary(view, plane, request);
    for (const visibility::BoundaryPiece& piece : seen.boundary) contour.add(piece);
    something_visible = something_visible || !seen.boundary.empty();
    if (wants_fraction) {
      note_fraction(seen, options);
      shares.push_back(share_of(scene, plane, seen));
    }
    result.cutters.insert(result.cutters.end(), seen.cutters.begin(), seen.cutters.end());
    result.planes.push_back(std::move(seen.record));
  }
  sort_unique(result.cutters);
  if (something_visible) certify(contour, options, result);
  set_bounds(result);
  if (wants_fraction) set_fraction(shares, result);
  return result;
}

bool behind_every_face(const FormFactor& result) {
  return !result.planes.empty() && std::all_of(result.planes.begin(), result.planes.end(),
                                               [](const PlaneRecord& p) { return p.outcome == Outcome::kBehind; });
}

}  // namespace exactff
