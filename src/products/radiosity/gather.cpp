#include "radiosity/gather.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "text/hashes.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::radiosity {

Rgb sum_of(const std::vector<Rgb>& radiosities) {
  Rgb sum;
  for (const Rgb& one : radiosities) sum = {sum.r + one.r, sum.g + one.g, sum.b + one.b};
  return sum;
}

std::string hash_of(const Radiosities& radiosities) {
  text::Fnv1a hash;
  for (const auto* list : {&radiosities.value, &radiosities.lower, &radiosities.upper}) {
    for (const Rgb& one : *list) {
      for (const double v : {one.r, one.g, one.b}) hash.add(v);
    }
  }
  return hash.digits();
}

std::string words_of_claim(const Radiosities& radiosities) {
  return "the view factors behind them are " + std::string(to_string(radiosities.claim));
}

Gather::Gather(const Scene& scene, const Radiosities& radiosities, const std::string& scene_name)
    : factors_(scene, radiosities.patches, whole_view::Sky::kLeftOut),
      value_(factors_, radiosities.value),
      lower_(factors_, radiosities.lower),
      upper_(factors_, radiosities.upper) {
  std::optional<Problem> problem = whole_view::problem_of_strength(scene, sum_of(radiosities.upper), scene_name);
  if (problem) throw InputError(std::move(*problem));
}

whole_view::Channels Gather::at(const Receiver& receiver, const whole_view::LightFormula& formula,
                                const ExactOptions& options, GatherBounds bounds,
                                whole_view::Light::Results& results) const {
  whole_view::Channels channels = value_.at(receiver, formula, options, results);
  if (bounds == GatherBounds::kNone) return channels;
  const whole_view::Channels lower = lower_.again(receiver, formula, options, results);
  const whole_view::Channels upper = upper_.again(receiver, formula, options, results);
  for (std::size_t c = 0; c < channels.size(); ++c) {
    channels[c].lower = lower[c].lower;
    channels[c].upper = upper[c].upper;
  }
  return channels;
}

// --- The radiosities of all patches, from a solution or from its file ---

namespace {

void set(Radiosities& all, std::size_t patch, std::size_t channel, const BoundedValue& b) {
  const auto colour = kColours[channel];
  all.value[patch].*colour = b.value;
  all.lower[patch].*colour = b.lower;
  all.upper[patch].*colour = b.upper;
}

Radiosities of_patches(std::vector<Selection> patches) {
  const std::vector<Rgb> none(patches.size());
  return {.patches = std::move(patches), .value = none, .lower = none, .upper = none};
}

[[noreturn]] void refuse_unbounded(const std::string& file, std::size_t channel) {
  text::refuse(file, "there is no bound for " + std::string(kChannelNames[channel]),
               "what is gathered from estimates alone would have no bounds either",
               "lower Kd where it is 1, or compute narrower view factors by --accuracy and --budget");
}

void require_scene(const Scene& scene, const SolutionFile& file) {
  if (scene.hash() == file.scene_hash) return;
  text::refuse(file.file, "holds radiosities of another scene, hash " + file.scene_hash,
               "the scene given has the hash " + scene.hash(),
               "give the scene and the flags that `exactff radiosity` was given");
}

[[noreturn]] void refuse_row(const SolutionFile& file, const std::string& what) {
  text::refuse(file.file, what, "every patch has one radiosity in each channel",
               "use the file as `exactff radiosity` wrote it");
}

// Of a patch of which no more radiosities are wanted.
std::string what_is_wrong_with(const std::string& patch, const std::vector<Selection>& patches, const Scene& scene) {
  const std::string name = text::in_quotes(patch, text::kShownName);
  const auto has_name = [&](const Selection& one) { return scene.name_of(one) == patch; };
  if (std::ranges::any_of(patches, has_name)) return "has a radiosity of " + name + " twice in one channel";
  const auto is_it = [&](const Patch& one) { return one.name == patch; };
  const bool exists = std::ranges::any_of(scene.patches(), is_it);
  return "has a radiosity of " + name + (exists ? ", which has no area" : ", which is no patch of the scene");
}

// The rows of each channel of these patches, in their order.
using RowsOfChannels = std::array<std::vector<const SolutionFile::Row*>, kColours.size()>;

RowsOfChannels rows_of(const Scene& scene, const std::vector<Selection>& patches, const SolutionFile& file) {
  RowsOfChannels rows;
  std::map<std::pair<std::string, std::size_t>, std::size_t> wanted;  // a channel of a patch
  for (std::size_t c = 0; c < rows.size(); ++c) {
    rows[c].resize(patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i) wanted.emplace(std::pair(scene.name_of(patches[i]), c), i);
  }
  for (const SolutionFile::Row& row : file.rows) {
    const auto found = wanted.find({row.patch, row.channel});
    if (found == wanted.end()) refuse_row(file, what_is_wrong_with(row.patch, patches, scene));
    rows[row.channel][found->second] = &row;
    wanted.erase(found);
  }
  if (wanted.empty()) return rows;
  const auto& [patch, channel] = wanted.begin()->first;
  refuse_row(file, "has no radiosity of " + text::in_quotes(patch, text::kShownName) + " in " +
                       std::string(kChannelNames[channel]));
}

}  // namespace

