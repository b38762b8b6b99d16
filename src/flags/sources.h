// The flag --source, shared by all commands over many receivers.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "exactff/scene.h"

namespace exactff::flags {

struct SourceArguments {
  std::vector<std::string> names;  // each a name, a comma list of names, or "all"
};

void add_source_options(CLI::App& app, SourceArguments& args);

// In the given order. Empty if the flag was not given, which stands for every patch that emits. Throws InputError if a
// name is unknown or occurs twice.
std::vector<Selection> sources_of(const SourceArguments& args, const Scene& scene);

// Whether the source has a Ke other than 0. If not, it counts with a radiosity of 1 where it is named.
bool emits(const Scene& scene, const Selection& source);

// A sentence that names those of the sources that emit nothing, and says how they count; empty if all emit.
std::string note_on_sources_without_emission(const Scene& scene, const std::vector<Selection>& sources);

// The flags again, each preceded by a blank and quoted for a shell.
std::string command_words(const SourceArguments& args);

}  // namespace exactff::flags
