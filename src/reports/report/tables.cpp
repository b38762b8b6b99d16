// The values of a study as CSV tables, and for ParaView.
#include <cctype>
#include <cmath>

#include "exactff/version.h"
#include "report/report.h"
#include "report/verdicts.h"
#include "study/settings.h"
#include "study/statistics.h"
#include "table/csv.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "vtk/vtk.h"

namespace exactff::report {
namespace {

template <class List, class Text>
void write_list(std::ostream& out, std::string_view name, const List& list, const Text& text) {
  out << "# " << name << ": ";
  for (std::size_t i = 0; i < list.size(); ++i) out << (i > 0 ? "," : "") << text(list[i]);
  out << '\n';
}

void write_names(std::ostream& out, std::string_view name, std::string names) {
  if (!names.empty()) out << "# " << name << ": " << text::csv_comment(std::move(names)) << '\n';
}

std::string joined_names(const Scene& scene, std::span<const Selection> selections) {
  std::string names;
  for (const Selection& one : selections) names += (names.empty() ? "" : " + ") + scene.name_of(one);
  return names;
}

// The comment lines at the beginning of every file.
void write_head(const Study& study, std::ostream& out, std::string_view what) {
  const Sweeps& sweeps = study.request.sweeps;
  const auto number = [](double v) { return text::shortest(v); };
  const auto name = [](auto v) { return to_string(v); };
  out << "# " << text::program_version() << " compare: " << text::csv_comment(what) << '\n'
      << "# scene: " << text::csv_comment(study.request.scene_name) << ", hash " << study.request.scene->hash() << '\n';
  write_names(out, "flipped", flipped_names(study));
  write_names(out, "transparent", transparent_names(study));
  out << "# receivers: " << text::csv_comment(study.request.receivers_name) << '\n'
      << "# sources: " << text::csv_comment(source_names(study)) << '\n';
  for (const std::string& sentence : receiver_warnings(study)) {
    out << "# warning: " << text::csv_comment(sentence) << '\n';
  }
  if (sweeps.enabled) {
    write_list(out, "eps_B", sweeps.eps_b, number);
    write_list(out, "eps_A", sweeps.eps_a, number);
    write_list(out, "rays", sweeps.rays, [](int v) { return v; });
    write_list(out, "seeds", sweeps.seeds, [](std::uint64_t v) { return v; });
    write_list(out, "patterns", sweeps.patterns, name);
    write_list(out, "variants", sweeps.variants, name);
    out << "# settings: " << (study.full_product ? "every combination" : "sweeps through a base") << '\n';
  }
  for (const LeftOut& item : study.left_out) out << "# left out: " << item.what << ": " << item.why << '\n';
}

// --- the exact values, and the sweeps ---

std::string on_name(const Study& study, const Receiver& receiver) { return study.request.scene->name_of(receiver.on); }

std::string column_name(std::string_view words) {
  std::string name(words);
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? static_cast<char>(std::tolower(c)) : '_';
  return name;
}

constexpr std::string_view kSettingColumns = "setting,variant,pattern,seed,eps_b,eps_a,rays_per_leaf";

// Setting numbers start at 1.
void put_setting(table::CsvLine& row, const Study& study, std::size_t k) {
  const AdaptiveOptions& s = study.settings[k];
  row << std::uint64_t{k + 1} << to_string(s.variant) << to_string(s.pattern) << s.seed << s.eps_b << s.eps_a << s.rays;
}

void write_exact(const Study& study, std::ostream& out) {
  const Scene& scene = *study.request.scene;
  write_head(study, out, "exact values");
  out << "receiver,on,x,y,z,nx,ny,nz,source,exact,lower,upper,status,sight,visible_fraction,radiosity_r,radiosity_g,"
         "radiosity_b\n";
  for (std::size_t i = 0; i < study.exact.size(); ++i) {
    const Receiver& receiver = study.request.receivers[i];
    const Rgb rho = scene.receiver_reflectance(receiver.on);
    for (std::size_t s = 0; s < study.request.sources.size(); ++s) {
      const ExactTerm& term = study.exact[i].terms[s];
      const Rgb b = scene.source_radiosity(study.request.sources[s]);
      table::CsvLine(out) << receiver.id << on_name(study, receiver) << receiver.point << receiver.normal
                          << scene.name_of(study.request.sources[s]) << term.value << term.lower << term.upper
                          << to_string(term.status) << to_string(term.sight) << term.visible_fraction
                          << rho.r * b.r * term.value << rho.g * b.g * term.value << rho.b * b.b * term.value;
    }
  }
}

void write_values(const Study& study, std::ostream& out) {
  write_head(study, out, "values");
  out << "receiver,on,x,y,z,source," << kSettingColumns
      << ",exact,approximate,error,exact_radiosity,radiosity_error,leaves,rays,shaft_tests";
  for (std::size_t r = 0; r < kLeafReasonCount; ++r) {
    out << ",leaves_" << column_name(to_string(static_cast<LeafReason>(r)));
  }
  out << ",silent_leaves,wrong_leaves,silent_error\n";
  const std::string source = source_names(study);
  for (std::size_t i = 0; i < study.exact.size(); ++i) {
    const Receiver& receiver = study.request.receivers[i];
    const ExactRow& exact = study.exact[i];
    for (std::size_t k = 0; k < study.settings.size(); ++k) {
      const SampleRow& sample = study.samples[k][i];
      table::CsvLine row(out);
      row << receiver.id << on_name(study, receiver) << receiver.point << source;
      put_setting(row, study, k);
      row << exact.form_factor << sample.form_factor << sample.error << exact.radiosity.largest()
          << sample.radiosity_error << sample.leaves << sample.rays << sample.shaft_tests;
      for (std::uint64_t count : sample.leaves_by_reason) row << count;
      row << sample.silent_leaves << sample.wrong_leaves << sample.silent_error;
    }
  }
}

void put_statistics(table::CsvLine& row, const ErrorStatistics& s) { row << s.rms << s.mean << s.p99 << s.worst; }

void write_summary(const Study& study, std::ostream& out) {
  write_head(study, out, "summary");
  out << kSettingColumns
      << ",receivers,rms_f,mean_f,p99_f,worst_f,rms_radiosity,mean_radiosity,p99_radiosity,worst_radiosity,"
         "violations,share_violating,leaves,rays,silent_leaves,wrong_leaves,silent_receivers,rms_silent_f,worst_silent_"
         "f,"
         "not_a_number\n";
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    const Summary& summary = study.summaries[k];
    table::CsvLine row(out);
    put_setting(row, study, k);
    row << std::uint64_t{study.exact.size()};
    put_statistics(row, summary.form_factor);
    put_statistics(row, summary.radiosity);
    row << std::uint64_t{summary.violations}
        << static_cast<double>(summary.violations) / static_cast<double>(study.exact.size()) << summary.leaves
        << summary.rays << summary.silent_leaves << summary.wrong_leaves << std::uint64_t{summary.silent_receivers}
        << summary.silent.rms << summary.silent.worst << std::uint64_t{summary.form_factor.not_a_number};
  }
}

void write_timings(const Study& study, std::ostream& out) {
  write_head(study, out, "time of single calls, one thread at work");
  out << "receiver,on,setting,seconds\n";
  for (const std::size_t i : study.timed) {
    const Receiver& receiver = study.request.receivers[i];
    const std::string on = on_name(study, receiver);
    table::CsvLine(out) << receiver.id << on << "exact" << study.exact[i].seconds;
    for (std::size_t k = 0; k < study.settings.size(); ++k) {
      const double seconds = study.samples[k][i].seconds;
      if (!std::isnan(seconds)) table::CsvLine(out) << receiver.id << on << std::uint64_t{k + 1} << seconds;
    }
  }
}

void put_times(table::CsvLine& row, const TimeSummary& t) {
  row << t.median << t.mean << t.median_partly << t.mean_partly;
}

void write_summary_timings(const Study& study, std::ostream& out) {
  write_head(study, out, "time per receiver, in seconds, one thread at work");
  out << "# set up once: exact " << text::shortest(study.exact_setup_seconds) << ", ray structure "
      << text::shortest(study.ray_setup_seconds) << '\n';
  out << kSettingColumns
      << ",median,mean,median_partly_hidden,mean_partly_hidden,exact_median,exact_mean,exact_median_partly_hidden,"
         "exact_mean_partly_hidden\n";
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    table::CsvLine row(out);
    put_setting(row, study, k);
    put_times(row, study.times[k]);
    put_times(row, study.exact_time);
  }
}

