// exactff point: the exact form factor from one receiver to one source, or to all.
#include <algorithm>
#include <array>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/exit_code.h"
#include "cli/output.h"
#include "exactff/adaptive.h"
#include "exactff/exact.h"
#include "exactff/receiver.h"
#include "exactff/study.h"
#include "exactff/version.h"
#include "exactff/visibility_svg.h"
#include "flags/engine.h"
#include "flags/scene.h"
#include "text/escape.h"
#include "text/json_document.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::cli {

namespace {

using text::shortest;

constexpr int kMostDigits = 10000;
constexpr std::uint64_t kMostLeaves = 10'000'000;  // takes some seconds
constexpr std::size_t kMostSharesComputed = 200;
constexpr std::size_t kMostSharesShown = 20;

using Triple = std::array<std::string, 3>;

struct PointArguments {
  flags::SceneArguments scene;
  Triple at;
  Triple normal;
  std::string on;
  std::vector<std::string> sources;
  std::vector<double> reflectance;
  int digits = 0;
  int precision_cap = ExactOptions{}.precision_cap;
  flags::EngineArgument engine;
  bool flip = false;
  bool fraction = false;
  bool exact_fraction = false;
  bool plain = false;
  bool json = false;
  bool explain = false;
  std::string svg;
  bool adaptive = false;
  AdaptiveOptions adaptive_options;
  std::string pattern = "jittered";
  std::string variant = "mended";
};

struct Share {
  FaceId face{};
  double alone = 0.0;  // the part of the unoccluded form factor that this occluder alone hides
};

struct SourceResult {
  Selection source;
  FormFactor exact;
  std::optional<double> unoccluded;
  std::vector<Share> shares;
  std::optional<AdaptiveResult> adaptive;
  double largest_rho_b = 0.0;
};

struct PointResult {
  Receiver receiver;
  Rgb reflectance;
  std::vector<SourceResult> sources;
  Enclosure sum;
  Rgb radiosity;  // sum over the sources of rho B F, an estimate in double
};

Vec3 to_vec3(const Triple& text, const std::string& flag) {
  return {parse_finite(text[0], flag), parse_finite(text[1], flag), parse_finite(text[2], flag)};
}

Receiver make_receiver(const PointArguments& args, const Scene& scene) {
  Receiver receiver{to_vec3(args.at, "--at"), to_vec3(args.normal, "--normal"), std::nullopt, ""};
  if (!args.on.empty()) receiver.on = select_face(scene, args.on);
  return receiver;
}

std::vector<Selection> make_sources(const PointArguments& args, const Scene& scene) {
  std::vector<Selection> sources;
  for (const std::string& name : args.sources) sources.push_back(scene.select(name));
  if (sources.empty()) sources = scene.emitters();
  if (sources.empty()) {
    throw InputError({.file = args.scene.path,
                      .what = "no patch of the scene emits (Ke is 0 everywhere)",
                      .why = "without --source, every emitting patch is a source",
                      .suggestion = "name a source with --source NAME; `exactff info` lists the names"});
  }
  if (args.plain && sources.size() != 1) {
    throw InputError({.file = {},
                      .what = "--plain prints one value, but there are " + std::to_string(sources.size()) + " sources",
                      .why = {},
                      .suggestion = "name one with --source NAME, or use --json"});
  }
  return sources;
}

Rgb make_reflectance(const PointArguments& args, const Scene& scene, const Receiver& receiver) {
  if (args.reflectance.empty()) return scene.receiver_reflectance(receiver.on);
  return {args.reflectance.front(), args.reflectance[args.reflectance.size() / 2], args.reflectance.back()};
}

void add_shares(const Scene& scene, const Receiver& receiver, const ExactSource& source, SourceResult& result) {
  const std::vector<FaceId> none;
  ExactOptions options{.only_occluders = &none};
  const double open = exact_form_factor(scene, receiver, source, options).value;
  result.unoccluded = open;
  if (open == 0.0) return;  // an underflow: there is nothing to compare with
  for (const FaceId face : result.exact.cutters) {
    if (result.shares.size() == kMostSharesComputed) break;
    const std::vector<FaceId> only{face};
    options.only_occluders = &only;
    result.shares.push_back({face, 1.0 - exact_form_factor(scene, receiver, source, options).value / open});
  }
  std::stable_sort(result.shares.begin(), result.shares.end(),
                   [](const Share& a, const Share& b) { return a.alone > b.alone; });
}

AdaptiveOptions adaptive_options(const PointArguments& args) {
  AdaptiveOptions options = args.adaptive_options;
  options.pattern = *study::pattern_named(args.pattern);
  options.variant = *study::variant_named(args.variant);
  options.record_leaves = !args.svg.empty();  // for the drawing only: there can be millions
  options.most_leaves = kMostLeaves;
  return options;
}

SourceResult compute_source(const PointArguments& args, const Scene& scene, const PointResult& point,
                            const ExactSource& source, const std::optional<AdaptiveSolver>& sampler) {
  SourceResult result{.source = source.selection(), .exact = {}, .unoccluded = {}, .shares = {}, .adaptive = {}};
  const ExactOptions options{.engine = args.engine.engine(),
                             .visible_fraction = args.fraction || args.exact_fraction,
                             .exact_fraction = args.exact_fraction,
                             .list_cutters = args.explain,
                             .digits = args.digits,
                             .precision_cap = args.precision_cap};
  result.exact = exact_form_factor(scene, point.receiver, source, options);
  const Rgb b = scene.source_radiosity(result.source);
  const Rgb& rho = point.reflectance;
  result.largest_rho_b = std::max({rho.r * b.r, rho.g * b.g, rho.b * b.b});
  if (args.explain) add_shares(scene, point.receiver, source, result);
  if (sampler) {
    result.adaptive = sampler->form_factor(point.receiver, result.source, result.largest_rho_b, adaptive_options(args));
  }
  return result;
}

void require_one(const std::vector<Selection>& sources, const std::string& picture) {
  if (sources.size() == 1) return;
  throw InputError({.file = picture,
                    .what = "--svg draws one source, but there are " + std::to_string(sources.size()),
                    .why = {},
                    .suggestion = "name one with --source NAME"});
}

PointResult compute(const PointArguments& args, const Scene& scene) {
  PointResult result{
      .receiver = make_receiver(args, scene), .reflectance = {}, .sources = {}, .sum = {}, .radiosity = {}};
  result.reflectance = make_reflectance(args, scene, result.receiver);
  std::optional<AdaptiveSolver> sampler;
  if (args.adaptive) sampler.emplace(scene);
  const std::vector<Selection> sources = make_sources(args, scene);
  if (!args.svg.empty()) require_one(sources, args.svg);
  for (const Selection& selection : sources) {
    const ExactSource source(scene, selection);
    SourceResult one = compute_source(args, scene, result, source, sampler);
    const Rgb b = scene.source_radiosity(selection);
    result.radiosity.r += result.reflectance.r * b.r * one.exact.value;
    result.radiosity.g += result.reflectance.g * b.g * one.exact.value;
    result.radiosity.b += result.reflectance.b * b.b * one.exact.value;
    result.sum += one.exact.enclosure;
    result.sources.push_back(std::move(one));
  }
  return result;
}

template <class Named>
std::string shown_name(const Scene& scene, const Named& named) {
  return text::printable(scene.name_of(named));
}

void warn_if_flipped(const Scene& scene, const PointResult& point) {
  for (const SourceResult& one : point.sources) {
    if (!behind_every_face(one.exact)) continue;
    std::cerr
        << "exactff: warning: the receiver is behind every face of '" << shown_name(scene, one.source)
        << "' (a source emits only from its front, so the form factor is 0); if its faces are flipped, use --flip\n";
  }
}

// A typing error in --at or --on would otherwise go unnoticed.
void warn_if_off_its_face(const Scene& scene, const Receiver& receiver) {
  constexpr double kFar = 0.01;
  if (!receiver.on) return;
  const double distance = relative_distance_from_face(scene, *receiver.on, receiver.point);
  if (distance <= kFar) return;
  std::cerr << "exactff: warning: --at is " << percent(distance) << " of the size of face '"
            << shown_name(scene, *receiver.on)
            << "' away from that face (a receiver on a face is neither occluded nor illuminated by it); check --at and "
               "--on\n";
}

void warn_of_missing_decimals(const PointArguments& args, const Scene& scene, const PointResult& point) {
  for (const SourceResult& one : point.sources) {
    if (args.digits == 0 || one.exact.status == Status::kZero || one.exact.enclosure.decimals(args.digits)) continue;
    std::cerr << "exactff: warning: " << args.digits << " significant digits of '" << shown_name(scene, one.source)
              << "' are not certified (the value may be a rounding tie, or --precision-cap is too low); the double is "
                 "printed instead\n";
  }
}

void warn_of_stopped_recursion(const Scene& scene, const PointResult& point) {
  for (const SourceResult& one : point.sources) {
    if (!one.adaptive || one.adaptive->leaves < kMostLeaves) continue;
    std::cerr << "exactff: warning: the adaptive recursion on '" << shown_name(scene, one.source) << "' stopped at "
              << one.adaptive->leaves
              << " leaves (its estimate is less accurate than the tolerance requires); use a larger "
              << "--eps-b\n";
  }
}

// --plain: "0" is a proved zero; a positive value that rounds to zero prints "0.0".
std::string plain_value(const FormFactor& result) {
  if (result.status == Status::kZero) return "0";
  if (result.status == Status::kUnderflow) return "0.0";
  return shortest(result.value);
}

std::string value_text(const FormFactor& result, int digits) {
  if (result.status == Status::kZero) return "0";
  if (digits > 0) {
    if (const std::optional<std::string> decimals = result.enclosure.decimals(digits)) return *decimals;
  }
  return plain_value(result);
}

std::string vec_text(const Vec3& v) { return "(" + shortest(v.x) + ", " + shortest(v.y) + ", " + shortest(v.z) + ")"; }

void print_stages(const Scene& scene, const SourceResult& one) {
  constexpr std::size_t kMostPlanes = 12;
  for (std::size_t p = 0; p < one.exact.planes.size() && p < kMostPlanes; ++p) {
    const PlaneRecord& plane = one.exact.planes[p];
    std::cout << "\n  plane of " << shown_name(scene, plane.faces.front());
    if (plane.faces.size() > 1) std::cout << " and " << plane.faces.size() - 1 << " more faces";
    std::cout << ": " << to_string(plane.outcome) << '\n';
    for (const StageNote& note : stages(plane)) {
      std::cout << "    " << pad(note.stage, 24) << pad(note.ran ? "ran" : "-", 5) << note.note << '\n';
    }
    if (plane.exact_fraction) std::cout << "    exact visible fraction  " << *plane.exact_fraction << '\n';
  }
  if (one.exact.planes.size() > kMostPlanes) {
    std::cout << "  ... and " << one.exact.planes.size() - kMostPlanes << " more planes (--json has them all)\n";
  }
}

void print_shares(const Scene& scene, const SourceResult& one) {
  const std::size_t cutters = one.exact.cutters.size();
  std::cout << "\n  occluders that hide a part of it: " << cutters << '\n';
  for (std::size_t i = 0; i < one.shares.size() && i < kMostSharesShown; ++i) {
    std::cout << "    " << pad(shown_name(scene, one.shares[i].face), 28) << "hides " << percent(one.shares[i].alone)
              << " alone\n";
  }
  if (cutters > kMostSharesShown) std::cout << "    ... and " << cutters - kMostSharesShown << " more\n";
  if (one.unoccluded) std::cout << "  unoccluded form factor: " << shortest(*one.unoccluded) << '\n';
  if (one.exact.precision_bits > 0) {
    std::cout << "  contour: " << one.exact.precision_bits
              << " bits were needed to decide the last bit of the double\n";
  }
}

void print_adaptive(const SourceResult& one) {
  const AdaptiveResult& a = *one.adaptive;
  std::cout << "  ray-sampled adaptive: " << shortest(a.form_factor) << " (error "
            << shortest(a.form_factor - one.exact.value) << ", " << a.leaves << " leaves, " << a.rays << " rays)\n";
}

void print_source(const PointArguments& args, const Scene& scene, const SourceResult& one) {
  std::cout << "source " << shown_name(scene, one.source) << '\n'
            << "  form factor  " << value_text(one.exact, args.digits) << "  (" << to_string(one.exact.status) << ")\n"
            << "  enclosure    [" << shortest(one.exact.lower) << ", " << shortest(one.exact.upper) << "]\n";
  if (one.exact.visible_fraction) {
    std::cout << "  visible      " << shortest(*one.exact.visible_fraction) << "  ("
              << to_string(*one.exact.visible_part) << " of it)\n";
  }
  if (one.adaptive) print_adaptive(one);
  if (!args.explain) return;
  print_stages(scene, one);
  print_shares(scene, one);
}

void print_table(const PointArguments& args, const Scene& scene, const PointResult& point) {
  std::cout << "receiver " << vec_text(point.receiver.point) << ", normal " << vec_text(point.receiver.normal);
  if (point.receiver.on) std::cout << ", on " << shown_name(scene, *point.receiver.on);
  std::cout << "\n\n";
  for (const SourceResult& one : point.sources) print_source(args, scene, one);
  if (point.sources.size() > 1) {
    const std::optional<double> nearest = point.sum.nearest();
    std::cout << "sum of " << point.sources.size() << " sources\n  form factor  "
              << (nearest ? shortest(*nearest) : "between the bounds") << "\n  enclosure    ["
              << shortest(point.sum.lower()) << ", " << shortest(point.sum.upper()) << "]\n";
  }
  std::cout << "\nradiosity received  " << shortest(point.radiosity.r) << ' ' << shortest(point.radiosity.g) << ' '
            << shortest(point.radiosity.b) << "  (reflectance x Ke of the source x form factor, per channel)\n";
}

nlohmann::ordered_json numbers_json(const Vec3& v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); }
nlohmann::ordered_json numbers_json(const Rgb& c) { return nlohmann::ordered_json::array({c.r, c.g, c.b}); }

