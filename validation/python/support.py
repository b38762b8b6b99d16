"""What the tests of the Python module share."""

import csv
import os
import pathlib
import subprocess

import numpy as np

import exactff

PROGRAM = os.environ["EXACTFF_PROGRAM"]
SOURCE = pathlib.Path(os.environ["EXACTFF_SOURCE"])
SCENES = SOURCE / "data" / "scenes"
CORNELL = str(SCENES / "cornell_box.obj")
BLINDS = str(SCENES / "blinds_room.obj")

POINT, UP = [200.0, 0.0, 400.0], [0.0, 1.0, 0.0]  # on the floor of the Cornell box


def program(*arguments, code=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done.stdout


def run(*command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def open_scene(name):
    return exactff.Scene.from_model(name[1:]) if name.startswith("@") else exactff.Scene.read(name)


def truth_rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def column(rows, name, sources):
    return np.array([float(row[name]) for row in rows]).reshape(-1, sources)


def same_bits(a, b):
    return np.array_equal(np.asarray(a, np.float64).view(np.int64), np.asarray(b, np.float64).view(np.int64))


def square(z, size=1.0):
    """Four corners at the height z, centred on the axis."""
    h = size / 2
    return [[-h, -h, z], [h, -h, z], [h, h, z], [-h, h, z]]


def lamp_above(*plates):
    """A square lamp that looks down at z = 1, and plates of (height, size) under it."""
    vertices, faces = square(1.0), [[3, 2, 1, 0]]
    for height, size in plates:
        faces.append([len(vertices) + k for k in range(4)])
        vertices = vertices + square(height, size)
    patch = [0] + [1] * len(plates)
    return exactff.Scene(vertices, faces, patch, ["lamp", "plates"], {"lamp": {"radiosity": 1.0}})
