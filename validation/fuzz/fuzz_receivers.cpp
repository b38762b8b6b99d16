// Arbitrary bytes as a CSV file of receivers for a fixed small scene. The result is either an InputError with a
// message, or receivers that the solver can use.
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "exactff/exact.h"
#include "fuzz/complaints.h"
#include "generate/plain_scene.h"
#include "support/program.h"

namespace exactff::validation {
namespace {

// A light, a plate in front of a part of it, and a floor of two faces.
Scene room() {
  generate::PlainScene plain;
  plain.add_ring(plain.patch("source"), {{-1, 1, 2}, {1, 1, 2}, {1, -1, 2}, {-1, -1, 2}});
  plain.add_ring(plain.patch("plate"), {{0, 0, 1}, {2, 0, 1}, {0, 2, 1}});
  plain.add_ring(plain.patch("floor"), {{-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}});
  plain.add_ring(plain.patch("floor"), {{0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}});
  return generate::build(plain);
}

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check(const Scene& scene, const std::vector<Receiver>& receivers) {
  constexpr std::size_t kSolved = 4;
  static const ExactSource source(scene, scene.select("source"));
  std::set<std::string> ids;
  for (const Receiver& receiver : receivers) {
    if (!finite(receiver.point) || !finite(receiver.normal)) fail("a receiver that is not finite");
    if (receiver.normal == Vec3{}) fail("a receiver without a normal");
    if (!receiver.on.empty() && index_of(receiver.on.front()) >= scene.faces().size())
      fail("a receiver on a face that is not there");
    if (receiver.id.empty() || !ids.insert(receiver.id).second) fail("a receiver without an id of its own");
    if (ids.size() > kSolved) continue;
    const FormFactor f = exact_form_factor(scene, receiver, source, {.engine = Engine::kBoth});
    if (!(f.value >= 0.0 && f.value <= 1.0) || f.status == Status::kNotCertified) fail("not a form factor");
  }
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace exactff;
  using namespace exactff::validation;
  static const Scene scene = room();
  static const TemporaryDirectory directory;
  const std::string text(reinterpret_cast<const char*>(data), size);
  unless_refused([&] { check(scene, read_receivers(directory.write("receivers.csv", text), scene)); });
  return 0;
}
