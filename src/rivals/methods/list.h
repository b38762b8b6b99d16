// The library's methods, in the order in which they are listed: one line for each. A file of this room defines
// `Method NAME_method()` for each. No include guard: each including file defines the macro EXACTFF_METHOD.
EXACTFF_METHOD(exact)
EXACTFF_METHOD(adaptive)
EXACTFF_METHOD(adaptive_exact_visibility)
EXACTFF_METHOD(hemicube)
EXACTFF_METHOD(nettle)
EXACTFF_METHOD(wallace)
EXACTFF_METHOD(area_sampling)
