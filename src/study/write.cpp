#include <fstream>

#include "exactff/study.h"
#include "study/figures.h"
#include "study/gnuplot.h"
#include "study/output_folder.h"
#include "study/report_page.h"
#include "study/tables.h"

namespace exactff::study {
namespace {

constexpr const char* kNoGnuplot =
    "There are no figures because gnuplot was not found; install it (Debian: gnuplot-nox) and run the comparison "
    "again. "
    "The tables are complete.";

void require_not_cancelled(const Hooks& hooks) {
  if (hooks.cancelled && hooks.cancelled()) throw Cancelled();
}

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw InputError(Problem{file.string(), 0, "cannot be written", "the disk may be full or read-only", {}});
}

// Calls put(stream); throws unless every byte was written.
template <class Put>
void write_file(const std::filesystem::path& file, const Put& put) {
  std::ofstream out(file, std::ios::binary);
  put(out);
  out.close();
  if (!out) refuse(file);
}

void draw(Page& page, std::vector<Figure> figures, const std::filesystem::path& scratch,
          std::vector<std::string>& messages, const Hooks& hooks) {
  for (Figure& figure : figures) {
    require_not_cancelled(hooks);
    const PlotResult plot = run_gnuplot(figure.script, scratch);
    if (plot.outcome == PlotResult::Outcome::kNoProgram) {
      page.no_figures = kNoGnuplot;
      messages.emplace_back(kNoGnuplot);
      return;
    }
    if (plot.outcome == PlotResult::Outcome::kFailed) {
      messages.push_back("gnuplot could not draw '" + figure.title + "': " + plot.message);
      page.left_out.push_back({"figure: " + figure.title, "gnuplot could not draw it"});
      continue;
    }
    std::string svg = inlined(plot.svg, figure.id, figure.title);
    page.figures.push_back({std::move(figure), std::move(svg)});
  }
}

}  // namespace

std::vector<std::string> write(const Study& study, const std::filesystem::path& folder, const Hooks& hooks) {
  StagedFolder staged(folder);
  std::vector<std::string> messages;
  for (const Table& table : tables()) {
    require_not_cancelled(hooks);
    write_file(staged.path() / table.file, [&](std::ostream& out) { table.write(study, out); });
  }
  Page page;
  page.left_out = study.left_out;
  draw(page, figures(study, page.left_out), staged.path(), messages, hooks);
  write_file(staged.path() / kReportFile, [&](std::ostream& out) { out << report_page(study, page); });
  require_not_cancelled(hooks);
  staged.commit();
  return messages;
}

}  // namespace exactff::study
