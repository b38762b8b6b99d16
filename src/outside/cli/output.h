// Small helpers of the commands: words for numbers and faces, tables, files that appear complete or not at all.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <initializer_list>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "exactff/receiver.h"
#include "exactff/scene.h"
#include "exactff/scene_files.h"
#include "files/file.h"
#include "text/escape.h"

namespace exactff::cli {

std::string percent(double share);
std::string pad(const std::string& text, std::size_t width);

std::string place_text(const Vec3& place);  // "(0, 0.5, 1)"
// "(0, 0.5, 1), normal (0, 1, 0), on floor"
std::string receiver_text(const Scene& scene, const Receiver& receiver);

// For a terminal.
template <class Named>
std::string shown_name(const Scene& scene, const Named& named) {
  return text::printable(scene.name_of(named));
}

// Writes a file beside `path` and renames it: the file appears complete or not at all. Throws InputError.
void write_whole_file(const std::filesystem::path& path, const std::string& text);

// The same for all of these files: if one cannot be written, none appears.
void write_scene_files(const SceneFiles& scene);

// Throws InputError if the file exists, unless it may be replaced. Pipes and devices may always be written to.
void require_free_file(const std::filesystem::path& path, bool force);
// Throws InputError for another extension than .csv, .npz and .jsonl, unless it is a pipe or a device.
void require_table_file(const std::filesystem::path& path);

// Throws InputError if the printed text could not be written, for example because the disk is full.
void check_output(std::ostream& out);

// Writes "warning: ..." to stderr for the first 20 warnings, then the number of the others.
void print_warnings(std::span<const Problem> warnings);
void print_warning(std::string what, std::string why, std::string suggestion);
// Warnings on receivers that were probably meant to lie on a face.
void print_near_misses(const Scene& scene, std::span<const Receiver> receivers);
// Warnings on faces that lie behind others, which hide everything from them. Of more than 4,096 faces, about that many
// are looked at.
void print_hidden_faces(const Scene& scene);

// Throws InputError unless a result can be written to `folder` (page/output_folder.h).
void check_output_folder(const std::filesystem::path& folder);

enum class Align { kLeft, kRight };

// A table to be read by people: columns as wide as their widest cell, numbers aligned right. Cells wider than a limit
// stick out instead of widening every row.
class TextTable {
 public:
  void add_column(std::string title, Align align = Align::kLeft);
  void add_columns(std::initializer_list<const char*> titles, Align align = Align::kLeft);
  void add_row(std::vector<std::string> cells);  // one per column
  void print(std::ostream& out) const;

 private:
  std::vector<std::string> titles_;
  std::vector<Align> aligns_;
  std::vector<std::vector<std::string>> rows_;
};

// --- Further files ---

// Files that commands write besides their result: --npy, --npz, --vtk, --exr and others.

struct FurtherFiles {
  std::string npy;
  std::string npz;
  std::string vtk;
  std::string exr;

  void add_numpy_to(CLI::App& app);  // --npy and --npz
  void add_vtk_to(CLI::App& app);
  void add_exr_to(CLI::App& app);
  // The flags that are given: "--npy", "--vtk".
  [[nodiscard]] std::vector<std::string> flags() const;
};

// Called before anything that takes time. Throws InputError unless each file can be written: if it is no regular file,
// exists already and may not be replaced, or has no place to be written. That outputs are different files is known
// already (flags/values.h). Files without a name are left out.
void check_output_files(const std::vector<files::NamedFile>& files, bool may_replace);
void check_further_files(const FurtherFiles& files, bool may_replace);

// Prints where they are.
void print_further_files(const FurtherFiles& files);

}  // namespace exactff::cli
