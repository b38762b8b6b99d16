"""What openfoam.py and calculix.py share: scenes in cells, factors of patches, and the judgement of `exactff check`."""

import csv
import json
import os
import pathlib
import re
import resource
import subprocess
import sys
import time
import typing

import numpy


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
        self.seconds = float(numpy.median([one[2] for one in repeated(lambda: run(command, passing=(0, 3)))]))  # 3: wider than asked
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


def measure(title, script, notes, settings, solve):
    """Runs all settings on all scenes and writes the table. A setting: (name, values of across, what solve needs, only
    closed scenes). solve(scene, across, **needs) returns (number of faces, factors of patches, seconds,
    processor seconds). Finished rows are kept."""
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    most = 10 if "--quick" in sys.argv else 1000
    path = folder / f"{script}.csv"
    finished = {(row["scene"], row["setting"], int(row["across"])) for row in rows_of(path)} if path.exists() else set()
    with open(path, "a", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        if file.tell() == 0:
            for note in [f"title: {title}", f"command: validation/field/measure.sh {script}", *notes,
                         "cells: exactff convert --divide, the longest edge / across",
                         *(f"exact, {source.label}: exactff matrix {source.path} {' '.join(source.ours)} --threads 1"
                           for source in SCENES)]:
                file.write(f"# {note}\n")
            table.writeheader()
        for source in SCENES:
            missing = [(name, across, needs) for name, refinements, needs, only_closed in settings
                       for across in refinements if source.coarsest <= across <= most and
                       (source.closed or not only_closed) and (source.label, name, across) not in finished]
            if not missing:
                continue
            place = folder / re.sub(r"\W", "_", source.label)
            place.mkdir(parents=True, exist_ok=True)
            scene = Scene(program, source.path, place, source.sheets)
            exact = Exact(scene, source.ours)
            for name, across, needs in missing:
                row = {"scene": source.label, "setting": name, **measure_once(solve, scene, across, exact, needs)}
                table.writerow({key: f"{value:.4g}" if isinstance(value, float) else value
                                for key, value in row.items()})
                file.flush()
                print(row, flush=True)
