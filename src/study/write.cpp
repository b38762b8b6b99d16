#include "exactff/study.h"
#include "study/figures.h"
#include "study/output_folder.h"
#include "study/page_files.h"
#include "study/report_page.h"
#include "study/tables.h"

namespace exactff::study {

std::vector<std::string> write(const Study& study, const std::filesystem::path& folder, const Hooks& hooks) {
  StagedFolder staged(folder);
  std::vector<std::string> messages;
  for (const Table& table : tables()) {
    require_not_cancelled(hooks);
    write_file(staged.path() / table.file, [&](std::ostream& out) { table.write(study, out); });
  }
  std::vector<LeftOut> left_out = study.left_out;
  std::vector<Figure> wanted = figures(study, left_out);
  DrawnFigures drawn = draw_figures(std::move(wanted), staged.path(), messages, hooks);
  left_out.insert(left_out.end(), drawn.left_out.begin(), drawn.left_out.end());
  const Page page{std::move(drawn), std::move(left_out)};
  write_file(staged.path() / kReportFile, [&](std::ostream& out) { out << report_page(study, page); });
  require_not_cancelled(hooks);
  staged.commit();
  return messages;
}

}  // namespace exactff::study
