// exactff convert: writes a scene, or a table, in another format.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/output.h"
#include "exactff/scene_files.h"
#include "exactff/table.h"
#include "files/file.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "scene/selections.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "text/text_lines.h"

namespace exactff::cli {
namespace {

constexpr const char* kConvertFooter =
    "The extension of OUT says what is written: .obj (with .mtl), .ply, .stl, .off or .vs3 (View3D). Doubles are\n"
    "kept, except in binary STL. What the format does not hold (names, materials, colours, holes, polygons) is listed\n"
    "as warnings before anything is written. Where faces are cut into smaller ones, at their own vertices, form\n"
    "factors do not change. A file appears complete or not at all.\n"
    "--divide LENGTH cuts faces into cells, each a patch NAME:k of its own. All faces along an edge share its points,\n"
    "so closed surfaces stay closed. Corners are rounded to doubles; how far they are off at most is printed. Cells\n"
    "that are not exactly planar then are cut into triangles.\n"
    "--weld LENGTH makes one corner of those that are linked by distances of at most LENGTH, so that walls that miss\n"
    "each other by roundings close. Each coordinate is the median of theirs. Edges almost along an axis become\n"
    "parallel to it, and open edges get the corners of others that they pass. What moved, vanished, closed or stays\n"
    "bent is printed; faces that lie closer than LENGTH, face to face, are named and stay two. Welding twice changes\n"
    "nothing. `exactff info` measures the length that closes a scene.\n"
    "--triangulate cuts all faces into triangles. A face that is not exactly planar becomes the triangles that\n"
    "exactff takes it for.\n"
    "A table that exactff wrote becomes .csv, .npz (a NumPy archive with an array for each\n"
    "column, and the head) or .jsonl (JSON lines, the first of which is the head).\n"
    "\n"
    "Example:\n"
    "  exactff convert room.obj room.ply\n"
    "  exactff convert @teapot:segments=4 teapot.stl\n"
    "  exactff convert data/scenes/cornell_box.obj cells.obj --divide 50\n"
    "  exactff convert office.obj closed.obj --weld 1e-5\n"
    "  exactff convert truth.csv truth.npz";

struct ConvertArguments {
  flags::SceneArguments scene;
  std::string out;
  std::string encoding;
  std::optional<double> weld;
  bool triangulate = false;
  bool force = false;

  [[nodiscard]] Encoding chosen_encoding() const {
    return encoding.empty() ? Encoding::kDefault : encoding == "text" ? Encoding::kText : Encoding::kBinary;
  }
};

// What the input is decides what may be written.
int convert_table(const ConvertArguments& args) {
  const std::filesystem::path out = args.out;
  require_table_file(out);
  if (args.triangulate || args.weld || args.scene.divide || !args.encoding.empty()) {
    text::refuse(args.scene.path, "is a table, and flags for scenes are given", "a table has no faces",
                 "leave them out");
  }
  files::require_not_read(out, std::vector<std::filesystem::path>{args.scene.path});
  table::write(table::read(args.scene.path), out);
  std::cout << "wrote " << text::printable(args.out) << '\n';
  check_output(std::cout);
  return 0;
}

// "a, b and 12 more".
std::string listed_faces(const Scene& scene, const std::vector<FaceId>& faces) {
  constexpr std::size_t kShown = 12;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(kShown, faces.size()); ++i)
    names.push_back(text::printable(scene.name_of(faces[i])));
  if (faces.size() > kShown) names.push_back(std::to_string(faces.size() - kShown) + " more");
  return text::enumerate(names);
}

void print_welding(const Scene& before, const WeldedScene& welded, double length) {
  const auto note = [](const std::string& text) { std::cerr << "note: " << text << '\n'; };
  note("welded within " + text::shortest(length) + ": " + text::counted(welded.corners_before, "corner") +
       (welded.corners == welded.corners_before ? ", each still apart" : " became " + std::to_string(welded.corners)) +
       (welded.largest_move == 0.0 ? "; none moved"
                                   : "; none moved by more than " + text::short_number(welded.largest_move)));
  if (welded.junctions > 0)
    note(text::counted(welded.junctions, "corner") + " added to faces on whose open edges they lie");
  if (!welded.vanished.empty())
    note(text::counted(welded.vanished.size(), "face") + " vanished: " + listed_faces(before, welded.vanished));
  const std::size_t open = welded.scene.open_edge_count();
  note("open edges: " + std::to_string(before.open_edge_count()) + " before, " + std::to_string(open) + " now" +
       (open == 0 ? "; the surface is closed" : ""));
  const auto is_bent = [](const Face& face) { return face.shape == FaceShape::kTriangulated; };
  if (const std::vector<FaceId> bent = faces_where(welded.scene, is_bent); !bent.empty())
    note(text::counted(bent.size(), "face") + (bent.size() == 1 ? " is" : " are") +
         " not exactly planar, and counted as triangles: " + listed_faces(welded.scene, bent));
  std::vector<Problem> warnings;
  for (const WeldedScene::Sheets& sheets : welded.sheets) {
    const std::string how = sheets.apart == 0.0 ? " now lie on each other"
                                                : " lie face to face, " + text::short_number(sheets.apart) + " apart";
    warnings.push_back({.what = text::in_quotes(welded.scene.name_of(sheets.one)) + " and " +
                                text::in_quotes(welded.scene.name_of(sheets.other)) + how,
                        .why = "faces that close to each other are not made one",
                        .suggestion = "remove one of them if only one is meant"});
  }
  print_warnings(warnings);
}

Scene loaded(const ConvertArguments& args) {
  flags::SceneArguments undivided = args.scene;
  const std::optional<double> length = std::exchange(undivided.divide, {});
  Scene scene = undivided.load();
  print_warnings(scene.warnings());
  if (args.weld) {
    WeldedScene welded = exactff::welded(scene, *args.weld);
    print_welding(scene, welded, *args.weld);
    scene = std::move(welded.scene);
  }
  if (length) scene = flags::divided_with_note(scene, *length);
  return args.triangulate ? triangulated(scene) : std::move(scene);
}

int run(const ConvertArguments& args) {
  require_free_file(args.out, args.force);  // checked before anything that takes time
  if (!table::kind_of(args.scene.path).empty()) return convert_table(args);
  const Scene scene = loaded(args);
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
  flags::add_value(*command, "--weld", args->weld, "LENGTH",
                   "Make one corner of those within this distance of each other, before anything is divided")
      ->check(flags::is_positive);
  command->add_flag("--triangulate", args->triangulate, "Cut all faces into triangles, at their own vertices");
  command->add_option("--encoding", args->encoding, "Form of PLY (otherwise binary) and STL (otherwise text)")
      ->check(CLI::IsMember({"text", "binary"}));
  command->add_flag("--force", args->force, "Replace existing files");
  command->footer(kConvertFooter);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
