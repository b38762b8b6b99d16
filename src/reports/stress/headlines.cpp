#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/float_environment.h"
#include "stress/stress.h"
#include "text/phrases.h"

namespace exactff::stress {

namespace {

using text::counted;
using text::counted_of;

struct Tally {
  std::size_t independent = 0;  // compared with a closed form or a symmetry
  std::size_t agreeing = 0;     // of these
  std::size_t certified = 0;    // compared with the exact method's own enclosure
  int most_bits = 0;
  double smallest = std::numeric_limits<double>::infinity();  // smallest positive form factor with an independent truth
};

Tally tally(const Report& report) {
  Tally t;
  for (const FamilyResult& family : report.families) {
    const bool independent = family.family.evidence != Evidence::kCertified;
    for (const Row& row : family.rows) {
      ++(independent ? t.independent : t.certified);
      t.most_bits = std::max(t.most_bits, row.precision_bits);
      if (!independent) continue;
      t.agreeing += row.agrees ? 1U : 0U;
      const double value = row.of(Method::kExact).value;
      if (value > 0.0) t.smallest = std::min(t.smallest, value);
    }
  }
  return t;
}

std::string exact_sentence(const Report& report) {
  const Tally t = tally(report);
  std::string text;
  if (t.independent > 0) {
    text = "The exact value agrees with an independent closed form or symmetry, rounded to a double, in " +
           counted_of(t.agreeing, t.independent, "scene");
    if (std::isfinite(t.smallest)) text += ", down to a form factor of " + text::rounded(t.smallest, 2);
    text += t.certified > 0 ? "; " : ". ";
  }
  if (t.certified > 0) {
    text += (text.empty() ? "In " : "in ") + counted(t.certified, "scene") +
            " no independent value exists; there it is compared with its own enclosure at higher precision. ";
  }
  if (t.most_bits > 0) text += "The proof needed at most " + std::to_string(t.most_bits) + " bits.";
  return text;
}

bool to_the_end(const FamilyResult& family, Method method, double threshold) {
  return usable_up_to(family, method, threshold) == family.rows.back().stiffness;
}

std::size_t families_kept(const Report& report, Method method, double threshold) {
  return static_cast<std::size_t>(
      std::count_if(report.families.begin(), report.families.end(),
                    [&](const FamilyResult& family) { return to_the_end(family, method, threshold); }));
}

std::size_t refusals(const Report& report, Method method) {
  std::size_t count = 0;
  for (const FamilyResult& family : report.families) {
    count += static_cast<std::size_t>(
        std::count_if(family.rows.begin(), family.rows.end(), [&](const Row& row) { return row.of(method).refused; }));
  }
  return count;
}

std::string thresholds_kept(const Report& report, Method method) {
  return " keeps its error below 10⁻³ to the end in " + std::to_string(families_kept(report, method, kThresholds[0])) +
         " of " + counted(report.families.size(), "family", "families") + ", below 10⁻⁶ in " +
         std::to_string(families_kept(report, method, kThresholds[1])) + " and below 10⁻¹² in " +
         std::to_string(families_kept(report, method, kThresholds[2]));
}

std::string tolerance_kept(const Report& report, Method method) {
  const auto kept = std::count_if(report.families.begin(), report.families.end(), [&](const FamilyResult& family) {
    return kept_up_to(family, method) == family.rows.back().stiffness;
  });
  return " keeps the tolerance that it was given (" + text::rounded(kToleranceShare) +
         " of the unoccluded form factor) to the end in " + std::to_string(kept) + " of " +
         counted(report.families.size(), "family", "families");
}

std::string method_sentence(const Report& report, Method method) {
  std::string text = std::string(name_of(method)) +
                     (has_tolerance(method) ? tolerance_kept(report, method) : thresholds_kept(report, method));
  if (const std::size_t refused = refusals(report, method); refused > 0) {
    text += "; it refuses " + counted(refused, "scene") + " because single precision would merge corners";
  }
  return text + '.';
}

}  // namespace

std::vector<std::string> headlines(const Report& report) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<std::string> sentences = {exact_sentence(report)};
  for (Method method : kMethods) {
    if (method != Method::kExact) sentences.push_back(method_sentence(report, method));
  }
  return sentences;
}

}  // namespace exactff::stress
