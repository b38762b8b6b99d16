#!/usr/bin/env python3
"""Holds other programs to our values.

Usage: field.py PROGRAM TASK    PROGRAM: build/exactff; results are written to build/field/TASK

  openfoam, calculix  view factors of viewFactorsGen, or of *VIEWFACTOR, against certified ones: TASK.csv
  suite [NAME...]     asks methods for points, POV-Ray, OpenFOAM and CalculiX, or those named, the questions of
                      data/suite: NAME.csv with the columns question and value, and times.json
  board               grades the answers in data/field/suite: their table there, and the page
  cycles [--quick]    images of Blender's path tracer against exact ones, by cycles.py: cycles.csv and maps of errors

Installs Debian's packages of the programs.
"""

import csv
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time
import typing

import numpy

TOP = pathlib.Path(__file__).resolve().parents[2]
SUITE = TOP / "data" / "suite"
PACKAGES = {"openfoam": ["openfoam"], "calculix": ["calculix-ccx"], "suite": ["openfoam", "calculix-ccx", "povray"],
            "board": [], "cycles": ["blender", "python3-openimageio"]}


# --- scenes in cells, factors of patches, and the judgement of `exactff check` ---

class Source(typing.NamedTuple):
    """A scene to measure. ours: how `exactff matrix` computes it; sheets: patches whose backs are seen; coarsest: the
    fewest cells along its longest edge."""

    label: str
    path: str
    closed: bool
    ours: tuple = ("--certify",)
    sheets: tuple = ()
    coarsest: int = 3


SCENES = [
    Source("room with cube", "data/field/room_with_cube.obj", True),
    Source("L-shaped room", "data/scenes/formats/test4.vs3", True),
    Source("plate between plates", "data/field/plates.obj", False),
    # Strips and slats are thinner than any cell here, and stay one cell wide.
    Source("gunter2", "data/scenes/formats/gunter2.vs3", True, ("--accuracy", "1e-3"), coarsest=9),
    Source("blinds room", "data/scenes/blinds_room.obj", True,
           ("--accuracy", "1e-3", "--from", "floor,ceiling,table_top", "--to", "window,blind"), ("blind",), coarsest=9),
]
LIMIT = 1e-3  # an entry that is farther from our bounds is counted
COLUMNS = """scene setting across faces runs cpu_seconds seconds worst rms row_sum beyond_limit entries
    exact_cpu_seconds exact_width""".split()
ONE_THREAD = {"OMP_NUM_THREADS": "1"}


def read_obj(path):
    """The vertices of an OBJ file, and its patches by name: lists of faces, which are lists of vertices."""
    vertices, patches, patch = [], {}, None
    for words in map(str.split, pathlib.Path(path).read_text(encoding="utf-8").splitlines()):
        if not words:
            continue
        if words[0] == "v":
            vertices.append([float(word) for word in words[1:4]])
        elif words[0] == "g":
            patch = patches.setdefault(words[1], [])
        elif words[0] == "f":
            patch.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return numpy.array(vertices), patches


class Cells:
    """Cells of a scene. points: coordinates; corners: the points of each cell, counter-clockwise before its front;
    patch, block: the numbers of its patch and of its block; size: no side is longer. The cells of a patch follow each
    other, and so do those of a block."""

    def __init__(self, points, corners, patch, block, size):
        self.points, self.corners, self.size = points, corners, size
        self.patch, self.block = numpy.array(patch), numpy.array(block)
        rings = [points[cell] for cell in corners]
        vectors = numpy.array([numpy.cross(ring[1:-1] - ring[0], ring[2:] - ring[0]).sum(axis=0) for ring in rings])
        lengths = numpy.linalg.norm(vectors, axis=1)
        self.areas, self.normals = lengths / 2, vectors / lengths[:, None]


