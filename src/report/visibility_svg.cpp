#include "exactff/visibility_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "kernel/vec.h"
#include "study/silent_errors.h"
#include "text/escape.h"
#include "text/phrases.h"

namespace exactff {

namespace {

constexpr double kPanelWidth = 640.0;
constexpr double kMargin = 24.0;
constexpr double kCaptionHeight = 44.0;
constexpr double kLegendHeight = 64.0;
constexpr double kLeastAspect = 0.02;
constexpr double kLargestAspect = 2.0;
constexpr std::size_t kMostPanels = 12;

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
// Scales first, because squares of very small components would underflow.
Vec3 unit(const Vec3& a) {
  const double largest = max_norm(a);
  const Vec3 b{a.x / largest, a.y / largest, a.z / largest};
  const double length = std::sqrt(kernel::dot(b, b));
  return {b.x / length, b.y / length, b.z / length};
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
    u_ = unit(std::isfinite(max_norm(side)) ? side
                                            : scaled_difference(drawing.source.front().corners[1], origin_, exponent_));
    v_ = unit(kernel::cross(unit(drawing.normal), u_));
    fit(drawing);
  }

  [[nodiscard]] Pixel operator()(const Vec3& p) const {
    const Pixel flat = flatten(p);
    return {kMargin + (flat.x - low_.x) / size_ * (kPanelWidth - 2 * kMargin),
            kMargin + (high_.y - flat.y) / size_ * (kPanelWidth - 2 * kMargin)};
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

std::string shadow_elements(const Scene& scene, const PanelMap& map, const PlaneDrawing& drawing, bool outline_only) {
  const std::string fill = outline_only ? "fill=\"none\" stroke-width=\"0.5\" stroke-opacity=\"0.6\""
                                        : "fill=\"#0072b2\" fill-opacity=\"0.25\" stroke-width=\"0.8\"";
  std::string result;
  for (const PlaneDrawing::Shadow& shadow : drawing.shadows) {
    result += "<path d=\"" + path_of(map, shadow.outline.corners) + "\" " + fill + " stroke=\"#0072b2\"><title>" +
              text::html(scene.name_of(shadow.face)) + "</title></path>\n";
  }
  return result;
}

std::string caption(const Scene& scene, const PlaneRecord& record, double y) {
  std::string faces = scene.name_of(record.faces.front());
  if (record.faces.size() > 1) faces += " and " + std::to_string(record.faces.size() - 1) + " more";
  std::string text = "Plane of " + faces + ": " + std::string(to_string(decided_outcome(record))) + "; " +
                     std::to_string(record.candidates) + " in the shaft, " + std::to_string(record.edges) +
                     " boundary edges";
  return "<text x=\"" + number(kMargin) + "\" y=\"" + number(y + kCaptionHeight * 0.75) + "\">" + text::html(text) +
         "</text>\n";
}

struct Panel {
  std::string body;
  double height = 0.0;
};

Panel draw_panel(const Scene& scene, const std::vector<PlaneDrawing>& drawings, std::size_t panel,
                 std::span<const Leaf> leaves) {
  const PlaneDrawing& drawing = drawings[panel];
  const PanelMap map(drawing);
  const bool with_leaves = !leaves.empty();
  std::string body;
  body += element(paths_of(map, drawing.source), "fill=\"#e3e3e3\" stroke=\"none\"");
  if (with_leaves) body += leaf_elements(map, drawings, panel, leaves);
  if (!with_leaves) {
    body += element(paths_of(map, drawing.clipped_source), "fill=\"#b9bec6\" stroke=\"none\"");
    body += element(paths_of(map, drawing.visible), "fill=\"#f6d64a\" fill-rule=\"evenodd\" stroke=\"none\"");
  }
  body += shadow_elements(scene, map, drawing, with_leaves);
  body += element(paths_of(map, drawing.visible),
                  "fill=\"none\" stroke=\"#d55e00\" stroke-width=\"1.8\" stroke-linejoin=\"round\"");
  body += element(paths_of(map, drawing.source), "fill=\"none\" stroke=\"#222222\" stroke-width=\"0.8\"");
  return {body, map.height()};
}

std::string legend_entry(double x, double y, const std::string& swatch, const std::string& text) {
  return "<rect x=\"" + number(x) + "\" y=\"" + number(y) + "\" width=\"14\" height=\"12\" " + swatch + "/><text x=\"" +
         number(x + 20) + "\" y=\"" + number(y + 11) + "\">" + text + "</text>\n";
}

std::string legend(double y, bool with_leaves) {
  std::string result;
  result += legend_entry(kMargin, y, "fill=\"none\" stroke=\"#d55e00\" stroke-width=\"2\"", "exact visible region");
  result +=
      legend_entry(kMargin + 190, y, "fill=\"#0072b2\" fill-opacity=\"0.25\" stroke=\"#0072b2\"", "projected occluder");
  if (with_leaves) {
    result += legend_entry(kMargin + 370, y, "fill=\"" + colour_of_visibility(0.0) + "\"", "leaf, V = 0");
    result += legend_entry(kMargin + 480, y, "fill=\"" + colour_of_visibility(1.0) + "\"", "leaf, V = 1");
  } else {
    result += legend_entry(kMargin + 370, y, "fill=\"#b9bec6\"", "hidden");
    result += legend_entry(kMargin + 450, y, "fill=\"#e3e3e3\"", "below the horizon");
  }
  return result;
}

}  // namespace

std::string visibility_svg(const Scene& scene, const Receiver& receiver, const ExactSource& source,
                           const FormFactor& result, std::span<const Leaf> leaves) {
  const std::vector<PlaneDrawing> drawings = draw_visibility(scene, receiver, source);
  std::string body;
  double y = kCaptionHeight;
  std::size_t panels = 0;
  std::size_t left_out = 0;
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
  }
  if (left_out > 0) {
    body += "<text x=\"" + number(kMargin) + "\" y=\"" + number(y + 16) + "\">" + std::to_string(left_out) +
            (left_out == 1 ? " plane" : " planes") + " not drawn (not facing the receiver, or too many)</text>\n";
    y += 24;
  }
  body += legend(y + 8, !leaves.empty());
  const double height = y + kLegendHeight;
  const std::string title = "Seen from the receiver: " + text::html(scene.name_of(source.selection())) +
                            ", form factor " + text::shortest(result.value);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kPanelWidth) + ' ' + number(height) +
         "\" width=\"" + number(kPanelWidth) + "\" height=\"" + number(height) +
         "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"#ffffff\"/>\n<text x=\"" +
         number(kMargin) + "\" y=\"28\" font-size=\"14\" font-weight=\"bold\">" + title + "</text>\n" + body +
         "</svg>\n";
}

}  // namespace exactff
