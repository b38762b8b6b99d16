#include "models/registry.h"

#include <algorithm>

#include "kernel/float_environment.h"
#include "text/settings.h"

namespace exactff::models {

namespace {

// In the order in which they are listed.
const std::vector<Recipe>& list() {
  static const std::vector<Recipe> recipes = {teapot_model(), forest_model(),   closed_room_model(), emitters_model(),
                                              room_model(),   karkanis_model(), soup_model(),        blinds_model(),
                                              tiles_model(),  mesh_model(),     lattice_model()};
  return recipes;
}

const Recipe& recipe_named(std::string_view name) {
  const auto found = std::ranges::find_if(list(), [&](const Recipe& recipe) { return recipe.model.name == name; });
  if (found != list().end()) return *found;
  std::vector<std::string_view> names;
  for (const Recipe& recipe : list()) names.emplace_back(recipe.model.name);
  throw text::unknown_name("model", name, names);
}

struct Choice {
  const Recipe& recipe;
  Settings settings;

  // Includes all settings, so that the text stays valid when a default changes.
  [[nodiscard]] std::string text() const { return recipe.model.name + ":" + settings.text(); }
};

Choice parse(std::string_view text) {
  const auto [name, assignments] = text::take_apart(text);
  const Recipe& recipe = recipe_named(name);
  Choice choice{recipe, Settings(recipe.model.settings)};
  text::read_assignments(assignments, "model '" + recipe.model.name + "'", choice.settings);
  return choice;
}

}  // namespace

std::vector<const Model*> all_models() {
  std::vector<const Model*> models;
  for (const Recipe& recipe : list()) models.push_back(&recipe.model);
  return models;
}

PlainScene make_plain(std::string_view text) {
  const Choice choice = parse(text);
  PlainScene scene = choice.recipe.make(choice.settings);
  scene.comments.insert(scene.comments.begin(), "exactff model " + choice.text());
  return scene;
}

Scene make_scene(std::string_view text, const SceneOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  return build(make_plain(text), "@" + std::string(text), options);
}

std::string make_obj(std::string_view text, const std::string& mtl) {
  const kernel::StandardArithmetic arithmetic;
  PlainScene scene = make_plain(text);
  if (mtl.empty()) {
    for (PlainPatch& patch : scene.patches) patch.material.clear();  // readers would miss their definition
  }
  return to_obj(scene, mtl);
}

std::string make_mtl(std::string_view text) {
  const kernel::StandardArithmetic arithmetic;
  return to_mtl(make_plain(text));
}

std::string description(const Model& model) {
  return model.name + ": " + model.summary + "\n" + text::setting_lines(model.settings);
}

}  // namespace exactff::models
