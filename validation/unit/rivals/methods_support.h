// Short ways to a method's value for the tests of the methods.
#pragma once

#include "generate/families.h"
#include "support/test.h"
#include "unit/rivals/sampled_scenes.h"

namespace exactff::validation {

inline methods::Estimate estimate(const Scene& scene, const Receiver& receiver, std::string_view source,
                                  std::string_view choice) {
  const methods::Choice chosen = methods::parse(choice);
  const auto on_scene = chosen.method->prepare(scene);
  const auto prepared = on_scene->prepare_source(scene.select(source));
  return on_scene->configure(chosen.settings)->form_factor(receiver, *prepared);
}

inline double value(const generate::PlainScene& plain, std::string_view choice) {
  const Scene scene = generate::build(plain);
  return estimate(scene, generate::receiver_of(plain), plain.source, choice).form_factor;
}

inline double truth(const generate::PlainScene& plain) {
  const Scene scene = generate::build(plain);
  return exact_form_factor(scene, generate::receiver_of(plain), ExactSource(scene, scene.select(plain.source))).value;
}

// A room without a lid: a lamp in two faces above, a table with something on it, walls; receivers on the floor.
inline Scene furnished_room() {
  generate::PlainScene plain;
  add(plain, "floor", {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  add(plain, "wall", {{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  add(plain, "wall", {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  add(plain, "lamp", {{1, 1, 3}, {1, 3, 3}, {2, 3, 3}, {2, 1, 3}});
  add(plain, "lamp", {{2, 1, 3}, {2, 3, 3}, {3, 2, 3}});
  add(plain, "table", {{1, 1, 1}, {3, 1, 1}, {3, 2.5, 1}, {1, 2.5, 1}});
  add(plain, "vase", {{2, 2, 1}, {2.5, 2, 1}, {2.25, 2, 2}});
  return generate::build(plain);
}

inline std::vector<Receiver> room_receivers(const Scene& room) {
  return grid_receivers(room, room.select("floor"), {3, 3});
}

}  // namespace exactff::validation
