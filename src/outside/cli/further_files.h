// Files that commands write besides their result: --npy, --npz, --vtk, --exr and others.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

namespace exactff::cli {

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

struct OutputFile {
  std::string flag;
  std::filesystem::path file;
};
// As check_further_files, for files beside others (`before`) that are checked already.
void check_output_files(const std::vector<OutputFile>& files, std::vector<OutputFile> before, bool may_replace);

// Called before anything that takes time. Throws InputError unless each file can be written beside `result`, a file or
// a folder: if a file is no regular file, exists already and may not be replaced, has no place to be written, is the
// same as another one, or lies in the folder.
void check_further_files(const FurtherFiles& files, const std::filesystem::path& result, bool may_replace);

// Prints where they are.
void print_further_files(const FurtherFiles& files);

}  // namespace exactff::cli
