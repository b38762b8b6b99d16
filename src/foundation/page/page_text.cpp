#include "page/page_text.h"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <thread>

#include "page/style.h"
#include "text/base64.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::page {

std::string page_head(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         title + "</title>\n<style>" + kReportStyle + "</style>\n</head>\n<body>\n<main>\n";
}

std::string page_end() { return "</main>\n</body>\n</html>\n"; }

std::string prose(std::string text) {
  for (const auto& [plain, marked] : {std::pair{"ε_B", "ε<sub>B</sub>"},
                                      {"ε_A", "ε<sub>A</sub>"},
                                      {"θ_r", "θ<sub>r</sub>"},
                                      {"θ_s", "θ<sub>s</sub>"},
                                      {"ρ_r", "ρ<sub>r</sub>"},
                                      {"B_s", "B<sub>s</sub>"},
                                      {" %", "&nbsp;%"},
                                      {" µs", "&nbsp;µs"},
                                      {" ms", "&nbsp;ms"}}) {
    text::replace_all(text, plain, marked);
  }
  return text;
}

std::string paragraph(const std::string& text) { return "<p>" + prose(text) + "</p>\n"; }
std::string heading(const std::string& text) { return "<h2>" + text + "</h2>\n"; }

std::string facts_table(const Facts& facts) {
  std::string text = "<div class=\"wide\"><table class=\"facts\">\n";
  for (const auto& [name, value] : facts) {
    text += "<tr><td>" + name + "</td><td>" + prose(value) + "</td></tr>\n";
  }
  return text + "</table></div>\n";
}

std::string fold(const std::string& title, const std::string& content) {
  if (content.empty()) return {};
  return "<details>\n<summary>" + prose(title) + "</summary>\n" + content + "</details>\n";
}

std::string png_source(std::string_view png) {
  text::Base64 base64;
  std::string text = "data:image/png;base64," + base64.append(png);
  return text + base64.finish();
}

namespace {

// ` class="name"`, or nothing.
std::string class_of(const std::string& name) { return name.empty() ? name : " class=\"" + name + '"'; }

}  // namespace

HtmlTable::HtmlTable(Shape shape)
    : shape_(shape),
      text_("<div class=\"wide\"><table" + class_of(shape == Shape::kWide ? "cards" : "") + ">\n<thead><tr>") {}

void HtmlTable::column(const std::string& heading, CellKind kind) {
  text_ += "<th" + class_of(kind == CellKind::kText ? "text" : "") + '>' + prose(heading) + "</th>";
  headings_.push_back(heading);
}

void HtmlTable::row(const std::string& name) {
  text_ += (in_head_ ? "</tr></thead>\n<tbody>\n<tr" : "</tr>\n<tr") + class_of(name) + '>';
  in_head_ = false;
  column_ = 0;
}

void HtmlTable::cell(const std::string& content, CellKind kind, int span) {
  text_ += "<td" + class_of(kind == CellKind::kText ? "text" : "");
  if (span > 1) text_ += " colspan=\"" + std::to_string(span) + '"';
  if (shape_ == Shape::kWide && column_ < headings_.size()) text_ += " data-label=\"" + headings_[column_] + '"';
  text_ += '>' + content + "</td>";
  column_ += static_cast<std::size_t>(span);
}

std::string HtmlTable::text() const {
  return text_ + (in_head_ ? "</tr></thead>\n<tbody>\n" : "</tr>\n") + "</tbody></table></div>";
}

namespace {

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

std::string compiler_name() {
#if defined(__clang__)
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

}  // namespace

std::string program_fact() {
  return text::html(text::program_version()) + ", " + text::html(compiler_name()) + ", " EXACTFF_BUILD_TYPE;
}

std::string processor_fact() {
  return text::html(processor_name()) + ", " + text::counted(std::thread::hardware_concurrency(), "hardware thread");
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::string text(32, '\0');
  text.resize(std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", &parts));
  return text;
}

}  // namespace exactff::page
