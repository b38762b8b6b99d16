// The library's models, in the order in which they are listed: one line for each. Every one has a function
// `Model NAME_model()` in a file of this folder. No include guard: whoever includes this says what to make of a line.
EXACTFF_MODEL(teapot)
EXACTFF_MODEL(forest)
EXACTFF_MODEL(closed_room)
EXACTFF_MODEL(emitters)
EXACTFF_MODEL(room)
EXACTFF_MODEL(karkanis)
EXACTFF_MODEL(soup)
EXACTFF_MODEL(blinds)
EXACTFF_MODEL(tiles)
EXACTFF_MODEL(mesh)
EXACTFF_MODEL(lattice)
