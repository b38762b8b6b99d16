// The experiments, in the order in which a report shows them: one line for each. Every one has files that define
// `Result NAME(const Effort&, const study::Hooks&)`. No include guard: whoever includes this says what to make of it.
EXACTFF_EXPERIMENT(hemicube_scatter, "hemicube-scatter",
                   "Karkanis' two plots: hemicube against exact values, triangle by triangle")
EXACTFF_EXPERIMENT(hemicube_resolution, "hemicube-resolution",
                   "hemicube error against resolution, rotation and distance")
EXACTFF_EXPERIMENT(karkanis_times, "karkanis-times",
                   "time for all patches from one point against their number, beside Karkanis'")
EXACTFF_EXPERIMENT(nettle_rule, "nettle-rule", "Nettle's rule: error against the patch's size over its distance")
EXACTFF_EXPERIMENT(small_emitters, "small-emitters", "Karkanis' conclusion: many small bright emitters, in radiosity")
EXACTFF_EXPERIMENT(closure, "closure", "a closed room: all patches seen from a point make up 1")
