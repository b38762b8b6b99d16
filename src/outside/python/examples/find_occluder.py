"""Where is the plate? Found from its shadow by gradient descent: find_occluder.py

`exactff` gives how each form factor changes if the plate's corners move. Steps are those of Gauss and Newton."""

import numpy as np

import exactff

LIGHT = [[-1, 1, 4], [1, 1, 4], [1, -1, 4], [-1, -1, 4]]
PLATE = np.array([[-0.5, -0.4, 0], [0.6, -0.5, 0], [0.5, 0.45, 0], [-0.4, 0.5, 0]])
SENSORS = [[x, y, 0.0] for x in np.linspace(-1.3, 1.4, 6) for y in np.linspace(-1.2, 1.5, 6)]


def shadow(place):
    """The form factor of each sensor to the light, and its derivatives by the plate's place."""
    scene = exactff.Scene(np.vstack([LIGHT, PLATE + place]), [[0, 1, 2, 3], [4, 5, 6, 7]], patch=[0, 1], names=["light", "plate"])
    found = [scene.form_factor(x, [0, 0, 1], "light", gradient=True, vertices=True) for x in SENSORS]
    moves = [f.gradient.vertices for f in found]
    return np.array([f.value for f in found]), np.array([m.derivative[m.vertex >= 4].sum(axis=0) for m in moves])


truth = np.array([0.21, -0.13, 1.7])
given, _ = shadow(truth)
place = np.array([-0.1, 0.2, 1.2])
for step in range(12):
    values, slopes = shadow(place)
    place = place + np.linalg.lstsq(slopes, given - values, rcond=None)[0]
    print(step, np.linalg.norm(place - truth))
assert np.linalg.norm(place - truth) < 1e-9
