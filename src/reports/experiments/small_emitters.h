// Karkanis' conclusion: "Clearly the extra cost of the accurate algorithm pays off when the form factor is small. This
// could be important in a radiosity solution, for example when a scene contains small, bright emitters."
//
// A hall with many small bright lamps: the radiosity that all lamps together give receivers on its floor, and the error
// and the time per receiver of every method.
#pragma once

#include "experiments/support.h"

namespace exactff::experiments {

struct EmittersSize {
  int lamps = 256;
  int grid = 16;   // receivers along a side of the floor
  int timed = 12;  // receivers used for timing
  std::vector<std::string> choices = {"hemicube:resolution=100",
                                      "hemicube:resolution=200",
                                      "hemicube:resolution=400",
                                      "hemicube:resolution=1024",
                                      "nettle:rays=1",
                                      "nettle:rays=16",
                                      "nettle:rays=256",
                                      "area-sampling:samples=1",
                                      "area-sampling:samples=4,pattern=stratified",
                                      "area-sampling:samples=16,pattern=stratified",
                                      "area-sampling:samples=64,pattern=stratified",
                                      "area-sampling:samples=256,pattern=stratified",
                                      "area-sampling:samples=1024,pattern=stratified",
                                      "area-sampling:samples=4096,pattern=stratified",
                                      "adaptive:eps_B=0.01",
                                      "adaptive:eps_B=0.001",
                                      "adaptive:eps_B=0.0001",
                                      "adaptive:eps_B=0.00001",
                                      "adaptive:eps_B=0.000001"};
};

// Radiosity errors divided by the mean exact radiosity.
struct EmitterErrors {
  std::string choice;
  double rms = 0.0;
  double worst = 0.0;
  std::vector<double> radiosity;  // indexed by receiver
};

struct EmitterStudy {
  std::vector<Receiver> receivers;
  std::vector<double> exact;  // radiosity, indexed by receiver
  double mean = 0.0;
  std::vector<EmitterErrors> methods;
};
[[nodiscard]] EmitterStudy emitter_study(const EmittersSize& size, int threads, const Hooks& hooks);

[[nodiscard]] Result small_emitters(const EmittersSize& size, int threads, const Hooks& hooks);
[[nodiscard]] Result small_emitters(const Effort& effort, const Hooks& hooks);

}  // namespace exactff::experiments