class Scene:
    """A scene that `exactff convert --divide` cuts into cells. names: its patches; longest: its longest edge."""

    def __init__(self, program, source, folder, sheets=()):
        self.program, self.source, self.folder, self.path = program, source, folder, folder / "scene.obj"
        self.sheets = sheets
        run([program, "convert", source, self.path, "--force"])
        points, patches = read_obj(self.path)
        self.names = list(patches)
        self.longest = max(numpy.linalg.norm(numpy.roll(points[face], -1, 0) - points[face], axis=1).max()
                           for faces in patches.values() for face in faces)

    def divided(self, path, length):
        """The file of the cells of a scene, and for each cell the patch that it was cut from: NAME:k, or NAME if it is
        the only one, from NAME."""
        cut = path.with_suffix(".cut.obj")
        run([self.program, "convert", path, cut, "--divide", repr(float(length)), "--force"])
        whole = read_obj(path)[1]
        return cut, {cell: cell if cell in whole else cell.rpartition(":")[0] for cell in read_obj(cut)[1]}

    def cells(self, across, block=1):
        """Cells by `--divide` with 1 / across of the longest edge, from blocks by `block` times that. A block is cut on
        its own. The diagonal of a cell that is not exactly planar, and so becomes two triangles, may be longer."""
        length = self.longest / across
        path, patch_of = self.divided(self.path, block * length)
        block_of = {cell: cell for cell in patch_of}
        if block > 1:
            path, block_of = self.divided(path, length)
        points, faces = read_obj(path)
        number = {block: k for k, block in enumerate(patch_of)}
        return Cells(points, [face for face, in faces.values()],
                     [self.names.index(patch_of[block_of[cell]]) for cell in faces],
                     [number[block_of[cell]] for cell in faces], length)


def of_patches(factors, areas, patch):
    """Factors of patches from those of their faces, weighted by area. factors[i, j]: from face i to face j."""
    member = (numpy.arange(patch.max() + 1)[:, None] == patch).astype(float)
    return (member * areas) @ factors @ member.T / (member @ areas)[:, None]


def run(command, passing=(0,), **more):
    """What a command says, the seconds it took, and those of the processor."""
    before, clock = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, **more)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode not in passing:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout[-2000:]}")
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return done.stdout, time.perf_counter() - clock, used


