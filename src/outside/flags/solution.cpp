#include "flags/solution.h"

#include <utility>

#include "exactff/matrix.h"
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

}  // namespace

void SolutionArgument::add_to(CLI::App& app) {
  app.add_option(
         "--radiosity", file,
         "Light after all bounces: radiosities of all patches, by `exactff radiosity SCENE -o FILE`; --divide and "
         "--two-sided of that command are taken from the file")
      ->type_name("FILE");
}

LitScene load(const SceneArguments& scene, const SolutionArgument& solution) {
  if (!solution.is_given()) return {scene.load(), std::nullopt};
  const radiosity::SolutionFile file = radiosity::read_csv(solution.file);
  SceneArguments divided = scene;
  divided.divide = agreed_length(scene.divide, file);
  Scene made = divided.load();
  const std::vector<std::string>& two_sided = file.origin.two_sided;
  if (!two_sided.empty()) made = matrix::with_two_sided(made, selections_named(made, two_sided));
  radiosity::Radiosities radiosities = radiosity::radiosities_of(made, file);
  return {std::move(made), std::move(radiosities)};
}

}  // namespace exactff::flags
