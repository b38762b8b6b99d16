// Names of any bytes in every language that they are written in: every byte, every character, and bytes that are not
// UTF-8.
#include <cstdio>
#include <nlohmann/json.hpp>

#include "support/test.h"
#include "text/csv_lines.h"
#include "text/encoding.h"
#include "text/escape.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::text {
namespace {

std::string encoded(char32_t code) {
  const auto byte = [](char32_t bits) { return static_cast<char>(static_cast<unsigned char>(bits)); };
  if (code < 0x80) return {byte(code)};
  if (code < 0x800) return {byte(0xC0 | code >> 6), byte(0x80 | (code & 0x3F))};
  if (code < 0x10000) return {byte(0xE0 | code >> 12), byte(0x80 | (code >> 6 & 0x3F)), byte(0x80 | (code & 0x3F))};
  return {byte(0xF0 | code >> 18), byte(0x80 | (code >> 12 & 0x3F)), byte(0x80 | (code >> 6 & 0x3F)),
          byte(0x80 | (code & 0x3F))};
}

std::string hexadecimal(const char* format, unsigned number) {
  std::array<char, 16> digits{};
  std::snprintf(digits.data(), digits.size(), format, number);
  return digits.data();
}

// Bytes that no conforming decoder accepts as a character, each with the result when its bytes become visible.
struct Broken {
  std::string bytes;
  std::string shown;
};
const std::vector<Broken>& broken() {
  static const std::vector<Broken> kBroken = {{"\xE4", "\\xe4"},                             // Latin-1
                                              {"\xC0\xAF", "\\xc0\\xaf"},                    // a slash in two bytes
                                              {"\xC1\xBF", "\\xc1\\xbf"},                    // DEL in two
                                              {"\xE0\x80\xAF", "\\xe0\\x80\\xaf"},           // a slash in three
                                              {"\xF0\x80\x80\xAF", "\\xf0\\x80\\x80\\xaf"},  // in four
                                              {"\xED\xA0\x80", "\\xed\\xa0\\x80"},           // half of a surrogate pair
                                              {"\xF4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // U+110000
                                              {"\xF8\x88\x80\x80\x80", "\\xf8\\x88\\x80\\x80\\x80"},  // five bytes
                                              {"\xC3", "\\xc3"},                                      // cut off
                                              {"\xE2\x82", "\\xe2\\x82"},
                                              {"\xF0\x9F\x98", "\\xf0\\x9f\\x98"},
                                              {"\xE2\x82z", "\\xe2\\x82z"},
                                              {"\x80", "\\x80"}};  // begins none
  return kBroken;
}

// Every byte, with a letter on both sides, and every broken sequence.
std::vector<std::string> awkward() {
  std::vector<std::string> texts;
  for (int byte = 0; byte < 256; ++byte) texts.push_back(std::string("a") + static_cast<char>(byte) + "z");
  for (const Broken& one : broken()) texts.push_back("a" + one.bytes + "z");
  for (const char32_t code : {0x80, 0x9B, 0x9F, 0x2028, 0x202A, 0x202E, 0x2066, 0x2069, 0xFFFE, 0xFFFF}) {
    texts.push_back("a" + encoded(code) + "z");
  }
  return texts;
}

// Checks, independently of the tested code, that no control character remains. `kept`: of ASCII.
bool is_harmless(const std::string& text, const std::string& kept = "") {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte < 0x20 && kept.find(text[i]) == std::string::npos) || byte == 0x7F) return false;
    if (text.compare(i, 1, "\xC2") == 0 && static_cast<unsigned char>(text[i + 1]) < 0xA0) return false;
    for (const char* act : {"\u2028", "\u202A", "\u202E", "\u2066", "\u2069", "\uFFFE", "\uFFFF"}) {
      if (text.compare(i, 3, act) == 0) return false;
    }
  }
  return nlohmann::json::accept("\"" + [&] {  // a parser that accepts only well-formed UTF-8
    std::string letters;
    for (const char c : text) letters += c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20 ? 'x' : c;
    return letters;
  }() + "\"");
}

TEST(Characters, EveryOneIsReadBack) {
  for (char32_t code = 0; code <= 0x10FFFF; ++code) {
    if (code == 0xD800) code = 0xE000;
    const std::string bytes = encoded(code);
    const Character c = character_at(bytes, 0);
    ASSERT_TRUE(c.well_formed && c.code == code && c.bytes == bytes.size()) << static_cast<unsigned>(code);
  }
}

