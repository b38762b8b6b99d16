// What a report says about a scene must agree with its own tables: the sentences on the terminal, the page, and the CSV
// files are read as a user reads them. Studies of every generated model.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "exactff/models.h"
#include "report/plan.h"
#include "report/report.h"
#include "report/verdicts.h"
#include "text/phrases.h"
#include "unit/reports/study_support.h"

namespace exactff::study {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream in(csv);
  std::vector<std::string> head;
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    const std::vector<std::string> fields = fields_of(line);
    if (head.empty()) {
      head = fields;
    } else {
      Row& row = rows.emplace_back();
      for (std::size_t i = 0; i < fields.size(); ++i) row[head[i]] = fields[i];
    }
  }
  return rows;
}

// A setting, from methods.csv and method_timings.csv.
struct Setting {
  std::string method, name;
  double error = 0.0, seconds = 0.0, times_exact = 0.0;
};

bool is_other(const Setting& setting) {
  return setting.method != "exact" && setting.method != "adaptive-exact-visibility";
}

// The sentences, the page without its figures, and the tables.
struct Report {
  std::vector<std::string> said;  // on the terminal
  std::string page;
  std::vector<Setting> settings;
  std::size_t swept = 0, with_times = 0;

  static std::vector<Row> table(const Study& study, std::string_view file) {
    const auto found = std::ranges::find(report::tables(), file, &report::StudyTable::file);
    return rows_of(validation::text_of(*found, study));
  }

  explicit Report(const Study& study) {
    said = report::method_sentences(study);
    std::ranges::copy(report::headlines(study), std::back_inserter(said));
    report::StudyReport whole;
    whole.scenes.push_back({"", "model", study});
    report::Pages pages;
    pages.scenes.emplace_back();
    page = plain(report::report_page(whole, pages));
    const auto errors = table(study, "methods.csv"), times = table(study, "method_timings.csv");
    EXPECT_EQ(errors.size(), times.size());
    for (std::size_t i = 0; i < std::min(errors.size(), times.size()); ++i) {
      EXPECT_EQ(errors[i].at("setting"), times[i].at("setting"));
      settings.push_back({errors[i].at("method"), report::cell_name(study, study.methods.cells[i]),
                          std::stod(errors[i].at("rms_over_brightest")), std::stod(times[i].at("seconds")),
                          std::stod(times[i].at("times_exact"))});
    }
    swept = table(study, "summary.csv").size();
    for (const Row& row : table(study, "summary_timings.csv")) {
      const double seconds = std::stod(row.at("mean")), exact = std::stod(row.at("exact_mean"));
      with_times += std::ranges::any_of(settings, [&](const Setting& s) { return s.seconds == seconds; }) ? 1 : 0;
      EXPECT_EQ(exact, exact_setting().seconds);
    }
  }

  static std::string plain(std::string html) {
    for (const auto& [from, to] : {std::pair{"&nbsp;", " "}, {"<sub>", "_"}, {"</sub>", ""}}) {
      for (std::size_t at = html.find(from); at != std::string::npos; at = html.find(from)) {
        html.replace(at, std::string(from).size(), to);
      }
    }
    return html;
  }

  [[nodiscard]] const Setting& exact_setting() const {
    return *std::ranges::find(settings, std::string("exact"), &Setting::method);
  }
  // The least multiple of the exact method's time among the others that are accurate to `wanted`; infinite for none.
  [[nodiscard]] double cheapest(double wanted) const {
    double best = INFINITY;
    for (const Setting& s : settings) {
      if (is_other(s) && s.error <= wanted) best = std::min(best, s.times_exact);
    }
    return best;
  }
  [[nodiscard]] bool has(const std::string& name, double error, const std::string& times_exact) const {
    return std::ranges::any_of(settings, [&](const Setting& s) {
      return s.name == name && s.error <= error && text::rounded(s.times_exact, 2) == times_exact;
    });
  }
  // The least error among the others that are at least as fast as the exact method; infinite for none.
  [[nodiscard]] double best_in_time() const {
    double best = INFINITY;
    for (const Setting& s : settings) {
      if (is_other(s) && s.times_exact <= 1.0) best = std::min(best, s.error);
    }
    return best;
  }
};

int digit(const std::string& superscript) {
  constexpr std::array<const char*, 10> kDigits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  return static_cast<int>(std::ranges::find(kDigits, superscript) - kDigits.begin());
}
double power(const std::string& superscript) { return std::pow(10.0, -digit(superscript)); }

// What was compared, so that no kind of sentence goes unseen.
struct Seen {
  int cheapest = 0, none = 0, crossover = 0, always_exact = 0, exact_times = 0, base_settings = 0;
};

void compare_times_of_exact(const Report& report, const std::string& text, Seen& seen) {
  static const std::regex kTime(
      "(exact (?:value|form factor|method)(?: takes|’s time)? ?\\(?|it takes )([0-9.]+ (?:ns|µs|ms|s))( per receiver| "
      "there)");
  for (std::sregex_iterator at(text.begin(), text.end(), kTime), end; at != end; ++at) {
    EXPECT_EQ((*at)[2], text::duration(report.exact_setting().seconds)) << at->str();
    ++seen.exact_times;
  }
}

