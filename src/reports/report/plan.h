// What a report covers, and how it is carried out. A .study file describes a report on several scenes.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "exactff/error.h"
#include "exactff/jobs.h"
#include "exactff/study.h"

namespace exactff::report {

struct PlannedScene {
  std::string name;   // letters, digits and hyphens, for the names of files; empty: the report is on this scene alone
  std::string title;  // "Cornell box"
  std::shared_ptr<const Scene> scene;
  study::Request request;         // of this scene
  std::vector<Problem> warnings;  // for the user, of how the request was made
};

// What a report is to cover.
struct Plan {
  std::string title;  // of the report; empty: that of the only scene
  std::vector<PlannedScene> scenes;
  std::string flags;          // all that the values depend on beside the scenes and their receivers, as it was given
  std::string command_line;   // shown in the last section of the report
  std::filesystem::path vtk;  // the file of write_vtk for the only scene; empty: none
  std::vector<std::filesystem::path> files_read;  // of the scenes in a study file, and their receivers

  // Gives the scene a name that no other has.
  void add_scene(std::string scene_title, std::shared_ptr<const Scene> scene, study::Request request,
                 std::vector<Problem> warnings = {});
};

// What a finished report in a folder tells about itself.
enum class Finished {
  kNone,       // there is no report
  kOfAnother,  // a report on another plan, by another version, or by study::write_report
  kOfThis,     // a report that carry_out() made of the same plan: its values would be the same
};
[[nodiscard]] Finished finished_report(const Plan& plan, const std::filesystem::path& folder);
[[nodiscard]] bool has_report(const std::filesystem::path& folder);

// What was found out, for the user to read.
struct Outcome {
  struct OfScene {
    std::string title;
    std::vector<std::string> sentences;
  };
  std::vector<OfScene> scenes;
  std::vector<std::string> notes;  // such as a missing gnuplot
};

// Runs every study of the plan and writes one report on all of them, as study::write_report does. The
// files of a scene begin with its name and an underscore. What is finished is kept in `journal`, which is to be removed
// when everything is done.
Outcome carry_out(const Plan& plan, const std::filesystem::path& folder, jobs::Journal& journal,
                  const Hooks& hooks = {});

}  // namespace exactff::report
