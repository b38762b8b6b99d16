// The errors of one picture against another.
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "exactff/render.h"
#include "kernel/float_environment.h"
#include "kernel/statistics.h"

namespace exactff::render {
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

namespace {

std::string method_of(const Picture& picture) {
  const auto found = std::ranges::find(picture.metadata, "method", &std::pair<std::string, std::string>::first);
  return found == picture.metadata.end() ? "the other picture" : found->second;
}

}  // namespace

Picture difference(const Picture& judged, const Picture& truth) {
  const kernel::StandardArithmetic arithmetic;
  require_same_size(judged, truth);
  Picture picture;
  picture.size = truth.size;
  picture.shows = truth.shows;
  picture.metadata = judged.metadata;
  picture.metadata.emplace_back("difference", "this method minus " + method_of(truth));
  picture.values.reserve(truth.values.size());
  for (std::size_t i = 0; i < truth.values.size(); ++i) picture.values.push_back(judged.values[i] - truth.values[i]);
  return picture;
}

double colour_scale(const Errors& errors) {
  return errors.p99 > 0.0 ? errors.p99 : errors.worst > 0.0 ? errors.worst : 1.0;
}

}  // namespace exactff::render