void compare_cost(const Report& report, const std::string& text, Seen& seen) {
  static const std::regex kCheapest(
      "accurate to 10⁻(⁰|¹|²|³|⁴|⁵|⁶) of the brightest receiver \\(RMS\\), (.*), takes (\\S+) times as long");
  static const std::regex kNone("no other setting that was run is accurate to 10⁻(⁰|¹|²|³|⁴|⁵|⁶)");
  std::smatch match;
  if (std::regex_search(text, match, kCheapest)) {
    const double wanted = power(match[1]);
    EXPECT_EQ(match[3], text::rounded(report.cheapest(wanted), 2)) << text;
    EXPECT_TRUE(report.has(match[2], wanted, match[3])) << text;
    ++seen.cheapest;
  }
  if (std::regex_search(text, match, kNone)) {
    EXPECT_TRUE(std::isinf(report.cheapest(power(match[1])))) << text;
    ++seen.none;
  }
}

void compare_crossover(const Report& report, const std::string& text, Seen& seen) {
  static const std::regex kBelow(
      "must stay below (\\S+) % of the brightest receiver; when (\\S+) % will do, use (.*), in (the same time|\\S+ % "
      "of its time)");
  std::smatch match;
  const double best = report.best_in_time();
  if (std::regex_search(text, match, kBelow)) {
    EXPECT_EQ(match[1], match[2]);
    EXPECT_EQ(match[1], text::rounded(100.0 * best, 2)) << text;
    EXPECT_TRUE(std::ranges::any_of(report.settings, [&](const Setting& s) {
      return s.name == match[3] && s.error == best && s.times_exact <= 1.0;
    })) << text;
    ++seen.crossover;
  }
  if (text.find("whatever error you accept") != std::string::npos) {
    EXPECT_TRUE(std::isinf(best)) << text;
    ++seen.always_exact;
  }
}

// A setting of the sweeps has the name under which it is compared with the methods.
void compare_names(const Report& report, const std::string& text, Seen& seen) {
  static const std::regex kBase("at the base setting \\((.*)\\) takes");
  std::smatch match;
  if (!std::regex_search(text, match, kBase)) return;
  EXPECT_NE(std::ranges::find(report.settings, match[1].str(), &Setting::name), report.settings.end()) << text;
  ++seen.base_settings;
}

// There must be one sentence that says from which error on another method is faster, and one place for it.
void expect_one_crossover(const Report& report) {
  std::size_t count = 0;
  for (const std::string& sentence : report.said) {
    for (const char* words :
         {"must stay below", "In the time of the exact method", "the exact method is the fastest"}) {
      count += sentence.find(words) != std::string::npos ? 1 : 0;
    }
  }
  EXPECT_LE(count, 1U);
}

Study study_of_model(const Scene& scene, const char* floor) {
  Request request;
  request.scene = &scene;
  request.scene_name = "model";
  request.receivers = grid_receivers(scene, scene.select(floor), {3, 3});
  request.receivers_name = "floor, grid 3x3";
  request.sweeps.rays = {1, 64};
  request.sweeps.patterns = {SamplePattern::kJittered};
  request.sweeps.seeds = {1, 2};
  request.methods = {.enabled = true, .seeds = 1, .receivers = 3, .budget = 0.001};
  request.sweep_budget = 0.01;
  request.seconds_for_a_time = 0.001;
  request.threads = 2;
  validation::scatter(request);
  return run(std::move(request));
}

TEST(Report, AgreesWithItsTablesForEveryModel) {
  const std::map<std::string, std::string> small = {
      {"teapot", "teapot:segments=2"}, {"forest", "forest:n=50"},  {"closed-room", "closed-room:boxes=1"},
      {"emitters", "emitters:n=2"},    {"room", "room:n=4"},       {"karkanis", "karkanis:n=20"},
      {"soup", "soup:n=20"},           {"blinds", "blinds:n=8"},   {"tiles", "tiles:n=4,drop=3"},
      {"mesh", "mesh:n=50"},           {"lattice", "lattice:n=20"}};
  Seen seen;
  for (const models::Model* model : models::all_models()) {
    const std::string text = small.contains(model->name) ? small.at(model->name) : model->name;
    SCOPED_TRACE(text);
    const Scene scene = models::make_scene(text);
    const Study study = study_of_model(scene, model->name == "forest" ? "ground" : "floor");
    const Report report(study);
    EXPECT_EQ(report.with_times, report.swept) << "a setting of the sweeps is not among the settings that are compared";
    std::vector<std::string> texts = report.said;
    texts.push_back(report.page);
    for (const std::string& one : texts) {
      compare_times_of_exact(report, one, seen);
      compare_cost(report, one, seen);
      compare_crossover(report, one, seen);
    }
    for (const std::string& sentence : report.said) compare_names(report, sentence, seen);
    expect_one_crossover(report);
  }
  EXPECT_GT(seen.cheapest, 0);
  EXPECT_GT(seen.none, 0);
  EXPECT_GT(seen.crossover, 10);
  EXPECT_GT(seen.exact_times, 40);
  EXPECT_GT(seen.base_settings, 5);
}

// The script of a figure has its points and the titles of its lines.
TEST(Report, DrawsWhatItRecommends) {
  for (const Study* study : {&validation::small_study(), &validation::whole_study()}) {
    const MethodCell* best = report::recommended(*study);
    if (best == nullptr) continue;
    std::vector<LeftOut> left_out;
    for (const page::Figure& figure : report::figures(*study, left_out)) {
      if (figure.id != "methods-time") continue;
      EXPECT_NE(figure.script.find("recommended"), std::string::npos);
      EXPECT_NE(figure.script.find(study->methods.ladders[best->ladder].name), std::string::npos);
      EXPECT_NE(figure.caption.find("which the verdict recommends"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace exactff::study
