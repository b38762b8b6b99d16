// What exactff point prints and draws.
#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/output.h"
#include "cli/point.h"
#include "exactff/version.h"
#include "report/report.h"
#include "text/escape.h"
#include "text/number_text.h"
#include "text/phrases.h"

namespace exactff::cli {

using text::shortest;

nlohmann::ordered_json numbers_json(const Vec3& v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); }
nlohmann::ordered_json numbers_json(const Rgb& c) { return nlohmann::ordered_json::array({c.r, c.g, c.b}); }

nlohmann::ordered_json ball_json(const Enclosure& enclosure) {
  return {{"midpoint", enclosure.midpoint()}, {"radius", enclosure.radius()}};
}

nlohmann::ordered_json question_json(const std::string& path, const Scene& scene, const Receiver& receiver,
                                     const Measure& measure) {
  const bool sphere = receiver.normal == Vec3{};
  nlohmann::ordered_json json = {{"program", "exactff"},
                                 {"version", kVersion},
                                 {"scene", path},
                                 {"scene_hash", scene.hash()},
                                 {"receiver",
                                  {{"point", numbers_json(receiver.point)},
                                   {"normal", sphere ? nlohmann::ordered_json() : numbers_json(receiver.normal)}}}};
  if (!measure.is_form_factor()) json["measure"] = to_string(measure.kind);
  if (measure.kind == MeasureKind::kOvercast) json["up"] = numbers_json(measure.up);
  return json;
}

