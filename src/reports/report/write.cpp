#include <iterator>

#include "files/file.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "page/chapter.h"
#include "page/output_folder.h"
#include "report/figures.h"
#include "report/report.h"
#include "report/scene_part.h"
#include "report/strip.h"
#include "report/tables.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

namespace fs = std::filesystem;

void write_tables(const SceneChapter& scene, const fs::path& folder, const Hooks& hooks) {
  for (const StudyTable& table : tables()) {
    if (!table.has_rows(scene.study)) continue;
    files::require_not_cancelled(hooks);
    files::write_file(folder / file_name(scene, table), [&](std::ostream& out) { table.write(scene.study, out); });
  }
}

void write_tables(const page::Chapter& chapter, const fs::path& folder) {
  for (const auto* list : {&chapter.values, &chapter.times}) {
    for (const page::CsvFile& table : *list) {
      files::write_file(folder / table.file, [&](std::ostream& out) {
        out << "# " << text::program_version() << " compare: " << text::csv_comment(table.holds) << '\n' << table.csv;
      });
    }
  }
}

class PageDrawer {
 public:
  PageDrawer(const fs::path& scratch, std::vector<std::string>& messages, const Hooks& hooks)
      : scratch_(scratch), messages_(messages), hooks_(hooks) {}

  Page draw(std::vector<page::Figure> figures, std::vector<LeftOut> left_out, const std::string& prefix) {
    for (page::Figure& figure : figures) figure.id = prefix.empty() ? figure.id : prefix + '-' + figure.id;
    page::DrawnFigures drawn;
    if (without_gnuplot_.empty()) {
      drawn = page::draw_figures(std::move(figures), scratch_, messages_, hooks_);
      without_gnuplot_ = drawn.none;
    } else {
      drawn.none = without_gnuplot_;
    }
    std::move(drawn.left_out.begin(), drawn.left_out.end(), std::back_inserter(left_out));
    return {std::move(drawn), std::move(left_out)};
  }

 private:
  const fs::path& scratch_;
  std::vector<std::string>& messages_;
  const Hooks& hooks_;
  std::string without_gnuplot_;
};

}  // namespace

std::string file_name(const SceneChapter& scene, const StudyTable& table) {
  return (scene.name.empty() ? std::string() : scene.name + '_') + std::string(table.file);
}

std::vector<std::string> write(const StudyReport& report, const fs::path& folder, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  page::StagedFolder staged(folder);
  std::vector<std::string> messages;
  PageDrawer drawer(staged.path(), messages, hooks);
  Pages pages;
  for (const SceneChapter& scene : report.scenes) {
    write_tables(scene, staged.path(), hooks);
    std::vector<LeftOut> left_out = scene.study.left_out;
    std::vector<page::Figure> wanted = figures(scene.study, left_out);
    std::optional<Strip> strip = strip_of(scene.study, left_out, hooks);
    pages.scenes.push_back(drawer.draw(std::move(wanted), std::move(left_out), scene.name));
    pages.scenes.back().strip = std::move(strip);
  }
  for (const page::Chapter& chapter : report.chapters) {
    write_tables(chapter, staged.path());
    pages.chapters.push_back(drawer.draw(chapter.figures, chapter.left_out, chapter.name));
  }
  files::write_file(staged.path() / page::kReportFile, [&](std::ostream& out) { out << report_page(report, pages); });
  files::require_not_cancelled(hooks);
  staged.commit();
  return messages;
}

}  // namespace exactff::report

namespace exactff::study {

std::vector<std::string> write_report(const Study& study, const std::filesystem::path& folder, const Hooks& hooks) {
  report::StudyReport report;
  report.scenes.push_back({"", study.request.scene_name, study});
  report.command_line = study.request.command_line;
  return write(report, folder, hooks);
}

}  // namespace exactff::study
