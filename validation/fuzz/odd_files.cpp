#include "fuzz/odd_files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "exactff/exr.h"
#include "exactff/scene_files.h"
#include "fuzz/scene_bytes.h"
#include "generate/families.h"
#include "support/random_scenes.h"

namespace exactff::validation {

using generate::PlainScene;
using generate::Random;

namespace {

PlainScene scene_of_bytes(Random& random) {
  for (;;) {
    std::vector<std::uint8_t> bytes(20 + random.below(200));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.bits());
    if (auto fuzz_case = decode(bytes)) return std::move(fuzz_case->scene);
  }
}

PlainScene scene_of_family(Random& random) {
  const auto families = generate::families();
  return families[random.below(families.size())].make(
      {.n = random.integer(1, 12), .seed = random.bits(), .cover = random.unit(), .drop = random.integer(0, 3)});
}

PlainScene scene_on_rays(Random& random) {
  const auto families = families_on_rays();
  return families[random.below(families.size())].make(random);
}

PlainScene scene_of_any_family(Random& random) {
  constexpr std::array kFamilies = {degenerate_scene, generic_scene,           nudged_scene,  sheared_scene,
                                    triangles_scene,  scene_of_all_magnitudes, scene_on_rays, scene_of_family,
                                    scene_of_bytes,   scene_of_bytes};
  return random.one_in(30) ? crowded_scene(random) : kFamilies[random.below(kFamilies.size())](random);
}

// Extreme values are rare, because tolerances are small compared with them, and the adaptive algorithm then runs for a
// long time.
double odd_emission(Random& random) {
  if (!random.one_in(8)) return one_of<double>(random, {0.0, 0.0, 1.0, 15.5, random.unit()});
  return one_of<double>(random, {1e-300, 1e300, 4.9e-324, 1.7976931348623157e308});
}

void add_materials(PlainScene& scene, Random& random) {
  const std::size_t before = scene.materials.size();
  for (int i = random.integer(0, 3); i > 0; --i) {
    const double e = odd_emission(random), d = random.one_in(3) ? random.unit() : 0.5;
    scene.materials.push_back({odd_name(random), {d, d, 1.0 - d}, {e, odd_emission(random), e}});
  }
  for (generate::PlainPatch& patch : scene.patches) {
    if (scene.materials.size() == before || random.one_in(2)) continue;
    patch.material = scene.materials[before + random.below(scene.materials.size() - before)].name;
  }
}

void rename_patches(PlainScene& scene, Random& random) {
  for (generate::PlainPatch& patch : scene.patches) {
    if (!random.one_in(3)) continue;
    const std::string name = odd_name(random);
    if (patch.name == scene.source) scene.source = name;
    patch.name = name;
  }
}

// In OBJ, a group name is one word, and an object name is the rest of the line.
std::string with_objects(std::string obj) {
  for (std::size_t at = 0; (at = obj.find("\ng ", at)) != std::string::npos; ++at) obj[at + 1] = 'o';
  return obj;
}

void add_scene(OddInputs& inputs, Random& random) {
  for (;;) {
    PlainScene scene = scene_of_any_family(random);
    rename_patches(scene, random);
    add_materials(scene, random);
    try {
      const std::string obj = generate::to_obj(scene, "scene.mtl");
      inputs.files["in/scene.obj"] = random.one_in(2) ? with_objects(obj) : obj;
    } catch (const std::invalid_argument&) {  // touching holes cannot be converted to keyholes
      continue;
    }
    inputs.files["in/scene.mtl"] = generate::to_mtl(scene);
    inputs.scene = std::move(scene);
    return;
  }
}

// The same scene in other formats, unless it cannot be built.
void add_other_formats(OddInputs& inputs) {
  try {
    const Scene scene = generate::build(inputs.scene);
    for (const char* path : {"in/scene.ply", "in/scene.stl", "in/scene.vs3"})
      inputs.files[path] = scene_files(scene, path).files.back().bytes;
  } catch (const InputError&) {
    return;
  }
}

// --- tables ---

// As in CSV; sometimes without the necessary quotes.
std::string field(Random& random, const std::string& text) {
  if (text.find_first_of(",\"\n\r ") == std::string::npos || random.one_in(30)) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string line_of(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& text : fields) line += (line.empty() ? "" : ",") + text;
  return line + '\n';
}

std::string near(Random& random, double centre) {
  return random.one_in(12) ? odd_number(random) : generate::to_text(centre + (random.unit() - 0.5) * 0.25);
}

std::string odd_receivers(const PlainScene& scene, Random& random) {
  std::string text = "id,x,y,z,nx,ny,nz,on\n";
  for (int i = random.integer(0, 5); i > 0; --i) {
    const std::string id = random.one_in(3) ? odd_name(random) : "r" + std::to_string(i);
    const std::string on = random.one_in(4) ? one_of(random, scene.patches).name + (random.one_in(2) ? ":1" : "") : "";
    text += line_of({field(random, id), near(random, scene.point.x), near(random, scene.point.y),
                     near(random, scene.point.z), near(random, scene.normal.x), near(random, scene.normal.y),
                     near(random, scene.normal.z), field(random, on)});
  }
  return text;
}

float odd_float(Random& random, double near) {
  if (!random.one_in(30)) return static_cast<float>(near + (random.one_in(3) ? 0.0 : (random.unit() - 0.5) * 0.25));
  return one_of<float>(random, {0.0F, -0.0F, 1e-45F, 3e38F, std::numeric_limits<float>::infinity(),
                                std::numeric_limits<float>::quiet_NaN()});
}

void add_channels(exr::Image& image, const std::vector<std::pair<std::string, double>>& channels, Random& random) {
  for (const auto& [name, near] : channels) {
    exr::Numbers& channel = image.channels.emplace_back(exr::Numbers{name, exr::Kind::kFloat, {}});
    if (random.one_in(40)) channel.kind = exr::Kind::kWhole;
    for (std::size_t i = 0; i < image.data.pixels(); ++i) {
      channel.bits.push_back(std::bit_cast<std::uint32_t>(odd_float(random, near)));
    }
  }
}

// Visible points near the scene's receiver, a truth and the values of another program.
void add_images(OddInputs& inputs, Random& random) {
  const exr::Window data{random.integer(-2, 2), random.integer(-2, 2), random.integer(1, 5), random.integer(1, 20)};
  const exr::Window display{0, 0, 5, 20};
  const Vec3 &p = inputs.scene.point, &n = inputs.scene.normal;
  const std::string view = random.one_in(4) ? odd_name(random) + '.' : "";
  const std::string position = view + (random.one_in(3) ? "P" : "position") + '.', normal = view + "normal.";
  exr::Image points{data, display, {}, {{"key", odd_name(random)}}};
  add_channels(points,
               {{position + "X", p.x},
                {position + "Y", p.y},
                {position + "Z", p.z},
                {normal + "X", n.x},
                {normal + "Y", n.y},
                {normal + "Z", n.z}},
               random);
  if (random.one_in(4)) add_channels(points, {{"A", 1.0}}, random);
  inputs.files["in/gbuffer.exr"] = exr::exr_of(points);
  for (const char* path : {"in/truth.exr", "in/candidate.exr"}) {
    exr::Image image{random.one_in(8) ? display : data, display, {}, {}};
    const std::string layer = random.one_in(3) ? "view." : "";
    add_channels(image, {{layer + "R", 0.5}, {layer + "G", 0.25}, {layer + "B", 0.0}}, random);
    inputs.files[path] = exr::exr_of(image);
  }
}

// A truth file with few rows and the values of another program for them, by id and by position.
void add_tables(Files& files, Random& random) {
  const bool rho = random.one_in(2), positions = !random.one_in(3), bounds = random.one_in(2);
  std::string truth = "# made by hand: " + odd_name(random) + "\nreceiver,source" + (positions ? ",x,y,z" : "") +
                      (rho ? ",largest_rho_b" : "") + (bounds ? ",lower,upper,status" : "") + ",exact\n";
  std::string candidate = random.one_in(2) ? "receiver,source,x,y,z,value\n" : "id,source,x,y,z,approximate,other\n";
  const std::string last = candidate.ends_with("other\n") ? ",1" : "";
  const std::vector<std::string> sources = {"light", odd_name(random)};
  for (int i = random.integer(0, 8); i > 0; --i) {
    const std::string id = field(random, random.one_in(3) ? odd_name(random) : std::to_string(i));
    const std::string source = field(random, one_of(random, sources));
    const double exact = random.one_in(4) ? 0.0 : random.one_in(5) ? 4.9e-324 : random.unit();
    const double value =
        random.one_in(2) ? exact : exact * (1.0 + (random.unit() - 0.5) * std::ldexp(1.0, -random.integer(0, 60)));
    const std::string place = std::to_string(i) + ",0," + odd_number(random);
    std::string row = id + "," + source + (positions ? "," + place : "") + (rho ? "," + odd_number(random) : "");
    if (bounds)
      row += "," + generate::to_text(exact) + "," + generate::to_text(exact) + (exact == 0.0 ? ",zero" : ",certified");
    truth += row + "," + generate::to_text(exact) + '\n';
    if (random.one_in(20)) continue;
    candidate += line_of({id, source, place, random.one_in(10) ? odd_number(random) : generate::to_text(value) + last});
  }
  files["in/truth.csv"] = truth;
  files["in/candidate.csv"] = candidate;
}

std::string odd_study(const PlainScene& scene, Random& random) {
  std::string text = random.one_in(2) ? "title " + odd_name(random) + '\n' : "";
  for (int i = random.integer(1, 2); i > 0; --i) {
    text += std::string("scene ") + (random.one_in(4) ? "@tiles:n=2" : "scene.obj") + " --on '" +
            (random.one_in(4) ? "all" : one_of(random, scene.patches).name) +
            "' --centres --method-budget 0.01 --sweep-budget 0.01 --method-receivers 2 --method-seeds 2 --rays 1,4" +
            " --eps-b .1 --seeds 1" + (random.one_in(2) ? " --source '" + scene.source + "'" : "") +
            (random.one_in(2) ? " --title \"" + odd_name(random) + "\"" : "") + '\n';
  }
  return text;
}

constexpr const char* kBaseline =
    R"({"exactff_baseline": 1, "criteria": [{"criterion": "max", "source": "", "value": 1e-3}]})";

// --- damage ---

void spoil(std::string& text, Random& random) {
  const std::size_t at = random.below(text.size() + 1);
  switch (random.below(4)) {
    case 0:
      return text.resize(at);
    case 1:
      text.erase(at, random.below(20));
      return;
    case 2:
      text.insert(at, random.one_in(2) ? odd_name(random) : std::string(1, static_cast<char>(random.bits())));
      return;
    default:
      if (at < text.size()) text[at] = static_cast<char>(random.bits());
  }
}

}  // namespace

