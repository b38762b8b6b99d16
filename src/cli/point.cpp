// exactff point: the exact form factor from one receiver to one source, or to all.
#include "cli/point.h"

#include <algorithm>
#include <iostream>

#include "cli/command.h"
#include "cli/exit_code.h"
#include "cli/output.h"
#include "exactff/study.h"
#include "text/number_text.h"

namespace exactff::cli {

namespace {

constexpr int kMostDigits = 10000;

void warn_if_flipped(const Scene& scene, const PointResult& point) {
  for (const PointTerm& one : point.sources) {
    if (!behind_every_face(one.exact)) continue;
    std::cerr << "exactff: warning: the receiver is behind every face of '" << shown_name(scene, one.source)
              << "' (a source emits from its front only, so the form factor is 0); is it flipped? --flip turns it\n";
  }
}

// A typing error in --at or --on would otherwise go unnoticed.
void warn_if_off_its_face(const Scene& scene, const Receiver& receiver) {
  constexpr double kFar = 0.01;
  if (!receiver.on) return;
  const double distance = relative_distance_from_face(scene, *receiver.on, receiver.point);
  if (distance <= kFar) return;
  std::cerr
      << "exactff: warning: --at is " << percent(distance) << " of the size of face '"
      << shown_name(scene, *receiver.on)
      << "' away from it (that face neither occludes nor illuminates a receiver that lies on it); is it the right "
         "one?\n";
}

void warn_of_missing_decimals(const PointArguments& args, const Scene& scene, const PointResult& point) {
  for (const PointTerm& one : point.sources) {
    if (args.digits == 0 || one.exact.status == Status::kZero || one.exact.enclosure.decimals(args.digits)) continue;
    std::cerr << "exactff: warning: " << args.digits << " significant digits of '" << shown_name(scene, one.source)
              << "' are not certified (its value may be a tie there, or --precision-cap is too low); the double stands "
                 "in their place\n";
  }
}

void warn_of_stopped_recursion(const Scene& scene, const PointResult& point) {
  for (const PointTerm& one : point.sources) {
    if (!one.adaptive || one.adaptive->leaves < kMostPointLeaves) continue;
    std::cerr << "exactff: warning: the adaptive recursion on '" << shown_name(scene, one.source) << "' stopped at "
              << one.adaptive->leaves << " leaves (its estimate is rougher than the tolerance asks for); give a larger "
              << "--eps-b\n";
  }
}

int run(const PointArguments& args) {
  const Scene scene = load_point_scene(args);
  const PointResult point = compute_point(args, scene);
  warn_if_off_its_face(scene, point.receiver);
  warn_if_flipped(scene, point);
  warn_of_missing_decimals(args, scene, point);
  warn_of_stopped_recursion(scene, point);
  if (!args.svg.empty()) draw_point(args, scene, point);
  if (args.plain) {
    std::cout << (args.digits > 0 ? value_text(point.sources.front().exact, args.digits)
                                  : plain_value(point.sources.front().exact))
              << '\n';
  } else if (args.json) {
    print_point_json(args, scene, point);
  } else {
    print_point_table(args, scene, point);
  }
  check_output(std::cout);
  const bool certified = std::all_of(point.sources.begin(), point.sources.end(),
                                     [](const PointTerm& one) { return one.exact.status != Status::kNotCertified; });
  return certified ? 0 : kNotCertified;
}

// Otherwise, if numbers are missing, the flag that follows would be read as one of them.
std::string is_no_flag(const std::string& text) {
  return text.starts_with("--") ? "takes three numbers; found '" + text + "' among them" : "";
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
  app.add_option("--at", args.at, "Receiving point X Y Z")->required()->type_name("X Y Z")->check(is_no_flag);
  app.add_option("--normal", args.normal, "Its normal, of any length other than zero")
      ->required()
      ->type_name("NX NY NZ")
      ->check(is_no_flag);
  app.add_option("--on", args.on, "The receiver lies on this face: it neither occludes nor illuminates")
      ->type_name("NAME[:K]");
  app.add_flag("--flip", args.flip, "Turn the source's faces round: their fronts become their backs");
  app.add_option("--source", args.sources, "Source patch or face; default: every emitting patch, and their sum")
      ->type_name("NAME[:K]")
      ->delimiter(',');
  app.add_option("--reflectance", args.reflectance,
                 "rho of the receiver, one value or three; default: Kd of --on's face, else 1")
      ->expected(1, 3)
      ->check(CLI::Range(0.0, 1.0))
      ->check(is_a_number);
}

void add_output_flags(CLI::App& app, PointArguments& args) {
  app.add_option("--digits", args.digits, "Certified significant digits")->check(CLI::Range(1, kMostDigits));
  args.engine.add_to(app);
  app.add_option("--precision-cap", args.precision_cap, "Most bits that the contour may use")
      ->check(CLI::Range(32, 1 << 24))
      ->capture_default_str();
  app.add_flag("--fraction", args.fraction, "Visible fraction of the source too");
  app.add_flag("--exact-fraction", args.exact_fraction, "The same as exact rationals, plane by plane");
  auto* plain = app.add_flag("--plain", args.plain, "Print the value alone: 0 is a proved zero, 0.0 an underflow");
  auto* json = app.add_flag("--json", args.json, "Print JSON");
  plain->excludes(json);
  app.add_flag("--explain", args.explain,
               "Which stages ran, which were left out and why, and the occluders that cut the source");
  app.add_option("--svg", args.svg, "Draw the source in its plane, shadows and visible region")->type_name("FILE");
}

void add_adaptive_flags(CLI::App& app, PointArguments& args) {
  AdaptiveOptions& options = args.adaptive_options;
  app.add_flag("--adaptive", args.adaptive, "Run the ray-sampled adaptive algorithm too; --svg then shows its leaves");
  app.add_option("--eps-b", options.eps_b, "Its radiosity tolerance")->capture_default_str()->check(is_a_tolerance);
  app.add_option("--eps-a", options.eps_a, "Its area tolerance")->capture_default_str()->check(is_a_tolerance);
  app.add_option("--rays", options.rays, "Its shadow rays per sub-patch")
      ->capture_default_str()
      ->check(CLI::Range(1, 1 << 20));
  app.add_option("--seed", options.seed, "Its random seed")->capture_default_str();
  app.add_option("--pattern", args.pattern, "Where its rays end: jittered, centre, regular or low-discrepancy")
      ->type_name("NAME")
      ->capture_default_str()
      ->check([](const std::string& name) {
        return study::pattern_named(name)
                   ? ""
                   : "no such pattern: " + name + "; choose jittered, centre, regular or low-discrepancy";
      });
  app.add_option("--variant", args.variant, "mended, or literal: the listing as it was printed")
      ->type_name("NAME")
      ->capture_default_str()
      ->check([](const std::string& name) {
        return study::variant_named(name) ? "" : "no such variant: " + name + "; choose mended or literal";
      });
}

}  // namespace

Command add_point(CLI::App& app) {
  auto args = std::make_shared<PointArguments>();
  CLI::App* command = app.add_subcommand("point", "Exact form factor from one receiver to one source, or to all");
  command->footer(
      "The exit code is 3 if a value is not certified within --precision-cap.\n\n"
      "Example:\n"
      "  exactff point data/scenes/cornell_box.obj --at 300 0 300 --normal 0 1 0 --on floor --source light --explain");
  args->scene.add_to(*command);
  add_receiver_flags(*command, *args);
  add_output_flags(*command, *args);
  add_adaptive_flags(*command, *args);
  return {command, [args] { return run(*args); }};
}

}  // namespace exactff::cli