namespace {

std::string plain_derivative(const Derivative& d) {
  if (d.status == DerivativeStatus::kZero) return "0";
  return d.value == 0.0 ? "0.0" : shortest(d.value);
}

constexpr std::size_t kMostSharesShown = 20;

void print_stages(const Scene& scene, const PointTerm& one) {
  constexpr std::size_t kMostPlanes = 12;
  for (std::size_t p = 0; p < one.exact.planes.size() && p < kMostPlanes; ++p) {
    const PlaneRecord& plane = one.exact.planes[p];
    std::cout << "\n  plane of " << shown_name(scene, plane.faces.front());
    if (plane.faces.size() > 1) std::cout << " and " << plane.faces.size() - 1 << " more faces";
    std::cout << ": " << to_string(decided_outcome(plane)) << '\n';
    for (const StageNote& note : stages(plane)) {
      std::cout << "    " << pad(note.stage, 24) << pad(note.ran ? "ran" : "-", 5) << note.note << '\n';
    }
  }
  if (one.exact.planes.size() > kMostPlanes) {
    std::cout << "  ... and " << one.exact.planes.size() - kMostPlanes << " more planes (--json has them all)\n";
  }
}

void print_shares(const Scene& scene, const PointTerm& one) {
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

// As a person can copy them: one per plane, however long they are.
void print_exact_fractions(const Scene& scene, const PointTerm& one) {
  for (const PlaneRecord& plane : one.exact.planes) {
    if (!plane.exact_fraction) continue;
    std::cout << "  exactly      " << *plane.exact_fraction << "  of the plane of "
              << shown_name(scene, plane.faces.front());
    if (plane.faces.size() > 1) std::cout << " and " << plane.faces.size() - 1 << " more faces";
    std::cout << '\n';
  }
}

std::string derivative_words(const Derivative& d) {
  const bool holds_zero = d.status == DerivativeStatus::kEnclosed && d.value == 0.0;
  if (holds_zero) return fmt::format("0.0  (enclosed: within {} of {})", d.enclosure.radius(), d.enclosure.midpoint());
  return fmt::format("{}  ({})", plain_derivative(d), to_string(d.status));
}

std::string names_of(const Scene& scene, const std::vector<FaceId>& faces) {
  constexpr std::size_t kMost = 4;
  std::string names;
  for (std::size_t i = 0; i < faces.size() && i < kMost; ++i)
    names += (i > 0 ? ", " : "") + shown_name(scene, faces[i]);
  return faces.size() > kMost ? names + ", ..." : names;
}

void print_gradient(const Scene& scene, const Gradient& gradient) {
  static constexpr const char* kAxes[] = {"x", "y", "z"};
  if (gradient.kink) {
    std::cout << "  gradient     none: a kink, since " << to_string(gradient.kink->reason) << " ("
              << names_of(scene, gradient.kink->faces) << ")\n";
  } else {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::cout << "  dF/d" << kAxes[axis] << "        " << derivative_words(gradient.position[axis]) << '\n';
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::cout << "  V" << kAxes[axis] << "           " << derivative_words(gradient.normal[axis]) << '\n';
  }
  if (!gradient.along) return;
  const bool exists = gradient.along->status != DerivativeStatus::kNone;
  std::cout << "  along        " << (exists ? derivative_words(*gradient.along) : "none: F may jump") << '\n';
}

// Each arc of the visible boundary with the line in space that moves it.
void print_arcs(const Gradient& gradient) {
  constexpr std::size_t kMostArcs = 20;
  if (gradient.kink) return;
  std::cout << "\n  arcs of the visible boundary that move: " << gradient.arcs.size() << '\n';
  for (std::size_t i = 0; i < gradient.arcs.size() && i < kMostArcs; ++i) {
    const GradientArc& arc = gradient.arcs[i];
    const auto brief = [](const Vec3& v) {
      return fmt::format("({}, {}, {})", text::short_number(v.x, 6), text::short_number(v.y, 6),
                         text::short_number(v.z, 6));
    };
    std::cout << "    the line through " << brief(arc.begin) << " and " << brief(arc.end) << " adds " << brief(arc.part)
              << '\n';
  }
  if (gradient.arcs.size() > kMostArcs) {
    std::cout << "    ... and " << gradient.arcs.size() - kMostArcs << " more (--json has them all)\n";
  }
}

// Each vertex that moves the visible boundary.
void print_vertices(const Scene& scene, const Gradient& gradient) {
  if (gradient.kink) return;
  std::cout << "\n  vertices that move the visible boundary: " << gradient.vertices.size() << '\n';
  for (const VertexDerivative& vertex : gradient.vertices) {
    std::cout << "    " << place_text(scene.vertices()[vertex.vertex]);
    if (vertex.is_kink) {
      std::cout << "  none: a kink\n";
      continue;
    }
    for (const Derivative& d : vertex.position) std::cout << "  " << plain_derivative(d);
    std::cout << '\n';
  }
  const char* const whose = gradient.frames.size() == 1 ? "the source's plane" : "the plane of a face of the source";
  for (const auto& frame : gradient.frames) {
    std::cout << "  " << whose << " follows";
    for (const std::uint32_t corner : frame) std::cout << ' ' << place_text(scene.vertices()[corner]);
    std::cout << '\n';
  }
}

void print_estimate(const PointArguments& args, const PointTerm& one) {
  std::cout << "  " << args.method << ": " << shortest(one.estimate->form_factor) << " (error "
            << shortest(one.estimate->form_factor - one.exact.value);
  for (const auto& [name, count] : one.estimate->counters.list()) {
    if (count > 0) std::cout << ", " << name << ' ' << count;
  }
  std::cout << ")\n";
}

// "form factor", padded as the words below it, or a longer one of another measure.
std::string label_of(const PointResult& point) { return flags::words_of(point.measure) + "  "; }

void print_source(const PointArguments& args, const Scene& scene, const PointResult& point, const PointTerm& one) {
  std::cout << "source " << shown_name(scene, one.source) << '\n'
            << "  " << label_of(point) << value_text(one.exact, args.precision.digits) << "  ("
            << to_string(one.exact.status) << ")\n"
            << "  enclosure    [" << shortest(one.exact.lower) << ", " << shortest(one.exact.upper) << "]\n";
  if (one.exact.visible_fraction) {
    std::cout << "  visible      " << shortest(*one.exact.visible_fraction) << "  ("
              << to_string(*one.exact.visible_part) << " of it)\n";
  }
  if (args.exact_fraction) print_exact_fractions(scene, one);
  if (one.exact.gradient) print_gradient(scene, *one.exact.gradient);
  if (args.vertices) print_vertices(scene, *one.exact.gradient);
  if (!one.emits && point.measure.is_form_factor())
    std::cout << "  emits        nothing (Ke 0), so it counts with a radiosity of 1\n";
  if (one.estimate) print_estimate(args, one);
  if (!args.explain) return;
  print_stages(scene, one);
  print_shares(scene, one);
  if (one.exact.gradient) print_arcs(*one.exact.gradient);
}

// Empty if the ball does not determine it.
std::optional<std::string> sum_text(const Enclosure& sum, int digits) {
  if (digits > 0) {
    if (auto decimals = sum.decimals(digits)) return decimals;
  }
  const std::optional<double> nearest = sum.nearest();
  return nearest ? std::optional(shortest(*nearest)) : std::nullopt;
}

void print_sum(const PointArguments& args, const PointResult& point, const std::string& title, const Enclosure& sum) {
  std::cout << title << "\n  " << label_of(point) << sum_text(sum, args.precision.digits).value_or("between the bounds")
            << "\n  enclosure    [" << shortest(sum.lower()) << ", " << shortest(sum.upper()) << "]\n";
}

std::string rgb_text(const Rgb& c) { return fmt::format("{} {} {}", shortest(c.r), shortest(c.g), shortest(c.b)); }

std::string radiosity_words(const PointResult& point) {
  const std::size_t others = point.sources.size() - point.emitters;
  if (others == 0) return "(reflectance x Ke of the source x form factor, per channel)";
  if (point.emitters == 0) return "(reflectance x 1 x form factor, per channel, since nothing is emitted)";
  return fmt::format(
      "(reflectance x Ke x form factor, per channel, over the {} that {})\n  not added         {}  (from the {} that "
      "{} nothing, with a radiosity of 1)",
      text::counted(point.emitters, "source"), point.emitters == 1 ? "emits" : "emit",
      rgb_text(point.radiosity_of_others), others, others == 1 ? "emits" : "emit");
}

// --- the table of --source all: what the receiver sees of every patch, and what is missing to 1 ---

// 1 - sum.
Enclosure missing_to_one(const Enclosure& sum) {
  Enclosure missing = Enclosure::of(1.0);
  missing -= sum;
  return missing;
}

// What 1 less the sum is.
std::string missing_meaning(const Scene& scene, const PointResult& point) {
  if (point.stacked) {
    return "patches lie in one plane over each other, and each counts fully; exactff view has the shares of what is "
           "seen";
  }
  if (!scene.transparent().empty()) return "transparent patches count fully, and so does what is seen through them";
  return "the share that reaches no patch's front: it leaves the scene or meets the back of a face";
}

std::string missing_words(const Enclosure& missing, const std::string& meaning, int digits) {
  const double low = missing.lower(), high = missing.upper();
  if (low <= 0.0 && high >= 0.0) {
    const double most = std::max(-low, high);
    return most == 0.0 ? "0 (exactly)" : "0, to within " + text::short_number(most, 2);
  }
  const std::string number = sum_words(missing, digits);
  return fmt::format("{}  ({}{})", number, high < 0.0 ? "the sum exceeds 1: " : "", meaning);
}

// One row per source, their sum and what is missing to 1.
void print_patch_table(const PointArguments& args, const Scene& scene, const PointResult& point) {
  const bool visible = args.fraction || args.exact_fraction;
  TextTable table;
  table.add_column("patch");
  table.add_column(flags::words_of(point.measure));
  table.add_column("status");
  if (visible) table.add_column("visible");
  if (!args.method.empty()) table.add_column(args.method);
  table.add_column("emits");
  for (const PointTerm& one : point.sources) {
    std::vector<std::string> cells = {scene.name_of(one.source), value_text(one.exact, args.precision.digits),
                                      std::string(to_string(one.exact.status))};
    if (visible) cells.push_back(shortest(one.exact.visible_fraction.value_or(0.0)));
    if (one.estimate) cells.push_back(shortest(one.estimate->form_factor));
    cells.emplace_back(one.emits ? "yes" : "-");
    table.add_row(std::move(cells));
  }
  table.print(std::cout);
  std::cout << "\nsum           " << sum_words(point.sum, args.precision.digits) << "  (of "
            << text::counted(point.sources.size(), "patch", "patches") << ", added as balls)\n";
  if (!point.measure.is_form_factor()) return;
  std::cout << "missing to 1  "
            << missing_words(missing_to_one(point.sum), missing_meaning(scene, point), args.precision.digits) << '\n';
  if (point.is_mixed()) {
    std::cout << "emitters      " << sum_words(point.sum_of_emitters, args.precision.digits) << "  (the sum over the "
              << text::counted(point.emitters, "patch", "patches")
              << (point.emitters == 1 ? " that emits)\n" : " that emit)\n");
  }
}

// --- JSON ---

nlohmann::ordered_json sum_json(const Enclosure& sum) {
  return {{"lower", sum.lower()}, {"upper", sum.upper()}, {"ball", ball_json(sum)}};
}

nlohmann::ordered_json plane_json(const Scene& scene, const PlaneRecord& plane) {
  nlohmann::ordered_json faces = nlohmann::ordered_json::array();
  for (const FaceId face : plane.faces) faces.push_back(scene.name_of(face));
  nlohmann::ordered_json notes = nlohmann::ordered_json::array();
  for (const StageNote& note : stages(plane)) {
    notes.push_back({{"stage", note.stage}, {"ran", note.ran}, {"note", note.note}});
  }
  nlohmann::ordered_json json = {{"faces", faces},
                                 {"outcome", to_string(decided_outcome(plane))},
                                 {"tree_candidates", plane.tree_candidates},
                                 {"candidates", plane.candidates},
                                 {"tree_edges", plane.tree_edges},
                                 {"silhouettes", plane.silhouettes},
                                 {"clipped", plane.clipped},
                                 {"loops", plane.loops},
                                 {"edges", plane.edges},
                                 {"stages", notes}};
  if (plane.visible_fraction) json["visible_fraction"] = *plane.visible_fraction;
  if (plane.exact_fraction) json["exact_fraction"] = *plane.exact_fraction;
  return json;
}

nlohmann::ordered_json estimate_json(const PointArguments& args, const PointTerm& one) {
  nlohmann::ordered_json work = nlohmann::ordered_json::object();
  for (const auto& [name, count] : one.estimate->counters.list()) work[std::string(name)] = count;
  if (one.adaptive) work["leaves by depth"] = one.adaptive->leaves_by_depth;
  return {{"method", methods::parse(args.method).text()}, {"form_factor", one.estimate->form_factor}, {"work", work}};
}

nlohmann::ordered_json derivative_json(const Derivative& d) {
  if (d.status == DerivativeStatus::kNone) return {{"value", nullptr}, {"status", to_string(d.status)}};
  return {{"value", d.value}, {"status", to_string(d.status)}, {"ball", ball_json(d.enclosure)}};
}

nlohmann::ordered_json vertices_json(const Scene& scene, const Gradient& gradient) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const VertexDerivative& vertex : gradient.vertices) {
    nlohmann::ordered_json position = nlohmann::ordered_json::array();
    for (const Derivative& d : vertex.position) position.push_back(derivative_json(d));
    json.push_back({{"vertex", vertex.vertex},
                    {"at", numbers_json(scene.vertices()[vertex.vertex])},
                    {"kink", vertex.is_kink},
                    {"position", position}});
  }
  return json;
}

