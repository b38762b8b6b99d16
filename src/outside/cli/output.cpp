#include "cli/output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <system_error>

#include "cli/process.h"
#include "exactff/error.h"
#include "flags/values.h"
#include "page/output_folder.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"
#include "vtk/vtk.h"

namespace exactff::cli {

namespace fs = std::filesystem;

std::string percent(double share) { return text::rounded(100.0 * share, 4) + " %"; }

std::string place_text(const Vec3& place) {
  return fmt::format("({}, {}, {})", text::shortest(place.x), text::shortest(place.y), text::shortest(place.z));
}

std::string receiver_text(const Scene& scene, const Receiver& receiver) {
  const std::string on = receiver.on.empty() ? "" : ", on " + scene.name_of(receiver.on);
  const bool sphere = receiver.normal == Vec3{};
  return place_text(receiver.point) + (sphere ? ", a sphere" : ", normal " + place_text(receiver.normal)) + on;
}

std::string pad(const std::string& text, std::size_t width) {
  return text + std::string(text.size() < width ? width - text.size() : 1, ' ');
}

namespace {

[[noreturn]] void cannot_write(const fs::path& path, const std::string& reason) {
  text::refuse(path, "cannot be written: " + reason, "nothing was written",
               "name a file in a folder that exists, is writable and has free space");
}

// A pipe or device cannot be replaced by a file, so it is written directly.
void write_through(const fs::path& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) cannot_write(path, errno != 0 ? std::strerror(errno) : "opening or writing failed");
}

}  // namespace

void require_free_file(const fs::path& path, bool force) {
  std::error_code ignored;
  if (force || !fs::is_regular_file(path, ignored)) return;
  text::refuse(path, "already exists", "it may hold something else", "name another file, or replace it with --force");
}

void require_table_file(const fs::path& path) {
  const std::string extension = path.extension().string();
  std::error_code ignored;
  if (extension == ".csv" || extension == ".npz" || extension == ".jsonl" || fs::is_other(path, ignored)) return;
  text::refuse(path, "cannot hold a table", "the extension says how it is written", "name a file .csv, .npz or .jsonl");
}

namespace {

// Null for a pipe or device, which has been written directly.
std::unique_ptr<files::WholeFile> begin_whole_file(const fs::path& path, const std::string& text) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) cannot_write(path, "it is a folder");
  if (fs::is_other(path, ignored)) {
    write_through(path, text);
    return nullptr;
  }
  auto file = std::make_unique<files::WholeFile>(path, files::FailureAdvice(), files::WholeFile::WhenBusy::kWait);
  file->append(text);
  file->sync();
  return file;
}

}  // namespace

void write_whole_file(const fs::path& path, const std::string& text) {
  if (const auto file = begin_whole_file(path, text)) file->commit();
  leave_if_interrupted();
}

void write_scene_files(const SceneFiles& scene) {
  std::vector<std::unique_ptr<files::WholeFile>> begun;
  for (const SceneFiles::File& file : scene.files) begun.push_back(begin_whole_file(file.path, file.bytes));
  for (const auto& file : begun) {
    if (file) file->commit();
  }
  leave_if_interrupted();
}

void check_output_folder(const fs::path& folder) {
  page::check_output_folder(folder);
  leave_if_interrupted();
}

void check_output(std::ostream& out) {
  out.flush();
  if (out) return;
  text::refuse("the result could not be written to standard output", "the printed output is incomplete",
               "free some disk space, or send the output elsewhere");
}

namespace {

void print_misses(const Scene& scene, std::span<const Receiver> receivers, std::string_view noun) {
  for (const std::string& sentence : sentences(near_misses(scene, receivers), receivers.size(), noun)) {
    std::cerr << "warning: " << text::printable(sentence) << '\n';
  }
}

}  // namespace

void print_near_misses(const Scene& scene, std::span<const Receiver> receivers) {
  print_misses(scene, receivers, "receiver");
}

void print_hidden_faces(const Scene& scene) {
  constexpr std::size_t kMost = 4096;
  const std::size_t step = scene.faces().size() / kMost + 1;
  std::vector<FaceId> faces;
  for (std::size_t i = 0; i < scene.faces().size(); i += step) faces.push_back(static_cast<FaceId>(i));
  print_misses(scene, probe_receivers(scene, faces), "point");
}

void print_warnings(std::span<const Problem> warnings) {
  constexpr std::size_t kPrinted = 20;
  for (const Problem& warning : warnings.first(std::min(warnings.size(), kPrinted))) {
    std::cerr << "warning: " << warning.message() << '\n';
  }
  const bool at_least = warnings.size() > text::ProblemList::kKept;
  if (warnings.size() > kPrinted) {
    std::cerr << "warning: ... and " << (at_least ? "more than " : "") << warnings.size() - kPrinted << " more\n";
  }
}

void print_warning(std::string what, std::string why, std::string suggestion) {
  const Problem warning{.what = std::move(what), .why = std::move(why), .suggestion = std::move(suggestion)};
  print_warnings(std::span(&warning, 1));
}

void TextTable::add_column(std::string title, Align align) {
  titles_.push_back(std::move(title));
  aligns_.push_back(align);
}

void TextTable::add_columns(std::initializer_list<const char*> titles, Align align) {
  for (const char* title : titles) add_column(title, align);
}

void TextTable::add_row(std::vector<std::string> cells) {
  for (std::string& cell : cells) cell = text::printable(cell);
  rows_.push_back(std::move(cells));
}

void TextTable::print(std::ostream& out) const {
  constexpr std::size_t kWidest = 80;
  const auto width = [](const std::string& cell) {  // counts the bytes that begin a UTF-8 character
    return static_cast<std::size_t>(
        std::ranges::count_if(cell, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
  };
  std::vector<std::size_t> widths(titles_.size());
  const auto for_each_row = [&](const auto& visit) {
    visit(titles_);
    for (const auto& row : rows_) visit(row);
  };
  for_each_row([&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) widths[i] = std::max(widths[i], std::min(width(cells[i]), kWidest));
  });
  for_each_row([&](const std::vector<std::string>& cells) {
    std::string line;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      const std::size_t taken = width(cells[i]);
      const std::string blanks(widths[i] > taken ? widths[i] - taken : 0, ' ');
      line += (aligns_[i] == Align::kLeft ? cells[i] + blanks : blanks + cells[i]) + "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << '\n';
  });
}

// --- Further files ---

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
