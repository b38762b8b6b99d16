// exactff convert: writes a scene, or a table, in another format.
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/output.h"
#include "exactff/scene_files.h"
#include "exactff/table.h"
#include "files/file.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::cli {
namespace {

constexpr const char* kConvertFooter =
    "The extension of OUT says what is written: .obj (with .mtl), .ply, .stl, .off or .vs3 (View3D). Doubles are "
    "kept,\n"
    "except in binary STL. What the format does not hold (names, materials, colours, holes, polygons) is listed as\n"
    "warnings before anything is written. Where faces are cut into smaller ones, at their own vertices, form factors "
    "do\n"
    "not change. A file appears complete or not at all.\n"
    "--divide LENGTH cuts faces into cells, each a patch NAME:k of its own. All faces along an edge share its points, "
    "so\n"
    "closed surfaces stay closed. Corners are rounded to doubles; how far they are off at most is printed. Cells that "
    "are\n"
    "not exactly planar then are cut into triangles.\n"
    "--triangulate cuts all faces into triangles. A face that is not exactly planar becomes the triangles that "
    "exactff\n"
    "takes it for.\n"
    "A table that exactff wrote becomes .csv, .npz (a NumPy archive with an array for each\n"
    "column, and the head) or .jsonl (JSON lines, the first of which is the head).\n"
    "\n"
    "Example:\n"
    "  exactff convert room.obj room.ply\n"
    "  exactff convert @teapot:segments=4 teapot.stl\n"
    "  exactff convert data/scenes/cornell_box.obj cells.obj --divide 50\n"
    "  exactff convert truth.csv truth.npz";

struct ConvertArguments {
  flags::SceneArguments scene;
  std::string out;
  std::string encoding;
  bool triangulate = false;
  bool force = false;

  [[nodiscard]] Scene load() const { return triangulate ? triangulated(scene.load()) : scene.load(); }
  [[nodiscard]] Encoding chosen_encoding() const {
    return encoding.empty() ? Encoding::kDefault : encoding == "text" ? Encoding::kText : Encoding::kBinary;
  }
};

// What the input is decides what may be written.
int convert_table(const ConvertArguments& args) {
  const std::filesystem::path out = args.out;
  const std::string extension = out.extension().string();
  if (extension != ".csv" && extension != ".npz" && extension != ".jsonl") {
    text::refuse(out, "cannot hold a table", args.scene.path + " is a table", "name a file .csv, .npz or .jsonl");
  }
  if (args.triangulate || args.scene.divide || !args.encoding.empty()) {
    text::refuse(std::filesystem::path(args.scene.path), "is a table, and flags for scenes are given",
                 "a table has no faces", "leave them out");
  }
  files::require_not_read(out, std::vector<std::filesystem::path>{args.scene.path});
  table::write(table::read(args.scene.path), out);
  std::cout << "wrote " << text::printable(args.out) << '\n';
  check_output(std::cout);
  return 0;
}

int run(const ConvertArguments& args) {
  require_free_file(args.out, args.force);  // checked before anything that takes time
  if (!table::kind_of(args.scene.path).empty()) return convert_table(args);
  const Scene scene = args.load();
  print_warnings(scene.warnings());
  const SceneFiles result = scene_files(scene, args.out, args.chosen_encoding());
  for (const SceneFiles::File& file : result.files) require_free_file(file.path, args.force);
  print_warnings(result.losses);
  write_scene_files(result);
  for (const SceneFiles::File& file : result.files)
    std::cout << "wrote " << text::printable(file.path.string()) << '\n';
  check_output(std::cout);
  return 0;
}

}  // namespace

Command add_convert(CLI::App& app) {
  auto args = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand("convert", "Write a scene, or a table, in another format");
  args->scene.add_to(*command);
  args->scene.add_divide_to(*command);
  command
      ->add_option("OUT", args->out, "File to write: .obj, .ply, .stl, .off or .vs3; of a table: .csv, .npz or .jsonl")
      ->required()
      ->check(flags::is_written(flags::Format::kScene, flags::Beside::kMaterials));
  command->add_flag("--triangulate", args->triangulate, "Cut all faces into triangles, at their own vertices");
  command->add_option("--encoding", args->encoding, "Form of PLY (otherwise binary) and STL (otherwise text)")
      ->check(CLI::IsMember({"text", "binary"}));
  command->add_flag("--force", args->force, "Replace existing files");
  command->footer(kConvertFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