nlohmann::ordered_json gradient_json(const PointArguments& args, const Scene& scene, const Gradient& gradient) {
  nlohmann::ordered_json json;
  if (gradient.kink) {
    nlohmann::ordered_json faces = nlohmann::ordered_json::array();
    for (const FaceId face : gradient.kink->faces) faces.push_back(scene.name_of(face));
    json["kink"] = {{"reason", to_string(gradient.kink->reason)}, {"faces", faces}};
  } else {
    json["kink"] = nullptr;
  }
  json["position"] = nlohmann::ordered_json::array();
  for (const Derivative& d : gradient.position) json["position"].push_back(derivative_json(d));
  json["normal"] = nlohmann::ordered_json::array();
  for (const Derivative& d : gradient.normal) json["normal"].push_back(derivative_json(d));
  if (gradient.along) json["along"] = derivative_json(*gradient.along);
  if (args.vertices) {
    json["vertices"] = vertices_json(scene, gradient);
    json["frames"] = gradient.frames;
  }
  if (args.explain) {
    json["arcs"] = nlohmann::ordered_json::array();
    for (const GradientArc& arc : gradient.arcs) {
      json["arcs"].push_back(
          {{"begin", numbers_json(arc.begin)}, {"end", numbers_json(arc.end)}, {"part", numbers_json(arc.part)}});
    }
  }
  return json;
}

