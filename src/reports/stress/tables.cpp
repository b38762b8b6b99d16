#include "stress/report.h"
#include "text/csv_row.h"
#include "text/phrases.h"

namespace exactff::stress {

namespace {

using text::CsvRow;

constexpr int kPrintedDigits = 30;

void write_head(const Report& report, std::ostream& out, std::string_view what) {
  out << "# " << text::program_version() << " stress: " << what << '\n';
  if (!report.unfinished.empty()) {
    out << "# incomplete: the run was interrupted; not finished: " << text::enumerate(report.unfinished) << '\n';
  }
}

void write_settings(std::ostream& out) {
  out << "# tampieri: eps_B " << text::shortest(kToleranceShare) << " of the unoccluded form factor, " << kRays
      << " jittered rays, seed 1\n";
}

void write_values(const Report& report, std::ostream& out) {
  write_head(report, out, "every family, stiffness and method");
  out << "# error: |value - truth| / truth; where the truth is 0, |value| over the unoccluded form factor\n"
         "# errors below "
      << text::shortest(kTruthIsGoodTo) << ", which is as far as the truth is known, are written 0\n";
  write_settings(out);
  out << "family,stiffness,truth,evidence,agrees,status,precision_bits,occluders,edges";
  for (Method method : kMethods) out << ',' << short_name_of(method) << "_value," << short_name_of(method) << "_error";
  out << '\n';
  for (const FamilyResult& family : report.families) {
    for (const Row& r : family.rows) {
      CsvRow row(out);
      row << family.family.name << r.stiffness << r.truth.decimals(kPrintedDigits).value_or(r.truth.midpoint())
          << to_string(family.family.evidence) << (r.agrees ? "yes" : "no") << exactff::to_string(r.status)
          << r.precision_bits << r.occluders << r.edges;
      for (Method method : kMethods) {
        const Answer& answer = r.of(method);
        if (answer.refused) {
          row << "refused"
              << "";
        } else {
          row << answer.value << answer.error;
        }
      }
    }
  }
}

void write_summary(const Report& report, std::ostream& out) {
  write_head(report, out,
             "the largest stiffness up to which each method's error stays below each threshold; 0: not even once");
  out << "# stiffnesses are tried in steps (see values.csv); each number is the last one tried\n";
  write_settings(out);
  out << "family,method,threshold,usable_up_to,largest_tried\n";
  for (const FamilyResult& family : report.families) {
    for (Method method : kMethods) {
      for (double threshold : kThresholds) {
        CsvRow(out) << family.family.name << short_name_of(method) << threshold
                    << usable_up_to(family, method, threshold) << family.rows.back().stiffness;
      }
    }
  }
}

void write_timings(const Report& report, std::ostream& out) {
  write_head(report, out, "median seconds of one call, preprocessing apart");
  out << "family,stiffness";
  for (Method method : kMethods) out << ',' << short_name_of(method) << "_seconds";
  out << '\n';
  for (const FamilyResult& family : report.families) {
    for (const Row& r : family.rows) {
      CsvRow row(out);
      row << family.family.name << r.stiffness;
      for (Method method : kMethods) row << r.of(method).seconds;
    }
  }
}

}  // namespace

const std::array<StressTable, 3>& tables() {
  static const std::array<StressTable, 3> list = {
      {{"summary.csv", "the stiffness up to which each method stays below each error", write_summary},
       {"values.csv", "every value and error, the truth to 30 digits, the bits needed", write_values},
       {"timings.csv", "times of single calls", write_timings}}};
  return list;
}

}  // namespace exactff::stress
