#include "experiments/closure.h"

#include <algorithm>
#include <cmath>

#include "exactff/models.h"
#include "files/parallel.h"
#include "study/statistics.h"
#include "text/phrases.h"

namespace exactff::experiments {

namespace {

using text::counted;
using text::rounded;

constexpr std::string_view kClosureStage = "closure";

std::vector<Selection> all_patches(const Scene& scene) {
  std::vector<Selection> patches;
  for (std::uint32_t i = 0; i < scene.patches().size(); ++i) patches.push_back({PatchId{i}, std::nullopt});
  return patches;
}

// Receivers lie on walls and ceiling, which no box touches. A receiver on the floor might lie inside a box, whose back
// sides emit nothing.
std::vector<Receiver> receivers_in(const Scene& scene, std::uint64_t count) {
  std::vector<FaceId> faces;
  for (const char* name : {"wall_left", "wall_right", "wall_back", "wall_front", "ceiling"}) {
    const std::vector<FaceId> own = scene.faces_of(scene.select(name));
    faces.insert(faces.end(), own.begin(), own.end());
  }
  return sample_receivers(scene, faces, count, 1);
}

struct Truth {
  std::vector<double> values;  // indexed by patch
  Enclosure sum;
};

Truth truth_at(const Scene& scene, const Receiver& receiver, std::span<const ExactSource> patches) {
  Truth truth;
  for (const ExactSource& patch : patches) {
    const FormFactor f = exact_form_factor(scene, receiver, patch);
    truth.values.push_back(f.value);
    truth.sum += f.enclosure;
  }
  return truth;
}

std::vector<Truth> truths_at(const Scene& scene, std::span<const Receiver> receivers,
                             std::span<const Selection> patches, int threads, const Hooks& hooks) {
  const std::vector<ExactSource> sources = exact_sources(scene, patches);
  std::vector<Truth> truths(receivers.size());
  files::parallel_for(receivers.size(), threads, kClosureStage, hooks,
                      [&](std::size_t i) { truths[i] = truth_at(scene, receivers[i], sources); });
  return truths;
}

ClosureErrors errors_of(const std::string& choice, const Scene& scene, std::span<const Receiver> receivers,
                        std::span<const Selection> patches, std::span<const Truth> truths) {
  Bench bench(methods::parse(choice), scene, patches);
  std::vector<double> closures, singles;
  for (std::size_t i = 0; i < receivers.size(); ++i) {
    double sum = 0.0;
    const std::span<const methods::Estimate> estimates = bench.look_from(receivers[i]);
    for (std::size_t p = 0; p < patches.size(); ++p) {
      sum += estimates[p].form_factor;
      singles.push_back(estimates[p].form_factor - truths[i].values[p]);
    }
    closures.push_back(sum - 1.0);
  }
  const study::ErrorStatistics closure = study::error_statistics(closures);
  return {choice, closure.rms, closure.worst, root_mean_square(singles)};
}

std::string exact_sentence(const ClosureStudy& study) {
  return "In a closed room of " + counted(study.patches, "patch", "patches") +
         " the form factors from a point to all patches sum to 1. The exact values do so at " +
         text::counted_of(study.hold_one, study.receivers, "receiver") +
         ": the sum of their balls (proved intervals) contains 1, and its width is at most " +
         rounded(study.widest, 2) + ".";
}

std::string others_sentence() {
  return "The hemicube closes by construction, because its pixels sum to 1 whatever they show. Its closure says "
         "nothing "
         "about the accuracy of its values.";
}

NumberTable error_table(const ClosureStudy& study) {
  NumberTable table{
      "RMS errors of the sum and of a single form factor", {"method", "of the sum", "of a form factor"}, {}};
  for (const ClosureErrors& m : study.methods) {
    table.rows.push_back({methods::parse(m.choice).short_text(), rounded(m.rms, 2), rounded(m.single_rms, 2)});
  }
  return table;
}

CsvFile table_of(const ClosureStudy& study, const ClosureSize& size) {
  TableWriter table(
      "closure in the model " + size.room + ": the sum over " + std::to_string(study.patches) +
          " patches less 1, over " + std::to_string(study.receivers) +
          " receivers, and errors of single form factors\nexact: rms and worst are 0 where the sum of balls "
          "holds 1",
      {"method", "rms", "worst", "single_rms"});
  if (study.hold_one == study.receivers) table.row() << "exact" << 0.0 << 0.0 << 0.0;
  for (const ClosureErrors& m : study.methods) table.row() << m.choice << m.rms << m.worst << m.single_rms;
  return table.finish("closure.csv", "closure error of every method in a closed room");
}

}  // namespace

ClosureStudy closure_study(const ClosureSize& size, int threads, const Hooks& hooks) {
  const Scene scene = models::make_scene(size.room);
  const std::vector<Selection> patches = all_patches(scene);
  const std::vector<Receiver> receivers = receivers_in(scene, size.receivers);
  const std::vector<Truth> truths = truths_at(scene, receivers, patches, threads, hooks);
  ClosureStudy study{.receivers = receivers.size(), .patches = patches.size()};
  for (const Truth& truth : truths) {
    study.hold_one += truth.sum.contains(1.0) ? 1U : 0U;
    study.widest = std::max(study.widest, truth.sum.upper() - truth.sum.lower());
  }
  study.methods.resize(size.choices.size());
  files::parallel_for(size.choices.size(), threads, kClosureStage, hooks, [&](std::size_t i) {
    study.methods[i] = errors_of(size.choices[i], scene, receivers, patches, truths);
  });
  return study;
}

Result closure(const ClosureSize& size, int threads, const Hooks& hooks) {
  const ClosureStudy study = closure_study(size, threads, hooks);
  return {.name = "closure",
          .title = "Closure: all patches of a closed room",
          .paragraphs = {exact_sentence(study), others_sentence()},
          .tables = {error_table(study)},
          .values = {table_of(study, size)}};
}

Result closure(const Effort& effort, const Hooks& hooks) {
  ClosureSize size;
  if (effort.abridged) size.receivers = 12;
  return closure(size, effort.threads, hooks);
}

}  // namespace exactff::experiments
