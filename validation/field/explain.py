#!/usr/bin/env python3
"""Tests the explanations of the errors that openfoam.py and calculix.py find, and names some of them. Two minutes.

Usage: /usr/bin/python3 -B validation/field/explain.py build/exactff, after measure.sh openfoam and measure.sh calculix

The empty cube is the room with cube without its cube: our own sums stand beside the programs' factors of its walls.
"""

import pathlib
import sys
import tempfile

import numpy

import calculix
import factors
import openfoam

ADJACENT, OPPOSITE = 0.200043776075403, 0.199824895698387  # closed forms for the walls of a cube
LOWEST = numpy.arccos(1 - 1 / 640)  # the lowest direction that calcview.f of CalculiX looks in, a sine


def lines_of_sight(centres, normals, i):
    """From centre i to all: distances, and the sines of their elevations at both ends."""
    away = centres - centres[i]
    distance = numpy.linalg.norm(away, axis=1)
    distance[i] = 1
    return distance, away @ normals[i] / distance, -(away * normals).sum(axis=1) / distance


def centre_to_centre(cells):
    """cos cos / (pi r^2) from centre to centre, where nothing hides anything."""
    centres, normals = cells.points[cells.corners].mean(axis=1), cells.normals
    found = numpy.zeros((6, 6))
    for i, wall in enumerate(cells.patch):
        distance, here, there = lines_of_sight(centres, normals, i)
        terms = here * there / (numpy.pi * distance**2) * cells.areas
        found[wall] += cells.areas[i] * numpy.bincount(cells.patch, terms * (cells.patch != wall))
    return found


def from_centroids(cells, lowest):
    """Closed forms from centroids of triangles to triangles whose centroids see each other above `lowest`."""
    corners = cells.points[cells.corners]
    # CalculiX cuts from the second corner to the fourth: its order is the reverse (calculix.py).
    triangles = numpy.concatenate([corners[:, [3, 0, 1]], corners[:, [3, 1, 2]]])
    walls, normals = numpy.tile(cells.patch, 2), numpy.tile(cells.normals, (2, 1))
    centres, areas = triangles.mean(axis=1), numpy.tile(cells.areas / 2, 2)
    found = numpy.zeros((6, 6))
    for i, wall in enumerate(walls):
        _, here, there = lines_of_sight(centres, normals, i)
        seen = (here > lowest) & (there > lowest) & (walls != wall)
        to = triangles[seen] - centres[i]
        to /= numpy.linalg.norm(to, axis=2)[:, :, None]
        terms = numpy.zeros(len(to))
        for k in range(3):
            a, b = to[:, k], to[:, (k + 1) % 3]
            across = numpy.cross(a, b)
            length = numpy.linalg.norm(across, axis=1)
            terms += across @ normals[i] / length * numpy.arctan2(length, (a * b).sum(axis=1))
        found[wall] += areas[i] * numpy.bincount(walls[seen], abs(terms) / (2 * numpy.pi), 6)
    return found


def scene_of(program, lines, folder):
    """The scene of these lines of an OBJ file."""
    (folder / "lines.obj").write_text("\n".join(lines), encoding="utf-8")
    return factors.Scene(program, folder / "lines.obj", folder)


def without(lines, prefix):
    """Lines of an OBJ file without the patches whose names begin so."""
    patch = ""
    for line in lines:
        patch = line[2:] if line.startswith("g ") else patch
        if not (line.startswith(("g ", "f ")) and patch.startswith(prefix)):
            yield line


def explain_walls(program, folder):
    room = pathlib.Path("data/field/room_with_cube.obj").read_text(encoding="utf-8").splitlines()
    walls = scene_of(program, without(room, "cube"), folder)
    for across in (4, 8, 16):
        ours, theirs = centre_to_centre(walls.cells(across)), openfoam.solve(walls, across, 1)[1]
        print(f"empty cube, {across} x {across}: OpenFOAM differs from our sum by {abs(ours - theirs).max():.1e};"
              f" adjacent walls {across * (theirs[0, 2] - ADJACENT):+.4f} / N,"
              f" opposite ones {across**2 * (theirs[0, 1] - OPPOSITE):+.4f} / N^2")
    for across in (4, 9, 16):
        cells = walls.cells(across)
        ours, theirs = from_centroids(cells, LOWEST), calculix.solve(walls, across, "300.")[1]
        whole = from_centroids(cells, 0)
        print(f"empty cube, {across} x {across}: CalculiX differs from our sum by {abs(ours - theirs).max():.1e};"
              f" its row adds up to {theirs[0].sum():.6f}; without the rule {whole[0].sum():.6f},"
              f" opposite walls {across**2 * (whole[0, 1] - OPPOSITE):+.4f} / N^2")


def explain_plates(program, folder):
    plates = pathlib.Path("data/field/plates.obj").read_text(encoding="utf-8").splitlines()
    moved = [line.replace("0.25", "0.26").replace("0.75", "0.76") for line in plates]
    for name, lines in ("as it is", plates), ("moved by 0.01", moved):
        scene = scene_of(program, lines, folder)
        exact = factors.Exact(scene)
        for across in (16, 17):
            worst = exact.judge(openfoam.solve(scene, across, 1)[1])["worst"]
            print(f"OpenFOAM, the plate between the plates {name}, {across} across: worst {worst:.2e}")
    lower = [line.replace(" 0.5", " 0.499") for line in plates if line.startswith("v ") and line.endswith(" 0.5")]
    apart = "\n".join(plates).replace("f 12 11 10 9", "\n".join([*lower, "f -1 -2 -3 -4"])).splitlines()
    for name, lines in ("in one plane", plates), ("0.001 apart", apart):
        scene = scene_of(program, lines, folder)
        exact = factors.Exact(scene)
        for across in (9, 17):
            worst = exact.judge(calculix.solve(scene, across, "300.")[1])["worst"]
            print(f"CalculiX, the sides of the plate {name}, {across} across: worst {worst:.2e}")
    scene = scene_of(program, without(plates, "plate_bottom"), folder)
    for name, found in ("CalculiX", calculix.solve(scene, 9, "300.")), ("OpenFOAM", openfoam.solve(scene, 9, 1)):
        print(f"{name}, a plate with a front only: up {found[1][0, 1]:.5f}, down {found[1][1, 0]:.5f}")


def name_worst(program, folder):
    for path, across, one, other in (("data/scenes/formats/gunter2.vs3", 33, "VH_OF", "VH_WF"),
                                     ("data/scenes/formats/gunter2.vs3", 17, "EBO", "VH_DA"),
                                     ("data/scenes/blinds_room.obj", 17, "ceiling", "blind")):
        scene = factors.Scene(program, path, folder)
        entry = scene.names.index(one), scene.names.index(other)
        for name, found in (("OpenFOAM", openfoam.solve(scene, across, 1)),
                            ("CalculiX", calculix.solve(scene, across, "300."))):
            print(f"{path}, {across} across, {one} to {other}: {name} {found[1][entry]:.4f}")


with tempfile.TemporaryDirectory() as temporary:
    for explain in explain_walls, explain_plates, name_worst:
        explain(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary))
