// Arbitrary bytes as a small degenerate scene: the cells of view factors between its faces, judged by point factors at
// points inside them, and the factors by their certified bounds and by the other direction. The bytes are those of
// fuzz_solver (scene_bytes.h), so both share a corpus.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "exactff/view_factors.h"
#include "fuzz/scene_bytes.h"
#include "generate/random.h"
#include "view_factors/pair.h"
#include "view_factors/point_factors.h"
#include "view_factors/prepared_patch.h"
#include "view_factors/seen_parts.h"

namespace exactff::validation {
namespace {

using generate::Random;
using view_factors::ExactScene;
using view_factors::NearPlanes;
using view_factors::Part;
using view_factors::Point;
using view_factors::Share;

constexpr double kTolerance = 0x1p-16, kMargin = 0x1p-24;  // as the self-check of pair.cpp
constexpr std::size_t kMostPairs = 3, kPoints = 4, kCells = 16;

// A mean of the corners with small whole weights.
Point point_in(const Part& part, const view_factors::Units& units, Random& random) {
  view_factors::Homogeneous sum{0, 0, 0, 1};
  long total = 0;
  for (const Point& corner : part.corners) {
    const long weight = random.integer(1, 1000);
    for (std::size_t i = 0; i < 3; ++i) sum[i] = sum[i] * corner.exact[3] + weight * corner.exact[i] * sum[3];
    sum[3] *= corner.exact[3];
    total += weight;
  }
  sum[3] *= total;
  return make_point(std::move(sum), units);
}

bool holds(const Share& share, const Point& point) {
  return std::ranges::all_of(share.cell.sides,
                             [&](const auto& side) { return side_of(*side, point) == sign_inside(*side, share.cell); });
}

class CellJudge {
 public:
  CellJudge(const Scene& scene, std::uint64_t seed) : scene_(scene), exact_(scene), seen_(exact_), random_(seed) {}

  // Every part of a patch against faces of one piece.
  void judge_cells(const Selection& from, const Selection& to) {
    for (const FaceId face : scene_.faces_of(to)) {
      if (scene_.pieces_of(face).size() != 1 || scene_.face(face).transparent) continue;
      Selection whole = to;
      whole.face = face;
      for (const Part& receiver : parts_of(exact_, from, view_factors::PartsOf::kExposed)) {
        for (const Part& source : parts_of(exact_, whole, view_factors::PartsOf::kExposed))
          judge_pair(receiver, source, whole);
      }
    }
  }

 private:
  void judge_pair(const Part& receiver, const Part& source, const Selection& whole) {
    if (!source.is_piece || pairs_++ >= kMostPairs) return;
    const view_factors::SeenParts::OfPatch of_receiver;
    std::optional<view_factors::Sight> sight;
    if (of_receiver.sees(seen_, {&receiver, 1}, 0, source)) {
      sight = sight_of(exact_, of_receiver.lists(seen_, {&receiver, 1}).front().occluders, receiver, source);
    }
    std::vector<Share> shares;
    view_factors::PairMemory memory;
    std::optional<view_factors::Pair> pair;
    if (sight) {
      pair.emplace(scene_, std::move(*sight), receiver.face, nullptr, memory, 0);
      pair->set_limits({.rounding = 1e-9});
      shares = pair->cells(0.0, {.cost = kCells, .effort = std::uint64_t{1} << 62});
    }
    const NearPlanes near(exact_, receiver);
    const ExactSource exact_source(scene_, whole);
    for (std::size_t i = 0; i < kPoints; ++i) {
      judge_point(point_in(receiver, exact_.units, random_), near, exact_source, shares);
    }
  }

  // What lies in no share sees nothing.
  void judge_point(const Point& point, const NearPlanes& near, const ExactSource& source,
                   const std::vector<Share>& shares) const {
    const std::optional<Vec3> rounded = near.round(point);
    const auto is_close = [&](const Share& share) { return distance_from_sides(share.cell, point.at) < kMargin; };
    if (!rounded || std::ranges::any_of(shares, is_close)) return;
    const auto share = std::ranges::find_if(shares, [&](const Share& s) { return holds(s, point); });
    if (share != shares.end() && share->is_event) return;
    view_factors::Evaluated found;
    if (share != shares.end()) found = share->formula->at(point.at);
    if (!(found.rounding <= kTolerance)) return;
    const Receiver receiver{.point = *rounded, .normal = near.normal(), .on = {near.own()}, .id = {}};
    EXPECT_NEAR(found.value, exact_form_factor(scene_, receiver, source).value, 2.0 * kTolerance);
  }

  const Scene& scene_;
  const ExactScene exact_;
  const view_factors::SeenParts seen_;
  Random random_;
  std::size_t pairs_ = 0;
};

bool meet(double lower, double upper, double other_lower, double other_upper) {
  return lower <= other_upper && other_lower <= upper;
}

void judge_factors(const Scene& scene, const Selection& from, const Selection& to) {
  const ViewFactorOptions quick{.accuracy = 1e-2, .budget = 8, .sample_crowds = false};
  const ViewFactorOptions certain{.accuracy = 1e-2, .budget = 4, .both_directions = true, .certify = true};
  try {
    const ViewFactor f = view_factor(scene, from, to, quick), proved = view_factor(scene, from, to, certain);
    EXPECT_TRUE(0.0 <= f.lower && f.lower <= f.value && f.value <= f.upper && f.upper <= 1.0);
    EXPECT_TRUE(meet(f.lower, f.upper, proved.lower, proved.upper));
    const ViewFactor back = view_factor(scene, to, from, certain);
    const double ratio = back.area_from / back.area_to, slack = 1.0 + 0x1p-30;
    if (!(ratio > 0x1p-300 && ratio < 0x1p300)) return;
    EXPECT_TRUE(meet(proved.lower, proved.upper, back.lower * ratio / slack, back.upper * ratio * slack));
  } catch (const InputError&) {  // a patch without an area that a double holds
  }
}

void judge(const generate::PlainScene& plain, std::uint64_t seed) {
  const Scene scene = generate::build(plain);
  CellJudge cells(scene, seed);
  Random random(seed);
  const Selection source = scene.select(plain.source);
  const Selection other{static_cast<PatchId>(random.below(scene.patches().size())), {}, scene.id()};
  for (const auto& [from, to] : {std::pair(other, source), std::pair(source, other)}) {
    if (scene.faces_of(from).empty() || scene.faces_of(to).empty()) return;
    cells.judge_cells(from, to);
  }
  judge_factors(scene, other, source);
}

}  // namespace
}  // namespace exactff::validation

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  GTEST_FLAG_SET(throw_on_failure, true);
  if (const auto fuzz_case = exactff::validation::decode({data, size})) {
    exactff::validation::judge(fuzz_case->scene, fuzz_case->seed);
  }
  return 0;
}
