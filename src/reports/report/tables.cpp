// The values of a study as CSV tables, and for ParaView.
#include <cctype>
#include <cmath>

#include "exactff/version.h"
#include "report/report.h"
#include "study/settings.h"
#include "study/statistics.h"
#include "table/rows.h"
#include "text/phrases.h"
#include "vtk/vtk.h"

namespace exactff::report {
namespace {

using table::Columns;
using table::counts;
using table::keys;
using table::numbers;
using table::Rows;
using table::Strength;
using table::Table;
using table::texts;
using table::Type;

template <class List, class Text>
std::vector<std::string> listed(const List& list, const Text& text) {
  std::vector<std::string> texts;
  for (const auto& one : list) texts.emplace_back(text(one));
  return texts;
}

std::string joined_names(const Scene& scene, std::span<const Selection> selections) {
  std::string names;
  for (const Selection& one : selections) names += (names.empty() ? "" : " + ") + scene.name_of(one);
  return names;
}

// `holds`: as in the report's list of files.
table::Head head_of(const Study& study, std::string_view holds) {
  const study::Request& request = study.request;
  const Sweeps& sweeps = request.sweeps;
  const auto number = [](double v) { return text::shortest(v); };
  const auto whole = [](auto v) { return std::to_string(v); };
  const auto name = [](auto v) { return to_string(v); };
  table::Head head;
  head.set("about", std::string(holds));
  head.set("scene", request.scene_name);
  head.set("scene_hash", request.scene->hash());
  const auto set = [&](std::string_view word, std::vector<std::string> list) {
    if (!list.empty()) head.set(word, std::move(list));
  };
  const auto name_of = [&](const Selection& one) { return request.scene->name_of(one); };
  set("flipped", listed(request.scene->flipped(), name_of));
  set("transparent", listed(request.scene->transparent(), name_of));
  head.set("receivers", request.receivers_name);
  set("sources", listed(request.sources, name_of));
  set("warnings", receiver_warnings(study));
  if (sweeps.enabled) {
    set("eps_b", listed(sweeps.eps_b, number));
    set("eps_a", listed(sweeps.eps_a, number));
    set("rays", listed(sweeps.rays, whole));
    set("seeds", listed(sweeps.seeds, whole));
    set("patterns", listed(sweeps.patterns, name));
    set("variants", listed(sweeps.variants, name));
    head.set("settings", std::string(study.full_product ? "every combination" : "sweeps through a base"));
  }
  set("left_out", listed(study.left_out, [](const LeftOut& item) { return item.what + ": " + item.why; }));
  return head;
}

// --- the exact values, and the sweeps ---

std::string on_name(const Study& study, const Receiver& receiver) { return study.request.scene->name_of(receiver.on); }

std::string column_name(std::string_view words) {
  std::string name(words);
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? static_cast<char>(std::tolower(c)) : '_';
  return name;
}

Columns estimates(std::string_view names, std::string unit = {}) {
  return numbers(names, Strength::kEstimated, std::move(unit));
}
Columns certified(std::string_view names) { return numbers(names, Strength::kCertified); }
Columns place() { return numbers("x,y,z", Strength::kGiven, "length"); }
Columns setting() { return keys("setting", Type::kCount); }
Columns parameters() {
  const table::Column count{.name = {}, .type = Type::kCount};
  return table::joined({texts("variant,pattern"), table::columns("seed", count),
                        numbers("eps_b", Strength::kGiven, "Ke"), numbers("eps_a", Strength::kGiven, "area"),
                        table::columns("rays_per_leaf", count)});
}

// Setting numbers start at 1.
void put_setting(Rows& rows, const Study& study, std::size_t k) {
  const AdaptiveOptions& s = study.settings[k];
  rows << k + 1 << to_string(s.variant) << to_string(s.pattern) << s.seed << s.eps_b << s.eps_a << s.rays;
}

Table exact_table(const Study& study, table::Head head) {
  const Scene& scene = *study.request.scene;
  Rows rows(
      "compare exact", std::move(head),
      {keys("receiver"), texts("on"), place(), numbers("nx,ny,nz", Strength::kGiven, "of any length"), keys("source"),
       certified("exact"), numbers("lower,upper", Strength::kProved), texts("status,sight", Strength::kProved),
       certified("visible_fraction"), estimates("radiosity_r,radiosity_g,radiosity_b", "Ke")});
  for (std::size_t i = 0; i < study.exact.size(); ++i) {
    const Receiver& receiver = study.request.receivers[i];
    const Rgb rho = scene.receiver_reflectance(receiver.on);
    for (std::size_t s = 0; s < study.request.sources.size(); ++s) {
      const ExactTerm& term = study.exact[i].terms[s];
      const Rgb b = scene.source_radiosity(study.request.sources[s]);
      rows << receiver.id << on_name(study, receiver) << receiver.point << receiver.normal
           << scene.name_of(study.request.sources[s]) << term.value << term.lower << term.upper
           << to_string(term.status) << to_string(term.sight) << term.visible_fraction << rho.r * b.r * term.value
           << rho.g * b.g * term.value << rho.b * b.b * term.value;
    }
  }
  return rows.take();
}

Table value_table(const Study& study, table::Head head) {
  std::string reasons;
  for (std::size_t r = 0; r < kLeafReasonCount; ++r) {
    reasons += (r > 0 ? ",leaves_" : "leaves_") + column_name(to_string(static_cast<LeafReason>(r)));
  }
  Rows rows("compare values", std::move(head),
            {keys("receiver"), texts("on"), place(), texts("source"), setting(), parameters(), certified("exact"),
             estimates("approximate,error"), estimates("exact_radiosity,radiosity_error", "Ke"),
             counts("leaves,rays,shaft_tests"), counts(reasons), counts("silent_leaves,wrong_leaves"),
             estimates("silent_error")});
  const std::string source = source_names(study);
  for (std::size_t i = 0; i < study.exact.size(); ++i) {
    const Receiver& receiver = study.request.receivers[i];
    const ExactRow& exact = study.exact[i];
    for (std::size_t k = 0; k < study.settings.size(); ++k) {
      const SampleRow& sample = study.samples[k][i];
      rows << receiver.id << on_name(study, receiver) << receiver.point << source;
      put_setting(rows, study, k);
      rows << exact.form_factor << sample.form_factor << sample.error << exact.radiosity.largest()
           << sample.radiosity_error << sample.leaves << sample.rays << sample.shaft_tests;
      for (const std::uint64_t count : sample.leaves_by_reason) rows << count;
      rows << sample.silent_leaves << sample.wrong_leaves << sample.silent_error;
    }
  }
  return rows.take();
}

void put_statistics(Rows& rows, const ErrorStatistics& s) { rows << s.rms << s.mean << s.p99 << s.worst; }

Table summary_table(const Study& study, table::Head head) {
  Rows rows("compare summary", std::move(head),
            {setting(), parameters(), counts("receivers"), estimates("rms_f,mean_f,p99_f,worst_f"),
             estimates("rms_radiosity,mean_radiosity,p99_radiosity,worst_radiosity", "Ke"), counts("violations"),
             estimates("share_violating"), counts("leaves,rays,silent_leaves,wrong_leaves,silent_receivers"),
             estimates("rms_silent_f,worst_silent_f"), counts("not_a_number")});
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    const Summary& summary = study.summaries[k];
    put_setting(rows, study, k);
    rows << study.exact.size();
    put_statistics(rows, summary.form_factor);
    put_statistics(rows, summary.radiosity);
    rows << summary.violations << static_cast<double>(summary.violations) / static_cast<double>(study.exact.size())
         << summary.leaves << summary.rays << summary.silent_leaves << summary.wrong_leaves << summary.silent_receivers
         << summary.silent.rms << summary.silent.worst << summary.form_factor.not_a_number;
  }
  return rows.take();
}

Table timing_table(const Study& study, table::Head head) {
  Rows rows("compare timings", std::move(head),
            {keys("receiver"), texts("on"), keys("setting"), estimates("seconds", "s")});
  for (const std::size_t i : study.timed) {
    const Receiver& receiver = study.request.receivers[i];
    const std::string on = on_name(study, receiver);
    rows << receiver.id << on << "exact" << study.exact[i].seconds;
    for (std::size_t k = 0; k < study.settings.size(); ++k) {
      const double seconds = study.samples[k][i].seconds;
      if (!std::isnan(seconds)) rows << receiver.id << on << k + 1 << seconds;
    }
  }
  return rows.take();
}

void put_times(Rows& rows, const TimeSummary& t) { rows << t.median << t.mean << t.median_partly << t.mean_partly; }

Table summary_timing_table(const Study& study, table::Head head) {
  head.set("set_up_exact", study.exact_setup_seconds);
  head.set("set_up_rays", study.ray_setup_seconds);
  Rows rows("compare summary timings", std::move(head),
            {setting(), parameters(),
             estimates("median,mean,median_partly_hidden,mean_partly_hidden,exact_median,exact_mean,"
                       "exact_median_partly_hidden,exact_mean_partly_hidden",
                       "s")});
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    put_setting(rows, study, k);
    put_times(rows, study.times[k]);
    put_times(rows, study.exact_time);
  }
  return rows.take();
}