def rows_of(path):
    with open(path, encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def repeated(measurement):
    """The results of three runs; the last item of a result is its processor seconds. Those of 10 s or more are single.
    """
    done = [measurement()]
    while len(done) < 3 and done[0][-1] < 10:
        done.append(measurement())
    return done


class Exact:
    """Our matrix of a scene: its file, the median time of three runs (of 10 s or more: a single one), and its widest
    entry."""

    def __init__(self, scene, options=("--certify",)):
        self.program, self.folder, self.names = scene.program, scene.folder, scene.names
        self.path = self.folder / "exact.csv"
        command = [self.program, "matrix", scene.source, *options, "--threads", "1", "--force", "-o", self.path]
        done = repeated(lambda: run(command, passing=(0, 3)))  # 3: wider than asked
        self.seconds = float(numpy.median([one[2] for one in done]))
        self.rows = rows_of(self.path)
        self.width = max(float(row["upper"]) - float(row["lower"]) for row in self.rows)

    def judge(self, matrix):
        """The errors of another program's matrix, by `exactff check`."""
        at = {name: number for number, name in enumerate(self.names)}
        theirs, verdict = self.folder / "theirs.csv", self.folder / "check.json"
        with open(theirs, "w", encoding="utf-8", newline="") as file:
            table = csv.writer(file)
            table.writerow(["from", "to", "value"])
            table.writerows([row["from"], row["to"], repr(float(matrix[at[row["from"]], at[row["to"]]]))]
                            for row in self.rows)
        run([self.program, "check", self.path, theirs, "--max-abs", LIMIT, "--json", verdict], passing=(0, 1))
        found = json.loads(verdict.read_text(encoding="utf-8"))
        off = [max(float(row["lower"]) - value, value - float(row["upper"]))
               for row in self.rows for value in [matrix[at[row["from"]], at[row["to"]]]]]
        beyond = sum(error > LIMIT for error in off)
        if found["passed"] != (beyond == 0):
            sys.exit(f"{theirs}: {beyond} entries are beyond the limit, but check says passed = {found['passed']}")
        return {"worst": found["overall"]["absolute"]["max"], "rms": found["overall"]["absolute"]["rms"],
                "row_sum": found["matrix"]["row_sum"]["by"], "beyond_limit": beyond, "entries": len(off)}


def measure_once(solve, scene, across, exact, needs):
    """What a setting gives: errors of the first run, median times of all runs."""
    done = repeated(lambda: solve(scene, across, **needs))
    faces, matrix = done[0][:2]
    seconds, used = numpy.median([one[2:] for one in done], axis=0)
    return {"across": across, "faces": faces, "runs": len(done), "cpu_seconds": used, "seconds": seconds,
            **exact.judge(matrix), "exact_cpu_seconds": exact.seconds, "exact_width": exact.width}


def measure(program, task, folder):
    """Runs all settings of a program on all scenes and writes the table. solve(scene, across, **needs) returns (number
    of faces, factors of patches, seconds, processor seconds)."""
    package, about, settings, solve = PROGRAMS[task]
    version = run(["dpkg-query", "--show", "--showformat=${Version}", package])[0]
    with open(folder / f"{task}.csv", "w", encoding="utf-8", newline="") as file:
        for note in [f"title: {about}", f"command: validation/field/field.py build/exactff {task}",
                     f"{package} {version}, one thread; its time includes reading the input and writing the factors",
                     "cells: exactff convert --divide, the longest edge / across",
                     *(f"exact, {source.label}: exactff matrix {source.path} {' '.join(source.ours)} --threads 1"
                       for source in SCENES)]:
            file.write(f"# {note}\n")
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        for source in SCENES:
            place = folder / re.sub(r"\W", "_", source.label)
            place.mkdir(parents=True, exist_ok=True)
            scene = Scene(program, source.path, place, source.sheets)
            exact = Exact(scene, source.ours)
            for name, refinements, needs, only_closed in settings:
                for across in refinements:
                    if across < source.coarsest or (only_closed and not source.closed):
                        continue
                    row = {"scene": source.label, "setting": name, **measure_once(solve, scene, across, exact, needs)}
                    table.writerow({key: f"{value:.4g}" if isinstance(value, float) else value
                                    for key, value in row.items()})
                    file.flush()


# --- OpenFOAM ---
#
# viewFactorsGen looks at boundary faces only. The mesh it gets is one polyhedral cell whose boundary is the scene; its
# coarse mesh is one such cell in any case. The plates do not enclose a volume; viewFactorsGen does not mind.

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


def solve_by_openfoam(scene, across, block):
    cells = scene.cells(across, block)
    case = scene.folder / "case"
    shutil.rmtree(case, ignore_errors=True)
    write_case(case, cells)
    environment = {**os.environ, **ONE_THREAD, "WM_PROJECT_DIR": "/usr/share/openfoam"}
    _, seconds, used = run(["viewFactorsGen", "-case", case], env=environment)
    first = numpy.unique(cells.block, return_index=True)[1]  # cell of each block
    matrix = of_patches(read_factors(case, len(first)), numpy.bincount(cells.block, cells.areas),
                                cells.patch[first])
    shutil.rmtree(case)
    return len(cells.corners), matrix, seconds, used


OPENFOAM_SETTINGS = [
    # The finest that viewFactorsGen knows: a ray between the centres of any two faces. Odd numbers of faces, since with
    # even ones many rays between the plates meet the very edge of the plate between them; 16 shows what that costs.
    ("each face alone", [3, 5, 9, 16, 17, 33], {"block": 1}, False),
    # What faceAgglomerate is for: one ray between blocks, whose faces are summed over. Square blocks are its best case.
    # Their number along an edge is odd, too.
    ("blocks of 2 x 2 faces", [10, 18, 34], {"block": 2}, False),
    ("blocks of 4 x 4 faces", [20, 36, 68], {"block": 4}, False),
]


# --- CalculiX ---
#
# Every cell is the face 1 of a thin brick of its own (C3D8; C3D6 behind a triangle), which radiates into one cavity.
# CalculiX cuts it into triangles. The bricks lie behind their faces and take no other part.

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


def read_vwf(path, faces):
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
    return Cells(numpy.array(points), corners, cells.patch[owner], cells.block[owner], cells.size)


def with_backs(cells, patches):
    """The cells, and then the backs of those of some patches, as cells of one patch more: a face hides nothing from its
    back. They lie a little behind: two sides in one plane can hide each other."""
    points, corners = list(cells.points), list(cells.corners)
    turned = [k for k, patch in enumerate(cells.patch) if patch in patches]
    for k in turned:
        corners.append(list(range(len(points), len(points) + len(cells.corners[k]))))
        points += list(cells.points[cells.corners[k][::-1]] - GAP * cells.size * cells.normals[k])
    patch = numpy.append(cells.patch, [cells.patch[-1] + 1] * len(turned))
    return Cells(numpy.array(points), corners, patch, range(len(corners)), cells.size)


def solve_by_calculix(scene, across, sink):
    cells = with_backs(without_polygons(scene.cells(across)), [scene.names.index(name) for name in scene.sheets])
    case = scene.folder / "case"
    shutil.rmtree(case, ignore_errors=True)
    case.mkdir()
    write_deck(case / "scene.inp", cells, sink)
    said, seconds, used = run(["ccx", "scene"], passing=(0, 201), cwd=case,
                                      env={**os.environ, **ONE_THREAD})
    if not (case / "scene.vwf").exists():
        sys.exit(f"{case}: CalculiX wrote no view factors\n{said[-2000:]}")
    matrix = of_patches(read_vwf(case / "scene.vwf", len(cells.corners)), cells.areas, cells.patch)
    shutil.rmtree(case)
    return len(cells.corners), matrix, seconds, used


CALCULIX_SETTINGS = [
    # A positive sink temperature: the program divides only those rows of faces by their sum whose sum exceeds 1.
    ("rows as computed", [3, 5, 9, 17, 33], {"sink": "300."}, False),
    # A negative one makes CalculiX divide every row of a face by its sum: for closed rooms.
    ("rows scaled to 1", [3, 5, 9, 17], {"sink": "-300."}, True),
]

PROGRAMS = {"openfoam": ("openfoam", "viewFactorsGen of OpenFOAM", OPENFOAM_SETTINGS, solve_by_openfoam),
            "calculix": ("calculix-ccx", "*VIEWFACTOR of CalculiX", CALCULIX_SETTINGS, solve_by_calculix)}


# --- the questions of data/suite: points for methods and POV-Ray, pairs for OpenFOAM and CalculiX, the sky for none ---

METHODS = {  # 1,024 rays or samples, or pixels in proportion
    "adaptive-literal": "adaptive:variant=literal,rays=256",
    "adaptive-mended": "adaptive:rays=256",
    "hemicube-256": "hemicube:resolution=256",
    "nettle-16x16": "nettle:splits=16",
    "wallace-32x32": "wallace:splits=32",
    "area-sampling-1024": "area-sampling:samples=1024,pattern=stratified",
}
ACROSS = {"openfoam": (33, {"block": 1}), "calculix": (17, {"sink": "300."})}  # cells along the longest edge
MOST_CELLS = 2500
POVRAY = """#version 3.7;
global_settings {{ assumed_gamma 1 radiosity {{ pretrace_start 1 pretrace_end 1 count 1600 nearest_count 1
  recursion_limit 1 error_bound 0.1 low_error_factor 1 minimum_reuse 1e-5 maximum_reuse 1e-3 }} }}
#default {{ finish {{ ambient 0 diffuse 0 }} pigment {{ rgb 0 }} }}
camera {{ orthographic location {camera} direction {down} right {right} up {up} }}
mesh {{ {receiver} pigment {{ rgb 1 }} finish {{ diffuse 1 }} }}
"""


def questions():
    return rows_of(SUITE / "questions.csv")


def scene_file(question):
    return SUITE / "scenes" / f"{question['scene']}.obj"


def ask_method(method):
    """The form factors at points, of patches; each question on its own."""
    import exactff
    scenes = {}
    for q in questions():
        if q["quantity"] != "form factor" or q["to"] == "sky":
            continue
        if q["scene"] not in scenes:
            scenes[q["scene"]] = exactff.Scene.read(str(scene_file(q)))
        point, normal = ([[float(q[c]) for c in columns]] for columns in (("x", "y", "z"), ("nx", "ny", "nz")))
        try:
            value = exactff.methods.evaluate(method, scenes[q["scene"]], point, normal, q["to"], q["on"] or None)
        except exactff.InputError as error:  # a scene that single precision cannot hold
            print(f"{q['question']}: {str(error).splitlines()[0][:150]}")
            continue
        yield q["question"], float(value[0, 0])


def triangles(corners):
    return " ".join("triangle { " + ", ".join("<%r, %r, %r>" % tuple(map(float, c)) for c in (corners[0], a, b)) + " }"
                    for a, b in zip(corners[1:], corners[2:]))


def povray_scene(q):
    """A white square on the receiver, lit by the source, which emits from its front, by the rays of `radiosity`."""
    vertices, patches = read_obj(scene_file(q))
    x, n = (numpy.array([float(q[c]) for c in columns]) for columns in (("x", "y", "z"), ("nx", "ny", "nz")))
    n /= numpy.linalg.norm(n)
    u = numpy.cross(n, [1, 0, 0] if abs(n[0]) < 0.6 else [0, 1, 0])
    u /= numpy.linalg.norm(u)
    w, size = numpy.cross(n, u), 1e-4 * numpy.ptp(vertices, axis=0).max()
    square = [x + size * (a * u + b * w) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    camera, down, right, up = ("<%r, %r, %r>" % tuple(map(float, vector))
                               for vector in (x + size * n, -size * n, size / 10 * u, size / 10 * w))
    text = POVRAY.format(camera=camera, down=down, right=right, up=up, receiver=triangles(square))
    for name, faces in patches.items():
        light = " interior_texture { pigment { rgb 1 } finish { emission 1 } }" if name == q["to"] else ""
        for k, face in enumerate(faces, 1):
            if q["on"] != f"{name}:{k}":
                text += f"mesh {{ {triangles(vertices[face])} no_image texture {{ pigment {{ rgb 0 }} }}{light} }}\n"
    return text


def ask_povray(folder):
    folder.mkdir(parents=True, exist_ok=True)
    for q in questions():
        if q["quantity"] == "form factor" and q["to"] != "sky":
            (folder / "s.pov").write_text(povray_scene(q))
            run(["povray", f"+I{folder}/s.pov", f"+O{folder}/s.ppm", "+W1", "+H1", "+FP16", "-D", "-A", "+WT1",
                         "File_Gamma=1"])
            yield q["question"], int.from_bytes((folder / "s.ppm").read_bytes()[-6:-4], "big") / 65535


def ask_program(program, exactff_program, folder):
    """The view factors of pairs of patches, from matrices of whole scenes. A scene without an answer is told."""
    solve, (across, needs) = PROGRAMS[program][3], ACROSS[program]
    pairs = [q for q in questions() if q["from"]]
    for name in dict.fromkeys(q["scene"] for q in pairs):
        place = folder / program / name
        place.mkdir(parents=True, exist_ok=True)
        source = SUITE / "scenes" / f"{name}.obj"
        scene = Scene(exactff_program, source, place)
        used = next(a for a in range(across, 0, -1) if a == 1 or len(scene.cells(a).corners) <= MOST_CELLS)
        if program == "calculix":  # a face hides nothing from its back
            scene.sheets = [n for n in scene.names if n not in {q[end] for q in pairs if q["scene"] == name
                                                                for end in ("from", "to")}]
        try:
            _, matrix, *_ = solve(scene, used, **needs)
        except SystemExit as error:
            print(f"{name}: {str(error)[-150:]!r}")
            continue
        at = {patch: k for k, patch in enumerate(scene.names)}
        for q in pairs:
            if q["scene"] == name:
                yield q["question"], float(matrix[at[q["from"]], at[q["to"]]])


def board(program, folder):
    """data/field/suite.csv, from the answers in data/field/suite and what programs.csv says of the programs."""
    field = SUITE.parent / "field"
    about = {row["program"]: row for row in rows_of(field / "suite" / "programs.csv")}
    times = [word for row in about.values() if row["cpu_seconds"]
             for word in ("--time", f"{row['program']}={row['cpu_seconds']}")]
    answers = [os.path.relpath(field / "suite" / f"{name}.csv") for name in about]
    said, *_ = run([program, "check", os.path.relpath(SUITE), *answers, "--max-abs",
                            "1e-3", *times, "-o", folder], passing=(0, 1))
    print(said)
    columns = "program level questions answered worst median digits_median digits_worst limits limits_kept".split()
    with open(field / "suite.csv", "w", encoding="utf-8") as file:
        file.write("# command: validation/field/field.py build/exactff board; limit: 1e-3\n")
        file.write(",".join(columns) + "\n")
        for one in json.loads((pathlib.Path(folder) / "scoreboard.json").read_text())["programs"]:
            for level in one["levels"]:
                errors, digits = level.get("errors", {}), level.get("digits", {})
                numbers = errors.get("max"), errors.get("median"), digits.get("median"), digits.get("worst")
                file.write(",".join([one["name"], level["level"], str(level["cases"]), str(level["answered"]),
                                     *("" if n is None else f"{n:.3g}" for n in numbers), str(level["limits"]),
                                     str(level["limits_kept"])]) + "\n")


def ask(program, folder, names):
    sys.path.insert(0, str(program.parent / "python"))
    times = folder / "times.json"
    seconds = json.loads(times.read_text()) if times.exists() else {}
    for name in names or (*METHODS, "povray", *ACROSS):
        before = time.process_time() + sum(os.times()[2:4])
        answers = (ask_method(METHODS[name]) if name in METHODS else ask_povray(folder / name) if name == "povray" else
                   ask_program(name, program, folder))
        lines = [f"{question},{value!r}" for question, value in answers]
        (folder / f"{name}.csv").write_text("\n".join(["question,value", *lines]) + "\n")
        seconds[name] = time.process_time() + sum(os.times()[2:4]) - before
        times.write_text(json.dumps(seconds, indent=1))
        print(f"{name}: {len(lines)} answers, {seconds[name]:.1f} s of the processor", flush=True)
        shutil.rmtree(folder / name, ignore_errors=True)


def main(program, task, *more):
    program = pathlib.Path(program).resolve()
    folder = TOP / "build" / "field" / task
    run([TOP / "validation" / "setup.sh", "python3-numpy", *PACKAGES[task]])
    os.chdir(TOP)
    if task == "board":
        return board(program, folder)
    folder.mkdir(parents=True, exist_ok=True)
    if task == "cycles":  # Debian's packages belong to Debian's Python, whatever else is installed
        os.execv("/usr/bin/python3", ["python3", "-B", "validation/field/cycles.py", str(program), str(folder), *more])
    return ask(program, folder, more) if task == "suite" else measure(program, task, folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
