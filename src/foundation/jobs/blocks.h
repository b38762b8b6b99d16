// Blocks: the format of finished rows in a journal and in a shard.
//
// Both files are CSV with comment lines. After the head come the blocks. Each is one comment line
//   # rows FIRST+COUNT, BYTES bytes, crc CRC32
// and then the lines of COUNT rows, BYTES bytes long. FIRST is the number of the first of these rows. The CRC-32 (in 8
// hexadecimal digits) covers the comment line up to the word crc, and the rows. A journal holds its blocks in the order
// in which they were finished. A shard holds each chunk as one block, in order.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/file.h"
#include "jobs/rows.h"

namespace exactff::jobs {

using files::File;
using files::WholeFile;

// The head of a file: its comment lines and the line of column names. Nothing if the file ends before that.
[[nodiscard]] std::optional<std::string> read_head(const File& file);

[[nodiscard]] std::string block_text(Range range, std::string_view lines);

// Where the lines of consecutive rows are in a file.
struct Block {
  Range range;
  std::uint64_t offset = 0;  // of the lines
  std::uint64_t bytes = 0;
};

// The sound blocks of a file, in the order of the file. Damaged parts between them are skipped.
struct Blocks {
  std::vector<Block> list;
  std::uint64_t end = 0;      // of the last sound block; of the head if there is none
  std::uint64_t damaged = 0;  // bytes before `end` that belong to no sound block
};
[[nodiscard]] Blocks find_blocks(const File& file, std::uint64_t head_bytes);

[[nodiscard]] std::string read_lines(const File& file, const Block& block);

}  // namespace exactff::jobs
