#!/usr/bin/env python3
"""Measures the view factors of CalculiX against certified ones.

Usage: calculix.py PROGRAM FOLDER [--quick]

Every cell is the face 1 of a thin brick of its own (C3D8; C3D6 behind a triangle), which radiates into one cavity.
CalculiX cuts it into triangles. The bricks lie behind their faces and take no other part.
"""

import os
import pathlib
import shutil
import sys

import numpy

import factors

GAP = 0.001  # of a cell, between its two sides
THICKNESS = 0.01  # of a cell; no face of a brick but face 1 radiates or hides anything
DECK = """*NODE, NSET=NODES
{nodes}
{bricks}
*MATERIAL, NAME=SOLID
*CONDUCTIVITY
1.
*SOLID SECTION, MATERIAL=SOLID, ELSET=BRICKS
*PHYSICAL CONSTANTS, ABSOLUTE ZERO=0, STEFAN BOLTZMANN=5.669E-8
*INITIAL CONDITIONS, TYPE=TEMPERATURE
NODES, 300.
*STEP
*HEAT TRANSFER, STEADY STATE
*BOUNDARY
NODES, 11, 11, 300.
*RADIATE
BRICKS, R1CR, {sink}, 1.
*VIEWFACTOR, WRITE ONLY
*END STEP
"""


def write_deck(path, cells, sink):
    nodes, bricks = [], []
    for number, (corners, normal) in enumerate(zip(cells.corners, cells.normals), 1):
        # Face 1 of a brick points away from its other nodes if its nodes run clockwise, seen from its front.
        front = cells.points[corners[::-1]]
        bricks.append(f"*ELEMENT, TYPE=C3D{2 * len(front)}, ELSET=BRICKS\n" + ", ".join(
            map(str, [number, *range(len(nodes) + 1, len(nodes) + 2 * len(front) + 1)])))
        nodes += [*front, *(front - THICKNESS * cells.size * normal)]
    path.write_text(DECK.format(
        # A number has at most 20 characters.
        nodes="\n".join("%d, %.12g, %.12g, %.12g" % (k, *node) for k, node in enumerate(nodes, 1)),
        bricks="\n".join(bricks), sink=sink), encoding="ascii")


def records(data):
    """The records of a sequential file of Fortran."""
    found, at = [], 0
    while at < len(data):
        length = int.from_bytes(data[at:at + 4], "little")
        if data[at + 4 + length:at + 8 + length] != data[at:at + 4]:
            sys.exit(f"The record at byte {at} does not end as it begins")
        found.append(data[at + 4:at + 4 + length])
        at += 8 + length
    return found


def read_factors(path, faces):
    """The matrix of the faces: its diagonal, then column by column what is below it, then row by row what is above."""
    diagonal, others, _ = map(numpy.frombuffer, records(pathlib.Path(path).read_bytes())[1:])  # the first: the version
    if len(diagonal) != faces or len(others) != faces * (faces - 1):
        sys.exit(f"{path}: {len(diagonal)} faces and {len(others)} other factors instead of {faces} faces")
    matrix, above = numpy.diag(diagonal), numpy.triu_indices(faces, 1)
    matrix.T[above], matrix[above] = others.reshape(2, -1)
    return matrix


def without_polygons(cells):
    """The cells, those of more than four corners cut into triangles around their centres, as no brick has such a face.
    """
    points, corners, owner = list(cells.points), [], []
    for k, cell in enumerate(cells.corners):
        found = [cell]
        if len(cell) > 4:
            points.append(cells.points[cell].mean(axis=0))
            found = [[len(points) - 1, a, b] for a, b in zip(cell, cell[1:] + cell[:1])]
        corners += found
        owner += [k] * len(found)
    return factors.Cells(numpy.array(points), corners, cells.patch[owner], cells.block[owner], cells.size)


def with_backs(cells, patches):
    """The cells, and then the backs of those of some patches, as cells of one patch more: a face hides nothing from its
    back. They lie a little behind: two sides in one plane can hide each other."""
    points, corners = list(cells.points), list(cells.corners)
    turned = [k for k, patch in enumerate(cells.patch) if patch in patches]
    for k in turned:
        corners.append(list(range(len(points), len(points) + len(cells.corners[k]))))
        points += list(cells.points[cells.corners[k][::-1]] - GAP * cells.size * cells.normals[k])
    patch = numpy.append(cells.patch, [cells.patch[-1] + 1] * len(turned))
    return factors.Cells(numpy.array(points), corners, patch, range(len(corners)), cells.size)


def solve(scene, across, sink):
    cells = with_backs(without_polygons(scene.cells(across)), [scene.names.index(name) for name in scene.sheets])
    case = scene.folder / "case"
    shutil.rmtree(case, ignore_errors=True)
    case.mkdir()
    write_deck(case / "scene.inp", cells, sink)
    said, seconds, used = factors.run(["ccx", "scene"], passing=(0, 201), cwd=case,
                                      env={**os.environ, **factors.ONE_THREAD})
    if not (case / "scene.vwf").exists():
        sys.exit(f"{case}: CalculiX wrote no view factors\n{said[-2000:]}")
    matrix = factors.of_patches(read_factors(case / "scene.vwf", len(cells.corners)), cells.areas, cells.patch)
    shutil.rmtree(case)
    return len(cells.corners), matrix, seconds, used


SETTINGS = [
    # A positive sink temperature: the program divides only those rows of faces by their sum whose sum exceeds 1.
    ("rows as computed", [3, 5, 9, 17, 33], {"sink": "300."}, False),
    # A negative one makes CalculiX divide every row of a face by its sum: for closed rooms.
    ("rows scaled to 1", [3, 5, 9, 17], {"sink": "-300."}, True),
]

if __name__ == "__main__":
    version = factors.run(["dpkg-query", "--show", "--showformat=${Version}", "calculix-ccx"])[0]
    factors.measure("CalculiX", "calculix", [
        f"CalculiX {version}, *VIEWFACTOR, WRITE ONLY, one thread; its time includes reading the input"],
        SETTINGS, solve)
