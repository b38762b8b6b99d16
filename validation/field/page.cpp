#include "field/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

#include "page/page_text.h"
#include "report/report.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::field {
namespace {

using page::HtmlTable;
using enum HtmlTable::CellKind;

// A column of the table; left out if no row has the number.
struct ErrorColumn {
  const char* heading;
  double FieldRow::*value;
  std::string (*text)(double value);
};
std::string in_percents(double share) { return text::rounded(100.0 * share, 2); }
std::string ratio_of(double ratio) { return text::short_number(ratio, 5); }
constexpr std::array<ErrorColumn, 9> kErrorColumns = {
    {{"RMS, %", &FieldRow::rms_of_brightest, in_percents},
     {"noise, %", &FieldRow::noise_of_brightest, in_percents},
     {"bias, %", &FieldRow::bias_of_brightest, in_percents},
     {"p99, %", &FieldRow::p99_of_brightest, in_percents},
     {"worst, %", &FieldRow::worst_of_brightest, in_percents},
     {"mean ratio", &FieldRow::mean_ratio, ratio_of},
     {"median ratio", &FieldRow::median_ratio, ratio_of},
     {"where all light is visible", &FieldRow::whole_lamp_ratio, ratio_of},
     {"black, %", &FieldRow::black_share, in_percents}}};

std::string results_table(const FieldResults& field, const std::vector<const FieldRow*>& rows) {
  std::vector<ErrorColumn> shown;
  for (const ErrorColumn& column : kErrorColumns) {
    // No pixel is black in most tables.
    const auto tells = [&](const FieldRow& row) {
      return column.value == &FieldRow::black_share ? row.*column.value > 0.0 : !std::isnan(row.*column.value);
    };
    if (std::ranges::any_of(field.rows, tells)) shown.push_back(column);
  }
  HtmlTable table(HtmlTable::Shape::kWide);
  table.column("setting", kText);
  table.columns({"samples", field.processor_time ? "processor time per pixel" : "time per pixel", "exact ×"});
  for (const ErrorColumn& column : shown) table.column(column.heading);
  for (const FieldRow* row : rows) {
    table.row();
    table.cell(text::html(row->setting), kText);
    table.cells(
        {text::rounded(row->samples), text::duration(row->time), text::rounded(row->time / row->exact_time, 2)});
    for (const ErrorColumn& column : shown) {
      const double value = row->*column.value;
      table.cell(std::isnan(value) ? std::string() : column.text(value));
    }
  }
  return table.text() + '\n';
}

// All rows, setting by setting; and of each setting the one with the most samples.
std::vector<const FieldRow*> all_rows(const FieldResults& field) {
  std::vector<const FieldRow*> rows;
  for (const std::string& setting : settings_of(field)) {
    for (const FieldRow& row : field.rows) {
      if (row.setting == setting) rows.push_back(&row);
    }
  }
  return rows;
}
std::vector<const FieldRow*> last_rows(const FieldResults& field) {
  std::vector<const FieldRow*> rows;
  for (const std::string& setting : settings_of(field)) rows.push_back(&most_samples(field, setting));
  return rows;
}

// What each setting means, and the other columns, which hardly differ.
std::string about_list(const FieldResults& field) {
  std::string text = "<ul>\n";
  for (const std::string& setting : settings_of(field)) {
    const FieldRow& row = most_samples(field, setting);
    text +=
        "<li><strong>" + text::html(setting) + "</strong>" + (row.about.empty() ? "" : ": " + text::html(row.about));
    if (row.pixels > 0.0) text += "; " + text::counted(static_cast<std::uint64_t>(row.pixels), "pixel") + " compared";
    if (row.left_out > 0.0) text += ", " + text::rounded(row.left_out) + " left out";
    if (row.runs > 0.0) text += "; " + text::counted(static_cast<std::uint64_t>(row.runs), "run");
    text += ".</li>\n";
  }
  return text + "</ul>\n";
}

std::string picture(const FieldRow& row) {
  const std::string samples = text::counted(static_cast<std::uint64_t>(row.samples), "sample");
  const std::string about = row.about.empty() ? "" : row.about + ", ";
  return "<div><img src=\"" + page::png_source(row.png) + "\" alt=\"signed error of " +
         text::html(row.setting + ", " + samples) + "\">\n<p><strong>" + text::html(row.setting) + ".</strong> " +
         text::html(about + samples) + "</p></div>\n";
}

// The map of each setting with the most samples, then the others.
struct Pictures {
  std::string leading, others;
};
Pictures pictures_of(const FieldResults& field) {
  std::map<std::string, const FieldRow*> most;
  for (const FieldRow& row : field.rows) {
    if (row.png.empty()) continue;
    const FieldRow*& kept = most[row.setting];
    if (kept == nullptr || kept->samples < row.samples) kept = &row;
  }
  Pictures pictures;
  for (const FieldRow& row : field.rows) {
    if (row.png.empty()) continue;
    (most[row.setting] == &row ? pictures.leading : pictures.others) += picture(row);
  }
  return pictures;
}

std::string figure_of(const std::string& pictures, const std::string& id, const std::string& caption) {
  if (pictures.empty()) return {};
  return "<figure id=\"" + id + "\">\n<div class=\"strip pictures\">\n" + pictures + "</div>\n<figcaption>" + caption +
         "</figcaption>\n</figure>\n";
}

std::string how_measured(const FieldResults& field) {
  if (field.notes.empty()) return {};
  std::string text = "<ul>\n";
  for (const std::string& note : field.notes) text += "<li>" + page::prose(text::html(note)) + "</li>\n";
  return text + "</ul>\n";
}

std::string opening(const FieldResults& field) {
  std::string text = "Another renderer’s images, held against exact images of the same pixels. ";
  if (!field.command.empty()) text += "Measured by <code>" + text::html(field.command) + "</code>. ";
  if (!field.processor_time) return text + "Times are wall times.";
  double load = 0.0;
  for (const FieldRow& row : field.rows) load = std::max(load, row.load);
  return text + "Other programs kept the machine busy (load up to " + text::rounded(load, 2) +
         "), so times are processor times.";
}

}  // namespace

