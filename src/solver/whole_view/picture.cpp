// A picture of the whole view. In the picture's plane, a is to the right and b upwards; with the unit normal n, a x b
// is -n, since the picture is seen from x. A direction d is drawn at (d . a, d . b) times a factor: 1 (Nusselt) or
// 1 / (1 + d . n) (stereographic).
//
// Let m be the unit normal of a plane through x. Its directions above the horizon lie
//   - on the ellipse around the middle with the half axes 1, along n x m, and |m . n| (Nusselt);
//   - on the circle of radius 1 / |m . n| (stereographic): with p = (d . a, d . b) / (1 + d . n), m . d = 0 is
//     |p - m_t / (m . n)|^2 = 1 / (m . n)^2, m_t the part of m in the picture's plane.
// With m on the left, both turn counter-clockwise where m . n > 0. Where an arc is flat to 1e-5 pixels it is a line.
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "exact/source_planes.h"
#include "exactff/view.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "text/escape.h"
#include "text/phrases.h"
#include "text/refuse.h"
#include "whole_view/regions.h"

namespace exactff {
namespace {

using kernel::cross;
using kernel::dot;
using kernel::scaled;
using kernel::sum;
using whole_view::OutlineId;
using whole_view::Regions;
using whole_view::Side;
using whole_view::SideLoop;
using whole_view::ViewEdges;

// --- Labels ---

// Where the names of things fit into a picture. The picture is a grid of squares, each of which belongs to the thing
// at its middle. A name is a box of squares.

struct Pixel {
  double x = 0.0, y = 0.0;
};
using PixelLoop = std::vector<Pixel>;  // the last one is joined to the first one

class Labels {
 public:
  static constexpr double kFontSize = 12.0, kHeight = 20.0;  // in pixels; the height is that of a line with margins

  Labels(double width, double height);

  // What lies within the loops, by the even-odd rule, belongs to `thing`, and no longer to a thing added before.
  void add(std::uint32_t thing, std::span<const PixelLoop> loops);
  // The middle of a box for the text that lies in the thing: of all such boxes, the one next to their mean. None if the
  // text fits nowhere. After the last `add`.
  [[nodiscard]] std::optional<Pixel> place(std::uint32_t thing, const std::string& text);

 private:
  struct SquareBounds {  // of squares; the last ones do not belong to it
    int left = 0, top = 0, right = 0, bottom = 0;
  };

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool fits(std::uint32_t thing, int column, int row, int width, int height) const;
  void count_runs();

  int columns_, rows_;
  std::vector<std::uint64_t> thing_;  // of each square: 1 + the thing, or 0
  std::vector<int> run_;              // the number of squares of its thing from each square to the right
  std::map<std::uint32_t, SquareBounds> bounds_;
};

constexpr double kSquare = 4.0;
constexpr double kMargin = 3.0;  // beside the text

int squares(double length) { return static_cast<int>(std::ceil(length / kSquare)); }

// Estimated from above for usual fonts. The letters of other alphabets may be wider, up to squares.
double width_of(const std::string& text) {
  constexpr double kNarrow = 7.0;
  double width = 2 * kMargin;
  for (const char byte : text) {
    const auto code = static_cast<unsigned char>(byte);
    const bool continues = (code & 0xC0U) == 0x80U;  // a letter that has begun
    if (!continues) width += code < 0x80U ? kNarrow : Labels::kFontSize;
  }
  return width;
}

Labels::Labels(double width, double height)
    : columns_(squares(width)),
      rows_(squares(height)),
      thing_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0) {}

void Labels::add(std::uint32_t thing, std::span<const PixelLoop> loops) {
  std::map<int, std::vector<double>> crossings;  // of the middle line of a row
  for (const PixelLoop& loop : loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Pixel &p = loop[i], &q = loop[(i + 1) % loop.size()];
      const auto [low, high] = std::minmax(p.y, q.y);
      const int first = std::max(0, static_cast<int>(std::ceil(low / kSquare - 0.5)));
      for (int row = first; row < rows_ && (row + 0.5) * kSquare < high; ++row) {
        crossings[row].push_back(p.x + ((row + 0.5) * kSquare - p.y) / (q.y - p.y) * (q.x - p.x));
      }
    }
  }
  if (crossings.empty()) return;
  SquareBounds bounds{columns_, crossings.begin()->first, 0, crossings.rbegin()->first + 1};
  for (auto& [row, places] : crossings) {
    std::ranges::sort(places);
    for (std::size_t i = 0; i + 1 < places.size(); i += 2) {
      const int left = std::max(0, static_cast<int>(std::ceil(places[i] / kSquare - 0.5)));
      const int right = std::min(columns_, static_cast<int>(std::ceil(places[i + 1] / kSquare - 0.5)));
      for (int column = left; column < right; ++column) thing_[index(column, row)] = std::uint64_t{1} + thing;
      if (left < right)
        bounds = {std::min(bounds.left, left), bounds.top, std::max(bounds.right, right), bounds.bottom};
    }
  }
  bounds_[thing] = bounds;
}

