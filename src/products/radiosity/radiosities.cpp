// The radiosities of all patches, from a solution or from its file.
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "exactff/radiosity.h"
#include "kernel/float_environment.h"
#include "radiosity/gather.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::radiosity {
namespace {

void set(Radiosities& all, std::size_t patch, std::size_t channel, const BoundedValue& b) {
  const auto colour = kColours[channel];
  all.value[patch].*colour = b.value;
  all.lower[patch].*colour = b.lower;
  all.upper[patch].*colour = b.upper;
}

Radiosities of_patches(std::vector<Selection> patches) {
  const std::vector<Rgb> none(patches.size());
  return {{}, std::move(patches), none, none, none};
}

[[noreturn]] void refuse_unbounded(const std::string& file, std::size_t channel) {
  throw InputError(
      {.file = file,
       .what = "there is no bound for " + std::string(kChannelNames[channel]),
       .why = "what is gathered from estimates alone would have no bounds either",
       .suggestion = "lower Kd where it is 1, or compute narrower view factors by --accuracy and --budget"});
}

void require_scene(const Scene& scene, const SolutionFile& file) {
  if (scene.hash() == file.scene_hash) return;
  text::refuse(file.file, "holds radiosities of another scene, hash " + file.scene_hash,
               "the scene given has the hash " + scene.hash(),
               "give the scene and the flags that `exactff radiosity` was given");
}

[[noreturn]] void refuse_row(const SolutionFile& file, const std::string& what) {
  text::refuse(file.file, what, "every patch has one radiosity in each channel",
               "use the file as `exactff radiosity` wrote it");
}

}  // namespace

Radiosities radiosities_of(const Solution& solution) {
  Radiosities all = of_patches(solution.patches);
  for (std::size_t c = 0; c < kColours.size(); ++c) {
    if (!solution.channels[c].is_bounded()) refuse_unbounded({}, c);
    for (std::size_t i = 0; i < all.patches.size(); ++i) set(all, i, c, solution.channels[c].radiosity[i]);
  }
  return all;
}

Radiosities radiosities_of(const Scene& scene, const SolutionFile& file) {
  const kernel::StandardArithmetic arithmetic;
  require_scene(scene, file);
  Radiosities all = of_patches(patches_of(scene));
  all.name = std::filesystem::path(file.file).filename().string();
  std::map<std::pair<std::string, std::size_t>, std::size_t> wanted;
  for (std::size_t i = 0; i < all.patches.size(); ++i) {
    for (std::size_t c = 0; c < kColours.size(); ++c) wanted.emplace(std::pair(scene.name_of(all.patches[i]), c), i);
  }
  for (const SolutionFile::Row& row : file.rows) {
    const auto found = wanted.find({row.patch, row.channel});
    if (found == wanted.end()) {
      refuse_row(file, "has " + text::in_quotes(row.patch, text::kShownName) + " twice, or as a patch without area");
    }
    if (std::isinf(row.radiosity.upper)) refuse_unbounded(file.file, row.channel);
    set(all, found->second, row.channel, row.radiosity);
    wanted.erase(found);
  }
  if (!wanted.empty()) {
    refuse_row(file, "has no radiosity of " + text::in_quotes(wanted.begin()->first.first, text::kShownName));
  }
  return all;
}

}  // namespace exactff::radiosity
