#include "flags/sources.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "flags/lists.h"
#include "scene/selections.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::flags {

namespace {

void refuse_sky(const Scene& scene, std::vector<std::string> names) {
  if (!take_sky(scene, names)) return;
  text::refuse("--source: the sky is not a source of this command", "its sources are patches",
               "exactff view prints the sky's form factor as (open); truth and render take sky as a source");
}

void add_option(CLI::App& app, SourceArguments& args, const std::string& sky) {
  app.add_option("--source", args.names,
                 std::string("Source patch or face") + kNamesHelp + "; all: every patch" + sky +
                     " (default: every emitting patch)")
      ->type_name("NAME[:K]")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

void add_source_options(CLI::App& app, SourceArguments& args) { add_option(app, args, ""); }

void add_source_options_under_sky(CLI::App& app, SourceArguments& args) {
  add_option(app, args, "; sky: what is open, all directions that meet nothing, with a radiosity of 1");
}

std::vector<Selection> sources_of(const SourceArguments& args, const Scene& scene) {
  refuse_sky(scene, args.names);
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

SourcesUnderSky sources_under_sky(const SourceArguments& args, const Scene& scene) {
  SourceArguments patches = args;
  const bool sky = take_sky(scene, patches.names);
  return {sources_of(patches, scene), sky};
}

std::string note_on_sources_without_emission(const Scene& scene, const std::vector<Selection>& sources) {
  constexpr std::size_t kNamed = 5;
  std::vector<std::string> names;
  std::size_t count = 0;
  for (const Selection& source : sources) {
    if (emits(scene, source)) continue;
    if (++count <= kNamed) names.push_back(text::in_quotes(scene.name_of(source)));
  }
  if (count == 0) return {};
  if (count > kNamed) names.push_back(std::to_string(count - kNamed) + " more");
  return count == 1
             ? names.front() + " emits nothing (Ke 0): as a named source it counts with a radiosity of 1"
             : text::enumerate(names) + " emit nothing (Ke 0): as named sources they count with a radiosity of 1 each";
}

std::string command_words(const SourceArguments& args) {
  std::string words;
  for (const std::string& name : args.names) words += " --source " + text::shell_word(name);
  return words;
}

}  // namespace exactff::flags
