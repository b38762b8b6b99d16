// Computes a picture tile by tile.
#include "exactff/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "files/parallel.h"
#include "files/stopwatch.h"
#include "jobs/kept_work.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "render/job.h"
#include "whole_view/light.h"

namespace exactff::render {
namespace {

constexpr int kTileSide = 16;

struct Tile {
  int left = 0, top = 0, width = 0, height = 0;
};

class Tiles {
 public:
  explicit Tiles(const Size& size)
      : size_(size),
        columns_((size.width + kTileSide - 1) / kTileSide),
        rows_((size.height + kTileSide - 1) / kTileSide) {}

  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  }
  [[nodiscard]] Tile operator[](std::size_t index) const {
    const auto columns = static_cast<std::size_t>(columns_);
    const int left = static_cast<int>(index % columns) * kTileSide, top = static_cast<int>(index / columns) * kTileSide;
    return {left, top, std::min(kTileSide, size_.width - left), std::min(kTileSide, size_.height - top)};
  }

 private:
  Size size_;
  int columns_, rows_;
};

// The result of a tile: the numbers of its pixels one after the other, as Numbers lists them.
struct TileResult {
  std::vector<double> numbers;
  std::uint64_t not_certified = 0;
  double seconds = 0.0;
};

// Rounded once. NaN if a method has given a value that is not finite.
double mean(std::span<const double> values) {
  kernel::Rational sum = 0;
  for (const double value : values) {
    if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
    sum += kernel::to_rational(value);
  }
  return kernel::nearest_double(kernel::Rational(sum / static_cast<unsigned long>(values.size())));
}

// Computes pixels in one thread.
class Brush {
 public:
  explicit Brush(const Job& job) : job_(job), painter_(job) {}

  void paint(const Tile& tile, TileResult& result) {
    const double start = files::thread_seconds();
    result = {};
    result.numbers.reserve(static_cast<std::size_t>(tile.width * tile.height) * job_.numbers_per_pixel());
    for (int row = tile.top; row < tile.top + tile.height; ++row) {
      for (int column = tile.left; column < tile.left + tile.width; ++column) paint_pixel(column, row, result);
    }
    result.seconds = files::thread_seconds() - start;
  }

 private:
  void paint_pixel(int column, int row, TileResult& result) {
    const int n = job_.request().spp;
    if (n == 1) {
      look(column + 0.5, row + 0.5, result);
      result.numbers.insert(result.numbers.end(), sample_.numbers.begin(), sample_.numbers.end());
      return;
    }
    parts_.clear();
    for (int b = 0; b < n; ++b) {
      for (int a = 0; a < n; ++a) {
        look(column + (a + 0.5) / n, row + (b + 0.5) / n, result);
        parts_.push_back(sample_.numbers);
      }
    }
    append_mean(result.numbers);
    append_lamps(result.numbers);
  }

  void look(double column, double row, TileResult& result) {
    painter_.look_along(job_.request().view.ray(column, row), sample_);
    if (!sample_.certified) ++result.not_certified;
  }

  // The bounds are means as well, moved outward by one double for the rounding.
  void append_mean(std::vector<double>& numbers) {
    constexpr double kUpwards = std::numeric_limits<double>::infinity();
    double shows = 0.0;
    for (const auto& part : parts_) shows = std::max(shows, part[Job::kShows]);
    numbers.push_back(shows);
    for (std::size_t i = 1; i < parts_.front().size(); ++i) {
      column_.clear();
      for (const auto& part : parts_) column_.push_back(std::isnan(part[i]) ? 0.0 : part[i]);
      double value = shows == 0.0 ? std::numeric_limits<double>::quiet_NaN() : mean(column_);
      const bool all_zero = std::ranges::all_of(column_, [](double part) { return part == 0.0; });
      if (i >= Job::kLower && i < Job::kUpper && !all_zero) value = std::max(0.0, std::nextafter(value, -1.0));
      if (i >= Job::kUpper && !all_zero) value = std::nextafter(value, kUpwards);
      numbers.push_back(value);
    }
  }

  void append_lamps(std::vector<double>& numbers) const {
    std::array<double, Job::kLamps> lamps{};
    for (const auto& part : parts_) {
      if (part[Job::kShows] != static_cast<double>(Shows::kEmitter)) continue;
      lamps[0] += 1.0;
      for (std::size_t c = 0; c < 3; ++c) lamps[1 + c] += part[Job::kValue + c];
    }
    for (const double sum : lamps) numbers.push_back(sum / static_cast<double>(parts_.size()));
  }

