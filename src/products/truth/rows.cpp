#include "truth/rows.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "files/parallel.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "scene/scene.h"
#include "scene/selections.h"
#include "text/hashes.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::truth {
namespace {

// A hash of everything that the rows state about the receivers: a file of the same name may have changed.
std::string hash_of(const std::vector<Receiver>& receivers) {
  text::Fnv1a hash;
  for (const Receiver& receiver : receivers) {
    hash.add(receiver.point);
    hash.add(receiver.normal);
    for (const FaceId face : receiver.on) hash.add(std::uint64_t{index_of(face)});
    if (receiver.on.empty()) hash.add(~std::uint64_t{0});
    hash.add_bytes(receiver.id);
    hash.add(std::uint64_t{receiver.id.size()});
  }
  return hash.digits();
}

void require_measures(const std::vector<Measure>& measures) {
  std::array<bool, 3> has{};
  for (const Measure& measure : measures) {
    const bool both = measure.sphere && measure.kind != MeasureKind::kFormFactor;
    if (measure.is_form_factor() || both || std::exchange(has[measure_column(measure)], true)) {
      text::refuse("a measure is requested twice, or has no column",
                   "a row has the form factor, and once each: the solid angle, the overcast sky, the sphere",
                   "leave it out");
    }
    if (measure.kind == MeasureKind::kOvercast && (!kernel::is_finite(measure.up) || measure.up == Vec3{})) {
      text::refuse("the direction upwards is zero or not finite", "an overcast sky is brightest there",
                   "give three finite numbers that are not all 0");
    }
  }
}

Request completed(Request request) {
  require_scene(request.scene);
  if (request.receivers.empty()) {
    text::refuse("there are no receivers in " + request.receivers_name, "a truth file has a row for each receiver",
                 "use a finer grid or another patch");
  }
  if (request.sources.empty() && !request.sky) request.sources = request.scene->emitters();
  if (request.sources.empty() && !request.sky) {
    text::refuse(request.scene_name, "no patch emits", "a truth file has a row for each source",
                 "name a source with --source");
  }
  if (request.uv && !std::ranges::all_of(request.receivers, [](const Receiver& r) { return r.cell.has_value(); })) {
    text::refuse("the receivers have no u and v", "only the cells of a grid have coordinates on their lattice",
                 "make the receivers by --grid, or leave out --uv");
  }
  if (request.sky && request.visible_fraction) {
    text::refuse("the visible fraction of the sky is requested", "the sky has no area", "leave out --fraction, or sky");
  }
  if (request.sky && request.gradient) {
    text::refuse("the gradient of the sky is requested", "gradients are computed for patches",
                 "leave out --gradient, or sky");
  }
  if (request.radiosities && (!request.total || request.total == Quantity::kFormFactor)) {
    text::refuse("radiosities are given, but no quantity of light is requested", "they are for the totals of a row",
                 "add --total irradiance, radiance or radiosity");
  }
  require_measures(request.measures);
  jobs::require_shard(request.shard);
  if (request.threads <= 0) request.threads = files::usable_threads();
  return request;
}

const GridSize& size_of(const Receiver& receiver) { return receiver.cell->lattice->size; }
// Of the centre of a cell; from 0 to 1, correctly rounded.
double place_along(int cell, int cells) { return (2.0 * cell - 1.0) / (2.0 * cells); }

// True if it is on record that no occluder hides anything of what is above the horizon: F is then the same as without
// occluders.
bool nothing_in_the_shaft(const FormFactor& result) {
  return !result.planes.empty() &&
         std::all_of(result.planes.begin(), result.planes.end(), [](const PlaneRecord& plane) {
           return plane.outcome == Outcome::kUnoccluded || plane.outcome == Outcome::kReceiverFace ||
                  plane.outcome == Outcome::kBehind || plane.outcome == Outcome::kBelowHorizon;
         });
}

// Exact: whether the normal points away from the front of the receiver's first face.
whole_view::FaceSide side_of(const Scene& scene, const Receiver& receiver) {
  static constexpr Vec3 kOrigin;
  if (receiver.on.empty()) return whole_view::FaceSide::kFront;
  const Vec3& front = scene.face(receiver.on.front()).newell;
  return kernel::exact_sign_of_dot(front, {kOrigin, receiver.normal}) < 0 ? whole_view::FaceSide::kBack
                                                                          : whole_view::FaceSide::kFront;
}

class RowComputer : public Rows::Computer {
 public:
  explicit RowComputer(const Rows& rows) : rows_(rows) {}
  void append(std::uint64_t row, std::string& text) override {
    rows_.compute(row, results_);
    rows_.columns().append_csv(results_.row, text);
  }

 private:
  const Rows& rows_;
  Rows::Results results_;
};

}  // namespace

