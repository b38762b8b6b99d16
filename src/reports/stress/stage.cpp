#include "stress/stage.h"

#include <algorithm>
#include <utility>

namespace exactff::stress {

using kernel::to_rational;

void Stage::add(std::string_view patch, const std::vector<std::vector<Vec3>>& rings) {
  std::vector<std::vector<std::uint32_t>> indices;
  for (const std::vector<Vec3>& ring : rings) {
    std::vector<std::uint32_t>& one = indices.emplace_back();
    for (const Vec3& corner : ring) one.push_back(builder_.add_vertex(corner));
  }
  builder_.add_face(builder_.patch(patch), material_, std::move(indices));
}

std::vector<Vec3> Stage::level_ring(const Span& x, const Span& y, double z) {
  return {{x.low, y.low, z}, {x.low, y.high, z}, {x.high, y.high, z}, {x.high, y.low, z}};
}

void Stage::add_level_source(const Span& x, const Span& y, double z) { add_source(level_ring(x, y, z)); }
void Stage::add_level_occluder(const Span& x, const Span& y, double z) { add_occluder(level_ring(x, y, z)); }

void Stage::add_slat(const ProfilePoint& from, const ProfilePoint& to, const Span& y) {
  add_occluder({{from.x, y.low, from.z}, {from.x, y.high, from.z}, {to.x, y.high, to.z}, {to.x, y.low, to.z}});
}

Case Stage::finish(double stiffness, std::optional<ClosedForm> truth) {
  return {stiffness, builder_.build(), {.point = point_, .normal = normal_, .on = {}, .id = {}}, std::move(truth)};
}

Rational LevelView::project(double u, double origin, double z) const {
  return (to_rational(u) - to_rational(origin)) * distance_ / (to_rational(z) - to_rational(x_.z));
}

Interval LevelView::shadow(const ProfilePoint& from, const ProfilePoint& to) const {
  const Rational a = along_x(from.x, from.z), b = along_x(to.x, to.z);
  return {std::min(a, b), std::max(a, b)};
}

Rectangle LevelView::shadow(const Span& x, const Span& y, double z) const {
  return {2, distance_, {along_x(x.low, z), along_x(x.high, z)}, {along_y(y.low, z), along_y(y.high, z)}};
}

Rectangle intersection(const Rectangle& a, const Rectangle& b) {
  return {a.axis, a.distance, intersection(a.u, b.u), intersection(a.v, b.v)};
}

ClosedForm left_by_strips(const Vec3& normal, const Rectangle& source, std::vector<Interval> shadows) {
  std::sort(shadows.begin(), shadows.end(), [](const Interval& a, const Interval& b) { return a.low < b.low; });
  ClosedForm form(normal);
  Interval gap{source.u.low, source.u.low};
  const auto close_gap_at = [&](const Rational& end) {
    gap.high = std::min(end, source.u.high);
    form.add({source.axis, source.distance, gap, source.v});
  };
  for (const Interval& shadow : shadows) {
    close_gap_at(shadow.low);
    gap.low = std::max(gap.low, shadow.high);
  }
  close_gap_at(source.u.high);
  return form;
}

Case plate_before_source(double stiffness, const PlateBeforeSource& p) {
  Stage stage(p.point, p.normal);
  stage.add_level_source(p.source_x, p.source_y, p.source_z);
  stage.add_level_occluder(p.plate_x, p.plate_y, p.plate_z);
  const LevelView view(p.point, p.source_z);
  const Rectangle source = view.shadow(p.source_x, p.source_y, p.source_z);
  ClosedForm truth(p.normal);
  truth.add(source);
  truth.add(intersection(source, view.shadow(p.plate_x, p.plate_y, p.plate_z)), -1);
  return stage.finish(stiffness, std::move(truth));
}

}  // namespace exactff::stress
