"""A mesh coloured by exact form factors, for ParaView: paraview_mesh.py SCENE PATCH SOURCE MESH.vtu
Needs meshio. PATCH is the surface to colour; triangles and quadrilaterals."""

import sys

import meshio
import numpy as np

import exactff

path, patch, source, output = sys.argv[1:]
scene = exactff.Scene.read(path)
faces = scene.faces_of(patch)
names = [scene.face_name(face) for face in faces]
receivers = scene.receivers(names, centres=True, per_face=True)
exact = scene.form_factors(receivers.points, receivers.normals, source, on=receivers.on, full=True)

cells, values, states = [], [], []
for corners, kind in ((3, "triangle"), (4, "quad")):
    chosen = [i for i, face in enumerate(faces) if len(scene.rings(face)[0]) == corners]
    if chosen:
        cells.append((kind, np.array([scene.rings(faces[i])[0] for i in chosen])))
        values.append(exact.value[chosen, 0])
        states.append(exact.status[chosen, 0])
meshio.Mesh(scene.vertices, cells, cell_data={"form_factor": values, "status": states}).write(output)
print(f"{sum(map(len, values))} of {len(faces)} faces, brightest {exact.value.max().item()!r}")