TEST(Characters, BytesOfNoneAreTakenOneByOne) {
  for (const Broken& one : broken()) {
    const Character c = character_at(one.bytes, 0);
    EXPECT_FALSE(c.well_formed) << one.shown;
    EXPECT_EQ(c.bytes, 1U) << one.shown;
  }
}

TEST(Printable, EveryByteIsSeen) {
  for (unsigned byte = 0; byte < 256; ++byte) {
    const std::string text(1, static_cast<char>(byte));
    EXPECT_EQ(printable(text), byte >= 0x20 && byte < 0x7F ? text : hexadecimal("\\x%02x", byte));
  }
  for (const Broken& one : broken()) EXPECT_EQ(printable("a" + one.bytes), "a" + one.shown);
}

TEST(Printable, CharactersThatActAreSeenAndOthersStay) {
  for (const char32_t code : {0x80, 0x85, 0x9B, 0x9F, 0x2028, 0x2029, 0x202A, 0x202E, 0x2066, 0x2069, 0xFFFE}) {
    EXPECT_EQ(printable(encoded(code)), hexadecimal("\\u%04x", code));
  }
  for (const char32_t code : {0xA0, 0xE4, 0x20AC, 0x2027, 0x202F, 0x2065, 0x206A, 0xFFFD, 0x1F600, 0x10FFFF}) {
    EXPECT_EQ(printable(encoded(code)), encoded(code));
  }
  EXPECT_EQ(printable("a\\b '\"<&>%"), "a\\b '\"<&>%");
  EXPECT_EQ(printable("a\nb\tc\rd", "\n\t"), "a\nb\tc\\x0dd");
}

TEST(EveryLanguage, LetsNothingAwkwardThrough) {
  for (const std::string& text : awkward()) {
    EXPECT_TRUE(is_harmless(printable(text))) << printable(text);
    EXPECT_TRUE(is_harmless(html(text), "\n\t")) << printable(text);
    EXPECT_TRUE(is_harmless(github_message(text))) << printable(text);
    EXPECT_TRUE(is_harmless(github_property(text))) << printable(text);
    EXPECT_TRUE(is_harmless(gnuplot_string(text))) << printable(text);
    EXPECT_TRUE(is_harmless(shell_word(text))) << printable(text);
    EXPECT_TRUE(is_harmless(json_document({{text, text}}), "\n")) << printable(text);
  }
}

TEST(GitHub, NothingEndsAMessageOrAProperty) {
  EXPECT_EQ(github_message("50 %\nnext: a,b\r"), "50 %25%0Anext: a,b\\x0d");
  EXPECT_EQ(github_property("a:b,c%"), "a%3Ab%2Cc%25");
}

TEST(Json, ReadsBackEveryCharacterAndShowsBytesOfNone) {
  for (const std::string& text : awkward()) {
    const auto read = nlohmann::json::parse(json_document({{"name", text}}));
    EXPECT_EQ(read["name"], utf8(text));
  }
  const auto read = nlohmann::json::parse(json_document({{"\xFFkey", {"\x1B\u0085\u202E\xE4", 1, nullptr, {0.5}}}}));
  EXPECT_EQ(read["\\xffkey"][0], "\x1B\u0085\u202E\\xe4");
  EXPECT_EQ(read["\\xffkey"][3][0], 0.5);
}

// As one of three fields, read by the reader that check uses.
void expect_reads_back(const std::string& text) {
  std::vector<std::string> fields;
  ASSERT_TRUE(text::split_csv_line("first," + csv_field(text) + ",last", fields)) << printable(text);
  ASSERT_EQ(fields.size(), 3U) << printable(text);
  EXPECT_EQ(fields[1], in_utf8(text)) << printable(text);
  EXPECT_TRUE(is_utf8(csv_field(text))) << printable(text);
  EXPECT_TRUE(is_utf8(csv_comment(text))) << printable(text);
}

