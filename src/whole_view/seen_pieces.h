// The pieces that points of a region may see, for many views from one place.
//
// A convex piece O hides a convex set Q from a convex set R, but for directions of measure zero, if every corner r of R
// lies strictly on one side of O's plane, every corner q of Q on the other side or in the plane, not all of them in it,
// and every segment from an r to a q meets O. Proof. From r, the central projection onto the plane maps Q, which lies
// beyond it, into the hull of the projections of Q's corners, hence into O. So every segment from an r to a point y of
// Q meets O. From y, in the same way, it maps R into O.
//
// A piece that is hidden from all points of R can be left out of their views: whatever it hides, O hides as well.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "exactff/scene.h"
#include "exactff/view.h"
#include "scene/shaft_tree.h"

namespace exactff::whole_view {

// All pieces but some that are certainly hidden, by single opaque pieces, from all points of the region. Decided by
// exact signs. In the order in which a view looks at them.
[[nodiscard]] std::vector<std::uint32_t> pieces_seen_from(const Scene& scene, const Box& region);

// view() from a point of that region, with the same result, in less time.
void view_among(const Scene& scene, std::span<const std::uint32_t> pieces, const Receiver& receiver,
                const ViewOptions& options, WholeView& result, Workspace& workspace);

}  // namespace exactff::whole_view