bool always(const Study&) { return true; }
bool has_settings(const Study& study) { return !study.settings.empty(); }

// --- the methods ---

bool has_cells(const Study& study) { return !study.methods.cells.empty(); }
bool has_fields(const Study& study) { return has_cells(study) && study.request.methods.enabled; }
bool has_profile(const Study& study) { return study.profile.has_value(); }

constexpr std::string_view kCellColumns = "method,setting";

const methods::Choice& choice_of(const Study& study, std::size_t ladder, std::size_t rung) {
  return study.methods.ladders[ladder].rungs[rung];
}

void put_choice(table::CsvLine& row, const methods::Choice& choice) {
  row << choice.method->name << choice.settings.text();
}

void write_methods(const Study& study, std::ostream& out) {
  write_head(study, out, "methods against one another at chosen receivers; errors in radiosity");
  out << kCellColumns
      << ",seeds,receivers,work,rms,mean,p99,worst,rms_partly_hidden,rms_visible,rms_over_brightest,not_a_number\n";
  const double brightest = study::largest_radiosity(study);
  for (const MethodCell& cell : study.methods.cells) {
    table::CsvLine row(out);
    put_choice(row, choice_of(study, cell.ladder, cell.rung));
    row << std::uint64_t{cell.seeds.size()} << std::uint64_t{study.methods.receivers.size()} << cell.work
        << cell.error.rms << cell.error.mean << cell.error.p99 << cell.error.worst << cell.error_partly.rms
        << cell.error_visible.rms << (brightest > 0.0 ? cell.error.rms / brightest : 0.0)
        << std::uint64_t{cell.error.not_a_number};
  }
}

