#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "exactff/slips.h"
#include "kernel/float_environment.h"
#include "scene/selections.h"
#include "slips/findings.h"
#include "text/phrases.h"

namespace exactff::slips {

std::string_view to_string(Kind kind) {
  constexpr std::array<std::string_view, 10> kNames = {
      "contradicting-normals", "inward-surface", "outward-room",       "unseen-front",    "emitter-looks-away",
      "doubled-faces",         "opposite-faces", "overlapping-fronts", "nearly-coplanar", "scale"};
  return kNames[static_cast<std::size_t>(kind)];
}

namespace {

struct Turned {
  std::vector<Selection> by_flag, not_yet;
};

Turned turned(const Scene& scene, std::span<const Selection> selections) {
  Turned result;
  for (const Selection& one : selections) {
    const std::vector<FaceId> faces = scene.faces_of(one);
    const bool flipped = std::ranges::any_of(faces, [&](FaceId id) { return scene.face(id).flipped; });
    (flipped ? result.by_flag : result.not_yet).push_back(one);
  }
  return result;
}

}  // namespace

std::string flag_to_flip(const Scene& scene, std::span<const Selection> selections) {
  return flag_words(scene, "--flip", turned(scene, selections).not_yet);
}

std::string words_to_flip(const Scene& scene, std::span<const Selection> selections) {
  const Turned parts = turned(scene, selections);
  std::string advice;
  if (!parts.not_yet.empty()) {
    const std::string flag = flag_to_flip(scene, selections);
    advice = "turn " + std::string(parts.not_yet.size() == 1 ? "it" : "them") + " round with " +
             (flag.empty() ? "--flip NAME,NAME,..." : flag);
  }
  if (parts.by_flag.empty()) return advice;
  return advice + (advice.empty() ? "" : ", and ") + "leave out --flip for " + listed(scene, parts.by_flag);
}

std::string advice_to_flip(const Scene& scene, std::span<const Selection> selections) {
  return FlipTrials(scene).try_flip(selections).darkens() ? std::string() : words_to_flip(scene, selections);
}

std::optional<Finding> contradicting_normals(const Scene& scene, FlipTrials& trials) {
  std::vector<FaceId> faces;
  std::vector<std::size_t> of_patch(scene.patches().size(), 0);
  std::size_t stated = 0;
  for (std::size_t i = 0; i < scene.faces().size(); ++i) {
    const Face& face = scene.faces()[i];
    if (face.piece_count == 0 || face.file_normals == FileNormals::kNone) continue;
    ++stated;
    if (face.file_normals != FileNormals::kContradict) continue;
    faces.push_back(static_cast<FaceId>(i));
    ++of_patch[index_of(face.patch)];
  }
  if (faces.empty()) return std::nullopt;
  constexpr std::size_t kShown = 6;
  std::string counts;
  std::size_t patches = 0;
  for (std::size_t p = 0; p < of_patch.size(); ++p) {
    if (of_patch[p] == 0 || ++patches > kShown) continue;
    const Selection patch{static_cast<PatchId>(p), {}, scene.id()};
    counts += (counts.empty() ? "" : ", ") + listed(scene, std::span(&patch, 1)) + ' ' + std::to_string(of_patch[p]) +
              " of " + text::counted(scene.faces_of(patch).size(), "face");
  }
  if (patches > kShown) counts += " and " + std::to_string(patches - kShown) + " more patches";
  Finding finding{.kind = Kind::kNormals, .objects = selections_of(scene, faces)};
  const bool darkens = trials.try_flip(finding.objects).darkens();
  if (!darkens) finding.flag = flag_to_flip(scene, finding.objects);
  finding.words = {.what = "the normals in the file (vn) contradict the winding of " +
                           text::counted_of(faces.size(), stated, "face") + ": " + counts,
                   .why = "the front is the side from which the vertices run counter-clockwise, whatever vn says",
                   .suggestion = darkens
                                     ? "turning them round may hide patches from each other: look first which is right"
                                     : "if vn is right, " + words_to_flip(scene, finding.objects)};
  return finding;
}

namespace {

// Over the vertices that a face with area uses.
struct CoordinateRange {
  double largest = 0.0;       // coordinate, in magnitude
  double least = HUGE_VAL;    // of the coordinates, in magnitude
  double longest_side = 0.0;  // of the box
};

CoordinateRange range_of(const Scene& scene) {
  CoordinateRange extent;
  std::array<double, 3> low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const Piece& piece : scene.pieces()) {
    for (const std::uint32_t corner : scene.corners(piece)) {
      const Vec3& v = scene.vertices()[corner];
      const std::array<double, 3> xyz{v.x, v.y, v.z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        extent.largest = std::max(extent.largest, std::abs(xyz[axis]));
        extent.least = std::min(extent.least, std::abs(xyz[axis]));
        low[axis] = std::min(low[axis], xyz[axis]);
        high[axis] = std::max(high[axis], xyz[axis]);
      }
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    extent.longest_side = std::max(extent.longest_side, high[axis] - low[axis]);
  return extent;
}

}  // namespace

std::optional<Finding> odd_scale(const Scene& scene) {
  constexpr double kLarge = 1e4, kSmall = 1e-3;
  if (scene.pieces().empty()) return std::nullopt;
  const CoordinateRange extent = range_of(scene);
  std::string what;
  if (extent.longest_side > kLarge) {
    what = "the scene is " + text::short_number(extent.longest_side) + " long";
  } else if (extent.largest < kSmall) {
    what = "no coordinate is larger than " + text::short_number(extent.largest);
  } else if (extent.least > kLarge) {
    what = "every coordinate is larger than " + text::short_number(extent.least);
  } else {
    return std::nullopt;
  }
  Finding finding{.kind = Kind::kScale};
  finding.words = {.what = what + ": is the unit of length right?",
                   .why = "form factors do not depend on the unit, but areas, distances and --eps-a do",
                   .suggestion = "give coordinates in the unit that you mean, near the origin"};
  return finding;
}

std::vector<Finding> diagnose(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Finding> findings;
  const auto add = [&](std::optional<Finding> finding) {
    if (finding) findings.push_back(std::move(*finding));
  };
  FlipTrials trials(scene);
  add(contradicting_normals(scene, trials));
  std::vector<Selection> turned;
  for (Finding& finding : turned_surfaces(scene, trials)) {
    turned.insert(turned.end(), finding.objects.begin(), finding.objects.end());
    findings.push_back(std::move(finding));
  }
  std::ranges::move(unseen_fronts(scene, turned, trials), std::back_inserter(findings));
  std::ranges::move(twin_faces(scene), std::back_inserter(findings));
  std::ranges::move(overlap_findings(scene, turned), std::back_inserter(findings));
  add(odd_scale(scene));
  return findings;
}

}  // namespace exactff::slips
