#include "jobs/blocks.h"

#include <charconv>

#include "text/hashes.h"

namespace exactff::jobs {
namespace {

constexpr std::string_view kOpening = "# rows ";
constexpr std::size_t kLongestLine = 96;
constexpr std::size_t kReadBytes = 1 << 20;

std::string opening_of(Range range, std::uint64_t bytes) {
  return std::string(kOpening) + std::to_string(range.first) + '+' + std::to_string(range.rows) + ", " +
         std::to_string(bytes) + " bytes, crc ";
}

// Parses the text that block_text wrote, from left to right.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  bool skip(std::string_view word) {
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
  }
  template <class Whole>
  bool number(Whole& value) {
    const auto end = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    at_ = static_cast<std::size_t>(end.ptr - text_.data());
    return end.ec == std::errc{};
  }
  std::string_view take(std::size_t count) {
    const std::string_view word = text_.substr(at_, count);
    at_ += word.size();
    return word;
  }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

// The block whose comment line is at `offset`; nothing if the block is damaged.
std::optional<Block> block_at(const File& file, std::uint64_t offset) {
  const std::string line = file.read(offset, kLongestLine);
  Scanner scan(line);
  Block block;
  if (!(scan.skip(kOpening) && scan.number(block.range.first) && scan.skip("+") && scan.number(block.range.rows) &&
        scan.skip(", ") && scan.number(block.bytes) && scan.skip(" bytes, crc "))) {
    return std::nullopt;
  }
  const std::string opening = line.substr(0, scan.at());
  const std::string_view crc = scan.take(8);
  if (!scan.skip("\n")) return std::nullopt;
  block.offset = offset + scan.at();
  if (block.bytes > file.size() - block.offset) return std::nullopt;
  if (crc != text::crc32_digits(opening, read_lines(file, block))) return std::nullopt;
  return block;
}

// Where the next comment line of a block may begin, after `offset`. Does not require a line break before it: that may
// be damaged, too.
std::optional<std::uint64_t> next_opening(const File& file, std::uint64_t offset) {
  for (++offset;;) {
    const std::string bytes = file.read(offset, kReadBytes);
    if (const std::size_t found = bytes.find(kOpening); found != std::string::npos) return offset + found;
    if (bytes.size() < kReadBytes) return std::nullopt;
    offset += bytes.size() - kOpening.size();  // the text may lie across two reads
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

std::string block_text(Range range, std::string_view lines) {
  std::string text = opening_of(range, lines.size());
  text += text::crc32_digits(text, lines) + '\n';
  text += lines;
  return text;
}

Blocks find_blocks(const File& file, std::uint64_t head_bytes) {
  Blocks blocks;
  blocks.end = head_bytes;
  std::optional<std::uint64_t> offset = head_bytes;
  while (offset && *offset < file.size()) {
    if (const std::optional<Block> block = block_at(file, *offset)) {
      blocks.damaged += *offset - blocks.end;
      blocks.list.push_back(*block);
      blocks.end = block->offset + block->bytes;
      offset = blocks.end;
    } else {
      offset = next_opening(file, *offset);
    }
  }
  return blocks;
}

std::string read_lines(const File& file, const Block& block) {
  return file.read(block.offset, static_cast<std::size_t>(block.bytes));
}

}  // namespace exactff::jobs
