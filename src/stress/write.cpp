#include <iterator>

#include "kernel/float_environment.h"
#include "page/output_folder.h"
#include "stress/report.h"
#include "work/file.h"
#include "work/parallel.h"

namespace exactff::stress {

std::vector<std::string> write(const Report& report, const std::filesystem::path& folder, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  page::StagedFolder staged(folder);
  std::vector<std::string> messages;
  for (const StressTable& table : tables()) {
    work::require_not_cancelled(hooks);
    work::write_file(staged.path() / table.file, [&](std::ostream& out) { table.write(report, out); });
  }
  std::vector<page::Figure> wanted;
  for (const FamilyResult& family : report.families) {
    std::vector<page::Figure> some = figures(family);
    std::move(some.begin(), some.end(), std::back_inserter(wanted));
  }
  const page::DrawnFigures drawn = page::draw_figures(std::move(wanted), staged.path(), messages, hooks);
  work::write_file(staged.path() / page::kReportFile, [&](std::ostream& out) { out << report_page(report, drawn); });
  work::require_not_cancelled(hooks);
  staged.commit();
  return messages;
}

}  // namespace exactff::stress