bool always(const Study&) { return true; }
bool has_settings(const Study& study) { return !study.settings.empty(); }

// --- the methods ---

bool has_cells(const Study& study) { return !study.methods.cells.empty(); }
bool has_fields(const Study& study) { return has_cells(study) && study.request.methods.enabled; }
bool has_profile(const Study& study) { return study.profile.has_value(); }

const methods::Choice& choice_of(const Study& study, std::size_t ladder, std::size_t rung) {
  return study.methods.ladders[ladder].rungs[rung];
}

void put_choice(Rows& rows, const Study& study, const MethodCell& cell) {
  const methods::Choice& choice = choice_of(study, cell.ladder, cell.rung);
  rows << choice.method->name << choice.settings.text();
}

Table method_table(const Study& study, table::Head head) {
  Rows rows("compare methods", std::move(head),
            {keys("method,setting"), counts("seeds,receivers"), estimates("work"),
             estimates("rms,mean,p99,worst,rms_partly_hidden,rms_visible", "Ke"), estimates("rms_over_brightest"),
             counts("not_a_number")});
  const double brightest = study::largest_radiosity(study);
  for (const MethodCell& cell : study.methods.cells) {
    put_choice(rows, study, cell);
    rows << cell.seeds.size() << study.methods.receivers.size() << cell.work;
    put_statistics(rows, cell.error);
    rows << cell.error_partly.rms << cell.error_visible.rms << (brightest > 0.0 ? cell.error.rms / brightest : 0.0)
         << cell.error.not_a_number;
  }
  return rows.take();
}

