#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "kernel/float_environment.h"
#include "report/plan.h"
#include "report/studies.h"
#include "report/verdicts.h"
#include "study/ladders.h"
#include "study/settings.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

std::size_t sight_count(const Study& study, Sight sight) {
  return study.receivers_by_sight[static_cast<std::size_t>(sight)];
}

std::string exact_sentence(const Study& study) {
  const auto certified = static_cast<std::size_t>(
      std::count_if(study.exact.begin(), study.exact.end(), [](const ExactRow& row) { return row.certified; }));
  const std::size_t all = study.exact.size();
  std::string text = "The exact form factor takes " + text::duration(exact_seconds(study)) + " per receiver";
  if (sight_count(study, Sight::kPartly) > 0) {
    text += ", " + text::duration(study.exact_time.mean_partly) + " where the source is partly hidden";
  }
  return text + ", and is certified to the last bit at " + text::counted_of(certified, all, "receiver") + ".";
}

std::string base_sentence(const Study& study) {
  const Summary& base = study.summaries[study.base];
  const double eps_b = study.settings[study.base].eps_b;
  const double seconds = study.times[study.base].mean;
  std::string text = "Ray sampling at the base setting (" + study::setting_name(study, study.base) + ") takes " +
                     text::duration(seconds) + " per receiver, " + text::rounded(seconds / exact_seconds(study), 2) +
                     " times as long as the exact method,";
  if (base.violations == 0) return text + " and keeps its tolerance at every receiver.";
  text += " and misses its tolerance at " + text::share(base.violations, study.exact.size()) + " of the receivers (" +
          std::to_string(base.violations) + ")";
  if (eps_b > 0.0)
    text += "; its worst error is " + text::rounded(base.radiosity.worst / eps_b, 2) + " times the tolerance";
  return text + ".";
}

// "lowers the RMS error by a factor of 3".
std::string change_words(double before, double after) {
  const std::string factor = text::rounded(std::max(before / after, after / before), 2);
  if (factor == "1") return "hardly changes the RMS error";
  return std::string(after < before ? "lowers" : "raises") + " the RMS error by a factor of " + factor;
}

// What a smaller eps_B alone achieves.
std::string tolerance_sentence(const Study& study) {
  const std::vector<std::size_t> line = study::line_through(study.settings, study.base, "eps_B");
  const auto smaller = [&](std::size_t a, std::size_t b) { return study.settings[a].eps_b < study.settings[b].eps_b; };
  const auto [low, high] = std::minmax_element(line.begin(), line.end(), smaller);
  const double low_eps = study.settings[*low].eps_b, high_eps = study.settings[*high].eps_b;
  const double low_rms = study.summaries[*low].radiosity.rms, high_rms = study.summaries[*high].radiosity.rms;
  if (!(low_eps > 0.0) || low_eps == high_eps || !(low_rms > 0.0) || !(high_rms > 0.0)) return {};
  return "Lowering ε_B by a factor of " + text::rounded(high_eps / low_eps) + ", from " + text::rounded(high_eps) +
         " to " + text::rounded(low_eps) + ", " + change_words(high_rms, low_rms) +
         "; the share of receivers off by more than ε_B goes from " +
         text::share(study.summaries[*high].violations, study.exact.size()) + " to " +
         text::share(study.summaries[*low].violations, study.exact.size()) + ".";
}

std::string seeds_sentence(const Study& study) {
  const std::vector<std::size_t> line = study::line_through(study.settings, study.base, "seed");
  if (line.size() < 2) return {};
  std::vector<double> rms;
  for (std::size_t k : line) rms.push_back(study.summaries[k].radiosity.rms);
  const auto [low, high] = std::minmax_element(rms.begin(), rms.end());
  return "Over " + std::to_string(line.size()) +
         " seeds, the RMS error of the base setting over all receivers ranges from " + text::rounded(*low) + " to " +
         text::rounded(*high) + ".";
}

std::string violations_sentence(const Study& study) {
  const auto broken = static_cast<std::size_t>(std::count_if(
      study.summaries.begin(), study.summaries.end(), [](const Summary& summary) { return summary.violations > 0; }));
  if (study.settings.size() < 2) return {};
  if (broken == 0)
    return "None of the " + std::to_string(study.settings.size()) +
           " settings broke its own tolerance at any receiver.";
  return std::to_string(broken) + " of the " + std::to_string(study.settings.size()) +
         " settings broke their own tolerance at one or more receivers.";
}

