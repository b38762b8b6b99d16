#include "experiments/hemicube_resolution.h"

#include <algorithm>
#include <cmath>

#include "files/parallel.h"
#include "kernel/statistics.h"
#include "models/random.h"
#include "text/phrases.h"

namespace exactff::experiments {

namespace {

using page::Axes;
using page::Series;
using text::rounded;

// The values where rotation and distance do not vary.
constexpr double kUsualResolution = 100;
constexpr double kTurned = 31.7;      // degrees: its tangent is far from every simple fraction
constexpr double kUsualDistance = 2;  // from the light
constexpr std::string_view kResolutionStage = "hemicube-resolution";

std::string choice_text(double resolution, double rotation) {
  return "hemicube:resolution=" + text::shortest(resolution) + ",rotation=" + text::shortest(rotation);
}

// --------------------------------------------------------------------------------------------------- Karkanis' scenes

struct Subject {
  KarkanisScene scene;
  std::vector<double> exact;
};

Subject make_subject(std::size_t group, int triangles) {
  Subject subject{karkanis_scene(triangles, group + 1), {}};
  subject.exact = exact_values(subject.scene.scene, subject.scene.receiver, subject.scene.triangles);
  return subject;
}

// Errors in F, for the visible triangles.
std::vector<double> triangle_errors(const Subject& subject, const std::string& choice) {
  const auto values = values_of(choice, subject.scene.scene, subject.scene.receiver, subject.scene.triangles);
  std::vector<double> errors;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (subject.exact[i] > 0.0) errors.push_back(values[i] - subject.exact[i]);
  }
  return errors;
}

// ---------------------------------------------------------------------------------------------------- the square light

// A square of side 1 in the plane z = 0 that faces -z.
Scene light_scene() {
  SmallScene small;
  small.add("light", {{-0.5, 0.5, 0}, {0.5, 0.5, 0}, {0.5, -0.5, 0}, {-0.5, -0.5, 0}});
  return small.build();
}

// A receiver at this distance below the light, displaced sideways by up to 0.8 of the distance: the light is within the
// top face.
Receiver place_below(models::Random& random, double distance) {
  const double x = distance * random.between(-0.8, 0.8), y = distance * random.between(-0.8, 0.8);
  return {.point = {x, y, -distance}, .normal = {0, 0, 1}, .on = {}, .id = {}};
}

// Relative errors. The places of a group are the same for every choice.
std::vector<double> light_errors(std::size_t group, int places, double distance, const std::string& choice) {
  const Scene scene = light_scene();
  const Selection light = scene.select("light");
  const ExactSource exact_light(scene, light);
  Bench bench(methods::parse(choice), scene, {&light, 1});
  models::Random random(1000 + group);
  std::vector<double> errors;
  for (int i = 0; i < places; ++i) {
    const Receiver receiver = place_below(random, distance);
    const double exact = exact_form_factor(scene, receiver, exact_light).value;
    errors.push_back(bench.look_from(receiver).front().form_factor / exact - 1.0);
  }
  return errors;
}

// ---------------------------------------------------------------------------------------------------------- sentences

constexpr double kAll = 1e300;
// Up to this distance the light is larger than ten pixels at every place.
constexpr double kLastLarge = 12;

std::string resolution_sentence() {
  return "With increasing resolution n, errors fall like a power of n. Theory: an edge along a row of pixels gains or "
         "loses all its pixels at once; the error is the width of a pixel, n⁻¹. Along an edge in general position, "
         "pixels err in both directions; the error lies between n⁻³ᐟ² (independent pixel errors) and n⁻² (regularly "
         "alternating ones).";
}

NumberTable resolution_table(const ResolutionCurves& c) {
  const auto at = [](double resolution) { return "at " + rounded(resolution) + " pixels"; };
  const ErrorCurve& first = c.triangles_by_resolution;
  NumberTable table{"RMS errors: of F for the triangles, relative for a square light",
                    {"subject", "power of n", at(first.at.front()), at(first.at.back())},
                    {}};
  const auto put = [&](std::string name, const ErrorCurve& curve) {
    table.rows.push_back(
        {std::move(name), to_text(curve.slope(kAll)), rounded(curve.rms.front(), 2), rounded(curve.rms.back(), 2)});
  };
  put("triangles", c.triangles_by_resolution);
  put("light, edges along the rows of pixels", c.aligned_by_resolution);
  put("light, turned by " + rounded(kTurned) + "°", c.turned_by_resolution);
  return table;
}

std::string rotation_sentence(const ResolutionCurves& c) {
  const std::vector<double>& light = c.light_by_rotation.rms;
  const auto [low, high] = std::ranges::minmax_element(c.triangles_by_rotation.rms);
  std::vector<std::string> peaks;
  for (std::size_t i = 0; i < light.size(); ++i) {
    const double angle = c.light_by_rotation.at[i];
    if (angle == 0.0 || angle == 45.0) peaks.push_back(percent(light[i]) + " at " + rounded(angle) + "°");
  }
  return "With " + rounded(kUsualResolution) + " × " + rounded(kUsualResolution) +
         " pixels, turning the hemicube about the normal changes the relative RMS error of the square light by a "
         "factor of " +
         rounded(*std::ranges::max_element(light) / *std::ranges::min_element(light), 2) + ": " +
         text::enumerate(peaks) + " (its edges run along the rows or the diagonals of the pixels), against " +
         percent(kernel::median(light)) +
         " in the median over all angles. For triangles with edges in all directions, the angle makes no significant "
         "difference (" +
         rounded(*low, 2) + " to " + rounded(*high, 2) + " in F).";
}

std::string distance_sentence(const ResolutionCurves& c) {
  const ErrorCurve& turned = c.turned_by_distance;
  const ErrorCurve& aligned = c.aligned_by_distance;
  std::string text = "A square light of side 1 moves away to distance d. With " + rounded(kUsualResolution) + " × " +
                     rounded(kUsualResolution) + " pixels, its relative RMS error grows like d to the power " +
                     to_text(turned.slope(kLastLarge)) + " (" + to_text(aligned.slope(kLastLarge)) +
                     " with edges along the rows) while the light covers many pixels";
  const Points points = turned.points();
  if (const auto far = reaches(points, 0.1)) text += ", reaches 10 % at a distance of " + rounded(*far, 2) + " sides";
  if (const auto far = reaches(points, 1.0))
    text += " and 100 % at " + rounded(*far, 2) + " sides, where the light is about as large as a pixel";
  return text + ". The exact value is correct to the last bit at every distance.";
}

// ------------------------------------------------------------------------------------------------------------ figures

Series line(std::string title, const ErrorCurve& curve, int style) { return {std::move(title), curve.points(), style}; }

// A power law through the first point of a curve.
Series theory(const ErrorCurve& curve, double power, std::string title) {
  const double x = curve.at.front(), y = curve.rms.front(), last = curve.at.back();
  return {std::move(title), {{x, y}, {last, y * std::pow(last / x, power)}}, 0};
}

std::vector<page::Figure> figures(const ResolutionCurves& c) {
  const Axes by_resolution{.x = "resolution n, pixels along a side",
                           .y = "RMS error",
                           .extra = {"set xtics (32,64,128,256,512,1024)", "set format x '%g'"}};
  const Axes by_rotation{.x = "rotation about the normal, degrees",
                         .y = "RMS error",
                         .log_x = false,
                         .extra = {"set xtics 0,15,90", "set xrange [-2:90]"}};
  const Axes by_distance{
      .x = "distance over the light's side", .y = "relative RMS error", .extra = {"set format x '%g'"}};
  const std::string pixels = rounded(kUsualResolution) + " × " + rounded(kUsualResolution) + " pixels";
  return {{"hemicube-resolution.resolution", "Hemicube: error against resolution",
           "Triangles: error in F. Light: relative error of a square of side 1 at distance " + rounded(kUsualDistance) +
               ", with edges along the rows of pixels or turned by " + rounded(kTurned) + "°.",
           page::line_plot(by_resolution, {line("Karkanis’ triangles", c.triangles_by_resolution, 1),
                                           line("light, along rows", c.aligned_by_resolution, 2),
                                           line("light, turned", c.turned_by_resolution, 3),
                                           theory(c.aligned_by_resolution, -1.0, "slope −1"),
                                           theory(c.triangles_by_resolution, -1.5, "slope −3/2")})},
          {"hemicube-resolution.rotation", "Hemicube: error against rotation",
           "With " + pixels + ". Triangles: error in F; light: relative error.",
           page::line_plot(by_rotation, {line("Karkanis’ triangles", c.triangles_by_rotation, 1),
                                         line("square light", c.light_by_rotation, 2)})},
          {"hemicube-resolution.distance", "Hemicube: error against distance",
           "With " + pixels + ". Above the line at 1, the light is sometimes missed and sometimes counted many times.",
           page::line_plot(
               by_distance,
               {line("light, along rows", c.aligned_by_distance, 2),
                line("light, turned", c.turned_by_distance, 3),
                {"100 %", {{c.turned_by_distance.at.front(), 1.0}, {c.turned_by_distance.at.back(), 1.0}}, 0}})}};
}

CsvFile curve_table(const ResolutionCurves& c, const ResolutionSize& size) {
  TableWriter table(
      "hemicube error: triangles of the models karkanis:n=" + std::to_string(size.triangles) + ",floor=0,seed=1.." +
          std::to_string(size.groups) +
          ", error in F; light: a square of side 1, relative error\nagainst: resolution in pixels, rotation in "
          "degrees or distance in sides of the light; the others are 100 pixels, 0 degrees (turned: 31.7), 2",
      {"subject", "against", "at", "rms", "median"});
  const auto put = [&](std::string_view subject, std::string_view against, const ErrorCurve& curve) {
    for (std::size_t i = 0; i < curve.at.size(); ++i) {
      table.row() << subject << against << curve.at[i] << curve.rms[i] << curve.median[i];
    }
  };
  put("triangles", "resolution", c.triangles_by_resolution);
  put("light along rows", "resolution", c.aligned_by_resolution);
  put("light turned", "resolution", c.turned_by_resolution);
  put("triangles", "rotation", c.triangles_by_rotation);
  put("light", "rotation", c.light_by_rotation);
  put("light along rows", "distance", c.aligned_by_distance);
  put("light turned", "distance", c.turned_by_distance);
  return table.finish("hemicube-resolution.csv", "hemicube error against resolution, rotation and distance");
}

// One place along a curve.
struct CurvePlace {
  const CurvePlan* plan = nullptr;
  double at = 0.0;
};

}  // namespace

