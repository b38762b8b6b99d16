#include "jobs/blocks.h"

#include <charconv>
#include <limits>
#include <utility>

#include "text/hashes.h"

namespace exactff::jobs {
namespace {

constexpr std::string_view kBeforeCrc = " bytes, crc ";
constexpr std::size_t kLongestLine = 512;
constexpr std::size_t kReadBytes = 1 << 20;

std::string opening_of(std::string_view word) { return "# " + std::string(word) + ' '; }

// The whole text as a number.
bool whole_number(std::string_view text, std::uint64_t& number) {
  const auto end = std::from_chars(text.data(), text.data() + text.size(), number);
  return end.ec == std::errc{} && end.ptr == text.data() + text.size();
}

// The block whose comment line is at `offset`; nothing if the block is damaged. The name may hold any text, so the line
// is read from its end.
std::optional<Block> block_at(const File& file, std::uint64_t offset, std::string_view opening) {
  const std::string text = file.read(offset, kLongestLine);
  const std::size_t end = text.find('\n');
  const std::string_view line = std::string_view(text).substr(0, end);
  const std::size_t crc = line.rfind(kBeforeCrc), comma = line.rfind(", ", crc == 0 ? 0 : crc - 1);
  if (end == std::string::npos || crc == std::string_view::npos || comma == std::string_view::npos) return std::nullopt;
  if (!line.starts_with(opening) || comma < opening.size()) return std::nullopt;
  Block block{std::string(line.substr(opening.size(), comma - opening.size())), offset + end + 1};
  if (!whole_number(line.substr(comma + 2, crc - comma - 2), block.bytes)) return std::nullopt;
  if (block.bytes > file.size() - block.offset) return std::nullopt;
  const std::size_t digits = crc + kBeforeCrc.size();
  if (line.substr(digits) != text::crc32_digits(line.substr(0, digits), read_bytes(file, block))) return std::nullopt;
  return block;
}

// Where the next comment line of a block may begin, after `offset`. Does not require a line break before it: that may
// be damaged, too.
std::optional<std::uint64_t> next_opening(const File& file, std::uint64_t offset, std::string_view opening) {
  for (++offset;;) {
    const std::string bytes = file.read(offset, kReadBytes);
    if (const std::size_t found = bytes.find(opening); found != std::string::npos) return offset + found;
    if (bytes.size() < kReadBytes) return std::nullopt;
    offset += bytes.size() - opening.size();  // the text may lie across two reads
  }
}

}  // namespace

std::optional<std::string> read_head(const File& file) {
  std::string text;
  for (std::size_t line = 0;;) {
    const std::string more = file.read(text.size(), kReadBytes);
    text += more;
    for (std::size_t end = text.find('\n', line); end != std::string::npos; end = text.find('\n', line)) {
      if (text[line] != '#') return text.substr(0, end + 1);
      line = end + 1;
    }
    if (more.empty()) return std::nullopt;
  }
}

std::string block_text(std::string_view word, std::string_view name, std::string_view bytes) {
  std::string text = opening_of(word);
  text.append(name).append(", ").append(std::to_string(bytes.size())).append(kBeforeCrc);
  text += text::crc32_digits(text, bytes) + '\n';
  text += bytes;
  return text;
}

Blocks find_blocks(const File& file, std::uint64_t head_bytes, std::string_view word) {
  const std::string opening = opening_of(word);
  Blocks blocks;
  blocks.end = head_bytes;
  std::optional<std::uint64_t> offset = head_bytes;
  while (offset && *offset < file.size()) {
    if (std::optional<Block> block = block_at(file, *offset, opening)) {
      blocks.damaged += *offset - blocks.end;
      blocks.end = block->offset + block->bytes;
      offset = blocks.end;
      blocks.list.push_back(std::move(*block));
    } else {
      offset = next_opening(file, *offset, opening);
    }
  }
  return blocks;
}

std::string read_bytes(const File& file, const Block& block) {
  return file.read(block.offset, static_cast<std::size_t>(block.bytes));
}

std::string name_of(Range range) { return std::to_string(range.first) + '+' + std::to_string(range.rows); }

Range range_of(const Block& block) {
  const std::string_view name = block.name;
  const std::size_t plus = name.find('+');
  std::uint64_t first = 0, rows = 0;
  const bool is_range = plus != std::string_view::npos && whole_number(name.substr(0, plus), first) &&
                        whole_number(name.substr(plus + 1), rows) && rows <= std::numeric_limits<std::uint32_t>::max();
  return is_range ? Range{first, static_cast<std::uint32_t>(rows)} : Range{};
}

std::string block_text(Range range, std::string_view lines) { return block_text(kRowsWord, name_of(range), lines); }

}  // namespace exactff::jobs
