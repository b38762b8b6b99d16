// Results of another renderer that were measured against exact images, read from a CSV file (data/README.md).
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "exactff/progress.h"
#include "page/chapter.h"

namespace exactff::field {

// One setting of the renderer at one number of samples per pixel. A number that the file does not state is NaN.
struct FieldRow {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  std::string setting, about;
  double samples = kUnknown, runs = kUnknown;
  double seconds = kUnknown, cpu_seconds = kUnknown, us_per_pixel = kUnknown;
  double exact_seconds = kUnknown, exact_cpu_seconds = kUnknown, exact_us_per_pixel = kUnknown;  // of exact images
  double pixels = kUnknown, left_out = kUnknown;  // compared; and not compared
  double mean_ratio = kUnknown, whole_lamp_ratio = kUnknown, median_ratio = kUnknown;
  double black_share = kUnknown;
  double rms = kUnknown, relative_mse = kUnknown;  // in radiance; and relative
  double rms_of_brightest = kUnknown, noise_of_brightest = kUnknown, bias_of_brightest = kUnknown;
  double p99_of_brightest = kUnknown, worst_of_brightest = kUnknown;
  double load = kUnknown;                         // of the machine
  double time = kUnknown, exact_time = kUnknown;  // seconds per pixel, of the kind that FieldResults states
  std::string image;                              // the name of a map of signed errors; empty if there is none
  std::string png;                                // its bytes
};

struct FieldResults {
  std::string name;                // letters, digits and hyphens, from that of the file
  std::string title;               // from the comment "# title: ..."
  std::string command;             // that measured them, from "# command: ..."; may be empty
  std::string maps;                // what the colours of the maps mean, from "# maps: ..."; may be empty
  std::vector<std::string> notes;  // the other comments
  bool processor_time = false;     // times are processor times, because the machine was busy; else wall times
  std::vector<FieldRow> rows;
};

// Throws InputError with every problem of the file and its pictures.
[[nodiscard]] FieldResults read_field(const std::filesystem::path& csv);

// The settings in their order, each once.
[[nodiscard]] std::vector<std::string> settings_of(const FieldResults& field);
// The row of a setting with the most samples.
[[nodiscard]] const FieldRow& most_samples(const FieldResults& field, const std::string& setting);

// One sentence: when to use the exact values, and what the renderer reaches.
[[nodiscard]] std::string verdict(const FieldResults& field);

// Which settings have more bias than noise at their most samples; empty if none has.
[[nodiscard]] std::string bias_note(const FieldResults& field);

// Error against samples and against time.
[[nodiscard]] std::vector<page::Figure> field_figures(const FieldResults& field, std::vector<LeftOut>& left_out);

}  // namespace exactff::field
