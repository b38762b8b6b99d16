// exactff view: the whole view from one receiver.
#include "exactff/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/point.h"
#include "cli/process.h"
#include "exactff/render.h"
#include "exactff/scene_files.h"
#include "exactff/version.h"
#include "flags/scene.h"
#include "flags/values.h"
#include "table/rows.h"
#include "text/escape.h"
#include "text/names.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "vtk/vtk.h"
#include "whole_view/light.h"

namespace exactff::cli {

namespace {

constexpr const char* kBack = "(back)";
constexpr const char* kOpen = "(open)";
constexpr const char* kBuried = "(buried)";

struct ViewArguments {
  flags::SceneArguments scene;
  OneReceiver receiver;
  flags::MeasureArgument measure;
  flags::PrecisionArguments precision;
  std::string engine = "edges";
  bool plain = false;
  bool json = false;
  bool csv = false;
  std::string svg, projection = "nusselt", mesh;
  flags::ThreeNumbers up;
  bool force = false;
};

// Of the view it has less than its form factor.
bool is_stacked(const SeenPatch& patch) {
  return patch.share.value != patch.form_factor.value || patch.share.status != patch.form_factor.status;
}

// --- Output ---

std::string number(const ViewArguments& args, const ViewShare& share) {
  return args.precision.digits > 0 ? value_text(as_form_factor(share), args.precision.digits)
                                   : plain_value(as_form_factor(share));
}

template <class Visit>
void for_each_share(const Scene& scene, const WholeView& seen, const Visit& visit) {
  for (const SeenPatch& patch : seen.patches) visit(scene.patch(patch.patch).name, patch.share, &patch);
  visit(kBack, seen.back, static_cast<const SeenPatch*>(nullptr));
  visit(kOpen, seen.open, static_cast<const SeenPatch*>(nullptr));
  if (seen.buried_under) visit(kBuried, seen.buried, static_cast<const SeenPatch*>(nullptr));
}

// What is seen: the lines add up to 1.
void print_plain(const ViewArguments& args, const Scene& scene, const WholeView& seen) {
  for_each_share(scene, seen, [&](const std::string& name, const ViewShare& share, const SeenPatch* patch) {
    if (patch != nullptr && share.status == Status::kZero) return;
    std::cout << text::printable(name) << '\t' << number(args, share) << '\n';
  });
}

// A stacked patch has two values; the form factor is not 0.
std::string status_text(const SeenPatch& patch) {
  if (!is_stacked(patch)) return std::string(to_string(patch.share.status));
  const bool certified = patch.share.status != Status::kNotCertified;
  return std::string(to_string(certified ? patch.form_factor.status : patch.share.status)) + ", stacked";
}

// What all shares add up to.
std::string words_of_whole(const Measure& measure, const Receiver& receiver) {
  if (measure.kind == MeasureKind::kSolidAngle) return measure.sphere ? "4 pi" : "2 pi";
  const bool all_of_the_sky = measure.kind != MeasureKind::kOvercast || receiver.normal == measure.up;
  return all_of_the_sky ? "1" : "what x would receive of an open sky";
}

void print_table(const ViewArguments& args, const Scene& scene, const Receiver& receiver, const Measure& measure,
                 const WholeView& seen) {
  std::vector<const SeenPatch*> by_size;
  for (const SeenPatch& patch : seen.patches) by_size.push_back(&patch);
  std::ranges::stable_sort(by_size, std::ranges::greater{}, [](const SeenPatch* patch) { return patch->share.value; });
  const bool stacked = std::ranges::any_of(seen.patches, is_stacked);
  std::cout << "receiver " << text::printable(receiver_text(scene, receiver)) << "\n\n";
  TextTable table;
  table.add_column("patch");
  table.add_column(stacked ? "share of the view" : flags::words_of(measure));
  if (stacked) table.add_column(flags::words_of(measure));
  table.add_column("status");
  const auto add = [&](const std::string& name, const ViewShare& share, const SeenPatch* patch) {
    std::vector<std::string> cells{name, number(args, share)};
    if (stacked) cells.push_back(patch ? number(args, patch->form_factor) : "");
    cells.push_back(patch ? status_text(*patch) : std::string(to_string(share.status)));
    table.add_row(std::move(cells));
  };
  for (const SeenPatch* patch : by_size) add(scene.patch(patch->patch).name, patch->share, patch);
  add(kBack, seen.back, nullptr);
  add(kOpen, seen.open, nullptr);
  if (seen.buried_under) add(kBuried, seen.buried, nullptr);
  table.print(std::cout);
  if (seen.buried_under) {
    std::cout << "\nburied under " << text::printable(scene.name_of(*seen.buried_under))
              << ": a closed solid stands on the receiver's face there, so it sees nothing\n";
    return;
  }
  Enclosure fronts;
  for (const SeenPatch& patch : seen.patches) fronts += patch.share.enclosure;
  std::cout << "\nfronts  " << sum_words(fronts, args.precision.digits) << "  (of "
            << text::counted(seen.patches.size(), "patch", "patches")
            << "; with (back), backs of faces, and (open), directions that meet nothing: "
            << words_of_whole(measure, receiver) << ")\n";
  if (stacked) {
    std::cout << "stacked: in one plane with the front of another patch, which comes first in the file and has the "
                 "share of the view; each keeps its full form factor\n";
  }
}

// With --digits, numbers are the decimals that were asked for.
void print_csv(const ViewArguments& args, const Scene& scene, const Receiver& receiver, const Measure& measure,
               const WholeView& seen) {
  table::Head head;
  head.set("about", std::string("shares of what is seen, correctly rounded, between proved bounds"));
  if (!measure.is_form_factor()) head.set("measure", flags::words_of(measure));
  head.set("scene", args.scene.path);
  head.set("scene_hash", scene.hash());
  head.set("receiver", receiver_text(scene, receiver));
  const auto values = [&](std::string_view name) {
    return args.precision.digits > 0 ? table::texts(name) : table::numbers(name, table::Strength::kCertified);
  };
  table::Rows rows("view", std::move(head),
                   {table::keys("name"), values("share"), table::numbers("lower,upper", table::Strength::kProved),
                    table::texts("status", table::Strength::kProved), values("form_factor"), table::texts("stacked")});
  const auto put = [&](const ViewShare& share) {
    args.precision.digits > 0 ? rows << number(args, share) : rows << share.value;
  };
  for_each_share(scene, seen, [&](const std::string& name, const ViewShare& share, const SeenPatch* patch) {
    rows << text::printable(name);
    put(share);
    rows << share.lower << share.upper << to_string(share.status);
    if (patch == nullptr) {
      rows << std::optional<double>() << "";
    } else {
      put(patch->form_factor);
      rows << (is_stacked(*patch) ? "yes" : "no");
    }
  });
  std::cout << table::csv_text(rows.take());
}

nlohmann::ordered_json share_json(const ViewArguments& args, const ViewShare& share) {
  nlohmann::ordered_json json = {{"value", share.value},
                                 {"lower", share.lower},
                                 {"upper", share.upper},
                                 {"status", to_string(share.status)},
                                 {"ball", ball_json(share.enclosure)},
                                 {"bits", share.precision_bits}};
  if (args.precision.digits > 0) json["decimals"] = number(args, share);
  return json;
}

nlohmann::ordered_json regions_json(const Scene& scene, const VisibilityMesh& mesh) {
  auto json = nlohmann::ordered_json::array();
  for (const SeenRegion& region : mesh.regions) {
    nlohmann::ordered_json one = {{"face", scene.name_of(region.face)}};
    if (region.triangle > 0) one["triangle"] = region.triangle;
    one["front"] = region.front;
    one["fraction"] = region.fraction;
    json.push_back(std::move(one));
  }
  return json;
}

void print_json(const ViewArguments& args, const Scene& scene, const Receiver& receiver, const Measure& measure,
                const WholeView& seen, const std::optional<VisibilityMesh>& mesh) {
  nlohmann::ordered_json json = question_json(args.scene.path, scene, receiver, measure);
  if (!receiver.on.empty()) json["receiver"]["on"] = scene.name_of(receiver.on);
  json["patches"] = nlohmann::ordered_json::array();
  for (const SeenPatch& patch : seen.patches) {
    nlohmann::ordered_json one = {{"patch", scene.patch(patch.patch).name}};
    one.update(share_json(args, patch.share));
    if (is_stacked(patch)) {
      one["stacked"] = true;
      one["form_factor"] = share_json(args, patch.form_factor);
    }
    json["patches"].push_back(one);
  }
  json["back"] = share_json(args, seen.back);
  json["open"] = share_json(args, seen.open);
  if (seen.buried_under) {
    json["buried"] = share_json(args, seen.buried);
    json["buried_under"] = scene.name_of(*seen.buried_under);
  }
  const ViewRecord& work = seen.record;
  json["work"] = {{"outlines", work.outlines},   {"windows", work.windows}, {"pairs", work.pairs},
                  {"undecided", work.undecided}, {"pierced", work.pierced}, {"arcs", work.arcs}};
  if (mesh) json["regions"] = regions_json(scene, *mesh);
  std::cout << text::json_document(json) << '\n';
}

// --- Files ---

ViewPictureOptions picture_options(const ViewArguments& args, const Scene& scene) {
  ViewPictureOptions options{.up = render::upwards(scene)};
  if (args.projection == "fisheye") options.projection = ViewProjection::kFisheye;
  if (flags::is_given(args.up)) options.up = flags::vector_of(args.up, "--up");
  return options;
}

bool is_for_vtk(const std::filesystem::path& file) {
  const std::string extension = text::in_lower_case(file.extension().string());
  return extension == ".vtp" || extension == ".vtu";
}

void write_mesh(const ViewArguments& args, const Scene& scene, const VisibilityMesh& mesh) {
  const Scene triangles = to_scene(scene, mesh);
  if (mesh.flat > 0) {
    std::cerr << "exactff: warning: " << text::counted(mesh.flat, "triangle") << " of the mesh "
              << (mesh.flat == 1 ? "is" : "are") << " left out: rounding the corners leaves no area\n";
  }
  if (mesh.triangles.empty()) std::cerr << "note: the receiver sees nothing of the scene; the mesh is empty\n";
  if (is_for_vtk(args.mesh)) return vtk::write_faces(triangles, {}, {}, args.mesh);
  const SceneFiles result = scene_files(triangles, args.mesh);
  for (const SceneFiles::File& file : result.files) require_free_file(file.path, args.force);
  print_warnings(result.losses);
  write_scene_files(result);
}

void write_files(const ViewArguments& args, const Scene& scene, const Receiver& receiver,
                 const std::optional<VisibilityMesh>& mesh) {
  const std::string picture = args.svg.empty() ? "" : view_svg(scene, receiver, picture_options(args, scene));
  if (mesh) write_mesh(args, scene, *mesh);
  if (!args.svg.empty()) write_whole_file(args.svg, picture);
}

// "it sees 6 patches instead of 0", or the first share that differs. Empty if none does.
std::string change_of_view(const Scene& scene, const WholeView& here, const WholeView& there) {
  if (here.patches.size() != there.patches.size()) {
    return fmt::format("it sees {} instead of {}", text::counted(there.patches.size(), "patch", "patches"),
                       here.patches.size());
  }
  const auto change = [](const std::string& name, const ViewShare& a, const ViewShare& b) {
    if (a.value == b.value) return std::string();
    return fmt::format("{} is {} instead of {}", name, text::short_number(b.value), text::short_number(a.value));
  };
  std::vector<std::string> changes{change(kBack, here.back, there.back), change(kOpen, here.open, there.open)};
  for (std::size_t p = 0; p < here.patches.size(); ++p) {
    const SeenPatch &a = here.patches[p], &b = there.patches[p];
    changes.push_back(a.patch == b.patch ? change('\'' + scene.patch(a.patch).name + '\'', a.share, b.share)
                                         : "it sees '" + scene.patch(b.patch).name + "'");
  }
  const auto found = std::ranges::find_if(changes, [](const std::string& one) { return !one.empty(); });
  return found == changes.end() ? std::string() : *found;
}

void refuse_pictures_of_spheres(const ViewArguments& args) {
  if (!args.receiver.sphere || (args.svg.empty() && args.mesh.empty())) return;
  text::refuse(std::string(args.svg.empty() ? "--mesh" : "--svg") + " is given with --sphere",
               "it shows what lies above the horizon of a normal", "give --normal, once for each side");
}

int run(const ViewArguments& args) {
  refuse_pictures_of_spheres(args);
  if (!args.mesh.empty()) require_free_file(args.mesh, args.force);
  const Scene scene = args.scene.load();
  print_warnings(scene.warnings());
  const Receiver receiver = args.receiver.make(scene);
  const Measure measure = args.measure.measure(args.up, args.receiver.sphere);
  const ViewOptions options{.measure = measure, .digits = args.precision.digits, .precision_cap = args.precision.cap};
  const WholeView seen = view(scene, receiver, options);
  if (args.engine == "both") whole_view::require_agreement(scene, receiver, options, seen);
  std::optional<VisibilityMesh> mesh;
  if (!args.mesh.empty()) mesh = visibility_mesh(scene, receiver);
  write_files(args, scene, receiver, mesh);
  warn_if_off_its_face(scene, receiver);
  warn_of_near_face(
      scene, receiver, [&] { return sees_only_backs(seen); },
      [&](const Receiver& there) { return change_of_view(scene, seen, view(scene, there, options)); });
  if (seen.back.status != Status::kZero) warn_of_turned_surfaces(scene);
  if (args.plain) {
    print_plain(args, scene, seen);
  } else if (args.json) {
    print_json(args, scene, receiver, measure, seen, mesh);
  } else if (args.csv) {
    print_csv(args, scene, receiver, measure, seen);
  } else {
    print_table(args, scene, receiver, measure, seen);
  }
  check_output(std::cout);
  bool certified = true;
  for_each_share(scene, seen, [&](const std::string&, const ViewShare& share, const SeenPatch* patch) {
    certified = certified && share.status != Status::kNotCertified &&
                (patch == nullptr || patch->form_factor.status != Status::kNotCertified);
  });
  return certified ? 0 : kNotAsAsked;
}

void add_output_flags(CLI::App& app, ViewArguments& args) {
  args.precision.add_to(app);
  app.add_option("--engine", args.engine,
                 "edges: one sweep over all edges; both: also compare every patch with the per-source solver, by edges "
                 "and by Booleans; it does not affect the values")
      ->capture_default_str()
      ->check(CLI::IsMember({"edges", "both"}));
  args.measure.add_to(app);
  auto* plain = app.add_flag(
      "--plain", args.plain,
      "Print one line per patch that is seen: name, tab, share of the view; then (back), (open) and, of a buried "
      "receiver, (buried). The lines add up to 1. The share is the form factor, unless patches are stacked");
  auto* json = app.add_flag("--json", args.json, "Print JSON");
  auto* csv = app.add_flag("--csv", args.csv, "Print CSV");
  plain->excludes(json)->excludes(csv);
  json->excludes(csv);
}

void add_file_flags(CLI::App& app, ViewArguments& args) {
  CLI::Option* svg = flags::add_written(
      app, "--svg", args.svg, "Draw all that the receiver sees above its horizon, with its normal in the middle",
      flags::Format::kSvg);
  app.add_option("--projection", args.projection,
                 "nusselt: areas in the picture are form factors times pi; fisheye: stereographic, which keeps angles")
      ->capture_default_str()
      ->check(CLI::IsMember({"nusselt", "fisheye"}))
      ->needs(svg);
  CLI::Option* mesh = flags::add_written(app, "--mesh", args.mesh,
                                         "Write the visible regions in space, cut into triangles: .obj, .ply, .stl, "
                                         ".off, .vs3, .vtp or .vtu; --json then has their exact shares of the faces",
                                         flags::Format::kMesh, flags::Beside::kMaterials);
  app.add_flag("--force", args.force, "Replace an existing file of --mesh")->needs(mesh);
  flags::add_vector_option(app, "--up", args.up,
                           "The direction that points upwards: in the picture (default: 0 0 1 if more area of fronts "
                           "looks along +z than along +y; else 0 1 0), and to the zenith of --measure overcast "
                           "(default: 0 0 1)");
}

}  // namespace

Command add_view(CLI::App& app) {
  auto args = std::make_shared<ViewArguments>();
  CLI::App* command =
      app.add_subcommand("view", "Compute what one receiver sees in all directions: every patch's form factor");
  command->footer(
      "What is seen in a direction is the nearest face that is not the receiver's own; of faces in one plane a front\n"
      "before a back, and of several fronts the first in the file. The others are stacked: each keeps its full form\n"
      "factor. Fronts count for their patch, backs for (back), and directions that meet nothing for (open). Together\n"
      "they are exactly 1. A receiver on a part of a face that a closed solid stands on sees nothing: (buried) is 1.\n"
      " Patches that are not listed have a form factor of exactly 0; --plain leaves out stacked ones\n"
      "that are not seen. The exit code is 3 if a value is not certified within --precision-cap.\n"
      "\n"
      "Example:\n"
      "  exactff view data/scenes/cornell_box.obj --at 200 0 400 --normal 0 1 0 --on floor --svg view.svg");
  args->scene.add_to(*command);
  args->receiver.add_to(*command);
  add_output_flags(*command, *args);
  add_file_flags(*command, *args);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
