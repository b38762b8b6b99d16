// Computes a picture tile by tile.
#include "exactff/render.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>

#include "files/parallel.h"
#include "files/stopwatch.h"
#include "jobs/kept_work.h"
#include "kernel/float_environment.h"
#include "kernel/numbers.h"
#include "kernel/vec.h"
#include "render/job.h"
#include "whole_view/light.h"

namespace exactff::render {
namespace {

constexpr int kTileSide = 16;

struct Tile {
  int left = 0, top = 0, width = 0, height = 0;
};

int tiles_along(int side) { return (side + kTileSide - 1) / kTileSide; }

Tile tile_at(const Size& size, std::size_t index) {
  const auto columns = static_cast<std::size_t>(tiles_along(size.width));
  const int left = static_cast<int>(index % columns) * kTileSide, top = static_cast<int>(index / columns) * kTileSide;
  return {left, top, std::min(kTileSide, size.width - left), std::min(kTileSide, size.height - top)};
}

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

constexpr double kNothingMet = std::numeric_limits<double>::quiet_NaN();

// Without any light: what is proved to be black, or nothing at all.
whole_view::Channels dark(double value) {
  const whole_view::CertifiedNumber number{value, value, value, true};
  return {number, number, number};
}

bool is_zero(const Rgb& colour) { return colour == Rgb{}; }

Vec3 unit_length(const Vec3& v) { return kernel::unit_unscaled(kernel::scaled(v, 1.0 / kernel::max_norm(v))); }

double of_visible(const FormFactor& factor) {
  return static_cast<double>(factor.visible_part.value_or(VisiblePart::kNothing));
}

// Computes single points, and pixels of them. One for each thread.
class Painter {
 public:
  explicit Painter(const Job& job) : job_(job) {
    options_.engine = job.request().engine;
    options_.visible_fraction = job.request().layers == Layers::kAll;
    options_.measure = job.request().measure;
    options_.gradient = job.request().shown == Shown::kSlope;
    if (job.prepared() == nullptr) return;
    evaluator_ = job.prepared()->configure(job.request().method->settings);
    estimates_.resize(job.source_count());
  }

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
      look_at(column + 0.5, row + 0.5, result);
      result.numbers.insert(result.numbers.end(), numbers_.begin(), numbers_.end());
      return;
    }
    parts_.clear();
    for (int b = 0; b < n; ++b) {
      for (int a = 0; a < n; ++a) {
        look_at(column + (a + 0.5) / n, row + (b + 0.5) / n, result);
        parts_.push_back(numbers_);
      }
    }
    append_mean(result.numbers);
    append_lamps(result.numbers);
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

  // Column and row as for View::ray, of a lightmap those of a texel's centre. The numbers are in the order of Job.
  void look_at(double column, double row, TileResult& result) {
    const Request& request = job_.request();
    const Atlas* atlas = job_.atlas();
    const Ray ray = atlas != nullptr ? Ray{} : request.view.ray(column, row);
    const std::optional<Hit> hit =
        atlas != nullptr ? atlas->hit(static_cast<int>(column), static_cast<int>(row)) : first_hit(*request.scene, ray);
    const bool black = !hit || (hit->back && request.sides == Sides::kFront);
    Shows shows = !hit ? Shows::kNothing : black ? Shows::kBack : Shows::kFace;
    if (request.shown == Shown::kSlope) {
      numbers_.assign(1, static_cast<double>(shows));
      return add_slope(hit ? &*hit : nullptr, black);
    }
    whole_view::Channels channels = dark(hit ? 0.0 : kNothingMet);
    if (!black) {
      const whole_view::LightFormula formula = job_.formula(hit->face, hit->back);
      if (!is_zero(formula.emitted)) shows = Shows::kEmitter;
      channels = light_at(receiver_at(*request.scene, *hit), formula);
    }
    numbers_.clear();
    numbers_.push_back(static_cast<double>(shows));
    for (const auto& channel : channels) numbers_.push_back(channel.value);
    if (request.bounds == Bounds::kAll) {
      for (const auto& channel : channels) numbers_.push_back(channel.lower);
      for (const auto& channel : channels) numbers_.push_back(channel.upper);
    }
    if (!std::ranges::all_of(channels, &whole_view::CertifiedNumber::certified)) ++result.not_certified;
    if (request.layers == Layers::kAll) add_layers(ray.origin, hit ? &*hit : nullptr, black);
  }

