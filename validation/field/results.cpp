#include "field/results.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "page/gnuplot.h"
#include "text/csv_lines.h"
#include "text/escape.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/text_lines.h"

namespace exactff::field {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPurpose = "a CSV file of measured results";

enum class Needed { kYes, kNo };

struct TextColumn {
  const char* name;
  std::string FieldRow::*value;
  Needed needed;
};
constexpr std::array<TextColumn, 3> kTexts = {{{"setting", &FieldRow::setting, Needed::kYes},
                                               {"about", &FieldRow::about, Needed::kNo},
                                               {"image", &FieldRow::image, Needed::kNo}}};

struct NumberColumn {
  const char* name;
  double FieldRow::*value;
  double least;       // what it may be at least
  const char* words;  // the same in words
  Needed needed = Needed::kNo;
};
constexpr const char *kCount = "is a number from 1 on", *kAmount = "is not negative", *kTime = "is above 0";
constexpr double kAboveZero = 1e-300;
constexpr std::array<NumberColumn, 22> kNumbers = {
    {{"samples", &FieldRow::samples, 1.0, kCount, Needed::kYes},
     {"runs", &FieldRow::runs, 1.0, kCount},
     {"seconds", &FieldRow::seconds, kAboveZero, kTime},
     {"cpu_seconds", &FieldRow::cpu_seconds, kAboveZero, kTime},
     {"us_per_pixel", &FieldRow::us_per_pixel, kAboveZero, kTime, Needed::kYes},
     {"exact_seconds", &FieldRow::exact_seconds, kAboveZero, kTime},
     {"exact_cpu_seconds", &FieldRow::exact_cpu_seconds, kAboveZero, kTime},
     {"exact_us_per_pixel", &FieldRow::exact_us_per_pixel, kAboveZero, kTime, Needed::kYes},
     {"pixels", &FieldRow::pixels, 1.0, kCount},
     {"left_out", &FieldRow::left_out, 0.0, kAmount},
     {"mean_ratio", &FieldRow::mean_ratio, 0.0, kAmount, Needed::kYes},
     {"whole_lamp_ratio", &FieldRow::whole_lamp_ratio, 0.0, kAmount},
     {"black_share", &FieldRow::black_share, 0.0, kAmount},
     {"median_ratio", &FieldRow::median_ratio, 0.0, kAmount},
     {"rms", &FieldRow::rms, 0.0, kAmount},
     {"rms_of_brightest", &FieldRow::rms_of_brightest, 0.0, kAmount, Needed::kYes},
     {"noise_of_brightest", &FieldRow::noise_of_brightest, 0.0, kAmount},
     {"bias_of_brightest", &FieldRow::bias_of_brightest, 0.0, kAmount},
     {"relative_mse", &FieldRow::relative_mse, 0.0, kAmount},
     {"p99_of_brightest", &FieldRow::p99_of_brightest, 0.0, kAmount},
     {"worst_of_brightest", &FieldRow::worst_of_brightest, 0.0, kAmount},
     {"load", &FieldRow::load, 0.0, kAmount}}};

// Other programs kept the machine busy: a run of one thread or more took longer than its processor time.
bool was_waiting(const FieldRow& row) {
  constexpr double kBusy = 2.0;
  return row.load > kBusy && row.seconds > row.cpu_seconds;
}
bool has_processor_time(const FieldRow& row) {
  return row.cpu_seconds > 0.0 && row.exact_cpu_seconds > 0.0 && row.pixels + row.left_out > 0.0;
}

void choose_times(FieldResults& field) {
  const auto waiting = static_cast<std::size_t>(std::ranges::count_if(field.rows, was_waiting));
  field.processor_time = 2 * waiting > field.rows.size() && std::ranges::all_of(field.rows, has_processor_time);
  for (FieldRow& row : field.rows) {
    const double pixels = row.pixels + row.left_out;
    row.time = field.processor_time ? row.cpu_seconds / pixels : 1e-6 * row.us_per_pixel;
    row.exact_time = field.processor_time ? row.exact_cpu_seconds / pixels : 1e-6 * row.exact_us_per_pixel;
  }
}

class FieldReader {
 public:
  explicit FieldReader(const fs::path& csv) : csv_(csv), lines_(csv, kPurpose) {}

  FieldResults read() {
    result_.title = "Measured results: " + csv_.filename().string();
    result_.name = plain_word(csv_.stem().string());
    for (std::string_view line; !problems_.full() && lines_.next(line);) {
      if (text::is_csv_comment(line)) {
        take_comment(text::trimmed(line));
      } else if (!text::split_csv_line(line, fields_)) {
        complain("a quote is not closed, or text follows it", "the fields of the line are unknown",
                 "close it before the next comma");
      } else if (columns_.empty()) {
        take_header();
        if (!problems_.empty()) break;
      } else {
        take_row();
      }
    }
    if (problems_.empty() && result_.rows.empty()) {
      problems_.add({csv_.string(), 0, columns_.empty() ? "the file has no header" : "the file has no row",
                     "there is nothing to show",
                     "write the results with validation/field/cycles.sh, or see data/README.md"});
    }
    problems_.throw_if_any();
    choose_times(result_);
    return std::move(result_);
  }