nlohmann::ordered_json ball_json(const Enclosure& enclosure) {
  return {{"midpoint", enclosure.midpoint()}, {"radius", enclosure.radius()}};
}

nlohmann::ordered_json plane_json(const Scene& scene, const PlaneRecord& plane) {
  nlohmann::ordered_json faces = nlohmann::ordered_json::array();
  for (const FaceId face : plane.faces) faces.push_back(scene.name_of(face));
  nlohmann::ordered_json notes = nlohmann::ordered_json::array();
  for (const StageNote& note : stages(plane)) {
    notes.push_back({{"stage", note.stage}, {"ran", note.ran}, {"note", note.note}});
  }
  nlohmann::ordered_json json = {{"faces", faces},
                                 {"outcome", to_string(plane.outcome)},
                                 {"tree_candidates", plane.tree_candidates},
                                 {"candidates", plane.candidates},
                                 {"clipped", plane.clipped},
                                 {"loops", plane.loops},
                                 {"edges", plane.edges},
                                 {"stages", notes}};
  if (plane.visible_fraction) json["visible_fraction"] = *plane.visible_fraction;
  if (plane.exact_fraction) json["exact_fraction"] = *plane.exact_fraction;
  return json;
}

nlohmann::ordered_json adaptive_json(const AdaptiveResult& a) {
  nlohmann::ordered_json reasons;
  for (std::size_t i = 0; i < kLeafReasonCount; ++i) {
    reasons[std::string(to_string(static_cast<LeafReason>(i)))] = a.leaves_by_reason[i];
  }
  return {{"form_factor", a.form_factor}, {"leaves", a.leaves},          {"rays", a.rays},
          {"shaft_tests", a.shaft_tests}, {"leaves_by_reason", reasons}, {"leaves_by_depth", a.leaves_by_depth}};
}

