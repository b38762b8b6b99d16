#include "page/page_text.h"

#include <algorithm>
#include <ctime>
#include <fstream>
#include <thread>

#include "text/encoding.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::page {
namespace {

// --- Style ---

// The report's style sheet: one column on a phone, two figures side by side on a screen, light or dark as the reader's
// system is set, black on white in print.

inline constexpr const char* kReportStyle = R"css(
:root { color-scheme: light dark; --paper: #fdfdfc; --ink: #1c1e21; --soft: #5b6168; --line: #d9dce0; --card: #ffffff;
  --mark: #fff3d6; --accent: #0072b2; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #14171a; --ink: #e6e8ea; --soft: #a3abb3; --line: #343a40; --card: #1c2024; --mark: #3a3220;
    --accent: #56b4e9; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); line-height: 1.55;
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; overflow-wrap: break-word; }
main { max-width: 76rem; margin: 0 auto; padding: 1.5rem 1rem 4rem; }
h1 { font-size: 1.75rem; line-height: 1.2; margin: .5rem 0 .25rem; }
h2 { font-size: 1.25rem; margin: 2rem 0 .75rem; }
h3 { font-size: 1rem; margin: 0 0 .25rem; }
section > h3 { font-size: 1.0625rem; margin: 2rem 0 .5rem; }
a { color: var(--accent); }
p, ul, dl { max-width: 48rem; }
details { border-top: 1px solid var(--line); }
figure + details { margin-top: 1rem; }
details + :not(details) { border-top: 1px solid var(--line); padding-top: .5rem; }
summary { cursor: pointer; padding: .3rem 0; font-weight: 600; }
p.verdict { font-size: 1.125rem; line-height: 1.45; font-weight: 600; margin: .75rem 0 1rem; max-width: 60rem; }
.strip { display: grid; grid-template-columns: repeat(3, minmax(0, 1fr)); gap: .75rem; }
.strip img, .pictures img { display: block; width: 100%; height: auto; image-rendering: pixelated; }
.strip p, .pictures p { margin: .3rem 0 0; font-size: .875rem; line-height: 1.35; }
.pictures { grid-template-columns: repeat(auto-fill, minmax(15rem, 1fr)); }
.pair { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 1rem; align-items: start;
  margin: 1rem 0; }
.pair > * { min-width: 0; }
.pair p { margin: 0 0 .5rem; font-size: .875rem; line-height: 1.4; }
.subtitle { color: var(--soft); margin-top: 0; }
.answer li { margin: .4rem 0; }
nav.contents { background: var(--card); border: 1px solid var(--line); border-radius: .5rem; padding: .6rem 1rem;
  margin: 1.5rem 0; }
nav.contents h2 { font-size: .875rem; color: var(--soft); margin: 0 0 .25rem; }
nav.contents ul { list-style: none; margin: 0; padding: 0; max-width: none; columns: 15rem; column-gap: 2rem; }
nav.contents li { break-inside: avoid; }
nav.contents li ul { columns: auto; padding-left: 1rem; font-size: .875rem; }
nav.contents a { display: block; padding: .2rem 0; line-height: 1.35; text-decoration: none; }
nav.contents a:hover { text-decoration: underline; }
section.scene { margin-top: 2rem; }
section.scene > h2 { font-size: 1.4rem; line-height: 1.25; margin: 0 0 .75rem; padding-top: .75rem;
  border-top: 3px solid var(--accent); }
.figures { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 1rem; margin: 1rem 0; }
.figures.maps { grid-template-columns: repeat(3, minmax(0, 1fr)); }
.figures > :only-child { grid-column: 1 / -1; width: 100%; max-width: 38rem; }
.figures.maps > :only-child { max-width: 30rem; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: .5rem; padding: .75rem;
  break-inside: avoid; min-width: 0; }
figure svg { display: block; width: 100%; height: auto; color: var(--ink); }
figcaption { color: var(--soft); font-size: .875rem; line-height: 1.4; margin-top: .5rem; }
.wide { overflow-x: auto; border: 1px solid var(--line); border-radius: .5rem; background: var(--card); }
table { border-collapse: collapse; font-size: .78rem; font-variant-numeric: tabular-nums; width: 100%; }
th, td { padding: .25rem .4rem; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
th { white-space: normal; background: var(--card); vertical-align: bottom; color: var(--soft); font-weight: 600; }
th.text, td.text { text-align: left; }
tr.base td { background: var(--mark); }
tr.exact td { font-weight: 600; }
sub { line-height: 0; }
dt { font-weight: 600; margin-top: .6rem; }
dd { margin: 0; color: var(--soft); }
code, pre { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: .875em; }
pre { overflow-x: auto; background: var(--card); border: 1px solid var(--line); border-radius: .5rem; padding: .75rem;
  white-space: pre-wrap; overflow-wrap: anywhere; }
td.text { white-space: normal; min-width: 6rem; }
th:first-child.text, .cards td.text:first-child { font-weight: 600; }
.facts { width: auto; } .facts td { white-space: normal; text-align: left; }
.facts td:first-child { color: var(--soft); }
@media (max-width: 60rem) { .figures.maps { grid-template-columns: repeat(2, minmax(0, 1fr)); } }
@media (max-width: 44rem) { .figures, .figures.maps { grid-template-columns: minmax(0, 1fr); }
  main { padding: 1rem .75rem 3rem; } h1 { font-size: 1.4rem; } figure { padding: .4rem; }
  .pair { grid-template-columns: minmax(0, 1fr); } .strip { grid-template-columns: minmax(0, 1fr); }
  table { font-size: .72rem; } th, td { padding: .25rem .2rem; } td.text { min-width: 0; }
  .cards, .cards tbody, .cards tr { display: block; } .cards thead { display: none; }
  .cards tr { padding: .4rem .5rem; border-bottom: 1px solid var(--line); }
  .cards td { display: inline-block; border: 0; padding: 0 .8rem 0 0; text-align: left; white-space: normal; }
  .cards td::before { content: attr(data-label) "\00a0"; color: var(--soft); font-weight: 400; }
  .cards td.text:first-child { display: block; } .cards td.text:first-child::before { content: none; }
  .cards td:empty { display: none; } }
@media print { details::details-content { content-visibility: visible; display: block; }
  :root { --paper: #fff; --ink: #000; --soft: #333; --line: #bbb; --card: #fff; --mark: #eee;
    --accent: #000; }
  @page { margin: 12mm; }
  body { font-size: 10pt; } main { max-width: none; padding: 0; } .wide { overflow: visible; border: 0; }
  h1, h2, h3, summary { break-after: avoid; }
  .figures, .figures.maps { grid-template-columns: repeat(2, minmax(0, 1fr)); gap: .5rem; }
  .figures > :only-child, .figures.maps > :only-child { max-width: 60%; }
  figure { padding: .4rem; } figcaption { font-size: 8pt; }
  table { font-size: 6pt; } th, td { padding: .1rem .15rem; } .cards { font-size: 5.4pt; } .cards td { white-space: normal; } td.text { white-space: normal; }
  table.facts { font-size: 8pt; } tr, li { break-inside: avoid; } dt { break-after: avoid; } }
)css";

}  // namespace

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
