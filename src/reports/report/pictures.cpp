// The pictures at the head of a chapter, and one receiver's view of one source.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <vector>

#include "exactff/render.h"
#include "kernel/vec.h"
#include "report/report.h"
#include "study/runs.h"
#include "study/settings.h"
#include "study/sight.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

using kernel::max_norm;

constexpr int kWidth = 192, kHeight = 144;  // of the largest picture
constexpr int kLeastHeight = 36;
constexpr const char* kLeftOut = "pictures of the scene";

// Seconds per pixel that a method is planned to need, from its counted work at some of the receivers.
double planned_seconds_per_pixel(const Study& study, const methods::Choice& choice) {
  constexpr std::size_t kMostPoints = 12;
  constexpr double kTooDear = 1.0;  // seconds for a pixel
  const study::PreparedMethod prepared(*choice.method, *study.request.scene, study.request.sources);
  study::Estimator estimator(choice, prepared, kTooDear);
  const std::size_t all = study.request.receivers.size(), points = std::min(all, kMostPoints);
  double seconds = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    seconds += estimator.seconds_at(study.request.receivers[(2 * i + 1) * all / (2 * points)]);
  }
  return seconds / static_cast<double>(points);
}

// As large as two seconds of planned time allow, which is less than one in most scenes; nothing if even the smallest
// picture would take several seconds.
std::optional<render::Size> affordable_size(double seconds_per_pixel) {
  constexpr double kBudget = 2.0, kMost = 4.0;
  const double ratio = double{kWidth} / kHeight;
  const auto height = static_cast<int>(
      std::clamp(std::sqrt(kBudget / (seconds_per_pixel * ratio)), double{kLeastHeight}, double{kHeight}));
  const render::Size size{static_cast<int>(std::lround(height * ratio)), height};
  if (seconds_per_pixel * size.width * size.height > kMost) return std::nullopt;
  return size;
}

std::set<PatchId> patches_of_receivers(const Study& study) {
  std::set<PatchId> patches;
  for (const Receiver& receiver : study.request.receivers) {
    if (!receiver.on.empty()) patches.insert(study.request.scene->face(receiver.on.front()).patch);
  }
  return patches;
}

// Which pixels show the patches of the receivers.
class Membership {
 public:
  Membership(const Study& study, const render::View& view) : size_(view.size()) {
    const std::set<PatchId> patches = patches_of_receivers(study);
    const Scene& scene = *study.request.scene;
    for (int row = 0; row < size_.height; ++row) {
      for (int column = 0; column < size_.width; ++column) {
        const auto hit = render::first_hit(scene, view.ray(column + 0.5, row + 0.5));
        const bool shows = hit && !hit->back && patches.contains(scene.face(hit->face).patch);
        if (shows) seen_.insert(scene.face(hit->face).patch);
        shows_.push_back(shows);
      }
    }
  }

  [[nodiscard]] const std::set<PatchId>& seen() const { return seen_; }
  [[nodiscard]] auto pixels() const { return std::ranges::count(shows_, true); }

  // Draws the outline: the pixels of the patches that have a neighbour of another kind.
  void outline(render::Colours& colours) const {
    constexpr std::array<std::uint8_t, 3> kGreen = {0, 190, 110};
    for (int row = 0; row < size_.height; ++row) {
      for (int column = 0; column < size_.width; ++column) {
        if (!at(column, row)) continue;
        const bool inside = at(column - 1, row) && at(column + 1, row) && at(column, row - 1) && at(column, row + 1);
        if (!inside)
          std::ranges::copy(kGreen, colours.bytes.begin() + 3 * static_cast<std::ptrdiff_t>(place(column, row)));
      }
    }
  }

 private:
  [[nodiscard]] std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.width) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool at(int column, int row) const {
    const bool in_picture = column >= 0 && row >= 0 && column < size_.width && row < size_.height;
    return in_picture && shows_[place(column, row)];
  }

  render::Size size_;
  std::vector<bool> shows_;
  std::set<PatchId> seen_;
};

