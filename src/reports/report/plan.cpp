// What a report covers, and how it is carried out.
#include "report/plan.h"

#include <algorithm>
#include <cctype>

#include "experiments/experiment.h"
#include "files/parallel.h"
#include "kernel/float_environment.h"
#include "page/chapter.h"
#include "report/identity.h"
#include "report/report.h"
#include "report/verdicts.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::report {
namespace {

// Lower-case letters, digits and hyphens. A number is appended if two names would be the same.
std::string file_word(const std::string& title, const std::vector<PlannedScene>& others) {
  std::string word;
  for (const char c : title) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 && static_cast<unsigned char>(c) < 128;
    if (plain) word += static_cast<char>(std::tolower(c));
    if (!plain && !word.empty() && word.back() != '-') word += '-';
  }
  while (!word.empty() && word.back() == '-') word.pop_back();
  if (word.empty()) word = "scene";
  const auto taken = [&](const std::string& name) {
    return std::any_of(others.begin(), others.end(), [&](const PlannedScene& scene) { return scene.name == name; });
  };
  if (!taken(word)) return word;
  for (int k = 2;; ++k) {
    const std::string numbered = word + '-' + std::to_string(k);
    if (!taken(numbered)) return numbered;
  }
}

page::Chapter run_experiment(const experiments::Experiment& experiment, const Effort& effort, jobs::Journal& journal,
                             const Hooks& hooks) {
  const std::string key = "experiment/" + std::string(experiment.name) + (effort.abridged ? "-abridged" : "");
  if (const auto bytes = journal.find(key)) {
    if (auto chapter = page::chapter_of(*bytes)) return std::move(*chapter);
  }
  const int threads = effort.threads > 0 ? effort.threads : files::usable_threads();
  page::Chapter chapter = experiment.run({effort.abridged, threads}, hooks);
  journal.add(key, page::to_bytes(chapter));
  return chapter;
}

// Progress of a scene's study is shown under the scene's title.
Hooks with_title(const PlannedScene& scene, const Hooks& hooks) {
  if (scene.name.empty() || !hooks.progress) return hooks;
  return {[&](const Progress& progress) {
            const std::string stage = scene.title + ": " + std::string(progress.stage);
            Progress shown = progress;
            shown.stage = stage;
            hooks.progress(shown);
          },
          hooks.cancelled};
}

Outcome outcome_of(const StudyReport& report) {
  Outcome outcome;
  for (const SceneChapter& scene : report.scenes) {
    std::vector<std::string> sentences = method_sentences(scene.study);
    if (report.scenes.size() == 1) std::ranges::move(headlines(scene.study), std::back_inserter(sentences));
    outcome.scenes.push_back({scene.title, std::move(sentences)});
    if (const std::string drift = drift_warning(scene.study); !drift.empty()) {
      outcome.notes.push_back(report.scenes.size() > 1 ? scene.title + ": " + drift : drift);
    }
  }
  return outcome;
}

}  // namespace

std::vector<std::string> experiment_names() {
  std::vector<std::string> names;
  for (const experiments::Experiment& one : experiments::all_experiments()) names.emplace_back(one.name);
  return names;
}

void Plan::add_scene(std::string scene_title, std::shared_ptr<const Scene> scene, study::Request request,
                     std::vector<Problem> warnings) {
  std::string name = file_word(scene_title, scenes);
  scenes.push_back(
      {std::move(name), std::move(scene_title), std::move(scene), std::move(request), std::move(warnings)});
}

void Plan::add_experiments(const std::vector<std::string>& names) {
  const auto add = [&](const std::string& name) {
    if (std::ranges::find(experiments, name) == experiments.end()) experiments.push_back(name);
  };
  for (const std::string& name : names) {
    if (name == "all") {
      for (const experiments::Experiment& one : experiments::all_experiments()) {
        if (!one.by_name_only) add(std::string(one.name));
      }
    } else {
      add(std::string(experiments::experiment_named(name).name));
    }
  }
}

Outcome carry_out(const Plan& plan, const std::filesystem::path& folder, jobs::Journal& journal, const Hooks& hooks) {
  const kernel::StandardArithmetic arithmetic;
  if (plan.scenes.empty() && plan.experiments.empty()) {
    text::refuse(
        plan.left_out.empty() ? "the report has no scene and no experiment" : "every scene of the study is left out",
        plan.left_out.empty() ? "there is nothing to do"
                              : "an abridged report leaves out the scenes marked --unless-abridged",
        plan.left_out.empty() ? "add a scene or an experiment" : "remove --abridged, or mark fewer scenes");
  }
  if (!plan.vtk.empty() && plan.scenes.size() != 1) {
    text::refuse("the report has " + text::counted(plan.scenes.size(), "scene") + ", and --vtk one file",
                 "a file shows the receivers of one scene", "compare each scene by itself, or leave out --vtk");
  }
  StudyReport report;
  report.title = plan.title;
  report.command_line = plan.command_line;
  report.identity = identity_of(plan);
  report.left_out = plan.left_out;
  for (const PlannedScene& scene : plan.scenes) {
    report.scenes.push_back({scene.name, scene.title, study::run(scene.request, with_title(scene, hooks), &journal)});
  }
  for (const std::string& name : plan.experiments) {
    report.chapters.push_back(run_experiment(experiments::experiment_named(name), plan.effort, journal, hooks));
  }
  if (!plan.vtk.empty()) write_vtk(report.scenes.front().study, plan.vtk, hooks);
  Outcome outcome = outcome_of(report);
  std::ranges::move(write(report, folder, hooks), std::back_inserter(outcome.notes));
  return outcome;
}

}  // namespace exactff::report
