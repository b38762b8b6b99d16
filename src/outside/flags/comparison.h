// The flags of a comparison of methods on one scene: those of `exactff compare`, and of a scene line in a study file;
// and the study file, which describes a study of several scenes.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactff/error.h"
#include "exactff/study.h"
#include "flags/scene.h"
#include "report/plan.h"

namespace exactff::flags {

// The flags as given; empty if a flag was not given.
struct ComparisonArguments {
  flags::SceneArguments scene;
  flags::ReceiverArguments receivers;
  flags::SourceArguments sources;
  std::string eps_b, eps_a, rays, seeds, pattern, variant;
  std::vector<std::string> methods;
  bool no_methods = false;
  bool sweep = false;
  std::optional<std::size_t> method_seeds, method_receivers;
  std::optional<double> method_budget, sweep_budget;
  flags::EngineArgument engine;
  flags::CameraArguments camera;  // of the report's pictures
  std::string title;

  void add_to(CLI::App& app);
};

struct Comparison {
  std::string title;
  std::shared_ptr<const Scene> scene;
  study::Request request;
  std::vector<Problem> warnings;  // of its receivers
};

// Loads the scene and completes the request. Throws InputError.
[[nodiscard]] Comparison comparison_of(const ComparisonArguments& args, int threads);

// "cornell_box.obj" for a path, "teapot:segments=8" for a model.
[[nodiscard]] std::string short_name(const std::string& scene);

// --- the study file ---
//
//   # a comment
//   title Form factors of rooms
//   scene cornell_box.obj --on floor --grid 32x32 --title "Cornell box"
//   scene @karkanis:n=200 --on floor --grid 16x16
//
// A scene line has the words and flags that `exactff compare` takes for one scene. Files are looked up in the folder
// of the study.

[[nodiscard]] bool is_study_file(const std::string& path);  // by its extension, .study

// Reads a .study file (data/guide/methods.md) and loads its scenes. Throws one InputError with the line of every
// problem.
[[nodiscard]] report::Plan read_study_file(const std::filesystem::path& file, int threads = 0);

// --- its syntax ---

struct StudyLine {
  std::size_t number = 0;
  std::vector<std::string> words;  // without the keyword
};

struct StudyFile {
  std::string title;
  std::vector<StudyLine> scenes;
};

// Throws InputError with everything that is wrong in the syntax of the file. Flags are checked later, by the code that
// parses them.
[[nodiscard]] StudyFile parse_study_file(const std::filesystem::path& path);

// The words of a line. Blanks separate words; "..." or '...' encloses text with blanks. Throws InputError if a quote is
// not closed.
[[nodiscard]] std::vector<std::string> split_words(std::string_view line, const std::string& file, std::size_t number);

}  // namespace exactff::flags
