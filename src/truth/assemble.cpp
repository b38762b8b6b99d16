#include "truth/assemble.h"

#include <stdexcept>

#include "work/file.h"

namespace exactff::truth {

void Pace::add(std::uint64_t rows) {
  if (hooks_.cancelled && hooks_.cancelled()) throw Cancelled();
  done_ += rows;
  if (hooks_.progress) hooks_.progress({stage_, done_, total_});
}

void assemble(const Rows& rows, RowJournal& journal, const std::filesystem::path& file, const Hooks& hooks,
              Summary& summary) {
  work::WholeFile whole(
      file, {"all rows are finished and kept in " + journal.path().string() + "; the file needs the same space again",
             "free some space, then continue with --resume"});
  const bool in_blocks = rows.request().shard.count > 1;
  Pace pace("writing the file", rows.shard_rows(), hooks);
  Tally tally;
  whole.append(rows.head());
  const std::vector<Block> blocks = journal.blocks();
  // A chunk may have been computed in several blocks. The result must not depend on where it was divided.
  for (std::size_t i = 0; i < blocks.size();) {
    Range range{blocks[i].range.first, 0};
    std::string lines;
    for (; i < blocks.size() && blocks[i].range.first / kChunkRows == range.first / kChunkRows; ++i) {
      lines += journal.read(blocks[i]);
      range.rows += blocks[i].range.rows;
    }
    if (!tally.add_rows(lines, range.rows)) throw std::logic_error("a block of the journal is not what it was");
    whole.append(in_blocks ? block_text(range, lines) : lines);
    pace.add(range.rows);
  }
  whole.commit();
  journal.remove();
  summary.rows_by_status = tally.by_status();
}

}  // namespace exactff::truth
