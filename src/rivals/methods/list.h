// The library's methods, in the order in which they are listed: one line for each. Each has a file that defines
// `Method NAME_method()`. No include guard: each including file defines the macro EXACTFF_METHOD.
EXACTFF_METHOD(exact)
EXACTFF_METHOD(adaptive)
EXACTFF_METHOD(adaptive_exact_visibility)
EXACTFF_METHOD(hemicube)
EXACTFF_METHOD(nettle)
EXACTFF_METHOD(wallace)
EXACTFF_METHOD(area_sampling)