  const Job& job_;
  Painter painter_;
  Sample sample_;
  std::vector<std::vector<double>> parts_;
  std::vector<double> column_;
};

// Brushes that no thread uses at the moment.
class Brushes {
 public:
  explicit Brushes(const Job& job) : job_(job) {}

  void paint(const Tile& tile, TileResult& result) {
    std::unique_ptr<Brush> brush = take();
    brush->paint(tile, result);
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(brush));
  }

 private:
  std::unique_ptr<Brush> take() {
    {
      const std::scoped_lock lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<Brush> brush = std::move(free_.back());
        free_.pop_back();
        return brush;
      }
    }
    return std::make_unique<Brush>(job_);
  }

  const Job& job_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Brush>> free_;
};

Picture empty_picture(const Job& job) {
  const Size size = job.request().view.size();
  const std::size_t pixels = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
  Picture picture;
  picture.size = size;
  picture.values.resize(3 * pixels);
  picture.shows.resize(pixels);
  if (job.request().bounds == Bounds::kAll) {
    picture.lower.resize(3 * pixels);
    picture.upper.resize(3 * pixels);
  }
  if (job.request().spp > 1) picture.lamps.resize(Job::kLamps * pixels);
  picture.layers = job.layers();
  for (Layer& layer : picture.layers) layer.values.resize(pixels);
  picture.metadata = job.metadata();
  return picture;
}

void place(const Tile& tile, const TileResult& result, Picture& picture) {
  const double* number = result.numbers.data();
  for (int row = tile.top; row < tile.top + tile.height; ++row) {
    for (int column = tile.left; column < tile.left + tile.width; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.size.width) +
                                static_cast<std::size_t>(column);
      picture.shows[pixel] = static_cast<Shows>(*number++);
      for (std::vector<double>* plane : {&picture.values, &picture.lower, &picture.upper}) {
        if (plane->empty()) continue;
        for (std::size_t c = 0; c < 3; ++c) (*plane)[3 * pixel + c] = *number++;
      }
      for (Layer& layer : picture.layers) layer.values[pixel] = *number++;
      if (picture.lamps.empty()) continue;
      for (std::size_t k = 0; k < Job::kLamps; ++k) picture.lamps[Job::kLamps * pixel + k] = *number++;
    }
  }
}

// Under given radiosities, the bounds are those of an image and belong into its file.
void add_bounds_as_layers(Picture& picture) {
  const auto add = [&](const std::string& name, const std::vector<double>& bounds) {
    for (std::size_t c = 0; c < 3; ++c) {
      Layer& layer = picture.layers.emplace_back(Layer{name + '.' + "RGB"[c], false, {}});
      for (std::size_t i = c; i < bounds.size(); i += 3) layer.values.push_back(bounds[i]);
    }
  };
  add("lower", picture.lower);
  add("upper", picture.upper);
}

}  // namespace

Picture render(const Request& request, const Hooks& hooks, jobs::Journal* journal) {
  const kernel::StandardArithmetic arithmetic;
  const Job job(request);
  Picture picture = empty_picture(job);
  const Tiles tiles(picture.size);
  const jobs::KeptWork kept(journal, job.hash());
  Brushes brushes(job);
  std::mutex mutex;
  const std::string stage = request.method ? "tiles, " + request.method->method->name : "tiles";
  files::parallel_for(tiles.count(), request.threads, stage, hooks, [&](std::size_t index) {
    TileResult result;
    const Tile tile = tiles[index];
    kept.get(
        "tile-" + std::to_string(index), [&] { brushes.paint(tile, result); },
        [&](auto& words) {
          words.list_of(static_cast<std::size_t>(tile.width * tile.height) * job.numbers_per_pixel(), result.numbers);
          words(result.not_certified, result.seconds);
        });
    place(tile, result, picture);
    const std::scoped_lock lock(mutex);
    picture.not_certified += result.not_certified;
    picture.seconds += result.seconds;
  });
  if (request.radiosities && request.bounds == Bounds::kAll) add_bounds_as_layers(picture);
  return picture;
}

}  // namespace exactff::render