 private:
  void complain(std::string what, std::string why, std::string suggestion) {
    problems_.add({csv_.string(), lines_.number(), std::move(what), std::move(why), std::move(suggestion)});
  }

  static std::string plain_word(const std::string& name) {
    std::string word;
    for (const char c : name) {
      const auto byte = static_cast<unsigned char>(c);
      word += byte < 128 && std::isalnum(byte) != 0 ? static_cast<char>(std::tolower(byte)) : '-';
    }
    return word;
  }

  void take_comment(std::string_view line) {
    if (line.empty()) return;
    line.remove_prefix(1);
    line = text::trimmed(line);
    const auto taken = [&](std::string_view key, std::string& value) {
      if (!line.starts_with(key)) return false;
      value = text::printable(text::trimmed(line.substr(key.size())));
      return true;
    };
    if (taken("title:", result_.title) || taken("command:", result_.command) || taken("maps:", result_.maps)) return;
    result_.notes.push_back(text::printable(line));
  }

  [[nodiscard]] static bool is_known(const std::string& name) {
    return std::ranges::any_of(kTexts, [&](const TextColumn& column) { return name == column.name; }) ||
           std::ranges::any_of(kNumbers, [&](const NumberColumn& column) { return name == column.name; });
  }

  [[nodiscard]] bool has_column(const char* name) const { return std::ranges::find(columns_, name) != columns_.end(); }

  void take_header() {
    columns_ = fields_;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      const std::string quoted = text::in_quotes(columns_[i]);
      if (!is_known(columns_[i])) {
        complain("there is no column " + quoted, "its numbers would not be shown", "remove it, or correct its name");
      } else if (std::find(columns_.begin(), columns_.begin() + static_cast<std::ptrdiff_t>(i), columns_[i]) !=
                 columns_.begin() + static_cast<std::ptrdiff_t>(i)) {
        complain("the column " + quoted + " is given twice", "one of them would not be shown", "remove one of them");
      }
    }
    const auto require = [&](const char* name) {
      if (has_column(name)) return;
      complain("the column " + text::in_quotes(name) + " is missing", "the chapter shows it",
               "add it; data/README.md lists the columns");
    };
    for (const TextColumn& column : kTexts) {
      if (column.needed == Needed::kYes) require(column.name);
    }
    for (const NumberColumn& column : kNumbers) {
      if (column.needed == Needed::kYes) require(column.name);
    }
  }

  void take_row() {
    if (fields_.size() != columns_.size()) {
      complain(
          "the row has " + text::counted(fields_.size(), "field") + ", the header " + std::to_string(columns_.size()),
          "each field belongs to a column", "complete the row, or quote a field that holds a comma");
      return;
    }
    FieldRow row;
    for (std::size_t i = 0; i < columns_.size(); ++i) take_field(columns_[i], fields_[i], row);
    if (row.setting.empty()) complain("the row has no setting", "rows are told apart by it", "give it a name");
    if (!row.image.empty()) take_image(row);
    result_.rows.push_back(std::move(row));
  }

  void take_field(const std::string& column, const std::string& text, FieldRow& row) {
    for (const TextColumn& one : kTexts) {
      if (column == one.name) row.*one.value = text::printable(text);
    }
    for (const NumberColumn& one : kNumbers) {
      if (column != one.name || (text.empty() && one.needed == Needed::kNo)) continue;
      const text::ParsedNumber number = text::parse_number(text);
      if (number.fault != text::NumberFault::kNone) {
        complain(column + ": " + text::describe(number.fault, text), "the column holds numbers",
                 text::advice(number.fault));
      } else if (!(number.value >= one.least)) {
        complain(column + " is " + text::in_quotes(text), "what it counts or measures " + std::string(one.words),
                 "measure it again");
      }
      row.*one.value = number.value;
    }
  }

  // A PNG file beside the CSV file.
  void take_image(FieldRow& row) {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    constexpr std::size_t kMostBytes = 2'000'000;
    const std::string quoted = "image " + text::in_quotes(row.image, text::kShownName);
    if (fs::path(row.image).has_parent_path()) {
      complain(quoted + " is in another folder", "pictures are beside the file",
               "move it there and give its name alone");
      return;
    }
    try {
      row.png = text::read_file(csv_.parent_path() / row.image, "a PNG file");
    } catch (const InputError& error) {
      complain(quoted + ": " + error.problems().front().what, "the chapter shows it",
               "make it again, or leave the field empty");
      return;
    }
    if (!std::string_view(row.png).starts_with(kSignature)) {
      complain(quoted + " is no PNG file", "browsers could not show it", "write it as PNG");
    } else if (row.png.size() > kMostBytes) {
      complain(quoted + " has over 2 MB", "it becomes a part of the page", "make it smaller");
    }
  }

  const fs::path& csv_;
  text::CsvLines lines_;
  text::ProblemList problems_;
  FieldResults result_;
  std::vector<std::string> fields_, columns_;
};

