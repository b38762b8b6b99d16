// Chooses a few occluders that may together hide all of the source. By estimates in doubles, which prove nothing:
// visible_edges.h proves that what is chosen hides all.
//
// An occluder seems to hide a direction if the direction lies on the inner side of all its edges. The size of a shadow
// is its area in a plane across the view.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "visibility/outlines.h"

namespace exactff::visibility {

// A workspace: its memory is reused from one call to the next.
class CoverChoice {
 public:
  // How many occluders may be chosen, of that many: so few that a search in vain takes little of the time that a search
  // for all visible edges takes, which is nearly proportional to `occluders`.
  [[nodiscard]] static std::size_t most_of(std::size_t occluders);

  // Chooses, for some points of the source, the largest of the occluders that seem to hide each. False if none does, or
  // if most_of() occluders are not enough for the area of the source. The first `source_count` outlines are the
  // source's.
  [[nodiscard]] bool start(const Outlines& outlines, std::size_t source_count);
  // Chooses the largest occluder that seems to hide the direction. False if none does, if the direction seems hidden by
  // those already chosen, or if they are too many.
  [[nodiscard]] bool add_for(const Outlines& outlines, const kernel::Approx3& direction);

  // Chooses all occluders; no more can be added.
  void take_all(const Outlines& outlines, std::size_t source_count);

  // Those chosen, in order. Valid until the next call.
  [[nodiscard]] std::span<const OutlineId> chosen() const { return chosen_; }

 private:
  using Shadow = std::pair<float, OutlineId>;  // its size, as a share of the source's, at most 1

  void find_points(const Outlines& outlines, std::size_t source_count);
  [[nodiscard]] bool corners_seem_hidden(const Outlines& outlines, std::size_t source_count);
  [[nodiscard]] bool find_largest(const Outlines& outlines, std::size_t source_count);
  void find_depths(const Outlines& outlines);
  [[nodiscard]] double size(const Outlines& outlines, OutlineId id) const;
  [[nodiscard]] static bool seems_hidden(const Outlines& outlines, OutlineId by, const kernel::Approx3& direction);

  kernel::Approx3 across_view_;
  std::vector<kernel::Approx3> corners_, points_;  // of the source: near its corners, and elsewhere
  std::vector<OutlineId> across_;                  // occluders that reach beyond the source's edges
  std::vector<double> inverse_depths_;             // by corner, along the view; infinite where it is not ahead
  std::vector<Shadow> largest_;                    // in descending order
  std::vector<OutlineId> chosen_;
  std::size_t most_ = 0;
};

}  // namespace exactff::visibility