  [[nodiscard]] whole_view::Channels light_at(const Receiver& receiver, const whole_view::LightFormula& formula) {
    if (evaluator_ != nullptr) return light_by_method(receiver, formula);
    return job_.light_at(receiver, formula, options_, results_);
  }

  [[nodiscard]] whole_view::Channels light_by_method(const Receiver& receiver,
                                                     const whole_view::LightFormula& formula) {
    evaluator_->look_from(receiver);
    evaluator_->form_factors(job_.prepared_sources(), estimates_);
    Rgb received;
    for (std::size_t s = 0; s < estimates_.size(); ++s) {
      const double f = estimates_[s].form_factor;
      const Rgb& weight = job_.weights()[s];
      received = {received.r + weight.r * f, received.g + weight.g * f, received.b + weight.b * f};
    }
    const double factor = formula.pi_power == 0  ? 1.0
                          : formula.pi_power > 0 ? std::numbers::pi
                                                 : 1.0 / std::numbers::pi;
    const auto channel = [&](double emitted, double reflectance, double arriving) {
      const double value = factor * (emitted + reflectance * arriving);
      return whole_view::CertifiedNumber{value, value, value, true};
    };
    return {channel(formula.emitted.r, formula.reflectance.r, received.r),
            channel(formula.emitted.g, formula.reflectance.g, received.g),
            channel(formula.emitted.b, formula.reflectance.b, received.b)};
  }

  // The length of the gradient along the surface, in three channels, its components, and whether there is none.
  void add_slope(const Hit* hit, bool dark) {
    if (hit == nullptr || dark) {
      const double value = hit == nullptr ? kNothingMet : 0.0;
      numbers_.insert(numbers_.end(), {value, value, value, 0.0, 0.0, 0.0, 0.0});
      return;
    }
    const Receiver receiver = receiver_at(*job_.request().scene, *hit);
    Vec3 gradient;
    bool kink = false;
    for (std::size_t s = 0; s < job_.source_count(); ++s) {
      job_.factors().find_one(receiver, s, options_, factor_, results_.at);
      const auto& [x, y, z] = factor_.gradient->position;
      kink = kink || factor_.gradient->kink.has_value();
      gradient = {gradient.x + x.value, gradient.y + y.value, gradient.z + z.value};
    }
    if (kink) gradient = {};
    const Vec3 normal = unit_length(receiver.normal);
    const double across = kernel::dot(gradient, normal);
    const Vec3 along{gradient.x - across * normal.x, gradient.y - across * normal.y, gradient.z - across * normal.z};
    const double slope = std::hypot(along.x, along.y, along.z);
    numbers_.insert(numbers_.end(), {slope, slope, slope, along.x, along.y, along.z, kink ? 1.0 : 0.0});
  }

  void add_layers(const Vec3& eye, const Hit* hit, bool dark) {
    for (std::size_t s = 0; s < job_.source_count(); ++s) {
      if (dark) {
        numbers_.insert(numbers_.end(), {0.0, 0.0, 0.0});
      } else {
        const FormFactor& factor = results_.at.factors[s];
        numbers_.insert(numbers_.end(), {factor.value, of_visible(factor), factor.visible_fraction.value_or(0.0)});
      }
    }
    if (hit == nullptr) {
      numbers_.insert(numbers_.end(), job_.atlas() != nullptr ? 8 : 9, 0.0);
      return;
    }
    const Scene& scene = *job_.request().scene;
    const Receiver receiver = receiver_at(scene, *hit);
    const Vec3 &point = receiver.point, normal = unit_length(receiver.normal);
    numbers_.insert(numbers_.end(), {point.x, point.y, point.z, normal.x, normal.y, normal.z});
    if (job_.atlas() == nullptr) numbers_.push_back(kernel::distance(point, eye));
    for (const std::size_t id : {index_of(hit->face), index_of(scene.face(hit->face).patch)})
      numbers_.push_back(static_cast<double>(id + 1));
  }