void Labels::count_runs() {
  run_.assign(thing_.size(), 1);
  for (int row = 0; row < rows_; ++row) {
    for (int column = columns_ - 2; column >= 0; --column) {
      const std::size_t here = index(column, row);
      if (thing_[here] == thing_[here + 1]) run_[here] = run_[here + 1] + 1;
    }
  }
}

bool Labels::fits(std::uint32_t thing, int column, int row, int width, int height) const {
  for (int r = row; r < row + height; ++r) {
    const std::size_t here = index(column, r);
    if (thing_[here] != std::uint64_t{1} + thing || run_[here] < width) return false;
  }
  return true;
}

std::optional<Pixel> Labels::place(std::uint32_t thing, const std::string& text) {
  if (run_.empty()) count_runs();
  const auto found = bounds_.find(thing);
  if (found == bounds_.end()) return {};
  const SquareBounds& bounds = found->second;
  const int width = squares(width_of(text)), height = squares(kHeight);
  std::vector<Pixel> middles;
  Pixel mean;
  for (int row = bounds.top; row + height <= bounds.bottom; ++row) {
    for (int column = bounds.left; column + width <= bounds.right; ++column) {
      if (!fits(thing, column, row, width, height)) continue;
      middles.push_back({(column + 0.5 * width) * kSquare, (row + 0.5 * height) * kSquare});
      mean = {mean.x + middles.back().x, mean.y + middles.back().y};
    }
  }
  if (middles.empty()) return {};
  const auto count = static_cast<double>(middles.size());
  return *std::ranges::min_element(middles, {}, [&](const Pixel& middle) {
    return std::hypot(middle.x - mean.x / count, middle.y - mean.y / count);
  });
}

// --- Colours of patches ---

// Colours for the things in the picture: things that touch can be told apart.

constexpr double kApart = 0.065;

// In sRGB: 8dd3c7, fccde5, 80b1d3, b3de69, ffed6f, fdb462, bc80bd, fb8072. Any two differ by more than kApart. From
// "Set3" of C. Brewer's ColorBrewer, without those near to grey and to the others; the pale ones first.
constexpr std::array<Rgb, 8> kList = {Rgb{0.266, 0.651, 0.571}, Rgb{0.974, 0.610, 0.783}, Rgb{0.216, 0.440, 0.651},
                                      Rgb{0.451, 0.730, 0.141}, Rgb{1.000, 0.847, 0.159}, Rgb{0.982, 0.456, 0.122},
                                      Rgb{0.503, 0.216, 0.509}, Rgb{0.965, 0.216, 0.168}};

struct Oklab {
  double lightness = 0.0, a = 0.0, b = 0.0;

  [[nodiscard]] double chroma() const { return std::hypot(a, b); }
};

