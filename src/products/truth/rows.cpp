#include "truth/rows.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <sstream>
#include <string_view>

#include "exactff/version.h"
#include "files/parallel.h"
#include "kernel/numbers.h"
#include "scene/scene.h"
#include "text/csv_row.h"
#include "text/escape.h"
#include "text/hashes.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::truth {
namespace {

constexpr std::array kStatuses = {Status::kCertified, Status::kZero, Status::kUnderflow, Status::kNotCertified};

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

void complete(Request& request) {
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
  jobs::require_shard(request.shard);
  if (request.threads <= 0) request.threads = files::usable_threads();
}

}  // namespace

Rows::Rows(Request request) : request_(std::move(request)) {
  complete(request_);
  sources_ = std::make_unique<whole_view::SourceFactors>(
      *request_.scene, request_.sources, request_.sky ? whole_view::Sky::kLastSource : whole_view::Sky::kLeftOut);
  plan_ = {kKind, request_.receivers.size() * sources_->count(), kChunkRows, request_.shard, request_.threads};
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
  receivers_hash_ = hash_of(request_.receivers);
  near_misses_ = sentences(near_misses(*request_.scene, request_.receivers), request_.receivers.size());
}

namespace {

std::string names_line(const Scene& scene, const std::string& key, const std::vector<Selection>& selections) {
  std::string line;
  for (const Selection& one : selections)
    line += (line.empty() ? "# " + key + ": " : " + ") + text::csv_comment(scene.name_of(one));
  return line.empty() ? line : line + '\n';
}

std::string changes_of(const Scene& scene) {
  return names_line(scene, "flipped", scene.flipped()) + names_line(scene, "transparent", scene.transparent());
}

}  // namespace

std::string Rows::head() const {
  const Scene& scene = *request_.scene;
  std::ostringstream out;
  out << "# exactff " << kVersion << " truth: form factors, correctly rounded, between proved bounds\n"
      << "# scene: " << text::csv_comment(request_.scene_name) << ", hash " << scene.hash() << '\n'
      << changes_of(scene) << "# receivers: " << text::csv_comment(request_.receivers_name) << ", hash "
      << receivers_hash_ << '\n'
      << "# sources: ";
  for (std::size_t s = 0; s < source_names_.size(); ++s)
    out << (s > 0 ? " + " : "") << text::csv_comment(source_names_[s]);
  out << '\n'
      << rows_line(plan_)
      << "# units: form factors are pure numbers, radiosity is in the unit of Ke, lengths are in the unit of the "
         "scene\n"
      << "# normals: nx,ny,nz are exact and of any length; --unit-normals adds unit vectors\n"
      << shard_line(plan_);
  for (const std::string& sentence : near_misses_) out << "# warning: " << text::csv_comment(sentence) << '\n';
  if (request_.unit_normals) {
    out << "# unit normals: ux,uy,uz is nx,ny,nz scaled to length 1, correctly rounded; the values belong to "
           "nx,ny,nz\n";
  }
  if (request_.gradient) {
    out << "# gradient: dF_dx,dF_dy,dF_dz are the derivatives of the form factor by the receiver's point, correctly "
           "rounded, per unit of length; empty at a kink, where they do not exist\n";
  }
  if (request_.total) {
    out << "# total: " << to_string(*request_.total) << ", in " << unit_of(*request_.total, request_.ke)
        << (gather_ ? ", of all patches together, with their radiosities" : ", of all sources together")
        << ", correctly rounded; Ke is a " << (request_.ke == KeMeans::kRadiance ? "radiance" : "radiosity") << '\n';
  }
  if (gather_) {
    out << "# radiosities: " << text::csv_comment(request_.radiosities->name) << ", hash "
        << radiosity::hash_of(*request_.radiosities)
        << "; total_lower and total_upper bound the sum over patches of form factor and radiosity, one number for each "
           "patch; not the light that varies over patches; "
        << radiosity::words_of_claim(*request_.radiosities) << '\n';
  }
  out << "receiver,on,x,y,z,nx,ny,nz" << (request_.unit_normals ? ",ux,uy,uz" : "") << (request_.uv ? ",u,v" : "")
      << ",source,exact,lower,upper" << (request_.unoccluded ? ",unoccluded" : "")
      << (request_.visible_fraction ? ",visible_fraction" : "")
      << (request_.gradient ? ",dF_dx,dF_dy,dF_dz,gradient_status" : "")
      << ",radiosity_r,radiosity_g,radiosity_b,largest_rho_b" << (request_.total ? ",total_r,total_g,total_b" : "")
      << (gather_ ? ",total_lower_r,total_lower_g,total_lower_b,total_upper_r,total_upper_g,total_upper_b" : "")
      << ",status\n";
  return std::move(out).str();
}

namespace {

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

}  // namespace

