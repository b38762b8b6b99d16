#include "fuzz/shrink.h"

#include <fstream>
#include <functional>
#include <stdexcept>
#include <vector>

#include "fuzz/apart.h"
#include "fuzz/checks.h"
#include "support/case_file.h"
#include "support/minimise.h"

namespace exactff::validation {

using generate::PlainScene;

namespace {

std::string text_of(const Outcome& outcome) {
  switch (outcome.ending) {
    case Ending::kCrash:
      return "crashes";
    case Ending::kHang:
      return "hangs";
    case Ending::kFine:
    case Ending::kProblem:
      break;
  }
  return outcome.problem;
}

// Smaller scenes must fail in the same way: shrinking does not go from a disagreement to a crash, or from a crash to a
// hang.
Shrunk shrunk_by(const PlainScene& scene, Ending ending, const std::function<Outcome(const PlainScene&)>& run) {
  Shrunk out;
  out.scene = minimised(scene, [&](const PlainScene& smaller) { return run(smaller).ending == ending; });
  out.problem = text_of(run(out.scene));
  return out;
}

}  // namespace

std::optional<Shrunk> shrink(const FuzzCase& fuzz_case, unsigned seconds) {
  const auto ask_oracle = [=](const PlainScene& scene) {
    return run_apart([&] { return oracle_problem(scene); }, seconds);
  };
  // If two scenes should agree and do not, one is wrong: the oracle decides which.
  std::vector<PlainScene> suspects{fuzz_case.scene};
  if (run_apart([&] { return changed(fuzz_case) ? "changes" : ""; }, seconds).ending == Ending::kProblem) {
    suspects.push_back(*changed(fuzz_case));
  }
  for (const PlainScene& suspect : suspects) {
    const Ending ending = ask_oracle(suspect).ending;
    if (ending != Ending::kFine) return shrunk_by(suspect, ending, ask_oracle);
  }
  const auto try_identity = [=](const PlainScene& scene) {
    return run_apart([&] { return identity_problem({scene, fuzz_case.identity, fuzz_case.seed}); }, seconds);
  };
  const Ending ending = try_identity(fuzz_case.scene).ending;
  if (ending == Ending::kFine) return std::nullopt;
  Shrunk out = shrunk_by(fuzz_case.scene, ending, try_identity);
  out.alone = false;
  out.identity = fuzz_case.identity;
  return out;
}

std::filesystem::path keep(const Shrunk& shrunk, const std::string& name, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  try {
    std::ofstream(folder / (name + ".obj")) << generate::to_obj(shrunk.scene);
  } catch (
      const std::invalid_argument&) {  // touching rings cannot be converted to keyholes; there is only the case file
  }
  const std::string with = shrunk.alone ? "" : " (only with the identity: " + name_of(shrunk.identity) + ")";
  const std::filesystem::path path = folder / (name + ".json");
  std::ofstream out(path);
  out << to_json(as_case(name, shrunk.scene), "found by fuzzing: " + shrunk.problem + with);
  if (!out.flush()) throw std::runtime_error("cannot write " + path.string());
  return path;
}

}  // namespace exactff::validation
