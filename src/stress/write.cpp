#include <iterator>

#include "exactff/stress.h"
#include "kernel/float_environment.h"
#include "stress/figures.h"
#include "stress/report_page.h"
#include "stress/tables.h"
#include "study/output_folder.h"
#include "study/page_files.h"

namespace exactff::stress {

std::vector<std::string> write(const Report& report, const std::filesystem::path& folder, const study::Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  study::StagedFolder staged(folder);
  std::vector<std::string> messages;
  for (const Table& table : tables()) {
    study::require_not_cancelled(hooks);
    study::write_file(staged.path() / table.file, [&](std::ostream& out) { table.write(report, out); });
  }
  std::vector<study::Figure> wanted;
  for (const FamilyResult& family : report.families) {
    std::vector<study::Figure> some = figures(family);
    std::move(some.begin(), some.end(), std::back_inserter(wanted));
  }
  const study::DrawnFigures drawn = study::draw_figures(std::move(wanted), staged.path(), messages, hooks);
  study::write_file(staged.path() / study::kReportFile, [&](std::ostream& out) { out << report_page(report, drawn); });
  study::require_not_cancelled(hooks);
  staged.commit();
  return messages;
}

}  // namespace exactff::stress
