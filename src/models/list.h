// The models of the library in the order in which they are listed, one line for each. Each has a function `Model
// NAME_model()` in a file of this folder. There is no include guard: the including file defines the macro that expands
// each line.
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