nlohmann::ordered_json source_json(const PointArguments& args, const Scene& scene, const SourceResult& one) {
  nlohmann::ordered_json json = {{"source", scene.name_of(one.source)},
                                 {"value", one.exact.value},
                                 {"lower", one.exact.lower},
                                 {"upper", one.exact.upper},
                                 {"status", to_string(one.exact.status)},
                                 {"ball", ball_json(one.exact.enclosure)},
                                 {"bits", one.exact.precision_bits}};
  if (args.digits > 0) json["decimals"] = value_text(one.exact, args.digits);
  if (one.exact.visible_fraction) {
    json["visible_fraction"] = *one.exact.visible_fraction;
    json["visible_part"] = to_string(*one.exact.visible_part);
  }
  if (one.unoccluded) json["unoccluded"] = *one.unoccluded;
  if (args.explain) {
    json["cutters"] = nlohmann::ordered_json::array();
    for (const FaceId face : one.exact.cutters) json["cutters"].push_back(scene.name_of(face));
    json["shares_alone"] = nlohmann::ordered_json::array();
    for (const Share& share : one.shares) {
      json["shares_alone"].push_back({{"face", scene.name_of(share.face)}, {"share", share.alone}});
    }
  }
  json["planes"] = nlohmann::ordered_json::array();
  for (const PlaneRecord& plane : one.exact.planes) json["planes"].push_back(plane_json(scene, plane));
  if (one.adaptive) json["adaptive"] = adaptive_json(*one.adaptive);
  return json;
}