nlohmann::ordered_json source_json(const PointArguments& args, const Scene& scene, const PointResult& point,
                                   const PointTerm& one) {
  nlohmann::ordered_json json = {{"source", scene.name_of(one.source)},
                                 {"value", one.exact.value},
                                 {"lower", one.exact.lower},
                                 {"upper", one.exact.upper},
                                 {"status", to_string(one.exact.status)},
                                 {"emits", one.emits}};
  if (point.measure.is_form_factor()) json["radiosity"] = numbers_json(one.radiosity);
  json["ball"] = ball_json(one.exact.enclosure);
  json["bits"] = one.exact.precision_bits;
  if (args.precision.digits > 0) json["decimals"] = value_text(one.exact, args.precision.digits);
  if (one.exact.visible_fraction) {
    json["visible_fraction"] = *one.exact.visible_fraction;
    json["visible_part"] = to_string(*one.exact.visible_part);
  }
  if (one.exact.gradient) json["gradient"] = gradient_json(args, scene, *one.exact.gradient);
  if (one.unoccluded) json["unoccluded"] = *one.unoccluded;
  if (args.explain) {
    json["cutters"] = nlohmann::ordered_json::array();
    for (const FaceId face : one.exact.cutters) json["cutters"].push_back(scene.name_of(face));
    json["shares_alone"] = nlohmann::ordered_json::array();
    for (const PointTerm::Share& share : one.shares) {
      json["shares_alone"].push_back({{"face", scene.name_of(share.face)}, {"share", share.alone}});
    }
  }
  json["planes"] = nlohmann::ordered_json::array();
  for (const PlaneRecord& plane : one.exact.planes) json["planes"].push_back(plane_json(scene, plane));
  if (one.estimate) json["estimate"] = estimate_json(args, one);
  return json;
}

}  // namespace

