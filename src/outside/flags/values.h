// Parses the values of flags: lists, whole numbers, names of patches, and three numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exactff/geometry.h"
#include "exactff/scene.h"
#include "text/number_text.h"

namespace exactff::flags {

// The parts between the commas. An empty text has one empty part.
std::vector<std::string> split_list(const std::string& text);

using text::whole_number;
// "32x16". Nothing for any other text.
[[nodiscard]] std::optional<std::pair<int, int>> numbers_across(std::string_view text);

// A check of a flag's value.
[[nodiscard]] std::string is_positive(const std::string& text);
[[nodiscard]] std::string is_not_negative(const std::string& text);

// What the help of such a flag says.
inline constexpr const char* kNamesHelp = "; can be repeated, or separate names by commas; * ? [...] as in file names";

// In the order of `texts`. Each of them is a name or pattern, which may stand for several patches (Scene::select_all),
// a comma list of them, or "all": every patch with area, in the order of the file. A patch, or the cells of a divided
// one, with exactly the given name has priority, even if its name is "all" or contains a comma. What a pattern matches
// is left out if it is among the selections before. Throws InputError for an unknown name.
std::vector<Selection> selections_named(const Scene& scene, const std::vector<std::string>& texts);

// Takes "sky" out of the texts, if it is among them and is not the name of a patch.
bool take_sky(const Scene& scene, std::vector<std::string>& texts);

// Whether "all" is among them and means every patch.
bool names_all(const Scene& scene, const std::vector<std::string>& texts);

// For selections_named(). The help says `meaning`, then how several are named, then `more`.
void add_names(CLI::App& app, const std::string& flag, std::vector<std::string>& names, const std::string& meaning,
               const std::string& more = "");
void add_threads(CLI::App& app, int& threads);

// The flags that are given, each preceded by a blank and quoted for a shell, without those that `left_out` names.
[[nodiscard]] std::string command_words(const CLI::App& command, const std::vector<std::string>& left_out = {});

// Three numbers as given; empty texts if the flag was not. CLI11 always gives an array all its words, so "-.5" is no
// flag.
using ThreeNumbers = std::array<std::string, 3>;
[[nodiscard]] inline bool is_given(const ThreeNumbers& numbers) { return !numbers.front().empty(); }

CLI::Option* add_vector_option(CLI::App& app, const std::string& flag, ThreeNumbers& numbers,
                               const std::string& meaning, const std::string& type = "X Y Z");

// Parses finite doubles with correct rounding. The InputError for other texts names the flag.
[[nodiscard]] Vec3 vector_of(const ThreeNumbers& numbers, const std::string& flag);

// --- File options ---

// The options that name files. Each is marked as read or written, and the marks keep one promise for all commands: no
// output replaces what the command reads, or another output of it, whatever flags say.

// What a file holds. Of several formats, the name of the file says which.
enum class Format {
  kAny,
  kCsv,
  kNpy,
  kNpz,
  kVtk,
  kExr,
  kSvg,
  kJson,
  kXml,
  kEnergyPlus,
  kProgram,  // numbers of another program, by any name
  kTable,    // CSV, .npz or .jsonl
  kImage,    // EXR or PNG
  kScene,
  kMesh,  // a scene, or VTK
};

// What a command writes beside the file that an option names.
enum class Beside {
  kNothing,
  kJournal,      // FILE.part, until FILE is complete
  kViewFactors,  // of `exactff radiosity`: FILE.factors and its journal, FILE.again.part
  kOpenFoam,     // matrix::kOpenFoamFiles in the same folder
  kScene,        // NAME_scene.vtp of NAME.vtp
  kMaterials,    // NAME.mtl of NAME.obj
};

// The marks, for CLI::Option::check. They accept every value. An option that names a file has exactly one of them.
[[nodiscard]] CLI::Validator is_read();
[[nodiscard]] CLI::Validator is_written(Format format, Beside beside = Beside::kNothing);
[[nodiscard]] CLI::Validator is_written_folder();  // with a journal FOLDER.part

// An option whose value the help calls `type`: "LENGTH".
template <class Target>
CLI::Option* add_value(CLI::App& app, const std::string& flag, Target& value, const std::string& type,
                       const std::string& meaning) {
  return app.add_option(flag, value, meaning)->type_name(type);
}

// Options whose value is FILE, with their mark.
template <class Target>
CLI::Option* add_read(CLI::App& app, const std::string& flag, Target& file, const std::string& meaning) {
  return add_value(app, flag, file, "FILE", meaning)->check(is_read());
}
template <class Target>
CLI::Option* add_written(CLI::App& app, const std::string& flag, Target& file, const std::string& meaning,
                         Format format, Beside beside = Beside::kNothing) {
  return add_value(app, flag, file, "FILE", meaning)->check(is_written(format, beside));
}

struct FileMark {
  enum class Use { kRead, kFile, kFolder };
  Use use = Use::kRead;
  Format format = Format::kAny;
  Beside beside = Beside::kNothing;
};
[[nodiscard]] std::optional<FileMark> mark_of(const CLI::Option& option);
// Where the mark begins in CLI::Option::get_type_name(), "FILE:WRITTEN 1 0"; its end if there is none.
[[nodiscard]] std::size_t begin_of_mark(std::string_view type_name);
// The extensions that files of this format have, in lower case; empty if any will do.
[[nodiscard]] std::span<const std::string_view> extensions_of(Format format);

// Before a command begins: throws InputError if an output that is given would replace what a given option names to be
// read, or another output or what is written beside it, or lies in a folder that is replaced; or if its name says that
// it holds another format, which readers would believe.
void require_outputs_apart(const CLI::App& command);

// The same for files that the command finds to be read: the MTL files of a scene, the scenes of a study.
void require_not_written(const CLI::App& command, std::span<const std::filesystem::path> read);

// Where `exactff radiosity -o FILE` keeps its view factors: those of the patches, and those that are computed again.
[[nodiscard]] std::filesystem::path kept_factors_of(const std::filesystem::path& file);
[[nodiscard]] std::filesystem::path kept_again_of(const std::filesystem::path& file);

}  // namespace exactff::flags
