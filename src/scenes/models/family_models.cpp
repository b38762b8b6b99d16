// The families (families.h) as models. Each gets materials, so that the source emits, and a square `floor` around the
// receiver, facing the source, for receivers other than the origin.
#include "models/families.h"
#include "models/model_files.h"

namespace exactff::models {

namespace {

constexpr int kMostFaces = 10'000'000;
constexpr int kMostTilesASide = 3000;

FamilyOptions options_of(const Settings& settings) {
  FamilyOptions options;
  options.n = static_cast<int>(settings.whole("n"));
  if (settings.has("seed")) options.seed = static_cast<std::uint64_t>(settings.whole("seed"));
  if (settings.has("cover")) options.cover = settings.number("cover");
  if (settings.has("drop")) options.drop = static_cast<int>(settings.whole("drop"));
  return options;
}

void complete(PlainScene& scene, double side) {
  const double h = side / 2;
  if (side > 0.0) scene.add_ring(scene.patch("floor"), {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}});
  scene.materials = {{"light", {0, 0, 0}, {1, 1, 1}}, {"grey", {0.5, 0.5, 0.5}, {}}};
  for (PlainPatch& patch : scene.patches) patch.material = patch.name == scene.source ? "light" : "grey";
}

template <PlainScene (*kFamily)(const FamilyOptions&)>
PlainScene make_family(const Settings& settings) {
  PlainScene scene = kFamily(options_of(settings));
  complete(scene, settings.number("floor"));
  return scene;
}

// Turns all of Karkanis' triangles towards the receiver, so that they can be sources: the family leaves their front to
// chance.
void turn_down(PlainScene& scene, PlainPatch& patch) {
  for (PlainFace& face : patch.faces) {
    Ring& ring = face.rings.front();
    const Vec3 &a = scene.vertices[ring[0]], &b = scene.vertices[ring[1]], &c = scene.vertices[ring[2]];
    if ((b.x - a.x) * (c.y - a.y) > (b.y - a.y) * (c.x - a.x)) std::swap(ring[1], ring[2]);
  }
}

PlainScene make_karkanis(const Settings& settings) {
  PlainScene scene = karkanis(options_of(settings));
  turn_down(scene, scene.patch("occ"));
  complete(scene, settings.number("floor"));
  return scene;
}

PlainScene make_room(const Settings& settings) { return room(options_of(settings)); }

SettingSpec cover_setting() {
  return number_setting("cover", 1.0, 1e-6, 1e6, "total area of all shadows / area of the source");
}

SettingSpec floor_setting() {
  return number_setting("floor", 1.0, 0.0, 100.0, "side of the patch `floor` around the receiver; 0: no floor");
}

SettingSpec count_setting(int fallback, int most, std::string meaning) {
  return whole_setting("n", fallback, 1, most, std::move(meaning));
}

}  // namespace

Recipe karkanis_model() {
  return {
      {.name = "karkanis",
       .summary = "n random triangles with the same normal, facing the receiver at the origin, in front of the square "
                  "source (occ, source, floor)",
       .settings = {count_setting(50, kMostFaces, "triangles"), cover_setting(), floor_setting(), seed_setting()}},
      &make_karkanis};
}

Recipe soup_model() {
  return {{.name = "soup",
           .summary = "n random triangles of any orientation between the origin and the square source (occ, source, "
                      "floor)",
           .settings = {count_setting(50, kMostFaces, "triangles"), cover_setting(), floor_setting(), seed_setting()}},
          &make_family<&soup>};
}

Recipe blinds_model() {
  return {{.name = "blinds",
           .summary = "n tilted slats between the origin and the square source (occ, source, floor)",
           .settings = {count_setting(50, kMostFaces, "slats"), floor_setting()}},
          &make_family<&blinds>};
}

Recipe tiles_model() {
  return {
      {.name = "tiles",
       .summary = "n x n abutting squares that hide the square source from the origin (occ, source, floor)",
       .settings = {count_setting(16, kMostTilesASide,
                                  "tiles along a side; with a power of two, the corners are exact"),
                    whole_setting("drop", 0, 0, kMostFaces, "leave out every k-th square; 0: none"), floor_setting()}},
      &make_family<&tiles>};
}

Recipe mesh_model() {
  return {{.name = "mesh",
           .summary = "a closed sphere of about n triangles between the origin and the square source (occ, source, "
                      "floor)",
           .settings = {count_setting(1000, kMostFaces, "triangles"), floor_setting()}},
          &make_family<&mesh>};
}

Recipe lattice_model() {
  return {
      {.name = "lattice",
       .summary = "n faces that touch, overlap and coincide, with corners on multiples of 1/64 (occ, source, floor)",
       .settings = {count_setting(50, kMostFaces, "faces"), cover_setting(), floor_setting(), seed_setting()}},
      &make_family<&lattice>};
}

Recipe room_model() {
  return {{.name = "room",
           .summary = "a room with a window behind a venetian blind of n slats, and a table (floor, ceiling, wall_*, "
                      "window, blind, table_*)",
           .settings = {count_setting(32, kMostFaces, "slats")}},
          &make_room};
}

}  // namespace exactff::models
