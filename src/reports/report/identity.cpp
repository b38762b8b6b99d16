#include "report/identity.h"

#include <fstream>

#include "exactff/version.h"
#include "files/file.h"
#include "page/output_folder.h"
#include "text/hashes.h"

namespace exactff::report {
namespace {

class Identity {
 public:
  void add(const std::string& text) {
    hash_.add(std::uint64_t{text.size()});
    hash_.add_bytes(text);
  }
  void add(std::uint64_t number) { hash_.add(number); }
  void add(double number) { hash_.add(number); }
  template <class Item>
  void add(const std::vector<Item>& list) {
    hash_.add(std::uint64_t{list.size()});
    for (const Item& item : list) add(item);
  }
  void add(int number) { hash_.add(static_cast<std::uint64_t>(number)); }
  void add(SamplePattern pattern) { hash_.add(static_cast<std::uint64_t>(pattern)); }
  void add(Variant variant) { hash_.add(static_cast<std::uint64_t>(variant)); }
  void add(FaceId face) { hash_.add(std::uint64_t{index_of(face)}); }
  void add(const LeftOut& item) {
    add(item.what);
    add(item.why);
  }
  void add(const Receiver& receiver) {
    hash_.add(receiver.point);
    hash_.add(receiver.normal);
    add(receiver.on);
    add(receiver.id);
  }
  void add(const study::Ladder& ladder) {
    add(ladder.name);
    add(ladder.along);
    for (const methods::Choice& rung : ladder.rungs) {
      add(rung.method->name);
      add(rung.settings.text());
    }
  }

  void add(const PlannedScene& scene) {
    add(scene.name);
    add(scene.title);
    add(scene.scene->hash());
    const study::Request& request = scene.request;
    add(request.scene_name);
    add(request.receivers_name);
    add(request.receivers);
    for (const Selection& source : request.sources) add(scene.scene->name_of(source));
    add(request.sweeps);
    add(request.methods);
    add(request.sweep_budget);
    add(request.seconds_for_a_time);
    if (request.camera) add(*request.camera);  // without one, reports keep the identity that earlier builds gave them
    if (request.up) hash_.add(*request.up);    // likewise
  }

  [[nodiscard]] std::string digits() const { return hash_.digits(); }

 private:
  void add(const study::Sweeps& sweeps) {
    add(std::uint64_t{sweeps.enabled});
    add(sweeps.eps_b);
    add(sweeps.eps_a);
    add(sweeps.rays);
    add(sweeps.seeds);
    add(sweeps.patterns);
    add(sweeps.variants);
  }
  void add(const render::Camera& camera) {
    for (const Vec3& v : {camera.eye, camera.look, camera.up}) hash_.add(v);
    add(camera.fov);
  }
  void add(const study::MethodSweep& methods) {
    add(std::uint64_t{methods.enabled});
    add(methods.ladders);
    add(std::uint64_t{methods.seeds});
    add(std::uint64_t{methods.receivers});
    add(methods.budget);
  }

  text::Fnv1a hash_;
};

std::filesystem::path page_in(const std::filesystem::path& folder) { return folder / page::kReportFile; }

}  // namespace

std::string identity_of(const Plan& plan) {
  Identity identity;
  identity.add(std::string(kVersion));
  identity.add(plan.title);
  identity.add(plan.scenes);
  identity.add(plan.experiments);
  identity.add(std::uint64_t{0});  // so that reports keep the identity that earlier builds gave them
  identity.add(plan.left_out);
  identity.add(std::uint64_t{plan.effort.abridged});
  return identity.digits();
}

std::string identity_line(const std::string& identity) { return "<!-- request " + identity + " -->"; }

bool has_report(const std::filesystem::path& folder) { return files::is_there(page_in(folder)); }

Finished finished_report(const Plan& plan, const std::filesystem::path& folder) {
  if (!has_report(folder)) return Finished::kNone;
  const std::string wanted = identity_line(identity_of(plan));
  std::ifstream page(page_in(folder), std::ios::binary);
  for (std::string line; std::getline(page, line);) {
    if (line == wanted) return Finished::kOfThis;
  }
  return Finished::kOfAnother;
}

}  // namespace exactff::report
