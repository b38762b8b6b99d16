#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "exactff/render.h"
#include "kernel/vec.h"
#include "report/report.h"
#include "study/runs.h"
#include "study/settings.h"
#include "text/phrases.h"

namespace exactff::report {
namespace {

constexpr int kWidth = 192, kHeight = 144;  // of the largest picture
constexpr int kLeastHeight = 36;
constexpr const char* kLeftOut = "pictures of the scene";

// Seconds per pixel that a method is planned to need, from its counted work at some of the receivers.
double planned_seconds_per_pixel(const Study& study, const methods::Choice& choice) {
  constexpr std::size_t kMostPoints = 12;
  constexpr double kTooDear = 1.0;  // seconds for a pixel
  const study::PreparedMethod prepared(*choice.method, *study.request.scene, study.request.sources);
  study::Estimator estimator(choice, prepared, kTooDear);
  const std::size_t all = study.request.receivers.size(), points = std::min(all, kMostPoints);
  double seconds = 0.0;
  for (std::size_t i = 0; i < points; ++i) {
    seconds += estimator.seconds_at(study.request.receivers[(2 * i + 1) * all / (2 * points)]);
  }
  return seconds / static_cast<double>(points);
}

// As large as two seconds of planned time allow, which is less than one in most scenes; nothing if even the smallest
// picture would take several seconds.
std::optional<render::Size> affordable_size(double seconds_per_pixel) {
  constexpr double kBudget = 2.0, kMost = 4.0;
  const double ratio = double{kWidth} / kHeight;
  const auto height = static_cast<int>(
      std::clamp(std::sqrt(kBudget / (seconds_per_pixel * ratio)), double{kLeastHeight}, double{kHeight}));
  const render::Size size{static_cast<int>(std::lround(height * ratio)), height};
  if (seconds_per_pixel * size.width * size.height > kMost) return std::nullopt;
  return size;
}

std::set<PatchId> patches_of_receivers(const Study& study) {
  std::set<PatchId> patches;
  for (const Receiver& receiver : study.request.receivers) {
    if (!receiver.on.empty()) patches.insert(study.request.scene->face(receiver.on.front()).patch);
  }
  return patches;
}

// Which pixels show the patches of the receivers.
class Membership {
 public:
  Membership(const Study& study, const render::View& view) : size_(view.size()) {
    const std::set<PatchId> patches = patches_of_receivers(study);
    const Scene& scene = *study.request.scene;
    for (int row = 0; row < size_.height; ++row) {
      for (int column = 0; column < size_.width; ++column) {
        const auto hit = render::first_hit(scene, view.ray(column + 0.5, row + 0.5));
        const bool shows = hit && !hit->back && patches.contains(scene.face(hit->face).patch);
        if (shows) seen_.insert(scene.face(hit->face).patch);
        shows_.push_back(shows);
      }
    }
  }

  [[nodiscard]] const std::set<PatchId>& seen() const { return seen_; }
  [[nodiscard]] auto pixels() const { return std::ranges::count(shows_, true); }

  // Draws the outline: the pixels of the patches that have a neighbour of another kind.
  void outline(render::Colours& colours) const {
    constexpr std::array<std::uint8_t, 3> kGreen = {0, 190, 110};
    for (int row = 0; row < size_.height; ++row) {
      for (int column = 0; column < size_.width; ++column) {
        if (!at(column, row)) continue;
        const bool inside = at(column - 1, row) && at(column + 1, row) && at(column, row - 1) && at(column, row + 1);
        if (!inside)
          std::ranges::copy(kGreen, colours.bytes.begin() + 3 * static_cast<std::ptrdiff_t>(place(column, row)));
      }
    }
  }

 private:
  [[nodiscard]] std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(size_.width) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool at(int column, int row) const {
    const bool in_picture = column >= 0 && row >= 0 && column < size_.width && row < size_.height;
    return in_picture && shows_[place(column, row)];
  }