// The base setting in the other variant, if the variant makes a difference.
std::string variant_sentence(const Study& study) {
  AdaptiveOptions literal = study.settings[study.base];
  if (literal.variant == Variant::kLiteral) return {};
  literal.variant = Variant::kLiteral;
  const auto found = study::find_setting(study.settings, literal);
  if (!found) return {};
  const double mended = study.summaries[study.base].radiosity.rms, printed = study.summaries[*found].radiosity.rms;
  if (!(printed > 1.1 * mended)) return {};
  std::string text =
      "The literal variant, which follows the published listing exactly, has an RMS error of " + text::rounded(printed);
  if (mended > 0.0) text += ", " + text::rounded(printed / mended, 2) + " times that of the mended variant";
  return text + ".";
}

std::string silent_sentence(const Study& study) {
  std::uint64_t sampled = 0, silent = 0, wrong = 0;
  const auto reason = [](LeafReason r) { return static_cast<std::size_t>(r); };
  for (const std::size_t i : study.judged) {
    const SampleRow& row = study.samples[study.base][i];
    sampled += row.leaves_by_reason[reason(LeafReason::kSampledVisible)] +
               row.leaves_by_reason[reason(LeafReason::kSampledHidden)];
    silent += row.silent_leaves;
    wrong += row.wrong_leaves;
  }
  if (sampled == 0) return {};
  return "At the base setting, all rays of " + text::counted(sampled, "leaf", "leaves") + " agreed. " +
         text::share(silent, sampled) +
         " of these leaves were in fact partly visible, an error that the algorithm cannot detect" +
         (wrong > 0 ? ", and " + std::to_string(wrong) + " were the opposite of what the rays showed." : ".");
}

std::string no_work_sentence(const Study& study) {
  if (sight_count(study, Sight::kPartly) > 0) return {};
  if (sight_count(study, Sight::kNothing) == study.exact.size())
    return "Every form factor is 0, because the source and every receiver face away from each other.";
  return "No receiver sees the source partly hidden, so sampling has almost nothing to decide in this scene.";
}

std::vector<std::string> sweep_sentences(const Study& study) {
  if (study.settings.empty()) return {};
  return {base_sentence(study),       tolerance_sentence(study), seeds_sentence(study),
          violations_sentence(study), variant_sentence(study),   silent_sentence(study)};
}

// "RMS error 0.3 % of the brightest receiver, worst 1.2 %; 12 µs per receiver, 3.4 times as long as the exact method".
std::string cell_words(const Study& study, const MethodCell& cell) {
  const double brightest = study::largest_radiosity(study);
  const auto size_of = [&](double error) {
    return brightest > 0.0 ? text::rounded(100.0 * error / brightest, 2) + " %" : text::rounded(error, 2);
  };
  std::string text = "RMS error " + size_of(cell.error.rms) +
                     (brightest > 0.0 ? " of the radiosity of the brightest receiver" : "") + ", worst " +
                     size_of(cell.error.worst);
  if (std::isnan(cell.seconds)) return text;
  text += "; " + text::duration(cell.seconds) + " per receiver";
  const MethodCell* exact = exact_cell(study);
  if (exact == nullptr || !(exact->seconds > 0.0)) return text;
  return text + ", " + text::rounded(cell.seconds / exact->seconds, 2) + " times as long as the exact method";
}

// A sentence on each method that is compared: its first and its last setting.
std::vector<std::string> named_method_sentences(const Study& study) {
  std::vector<std::string> sentences;
  const std::string at = " (at " + text::counted(study.methods.receivers.size(), "receiver") + ")";
  for (std::size_t l = 0; l < study.methods.ladders.size(); ++l) {
    const MethodCell *first = nullptr, *last = nullptr;
    for (const MethodCell& cell : study.methods.cells) {
      if (cell.ladder != l || is_exact(study, cell)) continue;
      if (first == nullptr) first = &cell;
      last = &cell;
    }
    if (first == nullptr) continue;
    sentences.push_back(cell_name(study, *first) + ": " + cell_words(study, *first) + at + ".");
    if (last != first) sentences.push_back(cell_name(study, *last) + ": " + cell_words(study, *last) + at + ".");
  }
  for (const LeftOut& item : study.left_out) {
    if (item.what.starts_with("method ")) sentences.push_back("Left out: " + item.what + ", because " + item.why + ".");
  }
  return sentences;
}

}  // namespace

std::vector<std::string> sweep_findings(const Study& study) {
  if (study.settings.empty()) return {};
  std::vector<std::string> sentences = {seeds_sentence(study), violations_sentence(study), variant_sentence(study),
                                        silent_sentence(study), no_work_sentence(study)};
  std::erase(sentences, "");
  return sentences;
}

std::vector<std::string> headlines(const Study& study) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<std::string> sentences = {exact_sentence(study)};
  std::ranges::move(study.settings.empty() ? named_method_sentences(study) : sweep_sentences(study),
                    std::back_inserter(sentences));
  sentences.push_back(no_work_sentence(study));
  std::erase(sentences, "");
  return sentences;
}

}  // namespace exactff::report
