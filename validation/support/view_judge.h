// Judges of a whole view that share no code with the sweep.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "exactff/view.h"

namespace exactff::validation {

// Null if nothing of the patch is seen.
[[nodiscard]] const SeenPatch* find_patch(const WholeView& seen, std::size_t patch);

template <class A, class B>
void expect_same_bits(const A& a, const B& b, const std::string& what) {
  EXPECT_EQ(a.value, b.value) << what << ": " << a.enclosure.midpoint() << " and " << b.enclosure.midpoint();
  EXPECT_EQ(a.lower, b.lower) << what;
  EXPECT_EQ(a.upper, b.upper) << what;
  EXPECT_EQ(a.status, b.status) << what << ": " << to_string(a.status) << " and " << to_string(b.status);
  EXPECT_TRUE(a.enclosure.overlaps(b.enclosure)) << what;
}

// Every patch has the value, bounds and status that exact_form_factor gives. Requires a scene without glass.
void expect_patches_as_the_solver(const Scene& scene, const Receiver& receiver);
// The balls of all shares together contain 1.
void expect_shares_to_add_up(const Scene& scene, const Receiver& receiver);
// Faces of one source count once where they overlap. So the share of each face is what it adds, as a source, to the
// faces before it; and the backs are what all faces turned round add to all fronts. The share of a patch is that of its
// faces together. Requires a scene without glass.
void expect_shares_of_unions(const Scene& scene, const Receiver& receiver);
// On both sides of every arc lies what rational numbers find there: of all pieces that cover the direction of a point
// of the arc, moved aside by an infinitely small step, the nearest; of
// several in one plane a front, and of these the first.
void expect_sides_as_rational_numbers_find(const Scene& scene, const Receiver& receiver);

}  // namespace exactff::validation
