#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "exactff/error.h"
#include "support/program.h"
#include "text/csv_dialect.h"

namespace exactff {
namespace {

using validation::TemporaryDirectory;

std::vector<std::string> lines_of(const std::string& text) {
  const TemporaryDirectory directory;
  text::CsvLines lines(directory.write("a.csv", text), "a CSV file");
  std::vector<std::string> result;
  for (std::string_view line; lines.next(line);) {
    result.emplace_back(line);
    EXPECT_EQ(lines.number(), result.size());
  }
  return result;
}

using List = std::vector<std::string>;

TEST(CsvLines, EndInAnyWay) {
  EXPECT_EQ(lines_of("a\nb\r\nc\rd"), (List{"a", "b", "c", "d"}));
  EXPECT_EQ(lines_of("a\n\n\r\n\rb\n"), (List{"a", "", "", "", "b"}));
  EXPECT_EQ(lines_of(""), List{});
  EXPECT_EQ(lines_of("\n"), List{""});
}

// The file is read in blocks of 65536 bytes: here CR LF and a long line cross block borders.
TEST(CsvLines, LieAcrossBlocks) {
  for (const std::size_t length : {65533U, 65534U, 65535U, 65536U, 65537U, 200000U}) {
    const std::string line(length, 'x');
    EXPECT_EQ(lines_of(line + "\r\nb\r\n"), (List{line, "b"})) << length;
  }
}

TEST(CsvLines, RefuseWhatIsNoText) {
  const TemporaryDirectory directory;
  const auto refusal = [&](const std::filesystem::path& path) -> std::string {
    try {
      text::CsvLines lines(path, "a CSV file");
      for (std::string_view line; lines.next(line);) {
      }
    } catch (const InputError& error) {
      return error.what();
    }
    return {};
  };
  using namespace std::string_literals;
  EXPECT_NE(refusal(directory.path()).find("is a folder"), std::string::npos);
  EXPECT_NE(refusal(directory.path() / "none.csv").find("cannot be opened"), std::string::npos);
  EXPECT_NE(refusal(directory.write("u.csv",
                                    "\xFF\xFE"
                                    "a\0"s))
                .find("UTF-16"),
            std::string::npos);
  EXPECT_NE(refusal(directory.write("z.csv", std::string(70000, 'a') + "\0"s)).find("zero bytes"), std::string::npos);
}

List fields_of(std::string_view line) {
  List fields{"left", "over", "from", "before"};
  return text::split_csv_line(line, fields) ? fields : List{"refused"};
}

TEST(CsvFields, AreTrimmedUnlessQuoted) {
  EXPECT_EQ(fields_of("a, b ,\tc"), (List{"a", "b", "c"}));
  EXPECT_EQ(fields_of("\" a \",b"), (List{" a ", "b"}));
  EXPECT_EQ(fields_of(""), List{""});
  EXPECT_EQ(fields_of(",,"), (List{"", "", ""}));
}

TEST(CsvFields, MayHoldCommasAndQuotes) {
  EXPECT_EQ(fields_of(R"("a,b","c ""d""", "" )"), (List{"a,b", "c \"d\"", ""}));
  EXPECT_EQ(fields_of(R"(a"b,c)"), (List{"a\"b", "c"}));
}

TEST(CsvFields, AreRefusedWhereQuotesDoNotMatch) {
  EXPECT_EQ(fields_of("\"a"), List{"refused"});
  EXPECT_EQ(fields_of("\"a\"b,c"), List{"refused"});
  EXPECT_EQ(fields_of("a,\""), List{"refused"});
}

// --- commas or semicolons ---

TEST(CsvDialect, IsRecognisedByTheFirstLine) {
  for (const char* line : {"receiver;value", "\"a,b\";c", "0,5;0,25;1", "7;8", ";b;a", "nan;0,5"}) {
    EXPECT_TRUE(text::CsvDialect(line).has_semicolons()) << line;
  }
  for (const char* line : {"receiver,value", "a;b,c", "\"a;b\",c", "\"a;b\"", "0,5;0,x", ""}) {
    EXPECT_FALSE(text::CsvDialect(line).has_semicolons()) << line;
  }
}

TEST(CsvDialect, SplitsByItsSeparator) {
  List fields;
  EXPECT_TRUE(text::CsvDialect("a;b").split("\"x;y\" ; 0,25;", fields));
  EXPECT_EQ(fields, (List{"x;y", "0,25", ""}));
  EXPECT_TRUE(text::CsvDialect("a,b").split("x;y,1", fields));
  EXPECT_EQ(fields, (List{"x;y", "1"}));
}

// 1,234 may be 1234: so a file has one decimal sign.
TEST(CsvDialect, ReadsDecimalCommasBesideSemicolons) {
  text::CsvDialect german("a;b"), other("a;b"), commas("a,b");
  EXPECT_EQ(german.number("7").value, 7.0);
  EXPECT_EQ(german.number("-1,5E-03").value, -1.5e-3);
  EXPECT_EQ(german.number("0.5").fault, text::NumberFault::kPoint);
  EXPECT_EQ(german.number("0,1").value, 0.1);
  EXPECT_EQ(german.number("1,2,3").fault, text::NumberFault::kNotANumber);
  EXPECT_EQ(german.number("1e999").fault, text::NumberFault::kTooLarge);
  EXPECT_EQ(other.number("0.5").value, 0.5);
  EXPECT_EQ(other.number("1,234").fault, text::NumberFault::kComma);
  EXPECT_EQ(commas.number("1,5").fault, text::NumberFault::kComma);
}

}  // namespace
}  // namespace exactff