std::string anchor_of(const FieldResults& field) { return "field-" + field.name; }

std::string field_part(const FieldResults& field, const report::Page& page) {
  const std::string id = anchor_of(field);
  std::string text = "<section class=\"scene\" id=\"" + id + "\">\n<h2>" + text::html(field.title) + "</h2>\n";
  text += "<p class=\"verdict\">" + page::prose(text::html(verdict(field))) + "</p>\n";
  const std::string bias = bias_note(field);
  if (!bias.empty()) text += page::paragraph(page::prose(text::html(bias)));
  text += page::paragraph(opening(field));
  const Pictures pictures = pictures_of(field);
  if (!page.drawn.none.empty()) text += page::paragraph(text::html(page.drawn.none));
  text += report::figure_group(page.drawn, [](const page::Figure&) { return true; });
  const std::string colours =
      "Red: too bright; blue: too dark." + (field.maps.empty() ? "" : " " + page::prose(text::html(field.maps)));
  text += figure_of(pictures.leading, id + "-maps", "Signed error. " + colours);
  const std::string words = page::paragraph(
      "Errors are relative to the brightest pixel. A ratio is the renderer’s value divided by the exact one. Noise is "
      "the "
      "spread between seeds; bias is what their mean keeps beyond it. Black: the share of light that is missing "
      "because "
      "a pixel is black.");
  text += page::fold("What the settings are", about_list(field));
  text += page::fold("The most samples of each setting", results_table(field, last_rows(field)) + words);
  text += page::fold("All numbers of samples", results_table(field, all_rows(field)) + words);
  text += page::fold("Further maps of the error", figure_of(pictures.others, id + "-further-maps", colours));
  text += page::fold("How it was measured", how_measured(field));
  if (!page.left_out.empty()) text += page::fold("What was left out, and why", report::left_out_list(page.left_out));
  return text + "</section>\n";
}

std::string field_page(const FieldResults& field, const std::filesystem::path& scratch,
                       std::vector<std::string>& notes) {
  report::Page page;
  std::vector<page::Figure> figures = field_figures(field, page.left_out);
  for (page::Figure& figure : figures) figure.id = anchor_of(field) + '-' + figure.id;
  page.drawn = page::draw_figures(std::move(figures), scratch, notes, {});
  std::ranges::move(page.drawn.left_out, std::back_inserter(page.left_out));
  return page::page_head(text::html(field.title)) + "<h1>Another renderer against exact images</h1>\n" +
         field_part(field, page) + page::heading("How to reproduce this page") +
         page::facts_table(
             {{"program", page::program_fact()}, {"processor", page::processor_fact()}, {"made", page::today()}}) +
         page::page_end();
}

}  // namespace exactff::field
