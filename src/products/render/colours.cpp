// Numbers to 8-bit colours.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "exactff/render.h"
#include "kernel/float_environment.h"
#include "kernel/statistics.h"

namespace exactff::render {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kWhite{255, 255, 255}, kBright{178, 24, 43}, kDark{33, 102, 172}, kNothingShown{214, 214, 214},
    kOutline{20, 20, 20};

// IEC 61966-2-1. NaN gives black.
std::uint8_t srgb(double linear) {
  if (!(linear > 0.0)) return 0;
  if (linear >= 1.0) return 255;
  const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

Colour between(const Colour& from, const Colour& to, double share) {
  Colour mixed;
  for (std::size_t c = 0; c < 3; ++c) {
    mixed[c] = static_cast<std::uint8_t>(std::lround(from[c] + share * (to[c] - from[c])));
  }
  return mixed;
}

Colour colour_of(double error, double scale) {
  if (std::isnan(error)) return kNothingShown;
  return between(kWhite, error > 0.0 ? kBright : kDark, std::min(std::abs(error) / scale, 1.0));
}

// Around the regions in which most pixels are wrong. Specks of noise have no outline of their own.
class Outline {
 public:
  Outline(const Errors& errors, const Size& size) : size_(size), wrong_before_(count(size.width + 1, size.height + 1)) {
    for (int row = 0; row < size.height; ++row) {
      std::uint32_t in_row = 0;
      for (int column = 0; column < size.width; ++column) {
        in_row += errors.is_wrong[count(row, size.width) + static_cast<std::size_t>(column)] ? 1 : 0;
        wrong_before_[count(row + 1, size.width + 1) + static_cast<std::size_t>(column + 1)] =
            before(column + 1, row) + in_row;
      }
    }
  }

  [[nodiscard]] bool passes(int column, int row) const {
    if (!mostly_wrong(column, row)) return false;
    return !mostly_wrong(column - 1, row) || !mostly_wrong(column + 1, row) || !mostly_wrong(column, row - 1) ||
           !mostly_wrong(column, row + 1);
  }

 private:
  static std::size_t count(int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); }
  // The number of wrong pixels above and to the left of this corner.
  [[nodiscard]] std::uint32_t before(int column, int row) const {
    return wrong_before_[count(row, size_.width + 1) + static_cast<std::size_t>(column)];
  }

  // Of the square around the pixel, as far as it lies in the picture.
  [[nodiscard]] bool mostly_wrong(int column, int row) const {
    if (column < 0 || row < 0 || column >= size_.width || row >= size_.height) return true;  // no outline at the rim
    constexpr int kReach = 5;
    const int left = std::max(column - kReach, 0), right = std::min(column + kReach + 1, size_.width);
    const int top = std::max(row - kReach, 0), bottom = std::min(row + kReach + 1, size_.height);
    const std::uint32_t wrong = before(right, bottom) - before(left, bottom) - before(right, top) + before(left, top);
    return 2 * wrong > static_cast<std::uint32_t>((right - left) * (bottom - top));
  }

  Size size_;
  std::vector<std::uint32_t> wrong_before_;
};

// 1 is white.
double brightness(const Picture& picture, std::size_t pixel, std::size_t channel, double exposure) {
  const double whole = exposure * picture.values[3 * pixel + channel];
  if (picture.lamps.empty()) return whole;
  const double share = picture.lamps[4 * pixel], lamps = exposure * picture.lamps[4 * pixel + 1 + channel];
  return std::min(lamps, share) + std::min(whole - lamps, 1.0 - share);
}

}  // namespace

double automatic_exposure(const Picture& picture) {
  const kernel::StandardArithmetic arithmetic;
  constexpr double kShare = 0.99, kTarget = 0.8;
  std::vector<double> brightest;
  for (const Shows least : {Shows::kFace, Shows::kNothing}) {  // if nothing reflects light, of all pixels
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
      if (least == Shows::kFace && picture.shows[i] != Shows::kFace) continue;
      const double* rgb = &picture.values[3 * i];
      const double largest = std::max({rgb[0], rgb[1], rgb[2]});
      if (std::isfinite(largest)) brightest.push_back(largest);
    }
    if (!brightest.empty() && *std::ranges::max_element(brightest) > 0.0) break;
    brightest.clear();
  }
  if (brightest.empty()) return 1.0;
  const auto place =
      brightest.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(brightest.size() - 1));
  std::nth_element(brightest.begin(), place, brightest.end());
  const double bright = *place > 0.0 ? *place : *std::ranges::max_element(brightest);
  const double exposure = kTarget / bright;
  return std::isfinite(exposure) ? exposure : 1.0;
}