std::string odd_name(Random& random) {
  static const std::vector<std::string> kNames = {"a",
                                                  "a:1",
                                                  "all",
                                                  "a,b",
                                                  "a b",
                                                  "<b>&amp;",
                                                  "\"q\"",
                                                  "it's",
                                                  "\x1b[31m",
                                                  "caf\xe9",
                                                  "na\xc3\xafve",
                                                  "back\\",
                                                  "$(x)",
                                                  "%s%n",
                                                  "::error::x",
                                                  "]]>",
                                                  "-->",
                                                  "del\x7f",
                                                  "=1+2",
                                                  "--out",
                                                  "tab\tx",
                                                  "nel\xc2\x85",
                                                  "\xe2\x80\xaertl",
                                                  "\xff\xfe",
                                                  "</script>",
                                                  "{\"a\":1}",
                                                  "x'/>",
                                                  "\xef\xbf\xbe",
                                                  "@tiles",
                                                  "#",
                                                  "..",
                                                  "\xed\xa0\x80",
                                                  "\xc0\x80"};
  if (random.one_in(25)) return std::string(300, 'n');
  const std::string& name = one_of(random, kNames);
  return random.one_in(6) ? name + one_of(random, kNames) : name;
}

std::string odd_number(Random& random) {
  static const std::vector<std::string> kOdd = {"0",        "-0",     "-1",    "1e308", "1.7976931348623157e308",
                                                "4.9e-324", "1e-310", "1e309", "nan",   "inf",
                                                "-inf",     "",       "0x10",  "1e",    "1,5",
                                                "+1",       "1e-400", "007",   " 1",    "1 ",
                                                "x",        "1d0"};
  if (random.one_in(3)) return one_of(random, kOdd);
  return generate::to_text(random.one_in(2) ? random.unit() : random.integer(0, 4));
}

OddInputs odd_inputs(Random& random) {
  OddInputs inputs;
  add_scene(inputs, random);
  add_other_formats(inputs);
  inputs.files["in/receivers.csv"] = odd_receivers(inputs.scene, random);
  add_tables(inputs.files, random);
  add_images(inputs, random);
  inputs.files["in/run.study"] = odd_study(inputs.scene, random);
  inputs.files["in/baseline.json"] = kBaseline;
  for (auto& [path, text] : inputs.files) {
    if (random.one_in(15)) spoil(text, random);
  }
  return inputs;
}

}  // namespace exactff::validation
