// Files that commands write besides their result: --npy, --npz, --vtk, --exr and others.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "files/file.h"

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

// Called before anything that takes time. Throws InputError unless each file can be written: if it is no regular file,
// exists already and may not be replaced, or has no place to be written. That outputs are different files is known
// already (flags/file_options.h). Files without a name are left out.
void check_output_files(const std::vector<files::NamedFile>& files, bool may_replace);
void check_further_files(const FurtherFiles& files, bool may_replace);

// Prints where they are.
void print_further_files(const FurtherFiles& files);

}  // namespace exactff::cli
