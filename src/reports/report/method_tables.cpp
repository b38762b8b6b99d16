#include "report/tables.h"
#include "report/verdicts.h"
#include "study/ladders.h"
#include "study/statistics.h"
#include "text/csv_row.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

bool has_cells(const Study& study) { return !study.methods.cells.empty(); }
bool has_fields(const Study& study) { return has_cells(study) && study.request.methods.enabled; }
bool has_profile(const Study& study) { return study.profile.has_value(); }

constexpr std::string_view kCellColumns = "method,setting";

const methods::Choice& choice_of(const Study& study, std::size_t ladder, std::size_t rung) {
  return study.methods.ladders[ladder].rungs[rung];
}

void put_choice(text::CsvRow& row, const methods::Choice& choice) {
  row << choice.method->name << choice.settings.text();
}

void write_methods(const Study& study, std::ostream& out) {
  write_head(study, out, "methods against one another at chosen receivers; errors in radiosity");
  out << kCellColumns
      << ",seeds,receivers,work,rms,mean,p99,worst,rms_partly_hidden,rms_visible,rms_over_brightest,not_a_number\n";
  const double brightest = study::largest_radiosity(study);
  for (const MethodCell& cell : study.methods.cells) {
    text::CsvRow row(out);
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
      text::CsvRow row(out);
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
      text::CsvRow row(out);
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
      text::CsvRow(out) << study.methods.ladders[l].name << where << slope->exponent << slope->low << slope->high
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
    text::CsvRow row(out);
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
    text::CsvRow row(out);
    row << profile.position[i] << profile.receivers[i].point << profile.exact[i];
    for (const Profile::Curve& curve : profile.others) row << curve.radiosity[i];
  }
}

void write_method_timings(const Study& study, std::ostream& out) {
  write_head(study, out, "seconds per receiver and all sources, one thread at work");
  if (const std::string drift = drift_warning(study); !drift.empty()) out << "# warning: " << drift << '\n';
  out << kCellColumns << ",seconds,seconds_partly_hidden,seconds_set_up,times_exact,lower_quartile,upper_quartile\n";
  for (const MethodCell& cell : study.methods.cells) {
    text::CsvRow row(out);
    put_choice(row, choice_of(study, cell.ladder, cell.rung));
    row << cell.seconds << cell.seconds_partly << study.methods.setup_seconds[cell.ladder]
        << cell.seconds / exact_seconds(study) << cell.ratio_low << cell.ratio_high;
  }
}

}  // namespace

const std::vector<StudyTable>& method_tables() {
  static const std::vector<StudyTable> kTables = {
      {"methods.csv", "one row per method and setting at chosen receivers: work and error statistics over the seeds",
       write_methods, has_cells},
      {"method_seeds.csv", "the same for every seed", write_method_seeds, has_cells},
      {"method_values.csv", "the values of the first seed, receiver by receiver", write_method_values, has_cells},
      {"slopes.csv", "how the error falls with the work, with confidence intervals", write_slopes, has_cells},
      {"receivers.csv", "one row per receiver: visibility of the source, and the error of each method", write_fields,
       has_fields},
      {"profile.csv", "the radiosity along a line, exact and by other methods", write_profile, has_profile},
      {"method_timings.csv", "one row per method and setting: seconds per receiver", write_method_timings, has_cells,
       Holds::kTimes},
  };
  return kTables;
}

}  // namespace exactff::report
