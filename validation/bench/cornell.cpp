// The Cornell box end to end: the certified value at each receiver of a grid on the floor, with the light as source.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/scenes.h"
#include "exactff/exact.h"
#include "exactff/receiver.h"
#include "exactff/scene_files.h"

namespace exactff::bench {

namespace {

struct Cornell {
  Scene scene = read_obj(EXACTFF_DATA_DIR "/scenes/cornell_box.obj");
  ExactSource light{scene, scene.select("light")};
  std::vector<Receiver> receivers = grid_receivers(scene, scene.select("floor"), {32, 32});
};

const Cornell& cornell() {
  static const Cornell the_box;
  return the_box;
}

void solve(const Receiver& receiver, FormFactor& result) {
  exact_form_factor(cornell().scene, receiver, cornell().light, {}, result);
}

std::vector<Receiver> receivers_with(const std::function<bool(Outcome)>& chosen) {
  std::vector<Receiver> receivers;
  FormFactor result;
  for (const Receiver& receiver : cornell().receivers) {
    solve(receiver, result);
    if (chosen(result.planes.front().outcome)) receivers.push_back(receiver);
  }
  return receivers;
}

double seconds_of(const Receiver& receiver, FormFactor& result) {
  const auto begin = std::chrono::steady_clock::now();
  solve(receiver, result);
  keep(result.value);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// One iteration computes every receiver once; the result is the median time over them.
void median_receiver(benchmark::State& state, const std::vector<Receiver>& receivers) {
  std::vector<double> seconds(receivers.size());
  FormFactor result;
  for (auto _ : state) {
    for (std::size_t i = 0; i < receivers.size(); ++i) seconds[i] = seconds_of(receivers[i], result);
    const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
    std::nth_element(seconds.begin(), middle, seconds.end());
    state.SetIterationTime(*middle);
  }
  state.counters["receivers"] = static_cast<double>(receivers.size());
}

}  // namespace

void add_cornell() {
  using Kind = std::pair<std::string, std::function<bool(Outcome)>>;
  for (const auto& [kind, chosen] : {Kind("unoccluded", [](Outcome o) { return o == Outcome::kUnoccluded; }),
                                     Kind("partly", [](Outcome o) { return o == Outcome::kPartlyHidden; })}) {
    benchmark::RegisterBenchmark(
        ("cornell/" + kind).c_str(),
        [chosen = chosen](benchmark::State& state) { median_receiver(state, receivers_with(chosen)); })
        ->Unit(benchmark::kMicrosecond)
        ->UseManualTime()
        ->Iterations(5);  // each computes every receiver
  }
}

}  // namespace exactff::bench
