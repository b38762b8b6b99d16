// exactff point: the exact form factor from one receiver to one source, or to all.
#include "cli/point.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <span>
#include <utility>

#include "cli/commands.h"
#include "cli/output.h"
#include "cli/process.h"
#include "exactff/render.h"
#include "exactff/slips.h"
#include "kernel/vec.h"
#include "scene/selections.h"
#include "study/settings.h"
#include "text/escape.h"
#include "text/number_text.h"
#include "text/phrases.h"
#include "text/refuse.h"

namespace exactff::cli {

// --- One receiver ---

namespace {

std::vector<FaceId> own_faces(const std::string& on, const Scene& scene, const Receiver& receiver) {
  const auto automatic = flags::auto_face(on, scene);
  if (!automatic) return own_faces_named(scene, on);
  const double tolerance = automatic->tolerance.value_or(face_tolerance(scene, receiver.point));
  std::vector<FaceId> faces = find_faces(scene, receiver, tolerance).faces;
  if (!faces.empty()) return faces;
  text::refuse("--on " + on + ": no face lies within " + text::short_number(tolerance, 2) +
                   " of x with a normal within a degree of --normal",
               "the receiver would lie on no face",
               "check --at and --normal, or look further away with --on auto:DISTANCE");
}

void warn_of_own_face(const Scene& scene, const Receiver& receiver) {
  const NearMisses misses = near_misses(scene, std::span(&receiver, 1));
  const std::string own = '\'' + text::printable(scene.name_of(receiver.on)) + '\'';
  if (misses.turned > 0) {
    std::cerr << "exactff: warning: the normal points away from the front of " << own
              << ", so the receiver looks through its back\n";
  }
  if (misses.hidden > 0) {
    std::cerr << "exactff: warning: x lies on " << own
              << ", but behind another face that is nearly in its plane and hides everything; "
              << text::printable(misses.mends_hidden) << " lets light pass through it\n";
  }
}

// The first face in the direction of the normal, if the receiver looks at its back, squarely.
void warn_of_face_before(const Scene& scene, const Receiver& receiver, const std::function<bool()>& sees_no_front,
                         const std::function<std::string(const Receiver&)>& effect) {
  constexpr double kCosOfOneDegree = 0.99984;
  const auto hit = render::first_hit(scene, {receiver.point, kernel::unit(receiver.normal)});
  if (!hit || !hit->back) return;
  const Vec3 front = kernel::unit(scene.face(hit->face).newell);
  if (kernel::dot(front, kernel::unit(receiver.normal)) < kCosOfOneDegree || !sees_no_front()) return;
  const std::string change = effect({hit->point, receiver.normal, {hit->face}, ""});
  if (change.empty()) return;
  const std::string name = scene.name_of(hit->face);
  std::cerr << "exactff: warning: x lies " << text::short_number(kernel::distance(hit->point, receiver.point), 2)
            << " behind '" << text::printable(name) << "' and sees nothing but backs. On it, with --at";
  for (const double coordinate : {hit->point.x, hit->point.y, hit->point.z})
    std::cerr << ' ' << text::shortest(coordinate);
  std::cerr << " --on " << text::shell_word(name) << ", " << change << '\n';
}

}  // namespace

void OneReceiver::add_to(CLI::App& app) {
  flags::add_vector_option(app, "--at", at, "The receiver's point")->required();
  CLI::Option* direction =
      flags::add_vector_option(app, "--normal", normal, "The receiver's normal, of any length except zero", "NX NY NZ");
  app.add_flag(
         "--sphere", sphere,
         "Instead of --normal: the receiver is a small sphere, which sees all directions. The form factor is then "
         "the solid angle over 4 pi")
      ->excludes(direction);
  flags::add_value(app, "--on", on, "NAME[:K]",
                   "The receiver lies on this face, or on several (floor:1+2); faces exactly in their planes then "
                   "neither occlude nor illuminate it; auto or auto:DISTANCE finds them");
}

Receiver OneReceiver::make(const Scene& scene) const {
  if (!sphere && !flags::is_given(normal)) {
    text::refuse("--normal is required", "only what lies above the receiver's horizon counts",
                 "add --normal NX NY NZ, or --sphere for a receiver that sees all directions");
  }
  Receiver receiver{flags::vector_of(at, "--at"), sphere ? Vec3{} : flags::vector_of(normal, "--normal"), {}, ""};
  if (sphere && flags::auto_face(on, scene)) {
    text::refuse("--on " + on + " is given with --sphere", "it finds a face whose normal is the receiver's",
                 "name the face");
  }
  if (!on.empty()) receiver.on = own_faces(on, scene, receiver);
  return receiver;
}

void warn_of_turned_surfaces(const Scene& scene) {
  constexpr std::size_t kMostFaces = 1'000;
  if (scene.faces().size() <= kMostFaces) print_warnings(slips::warnings_of_turned_surfaces(scene));
}

bool sees_only_backs(const WholeView& seen) {
  const auto is_nothing = [](const SeenPatch& patch) { return patch.share.status == Status::kZero; };
  return std::ranges::all_of(seen.patches, is_nothing) && seen.back.status != Status::kZero;
}

void warn_if_off_its_face(const Scene& scene, const Receiver& receiver) {
  constexpr double kFar = 0.01;
  if (receiver.on.empty()) return;
  const double distance = relative_distance_from_face(scene, receiver.on.front(), receiver.point);
  if (distance <= kFar) return;
  std::cerr << "exactff: warning: --at is " << percent(distance) << " of the size of face '"
            << shown_name(scene, receiver.on.front())
            << "' away from that face (a receiver on a face is neither occluded nor illuminated by it); check --at and "
               "--on\n";
}

void warn_of_near_face(const Scene& scene, const Receiver& receiver, const std::function<bool()>& sees_no_front,
                       const std::function<std::string(const Receiver&)>& effect) {
  if (receiver.normal == Vec3{}) return;  // a sphere, which sees both sides of everything
  if (!receiver.on.empty()) return warn_of_own_face(scene, receiver);
  const NearFaces near = find_faces(scene, receiver, face_tolerance(scene, receiver.point));
  if (near.faces.empty()) return warn_of_face_before(scene, receiver, sees_no_front, effect);
  if (near.side == 0) return;
  const std::string name = scene.name_of(near.faces);
  const bool looks_through = (near.side < 0) != near.turned;
  Receiver there = receiver;
  there.on = near.faces;
  const std::string change = effect(there);
  std::cerr << "exactff: " << (looks_through ? "warning" : "note") << ": x lies "
            << text::short_number(near.distance, 2) << (near.side < 0 ? " behind '" : " in front of '")
            << text::printable(name) << '\'' << (near.turned ? ", turned against its front" : "")
            << (looks_through ? ", which then hides everything beyond it" : "");
  if (!change.empty()) std::cerr << ". With --on " << text::shell_word(name) << ' ' << change;
  std::cerr << '\n';
}

// --- Point ---

namespace {

// --- values ---

constexpr std::size_t kMostSharesComputed = 200;

std::vector<Selection> make_sources(const PointArguments& args, const Scene& scene) {
  std::vector<Selection> sources = flags::sources_of({args.sources}, scene);
  if (sources.empty()) sources = scene.emitters();
  if (sources.empty()) {
    text::refuse(args.scene.path, "no patch of the scene emits (Ke is 0 everywhere)",
                 "without --source, every emitting patch is a source",
                 "name a source with --source NAME; `exactff info` lists the names");
  }
  if (args.plain && sources.size() != 1) {
    text::refuse(fmt::format("--plain prints one value, but there are {} sources", sources.size()), {},
                 "name one with --source NAME, or use --json");
  }
  return sources;
}

Rgb make_reflectance(const PointArguments& args, const Scene& scene, const Receiver& receiver) {
  if (args.reflectance.empty()) return scene.receiver_reflectance(receiver.on);
  return {args.reflectance.front(), args.reflectance[args.reflectance.size() / 2], args.reflectance.back()};
}

void add_shares(const Scene& scene, const PointResult& point, const ExactSource& source, PointTerm& result) {
  const Receiver& receiver = point.receiver;
  const std::vector<FaceId> none;
  ExactOptions options{.measure = point.measure, .only_occluders = &none};
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
                   [](const PointTerm::Share& a, const PointTerm::Share& b) { return a.alone > b.alone; });
}

// Whether one sweep finds all that is printed, in less time than one patch after another. It says nothing of how a
// value was found, and nothing about transparent patches.
bool one_sweep_will_do(const PointArguments& args, const Scene& scene, const std::vector<Selection>& sources) {
  constexpr std::size_t kFewestFaces = 400;
  const bool shows_more =
      args.fraction || args.gradient || args.exact_fraction || args.explain || args.json || !args.svg.empty();
  const bool every_patch = flags::names_all(scene, args.sources) &&
                           std::ranges::none_of(sources, [](const Selection& s) { return s.face.has_value(); });
  return every_patch && !shows_more && scene.faces().size() >= kFewestFaces && scene.transparent().empty() &&
         args.engine.engine() == Engine::kEdges;
}

// The form factor of a patch in the whole view, which lists those above 0.
FormFactor factor_in_view(const WholeView& seen, const Selection& source) {
  const auto found = std::ranges::lower_bound(seen.patches, source.patch, {}, &SeenPatch::patch);
  if (found == seen.patches.end() || found->patch != source.patch) return {};
  return as_form_factor(found->form_factor);
}

// Whether the sum of all form factors counts a part of the view twice.
bool has_stacked(const PointArguments& args, const Scene& scene, const PointResult& point) {
  const auto is_stacked = [](const SeenPatch& patch) { return patch.share.value != patch.form_factor.value; };
  const auto some = [&](const WholeView& seen) { return std::ranges::any_of(seen.patches, is_stacked); };
  return some(point.seen ? *point.seen : view(scene, point.receiver, {.precision_cap = args.precision.cap}));
}

std::optional<Vec3> direction_of(const PointArguments& args) {
  return flags::is_given(args.along) ? std::optional(flags::vector_of(args.along, "--along")) : std::nullopt;
}

FormFactor exact_value(const PointArguments& args, const Scene& scene, const PointResult& point,
                       const ExactSource& source) {
  if (point.seen) return factor_in_view(*point.seen, source.selection());
  const ExactOptions options{.engine = args.engine.engine(),
                             .measure = point.measure,
                             .visible_fraction = args.fraction || args.exact_fraction,
                             .exact_fraction = args.exact_fraction,
                             .list_cutters = args.explain || !args.svg.empty(),
                             .gradient = args.gradient,
                             .list_arcs = args.gradient && args.explain,
                             .vertices = args.vertices,
                             .along = direction_of(args),
                             .digits = args.precision.digits,
                             .precision_cap = args.precision.cap};
  return exact_form_factor(scene, point.receiver, source, options);
}

PointTerm compute_source(const PointArguments& args, const Scene& scene, const PointResult& point,
                         const ExactSource& source) {
  PointTerm result{.source = source.selection(), .emits = emits(scene, source.selection())};
  result.exact = exact_value(args, scene, point, source);
  const Rgb b = scene.source_radiosity(result.source);
  const Rgb& rho = point.reflectance;
  const double f = result.exact.value;
  result.radiosity = {rho.r * b.r * f, rho.g * b.g * f, rho.b * b.b * f};
  if (args.explain) add_shares(scene, point, source, result);
  return result;
}

// Of all sources, by the method of --method.
void add_estimates(const PointArguments& args, const Scene& scene, const std::vector<Selection>& sources,
                   PointResult& result) {
  const methods::Choice choice = methods::parse(args.method);
  const study::PreparedMethod prepared(*choice.method, scene, sources);
  study::ReadySetting setting(prepared, choice.settings);
  methods::RecursionEvaluator* const recursion = setting.recursion();
  if (recursion != nullptr) {
    recursion->stop_at(kMostPointLeaves);
    recursion->keep_results(!args.svg.empty(), kMostDrawnLeaves);  // for the drawing only: there can be millions
  }
  const std::span<const methods::Estimate> estimates = setting.look_from(result.receiver);
  for (std::size_t s = 0; s < sources.size(); ++s) result.sources[s].estimate = estimates[s];
  if (recursion == nullptr) return;
  std::vector<AdaptiveResult> results = recursion->take_results();
  for (std::size_t s = 0; s < results.size(); ++s) result.sources[s].adaptive = std::move(results[s]);
}

void add(Rgb& sum, const Rgb& part) { sum = {sum.r + part.r, sum.g + part.g, sum.b + part.b}; }

// Sources that emit nothing count with a radiosity of 1, which cannot be added to the radiosity of lamps.
void add_up(PointResult& result) {
  for (const PointTerm& one : result.sources) {
    result.sum += one.exact.enclosure;
    if (one.emits) {
      ++result.emitters;
      result.sum_of_emitters += one.exact.enclosure;
      add(result.radiosity, one.radiosity);
    } else {
      add(result.radiosity_of_others, one.radiosity);
    }
  }
  if (result.emitters == 0) std::swap(result.radiosity, result.radiosity_of_others);
}

void require_one(const std::vector<Selection>& sources, const std::string& picture) {
  if (sources.size() == 1) return;
  text::refuse(picture, "--svg draws one source, but there are " + std::to_string(sources.size()), {},
               "name one with --source NAME");
}

PointResult compute_point(const PointArguments& args, const Scene& scene) {
  PointResult result{.receiver = args.receiver.make(scene),
                     .measure = args.measure.measure(args.up, args.receiver.sphere)};
  result.reflectance = make_reflectance(args, scene, result.receiver);
  const std::vector<Selection> sources = make_sources(args, scene);
  if (!args.svg.empty()) require_one(sources, args.svg);
  result.every_patch = flags::names_all(scene, args.sources);
  if (one_sweep_will_do(args, scene, sources)) {
    result.seen =
        view(scene, result.receiver,
             {.measure = result.measure, .digits = args.precision.digits, .precision_cap = args.precision.cap});
  }
  for (const Selection& selection : sources) {
    const ExactSource source(scene, selection);
    result.sources.push_back(compute_source(args, scene, result, source));
  }
  if (!args.method.empty()) add_estimates(args, scene, sources, result);
  add_up(result);
  result.stacked = result.every_patch && result.measure.is_form_factor() && has_stacked(args, scene, result);
  return result;
}

// --- the face that the receiver was probably meant to lie on ---

// "the form factor of 'light' is 0.0179 instead of 0". Empty if none changes.
std::string effect_of(const Scene& scene, const PointResult& point, const Receiver& receiver) {
  std::string text;
  for (const PointTerm& one : point.sources) {
    const FormFactor there =
        exact_form_factor(scene, receiver, ExactSource(scene, one.source), {.measure = point.measure});
    if (there.value == one.exact.value) continue;
    text += fmt::format("{} '{}' is {} instead of {}",
                        text.empty() ? "the " + flags::words_of(point.measure) + " of" : ", of",
                        shown_name(scene, one.source), text::shortest(there.value), text::shortest(one.exact.value));
  }
  return text;
}

// Says on stderr that x lies near a face that is not its own, and what would follow if it were.
void warn_of_face_nearby(const Scene& scene, const PointResult& point) {
  const auto sees_no_front = [&] {
    const auto is_zero = [](const PointTerm& one) { return one.exact.status == Status::kZero; };
    return std::ranges::all_of(point.sources, is_zero) && sees_only_backs(view(scene, point.receiver));
  };
  warn_of_near_face(scene, point.receiver, sees_no_front,
                    [&](const Receiver& there) { return effect_of(scene, point, there); });
}

// --- flags and warnings ---

void warn_if_flipped(const Scene& scene, const PointResult& point) {
  for (const PointTerm& one : point.sources) {
    if (!behind_every_face(one.exact)) continue;
    const std::string advice = slips::advice_to_flip(scene, std::span(&one.source, 1));
    std::cerr << "exactff: warning: the receiver is behind every face of '" << shown_name(scene, one.source)
              << "' (a source emits only from its front, so the form factor is 0)"
              << (advice.empty() ? "" : "; if the other side is meant, " + text::printable(advice)) << '\n';
  }
}

void warn_of_missing_decimals(const PointArguments& args, const Scene& scene, const PointResult& point) {
  for (const PointTerm& one : point.sources) {
    if (args.precision.digits == 0 || one.exact.status == Status::kZero ||
        one.exact.enclosure.decimals(args.precision.digits))
      continue;
    std::cerr << "exactff: warning: " << args.precision.digits << " significant digits of '"
              << shown_name(scene, one.source)
              << "' are not certified (the value may be a rounding tie, or --precision-cap is too low); the double is "
                 "printed instead\n";
  }
}

void warn_of_stopped_recursion(const Scene& scene, const PointResult& point) {
  for (const PointTerm& one : point.sources) {
    if (!one.adaptive || one.adaptive->leaves < kMostPointLeaves) continue;
    std::cerr << "exactff: warning: the adaptive recursion on '" << shown_name(scene, one.source) << "' stopped at "
              << one.adaptive->leaves
              << " leaves (its estimate is less accurate than the tolerance requires); use a larger eps_B\n";
  }
}

std::vector<std::string> given(const CLI::App& command, std::initializer_list<const char*> flags) {
  std::vector<std::string> found;
  for (const char* flag : flags) {
    if (command.get_option(flag)->count() > 0) found.emplace_back(flag);
  }
  return found;
}

void refuse_along_without_gradient(const PointArguments& args) {
  if (args.gradient) return;
  if (args.vertices) {
    text::refuse("--vertices is given without --gradient", "it adds the derivatives by the vertices of the scene",
                 "add --gradient, or remove it");
  }
  if (!flags::is_given(args.along)) return;
  text::refuse("--along is given without --gradient", "it names the direction of a one-sided derivative",
               "add --gradient, or remove it");
}

// What is known of the form factor alone.
void refuse_with_another_measure(const CLI::App& command, const PointArguments& args) {
  if (args.measure.name == "form-factor" && !args.receiver.sphere) return;
  std::vector<std::string> idle = given(command, {"--gradient", "--method"});
  if (args.receiver.sphere) {
    for (std::string& flag : given(command, {"--svg", "--reflectance"})) idle.push_back(std::move(flag));
  }
  if (idle.empty()) return;
  text::refuse(text::enumerate(idle) + (idle.size() == 1 ? " is" : " are") + " given with " +
                   (args.receiver.sphere ? "--sphere" : "--measure " + args.measure.name),
               "this is known of the form factor to a surface alone", "leave it out, or ask for the form factor");
}

// These change nothing that is printed. A script may give them all the same.
void warn_of_idle_options(const CLI::App& command, const PointArguments& args) {
  if (!args.plain) return;
  std::vector<std::string> idle =
      given(command, {"--fraction", "--exact-fraction", "--explain", "--along", "--vertices", "--reflectance"});
  if (!args.method.empty() && args.svg.empty()) idle.emplace_back("--method");  // else its leaves are drawn
  if (idle.empty()) return;
  std::cerr << "exactff: warning: " << text::enumerate(idle) << (idle.size() == 1 ? " has" : " have")
            << " no effect here (--plain prints the value alone; remove --plain, or use --json)\n";
}

// A derivative whose ball contains 0 is a result.
bool is_certified(const FormFactor& f) {
  const auto is_open = [](const Derivative& d) { return d.status == DerivativeStatus::kEnclosed && d.value != 0.0; };
  const auto is_open_vertex = [&](const VertexDerivative& v) { return std::ranges::any_of(v.position, is_open); };
  if (f.gradient &&
      (std::ranges::any_of(f.gradient->vertices, is_open_vertex) ||
       std::ranges::any_of(f.gradient->position, is_open) || std::ranges::any_of(f.gradient->normal, is_open) ||
       (f.gradient->along && is_open(*f.gradient->along)))) {
    return false;
  }
  return f.status != Status::kNotCertified;
}

int run(const CLI::App& command, const PointArguments& args) {
  refuse_along_without_gradient(args);
  refuse_with_another_measure(command, args);
  warn_of_idle_options(command, args);
  const Scene scene = args.scene.load();
  print_warnings(scene.warnings());
  const PointResult point = compute_point(args, scene);
  warn_if_off_its_face(scene, point.receiver);
  warn_of_face_nearby(scene, point);
  warn_if_flipped(scene, point);
  const auto is_zero = [](const PointTerm& one) { return one.exact.status == Status::kZero; };
  if (std::ranges::all_of(point.sources, is_zero)) warn_of_turned_surfaces(scene);
  warn_of_missing_decimals(args, scene, point);
  warn_of_stopped_recursion(scene, point);
  if (!args.svg.empty()) draw_point(args, scene, point);
  if (args.plain) {
    std::cout << (args.gradient               ? plain_gradient(point.sources.front().exact)
                  : args.precision.digits > 0 ? value_text(point.sources.front().exact, args.precision.digits)
                                              : plain_value(point.sources.front().exact))
              << '\n';
  } else if (args.json) {
    print_point_json(args, scene, point);
  } else {
    print_point_table(args, scene, point);
  }
  check_output(std::cout);
  const bool certified = std::all_of(point.sources.begin(), point.sources.end(),
                                     [](const PointTerm& one) { return is_certified(one.exact); });
  return certified ? 0 : kNotAsAsked;
}

// A NaN passes every range check, since all its comparisons are false.
std::string is_a_number(const std::string& text) {
  return text::parse_number(text).fault == text::NumberFault::kNone ? ""
                                                                    : "'" + text + "' is not a finite decimal number";
}

void add_receiver_flags(CLI::App& app, PointArguments& args) {
  args.receiver.add_to(app);
  flags::add_value(app, "--source", args.sources, "NAME[:K]",
                   std::string("Source patch or face") + flags::kNamesHelp +
                       "; all: a table of every patch, with the sum and what is missing to 1 (default: every emitting "
                       "patch, and their sum)");
  app.add_option(
         "--reflectance", args.reflectance,
         "Reflectance rho of the receiver, one or three values (default: Kd of the face of --on, or 1 without --on)")
      ->expected(1, 3)
      ->check(CLI::Range(0.0, 1.0))
      ->check(is_a_number);
}

void add_output_flags(CLI::App& app, PointArguments& args) {
  args.precision.add_to(app);
  args.engine.add_to(app);
  args.measure.add_to(app);
  flags::add_vector_option(app, "--up", args.up, "Of --measure overcast: where the zenith is (default: 0 0 1)");
  app.add_flag("--fraction", args.fraction, "Also print the visible fraction of the source");
  app.add_flag("--exact-fraction", args.exact_fraction,
               "Also print the visible fractions as exact rationals, one per plane of the source");
  app.add_flag("--gradient", args.gradient,
               "Also print dF/dx, dF/dy, dF/dz, per unit of length, and the vector V with F = n . V / |n|; where the "
               "derivative does not exist (a kink), the reason. With --plain: one line of value and derivatives, or of "
               "value and the word kink, separated by tabs");
  app.add_flag("--vertices", args.vertices,
               "With --gradient: also the derivatives by the coordinates of every vertex that moves the visible "
               "boundary, per unit of length. Vertices at equal coordinates move together");
  flags::add_vector_option(app, "--along", args.along,
                           "With --gradient: also the one-sided derivative if the point moves in this direction, per "
                           "unit of length. It exists at most kinks",
                           "DX DY DZ");
  auto* plain = app.add_flag("--plain", args.plain, "Print only the value: 0 is a proved zero, 0.0 an underflow");
  auto* json = app.add_flag("--json", args.json, "Print JSON");
  plain->excludes(json);
  app.add_flag("--explain", args.explain,
               "Show which stages ran, which were skipped and why, and the occluders that hide a part of the source");
  flags::add_written(app, "--svg", args.svg,
                     "Draw the source in its plane, with the shadows of the occluders and the visible region",
                     flags::Format::kSvg);
  flags::add_value(app, "--method", args.method, "METHOD",
                   "Also compute the value by this method, such as adaptive:eps_B=0.01,rays=16. With adaptive, --svg "
                   "shows its leaves, the parts that it does not split further");
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
  return {command, [command, args] { return run(*command, *args); }};
}

}  // namespace exactff::cli
