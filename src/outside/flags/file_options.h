// The options that name files. Each is marked as read or written, and the marks keep one promise for all commands: no
// output replaces what the command reads, or another output of it, whatever flags say.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace exactff::flags {

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
  kView3d,
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
  kFaceFaces,    // globalFaceFaces in the same folder
  kScene,        // NAME_scene.vtp of NAME.vtp
  kMaterials,    // NAME.mtl of NAME.obj
};

// The marks, for CLI::Option::check. They accept every value. An option that names a file has exactly one of them.
[[nodiscard]] CLI::Validator is_read();
[[nodiscard]] CLI::Validator is_written(Format format, Beside beside = Beside::kNothing);
[[nodiscard]] CLI::Validator is_written_folder();  // with a journal FOLDER.part

// Options whose value is FILE, with their mark.
template <class Target>
CLI::Option* add_read(CLI::App& app, const std::string& flag, Target& file, const std::string& meaning) {
  return app.add_option(flag, file, meaning)->type_name("FILE")->check(is_read());
}
template <class Target>
CLI::Option* add_written(CLI::App& app, const std::string& flag, Target& file, const std::string& meaning,
                         Format format, Beside beside = Beside::kNothing) {
  return app.add_option(flag, file, meaning)->type_name("FILE")->check(is_written(format, beside));
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
