// What a report covers, how it is carried out, and how it is written into a folder.
#include "report/plan.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>

#include "exactff/version.h"
#include "files/file.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "page/output_folder.h"
#include "report/report.h"
#include "study/runs.h"
#include "text/hashes.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::report {
namespace {

// Lower-case letters, digits and hyphens. A number is appended if two names would be the same.
std::string file_word(const std::string& title, const std::vector<PlannedScene>& others) {
  std::string word;
  for (const char c : title) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128;
    if (plain) word += static_cast<char>(std::tolower(c));
    if (!plain && !word.empty() && word.back() != '-') word += '-';
  }
  while (!word.empty() && word.back() == '-') word.pop_back();
  if (word.empty()) word = "scene";
  const auto taken = [&](const std::string& name) {
    return std::any_of(others.begin(), others.end(), [&](const PlannedScene& scene) { return scene.name == name; });
  };
  if (!taken(word)) return word;
  for (int k = 2;; ++k) {
    const std::string numbered = word + '-' + std::to_string(k);
    if (!taken(numbered)) return numbered;
  }
}

// Progress of a scene's study is shown under the scene's title.
Hooks with_title(const PlannedScene& scene, const Hooks& hooks) {
  if (scene.name.empty() || !hooks.progress) return hooks;
  return {[&](const Progress& progress) {
            const std::string stage = scene.title + ": " + std::string(progress.stage);
            Progress shown = progress;
            shown.stage = stage;
            hooks.progress(shown);
          },
          hooks.cancelled};
}

Outcome outcome_of(const StudyReport& report) {
  Outcome outcome;
  for (const SceneChapter& scene : report.scenes) {
    std::vector<std::string> sentences = method_sentences(scene.study);
    if (report.scenes.size() == 1) std::ranges::move(headlines(scene.study), std::back_inserter(sentences));
    outcome.scenes.push_back({scene.title, std::move(sentences)});
    if (const std::string drift = drift_warning(scene.study); !drift.empty()) {
      outcome.notes.push_back(report.scenes.size() > 1 ? scene.title + ": " + drift : drift);
    }
  }
  return outcome;
}

// The line of the page that says what was asked for: a finished folder of the same request need not be computed again.
std::string identity_line(const Plan& plan) {
  text::Fnv1a hash;
  const auto add = [&](const std::string& text) {
    hash.add(std::uint64_t{text.size()});
    hash.add_bytes(text);
  };
  add(std::string(kVersion));
  add(plan.flags);
  for (const PlannedScene& scene : plan.scenes) add(scene.title + '\n' + study::text_of_exact_values(scene.request));
  return "<!-- request " + hash.digits() + " -->";
}

std::filesystem::path page_in(const std::filesystem::path& folder) { return folder / page::kReportFile; }

void write_tables(const SceneChapter& scene, const std::filesystem::path& folder, const Hooks& hooks) {
  for (const StudyTable& table : tables()) {
    if (!table.has_rows(scene.study)) continue;
    files::require_not_cancelled(hooks);
    table::write(table.make(scene.study), folder / file_name(scene, table));
  }
}

}  // namespace

void Plan::add_scene(std::string scene_title, std::shared_ptr<const Scene> scene, study::Request request,
                     std::vector<Problem> warnings) {
  std::string name = file_word(scene_title, scenes);
  scenes.push_back(
      {std::move(name), std::move(scene_title), std::move(scene), std::move(request), std::move(warnings)});
}

std::vector<std::string> write(const StudyReport& report, const std::filesystem::path& folder, const Hooks& hooks) {
  page::StagedFolder staged(folder);
  std::vector<std::string> messages;
  std::string without_gnuplot;  // why there are no figures, once that is known
  const auto draw = [&](std::vector<page::Figure> figures, std::vector<LeftOut> left_out, const std::string& prefix) {
    for (page::Figure& figure : figures) figure.id = prefix.empty() ? figure.id : prefix + '-' + figure.id;
    page::DrawnFigures drawn;
    drawn.none = without_gnuplot;
    if (drawn.none.empty()) drawn = page::draw_figures(std::move(figures), staged.path(), messages, hooks);
    without_gnuplot = drawn.none;
    std::ranges::move(drawn.left_out, std::back_inserter(left_out));
    return Page{std::move(drawn), std::move(left_out)};
  };
  std::vector<Page> pages;
  for (const SceneChapter& scene : report.scenes) {
    write_tables(scene, staged.path(), hooks);
    std::vector<LeftOut> left_out = scene.study.left_out;
    std::vector<page::Figure> wanted = figures(scene.study, left_out);
    std::optional<Strip> strip = strip_of(scene.study, left_out, hooks);
    pages.push_back(draw(std::move(wanted), std::move(left_out), scene.name));
    pages.back().strip = std::move(strip);
  }
  files::write_file(staged.path() / page::kReportFile, [&](std::ostream& out) { out << report_page(report, pages); });
  files::require_not_cancelled(hooks);
  staged.commit();
  return messages;
}

Outcome carry_out(const Plan& plan, const std::filesystem::path& folder, jobs::Journal& journal, const Hooks& hooks) {
  if (!plan.vtk.empty() && plan.scenes.size() != 1) {
    text::refuse("the report has " + text::counted(plan.scenes.size(), "scene") + ", and --vtk one file",
                 "a file shows the receivers of one scene", "compare each scene by itself, or leave out --vtk");
  }
  StudyReport report;
  report.title = plan.title;
  report.command_line = plan.command_line;
  report.identity = identity_line(plan);
  for (const PlannedScene& scene : plan.scenes) {
    report.scenes.push_back({scene.name, scene.title, study::run(scene.request, with_title(scene, hooks), &journal)});
  }
  if (!plan.vtk.empty()) write_vtk(report.scenes.front().study, plan.vtk, hooks);
  Outcome outcome = outcome_of(report);
  std::ranges::move(write(report, folder, hooks), std::back_inserter(outcome.notes));
  return outcome;
}

bool has_report(const std::filesystem::path& folder) { return files::is_there(page_in(folder)); }

Finished finished_report(const Plan& plan, const std::filesystem::path& folder) {
  if (!has_report(folder)) return Finished::kNone;
  const std::string wanted = identity_line(plan);
  std::ifstream page(page_in(folder), std::ios::binary);
  for (std::string line; std::getline(page, line);) {
    if (line == wanted) return Finished::kOfThis;
  }
  return Finished::kOfAnother;
}

}  // namespace exactff::report

namespace exactff::study {

std::vector<std::string> write_report(const Study& study, const std::filesystem::path& folder, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  report::StudyReport report;
  report.scenes.push_back({"", study.request.scene_name, study});
  report.command_line = study.request.command_line;
  return write(report, folder, hooks);
}

}  // namespace exactff::study
