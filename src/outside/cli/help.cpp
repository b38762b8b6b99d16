#include "cli/help.h"

#include <sstream>
#include <string>

#include "cli/option_table.h"

namespace exactff::cli {
namespace {

constexpr std::size_t kIndent = 30;
constexpr std::size_t kLineLength = 120;

std::string wrapped(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::string result, word;
  for (std::size_t column = 0; words >> word; column += word.size()) {
    const bool breaks = column > 0 && column + 1 + word.size() > width;
    if (breaks) column = 0;
    if (column > 0) ++column;
    result += (result.empty() ? "" : breaks ? "\n" : " ") + word;
  }
  return result;
}

// CLI11's own formatter would print "TEXT:{edges,boolean,both}=edges" and not wrap long lines.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kIndent); }

  std::string make_usage(const CLI::App* app, std::string name) const override {
    return "\n" + Formatter::make_usage(app, std::move(name));
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const OptionRow row = option_row(*option);
    return option->get_positional() || row.value.empty() ? "" : " " + row.value;
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    const bool tells = option->get_required() && !option->get_positional();
    return wrapped(option_row(*option).description + (tells ? " (required)" : ""), kLineLength - kIndent);
  }
};

}  // namespace

std::shared_ptr<CLI::Formatter> help_formatter() { return std::make_shared<HelpFormatter>(); }

}  // namespace exactff::cli
