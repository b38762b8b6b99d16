#include "jobs/shards.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "jobs/journal.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::jobs {

namespace fs = std::filesystem;

namespace {

using text::refuse;

struct ShardFile {
  File file;
  ShardHead head;
  std::vector<Block> blocks;
};

void read_chunks(ShardFile& shard, std::uint64_t head_bytes) {
  const Plan& plan = shard.head.plan;
  Blocks found = find_blocks(shard.file, head_bytes, kRowsWord);
  bool whole = found.damaged == 0 && found.end == shard.file.size() && found.list.size() == plan.shard_chunks();
  for (std::size_t i = 0; whole && i < found.list.size(); ++i)
    whole = range_of(found.list[i]) == plan.chunk_of_shard(i);
  if (!whole) {
    refuse(shard.file.path(),
           "is damaged: " + std::to_string(found.list.size()) + " of its " +
               text::counted(plan.shard_chunks(), "chunk") + " of " + plan.kind.rows + " are intact",
           "every " + plan.kind.row + " is needed", "delete it and compute this shard again");
  }
  shard.blocks = std::move(found.list);
}

ShardFile read_shard_file(const fs::path& path) {
  File file(path, File::Mode::kRead);
  const std::string text = read_head(file).value_or("");
  std::optional<ShardHead> head = parse_shard_head(text);
  if (!head) {
    refuse(path, "is not a shard of a table", "shards are written with --shard 1/4 and so on, by this version",
           "name only those files");
  }
  const std::string& command = head->plan.kind.command;
  if (head->unfinished) {
    refuse(path, "is the journal of an unfinished run", "rows are missing",
           "complete it with the same exactff " + command + " command and --resume");
  }
  if (head->plan.shard.count < 2) refuse(path, "is no shard", "it has no part of the rows", "name the shards");
  ShardFile shard{std::move(file), std::move(*head), {}};
  read_chunks(shard, text.size());
  return shard;
}

// By shard number.
using ShardFiles = std::map<std::uint64_t, ShardFile>;

void add(ShardFiles& shards, ShardFile shard) {
  const Plan plan = shard.head.plan;
  if (!shards.empty()) {
    const ShardFile& first = shards.begin()->second;
    const Plan& other = first.head.plan;
    if (plan.shard.count != other.shard.count || plan.chunk != other.chunk) {
      refuse(shard.file.path(), "is one of " + text::counted(plan.shard.count, "shard"),
             first.file.path().string() + " is one of " + std::to_string(other.shard.count),
             "name shards of the same request");
    }
    require_same_head(shard.file.path(), shard.head.table, first.head.table, first.file.path().string() + " has",
                      "name shards of the same request");
  }
  const auto [place, is_new] = shards.try_emplace(plan.shard.number, std::move(shard));
  if (is_new) return;
  refuse(shard.file.path(),
         "is shard " + std::to_string(place->first) + ", and so is " + place->second.file.path().string(),
         "its " + plan.kind.rows + " would occur twice", "give each shard once");
}

ShardFiles read_all(const std::vector<fs::path>& paths, Pace& pace) {
  std::vector<Problem> problems;
  ShardFiles shards;
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

void require_all(const ShardFiles& shards) {
  if (shards.empty()) refuse("no shard is named", "there is nothing to merge", "name the files of the shards");
  const Plan& plan = shards.begin()->second.head.plan;
  if (shards.size() == plan.shard.count) return;
  constexpr std::size_t kMostNamed = 20;
  std::vector<std::string> missing;
  for (std::uint64_t number = 1; number <= plan.shard.count && missing.size() <= kMostNamed; ++number) {
    if (!shards.contains(number)) missing.push_back(std::to_string(number));
  }
  if (missing.size() > kMostNamed) missing.back() = "more";
  refuse("of " + text::counted(plan.shard.count, "shard") + " these are missing: " + text::enumerate(missing),
         "every " + plan.kind.row + " is needed", "add these files");
}

void take_chunks(const ShardFiles& shards, const RowHooks& hooks, const MergedShards::Take& take) {
  const Plan& plan = shards.begin()->second.head.plan;
  Pace pace("writing the file", plan.count, hooks);
  for (std::uint64_t chunk = 0; chunk < plan.chunks(); ++chunk) {
    const ShardFile& shard = shards.at(chunk % plan.shard.count + 1);
    const Block& block = shard.blocks[chunk / plan.shard.count];
    if (!take(range_of(block), read_bytes(shard.file, block))) {
      refuse(shard.file.path(), "changed while it was being read", "every " + plan.kind.row + " is needed",
             "try again");
    }
    pace.add(range_of(block).rows);
  }
}

}  // namespace

MergedShards read_shards(const std::vector<fs::path>& paths, const RowHooks& hooks) {
  Pace reading("reading shards", paths.size(), hooks);
  auto shards = std::make_shared<const ShardFiles>(read_all(paths, reading));
  require_all(*shards);
  const ShardHead& first = shards->begin()->second.head;
  return {first.table, first.numbered, first.plan.count,
          [shards, hooks](const MergedShards::Take& take) { take_chunks(*shards, hooks, take); }};
}

}  // namespace exactff::jobs
