#include "text/number_text.h"

#include <clocale>

#include "kernel/numbers.h"
#include "support/test.h"
#include "text/csv_lines.h"

namespace exactff {
namespace {

struct Accepted {
  std::string text;
  double value;
};

TEST(NumberText, ReadsDecimalsWithCorrectRounding) {
  const Accepted table[] = {
      {"0", 0.0},
      {"-0", 0.0},
      {"7", 7.0},
      {"+1.5", 1.5},
      {".5", 0.5},
      {"-.5", -0.5},
      {"+.5e1", 5.0},
      {"1.", 1.0},
      {"1.e2", 100.0},
      {"1E+3", 1000.0},
      {"1e-3", 0x1.0624dd2f1a9fcp-10},
      {"0.1", 0x1.999999999999ap-4},
      {"00012.500", 12.5},
      {"9007199254740993", 9007199254740992.0},  // a tie goes to the even neighbour
      {"9007199254740993.0000000000000000001", 9007199254740994.0},
      {"1.7976931348623157e308", std::numeric_limits<double>::max()},
      {"179769313486231580793e288", std::numeric_limits<double>::max()},
      {"2.2250738585072011e-308", 0x0.fffffffffffffp-1022},  // the largest denormal
      {"2.4703282292062327e-324", 0.0},                      // just below half the smallest denormal
      {"2.4703282292062328e-324", 0x1p-1074},                // just above it
      {"-4.9406564584124654e-324", -0x1p-1074},
      {"1e-400", 0.0},
      {"-1e-400", 0.0},
      {"1e-99999999999999999999", 0.0},
      {"0e99999999999999999999", 0.0},
      {"0.0000001e8", 10.0},
  };
  for (const Accepted& entry : table) {
    const text::ParsedNumber number = text::parse_number(entry.text);
    EXPECT_EQ(number.fault, text::NumberFault::kNone) << entry.text;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(number.value), std::bit_cast<std::uint64_t>(entry.value)) << entry.text;
    if (entry.text.find_first_of("+-") == 0) continue;
    EXPECT_EQ(text::parse_number("+" + entry.text).value, entry.value) << entry.text;
  }
}

TEST(NumberText, ATieBelowTheSmallestDenormalIsDecidedByTheLastDigit) {
  kernel::Integer five_to_1075;
  mpz_ui_pow_ui(five_to_1075.get_mpz_t(), 5, 1075);
  const std::string digits = five_to_1075.get_str();  // 2^-1075 = 5^1075 / 10^1075
  EXPECT_EQ(text::parse_number(digits + "e-1075").value, 0.0);
  EXPECT_EQ(text::parse_number(digits + "1e-1076").value, 0x1p-1074);
}

TEST(NumberText, RejectsWhatIsNoNumber) {
  using text::NumberFault;
  const std::pair<NumberFault, std::vector<std::string>> table[] = {
      {NumberFault::kNotANumber,
       {"", "+", "-", ".", "+-1", "--1", "e5", "1e", "1e+", "1.2.3", "1x", "1 ", " 1", "1f", "1d3", "1,5,5"}},
      {NumberFault::kNotFinite, {"nan", "-NaN", "nan(0x1)", "inf", "+Infinity", "-1.#IND", "1.#QNAN"}},
      {NumberFault::kHexadecimal, {"0x10", "-0X1p3"}},
      {NumberFault::kComma, {"1,5"}},
      {NumberFault::kTooLarge, {"1e400", "-1e400", "1.7976931348623159e308", "1e99999999999999999999"}},
  };
  for (const auto& [fault, texts] : table) {
    for (const std::string& text : texts) EXPECT_EQ(text::parse_number(text).fault, fault) << "'" << text << "'";
  }
}

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
  const auto refusal = [&](const std::filesystem::path& path) {
    return complaint([&] {
      text::CsvLines lines(path, "a CSV file");
      for (std::string_view line; lines.next(line);) {
      }
    });
  };
  using namespace std::string_literals;
  EXPECT_HOLDS(refusal(directory.path()), "is a folder");
  EXPECT_HOLDS(refusal(directory.path() / "none.csv"), "cannot be opened");
  EXPECT_HOLDS(refusal(directory.write("u.csv",
                                       "\xFF\xFE"
                                       "a\0"s)),
               "UTF-16");
  EXPECT_HOLDS(refusal(directory.write("z.csv", std::string(70000, 'a') + "\0"s)), "zero bytes");
}

}  // namespace
}  // namespace exactff
