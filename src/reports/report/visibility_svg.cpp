#include "report/visibility_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "kernel/vec.h"
#include "study/silent_errors.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff::report {

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

using kernel::max_norm;

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
