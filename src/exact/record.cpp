// The explanation of a result: which stages ran, and why the others were skipped.
#include <string>

#include "exactff/exact.h"

namespace exactff {

std::string_view to_string(Status status) {
  switch (status) {
    case Status::kCertified:
      return "certified";
    case Status::kZero:
      return "zero";
    case Status::kUnderflow:
      return "underflow";
    case Status::kNotCertified:
      return "not certified";
  }
  return "";
}

std::string_view to_string(VisiblePart part) {
  switch (part) {
    case VisiblePart::kNothing:
      return "nothing";
    case VisiblePart::kSome:
      return "some";
    case VisiblePart::kAll:
      return "all";
  }
  return "";
}

std::string_view to_string(Engine engine) {
  switch (engine) {
    case Engine::kEdges:
      return "edges";
    case Engine::kBoolean:
      return "boolean";
    case Engine::kBoth:
      return "both";
  }
  return "";
}

std::string_view to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::kReceiverFace:
      return "the receiver lies on it";
    case Outcome::kBehind:
      return "behind";
    case Outcome::kBelowHorizon:
      return "below the horizon";
    case Outcome::kUnoccluded:
      return "unoccluded";
    case Outcome::kHiddenByOne:
      return "hidden by one occluder";
    case Outcome::kPartlyHidden:
      return "partly hidden";
    case Outcome::kHiddenByUnion:
      return "hidden by the union of occluders";
  }
  return "";
}

namespace {

std::string counted(std::uint64_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

// The last stage that had work, in the order of the method.
enum Progress { kCulled, kClipped, kSearched, kSubtracted };

Progress progress(Outcome outcome) {
  switch (outcome) {
    case Outcome::kReceiverFace:
    case Outcome::kBehind:
      return kCulled;
    case Outcome::kBelowHorizon:
      return kClipped;
    case Outcome::kUnoccluded:
    case Outcome::kHiddenByOne:
      return kSearched;
    case Outcome::kPartlyHidden:
    case Outcome::kHiddenByUnion:
      return kSubtracted;
  }
  return kCulled;
}

StageNote cull_note(const PlaneRecord& plane) {
  switch (plane.outcome) {
    case Outcome::kReceiverFace:
      return {"cull", true, "the receiver lies on this face: it contributes 0"};
    case Outcome::kBehind:
      return {"cull", true, "the receiver is behind the source or in its plane: it contributes 0"};
    default:
      return {"cull", true, "the receiver is in front of the source"};
  }
}

StageNote horizon_note(const PlaneRecord& plane, const std::string& left_out) {
  if (progress(plane.outcome) < kClipped) return {"horizon clip", false, left_out};
  if (plane.outcome == Outcome::kBelowHorizon) return {"horizon clip", true, "nothing above the horizon"};
  if (!plane.horizon_clipped) return {"horizon clip", false, "all of it is above the horizon"};
  return {"horizon clip", true, "the part below was cut off exactly"};
}

StageNote shaft_note(const PlaneRecord& plane, const std::string& left_out) {
  if (progress(plane.outcome) < kSearched) return {"shaft", false, left_out};
  return {"shaft", true,
          counted(plane.tree_candidates, "piece") + " from the tree, " + std::to_string(plane.candidates) +
              " in the shaft"};
}

StageNote clip_note(const PlaneRecord& plane, const std::string& left_out) {
  if (progress(plane.outcome) < kSearched) return {"exact clip", false, left_out};
  const bool by_edges = plane.engine == Engine::kEdges;
  if (plane.clipped == 0) {
    return {"exact clip", false,
            by_edges ? "no candidate crosses the source's plane" : "no candidate extends beyond the shaft"};
  }
  return {"exact clip", true,
          counted(plane.clipped, "candidate") + " cut " + (by_edges ? "at the source's plane" : "to the shaft")};
}

StageNote total_note(const PlaneRecord& plane, const std::string& left_out) {
  if (progress(plane.outcome) < kSearched) return {"total occlusion", false, left_out};
  if (plane.candidates == 0) return {"total occlusion", false, "no candidates"};
  if (plane.outcome == Outcome::kHiddenByOne) return {"total occlusion", true, "one occluder hides all: 0"};
  return {"total occlusion", true, "no single candidate hides all"};
}

StageNote boolean_note(const PlaneRecord& plane, const std::string& left_out) {
  const std::string stage = "projection and Booleans";
  if (progress(plane.outcome) < kSearched) return {stage, false, left_out};
  if (plane.outcome == Outcome::kHiddenByOne) return {stage, false, "nothing is left to subtract from"};
  if (plane.outcome == Outcome::kUnoccluded) {
    if (plane.source_joined) return {stage, true, "only to join the source's own pieces; nothing to subtract"};
    return {stage, false, "no candidates"};
  }
  return {stage, true,
          counted(plane.candidates, "shadow") + " joined and subtracted" +
              (plane.outcome == Outcome::kHiddenByUnion ? ": nothing left" : "")};
}

StageNote edges_note(const PlaneRecord& plane, const std::string& left_out) {
  const std::string stage = "edges";
  if (progress(plane.outcome) < kSearched) return {stage, false, left_out};
  if (plane.outcome == Outcome::kHiddenByOne) return {stage, false, "nothing is left to hide"};
  if (plane.outcome == Outcome::kUnoccluded) {
    if (plane.source_joined) return {stage, true, "only to join the source's own pieces; nothing hides them"};
    return {stage, false, "no candidates"};
  }
  return {stage, true,
          "the part of each edge that " + counted(plane.candidates, "candidate") + " leave visible" +
              (plane.outcome == Outcome::kHiddenByUnion ? ": nothing" : "")};
}

StageNote contour_note(const PlaneRecord& plane, const std::string& left_out) {
  if (plane.edges == 0) {
    return {"contour", false, progress(plane.outcome) < kSearched ? left_out : "nothing is visible"};
  }
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
  return {cull_note(plane),
          horizon_note(plane, left_out),
          shaft_note(plane, left_out),
          clip_note(plane, left_out),
          total_note(plane, left_out),
          plane.engine == Engine::kEdges ? edges_note(plane, left_out) : boolean_note(plane, left_out),
          contour_note(plane, left_out),
          fraction_note(plane)};
}

}  // namespace exactff
