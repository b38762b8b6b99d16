"""A map of the light on the floor of the Cornell box: cornell_map.py SCENE.obj PICTURE.png"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import exactff

scene = exactff.Scene.read(sys.argv[1])
columns, rows = 80, 80
receivers = scene.receivers("floor", grid=(columns, rows))
exact = scene.form_factors(receivers.points, receivers.normals, "light", on=receivers.on, full=True)
shades = np.array(exact.value[:, 0]).reshape(rows, columns)
hidden = np.count_nonzero(exact.status == exactff.Status.ZERO)

picture, axes = plt.subplots()
image = axes.imshow(shades, origin="lower", cmap="inferno", interpolation="nearest")
picture.colorbar(image, label="form factor to the light (exact)")
axes.set(title=f"Cornell box, floor: {hidden} of {shades.size} cells see no light", xlabel="column", ylabel="row")
picture.savefig(sys.argv[2], dpi=150)
print(f"{shades.size} cells, brightest {shades.max().item()!r}")
