// The experiments in the order of the report, one line for each. Each has files that define `Result NAME(const Effort&,
// const study::Hooks&)`. There is no include guard: the including file defines the macro that expands each line.
EXACTFF_EXPERIMENT(hemicube_scatter, "hemicube-scatter",
                   "Karkanis' two plots: hemicube against exact values, triangle by triangle")
EXACTFF_EXPERIMENT(hemicube_resolution, "hemicube-resolution",
                   "hemicube error against resolution, rotation and distance")
EXACTFF_EXPERIMENT(karkanis_times, "karkanis-times",
                   "time for all patches from one point against their number, compared with Karkanis' times")
EXACTFF_EXPERIMENT(nettle_rule, "nettle-rule", "Nettle's rule: error against the patch's size over its distance")
EXACTFF_EXPERIMENT(small_emitters, "small-emitters", "Karkanis' conclusion: many small bright emitters, in radiosity")
EXACTFF_EXPERIMENT(closure, "closure", "a closed room: the form factors from a point to all patches sum to 1")