Table method_value_table(const Study& study, table::Head head) {
  Rows rows("compare method values", std::move(head),
            {keys("method,setting"), keys("seed", Type::kCount), keys("receiver"), certified("exact"),
             estimates("approximate,error"), estimates("radiosity_error", "Ke")});
  for (const MethodCell& cell : study.methods.cells) {
    for (std::size_t r = 0; r < study.methods.receivers.size(); ++r) {
      const std::size_t i = study.methods.receivers[r];
      const double exact = study.exact[i].form_factor, value = cell.values.front()[r];
      put_choice(rows, study, cell);
      rows << cell.seeds.front() << study.request.receivers[i].id << exact << value << value - exact
           << cell.radiosity_errors.front()[r];
    }
  }
  return rows.take();
}

Table slope_table(const Study& study, table::Head head) {
  Rows rows("compare slopes", std::move(head),
            {keys("method,where"), estimates("exponent,low,high"), counts("seeds,settings")});
  for (std::size_t l = 0; l < study.methods.ladders.size(); ++l) {
    const auto put = [&](const char* where, const std::optional<Slope>& slope) {
      if (!slope) return;
      rows << study.methods.ladders[l].name << where << slope->exponent << slope->low << slope->high << slope->seeds
           << slope->rungs;
    };
    put("partly hidden", study.methods.slopes[l].partly);
    put("visible", study.methods.slopes[l].visible);
  }
  return rows.take();
}