// The legend of a figure would read these as markup.
std::string without_markup(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return std::string_view("_^@&~{}\\").find(c) != std::string_view::npos; }, '-');
  return name;
}

double percent_of(double share) { return 100.0 * share; }

}  // namespace

std::vector<std::string> settings_of(const FieldResults& field) {
  std::vector<std::string> names;
  for (const FieldRow& row : field.rows) {
    if (std::ranges::find(names, row.setting) == names.end()) names.push_back(row.setting);
  }
  return names;
}

const FieldRow& most_samples(const FieldResults& field, const std::string& setting) {
  const FieldRow* most = nullptr;
  for (const FieldRow& row : field.rows) {
    if (row.setting == setting && (most == nullptr || most->samples < row.samples)) most = &row;
  }
  return *most;
}

FieldResults read_field(const fs::path& csv) { return FieldReader(csv).read(); }

namespace {

// "mesh (emitting faces)"
std::string named(const FieldRow& row) { return row.setting + (row.about.empty() ? "" : " (" + row.about + ")"); }

std::string with_samples(const FieldRow& row) {
  return named(row) + " with " + text::counted(static_cast<std::uint64_t>(row.samples), "sample") + " a pixel";
}

std::string percents(double share) { return text::rounded(percent_of(share), 2) + " %"; }

}  // namespace

std::string verdict(const FieldResults& field) {
  const FieldRow* within = nullptr;  // the most accurate row that is as fast as the exact method
  const FieldRow* best = nullptr;
  for (const FieldRow& row : field.rows) {
    if (best == nullptr || row.rms_of_brightest < best->rms_of_brightest) best = &row;
    if (row.time > row.exact_time) continue;
    if (within == nullptr || row.rms_of_brightest < within->rms_of_brightest) within = &row;
  }
  const double factor = best->time / best->exact_time;
  std::string text = "Use exact images (" + text::duration(best->exact_time) + " a pixel) ";
  if (within == best) {
    return text + "when the RMS error must stay below " + percents(best->rms_of_brightest) +
           " of the brightest pixel; otherwise the renderer, whose most accurate setting, " + with_samples(*best) +
           ", takes " + text::rounded(percent_of(factor), 2) + " % of their time.";
  }
  text += within == nullptr ? "whatever error you accept: no setting of the renderer was as fast"
                            : "when the RMS error must stay below " + percents(within->rms_of_brightest) +
                                  " of the brightest pixel, which the renderer reaches in the same time";
  return text + "; its most accurate setting, " + with_samples(*best) + ", takes " + text::rounded(factor, 2) +
         " times as long and still errs by " + percents(best->rms_of_brightest) + ".";
}

std::string bias_note(const FieldResults& field) {
  std::vector<std::string> biased;
  double most = 0.0;
  for (const std::string& setting : settings_of(field)) {
    const FieldRow& row = most_samples(field, setting);
    if (!(row.bias_of_brightest > row.noise_of_brightest)) continue;
    biased.push_back(setting);
    most = std::max(most, row.bias_of_brightest);
  }
  if (biased.empty()) return {};
  return "More samples do not help " + text::enumerate(biased) + ": more of the error is bias than noise, up to " +
         percents(most) + " of the brightest pixel.";
}

std::vector<page::Figure> field_figures(const FieldResults& field, std::vector<LeftOut>& left_out) {
  std::vector<page::Series> by_samples, by_time;
  double exact = 0.0;
  int style = 0;
  for (const std::string& setting : settings_of(field)) {
    page::Series samples{without_markup(setting), {}, ++style}, time{without_markup(setting), {}, style};
    for (const FieldRow& row : field.rows) {
      if (row.setting != setting) continue;
      samples.points.emplace_back(row.samples, row.rms_of_brightest);
      time.points.emplace_back(1e6 * row.time, row.rms_of_brightest);
      exact = 1e6 * row.exact_time;
    }
    by_samples.push_back(std::move(samples));
    by_time.push_back(std::move(time));
  }
  const std::string error = "RMS error / brightest pixel";
  const std::string kind = field.processor_time ? "processor time" : "time";
  page::Axes axes{kind + " per pixel, µs", error, true, true, {}, {}};
  axes.marks = {{"exact: error 0", exact}};
  std::vector<page::Figure> figures = {
      {"samples", "Error against samples", "Samples per pixel. Each line or mark is a setting of the renderer.",
       page::line_plot({"samples per pixel", error, true, true, {}, {}}, by_samples)},
      {"time", "Error against time",
       (field.processor_time ? "Processor times, because other programs kept the machine busy,"
                             : "Times of whole runs,") +
           std::string(" divided by the number of pixels. The vertical line is the exact image."),
       page::line_plot(axes, by_time)}};
  for (const page::Figure& figure : figures) {
    if (figure.script.empty()) left_out.push_back({"figure: " + figure.title, "every error is 0"});
  }
  std::erase_if(figures, [](const page::Figure& figure) { return figure.script.empty(); });
  return figures;
}

}  // namespace exactff::field
