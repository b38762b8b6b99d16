// The shards of one request. Every shard holds its chunks in order, so reading all shards in parallel gives the rows in
// order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "exactff/jobs.h"
#include "jobs/rows.h"

namespace exactff::jobs {

struct MergedShards {
  // Returns false if the text cannot be that of these rows: the file changed in the meantime.
  using Take = std::function<bool(Range range, const std::string& text)>;

  std::string head;       // of the table
  bool numbered = false;  // Rows::are_numbered
  std::uint64_t rows = 0;
  std::function<void(const Take& take)> for_each_chunk;  // in order
};

// Throws one InputError that lists all problems: shards that are missing, duplicate, damaged, unfinished or of another
// request.
[[nodiscard]] MergedShards read_shards(const std::vector<std::filesystem::path>& paths, const RowHooks& hooks);

}  // namespace exactff::jobs