struct Ball {
  Vec3 centre = {};
  double radius = 0.0;
};
Ball ball_of_receivers_patches(const Study& study) {
  const std::set<PatchId> patches = patches_of_receivers(study);
  const Scene& scene = *study.request.scene;
  std::vector<Vec3> points;
  for (const Piece& piece : scene.pieces()) {
    if (!patches.contains(scene.face(piece.face).patch)) continue;
    for (const std::uint32_t v : scene.corners(piece)) points.push_back(scene.vertices()[v]);
  }
  Ball ball;
  for (const Vec3& p : points) ball.centre = kernel::along(ball.centre, p, 1.0 / static_cast<double>(points.size()));
  for (const Vec3& p : points) ball.radius = std::max(ball.radius, kernel::distance(p, ball.centre));
  return ball;
}

// Shows the patches of the receivers from their front: from 45 degrees above them, on the side and at the distance from
// which most of them is seen. Nothing if they cannot be seen.
std::optional<render::View> view_of_receivers(const Study& study, const render::Size& size) {
  constexpr int kSides = 8;
  constexpr std::array<double, 3> kDistances = {2.1, 1.2, 0.7};  // over the radius; nearer ones only if it must be
  const Ball ball = ball_of_receivers_patches(study);
  if (!(ball.radius > 0.0)) return std::nullopt;
  const Vec3 up = kernel::unit_unscaled(study.request.receivers.front().normal);
  const Vec3 along = kernel::unit_unscaled(kernel::cross(up, std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 across = kernel::cross(up, along);
  std::optional<render::View> best;
  std::ptrdiff_t most = 0;
  for (const double distance : kDistances) {
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / kSides;
      const Vec3 level = kernel::along(kernel::scaled(along, std::cos(angle)), across, std::sin(angle));
      render::Camera camera;
      camera.look = ball.centre;
      camera.up = up;
      camera.eye =
          kernel::along(ball.centre, kernel::along(level, up, 1.0), distance * ball.radius / std::numbers::sqrt2);
      const auto pixels = Membership(study, render::View(camera, {kWidth / 6, kHeight / 6})).pixels();
      if (pixels <= most) continue;
      most = pixels;
      best = render::View(camera, size);
    }
    if (best) break;
  }
  return best;
}

double brightest_pixel(const render::Picture& picture) {
  double brightest = 0.0;
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    if (picture.shows[i] != render::Shows::kFace) continue;
    brightest = std::max({brightest, picture.values[3 * i], picture.values[3 * i + 1], picture.values[3 * i + 2]});
  }
  return brightest;
}

std::string names_of(const Scene& scene, const std::set<PatchId>& patches) {
  std::vector<std::string> names;
  for (const PatchId patch : patches) names.push_back(scene.name_of(Selection{patch, {}, scene.id()}));
  constexpr std::size_t kMost = 3;
  if (names.size() > kMost) return text::counted(names.size(), "patch", "patches");
  return text::enumerate(names);
}

std::optional<Strip> draw_strip(const Study& study, const Shown& shown, const render::Size& size, const Hooks& hooks) {
  render::Request request{.scene = study.request.scene};
  const std::optional<render::Camera>& given = study.request.camera;
  const auto chosen = [&] {
    return render::default_camera(*study.request.scene, {.up = study.request.up.value_or(Vec3{})}, size);
  };
  request.view = render::View(given ? *given : chosen(), size);
  request.sources = study.request.sources;
  request.threads = study.request.threads;
  render::Picture exact = render::render(request, hooks);
  const auto is_dull = [&] { return Membership(study, request.view).pixels() == 0 || !(brightest_pixel(exact) > 0.0); };
  if (!given && is_dull()) {
    if (const auto view = view_of_receivers(study, size)) {
      request.view = *view;
      exact = render::render(request, hooks);
    }
  }
  const double brightest = brightest_pixel(exact);
  if (!(brightest > 0.0)) return std::nullopt;
  request.method = shown.choice;
  const render::Picture judged = render::render(request, hooks);
  const render::Errors errors = render::errors_of(judged, exact);
  const double scale = render::colour_scale(errors), exposure = render::automatic_exposure(exact);
  const Membership membership(study, request.view);
  const auto png = [&](render::Colours colours) {
    membership.outline(colours);
    return render::png_of(colours, {});
  };
  return Strip{
      .exact = png(render::develop(exact, exposure)),
      .method = png(render::develop(judged, exposure)),
      .error = png(render::coloured(errors, size, scale)),
      .method_name = shown.name,
      .is_base = !study.settings.empty() && shown.choice.method->name == "adaptive",
      .camera = render::flags_of(request.view),
      .outlined = names_of(*study.request.scene, membership.seen()),
      .scale = scale / brightest,
      .rms = errors.rms / brightest,
      .wrong = static_cast<double>(errors.wrong) / static_cast<double>(std::max<std::uint64_t>(errors.pixels, 1))};
}