void print_json(const PointArguments& args, const Scene& scene, const PointResult& point) {
  nlohmann::ordered_json json = {{"program", "exactff"},
                                 {"version", kVersion},
                                 {"scene", args.scene.path},
                                 {"scene_hash", scene.hash()},
                                 {"receiver",
                                  {{"point", numbers_json(point.receiver.point)},
                                   {"normal", numbers_json(point.receiver.normal)},
                                   {"reflectance", numbers_json(point.reflectance)}}}};
  if (point.receiver.on) json["receiver"]["on"] = scene.name_of(*point.receiver.on);
  json["sources"] = nlohmann::ordered_json::array();
  for (const SourceResult& one : point.sources) json["sources"].push_back(source_json(args, scene, one));
  json["sum"] = {{"lower", point.sum.lower()}, {"upper", point.sum.upper()}, {"ball", ball_json(point.sum)}};
  json["radiosity"] = numbers_json(point.radiosity);
  std::cout << text::json_document(json) << '\n';
}

void write_svg(const PointArguments& args, const Scene& scene, const PointResult& point) {
  const SourceResult& one = point.sources.front();
  const std::span<const Leaf> leaves =
      one.adaptive ? std::span<const Leaf>(one.adaptive->leaf_list) : std::span<const Leaf>();
  const ExactSource source(scene, one.source);
  write_whole_file(args.svg, visibility_svg(scene, point.receiver, source, one.exact, leaves));
}

