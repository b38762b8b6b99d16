#include "support/picture_areas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace exactff::validation {

namespace {

using Place = std::complex<double>;  // x and, upwards, y; the disk is the unit disk

double value_of(std::string_view element, const std::string& attribute) {
  const std::string key = ' ' + attribute + "=\"";
  const std::size_t at = element.find(key);
  if (at == std::string_view::npos) throw std::runtime_error("no " + attribute);
  return std::stod(std::string(element.substr(at + key.size(), 40)));
}

std::string between(const std::string& text, const std::string& left, const std::string& right, std::size_t& at) {
  const std::size_t first = text.find(left, at);
  if (first == std::string::npos) return {};
  const std::size_t last = text.find(right, first + left.size());
  at = last;
  return text.substr(first + left.size(), last - first - left.size());
}

double cross(const Place& a, const Place& b) { return a.real() * b.imag() - a.imag() * b.real(); }

class Reader {
 public:
  Reader(const std::string& svg, bool fisheye) : svg_(svg), fisheye_(fisheye) {
    const std::string_view circle = std::string_view(svg).substr(svg.find("<circle id=\"horizon\""));
    centre_ = {value_of(circle, "cx"), value_of(circle, "cy")};
    radius_ = value_of(circle, "r");
  }

  PictureAreas run() {
    for (std::size_t at = svg_.find("<g class=\""); at != std::string::npos; at = svg_.find("<g class=\"", at)) {
      const std::string kind = between(svg_, "<g class=\"", "\"", at), name = between(svg_, "<title>", "</title>", at);
      if (areas_.contains({kind, name})) throw std::runtime_error("two groups of one name: " + name);
      area_ = {};
      const std::size_t end = svg_.find("</g>", at);
      for (std::size_t path = svg_.find("<path", at); path < end; path = svg_.find("<path", path)) {
        add_path(between(svg_, " d=\"", "\"", path));
      }
      area_.share /= M_PI;
      areas_[{kind, name}] = area_;
    }
    return areas_;
  }

 private:
  [[nodiscard]] Place place(double x, double y) const {
    return {(x - centre_.real()) / radius_, (centre_.imag() - y) / radius_};
  }
  // To Nusselt's projection: sin th instead of tan(th / 2).
  [[nodiscard]] Place flat(const Place& p) const { return fisheye_ ? 2.0 * p / (1.0 + std::norm(p)) : p; }

  void add_path(const std::string& path) {
    std::istringstream words(path);
    Place start, here;
    for (char letter = 0; words >> letter;) {
      if (letter == 'Z') {
        if (std::abs(here - start) > 1e-9) throw std::runtime_error("a loop is not closed");
        continue;
      }
      double rx = 0.0, ry = 0.0, degrees = 0.0, x = 0.0, y = 0.0;
      int large = 0, sweep = 0;
      if (letter == 'A') words >> rx >> ry >> degrees >> large >> sweep;
      words >> x >> y;
      if (!words || (letter != 'M' && letter != 'L' && letter != 'A')) throw std::runtime_error("not a path: " + path);
      const Place next = place(x, y);
      if (letter == 'M') {
        start = next;
      } else {
        ++area_.sides;
        area_.arcs += letter == 'A' ? 1U : 0U;
        add(letter == 'A' ? arc(here, next, rx / radius_, ry / radius_, -degrees * M_PI / 180.0, large != 0, sweep == 0)
                          : [here, next](double t) { return here + t * (next - here); });
      }
      here = next;
    }
  }

  using Curve = std::function<Place(double)>;

  // F.6.5, with y upwards.
  static Curve arc(const Place& p, const Place& q, double rx, double ry, double angle, bool large, bool left) {
    if (p == q) return [p](double) { return p; };
    const Place turn = std::polar(1.0, angle);
    const auto to_circle = [&](const Place& v) {
      const Place w = v / turn;
      return Place{w.real() / rx, w.imag() / ry};
    };
    const Place half = to_circle(0.5 * (p - q));
    const double stretch = std::max(1.0, std::abs(half));  // F.6.6
    const double off = std::sqrt(std::max(0.0, stretch * stretch / std::norm(half) - 1.0));
    const Place to_centre = half * Place{0.0, large == left ? off : -off};
    const Place first = half - to_centre, last = -half - to_centre;
    double sweep = std::arg(last / first);
    if (left && sweep < 0.0) sweep += 2.0 * M_PI;
    if (!left && sweep > 0.0) sweep -= 2.0 * M_PI;
    const Place middle = 0.5 * (p + q);
    return [=](double t) {
      const Place w = to_centre + first * std::polar(1.0, t * sweep);
      return middle + Place{w.real() * rx, w.imag() * ry} * turn;
    };
  }

  // Twice the area between the curve and the middle, by polygons and Richardson's extrapolation.
  void add(const Curve& curve) {
    const auto by_polygon = [&](int steps) {
      double sum = 0.0;
      Place before = flat(curve(0.0));
      for (int k = 1; k <= steps; ++k) {
        const Place next = flat(curve(static_cast<double>(k) / steps));
        sum += cross(before, next);
        before = next;
      }
      return 0.5 * sum;
    };
    constexpr int kSteps = 64;
    const double coarse = by_polygon(kSteps), fine = by_polygon(2 * kSteps);
    area_.share += fine + (fine - coarse) / 3.0;
  }

  const std::string& svg_;
  const bool fisheye_;
  Place centre_;
  double radius_ = 1.0;
  PictureArea area_;
  PictureAreas areas_;
};

}  // namespace

PictureAreas picture_areas(const std::string& svg, bool fisheye) { return Reader(svg, fisheye).run(); }

}  // namespace exactff::validation
