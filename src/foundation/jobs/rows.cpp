#include "jobs/rows.h"

#include <algorithm>

#include "text/refuse.h"

namespace exactff::jobs {

std::uint64_t Plan::shard_rows() const {
  const std::uint64_t rows = shard_chunks() * chunk;
  const bool has_last = count > 0 && (chunks() - 1) % shard.count == shard.number - 1;
  return has_last ? rows - (chunks() * chunk - count) : rows;  // the last chunk may be shorter
}

Range Plan::chunk_of_shard(std::uint64_t index) const {
  const std::uint64_t first = (index * shard.count + shard.number - 1) * chunk;
  return {first, static_cast<std::uint32_t>(std::min<std::uint64_t>(chunk, count - first))};
}

void require_shard(const Shard& shard) {
  if (shard.number >= 1 && shard.number <= shard.count) return;
  text::refuse("there is no shard " + std::to_string(shard.number) + " of " + std::to_string(shard.count),
               "shards are numbered from 1", "write --shard 1/4 for the first of four");
}

std::string rows_line(const Plan& plan) {
  return "# " + std::string(plan.kind.rows) + ": " + std::to_string(plan.count) + '\n';
}

std::string shard_line(const Plan& plan) {
  if (plan.shard.count <= 1) return {};
  return "# shard: " + std::to_string(plan.shard.number) + '/' + std::to_string(plan.shard.count) + " in chunks of " +
         std::to_string(plan.chunk) + ' ' + std::string(plan.kind.rows) + ", for exactff merge\n";
}

bool Rows::may_be_one_block(Range range) const {
  const std::uint64_t chunk = range.first / plan_.chunk;
  return range.rows > 0 && range.end() <= plan_.count && (range.end() - 1) / plan_.chunk == chunk &&
         chunk % plan_.shard.count == plan_.shard.number - 1;
}

}  // namespace exactff::jobs
