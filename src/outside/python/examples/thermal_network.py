"""A room as a thermal network of radiative conductors, solved by NumPy: thermal_network.py SCENE"""

import sys

import numpy as np

import exactff

SIGMA = 5.670374419e-8  # W / (m^2 K^4)

scene = exactff.Scene.read(sys.argv[1])  # lengths in metres, emissivity 1 - Kd
matrix = exactff.view_factor_matrix(scene, accuracy=1e-3, backs=True, sky=True).balanced()
exchange = matrix.exchange()
conductors = exchange.conductors.mean(0)  # over the channels; square metres
to_sky = exchange.conductors_to_open[:, :, 0].mean(0)
known = {matrix.from_names[0]: 400.0, matrix.from_names[1]: 280.0}  # K; all others give off no heat

# For each node i: sum over j of GR_ij (e_i - e_j) + GR_i,sky e_i = Q_i / sigma, with e = T^4 and a sky of 0 K.
n = len(conductors)
system = np.diag(conductors.sum(1) + to_sky) - conductors
heat = np.zeros(n)
for name, temperature in known.items():
    i = matrix.from_names.index(name)
    system[i], heat[i] = np.eye(n)[i], temperature**4
emission = np.linalg.solve(system, heat)
flow = SIGMA * ((conductors * (emission[:, None] - emission)).sum(1) + to_sky * emission)
for name, e, q in zip(matrix.from_names, emission, flow):
    print(f"{name:12} {max(e, 0.0) ** 0.25:8.2f} K {q:14.3f} W")
print(f"to the sky: {flow.sum():.3f} W")
