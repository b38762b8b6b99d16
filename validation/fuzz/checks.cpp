#include "fuzz/checks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <exception>
#include <functional>
#include <sstream>
#include <utility>
#include <vector>

#include "exactff/exact.h"
#include "exactff/scene_files.h"
#include "support/oracle_check.h"
#include "support/transform.h"

namespace exactff::validation {

using generate::PlainPatch;
using generate::PlainScene;
using generate::Random;

namespace {

FormFactor solve(const Scene& scene, const PlainScene& plain, ExactOptions options) {
  options.engine = Engine::kBoth;
  const ExactSource source(scene, scene.select(plain.source));
  return exact_form_factor(scene, generate::receiver_of(plain), source, options);
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

// --- against itself ---

struct Answer {
  double value = 0.0;
  double fraction = 0.0;
  Status status = Status::kZero;

  friend bool operator==(const Answer& a, const Answer& b) {
    return bits(a.value) == bits(b.value) && bits(a.fraction) == bits(b.fraction) && a.status == b.status;
  }
};

Answer answer_of(const FormFactor& result) { return {result.value, result.visible_fraction.value(), result.status}; }

Answer answer(const Scene& scene, const PlainScene& plain, const std::vector<FaceId>* only_occluders = nullptr) {
  ExactOptions options;
  options.visible_fraction = true;
  options.only_occluders = only_occluders;
  return answer_of(solve(scene, plain, options));
}

Answer answer(const PlainScene& plain) { return answer(generate::build(plain), plain); }

std::string text_of(const Answer& answer) {
  return generate::to_text(answer.value) + " (" + std::string(to_string(answer.status)) + ", fraction " +
         generate::to_text(answer.fraction) + ')';
}

std::string difference(const Answer& one, const Answer& other, Identity identity) {
  return one == other ? std::string() : name_of(identity) + ": " + text_of(one) + " and " + text_of(other);
}

bool same_positions(const PlainScene& a, const PlainScene& b) { return a.point == b.point && a.vertices == b.vertices; }

// Scales by a power of two that loses no bit; returns nothing if the random one does.
std::optional<PlainScene> scaled(const PlainScene& scene, Random& random) {
  const int exponent = random.integer(-1000, 1000);
  PlainScene out = scene;
  generate::scale(out, std::ldexp(1.0, exponent));
  PlainScene back = out;
  generate::scale(back, std::ldexp(1.0, -exponent));
  return same_positions(back, scene) ? std::optional(std::move(out)) : std::nullopt;
}

std::optional<PlainScene> with_other_normal(const PlainScene& scene, Random& random) {
  const int exponent = random.integer(-900, 900);
  const auto times = [](const Vec3& v, double f) { return Vec3{v.x * f, v.y * f, v.z * f}; };
  PlainScene out = scene;
  out.normal = times(scene.normal, std::ldexp(1.0, exponent));
  return times(out.normal, std::ldexp(1.0, -exponent)) == scene.normal ? std::optional(std::move(out)) : std::nullopt;
}

// The first occluder in random order; nothing if there is none.
std::optional<std::size_t> some_occluder(const PlainScene& scene, Random& random) {
  std::vector<std::size_t> occluders;
  for (std::size_t i = 0; i < scene.patches.size(); ++i) {
    if (scene.patches[i].name != scene.source) occluders.push_back(i);
  }
  return occluders.empty() ? std::nullopt : std::optional(occluders[random.below(occluders.size())]);
}

std::optional<PlainScene> with_twin(const PlainScene& scene, Random& random) {
  const auto chosen = some_occluder(scene, random);
  if (!chosen) return std::nullopt;
  PlainScene out = scene;
  PlainPatch twin = scene.patches[*chosen];
  twin.name = "twin";
  out.patches.insert(out.patches.begin(), std::move(twin));
  return out;
}

std::optional<PlainScene> without_one(const PlainScene& scene, Random& random) {
  const auto chosen = some_occluder(scene, random);
  if (!chosen) return std::nullopt;
  PlainScene out = scene;
  out.patches.erase(out.patches.begin() + static_cast<std::ptrdiff_t>(*chosen));
  return out;
}

bool can_be_built(const PlainScene& scene) {
  try {
    (void)generate::build(scene);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// Rounding is monotone, so the correctly rounded values may not decrease either.
std::string one_less_problem(const FuzzCase& fuzz_case) {
  const auto fewer = changed(fuzz_case);
  if (!fewer) return {};
  const Answer with = answer(fuzz_case.scene);
  const Answer without = answer(*fewer);
  if (without.value >= with.value && without.fraction >= with.fraction) return {};
  return "an occluder more raises " + text_of(without) + " to " + text_of(with);
}

// If only the faces reported as cutting the source remain, they cut it to the same shape.
std::string cutters_problem(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  ExactOptions options;
  options.visible_fraction = true;
  options.list_cutters = true;
  const FormFactor all = solve(scene, plain, options);
  return difference(answer_of(all), answer(scene, plain, &all.cutters), Identity::kCuttersAlone);
}

// OBJ has no holes. to_obj converts them to keyholes, which requires rings that do not meet. So such faces are left out
// here; the decoder makes its own keyholes.
bool has_holes(const PlainScene& scene) {
  return std::ranges::any_of(scene.patches, [](const PlainPatch& patch) {
    return std::ranges::any_of(patch.faces, [](const generate::PlainFace& face) { return face.rings.size() > 1; });
  });
}

std::string obj_problem(const PlainScene& plain) {
  if (has_holes(plain)) return {};
  std::istringstream in(generate::to_obj(plain));
  return difference(answer(plain), answer(read_obj(in, "scene.obj"), plain), Identity::kObjText);
}

// Drawings are rounded; the only promise is that one exists.
std::string drawing_problem(const PlainScene& plain) {
  const Scene scene = generate::build(plain);
  const ExactSource source(scene, scene.select(plain.source));
  const FormFactor result = solve(scene, plain, {});
  const auto drawings = draw_visibility(scene, generate::receiver_of(plain), source);
  const bool something = std::ranges::any_of(drawings, [](const PlaneDrawing& d) { return !d.visible.empty(); });
  if (something == (result.status != Status::kZero)) return {};
  return something ? "a drawing shows a source that is hidden" : "a drawing lacks a source that is visible";
}

std::string guarded(const std::function<std::string()>& check) {
  try {
    return check();
  } catch (const std::exception& error) {
    return std::string("threw ") + error.what();
  }
}

}  // namespace

std::string oracle_problem(const PlainScene& scene) { return disagreement(scene); }

std::optional<PlainScene> changed(const FuzzCase& fuzz_case) {
  const PlainScene& scene = fuzz_case.scene;
  Random random(fuzz_case.seed);
  switch (fuzz_case.identity) {
    case Identity::kOrder:
      return shuffled(scene, random);
    case Identity::kRetriangulation:
      return retriangulated(scene, random);
    case Identity::kSymmetry:
      return turned(scene, all_symmetries()[1 + random.below(47)]);
    case Identity::kScaling:
      return scaled(scene, random);
    case Identity::kNormalLength:
      return with_other_normal(scene, random);
    case Identity::kTwinOccluder:
      return with_twin(scene, random);
    case Identity::kOneOccluderLess:
      return without_one(scene, random);
    case Identity::kIdleCorners:
      return with_idle_corners(scene, random);
    case Identity::kSpikes: {
      // Intended for rings without spikes; a second spike may cross an existing one.
      PlainScene out = with_spikes(scene, random);
      return can_be_built(out) ? std::optional(std::move(out)) : std::nullopt;
    }
    case Identity::kCuttersAlone:
    case Identity::kObjText:
    case Identity::kDrawing:
      break;
  }
  return std::nullopt;
}

std::string identity_problem(const FuzzCase& fuzz_case) {
  return guarded([&]() -> std::string {
    switch (fuzz_case.identity) {
      case Identity::kOneOccluderLess:
        return one_less_problem(fuzz_case);
      case Identity::kCuttersAlone:
        return cutters_problem(fuzz_case.scene);
      case Identity::kObjText:
        return obj_problem(fuzz_case.scene);
      case Identity::kDrawing:
        return drawing_problem(fuzz_case.scene);
      default:
        break;
    }
    const auto other = changed(fuzz_case);
    return other ? difference(answer(fuzz_case.scene), answer(*other), fuzz_case.identity) : std::string();
  });
}

std::string problem(const FuzzCase& fuzz_case) {
  std::string wrong = oracle_problem(fuzz_case.scene);
  return wrong.empty() ? identity_problem(fuzz_case) : wrong;
}

std::string name_of(Identity identity) {
  constexpr std::array<const char*, kIdentityCount> kNames{"order",
                                                           "retriangulation",
                                                           "symmetry",
                                                           "scaling",
                                                           "length of the normal",
                                                           "twin occluder",
                                                           "one occluder less",
                                                           "cutters alone",
                                                           "idle corners",
                                                           "spikes",
                                                           "OBJ text",
                                                           "drawing"};
  return kNames.at(static_cast<std::size_t>(identity));
}

}  // namespace exactff::validation
