#include "report/verdicts.h"

#include <algorithm>
#include <cmath>

#include "study/ladders.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

const Ladder& ladder_of(const Study& study, const MethodCell& cell) { return study.methods.ladders[cell.ladder]; }

bool is_timed(const MethodCell& cell) { return !std::isnan(cell.seconds); }

// What R. Mitchell's and the classical results predict for the RMS error against the number of samples.
struct Expectation {
  double exponent = 0.0;
  const char* words = "";
};

std::optional<Expectation> expectation(const Ladder& ladder, Sight sight) {
  const methods::Choice& choice = ladder.rungs.front();
  if (choice.method->name != "area-sampling") return std::nullopt;
  const std::string& pattern = choice.settings.word("pattern");
  if (pattern == "random") return Expectation{-0.5, "−1/2"};
  if (sight == Sight::kPartly) return Expectation{-0.75, "−3/4 with one shadow edge across the source"};
  return Expectation{-1.0, "−1 where nothing is discontinuous"};
}

std::string signed_text(double value) {
  return (value < 0.0 ? "−" : "") + text::rounded(std::abs(value), std::abs(value) < 0.1 ? 1 : 2);
}

const char* why_shallower(Sight sight) {
  return sight == Sight::kPartly
             ? "a cell of the source contains several shadow edges until the cells are finer than the gaps, so that "
               "samples are no better than random"
             : "the first settings are too coarse to show the slope that theory predicts in the limit";
}

const char* why_steeper(Sight sight) {
  return sight == Sight::kPartly
             ? "the smooth part of the integrand, whose error falls faster, still outweighs the edges"
             : "the sequence exploits the smoothness of the integrand better than one sample per cell does";
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
  for (const MethodCell& cell : study.methods.cells) {
    if (is_exact(study, cell)) return &cell;
  }
  return nullptr;
}

const MethodCell* cell_of_setting(const Study& study, std::size_t setting) {
  for (const MethodCell& cell : study.methods.cells) {
    if (std::ranges::find(cell.settings, setting) != cell.settings.end()) return &cell;
  }
  return nullptr;
}

const MethodCell* cheapest(const Study& study, double wanted, std::optional<std::size_t> ladder) {
  const MethodCell* best = nullptr;
  for (const MethodCell& cell : study.methods.cells) {
    if (ladder ? cell.ladder != *ladder : !is_rival(study, cell)) continue;
    if (!is_timed(cell) || !(relative_error(study, cell) <= wanted)) continue;
    if (best == nullptr || cell.seconds < best->seconds) best = &cell;
  }
  return best;
}

const MethodCell* most_accurate(const Study& study, std::size_t ladder) {
  const MethodCell* best = nullptr;
  for (const MethodCell& cell : study.methods.cells) {
    if (cell.ladder != ladder) continue;
    if (best == nullptr || relative_error(study, cell) < relative_error(study, *best)) best = &cell;
  }
  return best;
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

namespace {

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

}  // namespace

double exact_seconds(const Study& study) {
  const MethodCell* exact = exact_cell(study);
  return exact != nullptr && is_timed(*exact) ? exact->seconds : study.exact_time.mean;
}

const MethodCell* recommended(const Study& study) {
  const MethodCell* best = nullptr;
  for (const MethodCell& cell : study.methods.cells) {
    if (!is_rival(study, cell) || !is_timed(cell) || cell.seconds > exact_seconds(study)) continue;
    if (!std::isfinite(relative_error(study, cell))) continue;
    if (best == nullptr || relative_error(study, cell) < relative_error(study, *best)) best = &cell;
  }
  return best;
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

namespace {

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

}  // namespace

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
  SlopeWords words{signed_text(slope.exponent), {}, {}};
  if (slope.seeds > 1) words.fitted += " (" + signed_text(slope.low) + " to " + signed_text(slope.high) + ")";
  const auto expected = expectation(ladder, sight);
  if (!expected) return words;
  constexpr double kClose = 0.1;
  const double off = slope.exponent - expected->exponent;
  words.theory = expected->words;
  if (std::abs(off) <= std::max(kClose, 0.5 * (slope.high - slope.low))) return words;
  words.reason = off > 0.0 ? "shallower, because " + std::string(why_shallower(sight))
                           : "steeper, because " + std::string(why_steeper(sight));
  return words;
}

}  // namespace exactff::report
