#include "flags/file_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "exactff/jobs.h"
#include "files/file.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"
#include "vtk/vtk.h"

namespace exactff::flags {
namespace {

namespace fs = std::filesystem;
using files::NamedFile;
using Use = FileMark::Use;

// CLI11 joins the type of an option and the descriptions of its checks by colons.
constexpr std::string_view kRead = ":READ", kWritten = ":WRITTEN ", kFolder = ":FOLDER";

CLI::Validator mark(std::string_view text) {
  return {[](const std::string&) { return std::string(); }, std::string(text.substr(1))};
}

// --- Formats and names ---

struct NamedFormat {
  Format format = Format::kAny;  // kAny: one that no command writes
  std::string_view name;
  std::vector<std::string_view> extensions = {};
};

const std::vector<NamedFormat>& formats() {
  static const std::vector<NamedFormat> kFormats = {
      {Format::kCsv, "CSV text", {".csv"}},
      {Format::kNpy, "a NumPy array", {".npy"}},
      {Format::kNpz, "an archive of NumPy arrays", {".npz"}},
      {Format::kVtk, "a VTK file", {".vtp", ".vtu"}},
      {Format::kExr, "an OpenEXR image", {".exr"}},
      {Format::kSvg, "an SVG drawing", {".svg"}},
      {Format::kJson, "JSON", {".json"}},
      {Format::kXml, "XML", {".xml"}},
      {Format::kView3d, "View3D's output"},
      {Format::kEnergyPlus, "objects of EnergyPlus", {".idf"}},
      {Format::kProgram, "numbers of another program"},
      {Format::kTable, "a table", {".csv", ".npz", ".jsonl"}},
      {Format::kImage, "an image", {".exr", ".png"}},
      {Format::kScene, "a scene", {".obj", ".ply", ".stl", ".off", ".vs3"}},
      {Format::kMesh, "a mesh", {".obj", ".ply", ".stl", ".off", ".vs3", ".vtp", ".vtu"}},
      {Format::kAny, "a spreadsheet", {".xlsx", ".xls", ".ods"}},
      {Format::kAny, "an HDF5 file", {".h5", ".hdf5"}},
      {Format::kAny, "a MATLAB file", {".mat"}},
      {Format::kAny, "a Parquet file", {".parquet"}},
      {Format::kAny, "a compressed file", {".gz", ".bz2", ".xz", ".zst", ".zip"}},
      {Format::kAny, "an image", {".jpg", ".jpeg", ".tif", ".tiff", ".hdr"}},
      {Format::kAny, "a document", {".pdf", ".html"}}};
  return kFormats;
}

const NamedFormat* named(Format format) {
  const auto found = std::ranges::find(formats(), format, &NamedFormat::format);
  return format == Format::kAny || found == formats().end() ? nullptr : &*found;
}

// These are chosen by the extension, and refuse others themselves.
bool chooses_by_extension(Format format) {
  return format == Format::kVtk || format == Format::kImage || format == Format::kScene || format == Format::kMesh;
}

// --- Options of a command that are given ---

// "--npz"; "-o" of "-o,--output"; "SCENE".
std::string name_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true, false);
  const std::vector<std::string>& letters = option.get_snames();
  return letters.empty() ? "--" + option.get_lnames().front() : '-' + letters.front();
}

struct GivenFile {
  const CLI::Option* option = nullptr;
  FileMark mark;
  NamedFile named;
};

std::vector<GivenFile> given_files(const CLI::App& command) {
  std::vector<GivenFile> given;
  for (const CLI::Option* option : command.get_options()) {
    const std::optional<FileMark> mark = mark_of(*option);
    if (!mark) continue;
    for (const std::string& file : option->results()) {
      if (!file.empty()) given.push_back({option, *mark, {name_of(*option), file}});
    }
  }
  return given;
}

std::vector<NamedFile> files_read(const std::vector<GivenFile>& given) {
  std::vector<NamedFile> read;
  for (const GivenFile& one : given) {
    if (one.mark.use == Use::kRead) read.push_back(one.named);
  }
  return read;
}

bool is_given(const CLI::App& command, const std::string& flag) {
  const CLI::Option* option = command.get_option_no_throw(flag);
  return option != nullptr && option->count() > 0;
}

fs::path with_suffix(fs::path file, const char* suffix) { return file += suffix; }

// A file appears under its name when it is complete (files/file.h).
void add_whole(const std::string& called, const fs::path& file, std::vector<NamedFile>& written) {
  written.push_back({called, file});
  written.push_back({"the unfinished file of " + called, with_suffix(file, ".whole")});
}

void add_journal(const std::string& called, const fs::path& file, std::vector<NamedFile>& written) {
  written.push_back({"the journal of " + called, jobs::journal_of_folder(file)});
}

