#include "fuzz/scene_file_checks.h"

#include <algorithm>
#include <optional>
#include <string>

#include "exactff/scene_files.h"
#include "fuzz/complaints.h"
#include "fuzz/scene_promises.h"

namespace exactff::validation {

namespace {

std::optional<Scene> read(std::string_view bytes, const char* name, const SceneOptions& options = {}) {
  try {
    return read_scene(bytes, name, options);
  } catch (const InputError& error) {
    require_words(error);
    return std::nullopt;
  }
}

// Empty if the format cannot hold the scene's coordinates.
std::string written(const Scene& scene, const char* name, Encoding encoding) {
  try {
    return scene_files(scene, name, encoding).files.back().bytes;
  } catch (const InputError& error) {
    require_words(error);
    return {};
  }
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

void check(std::string_view bytes, const char* name, const SceneOptions& options) {
  const auto scene = read(bytes, name, options);
  if (!scene) return;
  const std::string broken = broken_promise(*scene);
  if (!broken.empty()) fail(broken);
  (void)scene->open_edge_count();
  for (const char* out : {"s.off", "s.vs3"}) check_written(*scene, out, Encoding::kText);
  for (const char* out : {"s.ply", "s.stl"}) {
    check_written(*scene, out, Encoding::kText);
    check_written(*scene, out, Encoding::kBinary);
  }
}

}  // namespace

void check_scene_file(std::string_view bytes, const char* name) {
  check(bytes, name, {});
  check(bytes, name, {BadFaces::kSkip, PatchMode::kFaces});
}

}  // namespace exactff::validation
