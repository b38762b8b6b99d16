#include "cli/manual.h"

#include <algorithm>
#include <sstream>

#include "exactff/version.h"

namespace exactff::cli {
namespace {

constexpr const char* kExitStatus = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
A check failed.
.TP
.B 2
Bad input; a message says what the problem is, why it matters and what to do.
.TP
.B 3
A value is not as accurate or certified as asked; its bounds are still valid.
.TP
.B 4
Internal error, or out of memory.
.TP
.B 128 + N
Ended by signal N.
)";

constexpr const char* kEnd = R"(.SH SHELL COMPLETION
.EX
source <(exactff completion bash)
source <(exactff completion zsh)
exactff completion fish | source
.EE
.PP
enable completion of command lines in the running shell. An installed program has done this already.
.SH SEE ALSO
.BR gnuplot (1),
which draws the figures of the reports if it is installed.
)";

// Escapes characters that have a meaning in roff.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      case '\'':
        result += "\\(aq";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '~':
        result += "\\(ti";
        break;
      default:
        result += c;
    }
  }
  return result.starts_with('.') ? "\\&" + result : result;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

// Indented lines are examples and stay as they are; other lines are filled.
std::string prose(const std::string& text) {
  std::istringstream lines(text);
  std::string page, line;
  bool example = false;
  while (std::getline(lines, line)) {
    const bool indented = line.starts_with("  ");
    if (indented != example) page += indented ? ".PP\n.EX\n" : ".EE\n";
    example = indented;
    page += line.empty() ? ".PP\n" : roff(line) + "\n";
  }
  return page + (example ? ".EE\n" : "");
}

std::string title_of(const OptionRow& option) {
  std::string title;
  for (const std::string& name : option.names) title += (title.empty() ? "" : ", ") + bold(name);
  return option.value.empty() ? title : title + " " + italic(option.value);
}

std::string entry(const std::string& title, const std::string& text) {
  return ".TP\n" + title + "\n" + roff(text) + "\n";
}

std::string options(const CommandTable& command) {
  std::string page;
  for (const OptionRow& option : command.options) {
    page += entry(title_of(option), option.description + (option.required ? " (required)" : ""));
  }
  return page;
}

// The program, the command and its required arguments.
std::string synopsis(const CommandTable& command) {
  std::string line = bold("exactff " + command.name);
  for (const OptionRow& positional : command.positionals) line += " " + italic(positional.value);
  for (const OptionRow& option : command.options) {
    if (option.required) line += " " + bold(option.names.back()) + " " + italic(option.value);
  }
  return line + " [" + italic("OPTION") + "...]\n";
}

std::string section(const CommandTable& command) {
  std::string page =
      ".SH " + roff("exactff " + command.name) + "\n" + synopsis(command) + ".PP\n" + roff(command.description) + ".\n";
  for (const OptionRow& positional : command.positionals) {
    page += entry(italic(positional.value), positional.description);
  }
  page += options(command);
  return command.footer.empty() ? page : page + ".PP\n" + prose(command.footer);
}

// The first line "exactff: purpose", then the lines on how to begin.
struct Purpose {
  std::string first;
  std::string rest;
};

Purpose purpose_of(const ProgramTable& program) {
  const std::string& text = program.top.description;
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::size_t colon = text.substr(0, end).find(": ");
  const std::size_t begin = colon == std::string::npos ? 0 : colon + 2;
  const std::size_t next = std::min(text.find_first_not_of('\n', end), text.size());
  return {text.substr(begin, end - begin), text.substr(next)};
}

}  // namespace

std::string manual_page(const ProgramTable& program) {
  const Purpose purpose = purpose_of(program);
  std::string page = std::string(".TH EXACTFF 1 \"\" \"exactff ") + kVersion + "\" \"User commands\"\n" +
                     ".nh\n.ad l\n.SH NAME\nexactff \\- " + roff(purpose.first) + "\n.SH SYNOPSIS\n.nf\n";
  for (const CommandTable& command : program.commands) page += synopsis(command);
  page += ".fi\n.SH DESCRIPTION\n" + prose(purpose.rest) + options(program.top);
  for (const CommandTable& command : program.commands) page += section(command);
  return page + kExitStatus + kEnd;
}

}  // namespace exactff::cli
