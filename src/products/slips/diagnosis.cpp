#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "exactff/slips.h"
#include "kernel/float_environment.h"
#include "kernel/vec.h"
#include "scene/selections.h"
#include "slips/flip_trial.h"
#include "slips/sight_lines.h"
#include "text/names.h"
#include "text/phrases.h"

namespace exactff::slips {

using kernel::difference;
using kernel::dot;

std::string_view to_string(Kind kind) {
  constexpr std::array<std::string_view, 14> kNames = {
      "contradicting-normals", "inward-surface", "outward-room",   "unseen-front",
      "emitter-looks-away",    "doubled-faces",  "opposite-faces", "overlapping-fronts",
      "nearly-coplanar",       "on-open-floor",  "no-bottom",      "near-contact",
      "overlapping-solids",    "scale"};
  return kNames[static_cast<std::size_t>(kind)];
}

bool is_about_contacts(Kind kind) { return Kind::kOpenFloor <= kind && kind <= Kind::kOverlappingSolids; }

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

// By face: whether vn contradict all faces of its oriented surface. Otherwise its neighbours say that vn are wrong.
std::vector<bool> contradicted_as_a_whole(const Scene& scene) {
  const std::vector<std::uint32_t> surface = oriented_surfaces(scene);
  std::vector<bool> agrees(surface.size(), false), whole(scene.faces().size(), false);
  for (std::uint32_t p = 0; p < surface.size(); ++p) {
    if (scene.face(scene.pieces()[p].face).file_normals != FileNormals::kContradict) agrees[surface[p]] = true;
  }
  for (std::uint32_t p = 0; p < surface.size(); ++p) whole[index_of(scene.pieces()[p].face)] = !agrees[surface[p]];
  return whole;
}

std::optional<Finding> contradicting_normals(const Scene& scene, FlipTrials& trials) {
  std::vector<FaceId> faces, to_flip;
  std::vector<std::size_t> of_patch(scene.patches().size(), 0);
  const std::vector<bool> alone = contradicted_as_a_whole(scene);
  std::size_t stated = 0;
  for (std::size_t i = 0; i < scene.faces().size(); ++i) {
    const Face& face = scene.faces()[i];
    if (face.piece_count == 0 || face.file_normals == FileNormals::kNone) continue;
    ++stated;
    if (face.file_normals != FileNormals::kContradict) continue;
    faces.push_back(static_cast<FaceId>(i));
    if (alone[i]) to_flip.push_back(faces.back());
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
  const std::vector<Selection> flips = selections_of(scene, to_flip);
  const bool darkens = trials.try_flip(flips).darkens();
  if (!darkens) finding.flag = flag_to_flip(scene, flips);
  finding.words = {.what = "the normals in the file (vn) contradict the winding of " +
                           text::counted_of(faces.size(), stated, "face") + ": " + counts,
                   .why = "the front is the side from which the vertices run counter-clockwise, whatever vn says",
                   .suggestion = {}};
  std::vector<std::string> suggestions;
  if (!flips.empty()) {
    suggestions.push_back(darkens ? "turning them round may hide patches from each other: look first which is right"
                                  : "if vn is right, " + words_to_flip(scene, flips));
  }
  if (const std::size_t kept = faces.size() - to_flip.size(); kept > 0) {
    suggestions.push_back("the winding of " + (flips.empty() ? "these faces" : text::counted(kept, "face")) +
                          " agrees with that of their neighbours: there vn is the likely slip");
  }
  finding.words.suggestion = text::joined(suggestions, "; ");
  return finding;
}

// Over the vertices that a face with area uses.
struct CoordinateRange {
  double largest = 0.0;       // coordinate, in magnitude
  double longest_side = 0.0;  // of the box
  double float_step = 0.0;    // of float32, at the largest coordinate of an axis on which all are float32 numbers
};

bool is_float32(double value) { return static_cast<double>(static_cast<float>(value)) == value; }

double step_of_float32(double value) {
  const auto rounded = static_cast<float>(std::abs(value));
  return std::nextafter(rounded, std::numeric_limits<float>::infinity()) - static_cast<double>(rounded);
}

CoordinateRange range_of(const Scene& scene) {
  CoordinateRange extent;
  std::array<double, 3> low{HUGE_VAL, HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  std::array<bool, 3> may_be_float32{true, true, true};
  for (const Piece& piece : scene.pieces()) {
    for (const std::uint32_t corner : scene.corners(piece)) {
      const Vec3& v = scene.vertices()[corner];
      const std::array<double, 3> xyz{v.x, v.y, v.z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        extent.largest = std::max(extent.largest, std::abs(xyz[axis]));
        may_be_float32[axis] = may_be_float32[axis] && is_float32(xyz[axis]);
        low[axis] = std::min(low[axis], xyz[axis]);
        high[axis] = std::max(high[axis], xyz[axis]);
      }
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    extent.longest_side = std::max(extent.longest_side, high[axis] - low[axis]);
    const double farthest = std::max(std::abs(low[axis]), std::abs(high[axis]));
    if (may_be_float32[axis] && low[axis] < high[axis])
      extent.float_step = std::max(extent.float_step, step_of_float32(farthest));
  }
  return extent;
}

std::optional<Finding> odd_scale(const Scene& scene) {
  constexpr double kLarge = 1e4, kSmall = 1e-3, kCoarse = 1e-4;
  if (scene.pieces().empty()) return std::nullopt;
  const CoordinateRange extent = range_of(scene);
  std::string what;
  if (extent.float_step > kCoarse * extent.longest_side) {
    Finding finding{.kind = Kind::kScale};
    finding.words = {.what = "coordinates up to " + text::short_number(extent.largest) +
                             " are float32 numbers, which there are " + text::short_number(extent.float_step) +
                             " apart, beside " + text::short_number(extent.longest_side) +
                             " for the whole scene: are they rounded?",
                     .why = "rounded corners bend faces and open gaps",
                     .suggestion = "subtract the place of the origin before coordinates are written as float32"};
    return finding;
  }
  if (extent.longest_side > kLarge) {
    what = "the scene is " + text::short_number(extent.longest_side) + " long";
  } else if (extent.largest < kSmall) {
    what = "no coordinate is larger than " + text::short_number(extent.largest);
  } else {
    return std::nullopt;
  }
  Finding finding{.kind = Kind::kScale};
  finding.words = {.what = what + ": is the unit of length right?",
                   .why = "form factors do not depend on the unit, but areas, distances and --eps-a do",
                   .suggestion = "give coordinates in the unit that you mean, near the origin"};
  return finding;
}

std::vector<Finding> findings_of_fronts(const Scene& scene, FlipTrials& trials) {
  std::vector<Finding> turned = turned_surfaces(scene, trials);
  return turned.empty() ? unseen_fronts(scene, trials) : turned;
}

// Of those that a flag mends.
std::vector<Problem> words_of(std::span<const Finding> findings) {
  std::vector<Problem> words;
  for (const Finding& finding : findings) {
    if (!finding.flag.empty()) words.push_back(finding.words);
  }
  return words;
}

}  // namespace

std::string flag_to_flip(const Scene& scene, std::span<const Selection> selections) {
  const std::vector<Selection> not_yet = turned(scene, selections).not_yet;
  return not_yet.size() > 1 && not_yet == all_patches(scene) && !has_patch(scene, "all")
             ? "--flip all"
             : flag_words(scene, "--flip", not_yet);
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

std::vector<Finding> diagnose(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  std::vector<Finding> findings;
  const auto add = [&](std::optional<Finding> finding) {
    if (finding) findings.push_back(std::move(*finding));
  };
  FlipTrials trials(scene);
  add(contradicting_normals(scene, trials));
  std::vector<Selection> turned;
  for (Finding& finding : findings_of_fronts(scene, trials)) {
    const bool is_turned = finding.kind == Kind::kInwardSurface || finding.kind == Kind::kOutwardRoom;
    if (is_turned) turned.insert(turned.end(), finding.objects.begin(), finding.objects.end());
    findings.push_back(std::move(finding));
  }
  std::ranges::move(twin_faces(scene), std::back_inserter(findings));
  std::ranges::move(overlap_findings(scene, turned), std::back_inserter(findings));
  std::ranges::move(contact_findings(scene), std::back_inserter(findings));
  add(odd_scale(scene));
  return findings;
}

std::vector<Problem> warnings_of_turned_surfaces(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  FlipTrials trials(scene);
  return words_of(turned_surfaces(scene, trials));
}

std::vector<Problem> warnings_of_fronts(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  FlipTrials trials(scene);
  return words_of(findings_of_fronts(scene, trials));
}

// --- First try ---

namespace {

// A piece of `a` and a piece of `b` of which each has points before the front of the other. Occluders do not count, and
// of large patches only some pieces are looked at.
bool face_each_other(const Scene& scene, const SightLines& sight, const Selection& a, const Selection& b) {
  constexpr std::size_t kMostPieces = 8;
  const auto pieces_of = [&](const Selection& selection) {
    std::vector<std::uint32_t> pieces;
    for (const FaceId face : scene.faces_of(selection)) {
      if (pieces.size() < kMostPieces) pieces.push_back(scene.face(face).first_piece);
    }
    return pieces;
  };
  const auto has_before = [&](std::uint32_t piece, std::uint32_t other) {
    const Vec3 origin = sight.points_of(piece).front();
    return std::ranges::any_of(sight.points_of(other), [&](const Vec3& point) {
      return dot(sight.normal(piece), difference(point, origin)) > 1e-9 * sight.diameter();
    });
  };
  const std::vector<std::uint32_t> of_b = pieces_of(b);
  return std::ranges::any_of(pieces_of(a), [&](std::uint32_t p) {
    return std::ranges::any_of(of_b, [&](std::uint32_t q) { return has_before(p, q) && has_before(q, p); });
  });
}

double largest_surface(const Scene& scene, const Selection& selection) {
  double largest = 0.0;
  for (const Region& region : regions(scene, selection)) {
    double area = 0.0;
    for (const FaceId face : region.faces) area += scene.face(face).area;
    largest = std::max(largest, area);
  }
  return largest;
}

// A patch is no source if its faces differ in Ke; then its first face that emits is.
Selection usable_source(const Scene& scene, const Selection& patch) {
  const std::vector<FaceId> faces = scene.faces_of(patch);
  const auto radiosity = [&](FaceId id) { return scene.material(scene.face(id).material).radiosity; };
  if (std::ranges::all_of(faces, [&](FaceId id) { return radiosity(id) == radiosity(faces.front()); })) return patch;
  const auto emits = [&](FaceId id) { return scene.material(scene.face(id).material).emits(); };
  return {patch.patch, *std::ranges::find_if(faces, emits), scene.id()};
}

// The patches with area; of a single one its faces.
std::vector<Selection> candidates_of(const Scene& scene) {
  std::vector<Selection> patches = all_patches(scene);
  if (patches.size() != 1) return patches;
  std::vector<Selection> faces;
  for (const FaceId face : scene.faces_of(patches.front())) faces.push_back({patches.front().patch, face, scene.id()});
  return faces;
}

}  // namespace

std::optional<FirstTry> first_try(const Scene& scene) {
  const kernel::StandardArithmetic arithmetic;
  constexpr std::size_t kMostTried = 16;
  std::vector<Selection> all = candidates_of(scene);
  if (all.size() < 2) return std::nullopt;
  std::vector<Selection> sources;
  std::ranges::copy_if(all, std::back_inserter(sources), [&](const Selection& s) { return emits(scene, s); });
  if (sources.empty()) sources = all;
  std::vector<std::pair<std::pair<bool, double>, Selection>> ranked;  // those that do not emit first, then large ones
  for (const Selection& one : all) ranked.push_back({{emits(scene, one), -largest_surface(scene, one)}, one});
  std::ranges::stable_sort(ranked, {}, [](const auto& entry) { return entry.first; });
  if (ranked.size() > kMostTried) ranked.resize(kMostTried);
  if (sources.size() > kMostTried) sources.resize(kMostTried);
  const SightLines sight(scene);
  std::optional<FirstTry> any;
  for (const auto& [rank, on] : ranked) {
    for (const Selection& source : sources) {
      if (source == on) continue;
      const FirstTry one{on, usable_source(scene, source)};
      if (sight.usable() && face_each_other(scene, sight, on, source)) return one;
      if (!any) any = one;
    }
  }
  return any;
}

}  // namespace exactff::slips