Oklab oklab(const Rgb& c) {
  const double l = std::cbrt(0.4122214708 * c.r + 0.5363325363 * c.g + 0.0514459929 * c.b),
               m = std::cbrt(0.2119034982 * c.r + 0.6806995451 * c.g + 0.1073969566 * c.b),
               s = std::cbrt(0.0883024619 * c.r + 0.2817188376 * c.g + 0.6299787005 * c.b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Rgb dimmed(const Rgb& c, double by) { return {c.r * by, c.g * by, c.b * by}; }

// How much two colours differ: their distance in Oklab (B. Ottosson, "A perceptual color space for image processing",
// 2020), with half of that in lightness, which slopes change as well. Just noticeable: about 0.02.
double difference_of_colours(const Rgb& a, const Rgb& b) {
  const Oklab p = oklab(a), q = oklab(b);
  return std::hypot(0.5 * (p.lightness - q.lightness), p.a - q.a, p.b - q.b);
}

// Colours are linear, from 0 to 1.
struct Tinted {
  Rgb own;                                   // the colour that it has if it can
  double light = 1.0;                        // colours from the list are multiplied by this
  std::vector<std::uint32_t> touching = {};  // indices; each pair may be listed on one side, or several times
};

// The colour of each. The first one, and then the most colourful ones, keep their own. The others do so if it differs
// from those of all things that they touch; if not, they get the first colour of a list that does.
class Colouring {
 public:
  explicit Colouring(std::span<const Tinted> things)
      : things_(things), touching_(things.size()), colours_(things.size()) {
    for (std::uint32_t i = 0; i < things.size(); ++i) {
      for (const std::uint32_t j : things[i].touching) {
        touching_[i].push_back(j);
        touching_[j].push_back(i);
      }
    }
  }

  std::vector<Rgb> run() {
    for (const std::uint32_t i : order()) colours_[i] = colour_for(i);
    std::vector<Rgb> result;
    for (const auto& colour : colours_) result.push_back(*colour);
    return result;
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> order() const {
    std::vector<std::uint32_t> order(things_.size());
    std::iota(order.begin(), order.end(), 0U);
    if (!order.empty()) {
      std::stable_sort(order.begin() + 1, order.end(), [&](std::uint32_t i, std::uint32_t j) {
        return oklab(things_[i].own).chroma() > oklab(things_[j].own).chroma();
      });
    }
    return order;
  }

  // From the nearest of the neighbours' colours that are chosen already.
  [[nodiscard]] double apart(std::uint32_t thing, const Rgb& colour) const {
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t other : touching_[thing]) {
      if (other != thing && colours_[other]) least = std::min(least, difference_of_colours(colour, *colours_[other]));
    }
    return least;
  }

  // If none of them will do, the one that is furthest from the neighbours.
  [[nodiscard]] Rgb colour_for(std::uint32_t thing) const {
    Rgb best = things_[thing].own;
    double most = apart(thing, best);
    for (const Rgb& listed : kList) {
      if (most >= kApart) break;
      const Rgb colour = dimmed(listed, things_[thing].light);
      const double found = apart(thing, colour);
      if (found <= most) continue;
      best = colour;
      most = found;
    }
    return best;
  }

  std::span<const Tinted> things_;
  std::vector<std::vector<std::uint32_t>> touching_;
  std::vector<std::optional<Rgb>> colours_;
};

// --- The picture ---

constexpr double kRadius = 320.0, kCentreX = 344.0, kCentreY = 392.0, kWidth = 688.0, kHeight = 760.0;
constexpr double kFlat = 1e-5;
constexpr double kBelowMiddle = 4.0;  // the base line of a text
constexpr double kMark = 4.0;         // half of the cross at the normal
constexpr std::uint32_t kNoName = Regions::kOpen - 1;
constexpr int kDecimals = 5;
constexpr Rgb kSky{0.72, 0.81, 0.89};

Vec3 unit(const Vec3& a) {
  const Vec3 b = scaled(a, std::ldexp(1.0, -std::ilogb(kernel::max_norm(a))));  // squares neither overflow nor vanish
  return scaled(b, 1.0 / std::sqrt(dot(b, b)));
}

std::string number(double value, int decimals = kDecimals) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  std::string result = text.data();
  result.erase(result.find_last_not_of('0') + 1);
  if (result.back() == '.') result.pop_back();
  return result == "-0" ? "0" : result;
}

// --- From directions to pixels ---

std::string text_of(const Pixel& p) { return number(p.x) + ' ' + number(p.y); }

class Disk {
 public:
  Disk(const Vec3& normal, const ViewPictureOptions& options) : n_(unit(normal)), projection_(options.projection) {
    constexpr double kParallel = 1e-6;
    Vec3 up = unit(options.up);
    if (kernel::max_norm(cross(n_, up)) < kParallel) up = std::abs(up.y) > 0.5 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    a_ = unit(cross(n_, up));
    b_ = cross(a_, n_);
  }

  [[nodiscard]] Pixel at(const Vec3& d) const {
    const double factor = projection_ == ViewProjection::kNusselt ? kRadius : kRadius / (1.0 + dot(d, n_));
    return {kCentreX + factor * dot(d, a_), kCentreY - factor * dot(d, b_)};
  }

  // From the pixel of p to that of q, unit directions in the plane with the normal m: at most a quarter turn at a time,
  // so that the two pixels determine the arc well.
  [[nodiscard]] std::string arc(const Vec3& p, const Vec3& q, const Vec3& m) const {
    constexpr double kQuarter = 1e-9;
    if (dot(p, q) < -kQuarter) {
      const Vec3 middle = cross(p, m);
      return piece(p, middle, m) + piece(middle, q, m);
    }
    return piece(p, q, m);
  }

  // The same arc as points, without the last one: off the curve by less than 0.1 pixels.
  void trace(const Vec3& p, const Vec3& q, const Vec3& m, PixelLoop& points) const {
    constexpr double kStep = 0.04;
    const Vec3 ahead = cross(p, m);
    const double angle = std::abs(std::atan2(dot(ahead, q), dot(p, q)));  // a half turn may be rounded to -pi
    const int steps = 1 + static_cast<int>(angle / kStep);
    for (int k = 0; k < steps; ++k) {
      const double t = angle * k / steps;
      points.push_back(at(sum(scaled(p, std::cos(t)), scaled(ahead, std::sin(t)))));
    }
  }

 private:
  [[nodiscard]] std::string piece(const Vec3& p, const Vec3& q, const Vec3& m) const {
    const Pixel from = at(p), to = at(q), middle = at(unit(sum(p, q)));
    const double u = to.x - from.x, v = to.y - from.y, length = std::hypot(u, v);
    const double off = u * (middle.y - from.y) - v * (middle.x - from.x);
    if (!(std::abs(off) > kFlat * length)) return 'L' + text_of(to);
    const double slope = dot(m, n_);
    const char* const sweep = slope < 0.0 ? " 0 1 " : " 0 0 ";  // in SVG, y grows downwards
    if (projection_ == ViewProjection::kFisheye) {
      const std::string radius = number(kRadius / std::abs(slope));
      return 'A' + radius + ' ' + radius + " 0" + sweep + text_of(to);
    }
    const Vec3 along = cross(n_, m);
    const double degrees = std::atan2(-dot(along, b_), dot(along, a_)) * 180.0 / M_PI;
    constexpr int kAngleDecimals = 7;
    return 'A' + number(kRadius) + ' ' + number(kRadius * std::abs(slope)) + ' ' + number(degrees, kAngleDecimals) +
           sweep + text_of(to);
  }

  Vec3 n_, a_, b_;
  ViewProjection projection_;
};

// --- Colours ---

std::string colour_text(const Rgb& linear) {
  const auto level = [](double value) {
    return static_cast<int>(std::lround(255.0 * std::pow(std::clamp(value, 0.0, 1.0), 1.0 / 2.2)));
  };
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", level(linear.r), level(linear.g), level(linear.b));
  return text.data();
}

// What has one colour, but for its slopes.
struct Thing {
  PatchId patch{};
  MaterialId material{};
  bool back = false;
  friend auto operator<=>(const Thing&, const Thing&) = default;
};

bool emits(const Scene& scene, const Thing& thing) { return !thing.back && scene.material(thing.material).emits(); }

// Lamps are warm, and backs look as if in the shade.
Tinted tinted(const Scene& scene, const Thing& thing) {
  constexpr Rgb kWarm{1.0, 0.93, 0.6};
  constexpr double kOfFronts = 0.94, kOfBacks = 0.35;
  const Material& material = scene.material(thing.material);
  if (emits(scene, thing)) {
    const auto channel = [&](double emitted) { return 0.7 + 0.3 * emitted / material.radiosity.largest(); };
    const Rgb& ke = material.radiosity;
    return {{kWarm.r * channel(ke.r), kWarm.g * channel(ke.g), kWarm.b * channel(ke.b)}};
  }
  const auto channel = [&](double reflected) {
    return (thing.back ? kOfBacks : kOfFronts) * std::clamp(reflected, 0.0, 1.0);
  };
  const Rgb& kd = material.reflectance;
  return {{channel(kd.r), channel(kd.g), channel(kd.b)}, thing.back ? kOfBacks : 1.0};
}

// As if lit from one side, so that faces of different slopes can be told apart.
double shade_of(const Scene& scene, FaceId face, const Thing& thing) {
  constexpr Vec3 kLight{0.36, 0.8, 0.48};
  if (emits(scene, thing)) return 1.0;
  const double slope = dot(unit(scene.face(face).newell), kLight);
  return 0.9 + (thing.back ? -0.1 : 0.1) * slope;
}

// --- The picture ---

class Picture {
 public:
  Picture(const Scene& scene, const Receiver& receiver, const ViewPictureOptions& options)
      : scene_(scene),
        receiver_(receiver),
        options_(options),
        view_(scene, receiver),
        disk_(exact::rounded(view_.normal().exact), options) {
    edges_.find(view_, ViewEdges::Wholes::kFaces);
  }

  std::string draw() {
    std::string body = head() + fills();
    const Regions patches =
        regions_by([&](OutlineId o) { return 2 * patch_of(o) + (edges_.shows_front(o) ? 0U : 1U); });
    body += outlines(patches) + names(patches);
    const std::string circle = "<circle id=\"horizon\" cx=\"" + number(kCentreX) + "\" cy=\"" + number(kCentreY) +
                               "\" r=\"" + number(kRadius) + "\" fill=\"none\" stroke=\"#222222\"/>\n";
    const std::string x = number(kCentreX), y = number(kCentreY);
    return body + circle + legend() + "<path id=\"normal\" d=\"M" + number(kCentreX - kMark) + ' ' + y + "h8M" + x +
           ' ' + number(kCentreY - kMark) +
           "v8\" fill=\"none\" stroke=\"#222222\"><title>the receiver's normal</title></path>\n" + "</svg>\n";
  }

 private:
  // What is filled alike.
  struct Fill {
    std::uint32_t patch = 0;
    bool back = false;
    std::string colour;
    friend auto operator<=>(const Fill&, const Fill&) = default;
  };

  [[nodiscard]] std::uint32_t patch_of(OutlineId outline) const {
    return static_cast<std::uint32_t>(index_of(scene_.face(edges_.face(outline)).patch));
  }

  [[nodiscard]] static std::string line_of_text(double y, const std::string& text, const char* attributes) {
    return "<text x=\"24\" y=\"" + number(y) + "\" " + attributes + ">" + text::html(text::printable(text)) +
           "</text>\n";
  }

  [[nodiscard]] std::string head() const {
    const auto triple = [](const Vec3& v) {
      return '(' + text::shortest(v.x) + ", " + text::shortest(v.y) + ", " + text::shortest(v.z) + ')';
    };
    const std::string on = receiver_.on.empty() ? "" : ", on " + scene_.name_of(receiver_.on);
    const bool nusselt = options_.projection == ViewProjection::kNusselt;
    return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + number(kWidth) + ' ' + number(kHeight) +
           "\" width=\"" + number(kWidth) + "\" height=\"" + number(kHeight) +
           "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"#222222\">\n<rect width=\"100%\" height=\"100%\" "
           "fill=\"#ffffff\"/>\n" +
           line_of_text(24, "All that the receiver sees", "font-size=\"14\" font-weight=\"bold\"") +
           line_of_text(42, triple(receiver_.point) + ", normal " + triple(receiver_.normal) + on, "") +
           line_of_text(58,
                        nusselt ? "Nusselt's projection: the share of the disk that a patch takes is its form factor"
                                : "stereographic fisheye: angles are true",
                        "fill=\"#555555\"");
  }

  [[nodiscard]] static std::string legend() {
    constexpr const char* kGrey = "fill=\"#555555\"";
    return line_of_text(732, "+ is the direction of the receiver's normal; the rim is its horizon.", kGrey) +
           line_of_text(
               748, "Patches have the colours of their materials, or others where neighbours would look alike.", kGrey);
  }

  [[nodiscard]] Vec3 direction(std::uint32_t corner) const { return directions_[corner]; }

  [[nodiscard]] std::string path_of(const SideLoop& loop) const {
    std::string path = 'M' + text_of(disk_.at(direction(loop.front().from)));
    for (const Side& side : loop) path += disk_.arc(direction(side.from), direction(side.to), unit(side.inward));
    return path + 'Z';
  }

  [[nodiscard]] Regions regions_by(const Regions::ThingOf& thing_of) {
    Regions regions(edges_, view_.normal().exact, thing_of);
    directions_.clear();
    for (std::uint32_t c = 0; c < regions.corner_count(); ++c) {
      directions_.push_back(unit(exact::rounded(regions.corner(c).exact)));
    }
    return regions;
  }

  [[nodiscard]] Thing thing_of(OutlineId outline) const {
    const Face& face = scene_.face(edges_.face(outline));
    return {face.patch, face.material, !edges_.shows_front(outline)};
  }

  // Of all things that are seen.
  [[nodiscard]] std::map<Thing, Rgb> colours() const {
    std::map<Thing, std::uint32_t> index;
    std::vector<Tinted> things{{kSky}};
    const auto index_of_thing = [&](OutlineId outline) {
      const Thing thing = thing_of(outline);
      const auto [at, is_new] = index.try_emplace(thing, static_cast<std::uint32_t>(things.size()));
      if (is_new) things.push_back(tinted(scene_, thing));
      return at->second;
    };
    for (const ViewEdges::Sides& sides : edges_.sides()) {
      const std::uint32_t left = index_of_thing(sides.left);
      if (!sides.on_horizon) {
        const std::uint32_t right = sides.right == whole_view::kNothing ? 0 : index_of_thing(sides.right);
        things[left].touching.push_back(right);
      }
    }
    const std::vector<Rgb> chosen = Colouring(things).run();
    std::map<Thing, Rgb> result;
    for (const auto& [thing, place] : index) result.emplace(thing, chosen[place]);
    return result;
  }

  // A group for each patch, for its backs, and for what is open.
  std::string fills() {
    const std::map<Thing, Rgb> colours_of_things = colours();
    std::map<Fill, std::uint32_t> number_of;
    const auto fill_of = [&](OutlineId o) {
      const Thing thing = thing_of(o);
      const auto found = colours_of_things.find(thing);
      const Rgb colour = found == colours_of_things.end() ? Rgb{} : found->second;  // not seen
      const double shade = shade_of(scene_, edges_.face(o), thing);
      return Fill{patch_of(o), thing.back, colour_text({shade * colour.r, shade * colour.g, shade * colour.b})};
    };
    for (OutlineId o = 0; o < edges_.outline_count(); ++o) number_of.emplace(fill_of(o), 0);
    std::vector<const Fill*> fills;
    for (auto& [fill, index] : number_of) {
      index = static_cast<std::uint32_t>(fills.size());
      fills.push_back(&fill);
    }
    const Regions regions = regions_by([&](OutlineId o) { return number_of.at(fill_of(o)); });
    std::string result;
    const Fill* group = nullptr;
    for (const whole_view::Region& region : regions.regions()) {
      const bool open = region.thing == Regions::kOpen;
      const Fill sky{0, false, colour_text(kSky)};
      const Fill& fill = open ? sky : *fills[region.thing];
      if (open || group == nullptr || group->patch != fill.patch || group->back != fill.back) {
        if (!result.empty()) result += "</g>\n";
        result += open ? "<g class=\"open\"><title>(open)</title>\n"
                       : "<g class=\"" + std::string(fill.back ? "back" : "front") + "\"><title>" +
                             text::html(text::printable(scene_.patches()[fill.patch].name)) + "</title>\n";
      }
      group = open ? nullptr : &fill;
      result += "<path fill=\"" + fill.colour + "\" stroke=\"" + fill.colour +
                "\" stroke-width=\"0.4\" fill-rule=\"evenodd\" d=\"";
      for (const SideLoop& loop : region.loops) result += path_of(loop);
      result += "\"/>\n";
    }
    return result.empty() ? "" : result + "</g>\n";
  }

  // Each arc between two patches once.
  [[nodiscard]] std::string outlines(const Regions& patches) const {
    std::set<std::pair<std::uint32_t, std::uint32_t>> drawn;
    std::string path;
    for (const whole_view::Region& region : patches.regions()) {
      for (const SideLoop& loop : region.loops) {
        bool moved = false;
        for (const Side& side : loop) {
          const bool is_new = drawn.insert(std::minmax(side.from, side.to)).second;
          if (!is_new) {
            moved = false;
            continue;
          }
          if (!moved) path += 'M' + text_of(disk_.at(direction(side.from)));
          path += disk_.arc(direction(side.from), direction(side.to), unit(side.inward));
          moved = true;
        }
      }
    }
    return "<path id=\"outlines\" fill=\"none\" stroke=\"#222222\" stroke-width=\"0.7\" stroke-linejoin=\"round\" "
           "d=\"" +
           path + "\"/>\n";
  }

  // Where they fit into what is seen of the patch. All others are titles, which browsers show under the pointer.
  [[nodiscard]] std::string names(const Regions& patches) const {
    Labels labels(kWidth, kHeight);
    for (const whole_view::Region& region : patches.regions()) {
      std::vector<PixelLoop> loops;
      for (const SideLoop& loop : region.loops) {
        PixelLoop& points = loops.emplace_back();
        for (const Side& side : loop) {
          disk_.trace(direction(side.from), direction(side.to), unit(side.inward), points);
        }
      }
      labels.add(region.thing, loops);
    }
    labels.add(kNoName, std::array{around_mark()});
    std::string result;
    for (const whole_view::Region& region : patches.regions()) {
      const std::string name = name_of(region.thing);
      const std::optional<Pixel> middle = labels.place(region.thing, name);
      if (!middle) continue;
      result += "<text x=\"" + number(middle->x) + "\" y=\"" + number(middle->y + kBelowMiddle) + "\">" +
                text::html(name) + "</text>\n";
    }
    return "<g id=\"names\" font-size=\"" + number(Labels::kFontSize) +
           "\" text-anchor=\"middle\" pointer-events=\"none\" paint-order=\"stroke\" stroke=\"#ffffff\" "
           "stroke-width=\"3\" stroke-opacity=\"0.6\" stroke-linejoin=\"round\">\n" +
           result + "</g>\n";
  }

  [[nodiscard]] static PixelLoop around_mark() {
    constexpr double kAway = 2 * kMark;
    return {{kCentreX - kAway, kCentreY - kAway},
            {kCentreX + kAway, kCentreY - kAway},
            {kCentreX + kAway, kCentreY + kAway},
            {kCentreX - kAway, kCentreY + kAway}};
  }

  [[nodiscard]] std::string name_of(std::uint32_t thing) const {
    if (thing == Regions::kOpen) return "(open)";
    return text::printable(scene_.patches()[thing / 2].name) + (thing % 2 == 0 ? "" : " (back)");
  }

  const Scene& scene_;
  const Receiver& receiver_;
  const ViewPictureOptions& options_;
  const visibility::View view_;
  const Disk disk_;
  ViewEdges edges_;
  std::vector<Vec3> directions_;  // by corner
};

}  // namespace

std::string view_svg(const Scene& scene, const Receiver& receiver, const ViewPictureOptions& options) {
  const kernel::StandardArithmetic arithmetic;
  exact::check_view_arguments(scene, receiver, {}, 1);
  if (!kernel::is_finite(options.up) || kernel::max_norm(options.up) == 0.0) {
    text::refuse("the direction that points upwards in the picture is not finite or zero",
                 "it says how to turn the picture", "give a vector other than zero");
  }
  return Picture(scene, receiver, options).draw();
}

}  // namespace exactff
