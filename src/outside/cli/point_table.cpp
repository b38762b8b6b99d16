// The table of `exactff point --source all`: what the receiver sees of every patch, and what is missing to 1.
#include <iostream>

#include "cli/output.h"
#include "cli/point.h"
#include "cli/text_table.h"
#include "text/phrases.h"

namespace exactff::cli {

using text::shortest;

Enclosure missing_to_one(const Enclosure& sum) {
  Enclosure missing = Enclosure::of(1.0);
  missing -= sum;
  return missing;
}

namespace {

std::string between(const Enclosure& sum) {
  return "between " + shortest(sum.lower()) + " and " + shortest(sum.upper());
}

// What 1 less the sum is.
std::string missing_meaning(const Scene& scene, const PointResult& point) {
  if (point.stacked) {
    return "patches lie in one plane over each other, and each counts fully; exactff view has the shares of what is "
           "seen";
  }
  if (!scene.transparent().empty()) return "transparent patches count fully, and so does what is seen through them";
  return "the share that reaches no patch's front: it leaves the scene or meets the back of a face";
}

std::string missing_words(const Enclosure& missing, const std::string& meaning, int digits) {
  const double low = missing.lower(), high = missing.upper();
  if (low <= 0.0 && high >= 0.0) {
    const double most = std::max(-low, high);
    return most == 0.0 ? "0 (exactly)" : "0, to within " + text::short_number(most, 2);
  }
  const std::string number = sum_text(missing, digits).value_or(between(missing));
  return number + "  (" + (high < 0.0 ? "the sum exceeds 1: " : "") + meaning + ')';
}

}  // namespace

void print_patch_table(const PointArguments& args, const Scene& scene, const PointResult& point) {
  const bool visible = args.fraction || args.exact_fraction;
  TextTable table;
  table.add_column("patch");
  table.add_column("form factor");
  table.add_column("status");
  if (visible) table.add_column("visible");
  if (args.adaptive) table.add_column("ray-sampled adaptive");
  table.add_column("emits");
  for (const PointTerm& one : point.sources) {
    std::vector<std::string> cells = {scene.name_of(one.source), value_text(one.exact, args.digits),
                                      std::string(to_string(one.exact.status))};
    if (visible) cells.push_back(shortest(one.exact.visible_fraction.value_or(0.0)));
    if (args.adaptive) cells.push_back(shortest(one.adaptive->form_factor));
    cells.emplace_back(one.emits ? "yes" : "-");
    table.add_row(std::move(cells));
  }
  table.print(std::cout);
  std::cout << "\nsum           " << sum_text(point.sum, args.digits).value_or(between(point.sum)) << "  (of "
            << text::counted(point.sources.size(), "patch", "patches") << ", added as balls)\nmissing to 1  "
            << missing_words(missing_to_one(point.sum), missing_meaning(scene, point), args.digits) << '\n';
  if (point.is_mixed()) {
    std::cout << "emitters      "
              << sum_text(point.sum_of_emitters, args.digits).value_or(between(point.sum_of_emitters))
              << "  (the sum over the " << text::counted(point.emitters, "patch", "patches")
              << (point.emitters == 1 ? " that emits)\n" : " that emit)\n");
  }
}

}  // namespace exactff::cli
