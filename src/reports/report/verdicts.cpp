#include <algorithm>
#include <cmath>
#include <iterator>

#include "report/report.h"
#include "study/settings.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

const Ladder& ladder_of(const Study& study, const MethodCell& cell) { return study.methods.ladders[cell.ladder]; }

bool is_timed(const MethodCell& cell) { return !std::isnan(cell.seconds); }

// What R. Mitchell's and the classical results predict for the RMS error against the number of samples; else empty.
std::string expectation(const Ladder& ladder, Sight sight) {
  const methods::Choice& choice = ladder.rungs.front();
  if (choice.method->name != "area-sampling") return {};
  if (choice.settings.word("pattern") == "random") return "−1/2";
  return sight == Sight::kPartly ? "−3/4 with one shadow edge across the source" : "−1 where nothing is discontinuous";
}

std::string signed_text(double value) {
  return (value < 0.0 ? "−" : "") + text::rounded(std::abs(value), std::abs(value) < 0.1 ? 1 : 2);
}

// The eligible cell with the least key; null if there is none.
template <class Eligible, class Key>
const MethodCell* least(const Study& study, const Eligible& eligible, const Key& key) {
  const MethodCell* best = nullptr;
  for (const MethodCell& cell : study.methods.cells) {
    if (eligible(cell) && (best == nullptr || key(cell) < key(*best))) best = &cell;
  }
  return best;
}

// What the exact value costs, and which other method is accurate to the smallest wanted error that any of them reaches.
std::string cost_sentence(const Study& study, const MethodCell& exact) {
  double reached = 0.0, missed = 0.0;
  for (const double wanted : kWantedErrors) {
    (cheapest(study, wanted) != nullptr ? reached : missed) = wanted;
    if (missed > 0.0) break;
  }
  const std::string of = " of the brightest receiver (RMS)";
  const std::string text =
      "On this scene the exact value takes " + text::duration(exact.seconds) + " per receiver on average; ";
  if (reached == 0.0) {
    return text + "no other setting that was run is accurate to " + power_of_ten(kWantedErrors.front()) + of + '.';
  }
  const MethodCell* best = cheapest(study, reached);
  return text + "the fastest other method that is accurate to " + power_of_ten(reached) + of + ", " +
         cell_name(study, *best) + ", takes " + text::rounded(best->seconds / exact.seconds, 2) + " times as long" +
         (missed > 0.0 ? ", and no other setting that was run is accurate to " + power_of_ten(missed) : "") + '.';
}

// Counts values that are not finite or not in [0, 1].
struct RangeCount {
  std::size_t values = 0;
  std::size_t not_finite = 0;
  std::size_t outside = 0;
  double farthest = 0.0;

  void add(double value) {
    ++values;
    if (!std::isfinite(value)) {
      ++not_finite;
      return;
    }
    const double beyond = std::max(-value, value - 1.0);
    if (beyond <= kRoundingOfSums) return;
    ++outside;
    farthest = std::max(farthest, beyond);
  }

  static constexpr double kRoundingOfSums = 1e-12;
};

void add_range_sentences(const std::string& name, const RangeCount& count, std::vector<std::string>& sentences) {
  const auto of = [&](std::size_t part) {
    return std::to_string(part) + " of " + text::counted(count.values, "value") + " of " + name;
  };
  if (count.outside > 0) {
    sentences.push_back(of(count.outside) + (count.outside == 1 ? " lies" : " lie") + " outside [0, 1], by at most " +
                        text::rounded(count.farthest) + "; the cause is the method’s formula, not rounding.");
  }
  if (count.not_finite > 0) {
    sentences.push_back(
        of(count.not_finite) + (count.not_finite == 1 ? " is not a finite number" : " are not finite numbers") +
        "; errors are computed from the other values, and a setting with such a value never counts as accurate.");
  }
}

// --- headlines ---

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

double relative_error(const Study& study, const MethodCell& cell) {
  const double brightest = study::largest_radiosity(study);
  if (cell.error.not_a_number > 0) return INFINITY;  // whatever the other values are
  if (!(brightest > 0.0)) return cell.error.rms == 0.0 ? 0.0 : INFINITY;
  return cell.error.rms / brightest;
}