Table receiver_table(const Study& study, table::Head head) {
  Columns errors;
  for (const MethodField& field : study.methods.fields) {
    errors.push_back({choice_of(study, field.ladder, field.rung).text(), Type::kNumber, "Ke", Strength::kEstimated});
  }
  Rows rows("compare receivers", std::move(head),
            {keys("receiver"), place(), texts("sight", Strength::kProved), certified("visible_fraction"),
             estimates("radiosity", "Ke"), errors});
  for (std::size_t i = 0; i < study.exact.size(); ++i) {
    const ExactRow& exact = study.exact[i];
    rows << study.request.receivers[i].id << study.request.receivers[i].point << to_string(exact.sight)
         << exact.visible_fraction << exact.radiosity.largest();
    for (const MethodField& field : study.methods.fields) rows << field.radiosity_errors[i];
  }
  return rows.take();
}

Table profile_table(const Study& study, table::Head head) {
  const Profile& profile = *study.profile;
  head.set("along", profile.where);
  head.set("visibility_changes_at", listed(profile.kinks, [](double at) { return text::shortest(at); }));
  Columns curves;
  for (const Profile::Curve& curve : profile.others) {
    curves.push_back({curve.name, Type::kNumber, "Ke", Strength::kEstimated});
  }
  Columns position = numbers("position", Strength::kGiven, "length");
  position.front().key = true;
  Rows rows("compare profile", std::move(head), {position, place(), estimates("exact", "Ke"), curves});
  for (std::size_t i = 0; i < profile.receivers.size(); ++i) {
    rows << profile.position[i] << profile.receivers[i].point << profile.exact[i];
    for (const Profile::Curve& curve : profile.others) rows << curve.radiosity[i];
  }
  return rows.take();
}

Table method_timing_table(const Study& study, table::Head head) {
  if (const std::string drift = drift_warning(study); !drift.empty()) head.set("drift", drift);
  Rows rows("compare method timings", std::move(head),
            {keys("method,setting"), estimates("seconds,seconds_partly_hidden,seconds_set_up", "s"),
             estimates("times_exact,lower_quartile,upper_quartile")});
  for (const MethodCell& cell : study.methods.cells) {
    put_choice(rows, study, cell);
    rows << cell.seconds << cell.seconds_partly << study.methods.setup_seconds[cell.ladder]
         << cell.seconds / exact_seconds(study) << cell.ratio_low << cell.ratio_high;
  }
  return rows.take();
}

// --- ParaView ---

std::vector<vtk::SourceValues> exact_values(const Study& study) {
  const Scene& scene = *study.request.scene;
  std::vector<vtk::SourceValues> list;
  for (std::size_t s = 0; s < study.request.sources.size(); ++s) {
    const Rgb b = scene.source_radiosity(study.request.sources[s]);
    vtk::SourceValues& values = list.emplace_back();
    values.source = scene.name_of(study.request.sources[s]);
    for (std::size_t i = 0; i < study.exact.size(); ++i) {
      const ExactTerm& term = study.exact[i].terms[s];
      const Rgb rho = scene.receiver_reflectance(study.request.receivers[i].on);
      values.exact.push_back(term.value);
      values.lower.push_back(term.lower);
      values.upper.push_back(term.upper);
      values.status.push_back(static_cast<std::uint8_t>(term.status));
      values.visible_fraction.push_back(term.visible_fraction);
      values.radiosity.push_back({rho.r * b.r * term.value, rho.g * b.g * term.value, rho.b * b.b * term.value});
    }
  }
  return list;
}

