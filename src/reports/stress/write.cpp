#include <iterator>

#include "files/file.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "page/output_folder.h"
#include "stress/report.h"

namespace exactff::stress {

namespace {

void write_tables(const Report& report, const std::filesystem::path& folder) {
  for (const StressTable& table : tables()) {
    files::write_file(folder / table.file, [&](std::ostream& out) { table.write(report, out); });
  }
}

void write_page(const Report& report, const page::DrawnFigures& drawn, const std::filesystem::path& folder) {
  files::write_file(folder / page::kReportFile, [&](std::ostream& out) { out << report_page(report, drawn); });
}

}  // namespace

std::filesystem::path part_of(const std::filesystem::path& folder) {
  const std::filesystem::path named = folder.has_filename() ? folder : folder.parent_path();  // DIR/ is DIR
  return named.string() + ".part";
}

void write_part(const Report& report, const std::filesystem::path& folder) {
  const kernel::StandardArithmetic arithmetic;
  page::StagedFolder staged(part_of(folder));
  page::DrawnFigures drawn;
  drawn.none = "There are no figures, because the run was interrupted.";
  write_tables(report, staged.path());
  write_page(report, drawn, staged.path());
  staged.commit();
}

std::vector<std::string> write(const Report& report, const std::filesystem::path& folder, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  page::StagedFolder staged(folder);
  std::vector<std::string> messages;
  files::require_not_cancelled(hooks);
  write_tables(report, staged.path());
  std::vector<page::Figure> wanted;
  for (const FamilyResult& family : report.families) {
    std::vector<page::Figure> some = figures(family);
    std::move(some.begin(), some.end(), std::back_inserter(wanted));
  }
  const page::DrawnFigures drawn = page::draw_figures(std::move(wanted), staged.path(), messages, hooks);
  write_page(report, drawn, staged.path());
  files::require_not_cancelled(hooks);
  staged.commit();
  page::remove_result(part_of(folder));
  return messages;
}

}  // namespace exactff::stress
