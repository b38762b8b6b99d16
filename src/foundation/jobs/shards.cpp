#include "jobs/shards.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <memory>
#include <utility>

#include "jobs/journal.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::jobs {

namespace fs = std::filesystem;

namespace {

using text::refuse;

constexpr std::string_view kShardLine = "# shard: ";
constexpr std::uint64_t kMostChunk = 1 << 16;

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
bool read_shard(std::string_view text, Plan& plan) {
  Shard& shard = plan.shard;
  constexpr std::string_view kChunks = " in chunks of ";
  if (!read_number(text, shard.number) || !text.starts_with('/')) return false;
  text.remove_prefix(1);
  if (!read_number(text, shard.count) || shard.number < 1 || shard.number > shard.count) return false;
  if (!text.starts_with(kChunks)) return false;
  text.remove_prefix(kChunks.size());
  std::uint64_t chunk = 0;
  if (!read_number(text, chunk) || chunk < 1 || chunk > kMostChunk) return false;
  plan.chunk = static_cast<std::uint32_t>(chunk);
  return text.starts_with(' ' + std::string(plan.kind.rows) + ',');
}

struct ShardFile {
  File file;
  std::string head;  // without the line that identifies the shard
  Plan plan;
  std::vector<Block> blocks;
};

void read_chunks(ShardFile& shard, std::uint64_t head_bytes) {
  const Plan& plan = shard.plan;
  Blocks found = find_blocks(shard.file, head_bytes, kRowsWord);
  bool whole = found.damaged == 0 && found.end == shard.file.size() && found.list.size() == plan.shard_chunks();
  for (std::size_t i = 0; whole && i < found.list.size(); ++i)
    whole = range_of(found.list[i]) == plan.chunk_of_shard(i);
  if (!whole) {
    refuse(shard.file.path(),
           "is damaged: " + std::to_string(found.list.size()) + " of its " +
               text::counted(plan.shard_chunks(), "chunk") + " of " + std::string(plan.kind.rows) + " are intact",
           "every " + std::string(plan.kind.row) + " is needed", "delete it and compute this shard again");
  }
  shard.blocks = std::move(found.list);
}

ShardFile read_shard_file(const fs::path& path, const RowKind& kind) {
  const std::string command(kind.command);
  ShardFile shard{File(path, File::Mode::kRead), {}, {.kind = kind, .shard = {}}, {}};
  const std::string head = read_head(shard.file).value_or("");
  if (!line_of(head, "# unfinished: ").empty()) {
    refuse(path, "is the journal of an unfinished run", std::string(kind.rows) + " are missing",
           "complete it with the same exactff " + command + " command and --resume");
  }
  std::string_view rows = line_of(head, "# " + std::string(kind.rows) + ": ");
  const std::string_view told = line_of(head, kShardLine);
  if (!head.starts_with("# exactff ") || !read_number(rows, shard.plan.count) || !read_shard(told, shard.plan)) {
    refuse(path, "is not a shard of " + std::string(kind.file),
           "shards are written by exactff " + command + " --shard 1/4 and so on", "name only those files");
  }
  const auto line = static_cast<std::size_t>(told.data() - head.data()) - kShardLine.size();
  shard.head = head.substr(0, line) + head.substr(head.find('\n', line) + 1);
  read_chunks(shard, head.size());
  return shard;
}

// By shard number.
using ShardFiles = std::map<std::uint64_t, ShardFile>;

void add(ShardFiles& shards, ShardFile shard) {
  const Plan plan = shard.plan;
  if (!shards.empty()) {
    const ShardFile& first = shards.begin()->second;
    if (plan.shard.count != first.plan.shard.count || plan.chunk != first.plan.chunk) {
      refuse(shard.file.path(), "is one of " + text::counted(plan.shard.count, "shard"),
             first.file.path().string() + " is one of " + std::to_string(first.plan.shard.count),
             "name shards of the same request");
    }
    require_same_head(shard.file.path(), shard.head, first.head, first.file.path().string() + " says",
                      "name shards of the same request");
  }
  const auto [place, is_new] = shards.try_emplace(plan.shard.number, std::move(shard));
  if (is_new) return;
  refuse(shard.file.path(),
         "is shard " + std::to_string(place->first) + ", and so is " + place->second.file.path().string(),
         "its " + std::string(plan.kind.rows) + " would occur twice", "give each shard once");
}

ShardFiles read_all(const std::vector<fs::path>& paths, const RowKind& kind, Pace& pace) {
  std::vector<Problem> problems;
  ShardFiles shards;
  for (const fs::path& path : paths) {
    pace.add(1);
    try {
      add(shards, read_shard_file(path, kind));
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(std::move(problems));
  return shards;
}

void require_all(const ShardFiles& shards) {
  if (shards.empty()) refuse("no shard is named", "there is nothing to merge", "name the files of the shards");
  const Plan& plan = shards.begin()->second.plan;
  if (shards.size() == plan.shard.count) return;
  constexpr std::size_t kMostNamed = 20;
  std::vector<std::string> missing;
  for (std::uint64_t number = 1; number <= plan.shard.count && missing.size() <= kMostNamed; ++number) {
    if (!shards.contains(number)) missing.push_back(std::to_string(number));
  }
  if (missing.size() > kMostNamed) missing.back() = "more";
  refuse("of " + text::counted(plan.shard.count, "shard") + " these are missing: " + text::enumerate(missing),
         "every " + std::string(plan.kind.row) + " is needed", "add these files");
}

void take_chunks(const ShardFiles& shards, const RowHooks& hooks, const MergedShards::Take& take) {
  const Plan& plan = shards.begin()->second.plan;
  Pace pace("writing the file", plan.count, hooks);
  for (std::uint64_t chunk = 0; chunk < plan.chunks(); ++chunk) {
    const ShardFile& shard = shards.at(chunk % plan.shard.count + 1);
    const Block& block = shard.blocks[chunk / plan.shard.count];
    if (!take(range_of(block), read_bytes(shard.file, block))) {
      refuse(shard.file.path(), "changed while it was being read", "every " + std::string(plan.kind.row) + " is needed",
             "try again");
    }
    pace.add(range_of(block).rows);
  }
}

}  // namespace

std::string command_of_shard(const fs::path& file) {
  constexpr std::size_t kMostRead = 1 << 12;
  try {
    const std::string text = File(file, File::Mode::kRead).read(0, kMostRead);
    const std::string first = text.substr(0, text.find('\n'));
    for (const std::string command : {"truth", "matrix"}) {
      if (first.starts_with("# exactff ") && first.find(' ' + command + ": ") != std::string::npos) return command;
    }
  } catch (const InputError&) {  // merge() says why
  }
  return {};
}

MergedShards read_shards(const std::vector<fs::path>& paths, const RowKind& kind, const RowHooks& hooks) {
  Pace reading("reading shards", paths.size(), hooks);
  auto shards = std::make_shared<const ShardFiles>(read_all(paths, kind, reading));
  require_all(*shards);
  const ShardFile& first = shards->begin()->second;
  return {first.head, first.plan.count,
          [shards, hooks](const MergedShards::Take& take) { take_chunks(*shards, hooks, take); }};
}

}  // namespace exactff::jobs