Rows::Rows(Request request) : request_(completed(std::move(request))), columns_of_request_(columns_of(request_)) {
  sources_ = std::make_unique<whole_view::SourceFactors>(
      *request_.scene, request_.sources, request_.sky ? whole_view::Sky::kLastSource : whole_view::Sky::kLeftOut);
  plan_ = {{.command = "truth"},
           request_.receivers.size() * sources_->count(),
           kChunkRows,
           request_.shard,
           request_.threads};
  for (std::size_t s = 0; s < sources_->count(); ++s) {
    source_names_.push_back(sources_->name_of(s));
    radiosities_.push_back(sources_->radiosity(s));
  }
  if (request_.radiosities) {
    gather_ = std::make_unique<radiosity::Gather>(*request_.scene, *request_.radiosities, request_.scene_name);
  } else if (request_.total) {
    light_.emplace(*sources_,
                   whole_view::light_weights(*request_.scene, *sources_, *request_.total, request_.scene_name));
  }
  columns_ = columns_of_request_.columns();
  measures_ = request_.measures;
  std::stable_partition(measures_.begin(), measures_.end(), [](const Measure& measure) { return !measure.sphere; });
  describe(sentences(near_misses(*request_.scene, request_.receivers), request_.receivers.size()));
}

void Rows::describe(const std::vector<std::string>& near_misses) {
  const Scene& scene = *request_.scene;
  const auto set_names = [&](const char* key, const std::vector<Selection>& selections) {
    if (!selections.empty()) about_.set(key, names_of(scene, selections));
  };
  about_.set("scene", request_.scene_name);
  about_.set("scene_hash", scene.hash());
  set_names("flipped", scene.flipped());
  set_names("transparent", scene.transparent());
  about_.set("receivers", request_.receivers_name);
  about_.set("receivers_hash", hash_of(request_.receivers));
  about_.set("sources", source_names_);
  if (!near_misses.empty()) about_.set("warnings", near_misses);
  for (const Measure& measure : request_.measures) {
    if (measure.kind != MeasureKind::kOvercast) continue;
    about_.set("up",
               text::shortest(measure.up.x) + ' ' + text::shortest(measure.up.y) + ' ' + text::shortest(measure.up.z));
  }
  if (request_.total) {
    about_.set("total", std::string(to_string(*request_.total)));
    about_.set("total_of", std::string(gather_ ? "all patches, with their radiosities" : "all sources"));
    about_.set("ke", std::string(request_.ke == KeMeans::kRadiance ? "radiance" : "radiosity"));
  }
  if (!gather_) return;
  about_.set("radiosities", request_.radiosities->name);
  about_.set("radiosities_hash", radiosity::hash_of(*request_.radiosities));
  // total_lower and total_upper bound the sum over patches of form factor and radiosity, one number for each patch; not
  // the light that varies over patches.
  about_.set("radiosities_claim", radiosity::words_of_claim(*request_.radiosities));
}

void Rows::compute(std::uint64_t number_of_row, Results& results) const {
  const std::size_t number = number_of_row / sources_->count(), source = number_of_row % sources_->count();
  const Receiver& receiver = request_.receivers[number];
  const FormFactor& f = factor(number, source, results);
  Row& row = results.row;
  row.receiver = id(number);
  row.on = request_.scene->name_of(receiver.on);
  row.point = receiver.point;
  row.normal = receiver.normal;
  if (request_.unit_normals) row.unit_normal = results.unit_normal.of(receiver.normal);
  if (request_.uv) {
    row.u = place_along(receiver.cell->column, size_of(receiver).u);
    row.v = place_along(receiver.cell->row, size_of(receiver).v);
  }
  row.source = source_names_[source];
  row.exact = f.value;
  row.lower = f.lower;
  row.upper = f.upper;
  row.status = f.status;  // a row is only as good as its worst value
  const auto keep_worst = [&](bool certified) { row.status = certified ? row.status : Status::kNotCertified; };
  if (request_.visible_fraction) row.visible_fraction = f.visible_fraction.value_or(0.0);
  for (const Measure& measure : measures_) {  // before other searches: they read what was found
    const FormFactor& measured = find_measure(number, source, measure, results);
    row.measures[measure_column(measure)] = measured.value;
    keep_worst(measured.status != Status::kNotCertified);
  }
  if (request_.unoccluded) {
    const FormFactor& free = without_occluders(receiver, source, f, results);
    row.unoccluded = free.value;
    row.unoccluded_status = free.status;
    keep_worst(free.status != Status::kNotCertified);
  }
  if (request_.gradient) {
    row.kink = f.gradient->kink.has_value();
    const auto& [x, y, z] = f.gradient->position;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    row.gradient = row.kink ? Vec3{kNone, kNone, kNone} : Vec3{x.value, y.value, z.value};
    row.gradient_status = {x.status, y.status, z.status};
  }
  const Rgb rho = request_.scene->receiver_reflectance(receiver.on), b = radiosities_[source];
  row.radiosity = {rho.r * b.r * f.value, rho.g * b.g * f.value, rho.b * b.b * f.value};
  row.largest_rho_b = std::max({rho.r * b.r, rho.g * b.g, rho.b * b.b});
  if (!has_totals()) return;
  const auto& [red, green, blue] = results.totals;
  row.total = {red.value, green.value, blue.value};
  row.total_lower = {red.lower, green.lower, blue.lower};
  row.total_upper = {red.upper, green.upper, blue.upper};
  keep_worst(red.certified && green.certified && blue.certified);
}