bool is_exact(const Study& study, const MethodCell& cell) {
  return ladder_of(study, cell).rungs.front().method->name == "exact";
}

bool is_rival(const Study& study, const MethodCell& cell) {
  const std::string& name = ladder_of(study, cell).rungs.front().method->name;
  return name != "exact" && name != "adaptive-exact-visibility";
}

const MethodCell* exact_cell(const Study& study) {
  const auto found = std::ranges::find_if(study.methods.cells, [&](const auto& cell) { return is_exact(study, cell); });
  return found == study.methods.cells.end() ? nullptr : &*found;
}

const MethodCell* cell_of_setting(const Study& study, std::size_t setting) {
  for (const MethodCell& cell : study.methods.cells) {
    if (std::ranges::find(cell.settings, setting) != cell.settings.end()) return &cell;
  }
  return nullptr;
}

const MethodCell* cheapest(const Study& study, double wanted, std::optional<std::size_t> ladder) {
  const auto eligible = [&](const MethodCell& cell) {
    return (ladder ? cell.ladder == *ladder : is_rival(study, cell)) && is_timed(cell) &&
           relative_error(study, cell) <= wanted;
  };
  return least(study, eligible, [](const MethodCell& cell) { return cell.seconds; });
}

const MethodCell* most_accurate(const Study& study, std::size_t ladder) {
  return least(
      study, [&](const MethodCell& cell) { return cell.ladder == ladder; },
      [&](const MethodCell& cell) { return relative_error(study, cell); });
}

std::vector<const MethodCell*> pareto_front(const Study& study) {
  std::vector<const MethodCell*> cells;
  for (const MethodCell& cell : study.methods.cells) {
    if (!is_timed(cell) || !std::isfinite(relative_error(study, cell))) continue;
    if (is_rival(study, cell) || is_exact(study, cell)) cells.push_back(&cell);
  }
  std::stable_sort(cells.begin(), cells.end(),
                   [](const MethodCell* a, const MethodCell* b) { return a->seconds < b->seconds; });
  std::vector<const MethodCell*> front;
  for (const MethodCell* cell : cells) {
    if (front.empty() || relative_error(study, *cell) < relative_error(study, *front.back())) front.push_back(cell);
  }
  return front;
}

std::string cell_name(const Study& study, const MethodCell& cell) {
  return study::rung_name(ladder_of(study, cell), cell.rung);
}

std::string power_of_ten(double value) {
  return "10" + text::superscript(static_cast<int>(std::lround(std::log10(value))));
}

double exact_seconds(const Study& study) {
  const MethodCell* exact = exact_cell(study);
  return exact != nullptr && is_timed(*exact) ? exact->seconds : study.exact_time.mean;
}

const MethodCell* recommended(const Study& study) {
  const auto error = [&](const MethodCell& cell) { return relative_error(study, cell); };
  const auto eligible = [&](const MethodCell& cell) {
    return is_rival(study, cell) && is_timed(cell) && !(cell.seconds > exact_seconds(study)) &&
           std::isfinite(error(cell));
  };
  return least(study, eligible, error);
}

std::string verdict(const Study& study) {
  if (!(study::largest_radiosity(study) > 0.0)) {
    return "Use any method: every form factor of this scene is 0, and all of them find that out.";
  }
  const std::string time = text::duration(exact_seconds(study)) + " per receiver";
  const auto& cells = study.methods.cells;
  if (std::ranges::none_of(cells, [&](const MethodCell& cell) { return is_rival(study, cell) && is_timed(cell); })) {
    return "Use the exact method: it takes " + time + ", and no other method was run that could be compared with it.";
  }
  const MethodCell* other = recommended(study);
  if (other == nullptr) {
    return "Use the exact method whatever error you accept: it takes " + time +
           ", and no setting of another method that was run is as fast.";
  }
  const std::string name = cell_name(study, *other);
  const double percent = 100.0 * other->seconds / exact_seconds(study);
  const std::string faster = percent < 99.5 ? text::rounded(percent, 2) + " % of its time" : "the same time";
  constexpr double kRounding = 1e-12;
  if (relative_error(study, *other) < kRounding) {
    return "Use " + name + " in a scene like this, where it errs by rounding alone, in " + faster +
           "; use the exact method (" + time + ") when every digit must be proved.";
  }
  const std::string error = text::rounded(100.0 * relative_error(study, *other), 2) + " %";
  return "Use the exact method (" + time + ") when the RMS error must stay below " + error +
         " of the brightest receiver; when " + error + " will do, use " + name + ", in " + faster + ".";
}