void add_beside(const CLI::App& command, const GivenFile& one, std::vector<NamedFile>& written) {
  const auto& [called, file] = one.named;
  switch (one.mark.beside) {
    case Beside::kNothing:
      break;
    case Beside::kJournal:
      add_journal(called, file, written);
      break;
    case Beside::kViewFactors:
      if (is_given(command, "--matrix")) break;
      add_whole("the view factors of " + called, kept_factors_of(file), written);
      add_journal("the view factors of " + called, kept_factors_of(file), written);
      add_journal("the view factors that " + called + " computes again", kept_again_of(file), written);
      break;
    case Beside::kFaceFaces:
      add_whole("the faces of " + called, file.parent_path() / "globalFaceFaces", written);
      break;
    case Beside::kScene:
      add_whole("the scene of " + called, vtk::scene_file(file), written);
      break;
    case Beside::kMaterials:
      if (text::in_lower_case(file.extension().string()) != ".obj") break;
      add_whole("the materials of " + called, fs::path(file).replace_extension(".mtl"), written);
  }
}

std::vector<NamedFile> files_written(const CLI::App& command, const std::vector<GivenFile>& given) {
  std::vector<NamedFile> written;
  for (const GivenFile& one : given) {
    if (one.mark.use == Use::kRead) continue;
    if (one.mark.use == Use::kFile) {
      add_whole(one.named.called, one.named.file, written);
      add_beside(command, one, written);
    } else {
      add_journal(one.named.called, one.named.file, written);
    }
  }
  return written;
}

void require_apart(const CLI::App& command, const std::vector<GivenFile>& given, std::span<const NamedFile> read) {
  const std::vector<NamedFile> written = files_written(command, given);
  for (const NamedFile& output : written) files::require_not_read(output, read);
  files::require_apart(written);
  for (const GivenFile& folder : given) {
    if (folder.mark.use != Use::kFolder) continue;
    std::vector<GivenFile> others = given;
    std::erase_if(others, [&](const GivenFile& one) { return one.option == folder.option; });
    files::require_none_inside(folder.named, read, files_written(command, others));
  }
}

// "write --npz m.npz" if the command has a flag for what the name says.
std::string better_name(const CLI::App& command, const GivenFile& one, const std::string& extension) {
  const std::span<const std::string_view> own = extensions_of(one.mark.format);
  const std::string example = own.empty() ? ".txt" : std::string(own.front());
  for (const CLI::Option* other : command.get_options()) {
    const std::optional<FileMark> mark = mark_of(*other);
    if (!mark || mark->use != Use::kFile) continue;
    const std::span<const std::string_view> extensions = extensions_of(mark->format);
    if (std::ranges::find(extensions, extension) == extensions.end()) continue;
    const std::string both = one.option->get_required() ? fmt::format("{} FILE{} ", one.named.called, example) : "";
    return fmt::format("write {}{} {}", both, name_of(*other), text::shell_word(one.named.file.string()));
  }
  return "name a " + example + " file";
}

void require_own_format(const CLI::App& command, const GivenFile& one) {
  const NamedFormat* own = named(one.mark.format);
  std::error_code ignored;
  if (own == nullptr || chooses_by_extension(own->format) || fs::is_other(one.named.file, ignored)) return;
  const std::string extension = text::in_lower_case(one.named.file.extension().string());
  const auto has_it = [&](const NamedFormat& format) {
    return std::ranges::find(format.extensions, extension) != format.extensions.end();
  };
  const auto other = std::ranges::find_if(formats(), has_it);
  if (has_it(*own) || other == formats().end()) return;
  text::refuse(one.named.file,
               fmt::format("is named as {}, and {} writes {}", other->name, one.named.called, own->name),
               "other programs go by the name", better_name(command, one, extension));
}

}  // namespace

CLI::Validator is_read() { return mark(kRead); }
CLI::Validator is_written_folder() { return mark(kFolder); }
CLI::Validator is_written(Format format, Beside beside) {
  return mark(fmt::format("{}{} {}", kWritten, static_cast<int>(format), static_cast<int>(beside)));
}

std::size_t begin_of_mark(std::string_view type_name) {
  std::size_t begin = type_name.size();
  for (const std::string_view mark : {kRead, kWritten, kFolder}) begin = std::min(begin, type_name.find(mark));
  return begin;
}

std::optional<FileMark> mark_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  std::string_view text = std::string_view(type).substr(begin_of_mark(type));
  if (text.empty()) return std::nullopt;
  if (text.starts_with(kRead)) return FileMark{};
  if (text.starts_with(kFolder)) return FileMark{.use = Use::kFolder};
  text.remove_prefix(kWritten.size());
  const std::vector<std::string_view> numbers = text::words(text);
  return FileMark{Use::kFile, static_cast<Format>(std::stoi(std::string(numbers[0]))),
                  static_cast<Beside>(std::stoi(std::string(numbers[1])))};
}

std::span<const std::string_view> extensions_of(Format format) {
  const NamedFormat* found = named(format);
  return found == nullptr ? std::span<const std::string_view>() : found->extensions;
}

void require_outputs_apart(const CLI::App& command) {
  const std::vector<GivenFile> given = given_files(command);
  require_apart(command, given, files_read(given));
  for (const GivenFile& one : given) {
    if (one.mark.use == Use::kFile) require_own_format(command, one);
  }
}

void require_not_written(const CLI::App& command, std::span<const fs::path> read) {
  std::vector<NamedFile> named;
  for (const fs::path& file : read) named.push_back({"with SCENE", file});
  require_apart(command, given_files(command), named);
}

fs::path kept_factors_of(const fs::path& file) { return with_suffix(file, ".factors"); }
fs::path kept_again_of(const fs::path& file) { return with_suffix(file, ".again"); }

}  // namespace exactff::flags