Scene load_scene(const PointArguments& args) {
  Scene scene = args.scene.load();
  print_warnings(scene.warnings());
  if (!args.flip) return scene;
  return scene.with_flipped(make_sources(args, scene));
}

int run(const PointArguments& args) {
  const Scene scene = load_scene(args);
  const PointResult point = compute(args, scene);
  warn_if_off_its_face(scene, point.receiver);
  warn_if_flipped(scene, point);
  warn_of_missing_decimals(args, scene, point);
  warn_of_stopped_recursion(scene, point);
  if (!args.svg.empty()) write_svg(args, scene, point);
  if (args.plain) {
    std::cout << (args.digits > 0 ? value_text(point.sources.front().exact, args.digits)
                                  : plain_value(point.sources.front().exact))
              << '\n';
  } else if (args.json) {
    print_json(args, scene, point);
  } else {
    print_table(args, scene, point);
  }
  check_output(std::cout);
  const bool certified = std::all_of(point.sources.begin(), point.sources.end(),
                                     [](const SourceResult& one) { return one.exact.status != Status::kNotCertified; });
  return certified ? 0 : kNotCertified;
}

// Otherwise, if numbers are missing, the flag that follows would be read as one of them.
std::string is_no_flag(const std::string& text) {
  return text.starts_with("--") ? "needs three numbers; found '" + text + "' among them" : "";
}

// A NaN passes every range check, since all its comparisons are false.
std::string is_a_number(const std::string& text) {
  return text::parse_number(text).fault == text::NumberFault::kNone ? ""
                                                                    : "'" + text + "' is not a finite decimal number";
}

std::string is_a_tolerance(const std::string& text) {
  const text::ParsedNumber number = text::parse_number(text);
  return number.fault == text::NumberFault::kNone && number.value >= 0.0
             ? ""
             : "'" + text + "' is not a finite decimal number of at least 0";
}

