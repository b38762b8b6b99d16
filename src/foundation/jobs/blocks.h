// Blocks: the format of finished work in a journal and in a shard.
//
// After the head of the file come the blocks. Each is one comment line
//   # WORD NAME, BYTES bytes, crc CRC32
// and then BYTES bytes. All blocks of a file have the same word; names differ. The CRC-32 (in 8 hexadecimal digits)
// covers the comment line up to the word crc, and the bytes.
//
// The blocks of a shard, and of a journal of rows, are "rows FIRST+COUNT": the lines of COUNT rows, of which FIRST is
// the number of the first. Such a file is CSV with comment lines. A journal holds its blocks in the order in which they
// were finished. A shard holds each chunk as one block, in order.
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

// Where a block is in a file.
struct Block {
  std::string name;
  std::uint64_t offset = 0;  // of the bytes after the comment line
  std::uint64_t bytes = 0;
};

// Requires a name of less than 400 bytes without a line end.
[[nodiscard]] std::string block_text(std::string_view word, std::string_view name, std::string_view bytes);

// The sound blocks of a file, in the order of the file. Damaged parts between them are skipped.
struct Blocks {
  std::vector<Block> list;
  std::uint64_t end = 0;      // of the last sound block; of the head if there is none
  std::uint64_t damaged = 0;  // bytes before `end` that belong to no sound block
};
[[nodiscard]] Blocks find_blocks(const File& file, std::uint64_t head_bytes, std::string_view word);

[[nodiscard]] std::string read_bytes(const File& file, const Block& block);

// --- blocks of rows ---

inline constexpr std::string_view kRowsWord = "rows";

[[nodiscard]] std::string name_of(Range range);
[[nodiscard]] Range range_of(const Block& block);  // without rows if the name is that of no range
[[nodiscard]] std::string block_text(Range range, std::string_view lines);

}  // namespace exactff::jobs
