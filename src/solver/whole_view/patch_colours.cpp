#include "whole_view/patch_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace exactff::whole_view {
namespace {

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

Rgb scaled(const Rgb& c, double by) { return {c.r * by, c.g * by, c.b * by}; }

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
      const Rgb colour = scaled(listed, things_[thing].light);
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

}  // namespace

double difference_of_colours(const Rgb& a, const Rgb& b) {
  const Oklab p = oklab(a), q = oklab(b);
  return std::hypot(0.5 * (p.lightness - q.lightness), p.a - q.a, p.b - q.b);
}

std::vector<Rgb> distinct_colours(std::span<const Tinted> things) { return Colouring(things).run(); }

}  // namespace exactff::whole_view