void write_method_seeds(const Study& study, std::ostream& out) {
  write_head(study, out, "one row per method, setting and seed; errors in radiosity at the chosen receivers");
  out << kCellColumns << ",seed,rms,mean,p99,worst\n";
  for (const MethodCell& cell : study.methods.cells) {
    for (std::size_t s = 0; s < cell.seeds.size(); ++s) {
      const ErrorStatistics e = study::error_statistics(cell.radiosity_errors[s]);
      table::CsvLine row(out);
      put_choice(row, choice_of(study, cell.ladder, cell.rung));
      row << cell.seeds[s] << e.rms << e.mean << e.p99 << e.worst;
    }
  }
}

void write_method_values(const Study& study, std::ostream& out) {
  write_head(study, out, "one row per method, setting and chosen receiver, with the first seed");
  out << kCellColumns << ",seed,receiver,exact,approximate,error,radiosity_error\n";
  for (const MethodCell& cell : study.methods.cells) {
    for (std::size_t r = 0; r < study.methods.receivers.size(); ++r) {
      const std::size_t i = study.methods.receivers[r];
      const double exact = study.exact[i].form_factor, value = cell.values.front()[r];
      table::CsvLine row(out);
      put_choice(row, choice_of(study, cell.ladder, cell.rung));
      row << cell.seeds.front() << study.request.receivers[i].id << exact << value << value - exact
          << cell.radiosity_errors.front()[r];
    }
  }
}

void write_slopes(const Study& study, std::ostream& out) {
  write_head(study, out, "error = c * work^exponent, fitted over the settings of a method; 95 % confidence intervals");
  out << "method,where,exponent,low,high,seeds,settings\n";
  for (std::size_t l = 0; l < study.methods.ladders.size(); ++l) {
    const auto put = [&](const char* where, const std::optional<Slope>& slope) {
      if (!slope) return;
      table::CsvLine(out) << study.methods.ladders[l].name << where << slope->exponent << slope->low << slope->high
                          << std::uint64_t{slope->seeds} << std::uint64_t{slope->rungs};
    };
    put("partly hidden", study.methods.slopes[l].partly);
    put("visible", study.methods.slopes[l].visible);
  }
}

