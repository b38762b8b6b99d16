#include "flags/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "exactff/jobs.h"
#include "exactff/matrix.h"
#include "files/file.h"
#include "scene/selections.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"
#include "vtk/vtk.h"

namespace exactff::flags {
namespace {

using files::NamedFile;
using Use = FileMark::Use;

// Whether the text with its commas is one name. A pattern is not: its parts are.
bool is_a_name(const Scene& scene, const std::string& text) {
  try {
    (void)(Scene::is_pattern(text) ? std::vector{scene.select(text)} : scene.select_all(text));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

bool means_all(const Scene& scene, const std::string& name) { return name == "all" && !has_patch(scene, name); }

void add(const Scene& scene, const std::string& name, std::vector<Selection>& selections) {
  if (means_all(scene, name)) {
    const std::vector<Selection> all = all_patches(scene);
    selections.insert(selections.end(), all.begin(), all.end());
    return;
  }
  for (const Selection& part : scene.select_all(name)) {
    if (Scene::is_pattern(name) && std::ranges::find(selections, part) != selections.end()) continue;
    selections.push_back(part);
  }
}

// As other programs call it.
void refuse_other_names_of_sky(const Scene& scene, const std::string& name) {
  constexpr std::array<std::string_view, 17> kOthers = {
      "sky",  "space",  "void",    "outside", "outdoor",  "outdoors",     "environment", "env",     "ambient",
      "open", "(open)", "nothing", "air",     "exterior", "surroundings", "background",  "infinity"};
  if (name == "sky" || has_patch(scene, name) || is_a_name(scene, name)) return;
  if (std::ranges::find(kOthers, text::in_lower_case(name)) == kOthers.end()) return;
  text::refuse("there is no patch named " + text::in_quotes(name, text::kShownName),
               "what is open, all directions that meet nothing, is called sky here", "write sky instead");
}

// If numbers are missing, the flag that follows would be read as one of them.
std::string is_no_flag(const std::string& text) {
  return text.starts_with("--") ? "needs three numbers; found '" + text + "' among them" : "";
}

double finite_number(const std::string& text, const std::string& flag) {
  const text::ParsedNumber number = text::parse_number(text);
  if (number.fault == text::NumberFault::kNone) return number.value;
  text::refuse(flag + ": " + describe(number.fault, text), "a coordinate is a finite decimal number",
               "give three numbers, for example " + flag + " 0 0.5 -1e-3");
}

}  // namespace

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    parts.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

std::optional<std::pair<int, int>> numbers_across(std::string_view text) {
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto first = whole_number<int>(text.substr(0, cross));
  const auto second = whole_number<int>(text.substr(std::min(cross + 1, text.size())));
  return first && second ? std::optional(std::pair(*first, *second)) : std::nullopt;
}

std::string is_positive(const std::string& text) {
  const text::ParsedNumber number = text::parse_number(text);
  return number.fault == text::NumberFault::kNone && number.value > 0.0 ? ""
                                                                        : "'" + text + "' is not a positive number";
}

std::string is_not_negative(const std::string& text) {
  const text::ParsedNumber number = text::parse_number(text);
  return number.fault == text::NumberFault::kNone && number.value >= 0.0
             ? ""
             : "'" + text + "' is not a finite decimal number of at least 0";
}

std::vector<Selection> selections_named(const Scene& scene, const std::vector<std::string>& texts) {
  std::vector<Selection> selections;
  for (const std::string& text : texts) {
    const std::vector<std::string> parts = split_list(text);
    const bool is_one_name = parts.size() > 1 && is_a_name(scene, text);
    for (const std::string& name : is_one_name ? std::vector{text} : parts) add(scene, name, selections);
  }
  return selections;
}

bool take_sky(const Scene& scene, std::vector<std::string>& texts) {
  std::vector<std::string> kept;
  bool found = false;
  for (const std::string& text : texts) {
    for (const std::string& name : has_patch(scene, text) ? std::vector{text} : split_list(text)) {
      refuse_other_names_of_sky(scene, name);
      const bool is_sky = name == "sky" && !has_patch(scene, name);
      found = found || is_sky;
      if (!is_sky) kept.push_back(name);
    }
  }
  if (found) texts = kept;
  return found;
}

bool names_all(const Scene& scene, const std::vector<std::string>& texts) {
  return std::ranges::any_of(texts, [&](const std::string& text) {
    const std::vector<std::string> parts = split_list(text);
    if (parts.size() > 1 && is_a_name(scene, text)) return false;
    return std::ranges::any_of(parts, [&](const std::string& part) { return means_all(scene, part); });
  });
}

void add_names(CLI::App& app, const std::string& flag, std::vector<std::string>& names, const std::string& meaning,
               const std::string& more) {
  add_value(app, flag, names, "NAME[:K]", meaning + kNamesHelp + more)->expected(1)->take_all();
}

void add_threads(CLI::App& app, int& threads) {
  add_value(app, "--threads", threads, "N", "Number of threads (default: all); it does not affect the values")
      ->check(CLI::Range(1, 4096));
}

std::string command_words(const CLI::App& command, const std::vector<std::string>& left_out) {
  std::string line;
  for (const CLI::Option* option : command.get_options()) {
    const std::string flag = option->get_name();
    if (option->count() == 0 || option->get_positional() || std::ranges::count(left_out, flag) > 0) continue;
    const bool is_switch = option->get_items_expected_max() == 0, takes_several = option->get_type_size() > 1;
    if (is_switch || takes_several) line += ' ' + flag;
    if (is_switch) continue;
    for (const std::string& value : option->results()) {
      line += (takes_several ? "" : ' ' + flag) + ' ' + text::shell_word(value);
    }
  }
  return line;
}

CLI::Option* add_vector_option(CLI::App& app, const std::string& flag, ThreeNumbers& numbers,
                               const std::string& meaning, const std::string& type) {
  return add_value(app, flag, numbers, type, meaning)->check(is_no_flag);
}

Vec3 vector_of(const ThreeNumbers& numbers, const std::string& flag) {
  return {finite_number(numbers[0], flag), finite_number(numbers[1], flag), finite_number(numbers[2], flag)};
}

// --- File options ---

namespace {

namespace fs = std::filesystem;

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
    case Beside::kOpenFoam:
      for (const std::string_view name : matrix::kOpenFoamFiles) {
        add_whole(std::string(name) + " of " + called, file.parent_path() / name, written);
      }
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
