// Results that another renderer was measured to have, as a chapter of a report.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "field/page.h"
#include "field/results.h"
#include "support/program.h"

namespace exactff::field {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHead =
    "setting,about,samples,runs,seconds,cpu_seconds,us_per_pixel,exact_seconds,exact_cpu_seconds,exact_us_per_pixel,"
    "pixels,left_out,mean_ratio,median_ratio,rms,rms_of_brightest,relative_mse,p99_of_brightest,worst_of_brightest,"
    "image\n";
constexpr const char* kRow =
    "fair,\"lamp, sampled\",16,3,2,4,10,0.5,1,5,900,100,1.001,1,0.002,0.001,1e-4,0.006,0.02,\n";
constexpr const char* kNaive = "naive,as it comes,16,3,1,2,4,0.5,1,5,900,100,0.9,0.95,0.2,0.1,0.01,0.6,0.9,\n";
// The signature is all that is looked at.
constexpr std::string_view kPng = "\x89PNG\r\n\x1a\nand so on";

class FieldFile : public ::testing::Test {
 protected:
  [[nodiscard]] fs::path put(const std::string& text) const { return directory_.write("cycles.csv", text); }
  [[nodiscard]] FieldResults read(const std::string& text) const { return read_field(put(text)); }
  [[nodiscard]] std::string complaint(const std::string& text) const {
    try {
      (void)read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }
  static std::string with(std::string row, const std::string& from, const std::string& to) {
    return row.replace(row.find(from), from.size(), to);
  }

  const validation::TemporaryDirectory directory_;
};

TEST_F(FieldFile, HoldsRowsTitleCommandAndNotes) {
  std::ofstream(directory_.path() / "map.png", std::ios::binary) << kPng;
  const FieldResults field =
      read(std::string("# title: A renderer\n# command: validation/field/cycles.sh\n# version 3.4\n") + kHead + kRow +
           with(kNaive, "0.9,\n", "0.9,map.png\n"));
  EXPECT_EQ(field.name, "cycles");
  EXPECT_EQ(field.title, "A renderer");
  EXPECT_EQ(field.command, "validation/field/cycles.sh");
  EXPECT_EQ(field.notes, std::vector<std::string>{"version 3.4"});
  ASSERT_EQ(field.rows.size(), 2U);
  EXPECT_EQ(field.rows[0].about, "lamp, sampled");
  EXPECT_EQ(field.rows[0].samples, 16.0);
  EXPECT_EQ(field.rows[0].relative_mse, 1e-4);
  EXPECT_EQ(field.rows[0].png, "");
  EXPECT_EQ(field.rows[1].png, kPng);
}

TEST_F(FieldFile, ColumnsMayComeInAnyOrder) {
  std::string head = kHead, row = kRow;
  head.insert(head.size() - 1, ",setting");
  head.erase(0, 8);
  row.insert(row.size() - 1, ",last");
  row.erase(0, 5);
  EXPECT_EQ(read(head + row).rows.front().setting, "last");
}

TEST_F(FieldFile, TellsEverythingThatIsWrongWithItsLine) {
  const std::string head = kHead;
  const std::pair<std::string, std::string> table[] = {
      {"", "the file has no header"},
      {head, "the file has no row"},
      {with(head, "worst_of", "worse_of") + kRow, "cycles.csv:1: there is no column 'worse_of_brightest'"},
      {with(head, "samples", "simples") + kRow, "cycles.csv:1: the column 'samples' is missing"},
      {with(head, "p99_of_brightest", "rms") + kRow, "cycles.csv:1: the column 'rms' is given twice"},
      {head + kRow + "a,b\n", "cycles.csv:3: the row has 2 fields, the header 20"},
      {head + with(kRow, ",16,", ",many,"), "cycles.csv:2: samples: 'many' is no"},
      {head + with(kRow, ",16,", ",0,"), "cycles.csv:2: samples is '0'"},
      {head + with(kRow, ",16,", ",nan,"), "cycles.csv:2: samples: 'nan'"},
      {head + with(kRow, ",10,", ",-10,"), "cycles.csv:2: us_per_pixel is '-10'"},
      {head + with(kRow, "fair", ""), "cycles.csv:2: the row has no setting"},
      {head + with(kRow, "\"lamp", "\"lamp\" x"), "cycles.csv:2: a quote is not closed"},
      {head + with(kRow, "0.02,\n", "0.02,none.png\n"), "cycles.csv:2: image 'none.png'"},
      {head + with(kRow, "0.02,\n", "0.02,../a.png\n"), "cycles.csv:2: image '../a.png' is in another folder"},
      {head + with(kRow, "0.02,\n", "0.02,cycles.csv\n"), "cycles.csv:2: image 'cycles.csv' is no PNG file"},
  };
  for (const auto& [text, expected] : table) {
    const std::string said = complaint(text);
    EXPECT_NE(said.find(expected), std::string::npos) << expected << '\n' << said;
  }
}

TEST_F(FieldFile, SaysWhenToUseExactImages) {
  EXPECT_EQ(
      verdict(read(std::string(kHead) + kRow)),
      "Use exact images (5 µs a pixel) whatever error you accept: no setting of the renderer was as fast; its most "
      "accurate setting, fair (lamp, sampled) with 16 samples a pixel, takes 2 times as long and still errs by 0.1 %.");
  EXPECT_EQ(verdict(read(std::string(kHead) + kRow + kNaive)),
            "Use exact images (5 µs a pixel) when the RMS error must stay below 10 % of the brightest pixel, which the "
            "renderer reaches in the same time; its most accurate setting, fair (lamp, sampled) with 16 samples a "
            "pixel, takes 2 times "
            "as long and still errs by 0.1 %.");
  EXPECT_EQ(verdict(read(std::string(kHead) + kNaive)),
            "Use exact images (5 µs a pixel) when the RMS error must stay below 10 % of the brightest pixel; otherwise "
            "the renderer, whose most accurate setting, naive (as it comes) with 16 samples a pixel, takes 80 % of "
            "their time.");
}

TEST_F(FieldFile, MayLackWhatAnotherRendererDoesNotState) {
  const FieldResults field = read(
      "setting,samples,us_per_pixel,exact_us_per_pixel,mean_ratio,rms_of_brightest,black_share\n"
      "fast,4,1,8,0.99,0.01,\nslow,64,16,8,1.0,0.001,\n");
  EXPECT_TRUE(std::isnan(field.rows[0].worst_of_brightest));
  EXPECT_TRUE(std::isnan(field.rows[0].black_share));
  EXPECT_FALSE(field.processor_time);
  const std::string text = field_part(field, {});
  EXPECT_EQ(text.find("nan"), std::string::npos) << text;
  EXPECT_EQ(text.find("worst"), std::string::npos) << text;
  EXPECT_NE(text.find("Times are wall times"), std::string::npos) << text;
}

TEST_F(FieldFile, CountsProcessorTimeIfOtherProgramsKeptTheMachineBusy) {
  const std::string head =
      "setting,samples,seconds,cpu_seconds,us_per_pixel,exact_seconds,exact_cpu_seconds,exact_us_per_pixel,pixels,"
      "left_out,mean_ratio,rms_of_brightest,load\n";
  const FieldResults busy = read(head + "a,4,9,0.5,9000,8,0.25,8000,900,100,1,0.01,14\n");
  EXPECT_TRUE(busy.processor_time);
  EXPECT_EQ(busy.rows.front().time, 0.0005);
  EXPECT_EQ(busy.rows.front().exact_time, 0.00025);
  EXPECT_NE(field_part(busy, {}).find("busy (load up to 14), so times are processor times"), std::string::npos)
      << field_part(busy, {});
  EXPECT_NE(verdict(busy).find("(250 µs a pixel)"), std::string::npos) << verdict(busy);
  const FieldResults idle = read(head + "a,4,9,17,9000,8,0.25,8000,900,100,1,0.01,14\n");
  EXPECT_FALSE(idle.processor_time);
  EXPECT_EQ(idle.rows.front().time, 0.009);
  EXPECT_FALSE(read(head + "a,4,9,0.5,9000,8,0.25,8000,900,100,1,0.01,1.5\n").processor_time);
}

TEST_F(FieldFile, NamesTheSettingsWhoseErrorIsBias) {
  const std::string text = bias_note(
      read("setting,samples,us_per_pixel,exact_us_per_pixel,mean_ratio,rms_of_brightest,noise_of_brightest,"
           "bias_of_brightest\n"
           "fair,4,1,8,1,0.01,0.001,0.002\nfair,16,4,8,1,0.005,0.002,0.001\ndark,16,4,8,0.9,0.02,0.002,0.02\n"));
  EXPECT_TRUE(
      text.ends_with("More samples do not help dark: more of the error is bias than noise, up to 2 % of the "
                     "brightest pixel."))
      << text;
}

// The file of the repository is what the script writes.
TEST(Field, ResultsOfTheRepositoryAreRead) {
  const FieldResults field = read_field(EXACTFF_DATA_DIR "/field/cycles.csv");
  EXPECT_FALSE(field.command.empty());
  EXPECT_FALSE(field.maps.empty());
  EXPECT_GT(field.rows.size(), 10U);
}

TEST_F(FieldFile, BecomesAChapterThatHoldsEveryRowAndPicture) {
  std::ofstream(directory_.path() / "map.png", std::ios::binary) << kPng;
  const FieldResults field = read(std::string("# title: A <renderer>\n# command: a & b\n# on paper\n") + kHead + kRow +
                                  with(kNaive, "0.9,\n", "0.9,map.png\n"));
  std::vector<LeftOut> left_out;
  EXPECT_EQ(field_figures(field, left_out).size(), 2U);
  const std::string text = field_part(field, {});
  for (const char* part :
       {"<h2>A &lt;renderer&gt;</h2>\n<p class=\"verdict\">Use exact images", "a &amp; b", "on paper", "lamp, sampled",
        "data:image/png;base64,iVBORw0KGgphbmQgc28gb24=\"", "data-label=\"samples\">16<", ">0.9<"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
  }
}

TEST_F(FieldFile, BecomesAPage) {
  const validation::EnvironmentVariable without_gnuplot("PATH", "/nonexistent");
  std::vector<std::string> notes;
  const std::string page = field_page(read(std::string(kHead) + kRow), directory_.path(), notes);
  EXPECT_NE(page.find("<section class=\"scene\" id=\"field-cycles\">"), std::string::npos) << page;
  ASSERT_EQ(notes.size(), 1U) << "gnuplot is missing";
  EXPECT_NE(page.find(notes.front()), std::string::npos) << page;
}

}  // namespace
}  // namespace exactff::field
