#include "text/text_lines.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace exactff {
namespace {

using Lines = std::vector<std::pair<std::size_t, std::string>>;

Lines read(std::string_view text) {
  Lines result;
  text::TextLines lines(text);
  for (text::TextLine line; lines.next(line);) {
    if (!line.text.empty()) result.emplace_back(line.number, line.text);
  }
  return result;
}

TEST(TextLines, EveryKindOfLineEndCounts) {
  EXPECT_EQ(read("a\nb\r\nc\rd\n\ne"), (Lines{{1, "a"}, {2, "b"}, {3, "c"}, {4, "d"}, {6, "e"}}));
}

TEST(TextLines, BackslashJoinsAndTheFirstLineNumberStands) {
  EXPECT_EQ(read("f 1 2 \\\n 3\\\r\n4\nv"), (Lines{{1, "f 1 2  3 4"}, {4, "v"}}));
  EXPECT_EQ(read("a \\"), (Lines{{1, "a"}}));
  EXPECT_EQ(read("a \\  \nb"), (Lines{{1, "a  b"}}));
}

TEST(TextLines, CommentsStartAtAWordAndNeverContinue) {
  EXPECT_EQ(read("# one \\\nv 1 # two \\\ng a#b"), (Lines{{2, "v 1"}, {3, "g a#b"}}));
}

TEST(TextLines, ByteOrderMarkAndOuterBlanksVanish) { EXPECT_EQ(read("\xEF\xBB\xBF\t v  \t"), (Lines{{1, "v"}})); }

TEST(TextLines, WordsAreSeparatedByBlanksAndTabs) {
  EXPECT_EQ(text::words(" a\tb  c "), (std::vector<std::string_view>{"a", "b", "c"}));
  EXPECT_TRUE(text::words(" \t").empty());
}

TEST(PlainLines, NothingIsRemovedButLineEnds) {
  text::PlainLines lines("\xEF\xBB\xBF a # b \\\r\n\rc\n\r\n \nd", 10);
  Lines all;
  for (text::TextLine line; lines.next(line);) {
    all.emplace_back(line.number, line.text);
    EXPECT_EQ(lines.is_cut_off(), line.number == 16);
  }
  EXPECT_EQ(all, (Lines{{11, " a # b \\"}, {12, ""}, {13, "c"}, {14, ""}, {15, " "}, {16, "d"}}));
  EXPECT_EQ(lines.bytes_left(), 0U);
}

TEST(PlainLines, ManyLinesOfEitherEndTakeLinearTime) {
  for (const char* end : {"\n", "\r", "\r\n"}) {
    std::string text;
    for (int i = 0; i < 300'000; ++i) text += end;
    text::PlainLines lines(text);
    std::size_t count = 0;
    for (text::TextLine line; lines.next(line);) ++count;
    EXPECT_EQ(count, 300'000U);
  }
}

}  // namespace
}  // namespace exactff
