// The values of single points.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernel/vec.h"
#include "render/job.h"

namespace exactff::render {
namespace {

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

}  // namespace

Painter::Painter(const Job& job) : job_(job) {
  options_.engine = job.request().engine;
  options_.visible_fraction = job.request().layers == Layers::kAll;
  options_.measure = job.request().measure;
  options_.gradient = job.request().shown == Shown::kSlope;
  if (job.prepared() == nullptr) return;
  evaluator_ = job.prepared()->configure(job.request().method->settings);
  estimates_.resize(job.source_count());
}

void Painter::look_along(const Ray& ray, Sample& sample) {
  const Request& request = job_.request();
  const std::optional<Hit> hit = first_hit(*request.scene, ray);
  const bool black = !hit || (hit->back && request.sides == Sides::kFront);
  Shows shows = !hit ? Shows::kNothing : black ? Shows::kBack : Shows::kFace;
  if (request.shown == Shown::kSlope) {
    sample.numbers.assign(1, static_cast<double>(shows));
    return add_slope(hit ? &*hit : nullptr, black, sample);
  }
  whole_view::Channels channels = dark(hit ? 0.0 : kNothingMet);
  if (!black) {
    const whole_view::LightFormula formula = job_.formula(hit->face, hit->back);
    if (!is_zero(formula.emitted)) shows = Shows::kEmitter;
    channels = light_at(receiver_at(*request.scene, *hit), formula);
  }
  sample.numbers.clear();
  sample.numbers.push_back(static_cast<double>(shows));
  for (const auto& channel : channels) sample.numbers.push_back(channel.value);
  if (request.bounds == Bounds::kAll) {
    for (const auto& channel : channels) sample.numbers.push_back(channel.lower);
    for (const auto& channel : channels) sample.numbers.push_back(channel.upper);
  }
  sample.certified = std::ranges::all_of(channels, &whole_view::CertifiedNumber::certified);
  if (request.layers == Layers::kAll) add_layers(ray, hit ? &*hit : nullptr, black, sample);
}

whole_view::Channels Painter::light_at(const Receiver& receiver, const whole_view::LightFormula& formula) {
  if (evaluator_ != nullptr) return light_by_method(receiver, formula);
  return job_.light_at(receiver, formula, options_, results_);
}

whole_view::Channels Painter::light_by_method(const Receiver& receiver, const whole_view::LightFormula& formula) {
  evaluator_->look_from(receiver);
  evaluator_->form_factors(job_.prepared_sources(), estimates_);
  Rgb received;
  for (std::size_t s = 0; s < estimates_.size(); ++s) {
    const double f = estimates_[s].form_factor;
    const Rgb& weight = job_.weights()[s];
    received = {received.r + weight.r * f, received.g + weight.g * f, received.b + weight.b * f};
  }
  const double factor = formula.pi_power == 0 ? 1.0 : formula.pi_power > 0 ? std::numbers::pi : 1.0 / std::numbers::pi;
  const auto channel = [&](double emitted, double reflectance, double arriving) {
    const double value = factor * (emitted + reflectance * arriving);
    return whole_view::CertifiedNumber{value, value, value, true};
  };
  return {channel(formula.emitted.r, formula.reflectance.r, received.r),
          channel(formula.emitted.g, formula.reflectance.g, received.g),
          channel(formula.emitted.b, formula.reflectance.b, received.b)};
}

// The length of the gradient along the surface, in three channels, its components, and whether there is none.
void Painter::add_slope(const Hit* hit, bool dark, Sample& sample) {
  sample.certified = true;
  if (hit == nullptr || dark) {
    const double value = hit == nullptr ? kNothingMet : 0.0;
    sample.numbers.insert(sample.numbers.end(), {value, value, value, 0.0, 0.0, 0.0, 0.0});
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
  sample.numbers.insert(sample.numbers.end(), {slope, slope, slope, along.x, along.y, along.z, kink ? 1.0 : 0.0});
}

void Painter::add_layers(const Ray& ray, const Hit* hit, bool dark, Sample& sample) const {
  std::vector<double>& numbers = sample.numbers;
  for (std::size_t s = 0; s < job_.source_count(); ++s) {
    if (dark) {
      numbers.insert(numbers.end(), {0.0, 0.0, 0.0});
    } else {
      const FormFactor& factor = results_.at.factors[s];
      numbers.insert(numbers.end(), {factor.value, of_visible(factor), factor.visible_fraction.value_or(0.0)});
    }
  }
  if (hit == nullptr) {
    numbers.insert(numbers.end(), 9, 0.0);
    return;
  }
  const Scene& scene = *job_.request().scene;
  const Receiver receiver = receiver_at(scene, *hit);
  const Vec3 &point = receiver.point, normal = unit_length(receiver.normal);
  numbers.insert(numbers.end(), {point.x, point.y, point.z, normal.x, normal.y, normal.z,
                                 kernel::distance(point, ray.origin), static_cast<double>(index_of(hit->face) + 1),
                                 static_cast<double>(index_of(scene.face(hit->face).patch) + 1)});
}

}  // namespace exactff::render
