// Solutions as CSV files.
#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr std::string_view kAccuracy = "; view factors: accuracy ", kBudget = ", budget ", kWide = " wider than that",
                           kAgainFor = " again for bounds of ";

// "accuracy 1e-06, budget 100000 cells, 3 entries wider than that"
std::string words_of_factors(const Solution& solution, const ViewFactorOptions& options) {
  std::string words = std::string(kAccuracy) + text::shortest(options.accuracy) + std::string(kBudget) +
                      std::to_string(options.budget) + " cells";
  const auto add = [&](std::size_t count, std::string_view what) {
    ((words += ", ") += text::counted(count, "entry", "entries")) += what;
  };
  if (solution.width) {
    add(solution.computed_again, kAgainFor);
    words += text::shortest(*solution.width) + " of the brightest";
  } else if (solution.wide > 0) {
    add(solution.wide, kWide);
  }
  return words;
}

// The number that follows the key; 0 if there is none.
double number_after(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return 0.0;
  const std::string_view rest = line.substr(at + key.size());
  const text::ParsedNumber number = text::parse_number(rest.substr(0, rest.find_first_of(", ")));
  return number.fault == text::NumberFault::kNone ? number.value : 0.0;
}

bool has_variation(const Solution& solution) { return !solution.channels.front().variation.empty(); }

}  // namespace

std::string csv_text(const Scene& scene, const Solution& solution, const ViewFactorOptions& options,
                     const Origin& origin) {
  std::string text = "# exactff " + std::string(kVersion) +
                     " radiosity: what leaves each patch after all bounces, in the unit of Ke; areas in the scene's "
                     "unit squared\n# " +
                     std::string(kSceneHash) + scene.hash() + words_of_factors(solution, options) + '\n' +
                     origin_lines(origin) +
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
    irradiance_ = csv_.column("irradiance");
    irradiance_lower_ = csv_.column("irradiance_lower");
    irradiance_upper_ = csv_.column("irradiance_upper");
    area_ = csv_.column("area");
    variation_ = csv_.column("variation");
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
    if (const auto head = rest(kSceneHash)) take_head(*head);
    if (const auto names = rest(kTwoSided)) file_.origin.two_sided.push_back(*names);
    if (const auto length = rest(kDivided)) take_length(*length);
  }

  void take_head(std::string_view head) {
    file_.scene_hash = head.substr(0, head.find(';'));
    file_.accuracy = number_after(head, kAccuracy);
    file_.budget = static_cast<std::uint64_t>(number_after(head, kBudget));
    if (head.find(kAgainFor) != std::string_view::npos) file_.width = number_after(head, kAgainFor);
    const std::size_t wide = head.find(kWide), comma = head.rfind(", ", wide);
    if (wide != std::string_view::npos && comma != std::string_view::npos) {
      file_.wide = static_cast<std::size_t>(number_after(head.substr(comma), ", "));
    }
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
    const double value = bounded ? csv_.number(value_) : number_or(value_, kNothing);
    if (!(0.0 <= lower && lower <= upper) || value < lower || value > upper) {
      csv_.complain("the radiosity is not within its bounds, or negative", "the file contradicts itself",
                    "use the file as `exactff radiosity` wrote it");
    }
    const BoundedValue irradiance{number_or(irradiance_, kNothing), number_or(irradiance_lower_, 0.0),
                                  number_or(irradiance_upper_, HUGE_VAL)};
    file_.rows.push_back({csv_.field(patch_), static_cast<std::size_t>(channel - kChannelNames.begin()),
                          BoundedValue{value, lower, upper}, irradiance, number_or(area_, 0.0),
                          number_or(variation_, kNothing)});
  }

  // An empty field means that the value is not known.
  double number_or(std::optional<std::size_t> column, double otherwise) {
    return column && !csv_.field(*column).empty() ? csv_.number(*column) : otherwise;
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

  static constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

  text::CsvTable csv_;
  SolutionFile file_;
  std::size_t patch_ = 0, channel_ = 0, value_ = 0, lower_ = 0, upper_ = 0, claim_ = 0;
  std::optional<std::size_t> irradiance_, irradiance_lower_, irradiance_upper_, area_, variation_;
};

}  // namespace

SolutionFile read_csv(const std::filesystem::path& file) {
  const kernel::StandardArithmetic arithmetic;
  return FileReader(file).read();
}

}  // namespace exactff::radiosity