std::string plain_value(const FormFactor& result) {
  if (result.status == Status::kZero) return "0";
  if (result.status == Status::kUnderflow) return "0.0";
  return shortest(result.value);
}

std::string plain_gradient(const FormFactor& result) {
  std::string line = plain_value(result);
  if (result.gradient->kink) return line + "\tkink";
  for (const Derivative& d : result.gradient->position) line += '\t' + plain_derivative(d);
  return line;
}

std::string value_text(const FormFactor& result, int digits) {
  if (result.status == Status::kZero) return "0";
  if (digits > 0) {
    if (const std::optional<std::string> decimals = result.enclosure.decimals(digits)) return *decimals;
  }
  return plain_value(result);
}

std::string sum_words(const Enclosure& sum, int digits) {
  return sum_text(sum, digits).value_or(fmt::format("between {} and {}", shortest(sum.lower()), shortest(sum.upper())));
}

void print_point_table(const PointArguments& args, const Scene& scene, const PointResult& point) {
  std::cout << "receiver " << text::printable(receiver_text(scene, point.receiver));
  if (const std::optional<FaceId> cover = buried_under(scene, point.receiver)) {
    std::cout << "\nburied under " << shown_name(scene, *cover)
              << ": a closed solid stands on the receiver's face there, so it sees nothing";
  }
  std::cout << "\n\n";
  const bool blocks = !point.every_patch || args.explain || args.exact_fraction || args.gradient;
  for (const PointTerm& one : point.sources) {
    if (blocks) print_source(args, scene, point, one);
  }
  if (point.every_patch) {
    if (blocks) std::cout << '\n';
    print_patch_table(args, scene, point);
  } else if (point.sources.size() > 1) {
    print_sum(args, point, "sum of " + text::counted(point.sources.size(), "source"), point.sum);
    if (point.is_mixed() && point.measure.is_form_factor())
      print_sum(args, point,
                fmt::format("sum of the {} that {}", point.emitters, point.emitters == 1 ? "emits" : "emit"),
                point.sum_of_emitters);
  }
  if (!point.measure.is_form_factor()) return;
  std::cout << "\nradiosity received  " << rgb_text(point.radiosity) << "  " << radiosity_words(point) << '\n';
}

void print_point_json(const PointArguments& args, const Scene& scene, const PointResult& point) {
  nlohmann::ordered_json json = question_json(args.scene.path, scene, point.receiver, point.measure);
  nlohmann::ordered_json& receiver = json["receiver"];
  receiver["reflectance"] = numbers_json(point.reflectance);
  if (!point.receiver.on.empty()) receiver["on"] = scene.name_of(point.receiver.on);
  if (const auto cover = buried_under(scene, point.receiver)) receiver["buried_under"] = scene.name_of(*cover);
  json["sources"] = nlohmann::ordered_json::array();
  for (const PointTerm& one : point.sources) json["sources"].push_back(source_json(args, scene, point, one));
  json["sum"] = sum_json(point.sum);
  if (point.measure.is_form_factor()) {
    if (point.is_mixed()) json["sum_of_emitters"] = sum_json(point.sum_of_emitters);
    if (point.every_patch) json["missing_to_1"] = sum_json(missing_to_one(point.sum));
    json["radiosity"] = numbers_json(point.radiosity);
  }
  std::cout << text::json_document(json) << '\n';
}

void draw_point(const PointArguments& args, const Scene& scene, const PointResult& point) {
  const PointTerm& one = point.sources.front();
  const AdaptiveResult* const sampled = one.adaptive ? &*one.adaptive : nullptr;
  const ExactSource source(scene, one.source);
  write_whole_file(args.svg, report::visibility_svg(scene, point.receiver, source, one.exact, sampled));
}

}  // namespace exactff::cli
