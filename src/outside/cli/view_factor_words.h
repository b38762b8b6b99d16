// What the commands that compute view factors do and say alike.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exactff/matrix.h"
#include "flags/scene.h"

namespace exactff::cli {

// With the backs of the patches and faces in `two_sided`. Prints the scene's warnings.
[[nodiscard]] Scene load(const flags::SceneArguments& args, const std::vector<std::string>& two_sided);

// Of fronts of these columns that overlap, if any do: what to do about it. Found by estimates, before anything is
// computed.
[[nodiscard]] std::optional<Problem> problem_of_overlaps(const Scene& scene, std::span<const Selection> columns);

// The flags --claim and --certify, which is short for --claim certified.
struct ClaimOptions {
  CLI::Option *claim = nullptr, *certify = nullptr;
};
ClaimOptions add_claim(CLI::App& command, bool& certify);

// For each reason why entries are wider than the accuracy: the widest of them, and what would help.
[[nodiscard]] std::vector<Problem> problems_of_width(const Scene& scene, const matrix::Matrix& matrix,
                                                     const ViewFactorOptions& options);

inline constexpr const char* kBudgetHelp =
    "Limit of work for an entry: the most cells, where one with many edges counts for several, and the most points";

inline constexpr const char* kTwoSidedHelp =
    "Patches or faces, named as in --from, whose backs are patches as well, NAME (back), with the same Kd and Ke";

}  // namespace exactff::cli
