#!/usr/bin/env python3
"""Tests the explanations of the errors that openfoam.py and calculix.py find. A minute.

Usage: /usr/bin/python3 -B validation/field/explain.py build/exactff, after openfoam.sh and calculix.sh

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
    centres, normals = cells.points[cells.quads].mean(axis=1), cells.normals[cells.quads[:, 0]]
    found = numpy.zeros((6, 6))
    for i, wall in enumerate(cells.patch):
        distance, here, there = lines_of_sight(centres, normals, i)
        terms = here * there / (numpy.pi * distance**2) * cells.areas
        found[wall] += cells.areas[i] * numpy.bincount(cells.patch, terms * (cells.patch != wall))
    return found


def from_centroids(cells, lowest):
    """Closed forms from centroids of triangles to triangles whose centroids see each other above `lowest`."""
    corners = cells.points[cells.quads]
    triangles = numpy.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    walls, normals = numpy.tile(cells.patch, 2), numpy.tile(cells.normals[cells.quads[:, 0]], (2, 1))
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


def explain_walls(folder):
    room = factors.read_obj("data/field/room_with_cube.obj")
    walls = {name: faces for name, faces in room.items() if not name.startswith("cube")}
    for across in (4, 8, 16):
        cells = factors.Cells(walls, across)
        ours, theirs = centre_to_centre(cells), openfoam.solve(walls, across, folder, 1)[1]
        print(f"empty cube, {across} x {across}: OpenFOAM differs from our sum by {abs(ours - theirs).max():.1e};"
              f" adjacent walls {across * (theirs[0, 2] - ADJACENT):+.4f} / N,"
              f" opposite ones {across**2 * (theirs[0, 1] - OPPOSITE):+.4f} / N^2")
    for across in (4, 9, 16):
        cells = factors.Cells(walls, across)
        ours, theirs = from_centroids(cells, LOWEST), calculix.solve(walls, across, folder, "300.")[1]
        whole = from_centroids(cells, 0)
        print(f"empty cube, {across} x {across}: CalculiX differs from our sum by {abs(ours - theirs).max():.1e};"
              f" its row adds up to {theirs[0].sum():.6f}; without the rule {whole[0].sum():.6f},"
              f" opposite walls {across**2 * (whole[0, 1] - OPPOSITE):+.4f} / N^2")


def explain_plates(program, folder):
    text = pathlib.Path("data/field/plates.obj").read_text(encoding="utf-8")
    path = folder / "moved.obj"
    path.write_text("\n".join(line.replace("0.25", "0.26").replace("0.75", "0.76") for line in text.splitlines()))
    for name, scene in ("as it is", "data/field/plates.obj"), ("moved by 0.01", path):
        exact, patches = factors.Exact(program, scene, folder), factors.read_obj(scene)
        for across in (16, 17):
            worst = exact.judge(list(patches), openfoam.solve(patches, across, folder, 1)[1])["worst"]
            print(f"OpenFOAM, the plate between the plates {name}, {across} across: worst {worst:.2e}")
    patches = factors.read_obj("data/field/plates.obj")
    del patches["plate_bottom"]
    for name, found in (("CalculiX", calculix.solve(patches, 9, folder, "300.")),
                        ("OpenFOAM", openfoam.solve(patches, 9, folder, 1))):
        print(f"{name}, a plate with a front only: up {found[1][0, 1]:.5f}, down {found[1][1, 0]:.5f}")


with tempfile.TemporaryDirectory() as temporary:
    explain_walls(pathlib.Path(temporary))
    explain_plates(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(temporary))
