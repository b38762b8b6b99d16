#include "report/tables.h"

#include <cctype>
#include <cmath>

#include "exactff/version.h"
#include "report/verdicts.h"
#include "text/csv_row.h"
#include "text/escape.h"
#include "text/phrases.h"

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

}  // namespace

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

namespace {

std::string on_name(const Study& study, const Receiver& receiver) { return study.request.scene->name_of(receiver.on); }

std::string column_name(std::string_view words) {
  std::string name(words);
  for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? static_cast<char>(std::tolower(c)) : '_';
  return name;
}

constexpr std::string_view kSettingColumns = "setting,variant,pattern,seed,eps_b,eps_a,rays_per_leaf";

// Setting numbers start at 1.
void put_setting(text::CsvRow& row, const Study& study, std::size_t k) {
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
      text::CsvRow(out) << receiver.id << on_name(study, receiver) << receiver.point << receiver.normal
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
      text::CsvRow row(out);
      row << receiver.id << on_name(study, receiver) << receiver.point << source;
      put_setting(row, study, k);
      row << exact.form_factor << sample.form_factor << sample.error << exact.radiosity.largest()
          << sample.radiosity_error << sample.leaves << sample.rays << sample.shaft_tests;
      for (std::uint64_t count : sample.leaves_by_reason) row << count;
      row << sample.silent_leaves << sample.wrong_leaves << sample.silent_error;
    }
  }
}

void put_statistics(text::CsvRow& row, const ErrorStatistics& s) { row << s.rms << s.mean << s.p99 << s.worst; }

void write_summary(const Study& study, std::ostream& out) {
  write_head(study, out, "summary");
  out << kSettingColumns
      << ",receivers,rms_f,mean_f,p99_f,worst_f,rms_radiosity,mean_radiosity,p99_radiosity,worst_radiosity,"
         "violations,share_violating,leaves,rays,silent_leaves,wrong_leaves,silent_receivers,rms_silent_f,worst_silent_"
         "f,"
         "not_a_number\n";
  for (std::size_t k = 0; k < study.settings.size(); ++k) {
    const Summary& summary = study.summaries[k];
    text::CsvRow row(out);
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
    text::CsvRow(out) << receiver.id << on << "exact" << study.exact[i].seconds;
    for (std::size_t k = 0; k < study.settings.size(); ++k) {
      const double seconds = study.samples[k][i].seconds;
      if (!std::isnan(seconds)) text::CsvRow(out) << receiver.id << on << std::uint64_t{k + 1} << seconds;
    }
  }
}

void put_times(text::CsvRow& row, const TimeSummary& t) {
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
    text::CsvRow row(out);
    put_setting(row, study, k);
    put_times(row, study.times[k]);
    put_times(row, study.exact_time);
  }
}

bool always(const Study&) { return true; }
bool has_settings(const Study& study) { return !study.settings.empty(); }

}  // namespace

const std::vector<StudyTable>& tables() {
  static const std::vector<StudyTable> kTables = [] {
    std::vector<StudyTable> list = {
        {"values.csv", "one row per receiver and setting: exact and approximate value, errors, work", write_values,
         has_settings},
        {"exact.csv", "one row per receiver and source: the certified value with its bounds", write_exact, always},
        {"summary.csv", "one row per setting: the error statistics", write_summary, has_settings},
        {"timings.csv", "one row per receiver that was timed and method: the time of a single call", write_timings,
         always, Holds::kTimes},
        {"summary_timings.csv", "one row per setting: time per receiver, and that of the exact method",
         write_summary_timings, has_settings, Holds::kTimes},
    };
    for (const StudyTable& table : method_tables()) list.push_back(table);
    return list;
  }();
  return kTables;
}

namespace {

std::string joined_names(const Scene& scene, std::span<const Selection> selections) {
  std::string names;
  for (const Selection& one : selections) names += (names.empty() ? "" : " + ") + scene.name_of(one);
  return names;
}

}  // namespace

std::string source_names(const Study& study) { return joined_names(*study.request.scene, study.request.sources); }

std::string flipped_names(const Study& study) {
  return joined_names(*study.request.scene, study.request.scene->flipped());
}

std::string transparent_names(const Study& study) {
  return joined_names(*study.request.scene, study.request.scene->transparent());
}

}  // namespace exactff::report