std::vector<std::string> method_sentences(const Study& study) {
  const MethodCell* exact = exact_cell(study);
  if (exact == nullptr || !is_timed(*exact) || study.methods.cells.size() < 2) return {};
  return {cost_sentence(study, *exact), verdict(study)};
}

std::string drift_warning(const Study& study) {
  constexpr double kMuch = 1.25;
  if (!(study.exact_slowest > kMuch * study.exact_fastest)) return {};
  return "The machine’s speed drifted while times were measured: the exact method took from " +
         text::rounded(study.exact_fastest, 2) + " to " + text::rounded(study.exact_slowest, 2) +
         " times its median time. Every setting was measured in turn with the exact method, so ratios of times hold "
         "better than seconds do; for reliable times, run it again on an idle machine.";
}

std::vector<std::string> receiver_warnings(const Study& study) {
  const std::vector<Receiver>& receivers = study.request.receivers;
  return sentences(near_misses(*study.request.scene, receivers), receivers.size());
}

std::vector<std::string> range_sentences(const Study& study) {
  std::vector<RangeCount> of_ladder(study.methods.ladders.size());
  for (const MethodCell& cell : study.methods.cells) {
    for (const std::vector<double>& of_seed : cell.values) {
      for (const double value : of_seed) of_ladder[cell.ladder].add(value);
    }
  }
  std::array<RangeCount, 2> of_variant;
  for (std::size_t k = 0; k < study.samples.size(); ++k) {
    const auto variant = static_cast<std::size_t>(study.settings[k].variant == Variant::kLiteral);
    for (const SampleRow& row : study.samples[k]) of_variant[variant].add(row.form_factor);
  }
  std::vector<std::string> sentences;
  for (const Variant variant : {Variant::kMended, Variant::kLiteral}) {
    const auto place = static_cast<std::size_t>(variant == Variant::kLiteral);
    add_range_sentences("the ray-sampled algorithm (" + std::string(to_string(variant)) + " variant)",
                        of_variant[place], sentences);
  }
  for (std::size_t l = 0; l < of_ladder.size(); ++l) {
    if (study.methods.ladders[l].only_of_sweeps) continue;  // told already
    add_range_sentences(study.methods.ladders[l].name, of_ladder[l], sentences);
  }
  return sentences;
}

SlopeWords slope_words(const Slope& slope, const Ladder& ladder, Sight sight) {
  SlopeWords words{signed_text(slope.exponent), expectation(ladder, sight)};
  if (slope.seeds > 1) words.fitted += " (" + signed_text(slope.low) + " to " + signed_text(slope.high) + ")";
  return words;
}

std::vector<std::string> sweep_findings(const Study& study) {
  if (study.settings.empty()) return {};
  std::vector<std::string> sentences = {seeds_sentence(study), violations_sentence(study), variant_sentence(study),
                                        silent_sentence(study), no_work_sentence(study)};
  std::erase(sentences, "");
  return sentences;
}

std::vector<std::string> headlines(const Study& study) {
  std::vector<std::string> sentences = {exact_sentence(study)};
  std::ranges::move(study.settings.empty() ? named_method_sentences(study) : sweep_sentences(study),
                    std::back_inserter(sentences));
  sentences.push_back(no_work_sentence(study));
  std::erase(sentences, "");
  return sentences;
}

}  // namespace exactff::report
