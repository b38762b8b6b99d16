#!/usr/bin/env python3
"""Measures the view factors of OpenFOAM's viewFactorsGen against certified ones.

Usage: openfoam.py PROGRAM FOLDER [--quick]

viewFactorsGen looks at boundary faces only. The mesh it gets is one polyhedral cell whose boundary is the scene; its
coarse mesh is one such cell in any case. The plates do not enclose a volume; viewFactorsGen does not mind.
"""

import os
import pathlib
import re
import shutil
import sys

import numpy

import factors

DICTIONARIES = {
    "system/controlDict": "application viewFactorsGen; startFrom startTime; startTime 0; stopAt endTime; endTime 1;"
                          " deltaT 1; writeControl timeStep; writeInterval 1; writeFormat ascii; writePrecision 16;",
    "system/fvSchemes": "ddtSchemes {} gradSchemes {} divSchemes {} laplacianSchemes {} interpolationSchemes {}"
                        " snGradSchemes {}",
    "system/fvSolution": "",
    # The length of the list of rays is limited to 100,000 unless told otherwise, which suffices for some 400 faces.
    "constant/viewFactorsDict": "writeFacesAgglomeration false; writeViewFactorMatrix false; debug 1; dumpRays false;"
                                " maxDynListLength 2000000000;",
}


def write(case, name, kind, text):
    path = case / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"FoamFile {{ version 2.0; format ascii; class {kind}; object {path.name}; }}\n{text}\n")


def listed(items):
    items = list(items)
    return f"{len(items)}\n(\n" + "\n".join(items) + "\n)"


def write_case(case, cells):
    for name, text in DICTIONARIES.items():
        write(case, name, "dictionary", text)
    mesh = "constant/polyMesh/"
    write(case, mesh + "points", "vectorField", listed("(%r %r %r)" % tuple(map(float, p)) for p in cells.points))
    # Boundary faces point out of the mesh; ours point to where they emit, into it.
    write(case, mesh + "faces", "faceList", listed(
        f"{len(cell)}({' '.join(map(str, cell[::-1]))})" for cell in cells.corners))
    write(case, mesh + "owner", "labelList", listed("0" for _ in cells.corners))
    write(case, mesh + "neighbour", "labelList", "0()")
    patches = cells.patch[-1] + 1
    starts = numpy.searchsorted(cells.patch, numpy.arange(patches + 1))
    write(case, mesh + "boundary", "polyBoundaryMesh", listed(
        f"patch{k} {{ type wall; inGroups 2(wall viewFactorWall); nFaces {starts[k + 1] - starts[k]};"
        f" startFace {starts[k]}; }}" for k in range(patches)))
    write(case, "constant/finalAgglom", "labelListList", listed(
        listed(map(str, cells.block[starts[k]:starts[k + 1]] - cells.block[starts[k]])) for k in range(patches)))


def read_lists(path, kind):
    """A list of lists of numbers, as OpenFOAM writes it in ASCII: short lists on one line, equal values as N{value}."""
    text = pathlib.Path(path).read_text(encoding="utf-8")
    text = text[text.index("\n", text.index("// * *")):text.rindex(")")]
    text = text[text.index("(") + 1:]
    lists = []
    for count, values, same in re.findall(r"(\d+)\s*(?:\(([^()]*)\)|\{([^{}]*)\})", text):
        found = numpy.fromstring(values, kind, sep=" ") if not same else numpy.full(int(count), kind(same))
        if len(found) != int(count):
            sys.exit(f"{path}: {len(found)} values where {count} are announced")
        lists.append(found)
    return lists


def read_factors(case, faces):
    """The matrix of the faces."""
    matrix = numpy.zeros((faces, faces))
    rows = read_lists(case / "constant/F", float)
    columns = read_lists(case / "constant/globalFaceFaces", int)
    if len(rows) != faces or len(columns) != faces:
        sys.exit(f"{case}: {len(rows)} and {len(columns)} rows instead of {faces}")
    for i, (row, column) in enumerate(zip(rows, columns)):
        matrix[i, column] = row
    return matrix


def own_sums(said, count):
    """The factors of patches that viewFactorsGen prints itself."""
    order = re.search(r"included in the calculation :\s*\d+\s*\(([\d\s]*)\)", said)[1].split()
    if order != list(map(str, range(count))):
        sys.exit(f"viewFactorsGen took the patches in the order {order}")
    return numpy.array([float(value) for value in re.findall(r"^F\d+: (\S+)$", said, re.M)]).reshape(count, count)


def solve(scene, across, block):
    cells = scene.cells(across, block)
    case = scene.folder / "case"
    shutil.rmtree(case, ignore_errors=True)
    write_case(case, cells)
    environment = {**os.environ, **factors.ONE_THREAD, "WM_PROJECT_DIR": "/usr/share/openfoam"}
    said, seconds, used = factors.run(["viewFactorsGen", "-case", case], env=environment)
    first = numpy.unique(cells.block, return_index=True)[1]  # cell of each block
    matrix = factors.of_patches(read_factors(case, len(first)), numpy.bincount(cells.block, cells.areas),
                                cells.patch[first])
    printed = own_sums(said, len(scene.names))
    if abs(matrix - printed).max() > 1e-9:
        sys.exit(f"{case}: the factors of patches differ from those that viewFactorsGen prints")
    shutil.rmtree(case)
    return len(cells.corners), matrix, seconds, used


SETTINGS = [
    # The finest that viewFactorsGen knows: a ray between the centres of any two faces. Odd numbers of faces, since with
    # even ones many rays between the plates meet the very edge of the plate between them; 16 shows what that costs.
    ("each face alone", [3, 5, 9, 16, 17, 33], {"block": 1}, False),
    # What faceAgglomerate is for: one ray between blocks, whose faces are summed over. Square blocks are its best case.
    # Their number along an edge is odd, too.
    ("blocks of 2 x 2 faces", [10, 18, 34], {"block": 2}, False),
    ("blocks of 4 x 4 faces", [20, 36, 68], {"block": 4}, False),
]

if __name__ == "__main__":
    version = factors.run(["dpkg-query", "--show", "--showformat=${Version}", "openfoam"])[0]
    factors.measure("viewFactorsGen of OpenFOAM", "openfoam", [
        f"OpenFOAM {version}, viewFactorsGen, one process; its time includes reading the mesh and writing the factors"],
        SETTINGS, solve)
