#include "cli/further_files.h"

#include <iostream>
#include <system_error>

#include "exactff/error.h"
#include "files/file.h"
#include "text/escape.h"
#include "text/nearest_names.h"
#include "text/refuse.h"
#include "vtk/vtk.h"

namespace exactff::cli {

namespace fs = std::filesystem;

namespace {

using Output = OutputFile;

std::vector<Output> outputs(const FurtherFiles& files) {
  std::vector<Output> list;
  if (!files.npy.empty()) list.push_back({"--npy", files.npy});
  if (!files.npz.empty()) list.push_back({"--npz", files.npz});
  if (!files.vtk.empty()) list.push_back({"--vtk", files.vtk});
  if (!files.vtk.empty()) list.push_back({"the scene of --vtk", vtk::scene_file(files.vtk)});
  if (!files.exr.empty()) list.push_back({"--exr", files.exr});
  return list;
}

void require_regular(const Output& output) {
  std::error_code ignored;
  const bool folder = fs::is_directory(output.file, ignored), device = fs::is_other(output.file, ignored);
  if (output.file != "-" && !folder && !device && output.file.has_filename()) return;
  text::refuse(output.file,
               std::string(folder   ? "is a folder"
                           : device ? "is a device"
                                    : "is not the name of a file") +
                   " (" + output.flag + ')',
               "the file appears when it is complete, under a name of its own", "name a file on a disk");
}

// The place itself, also of a file that does not exist yet.
fs::path place(const fs::path& file) {
  std::error_code error;
  fs::path found = fs::weakly_canonical(fs::absolute(file, error), error);
  return error ? file : found;
}

void require_apart(const Output& output, const Output& other) {
  std::error_code ignored;
  if (place(output.file) != place(other.file) && !fs::equivalent(output.file, other.file, ignored)) return;
  text::refuse(output.file, "is given for two outputs (" + other.flag + " and " + output.flag + ')',
               "one would replace the other", "name another file");
}

void require_outside(const Output& output, const fs::path& folder) {
  const fs::path relative = place(output.file).lexically_relative(place(folder));
  if (relative.empty() || *relative.begin() == "..") return;
  text::refuse(output.file, "lies in the folder of the result (" + output.flag + ')',
               "the folder appears as a whole and replaces the one before", "name a file in another folder");
}

void require_writable(const Output& output, bool may_replace) {
  if (!may_replace && files::is_there(output.file)) {
    text::refuse(output.file, "already exists (" + output.flag + ')', "a result is not replaced by accident",
                 "name another file, or replace it with --force");
  }
  const files::WholeFile probe(output.file);
}

}  // namespace

void FurtherFiles::add_numpy_to(CLI::App& app) {
  app.add_option("--npy", npy,
                 "Also write the values as a NumPy array: float64, a row for each receiver and a column for each "
                 "source; NaN where not certified")
      ->type_name("FILE");
  app.add_option("--npz", npz,
                 "Also write NumPy arrays in one small file: points, normals (unit vectors), on (index into faces), "
                 "faces, sources, F as --npy")
      ->type_name("FILE");
}

void FurtherFiles::add_vtk_to(CLI::App& app) {
  app.add_option("--vtk", vtk,
                 "Also write the values at the receivers' cells for ParaView, as NAME.vtp or NAME.vtu, and the scene "
                 "as NAME_scene.vtp or .vtu")
      ->type_name("FILE");
}

void FurtherFiles::add_exr_to(CLI::App& app) {
  app.add_option("--exr", exr,
                 "Also write the totals as an OpenEXR image, in the pixels that --receivers FILE.exr has; NaN where "
                 "there is no value")
      ->type_name("FILE");
}

std::vector<std::string> FurtherFiles::flags() const {
  std::vector<std::string> given;
  if (!npy.empty()) given.emplace_back("--npy");
  if (!npz.empty()) given.emplace_back("--npz");
  if (!vtk.empty()) given.emplace_back("--vtk");
  if (!exr.empty()) given.emplace_back("--exr");
  return given;
}

void check_further_files(const FurtherFiles& files, const fs::path& result, bool may_replace) {
  std::vector<Output> before = {{"-o", result}, {"the journal of -o", result.string() + ".part"}};
  for (const Output& output : outputs(files)) {
    require_regular(output);
    if (output.flag == "--vtk") vtk::require_extension(output.file);
    if (output.flag == "--exr" && text::in_lower_case(output.file.extension().string()) != ".exr") {
      text::refuse(output.file, "does not end in .exr (--exr)", "it is an OpenEXR file, which others recognise by that",
                   "name a .exr file");
    }
    for (const Output& other : before) require_apart(output, other);
    require_outside(output, result);
    require_writable(output, may_replace);
    before.push_back(output);
  }
}

void check_output_files(const std::vector<OutputFile>& files, std::vector<OutputFile> before, bool may_replace) {
  for (const OutputFile& output : files) {
    if (output.file.empty()) continue;
    require_regular(output);
    if (output.flag == "--vtk") vtk::require_extension(output.file);
    for (const OutputFile& other : before) require_apart(output, other);
    require_writable(output, may_replace);
    before.push_back(output);
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
