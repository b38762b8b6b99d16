#include "experiments/support.h"

#include <algorithm>
#include <cmath>
#include <locale>

#include "exactff/models.h"
#include "exactff/view.h"
#include "files/stopwatch.h"
#include "kernel/expect.h"
#include "kernel/statistics.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::experiments {

KarkanisScene karkanis_scene(int triangles, std::uint64_t seed) {
  Scene scene = models::make_scene("karkanis:n=" + std::to_string(triangles) + ",floor=0,seed=" + std::to_string(seed));
  std::vector<Selection> sources;
  const Selection all = scene.select("occ");
  for (const FaceId face : scene.faces_of(all)) sources.push_back({all.patch, face});
  return {std::move(scene), {.point = {0, 0, 0}, .normal = {0, 0, 1}, .on = {}, .id = {}}, std::move(sources)};
}

void SmallScene::add(std::string_view patch, const std::vector<Vec3>& ring) {
  std::vector<std::uint32_t> corners;
  for (const Vec3& corner : ring) corners.push_back(builder_.add_vertex(corner));
  builder_.add_face(builder_.patch(patch), material_, {corners});
}

Bench::Bench(const methods::Choice& choice, const Scene& scene, std::span<const Selection> sources)
    : prepared_(*choice.method, scene, sources),
      evaluator_(prepared_.scene->configure(choice.settings)),
      estimates_(sources.size()) {}

std::span<const methods::Estimate> Bench::look_from(const Receiver& receiver) {
  evaluator_->look_from(receiver);
  evaluator_->form_factors(prepared_.sources, estimates_);
  return estimates_;
}

std::vector<double> values_of(std::string_view choice, const Scene& scene, const Receiver& receiver,
                              std::span<const Selection> sources) {
  Bench bench(methods::parse(choice), scene, sources);
  std::vector<double> values;
  for (const methods::Estimate& estimate : bench.look_from(receiver)) values.push_back(estimate.form_factor);
  return values;
}

std::vector<double> exact_values(const Scene& scene, const Receiver& receiver, std::span<const Selection> faces) {
  std::vector<double> of_face(scene.faces().size());
  for (const SeenPatch& seen : view(scene, receiver, {.faces = true}).patches) {
    of_face[index_of(*seen.face)] = seen.form_factor.value;
  }
  std::vector<double> values;
  for (const Selection& face : faces) values.push_back(of_face[index_of(face.face.value())]);
  return values;
}

std::vector<ExactSource> exact_sources(const Scene& scene, std::span<const Selection> sources) {
  std::vector<ExactSource> exact;
  exact.reserve(sources.size());
  for (const Selection& source : sources) exact.emplace_back(scene, source);
  return exact;
}

double root_mean_square(std::span<const double> errors) { return study::error_statistics(errors).rms; }

double median_seconds(const std::function<void()>& call, std::size_t repeats) {
  constexpr double kLong = 1.0;
  const double first = files::seconds_of(call);
  return first > kLong ? first : files::median_seconds(call, repeats, kLong);
}

SlopeFit mean_slope(std::span<const double> slopes) {
  EXACTFF_EXPECT(slopes.size() >= 2);
  return {kernel::mean(slopes), kernel::mean_half_width(slopes), slopes.size()};
}

std::string to_text(const SlopeFit& fit) { return slope_text(fit.slope) + " ± " + slope_text(fit.half_width); }

std::string slope_text(double slope) {
  const long hundredths = std::lround(std::abs(slope) * 100.0);
  const std::string digits = std::to_string(100 + hundredths % 100).substr(1);
  return (slope < 0.0 && hundredths > 0 ? "−" : "") + std::to_string(hundredths / 100) + '.' + digits;
}

void ErrorCurve::add_place(double place, const std::vector<std::vector<double>>& by_group) {
  std::vector<double> all;
  rms_by_group.resize(by_group.size());
  for (std::size_t group = 0; group < by_group.size(); ++group) {
    rms_by_group[group].push_back(root_mean_square(by_group[group]));
    all.insert(all.end(), by_group[group].begin(), by_group[group].end());
  }
  at.push_back(place);
  rms.push_back(root_mean_square(all));
  for (double& error : all) error = std::abs(error);
  median.push_back(kernel::median(all));
  p95.push_back(kernel::percentile(std::move(all), 95.0));
}

Points ErrorCurve::points() const {
  Points list;
  for (std::size_t i = 0; i < at.size(); ++i) list.emplace_back(at[i], rms[i]);
  return list;
}

SlopeFit ErrorCurve::slope(double last) const {
  std::vector<double> slopes;
  for (const std::vector<double>& group : rms_by_group) {
    Points points;
    for (std::size_t i = 0; i < at.size() && at[i] <= last; ++i) points.emplace_back(at[i], group[i]);
    if (const auto slope = kernel::fitted_slope(points)) slopes.push_back(*slope);
  }
  return mean_slope(slopes);
}

std::optional<double> reaches(const Points& points, double y) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [x0, y0] = points[i - 1];
    const auto& [x1, y1] = points[i];
    if (!(y0 > 0.0 && y0 < y && y1 >= y)) continue;
    return x0 * std::pow(x1 / x0, std::log(y / y0) / std::log(y1 / y0));
  }
  return std::nullopt;
}

std::string percent(double share) { return text::rounded(100.0 * share, 2) + " %"; }

TableWriter::TableWriter(std::string_view about, std::initializer_list<std::string_view> columns) {
  out_.imbue(std::locale::classic());
  std::string_view rest = about;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    out_ << "# " << rest.substr(0, end) << '\n';
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  text::CsvRow names(out_);
  for (const std::string_view name : columns) names << name;
}

CsvFile TableWriter::finish(std::string file, std::string holds) const {
  return {std::move(file), std::move(holds), out_.str()};
}

std::vector<double> geometric(double first, double last, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(first * std::pow(last / first, i / static_cast<double>(count - 1)));
  return values;
}

}  // namespace exactff::experiments
