// --source, as every command over many receivers has it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff::cli {

struct SourceArguments {
  std::vector<std::string> names;  // each a name, a comma list of names, or "all"
};

void add_source_options(CLI::App& app, SourceArguments& args);

// In the order given; empty, which stands for every patch that emits, where the flag was not. Throws InputError where a
// name is unknown or comes twice.
std::vector<Selection> sources_of(const SourceArguments& args, const Scene& scene);

// The flags again, each preceded by a blank, in words that a shell takes.
std::string command_words(const SourceArguments& args);

}  // namespace exactff::cli
