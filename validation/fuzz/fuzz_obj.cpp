// Arbitrary bytes as an OBJ file and, after the first byte 0x1e (ASCII's record separator), as the MTL file `m`.
//
// The result is either an InputError with a message, or a scene that keeps its promises: pieces, names, the same hash
// when its own text is read again, and form factors in [0, 1]. Both modes of the reader are tried.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

#include "exactff/exact.h"
#include "exactff/scene_files.h"
#include "fuzz/complaints.h"
#include "fuzz/scene_promises.h"
#include "support/program.h"

namespace exactff::validation {
namespace {

constexpr char kSeparator = '\x1e';
constexpr const char* kMtlName = "m";

std::optional<Scene> read(const SceneText& text, const SceneOptions& options) {
  static const TemporaryDirectory directory;
  (void)directory.write(kMtlName, text.mtl);
  std::istringstream in(text.obj);
  try {
    return read_obj(in, directory.path() / "scene.obj", options);
  } catch (const InputError& error) {
    require_words(error);
    return std::nullopt;
  }
}

void check_round_trip(const Scene& scene, const SceneOptions& options) {
  const SceneText text = text_of(scene, kMtlName);
  const auto again = read(text, {options.bad_faces, PatchMode::kGroups});
  if (!again) fail("the scene's own text is refused:\n" + text.obj);
  if (again->hash() != scene.hash()) fail("the scene's own text gives another hash:\n" + text.obj);
}

// Large scenes are left to the benchmarks.
void check_form_factors(const Scene& scene) {
  constexpr std::size_t kPieces = 40;
  constexpr std::size_t kPatches = 3;
  if (scene.pieces().size() > kPieces) return;
  const Receiver receiver{{0.25, -0.125, 0.0}, {0.5, 0.25, 1.0}, {}, {}};
  for (std::size_t i = 0; i < std::min(scene.patches().size(), kPatches); ++i) {
    const ExactSource source(scene, {PatchId(static_cast<std::uint32_t>(i)), std::nullopt});
    const FormFactor f = exact_form_factor(scene, receiver, source, {.engine = Engine::kBoth});
    if (!(f.value >= 0.0 && f.value <= 1.0)) fail("a form factor outside [0, 1]");
    if (f.status == Status::kNotCertified) fail("a form factor that is not certified");
  }
}

void check(const SceneText& text, const SceneOptions& options) {
  const auto scene = read(text, options);
  if (!scene) return;
  const std::string broken = broken_promise(*scene);
  if (!broken.empty()) fail(broken);
  (void)scene->emitters();
  (void)scene->open_edge_count();
  check_round_trip(*scene, options);
  check_form_factors(*scene);
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff::validation;
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = std::min(input.find(kSeparator), size);
  const SceneText text{std::string(input.substr(0, end)), std::string(input.substr(std::min(end + 1, size)))};
  check(text, {});
  check(text, {exactff::BadFaces::kSkip, exactff::PatchMode::kFaces});
  return 0;
}