Radiosities radiosities_of(const Solution& solution) {
  const kernel::StandardArithmetic arithmetic;
  Radiosities all = of_patches(solution.patches);
  all.claim = solution.claim;
  for (std::size_t c = 0; c < kColours.size(); ++c) {
    if (!solution.channels[c].is_bounded()) refuse_unbounded({}, c);
    for (std::size_t i = 0; i < all.patches.size(); ++i) set(all, i, c, solution.channels[c].radiosity[i]);
  }
  return all;
}

Radiosities radiosities_of(const Scene& scene, const SolutionFile& file) {
  const kernel::StandardArithmetic arithmetic;
  require_scene(scene, file);
  Radiosities all = of_patches(patches_of(scene));
  all.name = std::filesystem::path(file.file).filename().string();
  all.claim = file.claim;
  const RowsOfChannels rows = rows_of(scene, all.patches, file);
  for (std::size_t c = 0; c < rows.size(); ++c) {
    for (std::size_t i = 0; i < all.patches.size(); ++i) {
      if (std::isinf(rows[c][i]->radiosity.upper)) refuse_unbounded(file.file, c);
      set(all, i, c, rows[c][i]->radiosity);
    }
  }
  return all;
}

Solution solution_of(const Scene& scene, const SolutionFile& file) {
  const kernel::StandardArithmetic arithmetic;
  require_scene(scene, file);
  Solution solution;
  solution.patches = patches_of(scene);
  solution.claim = file.claim;
  solution.wide = file.wide;
  solution.width = file.width;
  const RowsOfChannels rows = rows_of(scene, solution.patches, file);
  for (const SolutionFile::Row* row : rows.front()) solution.areas.push_back(row->area);
  for (std::size_t c = 0; c < rows.size(); ++c) {
    Channel& channel = solution.channels[c];
    for (const SolutionFile::Row* row : rows[c]) {
      channel.radiosity.push_back(row->radiosity);
      channel.irradiance.push_back(row->irradiance);
      channel.variation.push_back(row->variation);
      if (!std::isinf(row->radiosity.upper)) continue;
      channel.no_bound = "the file does not say why";
      channel.remedy = "compute it again to see why";
    }
  }
  return solution;
}

// --- How much radiosity varies over the patches of a solution ---

namespace {

// Values of every patch; 0 where a channel has none.
Radiosities values_of(const Solution& solution) {
  Radiosities all{.patches = solution.patches};
  for (std::size_t i = 0; i < solution.patches.size(); ++i) {
    Rgb& rgb = all.value.emplace_back();
    for (std::size_t c = 0; c < kColours.size(); ++c) {
      const double value = solution.channels[c].radiosity[i].value;
      rgb.*kColours[c] = std::isfinite(value) ? value : 0.0;
    }
  }
  all.lower = all.upper = all.value;
  return all;
}

Rgb largest_difference(const Scene& scene, const Gather& gather, const Selection& patch, const Rgb& value,
                       whole_view::Light::Results& results) {
  Rgb largest;
  for (const FaceId face : scene.faces_of(patch)) {
    const auto formula = whole_view::light_formula(scene, std::span(&face, 1), whole_view::FaceSide::kFront,
                                                   Quantity::kRadiosity, KeMeans::kRadiosity);
    for (const Receiver& receiver : probe_receivers(scene, std::span(&face, 1))) {
      if (buried_under(scene, receiver)) continue;
      const auto channels = gather.at(receiver, formula, {}, GatherBounds::kNone, results);
      for (std::size_t c = 0; c < kColours.size(); ++c) {
        double& most = largest.*kColours[c];
        most = std::max(most, std::abs(channels[c].value - value.*kColours[c]));
      }
    }
  }
  return largest;
}

}  // namespace

void set_variation(const Scene& scene, Solution& solution, int threads, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  const Radiosities values = values_of(solution);
  const std::size_t patches = values.patches.size();
  for (Channel& channel : solution.channels)
    channel.variation.assign(patches, std::numeric_limits<double>::quiet_NaN());
  if (whole_view::problem_of_strength(scene, sum_of(values.value), {})) return;
  const Gather gather(scene, values, {});
  std::vector<Rgb> found(patches);
  files::parallel_for(patches, threads, "patches", hooks, [&](std::size_t i) {
    whole_view::Light::Results results;
    found[i] = largest_difference(scene, gather, values.patches[i], values.value[i], results);
  });
  for (std::size_t c = 0; c < kColours.size(); ++c) {
    Channel& channel = solution.channels[c];
    if (!std::ranges::all_of(channel.radiosity, [](const auto& b) { return std::isfinite(b.value); })) continue;
    for (std::size_t i = 0; i < patches; ++i) channel.variation[i] = found[i].*kColours[c];
  }
}

}  // namespace exactff::radiosity
