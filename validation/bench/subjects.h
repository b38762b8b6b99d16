// What is measured. Each registers its benchmarks; names are SUBJECT/SCENE/N.
#pragma once

namespace exactff::bench {

void add_engines();  // certified/ENGINE, visible/ENGINE, tree, limit
void add_rays();     // rays/coherent, rays/incoherent, rays/scattered, rays/build
void add_memory();   // memory; meaningful only in a process of its own
void add_cornell();  // cornell/ENGINE/CLASS, cornell/throughput
void add_view();     // view/loop, view/sweep, view/contour
void add_covers();   // covers/scratch, covers/neighbour

}  // namespace exactff::bench
