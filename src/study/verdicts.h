// What follows from the runs of the methods: who is cheapest for a wanted error, and what theory says of the slopes.
//
// Errors here are RMS errors over the chosen receivers and seeds, divided by the radiosity of the brightest receiver;
// times are seconds per receiver and all sources in the mean over them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exactff/study.h"

namespace exactff::study {

inline constexpr std::array kWantedErrors = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

[[nodiscard]] double relative_error(const Study& study, const MethodCell& cell);
[[nodiscard]] bool is_exact(const Study& study, const MethodCell& cell);
// Null where the exact method is not among the ladders.
[[nodiscard]] const MethodCell* exact_cell(const Study& study);

// The control, which is handed exact visibilities, is no method that anybody could choose instead.
[[nodiscard]] bool is_rival(const Study& study, const MethodCell& cell);

// The cell with the least time among those that are right to `wanted`; of one ladder, or of all rivals of the exact
// one.
[[nodiscard]] const MethodCell* cheapest(const Study& study, double wanted, std::optional<std::size_t> ladder = {});

// Cells that no other cell is both faster and more accurate than, by rising time; the control left out.
[[nodiscard]] std::vector<const MethodCell*> pareto_front(const Study& study);

// "area sampling, stratified, samples 64".
[[nodiscard]] std::string cell_name(const Study& study, const MethodCell& cell);
// "1e-4" as people write it: "10⁻⁴".
[[nodiscard]] std::string power_of_ten(double value);

// One or two sentences that can be quoted: what the exact value costs, and what the others need to come near it.
[[nodiscard]] std::vector<std::string> method_sentences(const Study& study);

// How many values of each method, and of each variant of the sweeps, are not finite, and how many lie outside [0, 1] by
// more than rounding: a sentence for each where there are any. Values are sums over the sources.
[[nodiscard]] std::vector<std::string> range_sentences(const Study& study);

// A fitted slope in words, with what theory expects where it does.
[[nodiscard]] std::string slope_words(const Slope& slope, const Ladder& ladder, Sight sight);

}  // namespace exactff::study
