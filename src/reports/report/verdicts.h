// Conclusions from the runs of the methods: which is cheapest for a wanted error, and what theory predicts for the
// slopes.
//
// All conclusions are drawn from the same runs, MethodStudy::cells, by the same two numbers: the RMS error over the
// chosen receivers and seeds, divided by the radiosity of the brightest receiver, and the time per receiver for all
// sources, averaged over the chosen receivers.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "report/report.h"

namespace exactff::report {

inline constexpr std::array kWantedErrors = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

[[nodiscard]] double relative_error(const Study& study, const MethodCell& cell);
[[nodiscard]] bool is_exact(const Study& study, const MethodCell& cell);
// Null if the exact method is not among the ladders.
[[nodiscard]] const MethodCell* exact_cell(const Study& study);
// That of a setting of the sweeps; null if it was not run at the chosen receivers.
[[nodiscard]] const MethodCell* cell_of_setting(const Study& study, std::size_t setting);

// False for the control, which is given the exact visibilities and so is not a method that anybody could use instead.
[[nodiscard]] bool is_rival(const Study& study, const MethodCell& cell);

// The fastest cell among those with an error of at most `wanted`: of one ladder, or of all rivals of the exact method.
[[nodiscard]] const MethodCell* cheapest(const Study& study, double wanted, std::optional<std::size_t> ladder = {});

// The cell of the ladder with the smallest error; null if none was run.
[[nodiscard]] const MethodCell* most_accurate(const Study& study, std::size_t ladder);

// The cells that no other cell beats in both time and accuracy, by increasing time. Without the control.
[[nodiscard]] std::vector<const MethodCell*> pareto_front(const Study& study);

// "area sampling, stratified, samples 64".
[[nodiscard]] std::string cell_name(const Study& study, const MethodCell& cell);
// "1e-4" in typeset form: "10⁻⁴".
[[nodiscard]] std::string power_of_ten(double value);

// The time of an exact value that a chapter states.
[[nodiscard]] double exact_seconds(const Study& study);

// The rival that a verdict recommends where its error will do: the most accurate of those that are at least as fast as
// the exact method. Null if there is none.
[[nodiscard]] const MethodCell* recommended(const Study& study);

// The main result in a few sentences.
[[nodiscard]] std::vector<std::string> headlines(const Study& study);

// One sentence that says when to use the exact method and when another one.
[[nodiscard]] std::string verdict(const Study& study);

// What the runs of Tampieri's algorithm over its settings show, in sentences; empty without such runs.
[[nodiscard]] std::vector<std::string> sweep_findings(const Study& study);

// Sentences that can be quoted: what other methods need for a similar accuracy, and the verdict; empty without others.
[[nodiscard]] std::vector<std::string> method_sentences(const Study& study);

// Says that the machine's speed drifted while times were measured; empty if it did not.
[[nodiscard]] std::string drift_warning(const Study& study);

// For each method, and each variant of the sweeps: how many values are not finite, and how many lie outside [0, 1] by
// more than rounding. One sentence for each that has any. Values are sums over the sources.
[[nodiscard]] std::vector<std::string> range_sentences(const Study& study);

// Receivers that were probably meant to lie on a face (near_misses), in sentences.
[[nodiscard]] std::vector<std::string> receiver_warnings(const Study& study);

// A fitted slope: "−0.75 (−0.8 to −0.7)"; the slope that theory expects, if it expects one: "−3/4 with one shadow edge
// across the source"; and, if they differ, the reason.
struct SlopeWords {
  std::string fitted, theory, reason;
};
[[nodiscard]] SlopeWords slope_words(const Slope& slope, const Ladder& ladder, Sight sight);

}  // namespace exactff::report