// A picture by the method that the maps show; if it is too dear for one, by area sampling, if that was run.
struct Painting {
  Shown shown;
  render::Size size;
};
std::optional<Painting> affordable_painting(const Study& study, Shown shown) {
  const double exact = planned_seconds_per_pixel(study, methods::parse("exact"));
  const auto size_for = [&](const methods::Choice& choice) {
    return affordable_size(std::max(exact, planned_seconds_per_pixel(study, choice)));
  };
  if (const auto size = size_for(shown.choice)) return Painting{std::move(shown), *size};
  for (const MethodField& field : study.methods.fields) {
    const Ladder& ladder = study.methods.ladders[field.ladder];
    const methods::Choice& choice = ladder.rungs[field.rung];
    if (choice.method->name != "area-sampling") continue;
    if (const auto size = size_for(choice)) {
      return Painting{{ladder.name, study::rung_name(ladder, field.rung), choice, {}}, *size};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Shown> shown_method(const Study& study) {
  if (!study.settings.empty()) {
    Shown shown{
        "the base setting", study::setting_name(study, study.base), study::choice_of(study.settings[study.base]), {}};
    for (const SampleRow& row : study.samples[study.base]) shown.errors.push_back(row.radiosity_error);
    return shown;
  }
  for (const MethodField& field : study.methods.fields) {
    const Ladder& ladder = study.methods.ladders[field.ladder];
    if (ladder.rungs.front().method->name == "exact") continue;
    return Shown{ladder.name, study::rung_name(ladder, field.rung), ladder.rungs[field.rung], field.radiosity_errors};
  }
  return std::nullopt;
}

std::optional<Strip> strip_of(const Study& study, std::vector<LeftOut>& left_out, const Hooks& hooks) {
  const auto leave_out = [&](const std::string& why) {
    left_out.push_back({kLeftOut, why});
    return std::nullopt;
  };
  const std::optional<Shown> shown = shown_method(study);
  if (!shown) return leave_out("no method was compared with the exact one");
  try {
    const HooksOfThread ours(hooks);
    const std::optional<Painting> painting = affordable_painting(study, *shown);
    if (!painting) return leave_out("they would take too long");
    std::optional<Strip> strip = draw_strip(study, painting->shown, painting->size, hooks);
    if (!strip) return leave_out("no light falls on what the camera sees");
    return strip;
  } catch (const InputError& error) {
    return leave_out(error.problems().front().what);
  }
}

// --- Visibility svg ---

namespace {

constexpr double kPanelWidth = 640.0;
constexpr double kMargin = 24.0;
constexpr double kTitleHeight = 56.0;
constexpr double kCaptionHeight = 32.0;
constexpr double kScaleHeight = 18.0;
constexpr double kLegendHeight = 64.0;
constexpr double kLeastAspect = 0.02;
constexpr double kLargestAspect = 2.0;
constexpr std::size_t kMostPanels = 12;

// The picture and its legend draw the same thing in the same way.
constexpr const char* kBelowHorizon = "fill=\"#e9e9e9\" stroke=\"none\"";
constexpr const char* kHidden = "fill=\"#a9b4c2\" stroke=\"none\"";
constexpr const char* kShadow = "fill=\"none\" stroke=\"#0072b2\" stroke-width=\"0.8\" stroke-opacity=\"0.7\"";
constexpr const char* kSmoothShadow = "fill=\"none\" stroke=\"#0072b2\" stroke-width=\"0.4\" stroke-opacity=\"0.35\"";
constexpr const char* kSilhouette = "fill=\"none\" stroke=\"#0072b2\" stroke-width=\"1.6\" stroke-linecap=\"round\"";
constexpr const char* kVisible =
    "fill=\"#f6d64a\" fill-rule=\"evenodd\" stroke=\"#d55e00\" stroke-width=\"1.8\" stroke-linejoin=\"round\"";
constexpr const char* kVisibleOutline =
    "fill=\"none\" stroke=\"#d55e00\" stroke-width=\"1.8\" stroke-linejoin=\"round\"";

struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value);
  return text.data();
}

// (a - b) * 2^-exponent, where a - b may overflow.
double scaled_difference(double a, double b, int exponent) {
  const double difference = a - b;
  return std::isfinite(difference) ? std::ldexp(difference, -exponent) : std::ldexp(0.5 * a - 0.5 * b, 1 - exponent);
}
Vec3 scaled_difference(const Vec3& a, const Vec3& b, int exponent) {
  return {scaled_difference(a.x, b.x, exponent), scaled_difference(a.y, b.y, exponent),
          scaled_difference(a.z, b.z, exponent)};
}

// Maps points of one plane to pixels: u along the first side of the source, v counter-clockwise from it as seen from x.
class PanelMap {
 public:
  explicit PanelMap(const PlaneDrawing& drawing) : origin_(drawing.source.front().corners.front()) {
    double size = 0.0;
    for (const Loop& loop : drawing.source) {
      for (const Vec3& p : loop.corners) size = std::max(size, max_norm(scaled_difference(p, origin_, 0)));
    }
    exponent_ = std::isfinite(size) ? std::ilogb(size) : std::numeric_limits<double>::max_exponent;
    const Vec3 side = scaled_difference(drawing.source.front().corners[1], origin_, 0);  // may be far shorter
    u_ = kernel::unit(std::isfinite(max_norm(side))
                          ? side
                          : scaled_difference(drawing.source.front().corners[1], origin_, exponent_));
    v_ = kernel::unit(kernel::cross(kernel::unit(drawing.normal), u_));
    fit(drawing);
  }

  [[nodiscard]] Pixel operator()(const Vec3& p) const {
    const Pixel flat = flatten(p);
    return {kMargin + (flat.x - low_.x) / size_ * (kPanelWidth - 2 * kMargin),
            kMargin + (high_.y - flat.y) / size_ * (kPanelWidth - 2 * kMargin)};
  }

  // log10 of the length of a pixel, in the scene's unit. (The length itself may not be a double.)
  [[nodiscard]] double log_pixel() const {
    return std::log10(size_ / (kPanelWidth - 2 * kMargin)) + exponent_ * std::log10(2.0);
  }

  [[nodiscard]] double height() const {
    const double aspect = std::clamp((high_.y - low_.y) / size_, kLeastAspect, kLargestAspect);
    return 2 * kMargin + aspect * (kPanelWidth - 2 * kMargin);
  }

 private:
  [[nodiscard]] Pixel flatten(const Vec3& p) const {
    const Vec3 relative = scaled_difference(p, origin_, exponent_);
    return {kernel::dot(relative, u_), kernel::dot(relative, v_)};
  }

  void fit(const PlaneDrawing& drawing) {
    const double infinity = std::numeric_limits<double>::infinity();
    low_ = {infinity, infinity};
    high_ = {-infinity, -infinity};
    for (const Loop& loop : drawing.source) {
      for (const Vec3& p : loop.corners) {
        const Pixel flat = flatten(p);
        low_ = {std::min(low_.x, flat.x), std::min(low_.y, flat.y)};
        high_ = {std::max(high_.x, flat.x), std::max(high_.y, flat.y)};
      }
    }
    size_ = std::max(high_.x - low_.x, (high_.y - low_.y) / kLargestAspect);
  }

  Vec3 origin_;
  int exponent_ = 0;  // of the source's size
  Vec3 u_;
  Vec3 v_;
  Pixel low_;
  Pixel high_;
  double size_ = 1.0;
};

template <class Corners>
std::string path_of(const PanelMap& map, const Corners& corners) {
  std::string path;
  for (const Vec3& corner : corners) {
    const Pixel p = map(corner);
    path += (path.empty() ? "M" : "L") + number(p.x) + ' ' + number(p.y);
  }
  return path + 'Z';
}

std::string paths_of(const PanelMap& map, const std::vector<Loop>& loops) {
  std::string path;
  for (const Loop& loop : loops) path += path_of(map, loop.corners);
  return path;
}

std::string element(const std::string& path, const std::string& attributes) {
  return path.empty() ? "" : "<path d=\"" + path + "\" " + attributes + "/>\n";
}

// V = 0 is dark blue, V = 1 yellow; distinguishable in grey and with colour blindness.
std::string colour_of_visibility(double visibility) {
  const double t = std::clamp(visibility, 0.0, 1.0);
  const auto mix = [t](double from, double to) { return static_cast<int>(std::lround(from + t * (to - from))); };
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", mix(0x1f, 0xf6), mix(0x3a, 0xd6), mix(0x7a, 0x4a));
  return text.data();
}

std::string leaf_elements(const PanelMap& map, const std::vector<PlaneDrawing>& drawings, std::size_t panel,
                          std::span<const Leaf> leaves) {
  std::string result;
  for (const Leaf& leaf : leaves) {
    if (study::plane_of(leaf, drawings) != &drawings[panel]) continue;
    const std::span<const Vec3> corners(leaf.corners.data(), static_cast<std::size_t>(leaf.corner_count));
    result += element(path_of(map, corners),
                      "fill=\"" + colour_of_visibility(leaf.visibility) + "\" stroke=\"#ffffff\" stroke-width=\"0.4\"");
  }
  return result;
}

// The sides of shadows, each with the number of shadows on its left minus those on its right. It is 0 where two
// neighbouring faces of a mesh continue one another.
class Sides {
 public:
  explicit Sides(const PlaneDrawing& drawing) {
    for (const PlaneDrawing::Shadow& shadow : drawing.shadows) {
      const std::vector<Vec3>& corners = shadow.outline.corners;
      for (std::size_t c = 0; c < corners.size(); ++c) add(corners[c], corners[c + 1 == corners.size() ? 0 : c + 1]);
    }
  }

  // Whether most sides bound nothing: then the drawing is that of a mesh.
  [[nodiscard]] bool are_mostly_smooth() const {
    const auto smooth = std::ranges::count_if(count_, [](const auto& side) { return side.second == 0; });
    return 2 * static_cast<std::size_t>(smooth) > count_.size();
  }
  [[nodiscard]] std::string path_of_silhouettes(const PanelMap& map) const {
    std::string path;
    for (const auto& [ends, count] : count_) {
      if (count == 0) continue;
      const Pixel a = map({ends[0], ends[1], ends[2]}), b = map({ends[3], ends[4], ends[5]});
      path += "M" + number(a.x) + ' ' + number(a.y) + "L" + number(b.x) + ' ' + number(b.y);
    }
    return path;
  }

 private:
  void add(const Vec3& a, const Vec3& b) {
    const std::array<double, 6> ahead{a.x, a.y, a.z, b.x, b.y, b.z}, back{b.x, b.y, b.z, a.x, a.y, a.z};
    if (ahead == back) return;
    count_[std::min(ahead, back)] += ahead < back ? 1 : -1;
  }

  std::map<std::array<double, 6>, int> count_;
};

std::string shadow_elements(const Scene& scene, const PanelMap& map, const PlaneDrawing& drawing, const Sides& sides) {
  const bool smooth = sides.are_mostly_smooth();
  std::string result;
  for (const PlaneDrawing::Shadow& shadow : drawing.shadows) {
    result += "<path d=\"" + path_of(map, shadow.outline.corners) + "\" " + (smooth ? kSmoothShadow : kShadow) +
              "><title>" + text::html(scene.name_of(shadow.face)) + "</title></path>\n";
  }
  return result + (smooth ? element(sides.path_of_silhouettes(map), kSilhouette) : "");
}

std::string line_of_text(double x, double y, const std::string& text, const char* attributes = "") {
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" " + attributes + ">" + text::html(text) + "</text>\n";
}

std::string caption(const Scene& scene, const PlaneRecord& record, double y) {
  std::string faces = scene.name_of(record.faces.front());
  if (record.faces.size() > 1) faces += " and " + std::to_string(record.faces.size() - 1) + " more";
  return line_of_text(kMargin, y + kCaptionHeight * 0.75,
                      "Plane of " + faces + ": " + std::string(to_string(decided_outcome(record))) + "; " +
                          text::counted(record.candidates, "face") + " in the shaft; " +
                          text::counted(record.edges, "edge") + " of the visible region");
}

// The longest of 1, 2 and 5 times a power of ten that is at most a third as long as the panel is wide.
struct ScaleBar {
  double pixels = 0.0;
  std::string length;
};

std::string power_of_ten_times(int digit, int exponent) {
  constexpr int kPlain = 4;
  const std::string text = std::to_string(digit);
  if (exponent >= 0 && exponent <= kPlain) return text + std::string(static_cast<std::size_t>(exponent), '0');
  if (exponent < 0 && exponent >= -kPlain)
    return "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + text;
  return text + "e" + std::to_string(exponent);
}

ScaleBar scale_bar(const PanelMap& map) {
  const double longest = std::log10((kPanelWidth - 2 * kMargin) / 3.0) + map.log_pixel();
  const auto exponent = static_cast<int>(std::floor(longest));
  const double rest = longest - exponent;
  const int digit = rest >= std::log10(5.0) ? 5 : rest >= std::log10(2.0) ? 2 : 1;
  return {std::pow(10.0, std::log10(digit) + exponent - map.log_pixel()), power_of_ten_times(digit, exponent)};
}

std::string scale_element(const PanelMap& map, double y) {
  const ScaleBar bar = scale_bar(map);
  const double end = kMargin + bar.pixels;
  const std::string path = "M" + number(kMargin) + ' ' + number(y - 4) + "v8M" + number(kMargin) + ' ' + number(y) +
                           "H" + number(end) + "M" + number(end) + ' ' + number(y - 4) + "v8";
  return element(path, "fill=\"none\" stroke=\"#222222\" stroke-width=\"1\"") +
         line_of_text(end + 8, y + 4, bar.length + " (the scene's unit of length)");
}

struct Panel {
  std::string body;
  double height = 0.0;
  bool with_silhouettes = false;
};

Panel draw_panel(const Scene& scene, const std::vector<PlaneDrawing>& drawings, std::size_t panel,
                 std::span<const Leaf> leaves) {
  const PlaneDrawing& drawing = drawings[panel];
  const PanelMap map(drawing);
  const bool with_leaves = !leaves.empty();
  std::string body = element(paths_of(map, drawing.source), kBelowHorizon);
  if (with_leaves) {
    body += leaf_elements(map, drawings, panel, leaves);
  } else {
    body += element(paths_of(map, drawing.clipped_source), kHidden);
  }
  const Sides sides(drawing);
  body += shadow_elements(scene, map, drawing, sides);
  body += element(paths_of(map, drawing.visible), with_leaves ? kVisibleOutline : kVisible);
  body += element(paths_of(map, drawing.source), "fill=\"none\" stroke=\"#222222\" stroke-width=\"0.8\"");
  body += scale_element(map, map.height() - kMargin + kScaleHeight);
  return {body, map.height() + kScaleHeight, sides.are_mostly_smooth()};
}

// Entries from left to right.
class Legend {
 public:
  explicit Legend(double y) : y_(y) {}

  void add(const char* swatch, const std::string& text, double width) {
    body_ += "<rect x=\"" + number(x_) + "\" y=\"" + number(y_) + "\" width=\"14\" height=\"12\" " + swatch + "/>" +
             line_of_text(x_ + 20, y_ + 11, text);
    x_ += width;
  }

  // The colours of all leaves, from V = 0 to V = 1.
  void add_leaves() {
    body_ += "<linearGradient id=\"v\"><stop offset=\"0\" stop-color=\"" + colour_of_visibility(0.0) +
             "\"/><stop offset=\"1\" stop-color=\"" + colour_of_visibility(1.0) + "\"/></linearGradient>\n<rect x=\"" +
             number(x_ + 136) + "\" y=\"" + number(y_) + "\" width=\"60\" height=\"12\" fill=\"url(#v)\"/>" +
             line_of_text(x_, y_ + 11, "leaf, sampled V = 0") + line_of_text(x_ + 202, y_ + 11, "1");
  }

  [[nodiscard]] const std::string& body() const { return body_; }

 private:
  double x_ = kMargin;
  double y_;
  std::string body_;
};

std::string legend(double y, bool with_leaves, bool with_silhouettes) {
  Legend first(y);
  first.add(with_leaves ? kVisibleOutline : kVisible, "visible region (exact)", 170);
  if (with_leaves) {
    first.add(kShadow, "outline of an occluder's shadow", 225);
    first.add_leaves();
  } else {
    first.add(kHidden, "hidden", 80);
    first.add(kShadow, "outline of an occluder's shadow", 225);
  }
  Legend second(y + 20);
  second.add(kBelowHorizon, "below the receiver's horizon", 250);
  if (with_silhouettes) second.add(kSilhouette, "silhouette, where faces do not continue one another", 0);
  return first.body() + second.body();
}

std::string coordinates(const Vec3& v) {
  return "(" + text::shortest(v.x) + ", " + text::shortest(v.y) + ", " + text::shortest(v.z) + ")";
}

std::string head(double height) {
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kPanelWidth) + ' ' + number(height) +
         "\" width=\"" + number(kPanelWidth) + "\" height=\"" + number(height) +
         "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"#ffffff\"/>\n";
}

}  // namespace

