// What is written about a report: sentences, histograms, JSON, JUnit XML, annotations, baselines.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "exactff/check.h"
#include "exactff/exr.h"
#include "exactff/render.h"

namespace exactff::check {

inline constexpr std::string_view kImage = "image";  // the kind of a truth of pixels

// In the relative mean square error of images, e^2 / (t^2 + this), as papers on denoising have it: e is the error, t
// the truth.
inline constexpr double kRelativeMseEpsilon = 0.01;

// Throws InputError if a limit is invalid.
void check_criteria(const Criteria& criteria);
// Of each candidate. Problems of all of them are thrown together.
[[nodiscard]] std::vector<Report> compare_all(const std::filesystem::path& truth,
                                              std::span<const std::filesystem::path> candidates,
                                              const Options& options);

// --- Sentences ---

[[nodiscard]] std::string name_of(const Quantile& quantile);  // "quantile 0.99"
[[nodiscard]] std::string name_of(const Verdict& verdict);    // "max-abs, source light"
// "receiver '7', source 'light'"; "row 'floor', column 'light'"
[[nodiscard]] std::string name_of(const std::array<std::string, 2>& keys, const std::string& receiver,
                                  const std::string& source);
// "max-abs, source light: 0.0123 is above the limit 0.01, worst at receiver '7'"
[[nodiscard]] std::string sentence(const Verdict& verdict);
// "exact 0.25, found 0.26, error 0.01, relative 0.04"
[[nodiscard]] std::string describe(const RowError& row);
// The worst rows: "receiver '7': exact 0.25, found 0.26, ...".
[[nodiscard]] std::vector<std::string> worst_lines(const Report& report);
// One for each fact.
[[nodiscard]] std::vector<std::string> sentences(const MatrixFacts& facts);
// What the user should know about the result, whether it passed or not.
[[nodiscard]] std::vector<std::string> warnings(const Report& report);

// --- For other programs ---

[[nodiscard]] nlohmann::ordered_json json_of(const Report& report);
[[nodiscard]] std::string json_text(const Report& report);
[[nodiscard]] nlohmann::ordered_json json_of(const Distribution& distribution);
[[nodiscard]] nlohmann::ordered_json json_number(double value);  // infinity and NaN as words, which JSON has not

// JUnit XML as Jenkins, GitLab and others read it: a test suite for each report, with a test case for each verdict.
[[nodiscard]] std::string junit_xml(std::span<const Report> reports);
[[nodiscard]] inline std::string junit_xml(const Report& report) { return junit_xml(std::span(&report, 1)); }

// Workflow commands of GitHub Actions, lines that the runner turns into annotations on files: an ::error for every
// verdict that failed, a ::warning for anything doubtful.
[[nodiscard]] std::string github_annotations(const Report& report);
[[nodiscard]] std::string github_annotations(const InputError& error);

// --- Histograms of errors on a logarithmic axis ---

// Of the magnitudes of the errors. The bins within a decade have equal width on a logarithmic axis.
struct HistogramBin {
  double low = 0.0;  // exclusive, except in the first bin, which also holds everything below it
  double high = 0.0;
  std::size_t count = 0;
};
struct Histogram {
  std::size_t exact = 0;  // number of errors equal to 0
  std::vector<HistogramBin> bins;
};
[[nodiscard]] Histogram histogram(const Report& report, int bins_per_decade = 1, std::size_t most_bins = 24);

// A gnuplot script that plots the histogram as SVG to standard output; empty if every error is 0.
[[nodiscard]] std::string histogram_script(const Report& report);
// The same of the share of rows whose error is at most x, a line for each program.
[[nodiscard]] std::string shares_script(const Scoreboard& board);

// The picture that gnuplot makes of a script, or the reason why there is none. Throws InputError if there is no place
// for temporary files. Ends gnuplot if `cancelled` returns true while it runs.
struct Plot {
  std::string svg;
  std::string why_not;  // empty if there is a picture
};
[[nodiscard]] Plot plot(const std::string& script, const std::function<bool()>& cancelled = {});

// --- Images as truths and candidates: a row for each pixel and channel ---

// Names of layers or channels (exr::ExrFile::find). Empty: R, G, B.
struct ImageLayers {
  std::string truth = {};
  std::string candidate = {};
};

// Two images, each an OpenEXR file or a NumPy array, pixel by pixel. Pixels are matched by their coordinates; an array
// has the place of the other image.
struct Images {
  Truth truth;                   // a row for each pixel and channel whose true value is finite
  std::vector<Measured> values;  // in its order
  std::string candidate_file;
  exr::Window window;                 // of the truth
  std::size_t channels = 3;           // 1 or 3
  std::vector<double> exact, theirs;  // `channels` for each pixel of the window; NaN where there is none
};
// Throws InputError if a file cannot be read, if channels are missing, or if the candidate lacks a pixel that the truth
// has, unless `partial`; throws Cancelled.
[[nodiscard]] Images read_images(const std::filesystem::path& truth, const std::filesystem::path& candidate,
                                 const ImageLayers& layers = {}, bool partial = false);

// The bytes of candidate minus truth: as EXR, a channel for each that was compared, NaN where nothing was; as PNG, in
// colours.
[[nodiscard]] std::string error_image(const Images& images, render::ImageKind kind);

// --- Baselines ---

// A baseline works as a ratchet: the statistics recorded in a file are the limits of later checks. Default slack: far
// above the noise that rounding adds to an error, far below the effect of any change of a method.
inline constexpr double kDefaultSlack = 1e-9;

// The statistics of the report as JSON, for a baseline file.
[[nodiscard]] std::string baseline_text(const Report& report);

// Whether these errors may become a baseline: no value is not a number, and nothing got worse than the baseline that
// the report was held against. So the ratchet never loosens.
[[nodiscard]] bool may_be_recorded(const Report& report);

// Adds to the report a verdict on every statistic of the baseline, and the improvements. A statistic is worse if it
// exceeds the recorded one by more than the share `slack` of it and also by more than 4 units in the last place of the
// largest truth, because different compilers do not agree more closely. Throws InputError if the file cannot be read,
// or if it was recorded with other rows, other truths or another relative floor.
void hold_against_baseline(Report& report, const std::filesystem::path& baseline, double slack = kDefaultSlack);

}  // namespace exactff::check