void write_fields(const Study& study, std::ostream& out) {
  write_head(study, out, "one row per receiver: what it sees, and the radiosity error of each method's middle setting");
  out << "receiver,x,y,z,sight,visible_fraction,radiosity,distance_to_shadow_edge";
  for (const MethodField& field : study.methods.fields) {
    out << ',' << text::csv_field(choice_of(study, field.ladder, field.rung).text());
  }
  out << '\n';
  for (std::size_t i = 0; i < study.exact.size(); ++i) {
    const ExactRow& exact = study.exact[i];
    table::CsvLine row(out);
    row << study.request.receivers[i].id << study.request.receivers[i].point << to_string(exact.sight)
        << exact.visible_fraction << exact.radiosity.largest();
    row << (study.edge_distance.empty() ? std::nullopt : std::optional(study.edge_distance[i]));
    for (const MethodField& field : study.methods.fields) row << field.radiosity_errors[i];
  }
}

void write_profile(const Study& study, std::ostream& out) {
  const Profile& profile = *study.profile;
  write_head(study, out, "radiosity along " + profile.where + ", largest channel");
  for (const double kink : profile.kinks)
    out << "# what is visible changes in kind at " << text::shortest(kink) << '\n';
  out << "position,x,y,z,exact";
  for (const Profile::Curve& curve : profile.others) out << ',' << text::csv_field(curve.name);
  out << '\n';
  for (std::size_t i = 0; i < profile.receivers.size(); ++i) {
    table::CsvLine row(out);
    row << profile.position[i] << profile.receivers[i].point << profile.exact[i];
    for (const Profile::Curve& curve : profile.others) row << curve.radiosity[i];
  }
}

void write_method_timings(const Study& study, std::ostream& out) {
  write_head(study, out, "seconds per receiver and all sources, one thread at work");
  if (const std::string drift = drift_warning(study); !drift.empty()) out << "# warning: " << drift << '\n';
  out << kCellColumns << ",seconds,seconds_partly_hidden,seconds_set_up,times_exact,lower_quartile,upper_quartile\n";
  for (const MethodCell& cell : study.methods.cells) {
    table::CsvLine row(out);
    put_choice(row, choice_of(study, cell.ladder, cell.rung));
    row << cell.seconds << cell.seconds_partly << study.methods.setup_seconds[cell.ladder]
        << cell.seconds / exact_seconds(study) << cell.ratio_low << cell.ratio_high;
  }
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

const std::vector<StudyTable>& tables() {
  static const std::vector<StudyTable> kTables = {
      {"values.csv", "one row per receiver and setting: exact and approximate value, errors, work", write_values,
       has_settings},
      {"exact.csv", "one row per receiver and source: the certified value with its bounds", write_exact, always},
      {"summary.csv", "one row per setting: the error statistics", write_summary, has_settings},
      {"timings.csv", "one row per receiver that was timed and method: the time of a single call", write_timings,
       always},
      {"summary_timings.csv", "one row per setting: time per receiver, and that of the exact method",
       write_summary_timings, has_settings},
      {"methods.csv", "one row per method and setting at chosen receivers: work and error statistics over the seeds",
       write_methods, has_cells},
      {"method_seeds.csv", "the same for every seed", write_method_seeds, has_cells},
      {"method_values.csv", "the values of the first seed, receiver by receiver", write_method_values, has_cells},
      {"slopes.csv", "how the error falls with the work, with confidence intervals", write_slopes, has_cells},
      {"receivers.csv", "one row per receiver: visibility of the source, and the error of each method", write_fields,
       has_fields},
      {"profile.csv", "the radiosity along a line, exact and by other methods", write_profile, has_profile},
      {"method_timings.csv", "one row per method and setting: seconds per receiver", write_method_timings, has_cells},
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