TEST(Encoding, Utf8StaysAndAnythingElseIsTakenForWindows1252) {
  EXPECT_EQ(in_utf8("Fenster-S\u00FCd \u7A93 \U0001F600"), "Fenster-S\u00FCd \u7A93 \U0001F600");
  EXPECT_EQ(in_utf8("T\xFCr"), "T\u00FCr");
  EXPECT_EQ(in_utf8("5 \x80 \x96 \x9F\xFF"), "5 \u20AC \u2013 \u0178\u00FF");
  EXPECT_EQ(in_utf8("\x81"), "\u0081") << "a byte without a character";
  EXPECT_EQ(in_utf8("\u00E9\xE9"), "\u00C3\u00A9\u00E9") << "as a whole, not byte by byte";
  std::set<std::string> converted;
  for (int byte = 0x80; byte < 0x100; ++byte) {
    const std::string text = in_utf8(std::string(1, static_cast<char>(byte)));
    EXPECT_TRUE(is_utf8(text)) << byte;
    EXPECT_TRUE(converted.insert(text).second) << byte;
  }
}

TEST(Csv, ReadsBackEveryTextButLineBreaks) {
  for (const std::string& text : awkward()) {
    if (text.find_first_of("\r\n") == std::string::npos) expect_reads_back(text);
  }
  for (const std::string text : {"", " a", "a\t", "\"", "a\"b", "a,b", "#", "\v", " "}) expect_reads_back(text);
  EXPECT_EQ(csv_field("a\r\nb"), "a\\x0d\\x0ab");
  EXPECT_EQ(csv_field("a,\nb"), "\"a,\\x0ab\"");
  EXPECT_EQ(csv_comment("a\r\nb"), "a  b");
}

TEST(ShellWord, IsReadBackByBash) {
  std::string all;
  for (int byte = 1; byte < 256; ++byte) all += static_cast<char>(byte);
  for (const std::string& text : {all, std::string("it's \\ plain"), std::string("it's\t\\\x1B"), std::string()}) {
    const auto run = run_program("/bin/bash", {"-c", "printf %s " + shell_word(text)});
    EXPECT_EQ(run.output, text);
  }
  EXPECT_EQ(shell_word("data/room.obj"), "data/room.obj");
  EXPECT_EQ(shell_word("two words"), "'two words'");
}

TEST(Interval, IsRoundedOutwardToAFractionOfItsWidth) {
  EXPECT_EQ(interval(0.8123, 1.0), "[0.812, 1]");
  EXPECT_EQ(interval(0.0, 13.99), "[0, 14]");
  EXPECT_EQ(interval(1.01773, 1.017736), "[1.01773, 1.017736]");
  EXPECT_EQ(interval(-0.5, 216.7), "[-0.5, 217]");
  EXPECT_EQ(interval(-7.33e-9, 3.218e-9), "[-7.4·10⁻⁹, 3.3·10⁻⁹]");
  EXPECT_EQ(interval(0.0, std::numeric_limits<double>::max()), "[0, 1.7976931348623157·10³⁰⁸]");
  EXPECT_EQ(interval(0.0, std::numeric_limits<double>::denorm_min()), "[0, 5·10⁻³²⁴]");
}

double parsed(std::string text) {
  const std::size_t power = text.find("·10");
  if (power == std::string::npos) return parse_number(text).value;
  std::string exponent;
  for (std::size_t i = power + std::string("·10").size(); i < text.size();) {
    for (int digit = -1; digit < 10; ++digit) {
      const std::string shown = digit < 0 ? "⁻" : superscript(digit);
      if (text.compare(i, shown.size(), shown) != 0) continue;
      exponent += digit < 0 ? "-" : std::to_string(digit);
      i += shown.size();
      break;
    }
  }
  return parse_number(text.substr(0, power) + 'e' + exponent).value;
}

TEST(Interval, HoldsTheBoundsThatItShows) {
  for (std::uint64_t s = 0; s < validation::scaled_count(3000); ++s) {
    Random random(validation::seed_of(s));
    const double scale = std::pow(10.0, random.integer(-300, 300)), width = std::pow(0.1, random.integer(0, 16));
    const double lower = scale * random.between(-1, 1), upper = lower + scale * width * random.unit();
    const std::string shown = interval(lower, upper);
    if (shown.front() != '[') continue;
    const std::size_t comma = shown.find(", ");
    const double low = parsed(shown.substr(1, comma - 1)),
                 high = parsed(shown.substr(comma + 2, shown.size() - comma - 3));
    EXPECT_LE(low, lower) << shown << ' ' << s;
    EXPECT_GE(high, upper) << shown << ' ' << s;
    EXPECT_LE((lower - low) + (high - upper), 0.021 * (upper - lower)) << shown << ' ' << s;
  }
}

}  // namespace
}  // namespace exactff::text
