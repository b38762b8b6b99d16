#include "formats/mtl_reader.h"

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>

#include "kernel/expect.h"
#include "text/encoding.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff {
namespace {

class MtlReader {
 public:
  MtlReader(const std::string& file, text::ProblemList& problems, text::ProblemList& warnings)
      : file_(file), problems_(problems), warnings_(warnings) {}

  std::vector<Material> run(std::string_view text) {
    text::TextLines lines(text);
    while (lines.next(line_)) read_line();
    if (!converted_.names().empty()) warnings_.add(converted_.warning(file_));
    if (!first_image_.what.empty()) {
      if (images_ > 1) first_image_.what += ", as are " + text::counted(images_ - 1, "other map");
      warnings_.add(first_image_);
    }
    return std::move(materials_);
  }

 private:
  void read_line() {
    std::string_view rest = line_.text;
    const std::string_view keyword = text::take_word(rest);
    if (keyword == "newmtl") return start_material(text::trimmed(rest));
    const bool transparency = keyword == "d" || keyword == "Tr" || keyword == "illum";
    if (transparency && started_) read_transparency(keyword, rest);
    if (started_ && (keyword == "map_Kd" || keyword == "map_Ke") && images_++ == 0) {
      first_image_ = {file_, line_.number, of_material(keyword) + " is an image",
                      "images are not read, and the colour beside it holds everywhere",
                      "give the material the mean colour of its image"};
    }
    if (keyword != "Kd" && keyword != "Ke") return;
    if (!started_)
      return fail(std::string(keyword) + " before any newmtl", "it does not belong to a material", "move it");
    read_colour(keyword, rest);
    if (counts_) materials_.back() = current_;
  }

  void start_material(std::string_view name) {
    started_ = true;
    if (!text::is_utf8(name)) converted_.add(line_.number, name);
    current_ = Material{text::in_utf8(name)};
    has_d_ = false;
    if (name.empty()) fail("newmtl without a name", "no face can use it", "give the material a name");
    counts_ = names_.insert(current_.name).second;
    if (counts_) {
      materials_.push_back(current_);
    } else {
      warn("material " + text::in_quotes(current_.name) + " is defined again", "the first definition is used",
           "remove one");
    }
  }

  void read_colour(std::string_view keyword, std::string_view values) {
    const std::vector<std::string_view> texts = text::words(values.substr(0, values.find('#')));
    if (!texts.empty() && (texts[0] == "spectral" || texts[0] == "xyz")) {
      return warn(of_material(keyword) + " is given as " + text::in_quotes(texts[0]), "exactff reads only RGB values",
                  "the default is used; write red, green and blue");
    }
    Rgb& colour = keyword == "Kd" ? current_.reflectance : current_.radiosity;
    if (read_numbers(keyword, texts, colour)) check(keyword, colour);
  }

  bool read_numbers(std::string_view keyword, const std::vector<std::string_view>& texts, Rgb& colour) {
    if (texts.empty() || texts.size() == 2) {
      fail(of_material(keyword) + " has " + (texts.empty() ? "no value" : "two values"),
           "a colour has one or three values", "give one value, or red, green and blue");
      return false;
    }
    std::array<double, 3> values{};
    for (std::size_t i = 0; i < std::min<std::size_t>(texts.size(), 3); ++i) {
      const text::ParsedNumber number = text::parse_number(texts[i]);
      if (number.fault != text::NumberFault::kNone) {
        fail(of_material(keyword) + ": " + describe(number.fault, texts[i]), "colours are finite numbers",
             advice(number.fault));
        return false;
      }
      values[i] = number.value;
    }
    if (texts.size() == 1) values[1] = values[2] = values[0];
    colour = {values[0], values[1], values[2]};
    return true;
  }

  void check(std::string_view keyword, const Rgb& colour) {
    const bool reflectance = keyword == "Kd";
    if (std::min({colour.r, colour.g, colour.b}) < 0.0) {
      return fail(of_material(keyword) + " is negative",
                  reflectance ? "a reflectance lies between 0 and 1" : "a radiosity cannot be negative", "correct it");
    }
    if (reflectance && colour.largest() > 1.0) {
      warn(of_material(keyword) + " exceeds 1", "such a surface reflects more than it receives", "correct it");
    }
  }

  // Some programs write Tr beside d with the meaning of d, so d counts where both are given. Anything unreadable says
  // nothing, since no value depends on it.
  void read_transparency(std::string_view keyword, std::string_view values) {
    static constexpr std::array kGlass = {4.0, 6.0, 7.0, 9.0};  // models with glass or refraction
    const std::vector<std::string_view> texts = text::words(values.substr(0, values.find('#')));
    const text::ParsedNumber number = text::parse_number(texts.empty() ? std::string_view() : texts.back());
    if (number.fault != text::NumberFault::kNone) return;
    const bool by_model = current_.see_through.starts_with("illum");
    bool glass = false;
    if (keyword == "illum") {
      if (!current_.see_through.empty() && !by_model) return;
      glass = std::ranges::find(kGlass, number.value) != kGlass.end();
    } else {
      if (keyword == "Tr" && has_d_) return;
      has_d_ = has_d_ || keyword == "d";
      glass = keyword == "d" ? number.value < 1.0 : number.value > 0.0;
      if (!glass && by_model) return;
    }
    current_.see_through = glass ? std::string(keyword) + ' ' + text::shortest(number.value) : std::string();
    current_.file = glass ? file_ : std::string();
    current_.line = glass ? line_.number : 0;
    if (counts_) materials_.back() = current_;
  }

  void fail(std::string what, std::string why, std::string suggestion) {
    problems_.add({file_, line_.number, std::move(what), std::move(why), std::move(suggestion)});
  }

  void warn(std::string what, std::string why, std::string suggestion) {
    warnings_.add({file_, line_.number, std::move(what), std::move(why), std::move(suggestion)});
  }

  std::string of_material(std::string_view keyword) const {
    return std::string(keyword) + " of material " + text::in_quotes(current_.name);
  }

  const std::string& file_;
  text::ProblemList& problems_;
  text::ProblemList& warnings_;
  text::TextLine line_;
  Material current_;     // the material that the current lines belong to
  bool has_d_ = false;   // it has a line d
  bool counts_ = false;  // false before any newmtl and in a repeated material
  bool started_ = false;
  ConvertedNames converted_;
  std::size_t images_ = 0;  // lines that name one
  Problem first_image_;
  std::vector<Material> materials_;
  std::unordered_set<std::string> names_;
};

}  // namespace

std::vector<Material> read_mtl(std::string_view text, const std::string& file, text::ProblemList& problems,
                               text::ProblemList& warnings) {
  return MtlReader(file, problems, warnings).run(text);
}

// --- Converted names ---

void ConvertedNames::add(std::size_t line, std::string_view name) {
  if (names_.empty()) {
    first_ = name;
    first_line_ = line;
  }
  names_.emplace(name);
}

Problem ConvertedNames::warning(const std::string& file) const {
  EXACTFF_EXPECT(!names_.empty());
  const std::size_t others = names_.size() - 1;
  return {file, first_line_,
          "the name " + text::in_quotes(text::in_utf8(first_), text::kShownName) + " is not written in UTF-8" +
              (others > 0 ? ", nor " + std::string(others == 1 ? "is " : "are ") + text::counted(others, "other name")
                          : ""),
          "it is read as Latin-1 (Windows-1252)", "save the file as UTF-8 if the name looks wrong"};
}

}  // namespace exactff
