#include "flags/solution.h"

#include <utility>

#include "exactff/matrix.h"
#include "flags/file_options.h"
#include "flags/lists.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::flags {
namespace {

std::optional<double> agreed_length(const std::optional<double>& flag, const radiosity::SolutionFile& file) {
  const std::optional<double>& length = file.origin.divided;
  if (!flag || flag == length) return length;
  text::refuse(file.file,
               length ? "is of the scene divided by " + text::shortest(*length) : "is of the undivided scene",
               "--divide " + text::shortest(*flag) + " makes other patches",
               "leave out --divide, or compute the radiosities with it");
}

// What cannot be done to this scene is what the file wants, not the user.
Scene made_as_in(const radiosity::SolutionFile& file, SceneArguments scene) {
  const std::optional<double> length = agreed_length(std::exchange(scene.divide, {}), file);
  const std::vector<std::string>& two_sided = file.origin.two_sided;
  Scene made = scene.load();
  try {
    if (length) made = divided_with_note(made, *length);
    if (!two_sided.empty()) made = matrix::with_two_sided(made, selections_named(made, two_sided));
  } catch (const InputError& error) {
    text::refuse(file.file, "holds radiosities of a scene that was changed as this one cannot be",
                 error.problems().front().what, "give the scene and the flags that `exactff radiosity` was given");
  }
  return made;
}

}  // namespace

void SolutionArgument::add_to(CLI::App& app) {
  app.add_option(
         "--radiosity", file,
         "Light after all bounces: radiosities of all patches, by `exactff radiosity SCENE -o FILE`; --divide and "
         "--two-sided of that command are taken from the file")
      ->type_name("FILE")
      ->check(is_read());
}

LitScene load(const SceneArguments& scene, const SolutionArgument& solution) {
  if (!solution.is_given()) return {scene.load(), std::nullopt};
  const radiosity::SolutionFile file = radiosity::read_solution(solution.file);
  Scene made = made_as_in(file, scene);
  radiosity::Radiosities radiosities = radiosity::radiosities_of(made, file);
  return {std::move(made), std::move(radiosities)};
}

}  // namespace exactff::flags
