#include "flags/sources.h"

#include <optional>
#include <set>
#include <utility>

#include "flags/lists.h"
#include "text/escape.h"

namespace exactff::flags {

void add_source_options(CLI::App& app, SourceArguments& args) {
  app.add_option("--source", args.names,
                 "Source patch or face; can be repeated, or separate names by commas; all: every patch (default: every "
                 "emitting patch)")
      ->type_name("NAME[:K]")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::vector<Selection> sources_of(const SourceArguments& args, const Scene& scene) {
  std::vector<Selection> sources = selections_named(scene, args.names);
  std::set<std::pair<PatchId, std::optional<FaceId>>> named;
  for (const Selection& source : sources) {
    if (named.emplace(source.patch, source.face).second) continue;
    throw InputError({.what = "--source: '" + scene.name_of(source) + "' is named twice",
                      .why = "its light would count twice",
                      .suggestion = "give it once"});
  }
  return sources;
}

std::string command_words(const SourceArguments& args) {
  std::string words;
  for (const std::string& name : args.names) words += " --source " + text::shell_word(name);
  return words;
}

}  // namespace exactff::flags