std::vector<ErrorCurve> error_curves(std::size_t groups, std::span<const CurvePlan> plans, int threads,
                                     const Hooks& hooks) {
  std::vector<CurvePlace> places;
  for (const CurvePlan& plan : plans) {
    for (const double at : plan.at) places.push_back({&plan, at});
  }
  std::vector<std::vector<std::vector<double>>> found(places.size(), std::vector<std::vector<double>>(groups));
  files::parallel_for(places.size() * groups, threads, kResolutionStage, hooks, [&](std::size_t i) {
    const auto& [plan, at] = places[i / groups];
    found[i / groups][i % groups] = plan->errors(i % groups, at);
  });
  std::vector<ErrorCurve> curves(plans.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    curves[static_cast<std::size_t>(places[i].plan - plans.data())].add_place(places[i].at, found[i]);
  }
  return curves;
}

ResolutionCurves resolution_curves(const ResolutionSize& size, int threads, const Hooks& hooks) {
  std::vector<Subject> subjects;
  for (std::size_t group = 0; group < size.groups; ++group) subjects.push_back(make_subject(group, size.triangles));
  const auto triangles = [&](const auto& choice_at) {
    return [&, choice_at](std::size_t group, double at) { return triangle_errors(subjects[group], choice_at(at)); };
  };
  const auto light = [&](const auto& choice_at) {
    return [&, choice_at](std::size_t group, double at) {
      return light_errors(group, size.places, kUsualDistance, choice_at(at));
    };
  };
  const auto far_light = [&](double rotation) {
    return [&, rotation](std::size_t group, double at) {
      return light_errors(group, size.places, at, choice_text(kUsualResolution, rotation));
    };
  };
  const auto aligned = [](double n) { return choice_text(n, 0.0); };
  const auto turned = [](double n) { return choice_text(n, kTurned); };
  const auto rotated = [](double degrees) { return choice_text(kUsualResolution, degrees); };
  const std::vector<CurvePlan> plans = {{size.resolutions, triangles(aligned)}, {size.resolutions, light(aligned)},
                                        {size.resolutions, light(turned)},      {size.rotations, triangles(rotated)},
                                        {size.rotations, light(rotated)},       {size.distances, far_light(0.0)},
                                        {size.distances, far_light(kTurned)}};
  const std::vector<ErrorCurve> c = error_curves(size.groups, plans, threads, hooks);
  return {c[0], c[1], c[2], c[3], c[4], c[5], c[6]};
}

Result hemicube_resolution(const ResolutionSize& size, int threads, const Hooks& hooks) {
  const ResolutionCurves curves = resolution_curves(size, threads, hooks);
  return {.name = "hemicube-resolution",
          .title = "The hemicube against resolution, rotation and distance",
          .paragraphs = {resolution_sentence(), rotation_sentence(curves), distance_sentence(curves)},
          .tables = {resolution_table(curves)},
          .figures = figures(curves),
          .values = {curve_table(curves, size)}};
}

Result hemicube_resolution(const Effort& effort, const Hooks& hooks) {
  ResolutionSize size;
  if (effort.abridged) {
    size.resolutions = {32, 64, 128, 256, 512};
    size.rotations = {0, 15, 30, 45, 60, 75};
    size.distances = geometric(1.0, 128.0, 8);
    size.groups = 4;
    size.places = 6;
  }
  Result result = hemicube_resolution(size, effort.threads, hooks);
  if (effort.abridged) {
    result.left_out.push_back({"the hemicube above 512 pixels, and half of the angles and distances", "abridged"});
  }
  return result;
}

}  // namespace exactff::experiments