  const Job& job_;
  ExactOptions options_;
  whole_view::Light::Results results_;
  FormFactor factor_;
  std::unique_ptr<methods::Evaluator> evaluator_;
  std::vector<methods::Estimate> estimates_;
  std::vector<double> numbers_;             // of the last point
  std::vector<std::vector<double>> parts_;  // of a pixel
  std::vector<double> column_;
};

Picture empty_picture(const Job& job) {
  const Size size = job.size();
  const std::size_t pixels = pixels_of(size);
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
      const std::size_t pixel = pixel_at(picture.size, column, row);
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

// --- Lightmaps ---

void add_alpha(Picture& picture) {
  Layer& alpha = picture.layers.emplace_back(Layer{"A", false, {}});
  for (const Shows shows : picture.shows) alpha.values.push_back(shows == Shows::kNothing ? 0.0 : 1.0);
}

// A texel is copied from one beside it that has a value already: left, right, above, below, then diagonally.
void add_margin(int width, Picture& picture) {
  if (width == 0) return;
  constexpr std::array<std::array<int, 2>, 8> kBeside = {
      {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}}};
  Layer& margin = picture.layers.emplace_back(Layer{"margin", true, std::vector<double>(picture.pixels())});
  const auto texel = [&](int column, int row) { return pixel_at(picture.size, column, row); };
  const auto has_value = [&](std::size_t i) { return picture.shows[i] != Shows::kNothing || margin.values[i] > 0.0; };
  std::vector<std::array<std::size_t, 2>> copied(1);  // from, to
  for (int step = 1; step <= width && !copied.empty(); ++step) {
    copied.clear();
    for (int row = 0; row < picture.size.height; ++row) {
      for (int column = 0; column < picture.size.width; ++column) {
        if (has_value(texel(column, row))) continue;
        for (const auto& [right, down] : kBeside) {
          const int x = column + right, y = row + down;
          if (x < 0 || y < 0 || x >= picture.size.width || y >= picture.size.height || !has_value(texel(x, y)))
            continue;
          copied.push_back({texel(x, y), texel(column, row)});
          break;
        }
      }
    }
    for (const auto& [from, to] : copied) {
      std::copy_n(&picture.values[3 * from], 3, &picture.values[3 * to]);
      margin.values[to] = step;
    }
  }
}

}  // namespace

Picture render(const Request& request, const Hooks& hooks, jobs::Journal* journal) {
  const kernel::StandardArithmetic arithmetic;
  const Job job(request);
  Picture picture = empty_picture(job);
  const jobs::KeptWork kept(journal, job.hash());
  std::mutex mutex;
  const std::string stage = request.method ? "tiles, " + request.method->method->name : "tiles";
  const auto paint = [&](std::shared_ptr<Painter>& painter, std::size_t index) {
    TileResult result;
    const Tile tile = tile_at(picture.size, index);
    const auto compute = [&] {
      if (!painter) painter = std::make_shared<Painter>(job);
      painter->paint(tile, result);
    };
    kept.get("tile-" + std::to_string(index), compute, [&](auto& words) {
      words.list_of(static_cast<std::size_t>(tile.width * tile.height) * job.numbers_per_pixel(), result.numbers);
      words(result.not_certified, result.seconds);
    });
    place(tile, result, picture);
    const std::scoped_lock lock(mutex);
    picture.not_certified += result.not_certified;
    picture.seconds += result.seconds;
  };
  const std::size_t tiles = pixels_of({tiles_along(picture.size.width), tiles_along(picture.size.height)});
  files::parallel_for({.count = tiles, .threads = request.threads, .stage = stage}, hooks, [&]() -> files::Body {
    return [&, painter = std::shared_ptr<Painter>()](std::size_t index) mutable { paint(painter, index); };
  });
  if (request.radiosities && request.bounds == Bounds::kAll) add_bounds_as_layers(picture);
  if (const Atlas* atlas = job.atlas()) {
    picture.charts = atlas->charts();
    add_alpha(picture);
    add_margin(atlas->lightmap().margin, picture);
  }
  return picture;
}

}  // namespace exactff::render