void add_receiver_flags(CLI::App& app, PointArguments& args) {
  app.add_option("--at", args.at, "The receiver's point")->required()->type_name("X Y Z")->check(is_no_flag);
  app.add_option("--normal", args.normal, "The receiver's normal, of any length except zero")
      ->required()
      ->type_name("NX NY NZ")
      ->check(is_no_flag);
  app.add_option("--on", args.on, "The receiver lies on this face, which then neither occludes nor illuminates it")
      ->type_name("NAME[:K]");
  app.add_flag("--flip", args.flip, "Flip the faces of the source, so that they emit from the other side");
  app.add_option("--source", args.sources, "Source patch or face (default: every emitting patch, and their sum)")
      ->type_name("NAME[:K]")
      ->delimiter(',');
  app.add_option(
         "--reflectance", args.reflectance,
         "Reflectance rho of the receiver, one or three values (default: Kd of the face of --on, or 1 without --on)")
      ->expected(1, 3)
      ->check(CLI::Range(0.0, 1.0))
      ->check(is_a_number);
}

void add_output_flags(CLI::App& app, PointArguments& args) {
  app.add_option("--digits", args.digits, "Number of significant digits to certify")->check(CLI::Range(1, kMostDigits));
  args.engine.add_to(app);
  app.add_option("--precision-cap", args.precision_cap, "Largest precision, in bits, of the contour integral")
      ->check(CLI::Range(32, 1 << 24))
      ->capture_default_str();
  app.add_flag("--fraction", args.fraction, "Also print the visible fraction of the source");
  app.add_flag("--exact-fraction", args.exact_fraction,
               "Print the visible fractions as exact rationals, one per plane of the source");
  auto* plain = app.add_flag("--plain", args.plain, "Print only the value: 0 is a proved zero, 0.0 an underflow");
  auto* json = app.add_flag("--json", args.json, "Print JSON");
  plain->excludes(json);
  app.add_flag("--explain", args.explain,
               "Show which stages ran, which were skipped and why, and the occluders that hide a part of the source");
  app.add_option("--svg", args.svg,
                 "Draw the source in its plane, with the shadows of the occluders and the visible region")
      ->type_name("FILE");
}

void add_adaptive_flags(CLI::App& app, PointArguments& args) {
  AdaptiveOptions& options = args.adaptive_options;
  app.add_flag("--adaptive", args.adaptive,
               "Also run Tampieri's ray-sampled adaptive algorithm; --svg then shows its leaves, the parts that it "
               "does not split further");
  app.add_option("--eps-b", options.eps_b, "Its tolerance eps_B, a radiosity for each leaf")
      ->capture_default_str()
      ->check(is_a_tolerance);
  app.add_option("--eps-a", options.eps_a, "Its tolerance eps_A, the area below which nothing is split")
      ->capture_default_str()
      ->check(is_a_tolerance);
  app.add_option("--rays", options.rays, "Its number of shadow rays per undecided leaf")
      ->capture_default_str()
      ->check(CLI::Range(1, 1 << 20));
  app.add_option("--seed", options.seed, "Its random seed")->capture_default_str();
  app.add_option("--pattern", args.pattern,
                 "Where in a leaf its rays end: jittered, centre, regular or low-discrepancy")
      ->type_name("NAME")
      ->capture_default_str()
      ->check([](const std::string& name) {
        return study::pattern_named(name)
                   ? ""
                   : "there is no pattern " + name + "; choose jittered, centre, regular or low-discrepancy";
      });
  app.add_option("--variant", args.variant,
                 "literal: the algorithm as printed in 1992; mended: with its faults corrected")
      ->type_name("NAME")
      ->capture_default_str()
      ->check([](const std::string& name) {
        return study::variant_named(name) ? "" : "there is no variant " + name + "; choose mended or literal";
      });
}

}  // namespace

Command add_point(CLI::App& app) {
  auto args = std::make_shared<PointArguments>();
  CLI::App* command =
      app.add_subcommand("point", "Compute the exact form factor from one receiver to one source, or to all sources");
  command->footer(
      "A receiver is a point with a normal. The form factor is the share of the diffuse light leaving the point that\n"
      "reaches the source directly. It is printed rounded to the nearest double, with its neighbours as bounds (the\n"
      "enclosure). It is certified if this rounding is proved. The exit code is 3 if a value is not certified within\n"
      "--precision-cap.\n"
      "\n"
      "Example:\n"
      "  exactff point data/scenes/cornell_box.obj --at 300 0 300 --normal 0 1 0 --on floor --source light --explain");
  args->scene.add_to(*command);
  add_receiver_flags(*command, *args);
  add_output_flags(*command, *args);
  add_adaptive_flags(*command, *args);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
