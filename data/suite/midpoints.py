"""Answers the plain level of the suite by midpoints, with NumPy only: the values for `exactff check data/suite`."""
import csv
import numpy as np

SUITE = "data/suite/"

def read_obj(file):
    corners, patches, name = [], {}, ""
    for word, *rest in (line.split() for line in open(file)):
        if word == "v": corners.append(np.array(rest, float))
        elif word == "g": name = rest[0]
        elif word == "f": patches.setdefault(name, []).append(np.array([corners[int(i) - 1] for i in rest]))
    return patches

def midpoints(patch, n):
    """Of n * n parts of the triangles that fan out from a corner; outside a concave face they count with both signs."""
    a, b = np.array([(i + s, j + s) for s in (1 / 3, 2 / 3) for i in range(n) for j in range(n - i - (s > .5))]).T / n
    parts = []
    for face in patch:
        arms = face[1:] - face[0]
        unit = sum(np.cross(p, q) for p, q in zip(arms, arms[1:]))
        unit /= np.linalg.norm(unit)
        for p, q in zip(arms, arms[1:]):
            places = face[0] + np.outer(a, p) + np.outer(b, q)
            parts.append((places, np.tile(unit, (len(a), 1)), np.full(len(a), np.cross(p, q) @ unit / 2 / n**2)))
    return map(np.concatenate, zip(*parts))

def received(x, normal, places, normals, areas, quantity):
    ray = places - x
    r = np.linalg.norm(ray, axis=1)
    angle = np.maximum(0, -np.sum(ray * normals, axis=1)) / r**3 * areas
    cosine = np.maximum(0, ray @ normal / np.linalg.norm(normal)) / r
    weight = {"sphere": 1 / (4 * np.pi), "solid angle": cosine > 0,
              "overcast sky": 3 / (7 * np.pi) * cosine * (ray[:, 2] > 0) * (1 + 2 * ray[:, 2] / r)}
    return np.sum(angle * weight.get(quantity, cosine / np.pi))

print("question,value")
for q in csv.DictReader(open(SUITE + "questions.csv")):
    if q["level"] == "plain":
        patches, quantity = read_obj(SUITE + "scenes/" + q["scene"] + ".obj"), q["quantity"]
        to = list(midpoints(patches[q["to"]], 16 if q["from"] else 128))
        points = zip(*midpoints(patches[q["from"]], 16)) if q["from"] else [(
            np.array([q[c] for c in "xyz"], float), np.array([q[c] for c in ("nx", "ny", "nz")], float), 1)]
        shares = np.array([(area * received(x, n, *to, quantity), area) for x, n, area in points])
        print(q["question"], shares[:, 0].sum() / shares[:, 1].sum(), sep=",")
