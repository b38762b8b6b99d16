// A checked request, with everything precomputed that depends on the scene and the sources alone.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactff/render.h"
#include "radiosity/gather.h"
#include "whole_view/light.h"

namespace exactff::render {

inline std::size_t pixels_of(const Size& size) {
  return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
}
// The place of a pixel, row by row.
inline std::size_t pixel_at(const Size& size, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(column);
}

// Threads may share it.
class Job {
 public:
  // Throws InputError as render().
  explicit Job(const Request& request);

  [[nodiscard]] const Request& request() const { return request_; }
  [[nodiscard]] const Size& size() const { return atlas_ ? atlas_->lightmap().size : request_.view.size(); }
  [[nodiscard]] const Atlas* atlas() const { return atlas_.get(); }  // of a lightmap
  [[nodiscard]] std::vector<Layer> layers() const;                   // without values
  [[nodiscard]] Metadata metadata() const;
  // Of everything that the numbers depend on.
  [[nodiscard]] std::string hash() const;

  // The numbers of a pixel: what it shows, its value, then on request lower, upper and layers, and those of
  // Picture::lamps.
  static constexpr std::size_t kShows = 0, kValue = 1, kLower = 4, kUpper = 7, kLamps = 4;
  [[nodiscard]] std::size_t numbers_per_pixel() const;

  // What leaves a face on the side that is seen, in the quantity of the request.
  [[nodiscard]] whole_view::LightFormula formula(FaceId face, bool back) const;
  [[nodiscard]] std::size_t source_count() const { return factors().count(); }
  [[nodiscard]] const whole_view::SourceFactors& factors() const { return gather_ ? gather_->factors() : *factors_; }
  [[nodiscard]] const std::vector<Rgb>& weights() const { return weights_; }  // B_s, or 1
  // What the receiver shows, exactly.
  [[nodiscard]] whole_view::Channels light_at(const Receiver& receiver, const whole_view::LightFormula& formula,
                                              const ExactOptions& options, whole_view::Light::Results& results) const;
  [[nodiscard]] const methods::PreparedScene* prepared() const { return prepared_.get(); }
  [[nodiscard]] const std::vector<const methods::PreparedSource*>& prepared_sources() const { return source_pointers_; }

 private:
  void take_sources();
  void take_radiosities();
  void require_possible() const;
  void require_light_of_patches() const;
  void require_possible_lightmap() const;
  [[nodiscard]] std::vector<std::string> source_names() const;  // of channels
  [[nodiscard]] std::string names_of_sources() const;

  Request request_;
  std::unique_ptr<const Atlas> atlas_;
  std::vector<Selection> sources_;
  std::vector<Rgb> weights_;
  std::unique_ptr<const whole_view::SourceFactors> factors_;
  std::unique_ptr<whole_view::Light> light_;
  std::unique_ptr<radiosity::Gather> gather_;  // instead of factors_ and light_, if radiosities are given
  std::unique_ptr<methods::PreparedScene> prepared_;
  std::vector<std::unique_ptr<methods::PreparedSource>> prepared_sources_;
  std::vector<const methods::PreparedSource*> source_pointers_;
};

// --- Which picture unfinished tiles belong to ---

// With a hash of the texture coordinates. Those of a set that does not exist throw std::invalid_argument.
[[nodiscard]] std::string words_of(const Scene& scene, const Lightmap& lightmap);

// Everything that the tiles of a picture, and those of the method that it is compared with, depend on.
[[nodiscard]] std::string identity_of(const Request& request, const std::optional<methods::Choice>& against);

}  // namespace exactff::render
