#include "cli/study_file.h"

#include "scene/text_file.h"
#include "scene/text_lines.h"

namespace exactff::cli {

bool is_study_file(const std::string& path) { return std::filesystem::path(path).extension() == ".study"; }

std::vector<std::string> split_words(std::string_view line, const std::string& file, std::size_t number) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = '\0';
  for (const char c : line) {
    const bool blank = c == ' ' || c == '\t';
    if (quote != '\0') {
      if (c == quote) {
        quote = '\0';
      } else {
        words.back() += c;
      }
      continue;
    }
    if (blank) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (c == '"' || c == '\'') {
      quote = c;
    } else {
      words.back() += c;
    }
  }
  if (quote != '\0') {
    throw InputError(Problem{file, number, "a quote is not closed", "where its word ends cannot be told",
                             std::string("end the word with ") + quote});
  }
  return words;
}

StudyFile read_study_file(const std::filesystem::path& path) {
  const std::string text = read_text_file(path, "a study file");
  const std::string file = path.string();
  StudyFile study;
  ProblemList problems;
  TextLines lines(text);
  for (TextLine line; lines.next(line);) {
    if (line.text.empty()) continue;
    std::vector<std::string> words;
    try {
      words = split_words(line.text, file, line.number);
    } catch (const InputError& error) {
      for (const Problem& problem : error.problems()) problems.add(problem);
      continue;
    }
    const std::string kind = words.front();
    words.erase(words.begin());
    if (kind == "title" || kind == "scene" || kind == "experiment") {
      if (words.empty()) {
        problems.add({file, line.number, "nothing follows the word " + in_quotes(kind),
                      "the line says nothing to be done", "complete it or remove it"});
      } else if (kind == "scene") {
        study.scenes.push_back({line.number, std::move(words)});
      } else if (kind == "experiment") {
        study.experiments.push_back({line.number, std::move(words)});
      } else {
        study.title = std::string(trimmed(line.text.substr(kind.size())));
      }
    } else {
      problems.add({file, line.number, "a line begins with " + in_quotes(kind), "it says what the line is about",
                    "begin it with title, scene or experiment, or with # for a comment"});
    }
  }
  if (problems.empty() && study.scenes.empty() && study.experiments.empty()) {
    problems.add({file, 0, "the study has neither a scene nor an experiment", "there is nothing to do",
                  "add a line such as: scene room.obj --on floor --grid 16x16"});
  }
  problems.throw_if_any();
  return study;
}

}  // namespace exactff::cli