std::unique_ptr<Rows::Computer> Rows::computer() const { return std::make_unique<RowComputer>(*this); }

ExactOptions Rows::options_of_factors() const {
  return {.engine = request_.engine, .visible_fraction = request_.visible_fraction, .gradient = request_.gradient};
}

const FormFactor& Rows::factor(std::size_t receiver, std::size_t source, Results& results) const {
  const ExactOptions options = options_of_factors();
  if (!has_totals() && !sources_->sweeps(options)) {
    sources_->find_one(request_.receivers[receiver], source, options, results.exact, results.all.at);
    return results.exact;
  }
  if (results.known != receiver) find_all(receiver, options, results);
  return results.all.at.factors[source];
}

const FormFactor& Rows::find_measure(std::size_t receiver, std::size_t source, const Measure& measure,
                                     Results& results) const {
  const Receiver& at = request_.receivers[receiver];
  const ExactOptions options{.engine = request_.engine, .measure = measure};
  Results::Measured& found = results.measured[measure_column(measure)];
  const bool reads_found = !has_totals() && !measure.sphere && request_.engine != Engine::kBoth;
  if (reads_found && !sources_->sweeps(options_of_factors())) {
    sources_->measure_one(at, source, options, found.one, results.all.at);
    return found.one;
  }
  if (!sources_->sweeps(options)) {
    sources_->find_one(at, source, options, found.one, results.all.at);
    return found.one;
  }
  if (found.known != receiver) {
    if (reads_found) {
      sources_->measure_all(at, options, found.all, results.all.at);
    } else {
      sources_->find_all(at, options, found.all, results.all.at);
    }
  }
  found.known = receiver;
  return found.all[source];
}

// Those of the sources come with their form factors.
void Rows::find_totals(const Receiver& at, const ExactOptions& options, Results& results) const {
  whole_view::LightFormula formula =
      whole_view::light_formula(*request_.scene, at.on, side_of(*request_.scene, at), *request_.total, request_.ke);
  if (buried_under(*request_.scene, at)) formula.emitted = {};
  results.totals =
      gather_ ? gather_->at(at, formula, {.engine = request_.engine}, radiosity::GatherBounds::kAll, results.gathered)
              : light_->at(at, formula, options, results.all);
}

// Sets the totals, too, if they are requested.
void Rows::find_all(std::size_t receiver, const ExactOptions& options, Results& results) const {
  const Receiver& at = request_.receivers[receiver];
  results.known.reset();
  if (!light_) sources_->find_all(at, options, results.all.at);
  if (has_totals()) find_totals(at, options, results);
  results.known = receiver;
}

const FormFactor& Rows::without_occluders(const Receiver& receiver, std::size_t source, const FormFactor& with,
                                          Results& results) const {
  static const std::vector<FaceId> kNone;
  if (nothing_in_the_shaft(with)) return with;
  if (sources_->is_sky(source)) {
    results.unoccluded.value = 1.0;
    results.unoccluded.status = Status::kCertified;
    return results.unoccluded;
  }
  const ExactOptions options{.engine = request_.engine, .only_occluders = &kNone};
  sources_->find_one(receiver, source, options, results.unoccluded, results.all.at);
  return results.unoccluded;
}

std::string Rows::id(std::size_t receiver) const {
  const std::string& given = request_.receivers[receiver].id;
  return given.empty() ? std::to_string(receiver + 1) : given;
}

std::string Rows::name(std::uint64_t row) const {
  const std::size_t receiver = row / sources_->count();
  const std::vector<FaceId>& on = request_.receivers[receiver].on;
  return "receiver '" + id(receiver) + "'" + (on.empty() ? "" : " on '" + request_.scene->name_of(on) + "'") +
         ", source '" + source_names_[row % sources_->count()] + "'";
}

void Tally::add(std::string_view text) {
  for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
    const std::string_view line = open_.empty() ? text.substr(0, end) : std::string_view(open_.append(text, 0, end));
    const std::string_view status = line.substr(line.rfind(',') + 1);
    for (const Status one : {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified}) {
      if (status == to_string(one)) ++by_status_[static_cast<std::size_t>(one)];
    }
    open_.clear();
    text.remove_prefix(end + 1);
  }
  open_ += text;
}

}  // namespace exactff::truth
