#include "cli/speed_advice.h"

#include <unistd.h>

#include <iostream>
#include <vector>

#include "text/escape.h"
#include "text/nearest_names.h"
#include "text/phrases.h"

namespace exactff::cli {

void LateNote::follow(const Progress& progress) {
  if (!done_before_) done_before_ = progress.done;
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  if (told_ || elapsed.count() < kLate || progress.total <= *done_before_) return;
  const double share_done =
      static_cast<double>(progress.done - *done_before_) / static_cast<double>(progress.total - *done_before_);
  const double left = elapsed.count() * (1.0 - share_done) / share_done;  // infinite as long as nothing is done
  if (left < kLate || (progress.slow.empty() && elapsed.count() < kNameable)) return;
  told_ = true;
  const std::string what = progress.slow.empty() ? "" : "It is slow " + text::printable(progress.slow) + ". ";
  const std::string clear_line = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
  std::cerr << clear_line + "note: this takes more than " + text::short_number(kLate) + " s. " + what + text_ + '\n';
}

std::string words_on_speed(const matrix::Request& request) {
  const ViewFactorOptions& factors = request.options.factors;
  constexpr double kCoarse = 1e-3;
  constexpr double kFine = 1e-9;  // below, certified entries cost less (validation/view_factors.md)
  std::vector<std::string> ways;
  if (factors.certify && factors.accuracy >= kFine) ways.emplace_back("no --certify, so that errors are estimated");
  if (!factors.certify && factors.accuracy < kFine)
    ways.emplace_back("--certify, which needs fewer cells for so little");
  if (factors.both_directions) ways.emplace_back("no --both-directions");
  if (factors.accuracy < kCoarse) {
    ways.push_back("--accuracy " + text::short_number(kCoarse) + " instead of " + text::shortest(factors.accuracy));
  }
  ways.push_back("a smaller --budget than " + std::to_string(factors.budget) + ", for wider entries");
  if (request.options.backs) ways.emplace_back("no --backs");
  if (request.from.size() > 1) {
    ways.push_back("fewer rows than " + std::to_string(request.from.size()) + " by --from");
  }
  return "Faster: " + text::joined(ways, "; ");
}

}  // namespace exactff::cli
