// The explanation of a result: which stages ran, and why the others were skipped.
#include <string>
#include <utility>

#include "exactff/exact.h"
#include "text/phrases.h"

namespace exactff {

std::string_view to_string(Status status) {
  constexpr std::string_view kNames[] = {"certified", "zero", "underflow", "not certified"};
  return kNames[static_cast<std::size_t>(status)];
}

std::string_view to_string(MeasureKind kind) {
  constexpr std::string_view kNames[] = {"form-factor", "solid-angle", "overcast"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::optional<MeasureKind> measure_named(std::string_view name) {
  for (const MeasureKind kind : {MeasureKind::kFormFactor, MeasureKind::kSolidAngle, MeasureKind::kOvercast}) {
    if (name == to_string(kind)) return kind;
  }
  return std::nullopt;
}

std::string_view to_string(VisiblePart part) {
  constexpr std::string_view kNames[] = {"nothing", "some", "all"};
  return kNames[static_cast<std::size_t>(part)];
}

std::string_view to_string(DerivativeStatus status) {
  constexpr std::string_view kNames[] = {"certified", "zero", "underflow", "enclosed", "none"};
  return kNames[static_cast<std::size_t>(status)];
}

std::string_view to_string(KinkReason reason) {
  constexpr std::string_view kNames[] = {"a face is seen edge-on", "lines at different depths are seen as one",
                                         "the source is seen edge-on",
                                         "the receiver lies on a face that is not its own"};
  return kNames[static_cast<std::size_t>(reason)];
}

std::string_view to_string(Engine engine) {
  constexpr std::string_view kNames[] = {"edges", "boolean", "both"};
  return kNames[static_cast<std::size_t>(engine)];
}

std::string_view to_string(Outcome outcome) {
  constexpr std::string_view kNames[] = {
      "buried",     "the receiver lies on it", "behind",        "below the horizon",
      "unoccluded", "hidden by one occluder",  "partly hidden", "hidden by the union of occluders"};
  return kNames[static_cast<std::size_t>(outcome)];
}

Outcome decided_outcome(const PlaneRecord& plane) {
  const bool all_visible = plane.outcome == Outcome::kPartlyHidden && plane.cutters == std::uint64_t{0};
  return all_visible ? Outcome::kUnoccluded : plane.outcome;
}

namespace {

using text::counted;

StageNote cull_note(const PlaneRecord& plane) {
  switch (plane.outcome) {
    case Outcome::kBuried:
      return {"cull", true, "a solid lies on the receiver's face there, or on the source: it contributes 0"};
    case Outcome::kReceiverFace:
      return {"cull", true, "the receiver lies on this face: it contributes 0"};
    case Outcome::kBehind:
      return {"cull", true, "the receiver is behind the source or in its plane: it contributes 0"};
    default:
      return {"cull", true, "the receiver is in front of the source"};
  }
}

StageNote horizon_note(const PlaneRecord& plane) {
  if (plane.outcome == Outcome::kBelowHorizon) return {"horizon clip", true, "nothing above the horizon"};
  if (!plane.horizon_clipped) return {"horizon clip", false, "all of it is above the horizon"};
  return {"horizon clip", true, "the part below was cut off exactly"};
}

StageNote shaft_note(const PlaneRecord& plane) {
  if (plane.cover_remembered) {
    return {"shaft", false, "only " + counted(plane.candidates, "piece") + " that hid it from an earlier receiver"};
  }
  if (plane.tree_edges > 0) {
    return {"shaft", true,
            counted(plane.tree_edges, "edge") + " from the tree of edges, " + std::to_string(plane.silhouettes) +
                (plane.silhouettes == 1 ? " of them a silhouette" : " of them silhouettes") + " before the source"};
  }
  return {"shaft", true,
          counted(plane.tree_candidates, "piece") + " from the tree, " + std::to_string(plane.candidates) +
              " in the shaft"};
}

StageNote clip_note(const PlaneRecord& plane) {
  const bool by_edges = plane.engine == Engine::kEdges;
  if (plane.clipped == 0) {
    return {"exact clip", false,
            by_edges ? "no candidate crosses the source's plane" : "no candidate extends beyond the shaft"};
  }
  return {"exact clip", true,
          counted(plane.clipped, "candidate") + " cut " + (by_edges ? "at the source's plane" : "to the shaft")};
}

StageNote total_note(const PlaneRecord& plane) {
  if (plane.candidates == 0) return {"total occlusion", false, "no candidates"};
  if (plane.outcome == Outcome::kHiddenByOne) return {"total occlusion", true, "one occluder hides all: 0"};
  return {"total occlusion", true, "no single candidate hides all"};
}

StageNote engine_note(const PlaneRecord& plane) {
  const bool by_edges = plane.engine == Engine::kEdges;
  const std::string stage = by_edges ? "edges" : "projection and Booleans";
  if (plane.outcome == Outcome::kHiddenByOne) {
    return {stage, false, by_edges ? "nothing is left to hide" : "nothing is left to subtract from"};
  }
  if (plane.outcome == Outcome::kUnoccluded) {
    if (!plane.source_joined) return {stage, false, "no candidates"};
    return {stage, true,
            std::string("only to join the source's own pieces; ") +
                (by_edges ? "nothing hides them" : "nothing to subtract")};
  }
  const bool nothing = plane.outcome == Outcome::kHiddenByUnion;
  if (nothing && plane.cover_remembered) return {stage, true, "these hide all together"};
  if (nothing && plane.cover < plane.candidates) {
    return {stage, true,
            std::to_string(plane.cover) + " of " + counted(plane.candidates, "candidate") +
                " were enough to hide all together"};
  }
  const bool all = decided_outcome(plane) == Outcome::kUnoccluded;
  if (by_edges && plane.tree_edges > 0) {
    return {stage, true,
            "the number of occluders along " + counted(plane.silhouettes, "silhouette") +
                (nothing ? ": nothing is visible" : ": it is 0 on one side of each part")};
  }
  if (by_edges) {
    return {stage, true,
            "the part of each edge that " + counted(plane.candidates, "candidate") +
                (plane.candidates == 1 ? " leaves visible" : " leave visible") +
                (nothing ? ": nothing"
                 : all   ? ": all of it"
                         : "")};
  }
  return {stage, true,
          counted(plane.candidates, "shadow") + " joined and subtracted" +
              (nothing ? ": nothing left"
               : all   ? ": all of it left"
                       : "")};
}

StageNote contour_note(const PlaneRecord& plane) {
  if (plane.edges == 0) return {"contour", false, "nothing is visible"};
  const std::string edges = counted(plane.edges, "edge");
  return {"contour", true, plane.loops == 0 ? edges : counted(plane.loops, "loop") + ", " + edges};
}

StageNote fraction_note(const PlaneRecord& plane) {
  if (!plane.visible_fraction) return {"visible fraction", false, "not requested"};
  return {"visible fraction", true, "exact, then rounded"};
}

}  // namespace

std::vector<StageNote> stages(const PlaneRecord& plane) {
  const std::string left_out = "left out: " + std::string(to_string(plane.outcome));
  const auto unless = [&](bool skipped, StageNote note) {
    return skipped ? StageNote{std::move(note.stage), false, left_out} : std::move(note);
  };
  // Outcomes are listed in the order of the stages.
  const bool unsearched = plane.outcome <= Outcome::kBelowHorizon;
  return {cull_note(plane),
          unless(plane.outcome <= Outcome::kBehind, horizon_note(plane)),
          unless(unsearched, shaft_note(plane)),
          unless(unsearched, clip_note(plane)),
          unless(unsearched, total_note(plane)),
          unless(unsearched, engine_note(plane)),
          unless(unsearched && plane.edges == 0, contour_note(plane)),
          fraction_note(plane)};
}

}  // namespace exactff