Colours develop(const Picture& picture, double exposure) {
  const kernel::StandardArithmetic arithmetic;
  Colours colours{picture.size, {}};
  colours.bytes.reserve(picture.values.size());
  for (std::size_t pixel = 0; pixel < picture.pixels(); ++pixel) {
    for (std::size_t c = 0; c < 3; ++c) colours.bytes.push_back(srgb(brightness(picture, pixel, c, exposure)));
  }
  return colours;
}

Colours coloured(const Errors& errors, const Size& size, double scale) {
  const kernel::StandardArithmetic arithmetic;
  Colours colours{size, {}};
  colours.bytes.reserve(3 * errors.signed_errors.size());
  const Outline outline(errors, size);
  std::size_t pixel = 0;
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column, ++pixel) {
      const Colour colour = outline.passes(column, row) ? kOutline : colour_of(errors.signed_errors[pixel], scale);
      colours.bytes.insert(colours.bytes.end(), colour.begin(), colour.end());
    }
  }
  return colours;
}

// --- The errors of one picture against another ---

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinitelyWrong = std::numeric_limits<double>::infinity();

struct PixelError {
  double error = 0.0;
  double relative = 0.0;
};

// Of the channel with the largest error. A value that is not finite is infinitely wrong.
PixelError error_of(const double* judged, const double* truth) {
  PixelError worst;
  for (int c = 0; c < 3; ++c) {
    const double error = judged[c] - truth[c];
    if (!std::isfinite(error)) return {kInfinitelyWrong, kInfinitelyWrong};
    if (std::abs(error) <= std::abs(worst.error)) continue;
    worst = {error, std::abs(error) / std::abs(truth[c])};
  }
  return worst;
}

void set_statistics(Errors& errors, std::vector<double> magnitudes, std::vector<double> relative) {
  errors.pixels = magnitudes.size();
  const kernel::Distribution absolute = kernel::distribution(std::move(magnitudes));
  const kernel::Distribution shares = kernel::distribution(std::move(relative));
  errors.p99 = absolute.p99;
  errors.worst = absolute.max;
  errors.rms = absolute.rms;
  errors.relative_median = shares.median;
  errors.relative_p99 = shares.p99;
}

void require_same_size(const Picture& judged, const Picture& truth) {
  if (judged.size.width != truth.size.width || judged.size.height != truth.size.height) {
    throw std::invalid_argument("the two pictures differ in size");
  }
}

std::string method_of(const Picture& picture) {
  const auto found = std::ranges::find(picture.metadata, "method", &std::pair<std::string, std::string>::first);
  return found == picture.metadata.end() ? "the other picture" : found->second;
}

}  // namespace

Errors errors_of(const Picture& judged, const Picture& truth) {
  const kernel::StandardArithmetic arithmetic;
  require_same_size(judged, truth);
  Errors errors;
  errors.signed_errors.assign(truth.pixels(), kNaN);
  errors.is_wrong.assign(truth.pixels(), false);
  std::vector<double> magnitudes, relative;
  for (std::size_t i = 0; i < truth.pixels(); ++i) {
    if (truth.shows[i] == Shows::kNothing) continue;
    const PixelError pixel = error_of(&judged.values[3 * i], &truth.values[3 * i]);
    errors.signed_errors[i] = pixel.error;
    errors.is_wrong[i] = pixel.relative > kWrong;
    if (errors.is_wrong[i]) ++errors.wrong;
    magnitudes.push_back(std::abs(pixel.error));
    relative.push_back(pixel.relative);
  }
  set_statistics(errors, std::move(magnitudes), std::move(relative));
  return errors;
}

Picture difference(const Picture& judged, const Picture& truth) {
  const kernel::StandardArithmetic arithmetic;
  require_same_size(judged, truth);
  Picture picture;
  picture.size = truth.size;
  picture.shows = truth.shows;
  picture.metadata = judged.metadata;
  picture.metadata.emplace_back("difference", "this method minus " + method_of(truth));
  picture.values.reserve(truth.values.size());
  for (std::size_t i = 0; i < truth.values.size(); ++i) {
    picture.values.push_back(truth.shows[i / 3] == Shows::kNothing ? kNaN : judged.values[i] - truth.values[i]);
  }
  std::ranges::copy_if(truth.layers, std::back_inserter(picture.layers),
                       [](const Layer& layer) { return layer.name == "A"; });  // of a lightmap
  return picture;
}

double colour_scale(const Errors& errors) {
  return errors.p99 > 0.0 ? errors.p99 : errors.worst > 0.0 ? errors.worst : 1.0;
}

}  // namespace exactff::render
