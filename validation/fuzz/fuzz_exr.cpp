// Arbitrary bytes as an OpenEXR file with visible points of a fixed small scene. The result is either an InputError
// with a message, or numbers: of all channels, and receivers in pixels of their own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "exactff/exr.h"
#include "fuzz/complaints.h"
#include "generate/plain_scene.h"

namespace exactff::validation {
namespace {

// A light above a floor.
Scene floor_and_light() {
  generate::PlainScene plain;
  plain.add_ring(plain.patch("light"), {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
  plain.add_ring(plain.patch("floor"), {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  return generate::build(plain);
}

void check(const exr::GBuffer& gbuffer) {
  const auto& [data, display, marks, at] = gbuffer.frame;
  if (marks.size() != data.pixels()) fail("a pixel without a mark");
  if (at.size() != gbuffer.receivers.size()) fail("a receiver without a pixel");
  if (!std::ranges::is_sorted(at) || std::ranges::adjacent_find(at) != at.end()) fail("two receivers in one pixel");
  for (const Receiver& receiver : gbuffer.receivers) {
    if (!std::isfinite(receiver.point.x + receiver.point.y + receiver.point.z)) fail("a point that is not finite");
    if (receiver.normal == Vec3{}) fail("a receiver without a normal");
  }
}

void check(const exr::ExrFile& file) {
  static const Scene scene = floor_and_light();
  for (const exr::Channel& channel : file.channels()) {
    unless_refused([&] {
      if (file.read({&channel, 1}).front().size() != file.data_window(channel).pixels()) fail("not a number a pixel");
    });
    unless_refused([&] { (void)file.find(channel.name, "--flag"); });
  }
  unless_refused([&] {
    exr::GBuffer gbuffer = exr::read_gbuffer(file);
    check(gbuffer);
    exr::place_on_faces(scene, gbuffer);
    check(gbuffer);
    (void)exr::FrameValues(gbuffer.frame).exr({"key: value"});
  });
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff;
  using namespace exactff::validation;
  unless_refused([&] { check(exr::ExrFile(std::string(reinterpret_cast<const char*>(data), size), "a.exr")); });
  return 0;
}
