// Solutions as CSV files.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "exactff/radiosity.h"
#include "exactff/version.h"
#include "kernel/float_environment.h"
#include "matrix/words.h"
#include "text/csv_row.h"
#include "text/csv_table.h"
#include "text/escape.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::radiosity {
namespace {

constexpr std::string_view kSceneHash = "scene hash ", kDivided = "divided by ", kTwoSided = "two-sided: ";

std::optional<double> if_finite(double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

std::string origin_lines(const Origin& origin) {
  std::string lines;
  const auto add = [&](std::string_view key, const std::string& value) {
    ((lines += "# ") += key) += text::csv_comment(value) + '\n';
  };
  if (origin.divided) add(kDivided, text::shortest(*origin.divided));
  for (const std::string& names : origin.two_sided) add(kTwoSided, names);
  return lines;
}

std::string words_of_width(const Solution& solution) {
  if (!solution.width) return {};
  return ", " + text::counted(solution.computed_again, "entry", "entries") + " again for bounds of " +
         text::shortest(*solution.width) + " of the brightest";
}

bool has_variation(const Solution& solution) { return !solution.channels.front().variation.empty(); }

}  // namespace

std::string csv_text(const Scene& scene, const Solution& solution, const ViewFactorOptions& options,
                     const Origin& origin) {
  std::string text = "# exactff " + std::string(kVersion) +
                     " radiosity: what leaves each patch after all bounces, in the unit of Ke; areas in the scene's "
                     "unit squared\n# " +
                     std::string(kSceneHash) + scene.hash() + "; view factors: accuracy " +
                     text::shortest(options.accuracy) + ", budget " + std::to_string(options.budget) + " cells" +
                     words_of_width(solution) + '\n' + origin_lines(origin) +
                     "patch,channel,radiosity,lower,upper,irradiance,irradiance_lower,irradiance_upper,claim,area" +
                     (has_variation(solution) ? ",variation\n" : "\n");
  for (std::size_t i = 0; i < solution.patches.size(); ++i) {
    const std::string name = scene.name_of(solution.patches[i]);
    for (std::size_t c = 0; c < solution.channels.size(); ++c) {
      const Channel& channel = solution.channels[c];
      text::CsvRow row(text);
      row << name << kChannelNames[c];
      for (const BoundedValue& q : {channel.radiosity[i], channel.irradiance[i]}) {
        row << if_finite(q.value) << q.lower << if_finite(q.upper);
      }
      row << claim_text(solution, channel) << solution.areas[i];
      if (has_variation(solution)) row << if_finite(channel.variation[i]);
    }
  }
  return text;
}

namespace {

class FileReader {
 public:
  explicit FileReader(const std::filesystem::path& path) : csv_(path, "radiosities of `exactff radiosity -o`") {
    file_.file = csv_.file();
    for (const std::string& comment : csv_.comments()) take_comment(comment);
    const auto column = [&](std::string_view name) {
      return csv_.needed_column({name}, "a solution has it", "give a file written by `exactff radiosity -o`");
    };
    patch_ = column("patch");
    channel_ = column("channel");
    value_ = column("radiosity");
    lower_ = column("lower");
    upper_ = column("upper");
    claim_ = column("claim");
  }

  SolutionFile read() {
    if (file_.scene_hash.empty() && csv_.is_sound()) {
      csv_.complain_at(0, "the head does not say to which scene the radiosities belong",
                       "patches are found by their names in that scene",
                       "use the file as `exactff radiosity` wrote it");
    }
    while (csv_.is_sound() && csv_.next()) take_row();
    csv_.throw_if_any();
    return std::move(file_);
  }

 private:
  void take_comment(const std::string& line) {
    const auto rest = [&](std::string_view key) {
      return line.starts_with(key) ? std::optional(line.substr(key.size())) : std::nullopt;
    };
    if (const auto hash = rest(kSceneHash)) file_.scene_hash = hash->substr(0, hash->find(';'));
    if (const auto names = rest(kTwoSided)) file_.origin.two_sided.push_back(*names);
    if (const auto length = rest(kDivided)) take_length(*length);
  }

  void take_length(const std::string& text) {
    const text::ParsedNumber length = text::parse_number(text);
    if (length.fault == text::NumberFault::kNone && length.value > 0.0) {
      file_.origin.divided = length.value;
    } else {
      csv_.complain_at(0, "the scene was divided by " + text::in_quotes(text), "it is a positive length",
                       "use the file as `exactff radiosity` wrote it");
    }
  }

  void take_row() {
    const auto channel = std::ranges::find(kChannelNames, csv_.field(channel_));
    if (channel == kChannelNames.end()) {
      csv_.complain("unknown channel " + text::in_quotes(csv_.field(channel_)), "it is red, green or blue",
                    "use the file as `exactff radiosity` wrote it");
      return;
    }
    take_claim(csv_.field(claim_));
    const bool bounded = !csv_.field(upper_).empty();
    const double lower = csv_.number(lower_), upper = bounded ? csv_.number(upper_) : HUGE_VAL;
    const double value = bounded ? csv_.number(value_) : lower;
    if (!(0.0 <= lower && lower <= value && value <= upper)) {
      csv_.complain("the radiosity is not within its bounds, or negative", "the file contradicts itself",
                    "use the file as `exactff radiosity` wrote it");
    }
    file_.rows.push_back({csv_.field(patch_), static_cast<std::size_t>(channel - kChannelNames.begin()),
                          BoundedValue{value, lower, upper}});
  }

  void take_claim(const std::string& text) {
    if (text == kNoBound) return;
    const std::optional<Claim> claim = matrix::claim_named(text);
    if (!claim) {
      csv_.complain("unknown claim " + text::in_quotes(text), "it says how strong the bounds are",
                    "use the file as `exactff radiosity` wrote it");
      return;
    }
    file_.claim = matrix::weaker(file_.claim, *claim);
  }

  text::CsvTable csv_;
  SolutionFile file_;
  std::size_t patch_ = 0, channel_ = 0, value_ = 0, lower_ = 0, upper_ = 0, claim_ = 0;
};

}  // namespace

SolutionFile read_csv(const std::filesystem::path& file) {
  const kernel::StandardArithmetic arithmetic;
  return FileReader(file).read();
}

}  // namespace exactff::radiosity
