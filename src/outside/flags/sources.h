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
void add_source_options_under_sky(CLI::App& app, SourceArguments& args);  // for sources_under_sky()

// In the given order. Empty if the flag was not given, which stands for every patch that emits. Throws InputError if a
// name is unknown or occurs twice, or is "sky".
std::vector<Selection> sources_of(const SourceArguments& args, const Scene& scene);

// The same for commands that know "sky", all directions that meet nothing, as a source. A patch of this name has
// priority.
struct SourcesUnderSky {
  std::vector<Selection> sources;  // empty, without sky: every patch that emits
  bool sky = false;
};
SourcesUnderSky sources_under_sky(const SourceArguments& args, const Scene& scene);

// A sentence that names those of the sources that emit nothing, and says how they count; empty if all emit.
std::string note_on_sources_without_emission(const Scene& scene, const std::vector<Selection>& sources);

// The flags again, each preceded by a blank and quoted for a shell.
std::string command_words(const SourceArguments& args);

}  // namespace exactff::flags
