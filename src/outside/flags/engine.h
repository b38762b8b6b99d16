// The flag --engine, shared by all commands that compute exact values.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "exactff/exact.h"

namespace exactff::flags {

struct EngineArgument {
  std::string name = "edges";

  void add_to(CLI::App& app) {
    app.add_option("--engine", name,
                   "How the visible region is found: edges (fast), boolean (Boolean set operations, the reference) or "
                   "both (run both and compare); it does not affect the values")
        ->capture_default_str()
        ->check(CLI::IsMember({"edges", "boolean", "both"}));
  }
  [[nodiscard]] Engine engine() const {
    return name == "both" ? Engine::kBoth : name == "boolean" ? Engine::kBoolean : Engine::kEdges;
  }
};

}  // namespace exactff::flags