  render::Size size_;
  std::vector<bool> shows_;
  std::set<PatchId> seen_;
};

struct Ball {
  Vec3 centre = {};
  double radius = 0.0;
};
Ball ball_of_receivers_patches(const Study& study) {
  const std::set<PatchId> patches = patches_of_receivers(study);
  const Scene& scene = *study.request.scene;
  std::vector<Vec3> points;
  for (const Piece& piece : scene.pieces()) {
    if (!patches.contains(scene.face(piece.face).patch)) continue;
    for (const std::uint32_t v : scene.corners(piece)) points.push_back(scene.vertices()[v]);
  }
  Ball ball;
  for (const Vec3& p : points) ball.centre = kernel::along(ball.centre, p, 1.0 / static_cast<double>(points.size()));
  for (const Vec3& p : points) ball.radius = std::max(ball.radius, kernel::distance(p, ball.centre));
  return ball;
}

// Shows the patches of the receivers from their front: from 45 degrees above them, on the side and at the distance from
// which most of them is seen. Nothing if they cannot be seen.
std::optional<render::View> view_of_receivers(const Study& study, const render::Size& size) {
  constexpr int kSides = 8;
  constexpr std::array<double, 3> kDistances = {2.1, 1.2, 0.7};  // over the radius; nearer ones only if it must be
  const Ball ball = ball_of_receivers_patches(study);
  if (!(ball.radius > 0.0)) return std::nullopt;
  const Vec3 up = kernel::unit_unscaled(study.request.receivers.front().normal);
  const Vec3 along = kernel::unit_unscaled(kernel::cross(up, std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 across = kernel::cross(up, along);
  std::optional<render::View> best;
  std::ptrdiff_t most = 0;
  for (const double distance : kDistances) {
    for (int side = 0; side < kSides; ++side) {
      const double angle = 2.0 * std::numbers::pi * side / kSides;
      const Vec3 level = kernel::along(kernel::scaled(along, std::cos(angle)), across, std::sin(angle));
      render::Camera camera;
      camera.look = ball.centre;
      camera.up = up;
      camera.eye =
          kernel::along(ball.centre, kernel::along(level, up, 1.0), distance * ball.radius / std::numbers::sqrt2);
      const auto pixels = Membership(study, render::View(camera, {kWidth / 6, kHeight / 6})).pixels();
      if (pixels <= most) continue;
      most = pixels;
      best = render::View(camera, size);
    }
    if (best) break;
  }
  return best;
}

double brightest_pixel(const render::Picture& picture) {
  double brightest = 0.0;
  for (std::size_t i = 0; i < picture.pixels(); ++i) {
    if (picture.shows[i] != render::Shows::kFace) continue;
    brightest = std::max({brightest, picture.values[3 * i], picture.values[3 * i + 1], picture.values[3 * i + 2]});
  }
  return brightest;
}

std::string names_of(const Scene& scene, const std::set<PatchId>& patches) {
  std::vector<std::string> names;
  for (const PatchId patch : patches) names.push_back(scene.name_of(Selection{patch, std::nullopt, kAnyScene}));
  constexpr std::size_t kMost = 3;
  if (names.size() > kMost) return text::counted(names.size(), "patch", "patches");
  return text::enumerate(names);
}

std::optional<Strip> draw_strip(const Study& study, const Shown& shown, const render::Size& size, const Hooks& hooks) {
  render::Request request{.scene = study.request.scene};
  const std::optional<render::Camera>& given = study.request.camera;
  const auto chosen = [&] {
    return render::default_camera(*study.request.scene, {.up = study.request.up.value_or(Vec3{})}, size);
  };
  request.view = render::View(given ? *given : chosen(), size);
  request.sources = study.request.sources;
  request.threads = study.request.threads;
  render::Picture exact = render::render(request, hooks);
  const auto is_dull = [&] { return Membership(study, request.view).pixels() == 0 || !(brightest_pixel(exact) > 0.0); };
  if (!given && is_dull()) {
    if (const auto view = view_of_receivers(study, size)) {
      request.view = *view;
      exact = render::render(request, hooks);
    }
  }
  const double brightest = brightest_pixel(exact);
  if (!(brightest > 0.0)) return std::nullopt;
  request.method = shown.choice;
  const render::Picture judged = render::render(request, hooks);
  const render::Errors errors = render::errors_of(judged, exact);
  const double scale = render::colour_scale(errors), exposure = render::automatic_exposure(exact);
  const Membership membership(study, request.view);
  const auto png = [&](render::Colours colours) {
    membership.outline(colours);
    return render::png_of(colours, {});
  };
  return Strip{
      .exact = png(render::develop(exact, exposure)),
      .method = png(render::develop(judged, exposure)),
      .error = png(render::coloured(errors, size, scale)),
      .method_name = shown.name,
      .is_base = !study.settings.empty() && shown.choice.method->name == "adaptive",
      .camera = render::flags_of(request.view),
      .outlined = names_of(*study.request.scene, membership.seen()),
      .scale = scale / brightest,
      .rms = errors.rms / brightest,
      .wrong = static_cast<double>(errors.wrong) / static_cast<double>(std::max<std::uint64_t>(errors.pixels, 1))};
}

// A picture by the method that the maps show; if it is too dear for one, by area sampling, if that was run.
struct Painting {
  Shown shown;
  render::Size size;
};
std::optional<Painting> affordable_painting(const Study& study, Shown shown) {
  const double exact = planned_seconds_per_pixel(study, methods::parse("exact"));
  const auto size_for = [&](const methods::Choice& choice) {
    return affordable_size(std::max(exact, planned_seconds_per_pixel(study, choice)));
  };
  if (const auto size = size_for(shown.choice)) return Painting{std::move(shown), *size};
  for (const MethodField& field : study.methods.fields) {
    const Ladder& ladder = study.methods.ladders[field.ladder];
    const methods::Choice& choice = ladder.rungs[field.rung];
    if (choice.method->name != "area-sampling") continue;
    if (const auto size = size_for(choice)) {
      return Painting{{ladder.name, study::rung_name(ladder, field.rung), choice, {}}, *size};
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<Shown> shown_method(const Study& study) {
  if (!study.settings.empty()) {
    Shown shown{
        "the base setting", study::setting_name(study, study.base), study::choice_of(study.settings[study.base]), {}};
    for (const SampleRow& row : study.samples[study.base]) shown.errors.push_back(row.radiosity_error);
    return shown;
  }
  for (const MethodField& field : study.methods.fields) {
    const Ladder& ladder = study.methods.ladders[field.ladder];
    if (ladder.rungs.front().method->name == "exact") continue;
    return Shown{ladder.name, study::rung_name(ladder, field.rung), ladder.rungs[field.rung], field.radiosity_errors};
  }
  return std::nullopt;
}

std::optional<Strip> strip_of(const Study& study, std::vector<LeftOut>& left_out, const Hooks& hooks) {
  const auto leave_out = [&](const std::string& why) {
    left_out.push_back({kLeftOut, why});
    return std::nullopt;
  };
  const std::optional<Shown> shown = shown_method(study);
  if (!shown) return leave_out("no method was compared with the exact one");
  try {
    const HooksOfThread ours(hooks);
    const std::optional<Painting> painting = affordable_painting(study, *shown);
    if (!painting) return leave_out("they would take too long");
    std::optional<Strip> strip = draw_strip(study, painting->shown, painting->size, hooks);
    if (!strip) return leave_out("no light falls on what the camera sees");
    return strip;
  } catch (const InputError& error) {
    return leave_out(error.problems().front().what);
  }
}

}  // namespace exactff::report
