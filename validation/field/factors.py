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

import numpy

SCENES = [
    ("room with cube", "data/field/room_with_cube.obj", True),
    ("L-shaped room", "data/scenes/formats/test4.vs3", True),
    ("plate between plates", "data/field/plates.obj", False),
]
LIMIT = 1e-3  # an entry that is farther from our bounds is counted
COLUMNS = """scene setting across faces runs cpu_seconds seconds worst rms row_sum beyond_limit entries
    exact_cpu_seconds exact_width""".split()
ONE_THREAD = {"OMP_NUM_THREADS": "1"}


def read_obj(path):
    """The patches of an OBJ file by name: lists of faces, which are arrays of vertices."""
    vertices, patches, patch = [], {}, None
    for words in map(str.split, pathlib.Path(path).read_text(encoding="utf-8").splitlines()):
        if not words:
            continue
        if words[0] == "v":
            vertices.append([float(word) for word in words[1:4]])
        elif words[0] == "g":
            patch = patches.setdefault(words[1], [])
        elif words[0] == "f":
            patch.append(numpy.array([vertices[int(word.split("/")[0]) - 1] for word in words[1:]]))
    return patches


class Cells:
    """The faces of a scene as grids of cells, about as large everywhere: `across` of them along the longest edge.

    points: coordinates; quads: the vertices of each cell, counter-clockwise before its front; patch: the number of its
    patch; normals: of the faces at their points; blocks: for each cell the number, within its patch, of its block of
    block x block cells. The cells of a patch follow each other. Points of different faces are different.
    """

    def __init__(self, patches, across, block=1):
        longest = max(numpy.linalg.norm(numpy.roll(face, -1, 0) - face, axis=1).max()
                      for faces in patches.values() for face in faces)
        points, normals, self.quads, self.patch, self.blocks = [], [], [], [], []
        for number, faces in enumerate(patches.values()):
            first_block = 0
            for face in faces:
                if len(face) != 4 or abs(face[0] - face[1] + face[2] - face[3]).max() > 1e-12 * longest:
                    sys.exit(f"Patch {list(patches)[number]}: only parallelograms can be cut into cells here")
                u, v = face[1] - face[0], face[3] - face[0]
                m, n = (max(1, round(across * numpy.linalg.norm(side) / longest)) for side in (u, v))
                start, normal = len(points), numpy.cross(u, v) / numpy.linalg.norm(numpy.cross(u, v))
                points += [face[0] + u * (i / m) + v * (j / n) for i in range(m + 1) for j in range(n + 1)]
                normals += [normal] * ((m + 1) * (n + 1))
                for i, j in numpy.ndindex(m, n):
                    corner = start + i * (n + 1) + j
                    self.quads.append([corner, corner + n + 1, corner + n + 2, corner + 1])
                    self.patch.append(number)
                    self.blocks.append(first_block + i // block * -(-n // block) + j // block)
                first_block = self.blocks[-1] + 1
        self.points, self.normals = numpy.array(points), numpy.array(normals)
        self.quads, self.patch, self.blocks = map(numpy.array, (self.quads, self.patch, self.blocks))
        corners = self.points[self.quads]
        sides = corners[:, 1] - corners[:, 0], corners[:, 3] - corners[:, 0]
        self.areas = numpy.linalg.norm(numpy.cross(*sides), axis=1)
        self.size = longest / across


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


class Exact:
    """The certified matrix of a scene: its file, the median time of three runs, and its widest entry."""

    def __init__(self, program, scene, folder):
        self.program, self.folder = program, folder
        self.path = folder / "exact.csv"
        self.obj = folder / "scene.obj"
        run([program, "convert", scene, self.obj, "--force"])
        command = [program, "matrix", scene, "--certify", "--threads", "1", "--force", "-o", self.path]
        self.seconds = float(numpy.median([run(command)[2] for _ in range(3)]))
        self.rows = rows_of(self.path)
        self.width = max(float(row["upper"]) - float(row["lower"]) for row in self.rows)

    def judge(self, names, matrix):
        """The errors of another program's matrix, by `exactff check`."""
        theirs, verdict = self.folder / "theirs.csv", self.folder / "check.json"
        with open(theirs, "w", encoding="utf-8", newline="") as file:
            table = csv.writer(file)
            table.writerow(["from", "to", "value"])
            table.writerows([a, b, repr(float(matrix[i, j]))] for i, a in enumerate(names) for j, b in enumerate(names))
        run([self.program, "check", self.path, theirs, "--max-abs", LIMIT, "--json", verdict], passing=(0, 1))
        found = json.loads(verdict.read_text(encoding="utf-8"))
        at = {name: number for number, name in enumerate(names)}
        off = [max(float(row["lower"]) - value, value - float(row["upper"]))
               for row in self.rows for value in [matrix[at[row["from"]], at[row["to"]]]]]
        beyond = sum(error > LIMIT for error in off)
        if found["passed"] != (beyond == 0):
            sys.exit(f"{theirs}: {beyond} entries are beyond the limit, but check says passed = {found['passed']}")
        return {"worst": found["overall"]["absolute"]["max"], "rms": found["overall"]["absolute"]["rms"],
                "row_sum": found["matrix"]["row_sum"]["by"], "beyond_limit": beyond, "entries": len(off)}


def measure_once(solve, patches, across, place, exact, needs):
    """What a setting gives: errors of the first run, median times of three runs; those of 20 s or more are single."""
    done = [solve(patches, across, place, **needs)]
    while len(done) < 3 and done[0][3] < 20:
        done.append(solve(patches, across, place, **needs))
    faces, matrix = done[0][:2]
    seconds, used = numpy.median([one[2:] for one in done], axis=0)
    return {"across": across, "faces": faces, "runs": len(done), "cpu_seconds": used, "seconds": seconds,
            **exact.judge(list(patches), matrix), "exact_cpu_seconds": exact.seconds, "exact_width": exact.width}


def show(row):
    print(f"{row['scene']}, {row['setting']}, {row['across']} across: {row['faces']} faces, {row['cpu_seconds']:.2f} s,"
          f" worst {row['worst']:.1e}, RMS {row['rms']:.1e}, row sum {row['row_sum']:.1e}, {row['beyond_limit']} of"
          f" {row['entries']} beyond {LIMIT:g}; exact {row['exact_cpu_seconds']:.2f} s, width {row['exact_width']:.1e}",
          flush=True)


def measure(title, script, notes, settings, solve):
    """Runs all settings on all scenes and writes the table. A setting: (name, values of across, what solve needs, only
    closed scenes). solve(patches, across, folder, **needs) returns (number of faces, factors of patches, seconds,
    processor seconds). Finished rows are kept."""
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    most = 9 if "--quick" in sys.argv else 1000
    path = folder / f"{script}.csv"
    finished = {(row["scene"], row["setting"], int(row["across"])) for row in rows_of(path)} if path.exists() else set()
    with open(path, "a", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS)
        if file.tell() == 0:
            for note in [f"title: {title}", f"command: validation/field/{script}.sh", *notes]:
                file.write(f"# {note}\n")
            table.writeheader()
        for scene, source, closed in SCENES:
            place = folder / re.sub(r"\W", "_", scene)
            place.mkdir(parents=True, exist_ok=True)
            exact = Exact(program, source, place)
            patches = read_obj(exact.obj)
            for name, refinements, needs, only_closed in settings:
                for across in refinements:
                    if (scene, name, across) in finished or (only_closed and not closed) or across > most:
                        continue
                    row = {"scene": scene, "setting": name,
                           **measure_once(solve, patches, across, place, exact, needs)}
                    table.writerow({key: f"{value:.4g}" if isinstance(value, float) else value
                                    for key, value in row.items()})
                    file.flush()
                    show(row)
