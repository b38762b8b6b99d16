// Arbitrary bytes as an OBJ, glTF, PLY, STL, OFF or View3D file; in the case of OBJ, the bytes after the first 0x1e
// (ASCII's record separator) are the MTL file `m`. EXACTFF_FUZZ_FILE: a name of the format.
//
// Both modes of the readers are tried. The result is either an InputError with a message, or a scene that keeps its
// promises and has form factors in [0, 1]. Every writer writes such a scene to a file that reads back to a scene; that
// scene is then written and read without any change.
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
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

const TemporaryDirectory& place() {
  static const TemporaryDirectory directory(memory_folder());
  return directory;
}

std::optional<Scene> read(std::string_view bytes, const char* name, const SceneOptions& options = {}) {
  std::optional<Scene> scene;
  unless_refused([&] { scene = read_scene(bytes, place().path() / name, options); });
  return scene;
}

// Empty if the format cannot hold the scene's coordinates. A material file is written to its place.
std::string written(const Scene& scene, const char* name, Encoding encoding) {
  std::string bytes;
  unless_refused([&] {
    const auto files = scene_files(scene, place().path() / name, encoding).files;
    if (files.size() > 1) std::ofstream(files.front().path, std::ios::binary) << files.front().bytes;
    bytes = files.back().bytes;
  });
  return bytes;
}

bool has_area(const Scene& scene) {
  return std::ranges::any_of(scene.faces(), [](const Face& face) { return face.piece_count > 0; });
}

// The first writing may change names and cut faces; the second must not.
void check_written(const Scene& scene, const char* name, Encoding encoding) {
  const std::string first = written(scene, name, encoding);
  const bool rounds = name == std::string_view("s.stl") && encoding == Encoding::kBinary;
  if (first.empty() || rounds) return;
  const auto again = read(first, name);
  if (!again && has_area(scene)) fail(std::string("what was written as ") + name + " is refused:\n" + first);
  if (!again) return;
  const std::string broken = broken_promise(*again);
  if (!broken.empty()) fail(std::string(name) + ": " + broken);
  const std::string second = written(*again, name, encoding);
  const auto last = read(second, name);
  if (!last || last->hash() != again->hash() || written(*last, name, encoding) != second)
    fail(std::string("what was written as ") + name + " changes when it is written again:\n" + second);
}

// Large scenes are left to the benchmarks.
void check_form_factors(const Scene& scene) {
  constexpr std::size_t kPieces = 40, kPatches = 3;
  if (scene.pieces().size() > kPieces) return;
  const Receiver receiver{{0.25, -0.125, 0.0}, {0.5, 0.25, 1.0}, {}, {}};
  for (std::size_t i = 0; i < std::min(scene.patches().size(), kPatches); ++i) {
    const ExactSource source(scene, {PatchId(static_cast<std::uint32_t>(i)), std::nullopt, scene.id()});
    const FormFactor f = exact_form_factor(scene, receiver, source, {.engine = Engine::kBoth});
    if (!(f.value >= 0.0 && f.value <= 1.0)) fail("a form factor outside [0, 1]");
    if (f.status == Status::kNotCertified) fail("a form factor that is not certified");
  }
}

void check_welding(const Scene& scene) {
  if (const std::string broken = broken_promise(scene); !broken.empty()) fail(broken);
  (void)gap(scene);
  for (const double length : {1e-9, 0.125, 1e3}) {
    try {
      const Scene once = welded(scene, length).scene;
      if (welded(once, length).largest_move != 0.0) fail("welding twice moves corners twice");
    } catch (const InputError&) {  // too large for this scene
    }
  }
}

void check(std::string_view bytes, const SceneOptions& options) {
  const auto scene = read(bytes, EXACTFF_FUZZ_FILE, options);
  if (!scene) return;
  const std::string broken = broken_promise(*scene);
  if (!broken.empty()) fail(broken);
  (void)scene->emitters();
  (void)scene->open_edge_count();
  check_form_factors(*scene);
  for (const char* out : {"w.obj", "s.off", "s.vs3", "s.ply", "s.stl"}) check_written(*scene, out, Encoding::kText);
  for (const char* out : {"s.ply", "s.stl"}) check_written(*scene, out, Encoding::kBinary);
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff;
  using namespace exactff::validation;
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (EXACTFF_FUZZ_FILE == std::string_view("s.obj")) {
    const std::size_t end = std::min(bytes.find(kSeparator), size);
    (void)place().write("m", std::string(bytes.substr(std::min(end + 1, size))));
    bytes = bytes.substr(0, end);
  }
  check(bytes, {});
  check(bytes, {BadFaces::kSkip, PatchMode::kFaces});
  for (const PatchMode mode : {PatchMode::kPlanes, PatchMode::kSmooth, PatchMode::kParts}) {
    const auto scene = read(bytes, EXACTFF_FUZZ_FILE, {BadFaces::kSkip, mode});
    if (scene) check_welding(*scene);
  }
  return 0;
}
