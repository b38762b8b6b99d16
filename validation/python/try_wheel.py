"""try_wheel.py SCENE.obj: computes a value of the Cornell box with the installed package, whose libraries must be its own."""

import pathlib
import re
import sys

import exactff

room = exactff.Scene.read(sys.argv[1])
f = room.form_factor([200, 0, 400], [0, 1, 0], "light", on="floor")
assert f.value == 0.010822702782492406, f
at = room.receivers("floor", grid=4)
exactff.methods.evaluate("adaptive", room, at.points, at.normals, "light", at.on)  # with Embree

package = pathlib.Path(exactff.__file__).parent
loaded = {line.split()[-1] for line in pathlib.Path("/proc/self/maps").read_text().splitlines() if ".so" in line}
libraries = {pathlib.Path(file) for file in loaded if re.search(r"/lib(gmp|mpfr|flint|embree|OpenEXR)", file)}
assert {file.parent for file in libraries} == {package / "libs"}, libraries
print(package, f)