// In the words of the method `adaptive`; "sweep" keeps the name apart from the same setting of that method.
std::string setting_words(const AdaptiveOptions& setting) {
  return "sweep:eps_B=" + text::shortest(setting.eps_b) + ",eps_A=" + text::shortest(setting.eps_a) +
         ",rays=" + std::to_string(setting.rays) + ",pattern=" + std::string(to_string(setting.pattern)) +
         ",variant=" + std::string(to_string(setting.variant)) + ",seed=" + std::to_string(setting.seed);
}

void add_setting(std::vector<vtk::Field>& fields, const std::string& name, std::vector<double> values,
                 const Study& study) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < values.size(); ++i) errors.push_back(values[i] - study.exact[i].form_factor);
  fields.push_back({"value " + name, 1, std::move(values)});
  fields.push_back({"error " + name, 1, std::move(errors)});
}

std::vector<vtk::Field> fields_of(const Study& study) {
  std::vector<vtk::Field> fields = vtk::fields_of(exact_values(study));
  if (study.request.sources.size() > 1) {
    std::vector<double> sums;
    for (const ExactRow& row : study.exact) sums.push_back(row.form_factor);
    fields.insert(fields.begin(), {"exact", 1, std::move(sums)});
  }
  for (const study::MethodField& field : study.methods.fields) {
    add_setting(fields, study.methods.ladders[field.ladder].rungs[field.rung].text(), field.form_factors, study);
  }
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    std::vector<double> values;
    for (const study::SampleRow& row : study.samples[k]) values.push_back(row.form_factor);
    add_setting(fields, setting_words(study.settings[k]), std::move(values), study);
  }
  return fields;
}

}  // namespace

table::Table StudyTable::make(const Study& study) const { return fill(study, head_of(study, holds)); }

const std::vector<StudyTable>& tables() {
  static const std::vector<StudyTable> kTables = {
      {"values.csv", "one row per receiver and setting: exact and approximate value, errors, work", value_table,
       has_settings},
      {"exact.csv", "one row per receiver and source: the certified value with its bounds", exact_table, always},
      {"summary.csv", "one row per setting: the error statistics", summary_table, has_settings},
      {"timings.csv", "one row per receiver that was timed and method: the time of a single call, one thread at work",
       timing_table, always},
      {"summary_timings.csv", "one row per setting: time per receiver, and that of the exact method",
       summary_timing_table, has_settings},
      {"methods.csv", "one row per method and setting at chosen receivers: work and errors in radiosity over the seeds",
       method_table, has_cells},
      {"method_values.csv", "the values of the first seed, receiver by receiver", method_value_table, has_cells},
      {"slopes.csv", "how the error falls with the work: error = c * work^exponent, with 95 % confidence intervals",
       slope_table, has_cells},
      {"receivers.csv", "one row per receiver: what it sees, and the radiosity error of each method's middle setting",
       receiver_table, has_fields},
      {"profile.csv", "the radiosity along a line, largest channel, exact and by other methods", profile_table,
       has_profile},
      {"method_timings.csv", "one row per method and setting: seconds per receiver and all sources, one thread at work",
       method_timing_table, has_cells},
  };
  return kTables;
}

std::string file_name(const SceneChapter& scene, const StudyTable& table) {
  return (scene.name.empty() ? std::string() : scene.name + '_') + std::string(table.file);
}

std::string source_names(const Study& study) { return joined_names(*study.request.scene, study.request.sources); }

std::string flipped_names(const Study& study) {
  return joined_names(*study.request.scene, study.request.scene->flipped());
}

std::string transparent_names(const Study& study) {
  return joined_names(*study.request.scene, study.request.scene->transparent());
}

void write_vtk(const Study& study, const std::filesystem::path& file, const Hooks& hooks) {
  const study::Request& request = study.request;
  std::vector<std::string> about = {text::program_version() + " compare",
                                    "scene: " + request.scene_name + ", hash " + request.scene->hash(),
                                    "receivers: " + request.receivers_name, "sources: " + source_names(study)};
  vtk::write({request.scene, request.receivers, fields_of(study), std::move(about)}, file, hooks);
}

}  // namespace exactff::report