std::string visibility_svg(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                           const FormFactor& result, const AdaptiveResult* sampled) {
  const std::span<const Leaf> leaves = sampled == nullptr ? std::span<const Leaf>() : sampled->leaf_list;
  const std::vector<PlaneDrawing> drawings = draw_visibility(scene, receiver, source);
  const std::string name = scene.name_of(source.selection());
  std::string body =
      line_of_text(kMargin, 24, "The plane of '" + name + "', as seen from the receiver",
                   "font-size=\"14\" font-weight=\"bold\"") +
      line_of_text(kMargin, 44,
                   "receiver " + coordinates(receiver.point) + "; form factor " + text::shortest(result.value));
  double y = kTitleHeight;
  std::size_t panels = 0;
  std::size_t left_out = 0;
  bool with_silhouettes = false;
  for (std::size_t i = 0; i < drawings.size(); ++i) {
    if (drawings[i].source.empty() || panels == kMostPanels) {
      ++left_out;
      continue;
    }
    ++panels;
    const Panel panel = draw_panel(scene, drawings, i, leaves);
    body += caption(scene, result.planes[i], y - 12);
    y += kCaptionHeight - 12;
    body += "<g transform=\"translate(0 " + number(y) + ")\">\n" + panel.body + "</g>\n";
    y += panel.height;
    with_silhouettes = with_silhouettes || panel.with_silhouettes;
  }
  if (left_out > 0) {
    body += line_of_text(kMargin, y + 16,
                         text::counted(left_out, "plane") + " not drawn (not facing the receiver, or too many)");
    y += 24;
  }
  if (sampled != nullptr && leaves.size() < sampled->leaves) {
    body += line_of_text(kMargin, y + 16,
                         text::counted(sampled->leaves - leaves.size(), "leaf", "leaves") + " not drawn (too small)");
    y += 24;
  }
  body += legend(y + 8, !leaves.empty(), with_silhouettes);
  return head(y + kLegendHeight) + body + "</svg>\n";
}

}  // namespace exactff::report
