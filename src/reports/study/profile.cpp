#include "study/profile.h"

#include <algorithm>
#include <array>
#include <map>

#include "files/parallel.h"
#include "kernel/expect.h"
#include "kernel/vec.h"
#include "study/ladders.h"
#include "study/prepared_method.h"
#include "study/radiosity.h"
#include "study/shadow_edges.h"
#include "study/sight.h"

namespace exactff::study {
namespace {

constexpr int kPoints = 256;
constexpr int kBisections = 20;
constexpr std::size_t kMostCurves = 3;

struct Line {
  const Lattice& lattice;
  int row = 0;
};

std::optional<Line> line_through_penumbra(const Study& study) {
  const Lattice* const lattice = lattice_of(study.request.receivers);
  if (lattice == nullptr || lattice->size.u < 2) return std::nullopt;
  std::map<int, int> partly_by_row;
  for (std::size_t i = 0; i < study.exact.size(); ++i) {
    if (study.exact[i].sight == Sight::kPartly) ++partly_by_row[study.request.receivers[i].cell->row];
  }
  const auto most = std::max_element(partly_by_row.begin(), partly_by_row.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == partly_by_row.end()) return std::nullopt;
  return Line{*lattice, most->first};
}

class Profiler {
 public:
  Profiler(const Study& study, std::span<const ExactSource> sources, const Hooks& hooks)
      : study_(study), sources_(sources), hooks_(hooks) {
    for (const Selection& source : request().sources) radiosities_.push_back(scene().source_radiosity(source));
  }

  std::optional<Profile> along(const Line& line) {
    take_receivers(line);
    if (profile_.receivers.size() < 2) return std::nullopt;
    profile_.where = "row " + std::to_string(line.row) + " of " + name_of(scene(), line.lattice.region);
    find_exact();
    find_kinks();
    add_curves();
    return std::move(profile_);
  }

 private:
  [[nodiscard]] const Request& request() const { return study_.request; }
  [[nodiscard]] const Scene& scene() const { return *request().scene; }

  void take_receivers(const Line& line) {
    const GridSize size = line.lattice.size;
    const GridSize finer{size.u * std::max(1, kPoints / size.u), size.v};
    for (Receiver& receiver : grid_receivers(scene(), std::span(&line.lattice.region, 1), finer)) {
      if (receiver.cell->row == line.row) profile_.receivers.push_back(std::move(receiver));
    }
    for (const Receiver& receiver : profile_.receivers) {
      profile_.position.push_back(kernel::distance(receiver.point, profile_.receivers.front().point));
    }
  }

  [[nodiscard]] double radiosity(const Receiver& receiver, const std::vector<double>& form_factors) const {
    Rgb sum;
    for (std::size_t s = 0; s < form_factors.size(); ++s) add(sum, times(radiosities_[s], form_factors[s]));
    return times(scene().receiver_reflectance(receiver.on), sum).largest();
  }

  void find_exact() {
    const std::size_t count = profile_.receivers.size();
    profile_.exact.resize(count);
    sights_.resize(count);
    files::parallel_for(count, request().threads, "profile", hooks_, [&](std::size_t i) {
      const Receiver& receiver = profile_.receivers[i];
      std::vector<double> values;
      for (const ExactSource& source : sources_) {
        const FormFactor result = exact_form_factor(scene(), receiver, source);
        values.push_back(result.value);
        sights_[i].push_back(sight_of(result));
      }
      profile_.exact[i] = radiosity(receiver, values);
    });
  }

  [[nodiscard]] Receiver between(std::size_t i, double t) const {
    Receiver receiver = profile_.receivers[i];
    const Vec3 &p = receiver.point, &q = profile_.receivers[i + 1].point;
    receiver.point = kernel::along(p, kernel::difference(q, p), t);
    return receiver;
  }

  // Finds by bisection a kink between two points whose sights differ.
  void find_kinks() {
    for (std::size_t i = 0; i + 1 < profile_.receivers.size(); ++i) {
      if (sights_[i] == sights_[i + 1]) continue;
      double low = 0.0, high = 1.0;
      for (int step = 0; step < kBisections; ++step) {
        const double middle = 0.5 * (low + high);
        (sights(scene(), between(i, middle), sources_) == sights_[i] ? low : high) = middle;
      }
      profile_.kinks.push_back(profile_.position[i] + low * (profile_.position[i + 1] - profile_.position[i]));
    }
  }

  // The middle rungs of the most common methods.
  void add_curves() {
    for (const char* wanted : {"adaptive", "hemicube", "area-sampling"}) {
      const auto& ladders = study_.methods.ladders;
      const auto found = std::find_if(ladders.begin(), ladders.end(), [&](const Ladder& ladder) {
        return ladder.rungs.front().method->name == wanted;
      });
      if (found != ladders.end() && profile_.others.size() < kMostCurves) add_curve(*found);
    }
  }

  void add_curve(const Ladder& ladder) {
    const std::size_t rung = ladder.rungs.size() / 2;
    const methods::Choice& choice = ladder.rungs[rung];
    const PreparedMethod prepared(*choice.method, scene(), request().sources);
    const auto evaluator = prepared.scene->configure(choice.settings);
    Profile::Curve curve{rung_name(ladder, rung), {}};
    for (const Receiver& receiver : profile_.receivers) {
      evaluator->look_from(receiver);
      std::vector<double> values;
      for (const auto* source : prepared.sources) values.push_back(evaluator->form_factor(*source).form_factor);
      curve.radiosity.push_back(radiosity(receiver, values));
    }
    profile_.others.push_back(std::move(curve));
  }

  const Study& study_;
  std::span<const ExactSource> sources_;
  const Hooks& hooks_;
  std::vector<Rgb> radiosities_;
  std::vector<std::vector<Sight>> sights_;
  Profile profile_;
};

}  // namespace

std::variant<Profile, LeftOut> find_profile(const Study& study, std::span<const ExactSource> sources,
                                            const Hooks& hooks) {
  EXACTFF_EXPECT(study.exact.size() == study.request.receivers.size());
  const auto line = line_through_penumbra(study);
  if (auto profile = line ? Profiler(study, sources, hooks).along(*line) : std::nullopt) return *std::move(profile);
  return LeftOut{"penumbra profile",
                 "the receivers are not one grid on one quadrilateral on which some see a source partly"};
}

}  // namespace exactff::study