namespace {

// The worst status of the three.
std::string_view status_of(const Gradient& gradient) {
  if (gradient.kink) return "kink";
  DerivativeStatus worst = DerivativeStatus::kZero;
  for (const DerivativeStatus status :
       {DerivativeStatus::kCertified, DerivativeStatus::kUnderflow, DerivativeStatus::kEnclosed}) {
    if (std::ranges::any_of(gradient.position, [&](const Derivative& d) { return d.status == status; })) worst = status;
  }
  return to_string(worst);
}

void append_gradient(const Gradient& gradient, text::CsvRow& line) {
  for (const Derivative& d : gradient.position) {
    if (gradient.kink) {
      line << std::string_view();
    } else if (d.value == 0.0 && d.status != DerivativeStatus::kZero) {
      line << "0.0";
    } else {
      line << d.value;
    }
  }
  line << status_of(gradient);
}

}  // namespace

void Rows::append(std::uint64_t row, std::string& lines, Results& results) const {
  const std::size_t number = row / sources_->count(), source = row % sources_->count();
  const Receiver& receiver = request_.receivers[number];
  const FormFactor& f = factor(number, source, results);
  Status status = f.status;  // a row is only as good as its worst value
  const auto keep_worst = [&](bool certified) { status = certified ? status : Status::kNotCertified; };
  text::CsvRow line(lines);
  line << id(number) << request_.scene->name_of(receiver.on) << receiver.point << receiver.normal;
  if (request_.unit_normals) line << results.unit_normal.of(receiver.normal);
  if (request_.uv) {
    line << place_along(receiver.cell->column, size_of(receiver).u)
         << place_along(receiver.cell->row, size_of(receiver).v);
  }
  line << source_names_[source] << f.value << f.lower << f.upper;
  if (request_.unoccluded) {
    const FormFactor& free = without_occluders(receiver, source, f, results);
    if (free.status == Status::kUnderflow) {
      line << "0.0";
    } else {
      line << free.value;
    }
    keep_worst(free.status != Status::kNotCertified);
  }
  if (request_.visible_fraction) line << f.visible_fraction.value_or(0.0);
  if (request_.gradient) append_gradient(*f.gradient, line);
  const Rgb rho = request_.scene->receiver_reflectance(receiver.on), b = radiosities_[source];
  line << rho.r * b.r * f.value << rho.g * b.g * f.value << rho.b * b.b * f.value
       << std::max({rho.r * b.r, rho.g * b.g, rho.b * b.b});
  if (has_totals()) {
    for (const whole_view::CertifiedNumber& total : results.totals) {
      line << total.value;
      keep_worst(total.certified);
    }
  }
  if (gather_) {
    for (const whole_view::CertifiedNumber& total : results.totals) line << total.lower;
    for (const whole_view::CertifiedNumber& total : results.totals) line << total.upper;
  }
  line << to_string(status);
}

bool Rows::may_be_text_of(jobs::Range range, std::string_view text) const { return Tally().add_rows(text, range.rows); }

namespace {

class RowComputer : public Rows::Computer {
 public:
  explicit RowComputer(const Rows& rows) : rows_(rows) {}
  void append(std::uint64_t row, std::string& text) override { rows_.append(row, text, results_); }

 private:
  const Rows& rows_;
  Rows::Results results_;
};

}  // namespace

std::unique_ptr<Rows::Computer> Rows::computer() const { return std::make_unique<RowComputer>(*this); }

const FormFactor& Rows::factor(std::size_t receiver, std::size_t source, Results& results) const {
  const ExactOptions options{
      .engine = request_.engine, .visible_fraction = request_.visible_fraction, .gradient = request_.gradient};
  if (!has_totals() && !sources_->sweeps(options)) {
    sources_->find_one(request_.receivers[receiver], source, options, results.exact, results.all.at);
    return results.exact;
  }
  if (results.known != receiver) find_all(receiver, options, results);
  return results.all.at.factors[source];
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
  constexpr std::size_t kLongestKept = 64;  // every status is shorter
  std::size_t field = 0;                    // start of the last field
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted_ = !quoted_;
    if (quoted_ || (c != ',' && c != '\n')) continue;
    if (c == '\n') end_row(field_.append(text.substr(field, i - field)));
    field_.clear();
    field = i + 1;
  }
  if (!text.empty()) row_open_ = quoted_ || text.back() != '\n';
  if (field_.size() < kLongestKept) field_ += text.substr(field, kLongestKept);
}

void Tally::end_row(std::string_view status) {
  const auto found = std::find_if(kStatuses.begin(), kStatuses.end(), [&](Status s) { return to_string(s) == status; });
  if (found == kStatuses.end()) {
    sound_ = false;
  } else {
    ++by_status_[static_cast<std::size_t>(*found)];
  }
}

bool Tally::add_rows(std::string_view text, std::uint64_t expected) {
  const std::uint64_t before = rows();
  add(text);
  return whole() && rows() - before == expected;
}

std::uint64_t Tally::rows() const { return std::accumulate(by_status_.begin(), by_status_.end(), std::uint64_t{0}); }

}  // namespace exactff::truth
