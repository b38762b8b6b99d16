"""The mean radiant temperature in a room, on a small cube at each point: mean_radiant.py SCENE"""

import sys

import numpy as np

import exactff

scene = exactff.Scene.read(sys.argv[1])
patches = list(scene.names)
temperature = dict.fromkeys(patches, 293.15)  # K
temperature[patches[0]], temperature[patches[-1]] = 303.15, 283.15  # a warm one and a cold one
sky = 268.15

low, high = np.min(scene.vertices, axis=0), np.max(scene.vertices, axis=0)
shares = np.linspace(0.1, 0.9, 3)
points = np.array([low + (high - low) * [x, 0.3, z] for x in shares for z in shares])
sides = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], float)

# Of each side of the cube, form factors to all patches and to what is open; backs are as warm as the air.
at, normals = np.repeat(points, 6, axis=0), np.tile(sides, (len(points), 1))
factors = scene.form_factors(at, normals, patches)
free = scene.form_factors(at, normals, ["sky"])[:, 0]
power = factors @ np.array([temperature[name] ** 4 for name in patches]) + free * sky**4
power += np.maximum(0.0, 1.0 - factors.sum(1) - free) * 293.15**4
mean = power.reshape(len(points), 6).mean(1) ** 0.25 - 273.15
for point, celsius in zip(points, mean):
    print(f"{np.array2string(point, precision=2):28} {celsius:6.2f} degrees Celsius")
print(f"from {mean.min():.2f} to {mean.max():.2f}")
