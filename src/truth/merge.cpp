// Merges shards into one truth file. Every shard holds its chunks in order, so reading all shards in parallel gives the
// rows in order.
#include <algorithm>
#include <charconv>
#include <map>
#include <system_error>

#include "kernel/float_environment.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "truth/journal.h"

namespace exactff::truth {
namespace {

namespace fs = std::filesystem;
using text::refuse;

constexpr std::string_view kShardLine = "# shard: ";
constexpr std::string_view kRowsLine = "# rows: ";

struct ShardFile {
  File file;
  std::string head;  // without the line that identifies the shard
  Shard shard;
  std::uint64_t rows = 0;  // of all shards together
  std::vector<Block> blocks;
};

// The line of the head that begins with `beginning`, without that beginning; empty if there is none.
std::string_view line_of(std::string_view head, std::string_view beginning) {
  for (std::size_t at = 0; at < head.size(); at = head.find('\n', at) + 1) {
    const std::string_view line = head.substr(at, head.find('\n', at) - at);
    if (line.starts_with(beginning)) return line.substr(beginning.size());
  }
  return {};
}

bool read_number(std::string_view& text, std::uint64_t& number) {
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  text.remove_prefix(static_cast<std::size_t>(end.ptr - text.data()));
  return end.ec == std::errc{};
}

// "2/4 in chunks of 64 rows, ..."
bool read_shard(std::string_view text, Shard& shard) {
  if (!read_number(text, shard.number) || !text.starts_with('/')) return false;
  text.remove_prefix(1);
  return read_number(text, shard.count) && shard.number >= 1 && shard.number <= shard.count &&
         text.starts_with(" in chunks of " + std::to_string(kChunkRows) + " rows");
}

std::uint64_t chunks_of(const ShardFile& shard) {
  const std::uint64_t chunks = (shard.rows + kChunkRows - 1) / kChunkRows;
  return (chunks + shard.shard.count - shard.shard.number) / shard.shard.count;
}

// The rows that chunk `index` of the shard should hold.
Range chunk_of(const ShardFile& shard, std::uint64_t index) {
  const std::uint64_t first = (index * shard.shard.count + shard.shard.number - 1) * kChunkRows;
  return {first, static_cast<std::uint32_t>(std::min<std::uint64_t>(kChunkRows, shard.rows - first))};
}

void read_chunks(ShardFile& shard, std::uint64_t head_bytes) {
  Blocks found = find_blocks(shard.file, head_bytes);
  bool whole = found.damaged == 0 && found.end == shard.file.size() && found.list.size() == chunks_of(shard);
  for (std::size_t i = 0; whole && i < found.list.size(); ++i) whole = found.list[i].range == chunk_of(shard, i);
  if (!whole) {
    refuse(shard.file.path(),
           "is damaged: " + std::to_string(found.list.size()) + " of its " + text::counted(chunks_of(shard), "chunk") +
               " of rows are intact",
           "every row is needed", "delete it and compute this shard again");
  }
  shard.blocks = std::move(found.list);
}

ShardFile read_shard_file(const fs::path& path) {
  ShardFile shard{File(path, File::Mode::kRead), {}, {}, 0, {}};
  const std::string head = read_head(shard.file).value_or("");
  if (!line_of(head, "# unfinished: ").empty()) {
    refuse(path, "is the journal of an unfinished run", "rows are missing",
           "complete it with the same exactff truth command and --resume");
  }
  std::string_view rows = line_of(head, kRowsLine);
  const std::string_view told = line_of(head, kShardLine);
  if (!head.starts_with("# exactff ") || !read_number(rows, shard.rows) || !read_shard(told, shard.shard)) {
    refuse(path, "is not a shard of a truth file", "shards are written by exactff truth --shard 1/4 and so on",
           "name only those files");
  }
  const auto line = static_cast<std::size_t>(told.data() - head.data()) - kShardLine.size();
  shard.head = head.substr(0, line) + head.substr(head.find('\n', line) + 1);
  read_chunks(shard, head.size());
  return shard;
}

// By shard number.
using Shards = std::map<std::uint64_t, ShardFile>;

void add(Shards& shards, ShardFile shard) {
  if (!shards.empty()) {
    const ShardFile& first = shards.begin()->second;
    if (shard.shard.count != first.shard.count) {
      refuse(shard.file.path(), "is one of " + text::counted(shard.shard.count, "shard"),
             first.file.path().string() + " is one of " + std::to_string(first.shard.count),
             "name shards of the same request");
    }
    require_same_head(shard.file.path(), shard.head, first.head, first.file.path().string() + " says",
                      "name shards of the same request");
  }
  const auto [place, is_new] = shards.try_emplace(shard.shard.number, std::move(shard));
  if (is_new) return;
  refuse(shard.file.path(),
         "is shard " + std::to_string(place->first) + ", and so is " + place->second.file.path().string(),
         "its rows would occur twice", "give each shard once");
}

Shards read_all(const std::vector<fs::path>& paths, Pace& pace) {
  std::vector<Problem> problems;
  Shards shards;
  for (const fs::path& path : paths) {
    pace.add(1);
    try {
      add(shards, read_shard_file(path));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return shards;
}

void require_all(const Shards& shards) {
  if (shards.empty()) refuse("no shard is named", "there is nothing to merge", "name the files of the shards");
  const std::uint64_t count = shards.begin()->second.shard.count;
  if (shards.size() == count) return;
  constexpr std::size_t kMostNamed = 20;
  std::vector<std::string> missing;
  for (std::uint64_t number = 1; number <= count && missing.size() <= kMostNamed; ++number) {
    if (!shards.contains(number)) missing.push_back(std::to_string(number));
  }
  if (missing.size() > kMostNamed) missing.back() = "more";
  refuse("of " + text::counted(count, "shard") + " these are missing: " + text::enumerate(missing),
         "every row is needed", "add these files");
}

}  // namespace

Summary merge(const std::vector<fs::path>& paths, const fs::path& file, Existing existing, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  require_free(file, existing == Existing::kReplace ? existing : Existing::kRefuse);
  Pace reading("reading shards", paths.size(), hooks);
  const Shards shards = read_all(paths, reading);
  require_all(shards);
  const ShardFile& first = shards.begin()->second;
  WholeFile whole(file);
  whole.append(first.head);
  Pace pace("writing the file", first.rows, hooks);
  Tally tally;
  for (std::uint64_t chunk = 0; chunk * kChunkRows < first.rows; ++chunk) {
    const ShardFile& shard = shards.at(chunk % first.shard.count + 1);
    const Block& block = shard.blocks[chunk / first.shard.count];
    const std::string lines = read_lines(shard.file, block);
    if (!tally.add_rows(lines, block.range.rows)) {
      refuse(shard.file.path(), "changed while it was being read", "every row is needed", "try again");
    }
    whole.append(lines);
    pace.add(block.range.rows);
  }
  whole.commit();
  Summary summary;
  summary.rows = tally.rows();
  summary.rows_by_status = tally.by_status();
  return summary;
}

}  // namespace exactff::truth
