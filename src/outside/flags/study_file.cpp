#include "flags/study_file.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>

#include "flags/comparison.h"
#include "kernel/float_environment.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::flags {

bool is_study_file(const std::string& path) { return std::filesystem::path(path).extension() == ".study"; }

std::vector<std::string> split_words(std::string_view line, const std::string& file, std::size_t number) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = '\0';
  for (const char c : line) {
    if (quote == '\0' && (c == ' ' || c == '\t')) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (c == quote) {
      quote = '\0';
    } else if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    } else {
      words.back() += c;
    }
  }
  if (quote != '\0') {
    throw InputError(Problem{file, number, "a quote is not closed", "the end of the word is unknown",
                             std::string("close it with ") + quote});
  }
  return words;
}

namespace {

void add_line(const text::TextLine& line, const std::string& file, StudyFile& study) {
  std::vector<std::string> words = split_words(line.text, file, line.number);
  const std::string kind = words.front();
  words.erase(words.begin());
  std::vector<StudyLine>* list = kind == "scene" ? &study.scenes : kind == "experiment" ? &study.experiments : nullptr;
  if (list == nullptr && kind != "title") {
    throw InputError(Problem{file, line.number, "a line begins with " + text::in_quotes(kind),
                             "the first word says what the line is",
                             "begin it with title, scene or experiment, or with # for a comment"});
  }
  if (words.empty()) {
    throw InputError(Problem{file, line.number, "nothing follows " + text::in_quotes(kind), "the line is incomplete",
                             "complete the line or remove it"});
  }
  if (list != nullptr) {
    list->push_back({line.number, std::move(words)});
  } else {
    study.title = std::string(text::trimmed(line.text.substr(kind.size())));
  }
}

}  // namespace

StudyFile parse_study_file(const std::filesystem::path& path) {
  const std::string text = text::read_text_file(path, "a study file");
  const std::string file = path.string();
  StudyFile study;
  text::ProblemList problems;
  text::TextLines lines(text);
  for (text::TextLine line; lines.next(line);) {
    if (line.text.empty()) continue;
    try {
      add_line(line, file, study);
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) problems.add(problem);
    }
  }
  if (problems.empty() && study.scenes.empty() && study.experiments.empty()) {
    problems.add({file, 0, "the study has no scene and no experiment", "there is nothing to do",
                  "add a line, for example: scene room.obj --on floor --grid 16x16"});
  }
  problems.throw_if_any();
  return study;
}

namespace {

ComparisonArguments arguments_of(const StudyLine& line, const std::string& file) {
  ComparisonArguments args;
  CLI::App app;
  app.set_help_flag();
  args.add_to(app);
  try {
    std::vector<std::string> reversed(line.words.rbegin(), line.words.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::ParseError& error) {
    throw InputError(Problem{file, line.number, error.what(), "the line has the flags of a scene",
                             "exactff compare --help explains these flags"});
  }
  args.scene.command = nullptr;  // the line has no outputs
  const std::string& path = args.scene.path;
  if (!path.starts_with('@')) args.scene.path = (std::filesystem::path(file).parent_path() / path).string();
  if (!args.receivers.file.empty()) {
    args.receivers.file = (std::filesystem::path(file).parent_path() / args.receivers.file).string();
  }
  return args;
}

// Problems with a line, or with the files that it names, are reported with the place of the line.
template <class Do>
void at_line(const std::string& file, std::size_t number, const Do& act) {
  try {
    act();
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      if (problem.file == file) continue;
      if (!problem.file.empty()) {
        const std::string line = problem.line > 0 ? ':' + std::to_string(problem.line) : std::string();
        problem.what = problem.file + line + ": " + problem.what;
      }
      problem.file = file;
      problem.line = number;
    }
    throw InputError(std::move(problems));
  }
}

void add_scene(const StudyLine& line, const std::string& file, report::Plan& plan) {
  ComparisonArguments args = arguments_of(line, file);
  if (plan.effort.abridged && args.unless_abridged) {
    const std::string name = args.title.empty() ? short_name(args.scene.path) : args.title;
    plan.left_out.push_back({name, "this report is abridged"});
    return;
  }
  if (!args.receivers.file.empty()) plan.files_read.emplace_back(args.receivers.file);
  Comparison comparison = comparison_of(std::move(args), plan.effort.abridged, plan.effort.threads);
  std::ranges::copy(comparison.scene->files(), std::back_inserter(plan.files_read));
  plan.add_scene(std::move(comparison.title), std::move(comparison.scene), std::move(comparison.request),
                 std::move(comparison.warnings));
}

void add_experiments(const StudyLine& line, report::Plan& plan) {
  constexpr std::string_view kUnlessAbridged = "--unless-abridged";
  std::vector<std::string> names = line.words;
  const bool marked = std::erase(names, kUnlessAbridged) > 0;
  if (marked && names.empty()) {
    text::refuse("nothing but --unless-abridged follows 'experiment'", "it marks the experiments of its line",
                 "name them, or remove the line");
  }
  if (!marked || !plan.effort.abridged) return plan.add_experiments(names);
  report::Plan named;
  named.add_experiments(names);
  for (const std::string& name : named.experiments) {
    plan.left_out.push_back({"the experiment " + name, "this report is abridged"});
  }
}

}  // namespace

report::Plan read_study_file(const std::filesystem::path& file, const report::Effort& effort) {
  const kernel::StandardArithmetic arithmetic;
  const StudyFile study = parse_study_file(file);
  report::Plan plan;
  plan.title = study.title.empty() ? short_name(file.string()) : study.title;
  plan.effort = effort;
  for (const StudyLine& line : study.scenes) {
    at_line(file.string(), line.number, [&] { add_scene(line, file.string(), plan); });
  }
  for (const StudyLine& line : study.experiments) {
    at_line(file.string(), line.number, [&] { add_experiments(line, plan); });
  }
  return plan;
}

}  // namespace exactff::flags
