// The flags for receivers, shared by all commands over many receivers: --receivers FILE, or --on NAME with one of
// --grid, --vertices, --centres, --samples.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "flags/scene.h"

namespace exactff::flags {

// The flags as given; empty if a flag was not given.
struct ReceiverArguments {
  std::vector<std::string> on;
  std::string grid;
  bool vertices = false;
  bool centres = false;
  std::string samples;
  std::string sample_seed;
  std::string file;
};

struct ChosenReceivers {
  std::vector<Receiver> receivers;
  std::string description;  // "floor, grid 32x32", "floor, 1000 samples, seed 1", "points.csv"
};

void add_receiver_options(CLI::App& app, ReceiverArguments& args);

// Throws InputError if flags are missing or contradict each other. Needs no scene.
void check_receiver_options(const ReceiverArguments& args);

// Throws InputError if both are to be read from standard input.
void check_standard_input(const SceneArguments& scene, const ReceiverArguments& receivers);

// Checks the flags, too. Throws InputError, also if the named receivers are none.
ChosenReceivers receivers_of(const ReceiverArguments& args, const Scene& scene, GridIds grid_ids = GridIds::kUnique);

// The flags again, each preceded by a blank and quoted for a shell.
std::string command_words(const ReceiverArguments& args);

}  // namespace exactff::flags
