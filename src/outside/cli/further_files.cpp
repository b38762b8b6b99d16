#include "cli/further_files.h"

#include <iostream>
#include <system_error>

#include "exactff/error.h"
#include "files/file.h"
#include "flags/file_options.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/refuse.h"
#include "vtk/vtk.h"

namespace exactff::cli {

namespace fs = std::filesystem;

namespace {

void require_regular(const files::NamedFile& output) {
  std::error_code ignored;
  const bool folder = fs::is_directory(output.file, ignored), device = fs::is_other(output.file, ignored);
  if (output.file != "-" && !folder && !device && output.file.has_filename()) return;
  text::refuse(output.file,
               std::string(folder   ? "is a folder"
                           : device ? "is a device"
                                    : "is not the name of a file") +
                   " (" + output.called + ')',
               "the file appears when it is complete, under a name of its own", "name a file on a disk");
}

void require_writable(const files::NamedFile& output, bool may_replace) {
  if (!may_replace && files::is_there(output.file)) {
    text::refuse(output.file, "already exists (" + output.called + ')', "a result is not replaced by accident",
                 "name another file, or replace it with --force");
  }
  const files::WholeFile probe(output.file);
}

}  // namespace

void FurtherFiles::add_numpy_to(CLI::App& app) {
  flags::add_written(app, "--npy", npy,
                     "Also write the values as a NumPy array: float64, a row for each receiver and a column for each "
                     "source; NaN where not certified",
                     flags::Format::kNpy);
  flags::add_written(app, "--npz", npz,
                     "Also write NumPy arrays in one small file: points, normals (unit vectors), on (index into "
                     "faces), faces, sources, F as --npy",
                     flags::Format::kNpz);
}

void FurtherFiles::add_vtk_to(CLI::App& app) {
  flags::add_written(app, "--vtk", vtk,
                     "Also write the values at the receivers' cells for ParaView, as NAME.vtp or NAME.vtu, and the "
                     "scene as NAME_scene.vtp or .vtu",
                     flags::Format::kVtk, flags::Beside::kScene);
}

void FurtherFiles::add_exr_to(CLI::App& app) {
  flags::add_written(app, "--exr", exr,
                     "Also write the totals as an OpenEXR image, in the pixels that --receivers FILE.exr has; NaN "
                     "where there is no value",
                     flags::Format::kExr);
}

std::vector<std::string> FurtherFiles::flags() const {
  std::vector<std::string> given;
  if (!npy.empty()) given.emplace_back("--npy");
  if (!npz.empty()) given.emplace_back("--npz");
  if (!vtk.empty()) given.emplace_back("--vtk");
  if (!exr.empty()) given.emplace_back("--exr");
  return given;
}

void check_further_files(const FurtherFiles& files, bool may_replace) {
  check_output_files({{"--npy", files.npy},
                      {"--npz", files.npz},
                      {"--vtk", files.vtk},
                      {"the scene of --vtk", files.vtk.empty() ? fs::path() : vtk::scene_file(files.vtk)},
                      {"--exr", files.exr}},
                     may_replace);
}

void check_output_files(const std::vector<files::NamedFile>& files, bool may_replace) {
  for (const files::NamedFile& output : files) {
    if (output.file.empty()) continue;
    require_regular(output);
    if (output.called == "--vtk") vtk::require_extension(output.file);
    if (output.called == "--exr" && text::in_lower_case(output.file.extension().string()) != ".exr") {
      text::refuse(output.file, "does not end in .exr (--exr)", "it is an OpenEXR file, which others recognise by that",
                   "name a .exr file");
    }
    require_writable(output, may_replace);
  }
}

void print_further_files(const FurtherFiles& files) {
  for (const std::string& file : {files.npy, files.npz}) {
    if (!file.empty()) std::cout << "NumPy file: " << text::printable(file) << '\n';
  }
  if (!files.vtk.empty()) {
    std::cout << "VTK files: " << text::printable(files.vtk) << ", "
              << text::printable(vtk::scene_file(files.vtk).string()) << '\n';
  }
  if (!files.exr.empty()) std::cout << "EXR file: " << text::printable(files.exr) << '\n';
}

}  // namespace exactff::cli
